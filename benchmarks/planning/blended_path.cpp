#include "benchmarks/planning/blended_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Core>

namespace firstcontact::benchmarks {
namespace {

using Eigen::VectorXd;

constexpr double kTolerance = 0.1;  // [rad]  Of circles from the path.
constexpr double kSample = 0.1;     // [s]
constexpr double kGrid = 1e-3;      // [rad]  Along the path.
// Those of the Panda's URDF, and of MoveIt's configuration of it.
constexpr std::array<double, 7> kVelocities = {2.175, 2.175, 2.175, 2.175,
                                               2.61,  2.61,  2.61};  // [rad/s]
constexpr std::array<double, 7> kAccelerations = {3.75, 1.875, 2.5, 3.125,
                                                  3.75, 5.0,   5.0};  // [rad/s^2]

/// A place on the path with its derivatives by length.
struct Place {
  VectorXd q;
  VectorXd tangent;
  VectorXd curvature;  // [1/rad]
};

void add_straight(const VectorXd& from, const VectorXd& to, std::vector<Place>& places) {
  const double length = (to - from).norm();
  if (length == 0.0) {
    return;
  }
  const int count = std::max(1, static_cast<int>(std::ceil(length / kGrid)));
  const VectorXd u = (to - from) / length;
  for (int k = 0; k <= count; ++k) {
    places.push_back({from + (to - from) * k / count, u, VectorXd::Zero(u.size())});
  }
}

/// Adds the circle at a corner, and moves the ends of the straight parts to its ends.
void add_corner(const VectorXd& before, const VectorXd& corner, const VectorXd& after,
                VectorXd& from, std::vector<Place>& places) {
  const VectorXd u = (corner - before).normalized();
  const VectorXd v = (after - corner).normalized();
  const double angle = std::acos(std::clamp(u.dot(v), -1.0, 1.0));
  constexpr double kStraight = 1e-6;  // [rad]
  if (!(angle > kStraight && angle < 3.14159)) {
    add_straight(from, corner, places);
    from = corner;
    return;
  }
  const double half = 0.5 * angle;
  const double reach = std::min({0.5 * (corner - before).norm(), 0.5 * (after - corner).norm(),
                                 kTolerance * std::sin(half) / (1.0 - std::cos(half))});
  const double radius = reach / std::tan(half);
  add_straight(from, corner - reach * u, places);
  const VectorXd out = (u - v).normalized();  // From the circle's middle to the corner.
  const VectorXd along = (u + v).normalized();
  const VectorXd middle = corner - radius / std::cos(half) * out;
  const int count = std::max(2, static_cast<int>(std::ceil(radius * angle / kGrid)));
  for (int k = 0; k <= count; ++k) {
    const double at = -half + angle * k / count;
    const VectorXd r = std::cos(at) * out + std::sin(at) * along;
    places.push_back({middle + radius * r, std::cos(at) * along - std::sin(at) * out, -r / radius});
  }
  from = corner + reach * v;
}

std::vector<Place> rounded(const std::vector<Configuration>& waypoints) {
  std::vector<VectorXd> corners;
  for (const Configuration& q : waypoints) {
    const VectorXd corner =
        Eigen::Map<const VectorXd>(q.data(), static_cast<Eigen::Index>(q.size()));
    if (corners.empty() || corner != corners.back()) {
      corners.push_back(corner);
    }
  }
  std::vector<Place> places;
  VectorXd from = corners.front();
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    add_corner(corners[k - 1], corners[k], corners[k + 1], from, places);
  }
  add_straight(from, corners.back(), places);
  return places;
}

/// [rad/s]  The greatest speed along the path at each place.
std::vector<double> speeds(const std::vector<Place>& places) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<double> v(places.size(), kNone);
  std::vector<double> gain(places.size(), kNone);  // [rad/s^2]
  for (std::size_t k = 0; k < places.size(); ++k) {
    for (std::size_t j = 0; j < kVelocities.size(); ++j) {
      const auto row = static_cast<Eigen::Index>(j);
      v[k] = std::min(v[k], kVelocities[j] / std::abs(places[k].tangent[row]));
      v[k] = std::min(v[k], std::sqrt(kAccelerations[j] / std::abs(places[k].curvature[row])));
      gain[k] = std::min(gain[k], kAccelerations[j] / std::abs(places[k].tangent[row]));
    }
  }
  v.front() = 0.0;
  v.back() = 0.0;
  const auto limit = [&](std::size_t from, std::size_t to) {
    const double ds = (places[to].q - places[from].q).norm();
    v[to] = std::min(v[to], std::sqrt(v[from] * v[from] + 2.0 * gain[from] * ds));
  };
  for (std::size_t k = 0; k + 1 < v.size(); ++k) {
    limit(k, k + 1);
  }
  for (std::size_t k = v.size(); k-- > 1;) {
    limit(k, k - 1);
  }
  return v;
}

}  // namespace

std::vector<Configuration> blended_path(const std::vector<Configuration>& waypoints) {
  const std::vector<Place> places = rounded(waypoints);
  if (places.empty()) {
    return waypoints;
  }
  const std::vector<double> v = speeds(places);
  std::vector<Configuration> samples = {waypoints.front()};
  double time = 0.0;
  double next = kSample;
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    const VectorXd step = places[k + 1].q - places[k].q;
    const double mean = 0.5 * (v[k] + v[k + 1]);
    const double took = step.norm() == 0.0 ? 0.0 : step.norm() / mean;
    while (took > 0.0 && next <= time + took) {
      const VectorXd q = places[k].q + step * (next - time) / took;
      samples.emplace_back(q.begin(), q.end());
      next += kSample;
    }
    time += took;
  }
  samples.push_back(waypoints.back());
  return samples;
}

}  // namespace firstcontact::benchmarks
