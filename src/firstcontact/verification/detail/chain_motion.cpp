#include <firstcontact/verification/detail/chain_motion.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace firstcontact::detail {
namespace {

/// [-]  Factor that covers the roundings of a sum of a few products that are not negative.
constexpr double kRoundedUp = 1.0 + 0x1p-48;

/// [-]  Bound of the chord of a turn on the unit circle.
double chord_of(double angle) {
  constexpr double kHalfTurn = 3.14;
  return angle < kHalfTurn ? (Interval(2.0) * sin(Interval(0.5) * Interval(angle))).upper() : 2.0;
}

/// A frame of a chain, and bounds of its motion.
class ChainFrame {
  /// A joint that was passed, with its rates.
  struct Passed {
    IntervalVector3 place;                // Place of its axis.
    std::optional<IntervalVector3> axis;  // Axis of a turn, unit; else it may turn about any.
    double turn_rate = 0.0;
    double slide_rate = 0.0;
    TrackingError error;
  };

 public:
  ChainFrame(const RigidMotion* base, double time, double half, const Eigen::Vector3d& origin)
      : time_(time), half_(half) {
    for (std::size_t k = 0; k < 3; ++k) {
      X_.rotation.columns[k].c[k] = Interval(1.0);
    }
    X_.position = Interval(-1.0) * enclose(origin);
    if (base != nullptr) {
      const RigidMotion::Rates rates = base->rates(time);
      X_ = base->enclosure(time, origin);
      velocity_ = rates.velocity;
      spin_ = rates.spin;
      turn_rate_ = norm(spin_).upper();
      acceleration_ = kRoundedUp * turn_rate_ * turn_rate_ * rates.lever;
    }
  }

  void go(const IntervalTransform& step) {
    const IntervalVector3 way = X_.rotation * step.position;
    velocity_ = velocity_ + cross(spin_, way);
    acceleration_ = kRoundedUp * (acceleration_ + turning() * norm(step.position).upper());
    X_ = {X_.rotation * step.rotation, X_.position + way};
  }

  void move(const ChainJoint& joint) {
    Passed& passed = passed_.emplace_back();
    passed.error = joint.error;
    if (joint.free != nullptr) {
      move_freely(*joint.free, passed);
      return;
    }
    for (const ChainJoint::Slide& slide : joint.slides) {
      const CoordinateWindow q = slide.coordinate->around(time_, half_);
      const IntervalVector3 direction = X_.rotation * slide.direction;
      const IntervalVector3 way = q.value * direction;
      velocity_ = velocity_ + cross(spin_, way) + q.rate * direction;
      acceleration_ =
          kRoundedUp * (acceleration_ + turning() * kRoundedUp * q.size +
                        kRoundedUp * (2.0 * turn_rate_ * q.rate_size + q.acceleration_size));
      X_.position = X_.position + way;
      passed.slide_rate += kRoundedUp * q.rate_size;
    }
    passed.place = X_.position;
    passed.axis = X_.rotation * joint.axis;
    if (joint.angle != nullptr) {
      const CoordinateWindow q = joint.angle->around(time_, half_);
      spin_ = spin_ + q.rate * (X_.rotation * joint.axis);
      X_.rotation = X_.rotation * turn(joint.axis, q.value);
      turn_acceleration_ = kRoundedUp * (turn_acceleration_ + kRoundedUp * q.acceleration_size +
                                         kRoundedUp * turn_rate_ * q.rate_size);
      turn_rate_ = kRoundedUp * (turn_rate_ + q.rate_size);
      passed.turn_rate = q.rate_size;
    }
  }

  /// Adds a joint whose child moves at constant rates.
  ///
  /// Derivation: p and R are the child's in J, with the velocity v and the spin u there. In the
  /// world the child's origin accelerates by at most a + (e + w^2) |p| + 2 w |v| + |dv/dt|, and its
  /// spin changes by at most e + w |u|. The origin turns about an axis at the distance `lever`, so
  /// |dv/dt| <= |u|^2 lever. |v| and |p| are those of the middle of the window, plus what they may
  /// change until its ends.
  void move_freely(const RigidMotion& motion, Passed& passed) {
    const RigidMotion::Rates rates = motion.rates(time_);
    const IntervalTransform X = motion.enclosure(time_, Eigen::Vector3d::Zero());
    const double turn_size = norm(rates.spin).upper();
    const double change = kRoundedUp * turn_size * turn_size * rates.lever;
    const double speed = kRoundedUp * (norm(rates.velocity).upper() + half_ * change);
    const double size = kRoundedUp * (norm(X.position).upper() + half_ * speed);
    const IntervalVector3 way = X_.rotation * X.position;
    velocity_ = velocity_ + cross(spin_, way) + X_.rotation * rates.velocity;
    acceleration_ = kRoundedUp * (acceleration_ + turning() * kRoundedUp * size +
                                  kRoundedUp * (2.0 * turn_rate_ * speed + change));
    spin_ = spin_ + X_.rotation * rates.spin;
    turn_acceleration_ = kRoundedUp * (turn_acceleration_ + kRoundedUp * turn_rate_ * turn_size);
    turn_rate_ = kRoundedUp * (turn_rate_ + turn_size);
    X_ = {X_.rotation * X.rotation, X_.position + way};
    passed.place = X_.position;
    passed.turn_rate = turn_size;
    passed.slide_rate = speed;
  }

  [[nodiscard]] const IntervalTransform& transform() const { return X_; }

  [[nodiscard]] BodyInstant instant() const {
    BodyInstant now = instant_of(X_);
    now.velocity = middle(velocity_, now.velocity_error);
    now.spin = middle(spin_, now.spin_error);
    now.constant_rates = false;
    now.acceleration = acceleration_;
    now.turn_acceleration = turning();
    return now;
  }

  /// Adds the bounds of tracking errors.
  ///
  /// Derivation: let e bound how far a point is off, as seen from the child of a joint. An error of
  /// the turn moves the nominal place of the point by at most c d. c is the chord 2 sin(error / 2)
  /// and d the distance of the nominal place from the axis. What the point is off besides turns
  /// with the child and keeps its length. So as seen from the parent it is off by e + c d and the
  /// error of the slide. A point at a distance r from the pivot has a d that is larger by r at
  /// most.
  void add_tracking(BodyInstant& now) const {
    double speed = 0.0;  // Speed of the pivot, as seen from the child of the joint.
    for (std::size_t k = passed_.size(); k-- > 0;) {
      const Passed& joint = passed_[k];
      const IntervalVector3 arm = X_.position - joint.place;
      const double way = kRoundedUp * half_ * speed;
      const double lever = norm(arm).upper() + way;
      const double from_axis = joint.axis ? norm(cross(arm, *joint.axis)).upper() + way : lever;
      const double chord = chord_of(joint.error.angle);
      now.tracking = kRoundedUp * (now.tracking + kRoundedUp * kRoundedUp * chord * from_axis +
                                   joint.error.distance);
      now.turn_tracking = kRoundedUp * (now.turn_tracking + chord);
      speed = kRoundedUp * (speed + kRoundedUp * joint.turn_rate * lever + joint.slide_rate);
    }
  }

 private:
  static IntervalMatrix3 turn(const IntervalVector3& axis, const Interval& angle) {
    IntervalMatrix3 unit;
    for (std::size_t k = 0; k < 3; ++k) {
      unit.columns[k].c[k] = Interval(1.0);
    }
    return detail::rotated(axis, angle, unit);
  }

  /// [1/s^2]  Bound for the present frame, per distance.
  [[nodiscard]] double turning() const {
    return kRoundedUp * (turn_acceleration_ + turn_rate_ * turn_rate_);
  }

  double time_;
  double half_;
  IntervalTransform X_;
  IntervalVector3 velocity_;
  IntervalVector3 spin_;
  double turn_rate_ = 0.0;          // Bounds in the window; so are the others.
  double turn_acceleration_ = 0.0;  // Bound for the turn alone, without w^2.
  double acceleration_ = 0.0;
  std::vector<Passed> passed_;
};

}  // namespace

ChainMotion::ChainMotion(double from, double to, std::shared_ptr<const RigidMotion> base,
                         std::vector<ChainJoint> joints, const IntervalTransform& tail)
    : CoveredMotion(from, to), base_(std::move(base)), joints_(std::move(joints)), tail_(tail) {
  has_errors_ = std::any_of(joints_.begin(), joints_.end(), [](const ChainJoint& joint) {
    return joint.error.angle > 0.0 || joint.error.distance > 0.0;
  });
}

const Eigen::Vector3d& ChainMotion::position() const {
  static const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();
  return base_ ? base_->position() : kOrigin;
}

IntervalTransform ChainMotion::enclosure(double time, const Eigen::Vector3d& origin) const {
  ChainFrame frame(base_.get(), time, 0.0, origin);
  for (const ChainJoint& joint : joints_) {
    frame.go(joint.before);
    frame.move(joint);
  }
  frame.go(tail_);
  return frame.transform();
}

BodyInstant ChainMotion::around(double time, double half, const Eigen::Vector3d& origin) const {
  ChainFrame frame(base_.get(), time, half, origin);
  for (const ChainJoint& joint : joints_) {
    frame.go(joint.before);
    frame.move(joint);
  }
  frame.go(tail_);
  BodyInstant now = frame.instant();
  if (has_errors_) {
    frame.add_tracking(now);
  }
  return now;
}

}  // namespace firstcontact::detail
