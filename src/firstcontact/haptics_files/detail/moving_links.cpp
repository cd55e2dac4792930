#include <firstcontact/haptics_files/detail/moving_links.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

using Eigen::Isometry3d;

Isometry3d isometry_of(const Pose& pose) {
  return Eigen::Translation3d(pose.position) * pose.rotation.normalized();
}

Pose pose_of(const Isometry3d& X) {
  return {X.translation(), Eigen::Quaterniond(X.linear()).normalized()};
}

/// A joint as a function of the coordinate of a joint that grips move: multiplier q + offset.
struct Driven {
  std::size_t joint = 0;  ///< Index in the tool.
  double multiplier = 1.0;
  double offset = 0.0;
};

class MovingLinksFinder {
 public:
  MovingLinksFinder(const RobotScene& robots, std::size_t robot, const SceneRobot& described,
                    HapticToolQuestion& tool)
      : robots_(robots),
        robot_(robot),
        described_(described),
        model_(described.model),
        tool_(tool) {}

  MovingLinks find() {
    find_joints();
    find_mimics();
    MovingLinks found{.body = body(), .number = {}};
    add_below(model_.root(), {}, found);
    require_start();
    return found;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument("haptics: robot " + in_quotes(described_.name) + ": " + what);
  }

  void find_joints() {
    for (HapticGripQuestion& grip : tool_.grips) {
      for (HapticGripJoint& moved : grip.joints) {
        const Joint& joint = model_.joints()[moved.joint];
        const double start =
            robots_.robot_motion(robot_).coordinate(moved.joint).front().state(0.0).value.hi;
        const bool slides = joint.type == JointType::prismatic;
        constexpr double kOfSlide = 1000.0;  // [N/m]
        driven_[moved.joint] = {.joint = tool_.joints.size()};
        tool_.joints.push_back({.joint = moved.joint,
                                .name = joint.name,
                                .start = start,
                                .lower = joint.limits.lower,
                                .upper = joint.limits.upper,
                                .stiffness = grip.stiffness.value_or(slides ? kOfSlide : 1.0)});
        moved.joint = tool_.joints.size() - 1;
      }
    }
  }

  /// Finds the joints that follow others, which may follow others in turn.
  void find_mimics() {
    for (std::size_t round = 0; round < model_.joints().size(); ++round) {
      for (std::size_t k = 0; k < model_.joints().size(); ++k) {
        const Joint& joint = model_.joints()[k];
        if (!joint.mimic || driven_.contains(k)) {
          continue;
        }
        const auto of = model_.find_joint(joint.mimic->joint);
        const auto found = of ? driven_.find(*of) : driven_.end();
        if (found != driven_.end()) {
          const double multiplier = joint.mimic->multiplier;
          driven_[k] = {.joint = found->second.joint,
                        .multiplier = multiplier * found->second.multiplier,
                        .offset = multiplier * found->second.offset + joint.mimic->offset};
          narrow(joint.limits, driven_[k]);
        }
      }
    }
  }

  /// Applies the limits of a joint that follows to the joint that it follows.
  void narrow(const JointLimits& limits, const Driven& driven) {
    HapticToolJoint& joint = tool_.joints[driven.joint];
    if (driven.multiplier == 0.0) {
      return;
    }
    const auto of = [&](const std::optional<double>& limit) {
      return limit ? std::optional((*limit - driven.offset) / driven.multiplier) : std::nullopt;
    };
    std::optional<double> lower = of(limits.lower);
    std::optional<double> upper = of(limits.upper);
    if (driven.multiplier < 0.0) {
      std::swap(lower, upper);
    }
    if (lower) {
      joint.lower = std::max(joint.lower.value_or(*lower), *lower);
    }
    if (upper) {
      joint.upper = std::min(joint.upper.value_or(*upper), *upper);
    }
  }

  void require_start() const {
    for (const HapticToolJoint& joint : tool_.joints) {
      if ((joint.lower && joint.start < *joint.lower) ||
          (joint.upper && joint.start > *joint.upper)) {
        fail("joint " + in_quotes(joint.name) + " starts at " + write_json(joint.start) +
             ", out of its limits " + (joint.lower ? write_json(*joint.lower) : "none") + " to " +
             (joint.upper ? write_json(*joint.upper) : "none") +
             "; give its \"state\" another position");
      }
    }
  }

  [[nodiscard]] Isometry3d placed(std::size_t link) const {
    return isometry_of(robots_.pose(robots_.first_member(robot_) + link, 0.0));
  }

  [[nodiscard]] bool has_geometry(std::size_t link) const {
    return !robots_.geometries(robots_.first_member(robot_) + link).empty();
  }

  [[nodiscard]] bool is_moved(std::size_t link) const {
    for (auto joint = model_.parent_joint(link); joint;
         joint = model_.parent_joint(model_.parent_link(*joint))) {
      if (driven_.contains(*joint)) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] std::size_t body() const {
    for (std::size_t link = 0; link < model_.links().size(); ++link) {
      if (has_geometry(link) && !is_moved(link)) {
        return link;
      }
    }
    fail("expected a link with a geometry that no grip moves");
  }

  /// Adds the links below one, depth first: a parent stands before its children.
  ///
  /// @param link    of the robot
  /// @param parent  of the tool: the link itself, or the link to which it is fixed
  void add_below(std::size_t link, std::optional<std::size_t> parent, MovingLinks& found) {
    if (link == model_.root() && has_geometry(link) && link != found.body) {
      parent = add(link, {}, {}, found);
    }
    for (std::size_t joint = 0; joint < model_.joints().size(); ++joint) {
      if (model_.parent_link(joint) != link) {
        continue;
      }
      const std::size_t child = model_.child_link(joint);
      const auto driven = driven_.find(joint);
      const bool is_needed =
          driven != driven_.end() || (has_geometry(child) && child != found.body);
      add_below(child,
                is_needed
                    ? add(child, parent, driven == driven_.end() ? nullptr : &driven->second, found)
                    : parent,
                found);
    }
  }

  std::size_t add(std::size_t link, std::optional<std::size_t> parent, const Driven* driven,
                  MovingLinks& found) {
    const Isometry3d X_WP = parent ? placed(found.number[*parent]) : placed(model_.root());
    HapticToolLink made{.parent = parent};
    if (driven == nullptr) {
      made.X_PJ = pose_of(X_WP.inverse() * placed(link));
    } else {
      const std::size_t number = *model_.parent_joint(link);
      const Joint& joint = model_.joints()[number];
      made.axis = joint.axis.normalized();
      made.joint = driven->joint;
      const bool turns = joint.type != JointType::prismatic;
      const double pitch = joint.type == JointType::screw ? joint.pitch : 0.0;
      made.turn = turns ? driven->multiplier : 0.0;
      made.slide = driven->multiplier * (turns ? pitch : 1.0);
      const double slid = driven->offset * (turns ? pitch : 1.0);
      const Isometry3d X_PJ = X_WP.inverse() * placed(model_.parent_link(number)) *
                              isometry_of(joint.X_PJ) * Eigen::Translation3d(slid * made.axis) *
                              Eigen::AngleAxisd(turns ? driven->offset : 0.0, made.axis);
      made.X_PJ = pose_of(X_PJ);
    }
    tool_.links.push_back(made);
    found.number.push_back(link);
    return tool_.links.size() - 1;
  }

  const RobotScene& robots_;
  std::size_t robot_;
  const SceneRobot& described_;
  const RobotModel& model_;
  HapticToolQuestion& tool_;
  std::map<std::size_t, Driven> driven_;
};

}  // namespace

MovingLinks find_moving_links(const RobotScene& robots, std::size_t robot,
                              const SceneRobot& described, HapticToolQuestion& tool) {
  return MovingLinksFinder(robots, robot, described, tool).find();
}

bool are_connected(const HapticToolQuestion& tool, std::optional<std::size_t> a,
                   std::optional<std::size_t> b) {
  const auto rigid_root = [&](std::optional<std::size_t> link) {
    while (link && !tool.links[*link].joint) {
      link = tool.links[*link].parent;
    }
    return link;
  };
  return rigid_root(a) == rigid_root(b) || (a && tool.links[*a].parent == b) ||
         (b && tool.links[*b].parent == a);
}

}  // namespace firstcontact::detail
