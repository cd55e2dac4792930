#include <array>
#include <charconv>
#include <string>

#include <firstcontact/scene/detail/write_json.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {
namespace {

/// As many digits as a person reads.
std::string quantity(double value, const char* unit) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6)
          .ptr;
  return std::string(text.data(), end) + " " + unit;
}

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
         quantity(violation.limit, unit) + " by " + quantity(violation.excess, unit) + " at " +
         quantity(violation.t_excess * duration, "s");
}

}  // namespace firstcontact
