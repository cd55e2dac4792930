#include <firstcontact/articulated/robot_description.h>

#include <array>
#include <cmath>
#include <map>
#include <string_view>

namespace firstcontact {
namespace {

using Defect = std::optional<RobotDefect>;
using Index = std::map<std::string, std::size_t, std::less<>>;

/// Beyond these sizes motions refuse coordinates and quaternions.
constexpr double kGreatest = 1e60;
constexpr double kLeast = 1e-60;

Defect at_joint(std::size_t joint, const std::string& message) {
  return RobotDefect{.message = message, .joint = joint, .link = {}};
}

Defect at_link(std::size_t link, const std::string& message) {
  return RobotDefect{.message = message, .joint = {}, .link = link};
}

bool is_length(double size) { return size >= kLeast && size <= kGreatest; }  // False for NaN.

bool is_pose(const Pose& pose) {
  return pose.position.allFinite() && pose.position.cwiseAbs().maxCoeff() <= kGreatest &&
         pose.rotation.coeffs().allFinite() &&
         is_length(pose.rotation.coeffs().cwiseAbs().maxCoeff());
}

bool is_finite(const std::optional<double>& x) { return !x || std::abs(*x) <= kGreatest; }
bool is_not_negative(const std::optional<double>& x) { return !x || (*x >= 0.0 && is_finite(x)); }

std::string wrong_limits(const JointLimits& limits) {
  if (!is_finite(limits.lower) || !is_finite(limits.upper)) {
    return "its limits must be finite";
  }
  if (limits.lower && limits.upper && *limits.lower > *limits.upper) {
    return "its lower limit is above its upper limit";
  }
  if (!is_not_negative(limits.velocity) || !is_not_negative(limits.effort)) {
    return "its velocity and effort limits must be finite and >= 0";
  }
  return {};
}

/// Empty if the joint's own numbers are sound.
std::string wrong_number(const Joint& joint) {
  if (!is_pose(joint.X_PJ)) {
    return "its origin must be finite, at most 1e60 in size, and its quaternion not zero";
  }
  if (!joint.axis.allFinite() || !is_length(joint.axis.cwiseAbs().maxCoeff())) {
    return "its axis must be finite and not zero";
  }
  if (!(std::abs(joint.pitch) <= kGreatest)) {
    return "its pitch must be finite";
  }
  return wrong_limits(joint.limits);
}

/// The link names, each once.
Defect index_links(const RobotDescription& robot, Index& links) {
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const std::string& name = robot.links[i].name;
    if (name.empty()) {
      return at_link(i, "a link has no name; give it one");
    }
    if (!links.emplace(name, i).second) {
      return at_link(i, "two links are named '" + name + "'; rename one of them");
    }
    for (const LinkGeometry& geometry : robot.links[i].collision) {
      if (!is_pose(geometry.X_LG)) {
        return at_link(i, "link '" + name + "': a collision geometry has no finite pose");
      }
    }
  }
  return {};
}

Defect index_joints(const RobotDescription& robot, Index& joints) {
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const Joint& joint = robot.joints[j];
    if (joint.name.empty()) {
      return at_joint(j, "a joint has no name; give it one");
    }
    if (!joints.emplace(joint.name, j).second) {
      return at_joint(j, "two joints are named '" + joint.name + "'; rename one of them");
    }
    if (const std::string wrong = wrong_number(joint); !wrong.empty()) {
      return at_joint(j, "joint '" + joint.name + "': " + wrong);
    }
  }
  return {};
}

/// Fills in each link's parent joint.
Defect connect(const RobotDescription& robot, const Index& links,
               std::vector<std::optional<std::size_t>>& parent_joint) {
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const Joint& joint = robot.joints[j];
    for (const std::string* end : {&joint.parent, &joint.child}) {
      if (links.find(*end) == links.end()) {
        const char* role = end == &joint.parent ? "parent" : "child";
        return at_joint(j, "joint '" + joint.name + "': its " + role + " link '" + *end +
                               "' is not a link of the robot");
      }
    }
    std::optional<std::size_t>& parent = parent_joint[links.find(joint.child)->second];
    if (parent) {
      return at_joint(j, "joint '" + joint.name + "': its child link '" + joint.child +
                             "' already hangs on joint '" + robot.joints[*parent].name +
                             "'; a link has one parent");
    }
    parent = j;
  }
  return {};
}

/// Every link hangs on the one root.
Defect check_tree(const RobotDescription& robot, const Index& links,
                  const std::vector<std::optional<std::size_t>>& parent_joint) {
  std::optional<std::size_t> root;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    std::size_t link = i;
    for (std::size_t steps = 0; parent_joint[link]; ++steps) {
      const Joint& joint = robot.joints[*parent_joint[link]];
      if (steps > robot.links.size()) {
        return at_joint(*parent_joint[link], "joint '" + joint.name +
                                                 "' is part of a loop of links; remove a joint "
                                                 "of the loop");
      }
      link = links.find(joint.parent)->second;
    }
    if (root && *root != link) {
      return at_link(link, "links '" + robot.links[*root].name + "' and '" +
                               robot.links[link].name +
                               "' both have no parent; connect them by a joint");
    }
    root = link;
  }
  return {};
}

Defect check_mimics(const RobotDescription& robot, const Index& joints) {
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    std::size_t at = j;
    for (std::size_t steps = 0; robot.joints[at].mimic; ++steps) {
      const Joint& joint = robot.joints[at];
      const std::string place = "joint '" + joint.name + "': ";
      const auto source = joints.find(joint.mimic->joint);
      if (source == joints.end()) {
        return at_joint(at, place + "it mimics '" + joint.mimic->joint +
                                "', which is not a joint of the robot");
      }
      if (coordinate_count(joint.type) != 1 ||
          coordinate_count(robot.joints[source->second].type) != 1) {
        return at_joint(at, place + "only joints of one coordinate mimic and are mimicked");
      }
      if (!is_finite(joint.mimic->multiplier) || !is_finite(joint.mimic->offset)) {
        return at_joint(at, place + "multiplier and offset of its mimic must be finite");
      }
      if (steps > robot.joints.size()) {
        return at_joint(at, place + "it mimics itself, by way of other joints");
      }
      at = source->second;
    }
  }
  return {};
}

}  // namespace

std::size_t coordinate_count(JointType type) {
  switch (type) {
    case JointType::revolute:
    case JointType::continuous:
    case JointType::prismatic:
    case JointType::screw:
      return 1;
    case JointType::planar:
      return 3;
    case JointType::fixed:
    case JointType::floating:
    case JointType::ball:
      return 0;
  }
  return 0;
}

const char* to_string(JointType type) {
  constexpr std::array<const char*, 8> kWords = {"fixed", "revolute", "continuous", "prismatic",
                                                 "screw", "planar",   "floating",   "ball"};
  return kWords[static_cast<std::size_t>(type)];
}

Defect find_defect(const RobotDescription& robot) {
  if (robot.links.empty()) {
    return RobotDefect{.message = "the robot has no link", .joint = {}, .link = {}};
  }
  Index links;
  Index joints;
  std::vector<std::optional<std::size_t>> parent_joint(robot.links.size());
  if (Defect defect = index_links(robot, links)) {
    return defect;
  }
  if (Defect defect = index_joints(robot, joints)) {
    return defect;
  }
  if (Defect defect = connect(robot, links, parent_joint)) {
    return defect;
  }
  if (Defect defect = check_tree(robot, links, parent_joint)) {
    return defect;
  }
  return check_mimics(robot, joints);
}

}  // namespace firstcontact
