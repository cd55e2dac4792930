#include <firstcontact/narrowphase/edge_edge_contact.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <firstcontact/narrowphase/detail/elementary_search.h>
#include <firstcontact/narrowphase/detail/gap_bounds.h>
#include <firstcontact/narrowphase/detail/vector_in_a.h>

namespace firstcontact {
namespace {

using detail::kUp;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Clamps x to [0, 1] without a branch, which could not be foreseen.
double clamp_to_unit(double x) { return Eigen::Array2d(x, x).max(0.0).min(1.0)[0]; }

/// [-]  Squared sine of the angle of two edges below which their product is no useful direction.
constexpr double kParallel = 1e-12;

/// Edge a + u of A at rest and edge c + v of B that moves, from A's pivot in A's axes at the start.
class TwoEdges {
 public:
  TwoEdges(const ElementaryMotion& motion, const Edge& edge_A, const Edge& edge_B)
      : motion_(motion),
        a_(motion.A.lever + motion.A.rotation * edge_A[0]),
        u_(motion.A.rotation * (edge_A[1] - edge_A[0])),
        lever_B_(motion.B.lever + motion.B.rotation * edge_B[0]),
        start_v_(motion.B.rotation * (edge_B[1] - edge_B[0])),
        path_c_(detail::seen_point(motion, lever_B_)),
        path_v_(detail::seen_vector(motion, start_v_)),
        uu_(u_.squaredNorm()),
        vv_(start_v_.squaredNorm()),
        inverse_uu_(detail::inverse(uu_)),
        inverse_vv_(detail::inverse(vv_)),
        reach_B_(detail::longest(edge_B[0], edge_B[1])),
        circle_B_(detail::longest(path_c_.cosine, Vector3d(path_c_.cosine + path_v_.cosine))),
        gap_(motion, detail::longest(edge_A[0], edge_A[1]), reach_B_,
             detail::longest(Vector2d(a_.head<2>()), Vector2d((a_ + u_).head<2>())), circle_B_) {}

  void move_to(double t) {
    const detail::Turns turns(motion_, t);
    seen_c_ = path_c_.at(turns, motion_.B.rate);
    seen_v_ = path_v_.at(turns, motion_.B.rate);
    e_ = seen_c_.value - a_;
    v_ = seen_v_.value;
    normal_ = u_.cross(v_);
    axis_B_ = turns.back(motion_.axis_B);
  }

  [[nodiscard]] ValueAndRate coplanarity() const {
    const double w_A = motion_.A.rate;
    const Vector3d rate_e = detail::relative_rate(seen_c_, w_A);
    const Vector3d rate_v = detail::relative_rate(seen_v_, w_A);
    return {e_.dot(normal_), rate_e.dot(normal_) + e_.cross(u_).dot(rate_v)};
  }
  /// Bounds f = u . (v x c) - (a x u) . v + (offset + tau drift) . (u x v), with c from B's pivot.
  [[nodiscard]] CurvatureBound coplanarity_bounds() {
    const double w_A = motion_.A.rate;
    const double w_B = motion_.B.rate;
    speed_bound_ = (motion_.drift_length + w_B * circle_B_ +
                    w_A * (motion_.offset_bound + motion_.B.lever_length + reach_B_)) *
                   kUp;
    // The rounding of u x v and of e' is relative to their factors.
    const double lengths = std::sqrt(uu_ * vv_) * kUp;
    CurvatureBound bounds;
    bounds.value_error = lengths * (gap_.position_error + 4.0 * motion_.rounding * gap_.size);
    bounds.rate_error = lengths * (2.0 * gap_.slip + 4.0 * motion_.rounding *
                                                         (speed_bound_ + (w_A + w_B) * gap_.size));
    const AxialParts u = axial_parts(u_, Vector3d::UnitZ());
    const AxialParts v = axial_parts(start_v_, motion_.axis_B);
    const AxialParts moment_u = axial_parts(a_.cross(u_), Vector3d::UnitZ());
    const AxialParts moment_v = axial_parts(start_v_.cross(lever_B_), motion_.axis_B);
    const Oscillation& oscillation = motion_.oscillation;
    bounds.curvature =
        (oscillation.dot_derivative(2, u, moment_v) + oscillation.dot_derivative(2, moment_u, v) +
         motion_.offset_bound * oscillation.cross_derivative(2, u, v) +
         2.0 * motion_.drift_length * oscillation.cross_derivative(1, u, v) +
         8.0 * lengths * gap_.unsteadiness) *
        kUp;
    return bounds;
  }

  /// The gaps along the direction between the nearest points, which stands still in the world.
  [[nodiscard]] detail::Gaps<4> gaps() const {
    const Vector3d d = between_nearest_points();
    // A point p of A moves at rate z x p, along d at -p . turn.
    const Vector3d turn(-motion_.A.rate * d.y(), motion_.A.rate * d.x(), 0.0);
    const ValueAndRate ac{d.dot(e_), d.dot(seen_c_.rate) + turn.dot(a_)};
    const ValueAndRate u{-d.dot(u_), turn.dot(u_)};
    const ValueAndRate v{d.dot(v_), d.dot(seen_v_.rate)};
    return {{ac, ac + u, ac + v, ac + u + v}, gap_.along(d, axis_B_)};
  }

  /// Whether the edges provably meet where they are coplanar within `duration`.
  ///
  /// Derivation: coplanar lines that are not parallel cross at a + s u = c + r v. There s
  /// |N|^2 = (e x v) . N and r |N|^2 = (e x u) . N, with N = u x v. Each product changes by no more
  /// than the product of its factors' greatest lengths times the sum of their relative changes.
  [[nodiscard]] bool meet_if_coplanar(double duration) const {
    const double e_change = speed_bound_ * duration * kUp + gap_.position_error;
    const double turn_change =
        2.0 * (motion_.A.rate + motion_.B.rate) * duration * kUp + 8.0 * motion_.rounding;
    const double e_length = e_.norm() + e_change;
    const double grown = (1.0 + turn_change) * (1.0 + turn_change) * kUp;
    const double uu = uu_ * grown;
    const double vv = vv_ * grown;
    const double uv = std::sqrt(uu * vv);
    const double change = (e_change + e_length * turn_change) * uv * kUp;
    const double nn = normal_.squaredNorm();
    const double nn_change = uu * vv * turn_change * kUp;
    const double s = e_.cross(v_).dot(normal_);
    const double r = e_.cross(u_).dot(normal_);
    const double s_change = change * std::sqrt(vv) * kUp;
    const double r_change = change * std::sqrt(uu) * kUp;
    return s > s_change && nn - s > s_change + nn_change && r > r_change &&
           nn - r > r_change + nn_change;
  }

 private:
  /// The direction between the nearest features, of any length.
  ///
  /// It is along the product of the edges, or across an edge from a corner, or between two corners.
  /// It stays accurate where they touch. One parameter comes from the normal equations. Then each
  /// parameter is made the best for the other, which also serves near-parallel edges.
  [[nodiscard]] Vector3d between_nearest_points() const {
    const double uv = u_.dot(v_);
    const double ue = u_.dot(e_);
    const double ve = v_.dot(e_);
    const double determinant = uu_ * vv_ - uv * uv;
    double s = clamp_to_unit((ue * vv_ - ve * uv) / std::max(determinant, 0x1p-1000));
    const double r = clamp_to_unit((s * uv - ve) * inverse_vv_);
    s = clamp_to_unit((r * uv + ue) * inverse_uu_);
    const bool inside_u = s > 0.0 && s < 1.0;
    const bool inside_v = r > 0.0 && r < 1.0;
    const Vector3d d = e_ + r * v_ - s * u_;
    const std::array<Vector3d, 4> directions{d, d - (d.dot(u_) * inverse_uu_) * u_,
                                             d - (d.dot(v_) * inverse_vv_) * v_,
                                             std::copysign(1.0, e_.dot(normal_)) * normal_};
    const bool crossed = inside_u && inside_v && determinant > kParallel * uu_ * vv_;
    return directions[crossed ? 3 : (inside_u ? 1 : (inside_v ? 2 : 0))];
  }

  const ElementaryMotion& motion_;
  Vector3d a_;
  Vector3d u_;
  Vector3d lever_B_;
  Vector3d start_v_;
  detail::VectorInA path_c_;
  detail::VectorInA path_v_;

  double uu_;
  double vv_;
  double inverse_uu_;
  double inverse_vv_;
  double reach_B_;
  double circle_B_;
  detail::GapBounds gap_;
  double speed_bound_ = 0.0;  // From coplanarity_bounds().

  detail::VectorInA::State seen_c_;
  detail::VectorInA::State seen_v_;
  Vector3d e_;
  Vector3d v_;
  Vector3d normal_;
  Vector3d axis_B_;
};

}  // namespace

ElementaryContact edge_edge_contact(const ElementaryMotion& motion, const Edge& edge_A,
                                    const Edge& edge_B, const ElementaryOptions& options) {
  TwoEdges pair(motion, edge_A, edge_B);
  return detail::ElementarySearch(pair, motion, options).run();
}

}  // namespace firstcontact
