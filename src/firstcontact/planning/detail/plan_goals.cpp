#include <firstcontact/planning/detail/plan_goals.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <firstcontact/edges/detail/edge_question.h>
#include <firstcontact/scene/detail/robot_name.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

[[noreturn]] void refuse_goal(const std::string& what) { throw std::invalid_argument(what); }

/// Adds the coordinates of the joints that move a link; for mimic joints those that they mimic.
///
/// Floating and ball joints rest.
void add_joints_below(const RobotModel& model, std::size_t link, std::set<JointCoordinate>& named) {
  for (auto joint = model.parent_joint(link); joint;
       joint = model.parent_joint(model.parent_link(*joint))) {
    std::size_t mover = *joint;
    while (model.joints()[mover].mimic) {
      mover = model.find_joint(model.joints()[mover].mimic->joint).value();
    }
    for (std::size_t index = 0; index < coordinate_count(model.joints()[mover].type); ++index) {
      named.insert({mover, index});
    }
  }
}

/// Refuses a position of a mimic joint that contradicts the planned joint.
void require_mimicked(const ConfigurationSpace& space, const Configuration& goal, std::size_t mover,
                      std::size_t joint, double position) {
  const RobotModel& model = space.model(mover);
  constexpr double kSame = 1e-6;
  double factor = 1.0;
  double shift = 0.0;
  std::size_t source = joint;
  while (const std::optional<Mimic>& mimic = model.joints()[source].mimic) {
    shift += factor * mimic->offset;
    factor *= mimic->multiplier;
    source = model.find_joint(mimic->joint).value();
  }
  const auto coordinates = space.coordinates();
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const double follows = factor * goal[k] + shift;
    if (coordinates[k].mover == mover && coordinates[k].joint == source &&
        std::abs(follows - position) > kSame) {
      refuse_goal("a goal has joint " + in_quotes(model.joints()[joint].name) + " at " +
                  write_json(position) + ", but it mimics " +
                  in_quotes(model.joints()[source].name) + " and is at " + write_json(follows) +
                  " there");
    }
  }
}

/// The index of a number in the pose of a body.
///
/// @param ending  behind the body's name
std::size_t index_in_pose(const std::string& name, const std::string& ending) {
  const std::optional<std::size_t> index = pose_index(ending);
  if (!index) {
    refuse_goal("expected a number of a pose, such as trans_x or rot_w of a body, got " +
                in_quotes(name));
  }
  return *index;
}

/// The number of a configuration that is a coordinate; none where it is not planned.
std::optional<std::size_t> number_in(const ConfigurationSpace& space, std::size_t mover,
                                     const JointCoordinate& coordinate) {
  const auto coordinates = space.coordinates();
  const auto found = std::ranges::find_if(coordinates, [&](const SpaceCoordinate& one) {
    return one.mover == mover && one.joint == coordinate.joint && one.index == coordinate.index;
  });
  if (found != coordinates.end()) {
    return static_cast<std::size_t>(found - coordinates.begin());
  }
  const auto poses = space.poses();
  const auto pose = std::ranges::find_if(poses, [&](const SpacePose& one) {
    return one.mover == mover && one.joint == coordinate.joint;
  });
  return pose == poses.end()
             ? std::nullopt
             : std::optional(space.begin_of_pose(static_cast<std::size_t>(pose - poses.begin())) +
                             coordinate.index);
}

}  // namespace

std::size_t link_of_goal(const RobotModel& model, const LinkGoal& goal, const std::string& name) {
  const std::optional<std::size_t> link = model.find_link(name);
  if (!link) {
    refuse_goal("expected a goal of a link of the robot, got " + in_quotes(goal.link));
  }
  return *link;
}

std::vector<std::vector<std::string>> planned_joints(const Scene& scene,
                                                     const PlanQuestion& question) {
  std::vector<std::vector<std::string>> joints(question.robots.size());
  for (const std::string& name : question.joints) {
    RobotName split = split_mover_name(scene, {question.robots, question.body}, name);
    if (split.which < joints.size()) {
      joints[split.which].push_back(std::move(split.name));
    }
  }
  if (!question.joints.empty()) {
    return joints;
  }
  const auto model_of = [&](const RobotName& split) -> const RobotModel& {
    return scene.robots[question.robots[split.which]].model;
  };
  std::vector<std::set<JointCoordinate>> named(question.robots.size());
  for (const JointPositions& goal : question.goals) {
    for (const auto& [name, position] : goal) {
      const RobotName split = split_mover_name(scene, {question.robots, question.body}, name);
      if (split.which == named.size()) {
        continue;  // A body is planned as a whole.
      }
      const JointCoordinate coordinate = find_coordinate(model_of(split), split.name);
      const Joint& joint = model_of(split).joints()[coordinate.joint];
      if (joint.type == JointType::floating) {
        named[split.which].insert({coordinate.joint, 0});  // Its pose is planned as a whole.
      } else if (!joint.mimic) {
        named[split.which].insert(coordinate);
      }
    }
  }
  for (const LinkGoal& goal : question.link_goals) {
    const RobotName split = split_mover_name(scene, {question.robots, question.body}, goal.link);
    if (split.which == named.size()) {
      refuse_goal("expected a goal of a link of a robot, got " + in_quotes(goal.link));
    }
    const RobotModel& model = model_of(split);
    add_joints_below(model, link_of_goal(model, goal, split.name), named[split.which]);
  }
  for (std::size_t k = 0; k < named.size(); ++k) {
    for (const JointCoordinate& coordinate : named[k]) {
      const RobotModel& model = scene.robots[question.robots[k]].model;
      const Joint& joint = model.joints()[coordinate.joint];
      joints[k].push_back(joint.type == JointType::floating ? joint.name
                                                            : coordinate_name(model, coordinate));
    }
  }
  return joints;
}

Pose pose_of_body(const Scene& scene, const PlanQuestion& question, const JointPositions& positions,
                  const Pose& from) {
  std::array<double, 7> numbers = positions_of_pose(from);
  for (const auto& [name, position] : positions) {
    const RobotName split = split_mover_name(scene, {question.robots, question.body}, name);
    if (split.which == question.robots.size()) {
      numbers.at(index_in_pose(name, split.name)) = position;
    }
  }
  return pose_of_positions(numbers);
}

Configuration goal_of(const Scene& scene, const PlanQuestion& question,
                      const ConfigurationSpace& space, const JointPositions& positions,
                      const Configuration& start) {
  struct Mimicking {
    std::size_t mover;
    std::size_t joint;
    double position;
  };
  Configuration goal = start;
  std::vector<Mimicking> mimics;
  for (const auto& [name, position] : positions) {
    const RobotName split = split_mover_name(scene, {question.robots, question.body}, name);
    if (split.which == question.robots.size()) {
      goal[space.begin_of_pose(space.poses().size() - 1) + index_in_pose(name, split.name)] =
          position;
      continue;
    }
    const RobotModel& model = space.model(split.which);
    const JointCoordinate coordinate = find_coordinate(model, split.name);
    if (const auto number = number_in(space, split.which, coordinate)) {
      goal[*number] = position;
    } else if (model.joints()[coordinate.joint].mimic) {
      mimics.push_back({split.which, coordinate.joint, position});
    } else {
      refuse_goal("a goal names joint " + in_quotes(name) + ", which is not among those planned");
    }
  }
  for (const Mimicking& one : mimics) {
    require_mimicked(space, goal, one.mover, one.joint, one.position);
  }
  return goal;
}

void ignore_what_rests(const PlanScene& plan, Scene& scene) {
  const std::vector<bool> moved = moved_members(plan);
  BodyGroup group{.name = "what no edge moves", .bodies = {}};
  const auto is_taken = [&](const auto& named) { return named.name == group.name; };
  while (std::any_of(scene.groups.begin(), scene.groups.end(), is_taken) ||
         std::any_of(scene.bodies.begin(), scene.bodies.end(), is_taken) ||
         std::any_of(scene.robots.begin(), scene.robots.end(), is_taken)) {
    group.name += " here";
  }
  // In the plan a planned body is a robot of its own, with one link.
  for (std::size_t member = 0; member < moved.size(); ++member) {
    if (!moved[member]) {
      group.bodies.push_back(member);
    }
  }
  if (group.bodies.size() > 1) {
    scene.groups.push_back(std::move(group));
    const std::size_t number = scene.groups.size() - 1;
    scene.ignored_groups.push_back({number, number});
  }
}

}  // namespace firstcontact::detail
