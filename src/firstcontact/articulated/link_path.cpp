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

/// At least the length, without a square root: errors need not be tight.
double size(const Vector3d& v) { return v.lpNorm<1>(); }

}  // namespace

/// Newton-Euler's recursion from F outwards: place and derivatives of the last link reached, and
/// the sums of the sizes of all that enters them, from which the errors follow.
///
/// Derivation of the errors: vectors r of the chain are within e |r|, e the error of the last
/// rotation, the greatest; rates of joints within d, summed over the joints; axes like vectors.
/// Each term of v is a product of one rate and one vector, within (2 e + d / rate) of its size; of
/// al two rates and an axis; of a two rates or their derivative, two axes and a vector. Roundings
/// are some dozen of each term, and two for each sum that a joint adds to.
struct LinkPath::Walk {
  Matrix3d R = Matrix3d::Identity();
  Vector3d p = Vector3d::Zero();
  Vector3d v = Vector3d::Zero();
  Vector3d a = Vector3d::Zero();
  Vector3d w = Vector3d::Zero();
  Vector3d al = Vector3d::Zero();

  double rotation_error = 0.0;
  double position_error = 0.0;  ///< By rotations and pivots.
  double length = 0.0;          ///< [m]  Of the chain.
  double speed = 0.0;           ///< At least |v|, and what cancelled in it; the same of the others.
  double acceleration = 0.0;
  double spin = 0.0;
  double spin_rate = 0.0;
  double sliding = 0.0;
  double spin_error = 0.0;  ///< By the rates of joints; the same of the others.
  double spin_rate_error = 0.0;
  double sliding_error = 0.0;
  double sliding_rate_error = 0.0;

  /// From the origin of the link reached to a point r that is fixed in it.
  void move(const Vector3d& r) {
    const Vector3d velocity = w.cross(r);
    a += al.cross(r) + w.cross(velocity);
    v += velocity;
    p += r;
    const double far = size(r);
    length += far;
    speed += spin * far;
    acceleration += (spin_rate + spin * spin) * far;
    position_error += rotation_error * far;
  }

  /// The point slides in the link.
  void slide(const JointState& joint) {
    const Vector3d velocity = R * joint.pivot_velocity;
    const Vector3d rate = R * joint.pivot_acceleration;
    a += 2.0 * w.cross(velocity) + rate;
    v += velocity;
    const double fast = size(velocity);
    speed += fast;
    sliding += fast;
    acceleration += 2.0 * spin * fast + size(rate);
    sliding_error += joint.pivot_velocity_error;
    sliding_rate_error +=
        joint.pivot_acceleration_error + 2.0 * (spin + spin_error) * joint.pivot_velocity_error;
  }

  void turn(const JointState& joint, const Vector3d& axis) {
    const Vector3d rate = joint.rate * axis;
    al += w.cross(rate) + joint.acceleration * axis;
    w += rate;
    const double fast = std::abs(joint.rate);
    spin_rate_error += joint.acceleration_error + spin * joint.rate_error + spin_error * fast +
                       spin_error * joint.rate_error;
    spin_rate += spin * fast + std::abs(joint.acceleration);
    spin += fast;
    spin_error += joint.rate_error;
    R = (R * joint.R_PL).eval();
    rotation_error += kRotationStep + joint.angle_error;
  }

  /// @param joints  how many were passed
  [[nodiscard]] LinkState state(std::size_t joints) const {
    constexpr double kSecondOrder = 1.0 + 0x1p-30;
    const double rounding = static_cast<double>(joints + 2) * kRounding;
    const double e = rotation_error + 0x1p-51;
    LinkState state;
    state.pose = {R, p, rotation_error, (position_error + rounding * length) * kSecondOrder};
    state.velocity = v;
    state.acceleration = a;
    state.spin = w;
    state.spin_rate = al;
    state.velocity_error =
        ((2.0 * e + rounding) * speed + spin_error * length + sliding_error) * kSecondOrder;
    state.acceleration_error =
        ((4.0 * e + rounding) * acceleration +
         (spin_rate_error + (2.0 * spin + spin_error) * spin_error) * length +
         2.0 * spin_error * sliding + sliding_rate_error) *
        kSecondOrder;
    state.spin_error = ((e + rounding) * spin + spin_error) * kSecondOrder;
    state.spin_rate_error = ((2.0 * e + rounding) * spin_rate + spin_rate_error) * kSecondOrder;
    return state;
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

LinkState LinkPath::walk(double t, const DoubleDoubleVector3& p_FO, LinkScratch* scratch) const {
  Walk walk;
  const DoubleDoubleVector3 p_OF = DoubleDouble(-1.0) * p_FO;
  if (joints_.empty()) {
    walk.move(p_OF.value());
  }
  const double far = size(p_FO.value());
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const JointState joint = joints_[k]->state(t);
    // F does not turn, so that large numbers cancel before they are rounded.
    const Vector3d step = (k == 0 ? p_OF + joint.p_PQ : joint.p_PQ).value();
    walk.position_error += joint.position_error + 0x1p-90 * (size(joint.p_PQ.value()) + far);
    walk.move(walk.R * step);
    if (joint.slides) {
      walk.slide(joint);
    }
    const Vector3d axis = walk.R * joint.axis;
    const Vector3d lever = walk.R * joint.p_QL;  // In the parent's axes: before the turn.
    if (scratch != nullptr) {
      scratch->places_[k] = {walk.p, axis, step.norm(), lever.norm(), walk.p + lever};
    }
    walk.turn(joint, axis);
    walk.move(lever);
  }
  return walk.state(joints_.size());
}

LinkState LinkPath::state(double t, const DoubleDoubleVector3& p_FO) const {
  return walk(t, p_FO, nullptr);
}

const ConstantRatePath* LinkPath::constant_rates() const {
  return joints_.size() == 1 ? joints_.front()->free_body() : nullptr;
}

LinkPose LinkPath::pose(double t, const DoubleDoubleVector3& p_FO) const {
  return walk(t, p_FO, nullptr).pose;
}

LinkWindow LinkPath::window(double t, double t_from, double t_to, const LinkPart& part,
                            LinkScratch& scratch, const DoubleDoubleVector3& p_FO) const {
  assert(t_begin_ <= t_from && t_from <= t && t <= t_to && t_to <= t_end_);
  scratch.places_.resize(joints_.size());
  const LinkState end = walk(t, p_FO, &scratch);
  LinkWindow window;
  window.t_ = t;
  window.t_from_ = t_from;
  window.t_to_ = t_to;
  window.pose_ = end.pose;
  window.velocity_ = end.velocity;
  window.acceleration_ = end.acceleration;
  window.spin_ = cross_matrix(end.spin);
  window.spin_rate_ = cross_matrix(end.spin_rate) + window.spin_ * window.spin_;
  // A point at offset e: errors of its velocity and acceleration, and of their products with n.
  const double e = (part.centre.norm() + part.reach()) * kUp;
  const double w = size(end.spin) + end.spin_error;
  const double turn = size(end.spin_rate) + end.spin_rate_error + w * w;
  const double relative = end.pose.rotation_error + 8.0 * kRounding;
  window.speed_error_ = (end.velocity_error + 8.0 * kRounding * size(end.velocity) +
                         (end.spin_error + w * relative) * e) *
                        kUp;
  window.acceleration_error_ =
      (end.acceleration_error + 8.0 * kRounding * size(end.acceleration) +
       (end.spin_rate_error + 2.0 * w * end.spin_error + turn * relative) * e) *
      kUp;

  const double T = std::max(t_to - t, t - t_from) * kUp;
  const LinkPose& pose = end.pose;
  const Vector3d centre = pose.p_OL + pose.R_FL * part.centre;
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
    const double error = 2.0 * pose.position_error + (pose.rotation_error + 8.0 * kRounding) *
                                                         (arm.norm() + part.centre.norm());
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
  const LinkState end = walk(t, {}, &scratch);
  const double T = std::max(t_to - t, t - t_from) * kUp;
  const LinkPose& pose = end.pose;
  const Vector3d centre = pose.p_OL + pose.R_FL * part.centre;
  double v = 0.0;  // Of the part's points, as seen from the child.
  double bound = 0.0;
  for (std::size_t k = joints_.size(); k-- > 0;) {
    const LinkScratch::JointPlace& place = scratch.places_[k];
    const JointBounds bounds = joints_[k]->bounds(t_from, t_to);
    const Vector3d arm = centre - place.p_OQ;
    const double error =
        2.0 * pose.position_error +
        (pose.rotation_error + 8.0 * kRounding) * (arm.norm() + place.lever + part.centre.norm());
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
