#include <firstcontact/simulation_model/detail/move.h>

#include <algorithm>
#include <array>

#include <firstcontact/simulation_model/detail/sim_body.h>

namespace firstcontact::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// [-]  Growth of boxes by rounding, by their size and place.
constexpr double kSlack = 1e-12;

}  // namespace

Motion motion_of(const SimBody& body, const Pose& X_WB, const Move& move) {
  const std::array<ConstantRatePiece, 1> piece{
      {{1.0, X_WB, move.translation, move.rotation_vector}}};
  return Motion::constant_rates(piece, body.inertia.p_BC);
}

AlignedBox3d swept_box(const SimBody& body, const Pose& X_WB, const Move& move) {
  const Eigen::Matrix3d R = X_WB.rotation.normalized().toRotationMatrix();
  const Vector3d p_WC = X_WB.position + R * body.inertia.p_BC;
  const Vector3d centre = X_WB.position + R * body.box_B.center();
  const Vector3d half = R.cwiseAbs() * (0.5 * body.box_B.sizes());
  // A point at distance r from C moves no farther than the chord, nor than 2 r.
  const double turned = body.reach * std::min(2.0, move.rotation_vector.norm());
  const Vector3d around = half.array() + turned;
  const AlignedBox3d box(centre - around, centre + around);
  const Vector3d reach = Vector3d::Constant(body.reach);
  AlignedBox3d swept = box.intersection(AlignedBox3d(p_WC - reach, p_WC + reach));
  swept.extend(AlignedBox3d(swept.min() + move.translation, swept.max() + move.translation));
  const Vector3d slack =
      kSlack * (swept.min().cwiseAbs().cwiseMax(swept.max().cwiseAbs()).array() + body.reach);
  return {swept.min() - slack, swept.max() + slack};
}

}  // namespace firstcontact::detail
