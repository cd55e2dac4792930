#include <firstcontact/articulated/link_path.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A few rounded operations on vectors of three.
constexpr double kRounding = 0x1p-49;

/// One joint's rotation, its product with those before it, and what hangs on it: 24 2^-53 for each
/// of three columns, 9 2^-53 for the product.
constexpr double kRotationStep = 0x1p-47;

/// Sums and products of up to some hundred joints' bounds.
constexpr double kUp = 1.0 + 0x1p-40;

constexpr double kHalfTurn = 3.141592653589793;

Matrix3d cross_matrix(const Vector3d& w) {
  Matrix3d m;
  m << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0;
  return m;
}

/// A vector and how far it may be from exact.
struct Uncertain {
  Vector3d value = Vector3d::Zero();
  double error = 0.0;

  [[nodiscard]] double most() const { return value.norm() + error; }

  void add(const Vector3d& term, double term_error) {
    value += term;
    error += term_error + kRounding * (value.norm() + term.norm());
  }
};

/// a x b, with both factors uncertain; second-order terms included.
Uncertain cross(const Uncertain& a, const Uncertain& b) {
  return {a.value.cross(b.value),
          a.error * b.most() + a.most() * b.error + kRounding * a.most() * b.most()};
}

Uncertain scaled(double factor, double factor_error, const Uncertain& a) {
  return {factor * a.value, std::abs(factor) * a.error + factor_error * a.most() +
                                kRounding * std::abs(factor) * a.most()};
}

}  // namespace

/// Newton-Euler's recursion from F outwards: place and twist of the last link reached.
struct LinkPath::Walk {
  Matrix3d R = Matrix3d::Identity();
  double rotation_error = 0.0;
  Uncertain p;
  Uncertain v;
  Uncertain a;
  Uncertain w;
  Uncertain al;

  /// R y for a vector y of the link reached.
  [[nodiscard]] Uncertain rotated(const Vector3d& y, double y_error) const {
    const double size = y.norm();
    return {R * y, rotation_error * size + (1.0 + rotation_error) * y_error + kRounding * size};
  }

  /// From the origin of the link reached to a point that is fixed in it.
  void move(const Uncertain& r) {
    const Uncertain speed = cross(w, r);
    const Uncertain inward = cross(w, speed);
    const Uncertain turning = cross(al, r);
    a.add(inward.value, inward.error);
    a.add(turning.value, turning.error);
    v.add(speed.value, speed.error);
    p.add(r.value, r.error);
  }

  /// The point slides in the link.
  void slide(const Uncertain& velocity, const Uncertain& acceleration) {
    const Uncertain coriolis = cross(w, velocity);
    a.add(2.0 * coriolis.value, 2.0 * coriolis.error);
    a.add(acceleration.value, acceleration.error);
    v.add(velocity.value, velocity.error);
  }

  void turn(const JointState& joint, const Uncertain& axis) {
    const Uncertain rate = scaled(joint.rate, joint.rate_error, axis);
    const Uncertain swing = cross(w, rate);
    const Uncertain acceleration = scaled(joint.acceleration, joint.acceleration_error, axis);
    al.add(swing.value, swing.error);
    al.add(acceleration.value, acceleration.error);
    w.add(rate.value, rate.error);
    R = (R * joint.R_PL).eval();
    rotation_error += kRotationStep + joint.angle_error;
  }
};

LinkPath::LinkPath(double t_begin, double t_end,
                   std::vector<std::shared_ptr<const JointPath>> joints)
    : t_begin_(t_begin), t_end_(t_end), joints_(std::move(joints)) {}

LinkPath LinkPath::then(const PreciseTransform& X_LG) const {
  return then(std::make_shared<const JointPath>(JointPath::rigid(X_LG)));
}

LinkPath LinkPath::then(std::shared_ptr<const JointPath> X_LG) const {
  std::vector<std::shared_ptr<const JointPath>> joints;
  joints.reserve(joints_.size() + 1);
  joints = joints_;
  joints.push_back(std::move(X_LG));
  return {t_begin_, t_end_, std::move(joints)};
}

LinkPath::Walk LinkPath::walk(double t, const DoubleDoubleVector3& p_FO,
                              LinkScratch* scratch) const {
  Walk walk;
  const DoubleDoubleVector3 p_OF = DoubleDouble(-1.0) * p_FO;
  if (joints_.empty()) {
    walk.p.add(p_OF.value(), 0.0);
  }
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const JointState joint = joints_[k]->state(t);
    // F does not turn, so that large numbers cancel before they are rounded.
    const DoubleDoubleVector3 step = k == 0 ? p_OF + joint.p_PQ : joint.p_PQ;
    const double error =
        joint.position_error + 0x1p-90 * (joint.p_PQ.value().norm() + p_FO.value().norm());
    walk.move(walk.rotated(step.value(), error));
    walk.slide(walk.rotated(joint.pivot_velocity, joint.pivot_velocity_error),
               walk.rotated(joint.pivot_acceleration, joint.pivot_acceleration_error));
    const Uncertain axis = walk.rotated(joint.axis, 0x1p-51);
    const Vector3d lever = walk.R * joint.p_QL;  // In the parent's axes: before the turn.
    const double lever_length = joint.p_QL.norm();
    if (scratch != nullptr) {
      scratch->places_[k] = {walk.p.value, axis.value, step.value().norm(), lever_length,
                             walk.p.value + lever};
    }
    walk.turn(joint, axis);
    walk.move({lever, (walk.rotation_error + kRounding) * lever_length});
  }
  return walk;
}

LinkState LinkPath::state(double t, const DoubleDoubleVector3& p_FO) const {
  const Walk end = walk(t, p_FO, nullptr);
  return {{end.R, end.p.value, end.rotation_error, end.p.error},
          end.v.value,
          end.a.value,
          end.w.value,
          end.al.value,
          end.v.error,
          end.a.error,
          end.w.error,
          end.al.error};
}

const ConstantRatePath* LinkPath::constant_rates() const {
  return joints_.size() == 1 ? joints_.front()->free_body() : nullptr;
}

LinkPose LinkPath::pose(double t, const DoubleDoubleVector3& p_FO) const {
  const Walk end = walk(t, p_FO, nullptr);
  return {end.R, end.p.value, end.rotation_error, end.p.error};
}

LinkWindow LinkPath::window(double t, double t_from, double t_to, const LinkPart& part,
                            LinkScratch& scratch, const DoubleDoubleVector3& p_FO) const {
  assert(t_begin_ <= t_from && t_from <= t && t <= t_to && t_to <= t_end_);
  scratch.places_.resize(joints_.size());
  const Walk end = walk(t, p_FO, &scratch);
  LinkWindow window;
  window.t_ = t;
  window.t_from_ = t_from;
  window.t_to_ = t_to;
  window.pose_ = {end.R, end.p.value, end.rotation_error, end.p.error};
  window.velocity_ = end.v.value;
  window.acceleration_ = end.a.value;
  window.spin_ = cross_matrix(end.w.value);
  window.spin_rate_ = cross_matrix(end.al.value) + window.spin_ * window.spin_;
  // A point at offset e: errors of its velocity and acceleration, and of their products with n.
  const double e = (part.centre.norm() + part.reach()) * kUp;
  const double w = end.w.most();
  const double turn = end.al.most() + w * w;
  const double relative = end.rotation_error + 8.0 * kRounding;
  window.speed_error_ =
      (end.v.error + 8.0 * kRounding * end.v.most() + (end.w.error + w * relative) * e) * kUp;
  window.acceleration_error_ = (end.a.error + 8.0 * kRounding * end.a.most() +
                                (end.al.error + 2.0 * w * end.w.error + turn * relative) * e) *
                               kUp;

  const double T = std::max(t_to - t, t - t_from) * kUp;
  const Vector3d centre = end.p.value + end.R * part.centre;
  const double reach = part.reach();
  double beyond = part.centre.norm() + reach;  // Of any point from the origin reached.
  double v = 0.0;
  double a = 0.0;
  double j = 0.0;
  for (std::size_t k = joints_.size(); k-- > 0;) {
    const LinkScratch::JointPlace& place = scratch.places_[k];
    const JointBounds bounds = joints_[k]->bounds(t_from, t_to);
    const auto& [w1, w2, w3] = bounds.angle;
    const Vector3d arm = centre - place.p_OQ;
    const double error = 2.0 * end.p.error +
                         (end.rotation_error + 8.0 * kRounding) * (arm.norm() + part.centre.norm());
    beyond += place.lever;
    const double rho = std::min(arm.cross(place.axis).norm() + error + reach + v * T, beyond) * kUp;
    const double turning = std::hypot(w2, w1 * w1) * kUp;
    j = bounds.pivot.jerk + j + 3.0 * w1 * a + 3.0 * turning * v +
        std::hypot(w3 + w1 * w1 * w1, 3.0 * w1 * w2) * kUp * rho;
    a = bounds.pivot.acceleration + a + 2.0 * w1 * v + turning * rho;
    v = bounds.pivot.rate + v + w1 * rho;
    beyond += place.step + bounds.pivot.rate * T;
  }
  window.bounds_ = {v * kUp, a * kUp, j * kUp};
  return window;
}

double LinkPath::tracking_bound(double t, double t_from, double t_to, const LinkPart& part,
                                std::span<const TrackingError> errors, LinkScratch& scratch) const {
  assert(errors.size() == joints_.size());
  scratch.places_.resize(joints_.size());
  const Walk end = walk(t, {}, &scratch);
  const double T = std::max(t_to - t, t - t_from) * kUp;
  const Vector3d centre = end.p.value + end.R * part.centre;
  double v = 0.0;  // Of the part's points, as seen from the child.
  double bound = 0.0;
  for (std::size_t k = joints_.size(); k-- > 0;) {
    const LinkScratch::JointPlace& place = scratch.places_[k];
    const JointBounds bounds = joints_[k]->bounds(t_from, t_to);
    const Vector3d arm = centre - place.p_OQ;
    const double error = 2.0 * end.p.error + (end.rotation_error + 8.0 * kRounding) *
                                                 (arm.norm() + place.lever + part.centre.norm());
    const double from_axis = arm.cross(place.axis).norm() + error + part.reach() + v * T;
    const double rho = joints_[k]->has_axis()
                           ? from_axis
                           : (centre - place.p_OL).norm() + error + part.reach() + v * T;
    const double chord = 2.0 * std::sin(0.5 * std::min(errors[k].angle, kHalfTurn));
    bound += (chord * rho + errors[k].distance) * kUp;
    v = (bounds.pivot.rate + v + bounds.angle.rate * from_axis) * kUp;
  }
  return bound * kUp;
}

double LinkWindow::support(const LinkPart& part, const Vector3d& n, const Vector3d& linear,
                           const Matrix3d& angular) const {
  // n . (linear + angular e) for e in the box about R centre.
  const Vector3d pull = angular.transpose() * n;
  const Vector3d along = part.axes * (pose_.R_FL.transpose() * pull);
  return n.dot(linear) + pull.dot(pose_.R_FL * part.centre) +
         part.half_extents.dot(along.cwiseAbs()) + part.radius * pull.norm();
}

DirectedBound LinkWindow::displacement(const LinkPart& part, const Vector3d& n) const {
  const double T = std::max(t_to_ - t_, 0.0);
  const double speed = support(part, n, velocity_, spin_) + speed_error_;
  const double acceleration = support(part, n, acceleration_, spin_rate_) + acceleration_error_ +
                              kUp * bounds_.jerk * T / 3.0;
  return {std::min(speed, bounds_.rate), std::min(acceleration, bounds_.acceleration)};
}

double LinkWindow::speed_bound(const LinkPart& part, const Vector3d& n) const {
  double most = 0.0;
  bool first = true;
  for (const double dt : {t_from_ - t_, t_to_ - t_}) {
    // Between the two ends a maximum of linear functions is no greater than at one of them.
    const double size = std::abs(dt);
    const double at_end =
        support(part, n, velocity_ + dt * acceleration_, spin_ + dt * spin_rate_) + speed_error_ +
        kUp * size * acceleration_error_;
    most = first ? at_end : std::max(most, at_end);
    first = false;
  }
  const double T = std::max(t_to_ - t_, t_ - t_from_);
  return std::min(most + kUp * 0.5 * bounds_.jerk * T * T, bounds_.rate);
}

}  // namespace firstcontact
