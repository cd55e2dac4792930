#include <firstcontact/robot/robot_description.h>

#include <array>
#include <cmath>
#include <map>
#include <string_view>

namespace firstcontact {
namespace {

using Index = std::map<std::string, std::size_t, std::less<>>;

/// Motions refuse coordinates and quaternions beyond these sizes.
constexpr double kGreatest = 1e60;
constexpr double kLeast = 1e-60;

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

/// Describes what is wrong with the joint's own numbers; empty if they are sound.
std::string wrong_number(const Joint& joint) {
  if (!is_pose(joint.X_PJ)) {
    return "its origin must be finite, at most 1e60 in size, and its quaternion not zero";
  }
  if (!joint.axis.allFinite() || joint.axis.isZero(0.0)) {
    return "its axis must be finite and not zero";
  }
  if (!is_length(joint.axis.cwiseAbs().maxCoeff())) {
    return "its axis must be from 1e-60 to 1e60 in size; give it the length 1";
  }
  if (!(std::abs(joint.pitch) <= kGreatest)) {
    return "its pitch must be finite";
  }
  return wrong_limits(joint.limits);
}

/// State of a link or joint in a walk along parents, or along mimicked joints.
enum class Visit { none, open, done };

/// Collects defects, step by step: each step needs the parts that those before it found sound.
class DefectSearch {
 public:
  explicit DefectSearch(const RobotDescription& robot)
      : robot_(robot), parent_joint_(robot.links.size()) {}

  std::vector<RobotDefect> run() {
    if (robot_.links.empty()) {
      defects_.push_back({.message = "the robot has no link", .joint = {}, .link = {}});
      return std::move(defects_);
    }
    index_links();
    index_joints();
    connect();
    if (defects_.empty()) {
      check_tree();
      check_mimics();
    }
    return std::move(defects_);
  }

 private:
  void at_joint(std::size_t joint, const std::string& message) {
    defects_.push_back({.message = message, .joint = joint, .link = {}});
  }

  void at_link(std::size_t link, const std::string& message) {
    defects_.push_back({.message = message, .joint = {}, .link = link});
  }

  [[nodiscard]] std::string place(std::size_t joint) const {
    return "joint '" + robot_.joints[joint].name + "': ";
  }

  void index_links() {
    for (std::size_t i = 0; i < robot_.links.size(); ++i) {
      const std::string& name = robot_.links[i].name;
      if (name.empty()) {
        at_link(i, "a link has no name; give it one");
      } else if (!links_.emplace(name, i).second) {
        at_link(i, "two links are named '" + name + "'; rename one of them");
      }
      for (const LinkGeometry& geometry : robot_.links[i].collision) {
        if (!is_pose(geometry.X_LG)) {
          at_link(i, "link '" + name + "': a collision geometry has no finite pose");
        }
      }
    }
  }

  void index_joints() {
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      const Joint& joint = robot_.joints[j];
      if (joint.name.empty()) {
        at_joint(j, "a joint has no name; give it one");
      } else if (!joints_.emplace(joint.name, j).second) {
        at_joint(j, "two joints are named '" + joint.name + "'; rename one of them");
      }
      if (const std::string wrong = wrong_number(joint); !wrong.empty()) {
        at_joint(j, place(j) + wrong);
      }
    }
  }

  /// Fills in each link's parent joint.
  void connect() {
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      const Joint& joint = robot_.joints[j];
      for (const std::string* end : {&joint.parent, &joint.child}) {
        if (links_.find(*end) == links_.end()) {
          const char* role = end == &joint.parent ? "parent" : "child";
          at_joint(j, place(j) + "its " + role + " link '" + *end + "' is not a link of the robot");
        }
      }
      const auto child = links_.find(joint.child);
      if (child == links_.end()) {
        continue;
      }
      std::optional<std::size_t>& parent = parent_joint_[child->second];
      if (parent) {
        at_joint(j, place(j) + "its child link '" + joint.child + "' already hangs on joint '" +
                        robot_.joints[*parent].name + "'; a link has one parent");
      } else {
        parent = j;
      }
    }
  }

  /// Checks that every link hangs on the one root. Each link is visited once.
  void check_tree() {
    std::optional<std::size_t> root;
    std::vector<Visit> visits(robot_.links.size(), Visit::none);
    std::vector<std::size_t> path;
    for (std::size_t i = 0; i < robot_.links.size(); ++i) {
      path.clear();
      std::size_t link = i;
      while (visits[link] == Visit::none) {
        visits[link] = Visit::open;
        path.push_back(link);
        if (parent_joint_[link]) {
          link = links_.find(robot_.joints[*parent_joint_[link]].parent)->second;
        } else if (root) {
          at_link(link, "links '" + robot_.links[*root].name + "' and '" + robot_.links[link].name +
                            "' both have no parent; connect them by a joint");
        } else {
          root = link;
        }
      }
      if (visits[link] == Visit::open && parent_joint_[link]) {
        at_joint(*parent_joint_[link],
                 "joint '" + robot_.joints[*parent_joint_[link]].name +
                     "' is part of a loop of links; remove a joint of the loop");
      }
      for (const std::size_t passed : path) {
        visits[passed] = Visit::done;
      }
    }
  }

  void check_mimics() {
    std::vector<Visit> visits(robot_.joints.size(), Visit::none);
    std::vector<std::size_t> path;
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      path.clear();
      std::optional<std::size_t> at = j;
      while (at && visits[*at] == Visit::none) {
        visits[*at] = Visit::open;
        path.push_back(*at);
        at = mimicked(*at);
      }
      if (at && visits[*at] == Visit::open) {
        const bool at_once = mimicked(*at) == at;
        at_joint(*at, place(*at) + "it mimics itself" +
                          (at_once ? "; name another joint" : ", by way of other joints"));
      }
      for (const std::size_t passed : path) {
        visits[passed] = Visit::done;
      }
    }
  }

  /// The joint that a joint mimics, if that makes sense.
  std::optional<std::size_t> mimicked(std::size_t j) {
    const Joint& joint = robot_.joints[j];
    if (!joint.mimic) {
      return {};
    }
    const auto source = joints_.find(joint.mimic->joint);
    if (source == joints_.end()) {
      at_joint(j, place(j) + "it mimics '" + joint.mimic->joint +
                      "', which is not a joint of the robot");
      return {};
    }
    if (coordinate_count(joint.type) != 1 ||
        coordinate_count(robot_.joints[source->second].type) != 1) {
      at_joint(j, place(j) + "only joints of one coordinate mimic and are mimicked");
      return {};
    }
    if (!is_finite(joint.mimic->multiplier) || !is_finite(joint.mimic->offset)) {
      at_joint(j, place(j) + "multiplier and offset of its mimic must be finite");
      return {};
    }
    return source->second;
  }

  const RobotDescription& robot_;
  std::vector<RobotDefect> defects_;
  Index links_;
  Index joints_;
  std::vector<std::optional<std::size_t>> parent_joint_;
};

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

const char* to_string(JointType type) { return kJointTypeWords[static_cast<std::size_t>(type)]; }

std::vector<RobotDefect> find_defects(const RobotDescription& robot) {
  return DefectSearch(robot).run();
}

std::optional<RobotDefect> find_defect(const RobotDescription& robot) {
  const std::vector<RobotDefect> defects = find_defects(robot);
  return defects.empty() ? std::nullopt : std::optional(defects.front());
}

}  // namespace firstcontact
