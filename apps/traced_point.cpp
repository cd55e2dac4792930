#include "traced_point.h"

#include <algorithm>
#include <set>

#include <Eigen/Geometry>

#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/body_motion.h>
#include <firstcontact/scene/trajectory.h>

namespace firstcontact::app {
namespace {

template <typename Named>
std::size_t number_of(const std::vector<Named>& all, const std::string& name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  return static_cast<std::size_t>(found - all.begin());
}

/// The joints of a robot that are planned, and those that mimic them.
std::set<std::size_t> moving_joints(const RobotModel& model, const std::string& begin,
                                    const std::vector<std::string>& names) {
  std::set<std::size_t> moving;
  for (const std::string& name : names) {
    if (name.starts_with(begin)) {
      moving.insert(find_coordinate(model, name.substr(begin.size())).joint);
    }
  }
  const auto joints = model.joints();
  for (std::size_t joint = 0; joint < joints.size(); ++joint) {
    const auto& mimic = joints[joint].mimic;
    const auto followed = mimic ? model.find_joint(mimic->joint) : std::nullopt;
    if (followed && moving.contains(*followed)) {
      moving.insert(joint);
    }
  }
  return moving;
}

/// The link with geometry that hangs on most joints, of which some move; else the root.
std::size_t traced_link(const RobotModel& model, const std::set<std::size_t>& moving) {
  std::size_t deepest = model.root();
  std::size_t most = 0;
  for (std::size_t link = 0; link < model.links().size(); ++link) {
    const Link& one = model.links()[link];
    const std::vector<std::size_t> chain = model.chain(model.root(), link);
    const bool moves =
        std::ranges::any_of(chain, [&](std::size_t joint) { return moving.contains(joint); });
    if (moves && !one.collision.empty() && chain.size() > most) {
      most = chain.size();
      deepest = link;
    }
  }
  return deepest;
}

TracedPoint point_of_robot(const LoadedScene& loaded, const Movers& movers,
                           const std::string& name) {
  const std::size_t robot = number_of(loaded.scene.robots, name);
  const RobotModel& model = loaded.scene.robots[robot].model;
  const bool is_alone = movers.robots.size() == 1 && movers.body.empty();
  const std::string begin = is_alone ? "" : name + "/";
  const std::size_t member = loaded.robots->first_member(robot) +
                             traced_link(model, moving_joints(model, begin, movers.joints));
  return {.name = loaded.robots->name(member), .member = member};
}

TracedPoint point_of_body(const LoadedScene& loaded, const std::string& name) {
  const std::size_t body = number_of(loaded.scene.bodies, name);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : shape_of_body(loaded, body).mesh().vertices) {
    box.extend(vertex);
  }
  return {.name = name, .member = body, .p_MP = box.center()};
}

}  // namespace

Eigen::Vector3d TracedPoint::at(const Pose& X_WM) const {
  return X_WM.position + X_WM.rotation.normalized() * p_MP;
}

std::vector<TracedPoint> traced_points(const LoadedScene& loaded, const Movers& movers) {
  std::vector<TracedPoint> points;
  if (!movers.body.empty()) {
    points.push_back(point_of_body(loaded, movers.body));
  }
  for (const std::string& robot : movers.robots) {
    points.push_back(point_of_robot(loaded, movers, robot));
  }
  return points;
}

Pose pose_of_member(const LoadedScene& loaded, std::size_t member, double t) {
  return loaded.robots
             ? loaded.robots->pose(member, t)
             : normalised_motion(loaded.scene.bodies[member].motion, loaded.scene.duration).pose(t);
}

}  // namespace firstcontact::app
