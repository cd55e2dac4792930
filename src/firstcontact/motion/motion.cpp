#include <firstcontact/motion/motion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/math/sine_cosine.h>

namespace firstcontact {
namespace {

/// Rounding of some ten double-double operations: 2^-98 of the operands is above it.
constexpr double kConstructionError = 0x1p-98;

/// The greatest coordinate. With greater ones double-double products would overflow or round below
/// the smallest normal number.
constexpr double kMaximumCoordinate = 1e60;  // [m]

/// The least time after 0: its reciprocal must not overflow.
constexpr double kLeastTime = 1e-200;

struct Quaternion {
  DoubleDouble w;
  DoubleDoubleVector3 v;
};

struct AxisAngle {
  DoubleDoubleVector3 axis;
  DoubleDouble angle;  // >= 0
};

void require(bool condition, const char* message) {
  if (!condition) {
    throw std::invalid_argument(message);
  }
}

void require_coordinates(const Eigen::Vector3d& v, const char* name) {
  // Negated, so that NaN is refused too.
  if (!(v.cwiseAbs().maxCoeff() <= kMaximumCoordinate) || v.hasNaN()) {
    throw std::invalid_argument(std::string(name) + " must be finite and at most 1e60 in size");
  }
}

void require_pose(const Pose& pose) {
  require_coordinates(pose.position, "Pose::position");
  const auto& q = pose.rotation.coeffs();
  require(q.allFinite(), "Pose::rotation must be finite");
  const double largest = q.cwiseAbs().maxCoeff();
  require(largest >= 1e-60 && largest <= 1e60,
          "Pose::rotation must not be a zero quaternion (its length must lie in 1e-60 ... 1e60)");
}

Quaternion exact(const Eigen::Quaterniond& q) {
  return {q.w(), DoubleDoubleVector3(q.x(), q.y(), q.z())};
}

DoubleDoubleVector3 unit(int axis) {
  DoubleDoubleVector3 e;
  e.c[axis] = 1.0;
  return e;
}

/// Computes the columns of the rotation matrix of q / |q|.
///
/// By R e = e + 2 (w v x e + v x (v x e)) / |q|^2, without the terms that are zero.
std::array<DoubleDoubleVector3, 3> rotation_columns(const Eigen::Quaterniond& rotation) {
  if (rotation.vec().isZero(0.0)) {
    return {unit(0), unit(1), unit(2)};
  }
  const Quaternion q = exact(rotation);
  const auto& v = q.v.c;
  const DoubleDouble scale = DoubleDouble(2.0) / (q.w * q.w + dot(q.v, q.v));
  std::array<DoubleDoubleVector3, 3> columns;
  for (std::size_t j = 0; j < 3; ++j) {
    const std::size_t k = (j + 1) % 3;
    const std::size_t l = (j + 2) % 3;
    columns[j].c[j] = DoubleDouble(1.0) + scale * (-(v[k] * v[k]) - v[l] * v[l]);
    columns[j].c[k] = scale * (q.w * v[l] + v[j] * v[k]);
    columns[j].c[l] = scale * (v[j] * v[l] - q.w * v[k]);
  }
  return columns;
}

/// The axis turned so that its first non-zero component is positive.
DoubleDoubleVector3 first_component_positive(const DoubleDoubleVector3& v) {
  for (const DoubleDouble& component : v.c) {
    if (component.hi != 0.0) {
      return component.hi > 0.0 ? v : DoubleDouble(-1.0) * v;
    }
  }
  return v;
}

/// The angle in [0, pi] whose sine and cosine are proportional to (y, x), y >= 0.
DoubleDouble precise_atan2(const DoubleDouble& y, const DoubleDouble& x) {
  const DoubleDouble r = sqrt(x * x + y * y);
  const DoubleDouble estimate = std::atan2(y.hi, x.hi);
  // One correction step: sin(exact - estimate) = its argument up to its cube, below 2^-150.
  const DoubleDoubleSineCosine sc = precise_sine_cosine(estimate);
  return estimate + (y / r) * sc.cosine - (x / r) * sc.sine;
}

/// Computes the sign of the exact sum of four products of doubles. It determines the direction of a
/// rotation of almost a half turn. Accumulates a non-overlapping expansion (Shewchuk 1997).
int sign_of_dot(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  std::array<double, 8> expansion{};
  int size = 0;
  const auto grow = [&](double term) {
    for (int i = 0; i < size; ++i) {
      const DoubleDouble s = two_sum(term, expansion[i]);
      expansion[i] = s.lo;
      term = s.hi;
    }
    expansion[size++] = term;
  };
  for (int i = 0; i < 4; ++i) {
    const DoubleDouble p = two_product(a[i], b[i]);
    grow(p.lo);
    grow(p.hi);
  }
  for (int i = size - 1; i >= 0; --i) {
    if (expansion[i] != 0.0) {
      return expansion[i] > 0.0 ? 1 : -1;
    }
  }
  return 0;
}

/// Finds the shortest rotation from one pose to the other.
AxisAngle shortest_rotation(const Pose& from, const Pose& to) {
  const Eigen::Quaterniond& a = from.rotation;
  const Eigen::Quaterniond& b = to.rotation;
  const Quaternion p = exact(a);
  const Quaternion q = exact(b);
  // b conj(a), not normalised: its scalar part is the four-dimensional dot product.
  DoubleDouble w = p.w * q.w + dot(p.v, q.v);
  DoubleDoubleVector3 v = p.w * q.v - q.w * p.v - cross(q.v, p.v);
  const int sign = sign_of_dot({a.w(), a.x(), a.y(), a.z()}, {b.w(), b.x(), b.y(), b.z()});
  if (sign < 0) {
    w = -w;
    v = DoubleDouble(-1.0) * v;
  } else if (sign == 0) {
    w = 0.0;
    v = first_component_positive(v);
  }
  const DoubleDouble length = norm(v);
  if (length.hi == 0.0) {
    return {};
  }
  return {(DoubleDouble(1.0) / length) * v, DoubleDouble(2.0) * precise_atan2(length, w)};
}

/// Splits a rotation vector into its exact direction and length.
AxisAngle axis_angle(const Eigen::Vector3d& rotation_vector) {
  // Scaled by a power of two, so that squares of tiny vectors do not underflow.
  const double largest = rotation_vector.cwiseAbs().maxCoeff();
  if (largest == 0.0) {
    return {};
  }
  const double scale = std::exp2(std::floor(std::log2(largest)));
  const DoubleDoubleVector3 v(rotation_vector / scale);
  const DoubleDouble length = norm(v);
  return {(DoubleDouble(1.0) / length) * v, DoubleDouble(scale) * length};
}

double rounded_length(const DoubleDoubleVector3& v) { return v.value().norm(); }

ConstantRateSegment at_rest(const Pose& pose) {
  ConstantRateSegment s;
  s.p_WQ = DoubleDoubleVector3(pose.position);
  s.rotation = rotation_columns(pose.rotation);
  s.rotation_error = kConstructionError;
  return s;
}

/// Moves the pivot of a segment from the body origin to Q, which moves as the origin did.
void move_pivot(ConstantRateSegment& s, const Eigen::Vector3d& p_BQ) {
  s.p_BQ = DoubleDoubleVector3(p_BQ);
  s.p_WQ = s.p_WQ + s.p_BQ.c[0] * s.rotation[0] + s.p_BQ.c[1] * s.rotation[1] +
           s.p_BQ.c[2] * s.rotation[2];
  s.position_error += kConstructionError * (rounded_length(s.p_WQ) + 4.0 * p_BQ.norm());
}

ConstantRateSegment constant_velocity_segment(const Pose& start,
                                              const DoubleDoubleVector3& translation,
                                              const AxisAngle& turn) {
  ConstantRateSegment s = at_rest(start);
  s.velocity = translation;
  s.axis = turn.axis;
  s.rate = turn.angle;
  s.rotation_error += kConstructionError * (1.0 + turn.angle.hi);
  s.position_error = kConstructionError * rounded_length(translation);
  return s;
}

/// Makes the segment of a screw.
///
/// @param axis_point  in the world; the pivot becomes the point of the axis nearest to the start
ConstantRateSegment screw_segment(const Pose& start, const DoubleDoubleVector3& axis_point,
                                  const AxisAngle& turn, const DoubleDouble& translation) {
  ConstantRateSegment s = at_rest(start);
  const DoubleDoubleVector3 origin(start.position);
  const DoubleDoubleVector3 p_WQ = axis_point + dot(origin - axis_point, turn.axis) * turn.axis;
  const DoubleDoubleVector3 p_BQ_W = p_WQ - origin;
  s.p_BQ = {dot(s.rotation[0], p_BQ_W), dot(s.rotation[1], p_BQ_W), dot(s.rotation[2], p_BQ_W)};
  s.p_WQ = p_WQ;
  s.velocity = translation * turn.axis;
  s.axis = turn.axis;
  s.rate = turn.angle;
  s.rotation_error += kConstructionError * (1.0 + turn.angle.hi);
  s.position_error = kConstructionError * (1.0 + turn.angle.hi) *
                     (start.position.norm() + rounded_length(axis_point) + rounded_length(p_BQ_W) +
                      std::abs(translation.hi));
  return s;
}

ConstantRateSegment between_constant_velocity(const Pose& from, const Pose& to) {
  return constant_velocity_segment(
      from, DoubleDoubleVector3(to.position) - DoubleDoubleVector3(from.position),
      shortest_rotation(from, to));
}

ConstantRateSegment between_screw(const Pose& from, const Pose& to) {
  const AxisAngle turn = shortest_rotation(from, to);
  const DoubleDoubleVector3 d =
      DoubleDoubleVector3(to.position) - DoubleDoubleVector3(from.position);
  // Below this angle the axis is too far away to be computed. The screw then deviates from the
  // straight motion by less than angle |d| / 4.
  constexpr double kStraight = 1e-15;  // [rad]
  if (turn.angle.hi < kStraight) {
    ConstantRateSegment s = constant_velocity_segment(from, d, turn);
    s.position_error += 0.25 * kStraight * rounded_length(d);
    return s;
  }
  const DoubleDouble along = dot(d, turn.axis);
  const DoubleDoubleVector3 across = d - along * turn.axis;
  const DoubleDoubleSineCosine half = precise_sine_cosine(DoubleDouble(0.5) * turn.angle);
  const DoubleDouble cotangent = half.cosine / half.sine;
  // Point of the axis: 1/2 (c0 + c1 + cot(w/2) u x d), equations A.2 of the bibliography's [Redon].
  const DoubleDoubleVector3 axis_point =
      DoubleDoubleVector3(from.position) +
      DoubleDouble(0.5) * (across + cotangent * cross(turn.axis, across));
  ConstantRateSegment s = screw_segment(from, axis_point, turn, along);
  // An error e of the axis direction moves the path by |d| e, and e grows as 1 / angle.
  s.position_error += 4.0 * kConstructionError * rounded_length(d) / turn.angle.hi;
  return s;
}

ConstantRateSegment between_poses(const Pose& from, const Pose& to, Between between) {
  return between == Between::screw ? between_screw(from, to) : between_constant_velocity(from, to);
}

/// Stretches a segment over [0, 1] to [t_begin, t_end].
ConstantRateSegment over(ConstantRateSegment s, double t_begin, double t_end) {
  const DoubleDouble speed_up = DoubleDouble(1.0) / two_sum(t_end, -t_begin);
  s.t_begin = t_begin;
  s.t_end = t_end;
  s.velocity = speed_up * s.velocity;
  s.rate = speed_up * s.rate;
  s.position_error += kConstructionError * (t_end - t_begin) * rounded_length(s.velocity);
  return s;
}

int compare_values(double a, double b) { return a < b ? -1 : (b < a ? 1 : 0); }

int compare_vectors(const DoubleDoubleVector3& a, const DoubleDoubleVector3& b) {
  int order = 0;
  for (std::size_t k = 0; k < 3 && order == 0; ++k) {
    order = compare_values(a.c[k].hi, b.c[k].hi);
    order = order != 0 ? order : compare_values(a.c[k].lo, b.c[k].lo);
  }
  return order;
}

/// Compares two segments. The third column of a rotation follows from the others.
int compare_segments(const ConstantRateSegment& a, const ConstantRateSegment& b) {
  for (const auto number : {&ConstantRateSegment::t_begin, &ConstantRateSegment::t_end}) {
    if (const int order = compare_values(a.*number, b.*number); order != 0) {
      return order;
    }
  }
  if (const int order = compare_vectors({a.rate, {}, {}}, {b.rate, {}, {}}); order != 0) {
    return order;
  }
  for (const auto vector : {&ConstantRateSegment::p_WQ, &ConstantRateSegment::p_BQ,
                            &ConstantRateSegment::velocity, &ConstantRateSegment::axis}) {
    if (const int order = compare_vectors(a.*vector, b.*vector); order != 0) {
      return order;
    }
  }
  const int order = compare_vectors(a.rotation[0], b.rotation[0]);
  return order != 0 ? order : compare_vectors(a.rotation[1], b.rotation[1]);
}

}  // namespace

Motion::Motion(std::vector<double> breaks, std::vector<ConstantRateSegment> segments)
    : breaks_(std::move(breaks)), segments_(std::move(segments)) {}

Motion Motion::fixed(const Pose& pose) {
  require_pose(pose);
  return {{0.0, 1.0}, {at_rest(pose)}};
}

Motion Motion::constant_velocity(const Pose& start, const Eigen::Vector3d& translation,
                                 const Eigen::Vector3d& rotation_vector) {
  require_pose(start);
  require_coordinates(translation, "translation");
  require(rotation_vector.norm() <= kMaximumAngle,
          "rotation_vector must be finite and at most 1e8 rad long");
  return {{0.0, 1.0},
          {constant_velocity_segment(start, DoubleDoubleVector3(translation),
                                     axis_angle(rotation_vector))}};
}

Motion Motion::constant_rates(std::span<const ConstantRatePiece> pieces,
                              const Eigen::Vector3d& p_BQ) {
  require(!pieces.empty() && pieces.back().t_end == 1.0,
          "a motion of constant rates needs at least one piece, and the last one ends at 1");
  require_coordinates(p_BQ, "p_BQ");
  std::vector<double> breaks{0.0};
  std::vector<ConstantRateSegment> segments;
  for (const ConstantRatePiece& piece : pieces) {
    require(piece.t_end > breaks.back(), "the ends of a motion's pieces must increase");
    require_pose(piece.X_WB);
    require_coordinates(piece.translation, "translation");
    require(piece.rotation_vector.norm() <= kMaximumAngle,
            "rotation_vector must be finite and at most 1e8 rad long");
    ConstantRateSegment s = constant_velocity_segment(
        piece.X_WB, DoubleDoubleVector3(piece.translation), axis_angle(piece.rotation_vector));
    move_pivot(s, p_BQ);
    segments.push_back(pieces.size() == 1 ? s : over(s, breaks.back(), piece.t_end));
    breaks.push_back(piece.t_end);
  }
  return {std::move(breaks), std::move(segments)};
}

Motion Motion::constant_velocity(const Pose& from, const Pose& to) {
  require_pose(from);
  require_pose(to);
  return {{0.0, 1.0}, {between_constant_velocity(from, to)}};
}

Motion Motion::screw(const Pose& start, const Eigen::Vector3d& axis_point,
                     const Eigen::Vector3d& axis_direction, double angle, double translation) {
  require_pose(start);
  require_coordinates(axis_point, "axis_point");
  require_coordinates(axis_direction, "axis_direction");
  require(axis_direction.cwiseAbs().maxCoeff() > 0.0, "axis_direction must not be zero");
  require(std::abs(angle) <= kMaximumAngle, "angle must be finite and at most 1e8 rad in size");
  require(std::abs(translation) <= kMaximumCoordinate,
          "translation must be finite and at most 1e60 in size");
  AxisAngle turn = axis_angle(axis_direction);
  const bool backwards = angle < 0.0;
  turn.angle = std::abs(angle);
  turn.axis = DoubleDouble(backwards ? -1.0 : 1.0) * turn.axis;
  return {{0.0, 1.0},
          {screw_segment(start, DoubleDoubleVector3(axis_point), turn,
                         backwards ? -translation : translation)}};
}

Motion Motion::screw(const Pose& from, const Pose& to) {
  require_pose(from);
  require_pose(to);
  return {{0.0, 1.0}, {between_screw(from, to)}};
}

Motion Motion::waypoints(std::span<const double> times, std::span<const Pose> poses,
                         Between between) {
  require(!poses.empty() && times.size() == poses.size(),
          "waypoints need as many times as poses, and at least one");
  for (std::size_t i = 0; i < times.size(); ++i) {
    require(times[i] >= 0.0 && times[i] <= 1.0, "waypoint times must lie in [0, 1]");
    require(times[i] == 0.0 || times[i] >= kLeastTime,
            "a waypoint time must be 0 or at least 1e-200 of the step");
    require(i == 0 || times[i] > times[i - 1], "waypoint times must increase");
    require_pose(poses[i]);
  }
  std::vector<double> breaks{0.0};
  std::vector<ConstantRateSegment> segments;
  const auto append = [&](const ConstantRateSegment& s, double t_end) {
    segments.push_back(over(s, breaks.back(), t_end));
    breaks.push_back(t_end);
  };
  if (times.front() > 0.0) {
    append(at_rest(poses.front()), times.front());
  }
  for (std::size_t i = 1; i < poses.size(); ++i) {
    append(between_poses(poses[i - 1], poses[i], between), times[i]);
  }
  if (times.back() < 1.0) {
    append(at_rest(poses.back()), 1.0);
  }
  return {std::move(breaks), std::move(segments)};
}

ConstantRatePath Motion::path(std::size_t piece, const Eigen::Vector3d& p_BC) const {
  return {segments_.at(piece), p_BC};
}

Pose Motion::pose(double t) const {
  const double clamped = t > 0.0 ? std::min(t, 1.0) : 0.0;
  const auto after = std::upper_bound(breaks_.begin() + 1, breaks_.end() - 1, clamped);
  const ConstantRatePath origin(segments_[after - breaks_.begin() - 1], Eigen::Vector3d::Zero());
  return {(origin.pivot(clamped) + origin.precise_lever(clamped)).value(),
          Eigen::Quaterniond(origin.state(clamped).R_WB)};
}

int Motion::compare(const Motion& other) const {
  if (segments_.size() != other.segments_.size()) {
    return segments_.size() < other.segments_.size() ? -1 : 1;
  }
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    if (const int order = compare_segments(segments_[i], other.segments_[i]); order != 0) {
      return order;
    }
  }
  return 0;
}

}  // namespace firstcontact
