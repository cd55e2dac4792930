#include <firstcontact/robot/link_path.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/robot/detail/chain_bounds.h>
#include <firstcontact/robot/detail/chain_walk.h>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// [-]  Rounding of a few operations on vectors of three.
constexpr double kRounding = 0x1p-49;

/// [-]  Factor that covers sums and products of the bounds of some hundred joints.
constexpr double kUp = 1.0 + 0x1p-40;

constexpr double kHalfTurn = 3.141592653589793;

Matrix3d cross_matrix(const Vector3d& w) {
  Matrix3d m;
  m << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0;
  return m;
}

}  // namespace

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

LinkScratch::LinkScratch() : memory_(std::make_unique<detail::ChainMemory>()) {}
LinkScratch::~LinkScratch() = default;
LinkScratch::LinkScratch(LinkScratch&&) noexcept = default;
LinkScratch& LinkScratch::operator=(LinkScratch&&) noexcept = default;

void LinkScratch::forget() { memory_->forget(); }

LinkState LinkPath::state(double t, LinkScratch& scratch, const DoubleDoubleVector3& p_FO) const {
  return scratch.memory().walk(joints_, t, p_FO).end().state();
}

DoubleDoubleVector3 LinkPath::anchor() const {
  return joints_.empty() ? DoubleDoubleVector3() : DoubleDoubleVector3(joints_.front()->anchor());
}

const ConstantRatePath* LinkPath::constant_rates() const {
  return joints_.size() == 1 ? joints_.front()->free_body() : nullptr;
}

LinkPose LinkPath::pose(double t, const DoubleDoubleVector3& p_FO) const {
  return detail::walk_along(joints_, t, p_FO).state().pose;
}

LinkWindow LinkPath::window(double t, double t_from, double t_to, const RoundedBox& box,
                            LinkScratch& scratch, const DoubleDoubleVector3& p_FO) const {
  assert(t_begin_ <= t_from && t_from <= t && t <= t_to && t_to <= t_end_);
  detail::ChainMemory& memory = scratch.memory();
  const auto walked = memory.walk(joints_, t, p_FO);
  const LinkState end = walked.end().state();
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
  const double e = (box.centre.norm() + box.reach()) * kUp;
  const double w = detail::rough_size(end.spin) + end.spin_error;
  const double turn = detail::rough_size(end.spin_rate) + end.spin_rate_error + w * w;
  const double relative = end.pose.rotation_error + 8.0 * kRounding;
  window.speed_error_ = (end.velocity_error + 8.0 * kRounding * detail::rough_size(end.velocity) +
                         (end.spin_error + w * relative) * e) *
                        kUp;
  window.acceleration_error_ =
      (end.acceleration_error + 8.0 * kRounding * detail::rough_size(end.acceleration) +
       (end.spin_rate_error + 2.0 * w * end.spin_error + turn * relative) * e) *
      kUp;

  const double T = std::max(t_to - t, t - t_from) * kUp;
  const LinkPose& pose = end.pose;
  const Vector3d centre = pose.p_OL + pose.R_FL * box.centre;
  const double reach = box.reach();
  detail::ChainBounds chain(box.centre.norm() + reach, reach, T);
  std::size_t at = walked.last;
  for (std::size_t k = joints_.size(); k-- > 0; at = walked.nodes[at].parent) {
    const detail::PassedJoint& place = walked.nodes[at].passed;
    if (joints_[k]->rest() != nullptr) {
      chain.pass_rest(place.step + place.lever);
      continue;
    }
    const JointBounds& bounds = memory.bounds(walked.nodes[at], *joints_[k], t_from, t_to);
    const Vector3d arm = centre - place.p_OQ;
    const double error = 2.0 * pose.position_error +
                         (pose.rotation_error + 8.0 * kRounding) * (arm.norm() + box.centre.norm());
    chain.pass(bounds, arm.cross(place.axis).norm() + error, place.step, place.lever);
  }
  window.bounds_ = chain.bounds();
  window.per_metre_ = chain.per_metre();
  return window;
}

LinkPath::Swept LinkPath::swept(double t, double t_from, double t_to, const RoundedBox& box,
                                LinkScratch& scratch) const {
  const auto walked = scratch.memory().walk(joints_, t, {});
  const detail::ChainWalk& end = walked.end();
  const double T = std::max(t_to - t, t - t_from) * kUp;
  Swept swept;
  swept.pose = end.pose();
  const Vector3d offset = swept.pose.R_FL * box.centre;
  const Vector3d centre = swept.pose.p_OL + offset;
  const double far = detail::rough_size(offset);
  const double reach = box.reach();
  std::size_t at = walked.last;
  for (std::size_t k = joints_.size(); k-- > 0; at = walked.nodes[at].parent) {
    const detail::PassedJoint& place = walked.nodes[at].passed;
    const JointBounds& bounds =
        detail::ChainMemory::bounds(walked.nodes[at], *joints_[k], t_from, t_to);
    if (bounds.angle.rate != 0.0) {
      const Vector3d arm = centre - place.p_OQ;
      const double error =
          2.0 * swept.pose.position_error +
          (swept.pose.rotation_error + 8.0 * kRounding) * (detail::rough_size(arm) + far);
      swept.speed += bounds.angle.rate *
                     (arm.cross(place.axis).norm() + error + reach + swept.speed * T) * kUp;
    }
    swept.speed = (swept.speed + bounds.pivot.rate) * kUp;
  }
  return swept;
}

double LinkPath::tracking_bound(double t, double t_from, double t_to, const RoundedBox& box,
                                std::span<const TrackingError> errors, LinkScratch& scratch) const {
  assert(errors.size() == joints_.size());
  detail::ChainMemory& memory = scratch.memory();
  const auto walked = memory.walk(joints_, t, {});
  const LinkState end = walked.end().state();
  const double T = std::max(t_to - t, t - t_from) * kUp;
  const LinkPose& pose = end.pose;
  const Vector3d centre = pose.p_OL + pose.R_FL * box.centre;
  double v = 0.0;  // Bound for the box's points, as seen from the child.
  double bound = 0.0;
  std::size_t at = walked.last;
  for (std::size_t k = joints_.size(); k-- > 0; at = walked.nodes[at].parent) {
    const detail::PassedJoint& place = walked.nodes[at].passed;
    const JointBounds& bounds = memory.bounds(walked.nodes[at], *joints_[k], t_from, t_to);
    const Vector3d arm = centre - place.p_OQ;
    const double error =
        2.0 * pose.position_error +
        (pose.rotation_error + 8.0 * kRounding) * (arm.norm() + place.lever + box.centre.norm());
    const double from_axis = arm.cross(place.axis).norm() + error + box.reach() + v * T;
    const double rho = joints_[k]->has_axis()
                           ? from_axis
                           : (centre - place.p_OL).norm() + error + box.reach() + v * T;
    const double chord = 2.0 * std::sin(0.5 * std::min(errors[k].angle, kHalfTurn));
    bound += (chord * rho + errors[k].distance) * kUp;
    v = (bounds.pivot.rate + v + bounds.angle.rate * from_axis) * kUp;
  }
  return bound * kUp;
}

double LinkWindow::support(const RoundedBox& box, const Vector3d& n, const Vector3d& linear,
                           const Matrix3d& angular) const {
  // n . (linear + angular e) for e in the box about R centre.
  const Vector3d pull = angular.transpose() * n;
  const Vector3d along = box.axes * (pose_.R_FL.transpose() * pull);
  return n.dot(linear) + pull.dot(pose_.R_FL * box.centre) +
         box.half_extents.dot(along.cwiseAbs()) + box.radius * pull.norm();
}

DirectedBound LinkWindow::displacement(const RoundedBox& box, const Vector3d& n) const {
  const double speed = support(box, n, velocity_, spin_) + speed_error_;
  const double acceleration = support(box, n, acceleration_, spin_rate_) + acceleration_error_ +
                              kUp * bounds_.jerk * (t_to_ - t_) / 3.0;
  return {std::min(speed, bounds_.rate), std::min(acceleration, bounds_.acceleration)};
}

double LinkWindow::speed_bound(const RoundedBox& box, const Vector3d& n) const {
  double most = 0.0;
  bool first = true;
  for (const double dt : {t_from_ - t_, t_to_ - t_}) {
    // Between the two ends a maximum of linear functions is no greater than at one of them.
    const double size = std::abs(dt);
    const double at_end = support(box, n, velocity_ + dt * acceleration_, spin_ + dt * spin_rate_) +
                          speed_error_ + kUp * size * acceleration_error_;
    most = first ? at_end : std::max(most, at_end);
    first = false;
  }
  const double T = std::max(t_to_ - t_, t_ - t_from_);
  return std::min(most + kUp * 0.5 * bounds_.jerk * T * T, bounds_.rate);
}

}  // namespace firstcontact
