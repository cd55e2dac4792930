#include <firstcontact/robot_check/robot_scene.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/robot/precise_transform.h>
#include <firstcontact/robot/rest.h>

namespace firstcontact {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("RobotScene: " + what);
}

double checked(double value, const std::string& what) {
  if (!(value >= 0.0 && std::isfinite(value))) {
    refuse(what + " must be finite and >= 0, got " + detail::shortest(value));
  }
  return value;
}

std::vector<MemberGeometry> geometries_of(const std::string& name, const Link& link) {
  std::vector<MemberGeometry> geometries;
  for (const LinkGeometry& geometry : link.collision) {
    if (!geometry.shape) {
      refuse("link '" + name + "' has a collision geometry without its shape; load it");
    }
    if (geometry.shape->hierarchy().deforms()) {
      refuse("link '" + name + "' has a shape that deforms; links are rigid");
    }
    geometries.push_back({*geometry.shape, geometry.X_LG});
  }
  return geometries;
}

bool turns(JointType type) { return type != JointType::fixed && type != JointType::prismatic; }

bool slides(JointType type) {
  return type == JointType::prismatic || type == JointType::planar || type == JointType::floating;
}

/// The pose X_WL(t) from a point near the link, where doubles are accurate.
LinkPose link_pose(const RobotMotion& motion, std::size_t link, double t,
                   const Eigen::Vector3d& p_WO) {
  return motion.path(link, t).pose(t, DoubleDoubleVector3(p_WO));
}

Pose carried_pose(const RobotMotion& motion, const BodyStretch::Carried& carried, double t) {
  const LinkPose X_WL = link_pose(motion, carried.link.link, t, Eigen::Vector3d::Zero());
  const Eigen::Quaterniond R_LB = carried.X_LB.rotation.normalized();
  return {X_WL.p_OL + X_WL.R_FL * carried.X_LB.position, Eigen::Quaterniond(X_WL.R_FL) * R_LB};
}

Pose relative_pose(const RobotMotion& motion, std::size_t link, double t, const Pose& X_WB) {
  const LinkPose X_OL = link_pose(motion, link, t, X_WB.position);
  return {-(X_OL.R_FL.transpose() * X_OL.p_OL),
          Eigen::Quaterniond(X_OL.R_FL).conjugate() * X_WB.rotation.normalized()};
}

const BodyStretch& stretch_at(std::span<const BodyStretch> stretches, double t) {
  const auto ends_before = [](const BodyStretch& stretch, double time) {
    return stretch.t_end < time;
  };
  return *std::lower_bound(stretches.begin(), stretches.end() - 1, t, ends_before);
}

}  // namespace

void RobotScene::require_member(std::size_t member) const {
  if (member >= members_.size()) {
    refuse("there is no member " + std::to_string(member));
  }
}

void RobotScene::require_robot(std::size_t robot) const {
  if (robot >= robots_.size()) {
    refuse("there is no robot " + std::to_string(robot));
  }
}

void RobotScene::require_new(const std::string& name) const {
  if (name.empty()) {
    refuse("a name is empty");
  }
  const auto is_taken = [&](const Robot& robot) { return robot.name == name; };
  if (find_member(name) || std::any_of(robots_.begin(), robots_.end(), is_taken)) {
    refuse("the name '" + name + "' is there twice");
  }
}

std::size_t RobotScene::add_body(std::string name, Shape shape, Motion X_WB) {
  require_new(name);
  const FloatEnvironmentGuard guard;
  Member body{.name = std::move(name), .geometries = {}, .link = {}};
  body.geometries.push_back({std::move(shape), {}});
  body.rests = !body.geometries.front().shape.hierarchy().deforms() && firstcontact::rests(X_WB);
  for (std::size_t k = 0; k + 1 < X_WB.breaks().size(); ++k) {
    body.paths.push_back(std::make_shared<const JointPath>(
        JointPath::of_motion({}, X_WB.path(k, Eigen::Vector3d::Zero()))));
  }
  body.motion = std::move(X_WB);
  body.stretches = {{}};
  members_.push_back(std::move(body));
  return members_.size() - 1;
}

std::size_t RobotScene::add_robot(std::string name, RobotMotion motion,
                                  std::span<const DisabledPair> disabled) {
  require_new(name);
  const FloatEnvironmentGuard guard;
  const RobotModel& model = motion.model();
  const std::size_t first = members_.size();
  std::vector<Member> links;
  for (std::size_t k = 0; k < model.links().size(); ++k) {
    const std::string link_name = name + "/" + model.links()[k].name;
    require_new(link_name);
    Member link{.name = link_name,
                .geometries = geometries_of(link_name, model.links()[k]),
                .link = RobotLink{robots_.size(), k}};
    for (const MemberGeometry& geometry : link.geometries) {
      link.paths.push_back(std::make_shared<const JointPath>(
          JointPath::rigid(model.from_rigid_root(k) * precise(geometry.X_MG))));
    }
    links.push_back(std::move(link));
  }
  for (const DisabledPair& pair : disabled) {
    if (std::max(pair.link, pair.other) >= links.size()) {
      refuse("robot '" + name + "' has no link " + std::to_string(std::max(pair.link, pair.other)));
    }
    rules_.ignore({first + pair.link, first + pair.other});
  }
  std::move(links.begin(), links.end(), std::back_inserter(members_));
  std::vector<TrackingError> errors(model.joints().size());
  robots_.push_back({std::move(name), std::move(motion), first, std::move(errors)});
  return robots_.size() - 1;
}

void RobotScene::set_motion(std::size_t robot, RobotMotion motion) {
  require_robot(robot);
  // Copies of a model share their links.
  if (motion.model().links().data() != robots_[robot].motion.model().links().data()) {
    refuse("robot '" + robots_[robot].name + "' is another model than that of its new motion");
  }
  robots_[robot].motion = std::move(motion);
  for (const Attachment& attachment : attachments_) {
    divide_into_stretches(attachment.body);
  }
}

void RobotScene::attach(Attachment attachment) {
  require_member(attachment.body);
  require_member(attachment.link);
  for (const std::size_t link : attachment.touch_links) {
    require_member(link);
  }
  const std::string& body = members_[attachment.body].name;
  if (members_[attachment.body].link) {
    refuse("'" + body + "' is a link; only bodies are attached");
  }
  if (geometries(attachment.body).front().shape.hierarchy().deforms()) {
    refuse("'" + body + "' deforms; a link holds rigid bodies only");
  }
  if (!members_[attachment.link].link) {
    refuse("'" + members_[attachment.link].name + "' is no link; it cannot hold '" + body + "'");
  }
  if (!(attachment.t_from >= 0.0 && attachment.t_from < attachment.t_to &&
        attachment.t_to <= 1.0)) {
    refuse("'" + body + "' must be attached from a time to a later one, both in [0, 1]");
  }
  if (attachment.X_LB) {
    if (attachment.t_from > 0.0) {
      refuse("'" + body + "' has a pose in its link: it is held from the start on, t_from = 0");
    }
    (void)Motion::fixed(*attachment.X_LB);  // Refuses a pose that is none.
  }
  for (const Attachment& other : attachments_) {
    if (other.body == attachment.body && attachment.t_from < other.t_to &&
        other.t_from < attachment.t_to) {
      refuse("'" + body + "' is attached twice at a time");
    }
  }
  const auto before = [](const Attachment& a, const Attachment& b) {
    return a.body != b.body ? a.body < b.body : a.t_from < b.t_from;
  };
  const std::size_t changed = attachment.body;
  attachments_.insert(
      std::upper_bound(attachments_.begin(), attachments_.end(), attachment, before),
      std::move(attachment));
  divide_into_stretches(changed);
}

void RobotScene::divide_into_stretches(std::size_t body) {
  const FloatEnvironmentGuard guard;
  members_[body].rests = false;
  std::vector<BodyStretch>& stretches = members_[body].stretches;
  stretches = {{}};
  for (const Attachment& attachment : attachments_) {
    if (attachment.body != body) {
      continue;
    }
    const RobotLink link = *members_[attachment.link].link;
    const RobotMotion& motion = robots_[link.robot].motion;
    const auto frozen = [&] {
      return relative_pose(motion, link.link, attachment.t_from, pose(body, attachment.t_from));
    };
    const BodyStretch::Carried carried{link, attachment.X_LB ? *attachment.X_LB : frozen()};
    stretches.back().t_end = attachment.t_from;
    if (stretches.back().t_begin == stretches.back().t_end) {
      stretches.pop_back();
    }
    stretches.push_back({attachment.t_from, attachment.t_to, carried});
    if (attachment.t_to < 1.0) {
      const Pose X_WB = carried_pose(motion, carried, attachment.t_to);
      stretches.push_back({attachment.t_to, 1.0, BodyStretch::Resting{X_WB}});
    }
  }
}

void RobotScene::set_padding(std::size_t member, double padding) {
  require_member(member);
  members_[member].padding = checked(padding, "padding of '" + members_[member].name + "'");
}

void RobotScene::hold_pair(const BodyPair& members, double distance) {
  require_member(members[0]);
  require_member(members[1]);
  held_[members] = checked(distance, "distance of '" + members_[members[0]].name + "' and '" +
                                         members_[members[1]].name + "'");
}

void RobotScene::set_tracking_error(std::size_t robot, std::string_view joint,
                                    const TrackingError& error) {
  require_robot(robot);
  Robot& changed = robots_[robot];
  const RobotModel& model = changed.motion.model();
  const std::optional<std::size_t> index = model.find_joint(joint);
  const std::string what = "tracking error of joint '" + std::string(joint) + "'";
  if (!index) {
    refuse(what + ": robot '" + changed.name + "' has no such joint");
  }
  const Joint& found = model.joints()[*index];
  if (found.mimic) {
    refuse(what + ": it mimics '" + found.mimic->joint + "', whose error it has");
  }
  if (checked(error.angle, what) > 0.0 && !turns(found.type)) {
    refuse(what + ": the joint does not turn, it has no angle");
  }
  if (checked(error.distance, what) > 0.0 && !slides(found.type)) {
    refuse(what + ": the joint does not slide, it has no distance");
  }
  changed.tracking_errors[*index] = error;
}

std::vector<TrackingError> RobotScene::tracking_errors(std::size_t robot) const {
  const RobotModel& model = robots_[robot].motion.model();
  std::vector<TrackingError> errors = robots_[robot].tracking_errors;
  for (std::size_t j = 0; j < errors.size(); ++j) {
    double multiplier = 1.0;
    std::size_t source = j;
    while (model.joints()[source].mimic) {
      multiplier *= std::abs(model.joints()[source].mimic->multiplier);
      source = model.find_joint(model.joints()[source].mimic->joint).value();
    }
    if (source != j) {
      const TrackingError& of_source = robots_[robot].tracking_errors[source];
      // One of the two is zero: a joint that is mimicked has one coordinate.
      const double error = multiplier * (of_source.angle + of_source.distance) * (1.0 + 0x1p-48);
      errors[j] = tracking_error_of(model.joints()[j], error);
    }
  }
  return errors;
}

std::optional<std::size_t> RobotScene::find_member(std::string_view name) const {
  const auto has_name = [&](const Member& member) { return member.name == name; };
  const auto found = std::find_if(members_.begin(), members_.end(), has_name);
  return found == members_.end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - members_.begin()));
}

const Motion& RobotScene::body_motion(std::size_t member) const {
  return members_[member].motion.value();
}

std::span<const BodyStretch> RobotScene::stretches(std::size_t member) const {
  return members_[member].stretches;
}

std::optional<double> RobotScene::margin(const BodyPair& members) const {
  const Member& a = members_[members[0]];
  const Member& b = members_[members[1]];
  if (a.link && b.link && a.link->robot == b.link->robot) {
    const RobotModel& model = robots_[a.link->robot].motion.model();
    if (model.are_adjacent(a.link->link, b.link->link) ||
        model.rigid_root(a.link->link) == model.rigid_root(b.link->link)) {
      return std::nullopt;
    }
  }
  if (a.rests && b.rests) {
    return std::nullopt;
  }
  const std::optional<double> margin = rules_.margin(members);
  if (!margin) {
    return std::nullopt;
  }
  const auto held = held_.find(members);
  return held != held_.end() ? held->second : *margin + a.padding + b.padding;
}

Pose RobotScene::pose(std::size_t member, double t) const {
  const FloatEnvironmentGuard guard;
  t = std::clamp(t, 0.0, 1.0);
  const Member& moved = members_[member];
  if (moved.link) {
    const LinkPose X_WL =
        link_pose(robots_[moved.link->robot].motion, moved.link->link, t, Eigen::Vector3d::Zero());
    return {X_WL.p_OL, Eigen::Quaterniond(X_WL.R_FL)};
  }
  const BodyStretch& stretch = stretch_at(moved.stretches, t);
  if (const auto* carried = std::get_if<BodyStretch::Carried>(&stretch.how)) {
    return carried_pose(robots_[carried->link.robot].motion, *carried, t);
  }
  const auto* resting = std::get_if<BodyStretch::Resting>(&stretch.how);
  return resting != nullptr ? resting->X_WB : moved.motion->pose(t);
}

Pose RobotScene::geometry_pose(std::size_t member, std::size_t geometry, double t) const {
  const Pose X_WM = pose(member, t);
  const Pose& X_MG = geometries(member)[geometry].X_MG;
  const Eigen::Quaterniond R_WM = X_WM.rotation.normalized();
  return {X_WM.position + R_WM * X_MG.position, R_WM * X_MG.rotation.normalized()};
}

}  // namespace firstcontact
