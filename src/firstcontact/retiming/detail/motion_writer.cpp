#include <firstcontact/retiming/detail/motion_writer.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace firstcontact::detail {
namespace {

// No phase is shorter than a millisecond, so these limits make no motion along an edge slower.
// Without them a way of 1e-300 would have infinite rates.
constexpr double kMostRate = 1e6;           // [1/s]
constexpr double kMostAcceleration = 1e10;  // [1/s^2]
constexpr double kMostJerk = 1e14;          // [1/s^3]

}  // namespace

LineLimits line_limits(const WaypointPath& path, std::size_t edge,
                       const std::vector<RateLimits>& limits, double share, bool needs_jerk) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  LineLimits line{kInfinite, kInfinite, kInfinite};
  for (std::size_t joint = 0; joint < limits.size(); ++joint) {
    const double way =
        std::abs(path.waypoints[edge + 1].at(joint) - path.waypoints[edge].at(joint));
    if (!(way > 0.0)) {
      continue;
    }
    line.rate = std::min(line.rate, share * limits[joint].velocity / way);
    line.acceleration = std::min(line.acceleration, share * limits[joint].acceleration / way);
    if (limits[joint].jerk) {
      line.jerk = std::min(line.jerk, share * *limits[joint].jerk / way);
    }
  }
  line.rate = std::min(line.rate, kMostRate);
  line.acceleration = std::min(line.acceleration, kMostAcceleration);
  if (line.has_jerk()) {
    line.jerk = std::min(line.jerk, kMostJerk);
  }
  if (needs_jerk && !line.has_jerk()) {
    line.jerk = line.acceleration / kBuildUpTime;
  }
  return line;
}

MotionWriter::MotionWriter(const WaypointPath& path, bool with_accelerations)
    : path_(path), with_accelerations_(with_accelerations) {
  motion_.joint_names = path.joint_names;
  add(0, on_edge(0, {}));
}

void MotionWriter::add(std::int64_t after, TimedPoint point) {
  point.time = motion_.points.empty() ? after : motion_.points.back().time + after;
  if (!(static_cast<double>(point.time) <= kLatestTime)) {
    throw std::invalid_argument("expected limits with which the motion ends within 13 days");
  }
  if (!with_accelerations_) {
    point.accelerations.clear();
  }
  motion_.points.push_back(std::move(point));
}

TimedPoint MotionWriter::on_edge(std::size_t edge, const LineState& state) const {
  const std::vector<double>& a = path_.waypoints[edge];
  const std::vector<double>& b = path_.waypoints[edge + 1];
  TimedPoint point;
  for (std::size_t joint = 0; joint < a.size(); ++joint) {
    const double way = b[joint] - a[joint];
    const double q = state.x == 1.0 ? b[joint] : a[joint] + state.x * way;
    point.positions.push_back(q);
    point.velocities.push_back(state.rate * way);
    point.accelerations.push_back(state.acceleration * way);
  }
  return point;
}

void MotionWriter::follow(std::size_t edge, double from, double to,
                          const std::vector<LineNode>& nodes) {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    LineState state = nodes[k].state;
    state.x = k + 1 == nodes.size() ? to : state.x + from;
    add(nodes[k].after, on_edge(edge, state));
  }
}

}  // namespace firstcontact::detail
