#include "support/exact_motion.h"

#include <stdexcept>

namespace firstcontact::oracle {
namespace {

struct Turn {
  Vector3<Wide> axis;
  Wide angle;  // >= 0
};

/// Splits an axis of any length, and an angle, into a unit axis and an angle >= 0.
Turn turn(const Vector3<Wide>& axis, const Wide& angle) {
  if (angle.is_zero()) {
    return {};
  }
  const Vector3<Wide> unit = (Wide(1.0) / norm(axis)) * axis;
  if (angle.is_negative()) {
    return {Wide(-1.0) * unit, -angle};
  }
  return {unit, angle};
}

bool is_zero(const Vector3<Wide>& v) { return v.x.is_zero() && v.y.is_zero() && v.z.is_zero(); }

/// e_k turned by the rotation q / |q|: e + 2 (w (v x e) + v x (v x e)) / |q|^2.
Matrix3<Wide> rotation_matrix(const Quaternion& q) {
  const Wide w = q.w;
  const Vector3<Wide> v{q.x, q.y, q.z};
  const Wide scale = Wide(2.0) / (w * w + dot(v, v));
  const std::array<Vector3<Wide>, 3> e{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  Matrix3<Wide> R;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3<Wide> v_e = cross(v, e[k]);
    R.column[k] = e[k] + scale * (w * v_e + cross(v, v_e));
  }
  return R;
}

bool first_component_is_negative(const Vector3<Wide>& v) {
  for (const Wide* component : {&v.x, &v.y, &v.z}) {
    if (!component->is_zero()) {
      return component->is_negative();
    }
  }
  return false;
}

/// The shortest rotation that takes a to b; for half turns the axis whose first non-zero
/// component is positive. Sums of products of doubles are exact in 256 bits unless their
/// exponents differ by more than a hundred, which the generator never does.
Turn shortest_rotation(const Quaternion& a, const Quaternion& b) {
  const Vector3<Wide> va{a.x, a.y, a.z};
  const Vector3<Wide> vb{b.x, b.y, b.z};
  Wide w = Wide(b.w) * Wide(a.w) + dot(vb, va);
  Vector3<Wide> v = Wide(a.w) * vb - Wide(b.w) * va - cross(vb, va);
  if (is_zero(v)) {
    return {};
  }
  if (w.is_negative() || (w.is_zero() && first_component_is_negative(v))) {
    w = -w;
    v = Wide(-1.0) * v;
  } else if (!w.is_zero() && !w.is_positive()) {
    throw std::runtime_error("shortest_rotation: 256 bits cannot tell the side of a half turn");
  }
  const Wide length = norm(v);
  return {(Wide(1.0) / length) * v, Wide(2.0) * atan2(length, w)};
}

MotionPiece at_rest(const PoseInput& pose, const Vector3<double>& center) {
  MotionPiece piece;
  piece.R = rotation_matrix(pose.rotation);
  piece.pivot = exact(pose.position);
  piece.lever = piece.R * exact(center);
  return piece;
}

MotionPiece constant_velocity(const PoseInput& start, const Vector3<Wide>& travel, const Turn& turn,
                              const Vector3<double>& center) {
  MotionPiece piece = at_rest(start, center);
  piece.travel = travel;
  piece.axis = turn.axis;
  piece.angle = turn.angle;
  return piece;
}

MotionPiece screw(const PoseInput& start, const Vector3<Wide>& axis_point,
                  const Vector3<Wide>& travel, const Turn& turn, const Vector3<double>& center) {
  MotionPiece piece = constant_velocity(start, travel, turn, center);
  piece.lever = piece.pivot + piece.lever - axis_point;
  piece.pivot = axis_point;
  return piece;
}

MotionPiece between(const PoseInput& from, const PoseInput& to, bool as_screw,
                    const Vector3<double>& center) {
  const Turn turn = shortest_rotation(from.rotation, to.rotation);
  const Vector3<Wide> travel = exact(to.position) - exact(from.position);
  if (!as_screw || turn.angle.is_zero()) {
    return constant_velocity(from, travel, turn, center);
  }
  // The axis point O solves (1 - Rot) (O - from) = across, the travel less its part along the axis.
  const Vector3<Wide> along = dot(travel, turn.axis) * turn.axis;
  const Vector3<Wide> across = travel - along;
  const Wide half = turn.angle.scaled(-1);
  const Vector3<Wide> to_axis = across + (cos(half) / sin(half)) * cross(turn.axis, across);
  return screw(from, exact(from.position) + Wide(0.5) * to_axis, along, turn, center);
}

MotionPiece spread(MotionPiece piece, double t_begin, double t_end) {
  piece.t_begin = t_begin;
  piece.t_end = t_end;
  return piece;
}

std::vector<MotionPiece> waypoints(const MotionInput& input, const Vector3<double>& center) {
  std::vector<MotionPiece> pieces;
  if (input.times.front() > 0.0) {
    pieces.push_back(spread(at_rest(input.poses.front(), center), 0.0, input.times.front()));
  }
  for (std::size_t i = 1; i < input.poses.size(); ++i) {
    pieces.push_back(spread(between(input.poses[i - 1], input.poses[i],
                                    input.kind == MotionKind::screw_waypoints, center),
                            input.times[i - 1], input.times[i]));
  }
  if (input.times.back() < 1.0) {
    pieces.push_back(spread(at_rest(input.poses.back(), center), input.times.back(), 1.0));
  }
  return pieces;
}

MotionPiece screw_about_axis(const MotionInput& input, const Vector3<double>& center) {
  const Vector3<Wide> direction = exact(input.axis_direction);
  const Vector3<Wide> travel = (Wide(input.along) / norm(direction)) * direction;
  return screw(input.poses[0], exact(input.axis_point), travel, turn(direction, input.angle),
               center);
}

}  // namespace

std::vector<MotionPiece> motion_pieces(const MotionInput& input, const Vector3<double>& center) {
  const Vector3<Wide> spin = exact(input.rotation_vector);
  switch (input.kind) {
    case MotionKind::fixed:
      return {at_rest(input.poses[0], center)};
    case MotionKind::constant_velocity:
      return {constant_velocity(input.poses[0], exact(input.translation),
                                is_zero(spin) ? Turn{} : turn(spin, norm(spin)), center)};
    case MotionKind::constant_velocity_between:
      return {between(input.poses[0], input.poses[1], false, center)};
    case MotionKind::screw:
      return {screw_about_axis(input, center)};
    case MotionKind::screw_between:
      return {between(input.poses[0], input.poses[1], true, center)};
    case MotionKind::waypoints:
    case MotionKind::screw_waypoints:
      return waypoints(input, center);
  }
  throw std::logic_error("motion_pieces: unknown kind");
}

}  // namespace firstcontact::oracle
