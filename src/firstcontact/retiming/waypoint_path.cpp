#include <firstcontact/retiming/waypoint_path.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

constexpr double kLargestPosition = 1e8;  // [rad or m]  As CoordinatePath.

[[noreturn]] void refuse_waypoint(std::size_t index, const std::string& why) {
  throw std::invalid_argument("waypoint " + std::to_string(index + 1) + ": " + why);
}

}  // namespace

void require_path(const WaypointPath& path) {
  if (path.joint_names.empty()) {
    throw std::invalid_argument("expected a path of at least one joint, got none");
  }
  if (path.waypoints.size() < 2) {
    throw std::invalid_argument("expected a path of two waypoints or more, got " +
                                std::to_string(path.waypoints.size()));
  }
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
    const std::vector<double>& waypoint = path.waypoints[k];
    if (waypoint.size() != path.joint_names.size()) {
      refuse_waypoint(k, "expected a number for each of the " +
                             std::to_string(path.joint_names.size()) + " joints, got " +
                             std::to_string(waypoint.size()));
    }
    for (std::size_t joint = 0; joint < waypoint.size(); ++joint) {
      if (!(std::abs(waypoint[joint]) <= kLargestPosition)) {
        refuse_waypoint(k, "expected a position of joint " +
                               detail::in_quotes(path.joint_names[joint]) +
                               " of at most 1e8 in size, got another number or none");
      }
    }
    if (k > 0 && waypoint == path.waypoints[k - 1]) {
      refuse_waypoint(k, "it repeats the waypoint before it; leave one of them out");
    }
  }
}

WaypointPath unwound(WaypointPath path, const std::vector<bool>& turns_short) {
  for (std::size_t joint = 0; joint < turns_short.size(); ++joint) {
    if (!turns_short[joint]) {
      continue;
    }
    double given_before = path.waypoints.front().at(joint);
    for (std::size_t k = 1; k < path.waypoints.size(); ++k) {
      const double given = path.waypoints[k].at(joint);
      const double before = path.waypoints[k - 1][joint];
      const bool as_numbers_go =
          before == given_before && shortest_way(given_before, given) == given - given_before;
      path.waypoints[k][joint] = as_numbers_go ? given : before + shortest_way(given_before, given);
      given_before = given;
    }
  }
  return path;
}

}  // namespace firstcontact
