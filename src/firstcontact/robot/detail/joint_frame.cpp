#include <firstcontact/robot/detail/joint_frame.h>

#include <array>

namespace firstcontact::detail {
namespace {

/// The x and y directions of a planar joint: those of J, turned by the shortest rotation from z to
/// n.
std::array<DoubleDoubleVector3, 2> planar_directions(const DoubleDoubleVector3& n) {
  const DoubleDoubleVector3 x(1.0, 0.0, 0.0);
  const DoubleDoubleVector3 y(0.0, 1.0, 0.0);
  const DoubleDouble across = n.c[0] * n.c[0] + n.c[1] * n.c[1];
  if (across.hi == 0.0) {
    return {x, n.c[2].hi > 0.0 ? y : DoubleDouble(-1.0) * y};
  }
  // R e = e - (n . e) / (1 + n_z) (z + n) for e across z, with 1 + n_z = across / (1 - n_z) where
  // the sum would cancel.
  const DoubleDouble sum =
      n.c[2].hi > 0.0 ? DoubleDouble(1.0) + n.c[2] : across / (DoubleDouble(1.0) - n.c[2]);
  const DoubleDoubleVector3 z_n = DoubleDoubleVector3(0.0, 0.0, 1.0) + n;
  const DoubleDoubleVector3 halfway{z_n.c[0], z_n.c[1], sum};
  return {x - (n.c[0] / sum) * halfway, y - (n.c[1] / sum) * halfway};
}

}  // namespace

JointFrame joint_frame(const Joint& joint, const PreciseTransform& X_RJ) {
  const PreciseTransform rest;
  const CoordinateSegment zero;
  const DoubleDoubleVector3 axis =
      joint.type == JointType::fixed ? DoubleDoubleVector3() : precise_direction(joint.axis);
  switch (joint.type) {
    case JointType::fixed:
    case JointType::floating:
    case JointType::ball:
      return {X_RJ, {}};
    case JointType::revolute:
    case JointType::continuous:
      return {X_RJ, JointPath::polynomial(X_RJ, axis, zero, {}, rest)};
    case JointType::prismatic:
      return {X_RJ, JointPath::polynomial(X_RJ, axis, {}, {{axis, zero}}, rest)};
    case JointType::screw:
      return {X_RJ, JointPath::polynomial(X_RJ, axis, zero, {{axis, zero}}, rest)};
    case JointType::planar: {
      const auto [x, y] = planar_directions(axis);
      return {X_RJ, JointPath::polynomial(X_RJ, axis, zero, {{x, zero}, {y, zero}}, rest)};
    }
  }
  return {X_RJ, {}};
}

}  // namespace firstcontact::detail
