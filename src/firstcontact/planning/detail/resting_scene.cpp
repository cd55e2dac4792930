#include <firstcontact/planning/detail/resting_scene.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <variant>

#include <firstcontact/planning/detail/plan_goals.h>
#include <firstcontact/scene/detail/robot_name.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

[[noreturn]] void refuse_plan(const std::string& what) { throw std::invalid_argument(what); }

bool moves_by_itself(const SceneRobot& robot) {
  return !std::holds_alternative<FixedMotion>(robot.base) ||
         (robot.trajectory.points.size() > 1 && !robot.trajectory.joint_names.empty());
}

bool is_planned(const PlanQuestion& question, std::size_t robot) {
  return std::ranges::find(question.robots, robot) != question.robots.end();
}

/// Whether a robot holds a body, whose own motion then has no meaning.
bool is_held(const Scene& scene, std::size_t body) {
  return std::ranges::any_of(scene.robots, [&](const SceneRobot& robot) {
    return std::ranges::any_of(robot.attached, [&](const SceneAttachment& held) {
      return held.body == body && held.pose;
    });
  });
}

/// Adds the first point of a trajectory to the positions at which the robot rests.
void rest_at_begin(SceneRobot& robot) {
  const Trajectory& trajectory = robot.trajectory;
  for (std::size_t k = 0; k < trajectory.joint_names.size(); ++k) {
    robot.state[trajectory.joint_names[k]] = trajectory.points.front().positions[k];
  }
  robot.trajectory = Trajectory{.joint_names = {}, .points = {TrajectoryPoint{}}};
}

void require_all_the_time(const Scene& scene, const SceneRobot& robot) {
  for (const SceneAttachment& held : robot.attached) {
    if (held.from_time > 0.0 || (held.to_time && *held.to_time < scene.duration)) {
      refuse_plan("body " + in_quotes(scene.bodies[held.body].name) +
                  " is held for a part of the time only; a path is planned for what is held all "
                  "the time");
    }
  }
}

/// Adds the start of the question to the positions at which its robots rest.
void rest_at_start(const PlanQuestion& question, Scene& scene) {
  for (const auto& [name, position] : question.start) {
    const RobotName split = split_mover_name(scene, {question.robots, question.body}, name);
    if (split.which == question.robots.size()) {
      continue;  // The body has its own.
    }
    SceneRobot& robot = scene.robots[question.robots[split.which]];
    robot.state[coordinate_name(robot.model, find_coordinate(robot.model, split.name))] = position;
  }
}

/// Gives the planned body the pose in which it starts.
void rest_at_start(const PlanQuestion& question, const Scene& scene, Body& body) {
  if (question.start_pose) {
    body.motion = FixedMotion{*question.start_pose};
  }
  auto* at_rest = std::get_if<FixedMotion>(&body.motion);
  if (at_rest == nullptr) {
    refuse_plan("body " + in_quotes(body.name) +
                " moves by itself and is to be planned; give it a \"start\" or a pose at rest");
  }
  if (!question.robots.empty()) {
    at_rest->pose = pose_of_body(scene, question, question.start, at_rest->pose);
  }
  at_rest->pose = with_unit_quaternion(at_rest->pose);
}

}  // namespace

std::optional<std::string> what_moves(const Scene& scene, const PlanQuestion& question) {
  for (std::size_t k = 0; k < scene.robots.size(); ++k) {
    if (!is_planned(question, k) && moves_by_itself(scene.robots[k])) {
      return "robot " + in_quotes(scene.robots[k].name);
    }
  }
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    if (question.body != k && !is_held(scene, k) &&
        !std::holds_alternative<FixedMotion>(scene.bodies[k].motion)) {
      return "body " + in_quotes(scene.bodies[k].name);
    }
  }
  return std::nullopt;
}

std::vector<std::string> frozen_by_plan(const Scene& scene, const PlanQuestion& question) {
  std::vector<std::string> frozen;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    if (scene.bodies[k].free && question.body != k) {
      frozen.push_back("body " + in_quotes(scene.bodies[k].name) +
                       " has \"dynamics\": here it rests where it is");
    }
  }
  return frozen;
}

Pose with_unit_quaternion(Pose pose) {
  constexpr double kUnit = 1e-7;  // Stricter than ConfigurationSpace::defect().
  if (std::abs(pose.rotation.norm() - 1.0) > kUnit) {
    pose.rotation.normalize();
  }
  return pose;
}

Scene resting_scene(Scene scene, const PlanQuestion& question) {
  const bool keeps_times = what_moves(scene, question).has_value();
  for (std::size_t k = 0; k < scene.robots.size(); ++k) {
    SceneRobot& robot = scene.robots[k];
    require_all_the_time(scene, robot);
    for (SceneAttachment& held : robot.attached) {
      held.to_time.reset();
    }
    if (is_planned(question, k) || !moves_by_itself(robot)) {
      rest_at_begin(robot);
    }
    if (is_planned(question, k) && !std::holds_alternative<FixedMotion>(robot.base)) {
      refuse_plan("the base of robot " + in_quotes(robot.name) +
                  " moves; a path is planned for a base at rest");
    }
    robot.dynamics.reset();
  }
  rest_at_start(question, scene);
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    Body& body = scene.bodies[k];
    if (std::holds_alternative<VertexMotion>(body.motion)) {
      refuse_plan("body " + in_quotes(body.name) +
                  " deforms; expected rigid bodies, among which a path can be proven again");
    }
    body.free.reset();
    if (question.body == k) {
      rest_at_start(question, scene, body);
    }
  }
  scene.options.margin = question.margin.value_or(scene.options.margin);
  scene.options.start_contacts = StartContacts::report;
  scene.simulation.reset();
  scene.plan.reset();
  if (!keeps_times) {
    scene.duration = 1.0;
  }
  return scene;
}

}  // namespace firstcontact::detail
