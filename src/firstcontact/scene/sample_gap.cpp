#include <firstcontact/scene/sample_gap.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/many_bodies/body_set.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/robot_check/robot_gap.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {

namespace {

constexpr double kGreatestCount = 1e7;

/// A ball around each body at one time.
struct Ball {
  Eigen::Vector3d centre;
  double radius;
};

std::vector<Ball> balls_at(const BodySet& bodies, double t) {
  std::vector<Ball> balls;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Hierarchy& hierarchy = bodies.shape(k).hierarchy();
    const Pose pose = bodies.motion(k).pose(t);
    balls.push_back({pose.position + pose.rotation * hierarchy.centre,
                     hierarchy.radius + bodies.shape(k).radius()});
  }
  return balls;
}

/// A lower bound of the distance of two balls, below it only by rounding.
double ball_distance(const Ball& a, const Ball& b) {
  const double distance = (a.centre - b.centre).norm();
  return distance - a.radius - b.radius - 1e-12 * (distance + a.centre.norm() + b.centre.norm());
}

GapSample sample(const LoadedScene& loaded, double t, Workspace& workspace) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  GapSample sample{.t = t, .distance = kNone, .lower_bound = kNone, .contact = false};
  const BodySet& bodies = loaded.bodies;
  const std::vector<Ball> balls = balls_at(bodies, t);
  for (std::size_t first = 0; first < bodies.size(); ++first) {
    for (std::size_t second = first + 1; second < bodies.size(); ++second) {
      const std::optional<double> margin = bodies.rules().margin({first, second});
      if (!margin ||
          ball_distance(balls[first], balls[second]) > std::max(sample.distance, *margin)) {
        continue;
      }
      const DistanceResult found =
          distance(bodies.moving_shape(first), bodies.moving_shape(second), t, workspace);
      sample.distance = std::min(sample.distance, found.distance);
      sample.lower_bound = std::min(sample.lower_bound, found.lower_bound);
      sample.contact = sample.contact || found.distance <= *margin;
    }
  }
  return sample;
}

std::vector<GapSample> sample_robots(const RobotScene& scene, std::span<const double> times,
                                     const std::stop_token& stop) {
  std::vector<GapSample> samples;
  for (const RobotGap& gap : robot_gaps(scene, times, stop)) {
    samples.push_back({.t = times[samples.size()],
                       .distance = gap.distance,
                       .lower_bound = gap.lower_bound,
                       .contact = gap.contact});
  }
  return samples;
}

}  // namespace

std::vector<GapSample> sample_gap(const LoadedScene& loaded, std::span<const double> times,
                                  Workspace& workspace, const std::stop_token& stop) {
  if (loaded.robots) {
    return sample_robots(*loaded.robots, times, stop);
  }
  std::vector<GapSample> samples;
  samples.reserve(times.size());
  for (const double t : times) {
    if (!(t >= 0.0 && t <= 1.0)) {
      throw std::invalid_argument("sample_gap: t must be in [0, 1], got " + detail::shortest(t));
    }
    if (stop.stop_requested()) {
      break;
    }
    samples.push_back(sample(loaded, t, workspace));
  }
  return samples;
}

std::vector<double> even_times(std::size_t count) {
  std::vector<double> times(std::max<std::size_t>(count, 2));
  for (std::size_t k = 0; k < times.size(); ++k) {
    times[k] = static_cast<double>(k) / static_cast<double>(times.size() - 1);
  }
  return times;
}

std::vector<double> times_at_rate(double rate, double duration) {
  const double last = std::floor(duration * rate);
  if (!(rate > 0.0 && duration > 0.0 && last < kGreatestCount)) {
    throw std::invalid_argument("times_at_rate: rate and duration must be > 0, times below 1e7");
  }
  std::vector<double> times(static_cast<std::size_t>(last) + 1);
  for (std::size_t k = 0; k < times.size(); ++k) {
    times[k] = std::min(static_cast<double>(k) / (rate * duration), 1.0);
  }
  return times;
}

}  // namespace firstcontact
