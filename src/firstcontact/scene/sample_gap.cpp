#include <firstcontact/scene/sample_gap.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <firstcontact/query/distance.h>

namespace firstcontact {

namespace {

constexpr double kGreatestCount = 1e7;

GapSample sample(const LoadedScene& loaded, double t, Workspace& workspace) {
  GapSample sample{.t = t, .distance = std::numeric_limits<double>::infinity(), .contact = false};
  for (const ScenePair& pair : loaded.pairs) {
    const double found = distance(loaded.moving_shape(pair.bodies[0]),
                                  loaded.moving_shape(pair.bodies[1]), t, workspace)
                             .distance;
    sample.distance = std::min(sample.distance, found);
    sample.contact = sample.contact || found <= pair.margin;
  }
  return sample;
}

}  // namespace

std::vector<GapSample> sample_gap(const LoadedScene& loaded, std::span<const double> times,
                                  Workspace& workspace, const std::stop_token& stop) {
  std::vector<GapSample> samples;
  samples.reserve(times.size());
  for (const double t : times) {
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
