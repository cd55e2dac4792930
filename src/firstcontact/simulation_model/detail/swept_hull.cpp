#include <firstcontact/simulation_model/detail/swept_hull.h>

#include <cstddef>
#include <span>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/narrowphase/convex_separation.h>
#include <firstcontact/simulation_model/detail/move.h>
#include <firstcontact/simulation_model/detail/sim_body.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// [-]  Rounding, by the sum of all places and ways. Rotations err by a few 2^-52, the matrix
/// between them (of norm 3 at most) by as many more, and the gap by 2^-48.
constexpr double kRounding = 0x1p-44;

/// [m]  Bound of the distance of a point of B from its parabola, as seen from A, roundings
/// included.
double error_seen(const SweptHull& A, const SweptHull& B) {
  const double speed = (B.translation - A.translation).norm();
  const double w = A.rate;
  const double w_B = B.rate;
  const double x = (B.p_WC - A.p_WC).norm() + speed + B.reach;
  const double jerk =
      w_B * w_B * (w_B + 3.0 * w) * B.reach + 3.0 * w * w * (speed + w_B * B.reach) + w * w * w * x;
  const double size = A.p_WC.norm() + B.p_WC.norm() + A.translation.norm() + B.translation.norm() +
                      A.p_BC.norm() + B.p_BC.norm() + 2.0 * (A.reach + B.reach);
  return jerk / 124.0 + kRounding * size * (1.0 + w + w_B);
}

}  // namespace

SweptHull::SweptHull(const SimBody& body, const Pose& X_WB, const Move& move, double from,
                     double to)
    : bounds(&body.shape.bounds()),
      p_BC(body.inertia.p_BC),
      p_WC(centre_of_mass(body.inertia, X_WB) + from * move.translation),
      translation((to - from) * move.translation),
      rate((to - from) * move.rotation_vector.norm()),
      reach(body.reach),
      thickness(body.shape.radius() + bounds->error) {
  const Matrix3d begin = X_WB.rotation.normalized().toRotationMatrix();
  const std::array<double, 3> shares{from, 0.5 * (from + to), to};
  for (std::size_t k = 0; k < 3; ++k) {
    R_WB[k] = shares[k] == 0.0
                  ? begin
                  : Matrix3d(turn(shares[k] * move.rotation_vector).toRotationMatrix() * begin);
  }
}

std::optional<Vector3d> plane_between(const SweptHull& A, const SweptHull& B, double distance,
                                      const Vector3d& n) {
  std::array<Matrix3d, 3> R_AB;
  std::array<Vector3d, 3> p_AB;  // From C of A to the middle of B's hull.
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d between =
        (B.p_WC - A.p_WC) + 0.5 * static_cast<double>(k) * (B.translation - A.translation);
    R_AB[k] = A.R_WB[k].transpose() * B.R_WB[k];
    p_AB[k] = A.R_WB[k].transpose() * between + R_AB[k] * (B.bounds->centre - B.p_BC);
  }
  R_AB[1] = 2.0 * R_AB[1] - 0.5 * (R_AB[0] + R_AB[2]);
  p_AB[1] = 2.0 * p_AB[1] - 0.5 * (p_AB[0] + p_AB[2]);
  const PlacedPolytope hull_A{A.bounds->corners, Matrix3d::Identity(), A.bounds->centre - A.p_BC};
  const std::array<PlacedPolytope, 3> hull_B{{{B.bounds->corners, R_AB[0], p_AB[0]},
                                              {B.bounds->corners, R_AB[1], p_AB[1]},
                                              {B.bounds->corners, R_AB[2], p_AB[2]}}};
  const double needed =
      (distance + A.thickness + B.thickness + error_seen(A, B)) * (1.0 + kRounding);
  const Separation found =
      separate(std::span(&hull_A, 1), hull_B, A.R_WB[0].transpose() * n, {needed, needed});
  return found.gap > needed ? std::optional<Vector3d>(A.R_WB[0] * found.n) : std::nullopt;
}

}  // namespace firstcontact::detail
