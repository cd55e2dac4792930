#include <firstcontact/scene_files/detail/joint_reports.h>

#include <utility>

#include <firstcontact/scene_files/detail/result_json.h>

namespace firstcontact::detail {
namespace {

const char* word(JointLimit limit) { return kJointLimitWords[static_cast<std::size_t>(limit)]; }

JsonValue turn_json(const SceneRobot& robot, const JointTurn& turn) {
  return {.value = JsonObject{{"robot", to_json(robot.name)},
                              {"joint", to_json(turn.joint)},
                              {"from", to_json(turn.from)},
                              {"to", to_json(turn.to)},
                              {"turned", to_json(turn.turned)},
                              {"turning", to_json(to_string(turn.turning))}}};
}

JsonValue limit_json(const SceneRobot& robot, const LimitViolation& violation, double duration) {
  JsonArray intervals;
  for (const TimeWindow& interval : violation.intervals) {
    intervals.push_back(two(to_json(interval.begin * duration), to_json(interval.end * duration)));
  }
  return {.value = JsonObject{{"robot", to_json(robot.name)},
                              {"joint", to_json(robot.model.joints()[violation.joint].name)},
                              {"limit", to_json(word(violation.what))},
                              {"value", to_json(violation.limit)},
                              {"excess", to_json(violation.excess)},
                              {"time", to_json(violation.t_excess * duration)},
                              {"intervals", {.value = std::move(intervals)}}}};
}

}  // namespace

void append_joint_reports(const LoadedScene& loaded, JsonObject& object) {
  const Scene& scene = loaded.scene;
  if (scene.robots.empty()) {
    return;
  }
  JsonArray turns;
  for (const SceneRobot& robot : scene.robots) {
    for (const JointTurn& turn : joint_turns(robot.model, robot.trajectory)) {
      turns.push_back(turn_json(robot, turn));
    }
  }
  if (!turns.empty()) {
    object.push_back({"turns", {.value = std::move(turns)}});
  }
  JsonArray limits;
  for (const SceneLimits& of_robot : loaded.limits) {
    for (const LimitViolation& violation : of_robot.violations) {
      limits.push_back(limit_json(scene.robots[of_robot.robot], violation, scene.duration));
    }
  }
  object.push_back({"limits", {.value = std::move(limits)}});
}

}  // namespace firstcontact::detail
