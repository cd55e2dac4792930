#include <firstcontact/retiming/detail/thinned_path.h>

#include <algorithm>
#include <cmath>

namespace firstcontact::detail {
namespace {

using Waypoint = std::vector<double>;

/// The product of the ways a to b and c to d.
double product(const Waypoint& a, const Waypoint& b, const Waypoint& c, const Waypoint& d) {
  double sum = 0.0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    sum += (b[j] - a[j]) * (d[j] - c[j]);
  }
  return sum;
}

double distance_from(const Waypoint& a, const Waypoint& b, double x, const Waypoint& q) {
  double greatest = 0.0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    greatest = std::max(greatest, std::abs(q[j] - a[j] - x * (b[j] - a[j])));
  }
  return greatest;
}

}  // namespace

FarthestWaypoint farthest_from_edge(const WaypointPath& path, std::size_t first, std::size_t last) {
  const Waypoint& a = path.waypoints[first];
  const Waypoint& b = path.waypoints[last];
  const double square = product(a, b, a, b);
  FarthestWaypoint farthest{.waypoint = first};
  double x = 0.0;
  for (std::size_t k = first + 1; k < last; ++k) {
    const Waypoint& q = path.waypoints[k];
    if (square > 0.0) {
      x = std::clamp(product(a, q, a, b) / square, x, 1.0);
    }
    const double deviation = distance_from(a, b, x, q);
    if (farthest.waypoint == first || deviation > farthest.deviation) {
      farthest = {k, deviation};
    }
  }
  return farthest;
}

std::vector<std::size_t> thinned_waypoints(const WaypointPath& path, double tolerance,
                                           const std::vector<std::size_t>& kept) {
  const std::size_t end = path.waypoints.size() - 1;
  std::vector<std::size_t> result{0};
  // The ends of edges that are not yet divided; the nearest one is the last.
  std::vector<std::size_t> ends{end};
  for (auto waypoint = kept.rbegin(); waypoint != kept.rend(); ++waypoint) {
    if (*waypoint > 0 && *waypoint < ends.back()) {
      ends.push_back(*waypoint);
    }
  }
  while (!ends.empty()) {
    const FarthestWaypoint farthest = farthest_from_edge(path, result.back(), ends.back());
    // An edge from a waypoint to itself has no direction.
    const bool is_edge = path.waypoints[result.back()] != path.waypoints[ends.back()];
    if (ends.back() - result.back() > 1 && !(is_edge && farthest.deviation <= tolerance)) {
      ends.push_back(farthest.waypoint);
    } else {
      result.push_back(ends.back());
      ends.pop_back();
    }
  }
  return result;
}

WaypointPath through_waypoints(const WaypointPath& path, const std::vector<std::size_t>& kept) {
  WaypointPath part{path.joint_names, {}};
  for (const std::size_t waypoint : kept) {
    part.waypoints.push_back(path.waypoints[waypoint]);
  }
  return part;
}

double extent_of(const WaypointPath& path) {
  double extent = 0.0;
  for (std::size_t j = 0; j < path.joint_names.size(); ++j) {
    const auto [low, high] = std::ranges::minmax(
        path.waypoints, {}, [j](const Waypoint& waypoint) { return waypoint[j]; });
    extent = std::max(extent, high[j] - low[j]);
  }
  return extent;
}

bool turns_back(const WaypointPath& path, std::size_t waypoint) {
  constexpr double kCosine = -0.98480775301220802;  // Of 170 degrees.
  const Waypoint& a = path.waypoints[waypoint - 1];
  const Waypoint& b = path.waypoints[waypoint];
  const Waypoint& c = path.waypoints[waypoint + 1];
  const double lengths = std::sqrt(product(a, b, a, b)) * std::sqrt(product(b, c, b, c));
  return product(a, b, b, c) < kCosine * lengths;
}

}  // namespace firstcontact::detail
