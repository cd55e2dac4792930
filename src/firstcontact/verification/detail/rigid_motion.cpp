#include <firstcontact/verification/detail/rigid_motion.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

/// Least rotation vector; the square of a shorter one would underflow.
constexpr double kLeastTurn = 0x1p-300;  // [rad]

IntervalVector3 zero_vector() { return {}; }

IntervalVector3 negative(const IntervalVector3& v) { return Interval(-1.0) * v; }

/// Encloses asin(x) of a small x: x <= asin(x) <= x (1 + x^2) for 0 <= x <= 0.5.
Interval small_arcsine(const Interval& x) {
  const double most = x.magnitude();
  if (!(most <= 0.5)) {
    return {};
  }
  return x * Interval(1.0, (Interval(1.0) + sqr(Interval(most))).upper());
}

/// The angle from 0 to pi whose sine and cosine are proportional to y >= 0 and x.
///
/// An estimate is corrected by the arc sine of the sine of its error.
Interval angle_of(const Interval& y, const Interval& x) {
  const Interval estimate(std::atan2(y.midpoint(), x.midpoint()));
  const Interval r = sqrt(sqr(x) + sqr(y));
  return estimate + small_arcsine((y * cos(estimate) - x * sin(estimate)) / r);
}

/// Half angle below which series are more precise than quotients of sines [rad].
constexpr double kSmallAngle = 0x1p-10;

/// Encloses sin(s x) / (s sin(x)) - 1 for 0 <= s <= 1.
///
/// For small x it is x^2 (1 - s^2) / 6 times a number from 1 to 1 + x^2 / 2. The next term is x^2
/// (7 - 3 s^2) / 60 times that. All others are positive and fall as quickly.
Interval sine_ratio_less_one(const Interval& s, const Interval& x) {
  if (x.magnitude() <= kSmallAngle) {
    const Interval square = sqr(x);
    const Interval more(1.0, (Interval(1.0) + Interval(0.5) * square).upper());
    return square * (Interval(1.0) - sqr(s)) / Interval(6.0) * more;
  }
  const Interval ratio = s == Interval(0.0) ? x / sin(x) : sin(s * x) / (s * sin(x));
  return ratio - Interval(1.0);
}

/// The sign of the first component that is not zero; it decides which way an axis points.
int first_sign(const IntervalVector3& v) {
  for (const Interval& component : v.c) {
    if (component.lower() > 0.0) {
      return 1;
    }
    if (component.upper() < 0.0) {
      return -1;
    }
    if (component != Interval(0.0)) {
      break;
    }
  }
  throw UncertainMotion("which way half a turn goes is within the rounding");
}

}  // namespace

RigidMotion::RigidMotion(double from, double to, const Pose& X_WB, const OriginWay& way,
                         const Turn& turn, const Eigen::Vector3d& p_BC)
    : CoveredMotion(from, to),
      position_(X_WB.position),
      R_(exact_rotation(X_WB.rotation)),
      p_BC_W_(R_ * enclose(p_BC)),
      way_(way),
      turn_(turn) {
  if (turn.off > 0.0) {
    for (IntervalVector3& column : R_.columns) {
      column = inflated(column, 2.0 * turn.off);
    }
    p_BC_W_ = R_ * enclose(p_BC);
  }
  if (from < to) {
    per_length_ = Interval(1.0) / (Interval(to) - Interval(from));
  }
  spin_ = (per_length_ * turn.angle) * turn.axis;
  if (turn.angle == Interval(0.0)) {
    way_.to_axis.reset();
    return;
  }
  if (way_.to_axis) {
    // The point of the axis that is nearest to the pivot.
    const IntervalVector3 lever = p_BC_W_ - *way_.to_axis;
    way_.to_axis = *way_.to_axis + dot(lever, turn.axis) * turn.axis;
    lever_ = norm(p_BC_W_ - *way_.to_axis).upper();
  } else if (way_.across) {
    half_sine_ = sin(Interval(0.5) * turn.angle);
    lever_ = (norm(*way_.across) / (Interval(2.0) * abs(half_sine_)) + norm(p_BC_W_)).upper();
  } else {
    lever_ = norm(p_BC_W_).upper();
  }
}

Interval RigidMotion::part(double time) const {
  if (time == from()) {
    return Interval(0.0);
  }
  return time == to() ? Interval(1.0) : (Interval(time) - Interval(from())) * per_length_;
}

IntervalVector3 RigidMotion::turned(const IntervalVector3& v, const Interval& angle) const {
  return angle == Interval(0.0) ? v : firstcontact::rotated(turn_.axis, angle, v);
}

/// The change of a vector by a turn, precise for small turns, as `turned` less the vector is not.
IntervalVector3 RigidMotion::change(const IntervalVector3& v, const Interval& angle) const {
  const IntervalVector3 once = cross(turn_.axis, v);
  const Interval versine = Interval(2.0) * sqr(sin(Interval(0.5) * angle));
  return sin(angle) * once + versine * cross(turn_.axis, once);
}

// For an arc the chord to the part s of an angle w is sin(s w / 2) / sin(w / 2) as long as the
// whole one, and is turned against it by (s - 1) w / 2. The difference from s times the chord is
// small where w is, and so is the effect of an uncertain axis on it.
IntervalTransform RigidMotion::enclosure(double time, const Eigen::Vector3d& origin) const {
  const Interval s = part(time);
  const Interval angle = s * turn_.angle;
  IntervalTransform X{detail::rotated(turn_.axis, angle, R_),
                      (enclose(position_) - enclose(origin)) + s * way_.translation};
  if (way_.to_axis) {
    X.position = X.position + *way_.to_axis + turned(p_BC_W_ - *way_.to_axis, angle);
    return X;
  }
  X.position = X.position + turned(p_BC_W_, angle);
  if (way_.across) {
    const Interval back = Interval(0.5) * (s - Interval(1.0)) * turn_.angle;
    const IntervalVector3 turn = change(*way_.across, back);
    const Interval more = s * sine_ratio_less_one(s, Interval(0.5) * turn_.angle);
    X.position = X.position + more * *way_.across + (s + more) * turn;
  }
  return X;
}

RigidMotion::Rates RigidMotion::rates(double time) const {
  const Interval s = part(time);
  const Interval angle = s * turn_.angle;
  const IntervalVector3 lever = way_.to_axis ? p_BC_W_ - *way_.to_axis : p_BC_W_;
  Rates rates{.velocity = per_length_ * way_.translation, .spin = spin_, .lever = lever_};
  if (turn_.angle == Interval(0.0)) {
    return rates;
  }
  rates.velocity = rates.velocity + cross(spin_, turned(lever, angle));
  if (way_.across) {
    const Interval half_angle = Interval(0.5) * angle;
    const IntervalVector3 turn = change(*way_.across, half_angle - Interval(0.5) * turn_.angle);
    const Interval rate_more = sine_ratio_less_one(Interval(0.0), Interval(0.5) * turn_.angle);
    const Interval rate = Interval(1.0) + rate_more;
    const Interval versine = Interval(2.0) * sqr(sin(Interval(0.5) * half_angle));
    const Interval along_more = rate_more - rate * versine;  // rate cos(half_angle) - 1
    const IntervalVector3 more = along_more * *way_.across + (Interval(1.0) + along_more) * turn +
                                 (rate * sin(half_angle)) * cross(turn_.axis, *way_.across + turn);
    rates.velocity = rates.velocity + per_length_ * more;
  }
  return rates;
}

BodyInstant RigidMotion::around(double time, double, const Eigen::Vector3d& origin) const {
  BodyInstant now = instant_of(enclosure(time, origin));
  const Rates rates = this->rates(time);
  now.velocity = middle(rates.velocity, now.velocity_error);
  now.spin = middle(rates.spin, now.spin_error);
  now.lever = rates.lever;
  now.tracking = tracking_;
  return now;
}

bool RigidMotion::rests() const {
  const auto is_zero = [](const Interval& x) { return x == Interval(0.0); };
  return turn_.angle == Interval(0.0) && turn_.off == 0.0 && !way_.across &&
         std::all_of(way_.translation.c.begin(), way_.translation.c.end(), is_zero);
}

Turn turn_of(const Eigen::Vector3d& rotation_vector) {
  const double size = rotation_vector.cwiseAbs().maxCoeff();
  if (!(size >= kLeastTurn)) {
    return {.axis = zero_vector(), .off = 2.0 * size};
  }
  const Interval angle = norm(enclose(rotation_vector));
  return {.axis = (Interval(1.0) / angle) * enclose(rotation_vector), .angle = angle};
}

Turn least_turn(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::Vector4d a = from.coeffs();
  const Eigen::Vector4d b = to.coeffs();
  if (a == b || a == -b) {
    return {};
  }
  // Up to conj(from), of any length.
  const IntervalVector3 p = enclose(Eigen::Vector3d(from.vec()));
  const IntervalVector3 q = enclose(Eigen::Vector3d(to.vec()));
  const Interval p_w(from.w());
  const Interval q_w(to.w());
  Interval w = p_w * q_w + dot(p, q);
  IntervalVector3 v = p_w * q + negative(q_w * p) + negative(cross(q, p));
  if (w.upper() < 0.0) {
    w = -w;
    v = negative(v);
  } else if (w == Interval(0.0)) {
    v = first_sign(v) > 0 ? v : negative(v);
  } else if (!(w.lower() > 0.0)) {
    throw UncertainMotion("which way half a turn goes is within the rounding");
  }
  const Interval length = norm(v);
  if (!(length.lower() > 0.0)) {
    // Twice the half angle, whose tangent is at least itself.
    return {.axis = zero_vector(), .off = (Interval(2.0) * length / w).upper()};
  }
  return {.axis = (Interval(1.0) / length) * v, .angle = Interval(2.0) * angle_of(length, w)};
}

RigidMotion motion_between(double from, double to, const Pose& X_from, const Pose& X_to,
                           Between between, const Eigen::Vector3d& p_BC) {
  const Turn turn = least_turn(X_from.rotation, X_to.rotation);
  OriginWay way{.translation = enclose(X_to.position) - enclose(X_from.position)};
  if (between == Between::screw && turn.angle != Interval(0.0)) {
    way.across = way.translation - dot(way.translation, turn.axis) * turn.axis;
  } else if (between == Between::screw && turn.off > 0.0) {
    // The arc differs from its chord by at most a quarter of the angle times the chord.
    way.translation =
        inflated(way.translation, (norm(way.translation) * Interval(turn.off)).upper());
  }
  return {from, to, X_from, way, turn, p_BC};
}

namespace {

class MotionPieces {
 public:
  MotionPieces(double duration, const Eigen::Vector3d& p_BC) : duration_(duration), p_BC_(p_BC) {}

  std::vector<RigidMotion> operator()(const FixedMotion& motion) const {
    return {at_rest(0.0, 1.0, motion.pose)};
  }

  std::vector<RigidMotion> operator()(const ConstantVelocityMotion& motion) const {
    return {RigidMotion(0.0, 1.0, motion.from, {.translation = enclose(motion.translation)},
                        turn_of(motion.rotation_vector), p_BC_)};
  }

  std::vector<RigidMotion> operator()(const ScrewMotion& motion) const {
    const IntervalVector3 axis = exact_direction(motion.axis_direction);
    return {RigidMotion(0.0, 1.0, motion.from,
                        {.translation = Interval(motion.translation) * axis,
                         .to_axis = enclose(motion.axis_point) - enclose(motion.from.position)},
                        {.axis = axis, .angle = Interval(motion.angle)}, p_BC_)};
  }

  std::vector<RigidMotion> operator()(const TwoPoseMotion& motion) const {
    return {motion_between(0.0, 1.0, motion.from, motion.to, motion.between, p_BC_)};
  }

  // The quotients of times are rounded, and define the motion as they are.
  std::vector<RigidMotion> operator()(const WaypointMotion& motion) const {
    std::vector<RigidMotion> pieces;
    const auto time = [&](std::size_t k) { return motion.times[k] / duration_; };
    const std::size_t last = motion.times.size() - 1;
    if (time(0) > 0.0) {
      pieces.push_back(at_rest(0.0, time(0), motion.poses[0]));
    }
    for (std::size_t k = 0; k < last; ++k) {
      pieces.push_back(motion_between(time(k), time(k + 1), motion.poses[k], motion.poses[k + 1],
                                      motion.between, p_BC_));
    }
    if (time(last) < 1.0 || pieces.empty()) {
      pieces.push_back(at_rest(time(last), 1.0, motion.poses[last]));
    }
    return pieces;
  }

  std::vector<RigidMotion> operator()(const VertexMotion&) const {
    throw std::invalid_argument("expected a rigid motion");
  }

 private:
  [[nodiscard]] RigidMotion at_rest(double from, double to, const Pose& pose) const {
    return {from, to, pose, {}, {}, p_BC_};
  }

  double duration_;
  Eigen::Vector3d p_BC_;
};

}  // namespace

std::vector<RigidMotion> rigid_motions(const BodyMotion& motion, double duration,
                                       const Eigen::Vector3d& p_BC) {
  return std::visit(MotionPieces(duration, p_BC), motion);
}

}  // namespace firstcontact::detail
