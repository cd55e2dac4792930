#include <firstcontact/scene/gap_bound.h>

#include <algorithm>
#include <cmath>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/many_bodies/body_set.h>
#include <firstcontact/motion/constant_rate_path.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/sample_gap.h>

namespace firstcontact {
namespace {

constexpr double kRounding = 0x1p-40;

/// [m per step]  Bound of the speed of any point of the body.
double greatest_speed(const BodySet& bodies, std::size_t body) {
  const double radius = bodies.shape(body).hierarchy().radius + bodies.shape(body).radius();
  const double deformation = bodies.shape(body).hierarchy().deformation_speed;
  double greatest = 0.0;
  for (const ConstantRatePath& path : bodies.centre_path(body)) {
    greatest = std::max(greatest, path.pivot_velocity().value().norm() +
                                      path.rate() * (path.lever_length() + radius) + deformation);
  }
  return greatest * (1.0 + kRounding);
}

/// The cone below a sample, cut off at a floor.
class Cone {
 public:
  Cone(const GapSample& sample, double rate, double floor)
      : t_(sample.t), apex_(std::max(sample.lower_bound, floor)), rate_(rate), floor_(floor) {}

  [[nodiscard]] double at(double t) const {
    return std::max(floor_, apex_ - rate_ * std::abs(t - t_));
  }
  /// [-]  The time for which the cone is above its floor, to each side.
  [[nodiscard]] double width() const { return rate_ > 0.0 ? (apex_ - floor_) / rate_ : 1.0; }
  [[nodiscard]] double t() const { return t_; }
  [[nodiscard]] double apex() const { return apex_; }

 private:
  double t_;
  double apex_;
  double rate_;
  double floor_;
};

/// Appends the corners of the greater of two cones between their samples, after that of the left
/// one.
void append_between(const Cone& left, const Cone& right, double rate,
                    std::vector<GapPoint>& points) {
  const double meet = rate > 0.0
                          ? 0.5 * (left.t() + right.t()) + 0.5 * (left.apex() - right.apex()) / rate
                          : right.t();
  const double first = std::clamp(std::min(meet, left.t() + left.width()), left.t(), right.t());
  const double second = std::clamp(std::max(meet, right.t() - right.width()), left.t(), right.t());
  for (const double t : {first, second}) {
    if (t > points.back().t && t < right.t()) {
      points.push_back({t, std::max(left.at(t), right.at(t)) * (1.0 - kRounding)});
    }
  }
}

/// The bound in a scene with robots: the clearance until the result's t.
std::vector<GapPoint> clearance_until(const SceneResult& result,
                                      std::span<const GapSample> samples) {
  std::vector<GapPoint> points;
  const auto add = [&points](double t, double distance) {
    if (points.empty() || points.back().t < t) {
      points.push_back({t, distance});
    }
  };
  for (const GapSample& sample : samples) {
    if (sample.t <= result.t) {
      add(sample.t, result.clearance);
    } else {
      add(result.t, result.clearance);
      add(std::nextafter(result.t, 1.0), 0.0);
      add(sample.t, 0.0);
    }
  }
  return points;
}

}  // namespace

double greatest_gap_rate(const BodySet& bodies) {
  double greatest = 0.0;
  double second = 0.0;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const double speed = greatest_speed(bodies, k);
    second = std::max(second, std::min(speed, greatest));
    greatest = std::max(greatest, speed);
  }
  return (greatest + second) * (1.0 + kRounding);
}

std::vector<GapPoint> gap_lower_bound(const LoadedScene& loaded, const SceneResult& result,
                                      std::span<const GapSample> samples) {
  if (std::isinf(result.clearance)) {
    return {};  // No pair is tested.
  }
  if (loaded.robots) {
    return clearance_until(result, samples);
  }
  const double rate = greatest_gap_rate(loaded.bodies);
  const auto cone = [&](const GapSample& sample, double until) {
    return Cone(sample, rate, until <= result.t ? result.clearance : 0.0);
  };
  std::vector<GapPoint> points;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double next = k + 1 < samples.size() ? samples[k + 1].t : samples[k].t;
    points.push_back({samples[k].t, cone(samples[k], next).apex() * (1.0 - kRounding)});
    if (k + 1 < samples.size()) {
      append_between(cone(samples[k], next), cone(samples[k + 1], next), rate, points);
    }
  }
  return points;
}

}  // namespace firstcontact
