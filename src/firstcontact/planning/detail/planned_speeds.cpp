#include <firstcontact/planning/detail/planned_speeds.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>

#include <firstcontact/robot/robot_model.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// Narrows the speed of a joint to the limits of the joints that mimic it, and so on.
///
/// @param factor  [-]  the named joint moves this many times as fast as the coordinate
void narrow_by_followers(const RobotModel& model, std::size_t joint, double factor, double& speed) {
  for (std::size_t other = 0; other < model.joints().size(); ++other) {
    const Joint& follower = model.joints()[other];
    if (!follower.mimic || follower.mimic->joint != model.joints()[joint].name) {
      continue;
    }
    const double faster = std::abs(follower.mimic->multiplier) * factor;
    const double limit = follower.limits.velocity.value_or(0.0);
    if (faster > 0.0 && limit > 0.0) {  // A limit of 0 stands for an unknown one.
      speed = std::min(speed, std::nextafter(limit / faster, 0.0));
    }
    narrow_by_followers(model, other, faster, speed);
  }
}

}  // namespace

std::vector<double> planned_speeds(const PlanQuestion& question, const ConfigurationSpace& space,
                                   const std::string& moving) {
  const auto speed = [&](const std::string& name, const std::optional<double>& own) {
    const auto found = question.speeds.find(name);
    if (found == question.speeds.end() && !(own.value_or(0.0) > 0.0)) {
      throw std::invalid_argument(moving + " moves: expected \"speeds\" of what is planned with " +
                                  in_quotes(name) + ", got none");
    }
    return found == question.speeds.end() ? *own : found->second;
  };
  if (space.is_body()) {
    return {speed("linear", std::nullopt), speed("angular", std::nullopt)};
  }
  std::vector<double> speeds;
  speeds.reserve(space.speed_count());
  for (const SpaceCoordinate& coordinate : space.coordinates()) {
    const RobotModel& model = space.model(coordinate.mover);
    speeds.push_back(speed(coordinate.name, model.joints()[coordinate.joint].limits.velocity));
    narrow_by_followers(model, coordinate.joint, 1.0, speeds.back());
  }
  for (const SpacePose& pose : space.poses()) {
    speeds.push_back(speed(pose.name + "/linear", std::nullopt));
    speeds.push_back(speed(pose.name + "/angular", std::nullopt));
  }
  return speeds;
}

}  // namespace firstcontact::detail
