#include <firstcontact/retiming/retiming_scene.h>

#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/scene/trajectory.h>

namespace firstcontact {
namespace {

constexpr const char* kRoot = "world";  // Not the name of a link: links are ROBOT/NAME.

const RobotModel& model_of(const RetimingScene& where, std::size_t robot) {
  if (robot >= where.scene.robot_count()) {
    throw std::invalid_argument("expected a robot of the scene, got number " +
                                std::to_string(robot));
  }
  return where.scene.robot_motion(robot).model();
}

/// Adds a robot, on a fixed joint that comes behind its own joints.
void add_robot(const std::string& name, const RobotModel& model, RobotDescription& joined) {
  const std::string begin = name + "/";
  for (const Link& link : model.links()) {
    joined.links.push_back({.name = begin + link.name});
  }
  for (Joint joint : model.joints()) {
    joint.name = begin + joint.name;
    joint.parent = begin + joint.parent;
    joint.child = begin + joint.child;
    if (joint.mimic) {
      joint.mimic->joint = begin + joint.mimic->joint;
    }
    joined.joints.push_back(std::move(joint));
  }
  joined.joints.push_back(
      {.name = begin, .parent = kRoot, .child = begin + model.links()[model.root()].name});
}

/// A coordinate of one of several robots.
struct RobotCoordinate {
  std::size_t which = 0;  ///< Index among the robots that move.
  std::string name;       ///< Name in that robot.
};

/// The coordinate of a robot for one of the joined model.
///
/// @param coordinate  a coordinate of the joined model
RobotCoordinate own_coordinate(const RetimingScene& where, JointCoordinate coordinate) {
  for (std::size_t which = 0;; ++which) {
    const RobotModel& model = model_of(where, where.robots[which]);
    if (coordinate.joint < model.joints().size()) {
      return {which, coordinate_name(model, coordinate)};
    }
    coordinate.joint -= model.joints().size() + 1;  // The joint that add_robot() appends.
  }
}

/// Appends a column of numbers; nothing for rates that the points do not have.
void append_column(const TimedMotion& motion, std::size_t column, TimedMotion& part) {
  for (std::size_t k = 0; k < motion.points.size(); ++k) {
    for (const auto numbers :
         {&TimedPoint::positions, &TimedPoint::velocities, &TimedPoint::accelerations}) {
      const std::vector<double>& all = motion.points[k].*numbers;
      if (!all.empty()) {
        (part.points[k].*numbers).push_back(all.at(column));
      }
    }
  }
}

}  // namespace

RobotModel joined_model(const RetimingScene& where) {
  if (where.robots.empty()) {
    throw std::invalid_argument("expected a robot that moves, got none");
  }
  if (where.robots.size() == 1) {
    return model_of(where, where.robots.front());
  }
  RobotDescription joined{.name = {}, .links = {{.name = kRoot}}, .joints = {}};
  for (const std::size_t robot : where.robots) {
    const RobotModel& model = model_of(where, robot);
    const std::string& name = where.scene.robot_name(robot);
    joined.name += (joined.name.empty() ? "" : " and ") + name;
    add_robot(name, model, joined);
  }
  return RobotModel(std::move(joined));
}

std::vector<TimedMotion> split_motion(const TimedMotion& motion, const RetimingScene& where) {
  if (where.robots.size() == 1) {
    return {motion};
  }
  const RobotModel joined = joined_model(where);
  TimedMotion without_joints;
  for (const TimedPoint& point : motion.points) {
    without_joints.points.push_back({.time = point.time});
  }
  std::vector<TimedMotion> parts(where.robots.size(), without_joints);
  for (std::size_t column = 0; column < motion.joint_names.size(); ++column) {
    const auto [which, name] =
        own_coordinate(where, find_coordinate(joined, motion.joint_names[column]));
    parts[which].joint_names.push_back(name);
    append_column(motion, column, parts[which]);
  }
  return parts;
}

}  // namespace firstcontact
