#include <stdexcept>
#include <string>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/text/quantity.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

const char* unit_of(const Joint& joint, JointLimit limit) {
  const bool slides = joint.type == JointType::prismatic;
  if (limit == JointLimit::velocity) {
    return slides ? "m/s" : "rad/s";
  }
  return slides ? "m" : "rad";
}

}  // namespace

std::string describe(const SceneRobot& robot, const LimitViolation& violation, double duration) {
  const Joint& joint = robot.model.joints()[violation.joint];
  const char* unit = unit_of(joint, violation.what);
  const char* what = violation.what == JointLimit::velocity         ? "velocity limit"
                     : violation.what == JointLimit::lower_position ? "lower limit"
                                                                    : "upper limit";
  return robot.name + ": joint " + detail::in_quotes(joint.name) + " leaves its " + what + " of " +
         detail::quantity(violation.limit, unit) + " by " +
         detail::quantity(violation.excess, unit) + " at " +
         detail::quantity(violation.t_excess * duration, "s");
}

void require_within_limits(const LoadedScene& loaded) {
  if (loaded.limits.empty()) {
    return;
  }
  const SceneLimits& first = loaded.limits.front();
  std::size_t others = 0;
  for (const SceneLimits& limits : loaded.limits) {
    others += limits.violations.size();
  }
  --others;
  throw std::invalid_argument(
      "expected a motion within the joint limits, but " +
      describe(loaded.scene.robots[first.robot], first.violations.front(), loaded.scene.duration) +
      (others > 0 ? ", and " + std::to_string(others) + " more" : ""));
}

}  // namespace firstcontact
