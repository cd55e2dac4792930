#include <firstcontact/scene/gap_curve.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/parallel_sampling.h>

namespace firstcontact {
namespace {

constexpr std::size_t kFirstSamples = 129;  // Several samples for each ripple of a nut in five
                                            // turns.
constexpr int kRounds = 4;                  // Each halves the intervals that it refines.
constexpr double kSeen = 2e-2;  // [-]  Part of the height; half way between samples the line is off
                                // by a quarter of it.

/// The distance of a sample from the straight line between its neighbours.
double bend(const GapSample& before, const GapSample& sample, const GapSample& after) {
  const double share = (sample.t - before.t) / (after.t - before.t);
  return std::abs(before.distance + share * (after.distance - before.distance) - sample.distance);
}

/// The middles of the intervals beside each bend.
std::vector<double> times_at_bends(const std::vector<GapSample>& curve) {
  const auto greatest = std::max_element(
      curve.begin(), curve.end(),
      [](const GapSample& a, const GapSample& b) { return a.distance < b.distance; });
  std::set<double> times;
  for (std::size_t k = 1; k + 1 < curve.size(); ++k) {
    if (bend(curve[k - 1], curve[k], curve[k + 1]) > kSeen * greatest->distance) {
      times.insert(0.5 * (curve[k - 1].t + curve[k].t));
      times.insert(0.5 * (curve[k].t + curve[k + 1].t));
    }
  }
  return {times.begin(), times.end()};
}

void merge(const std::vector<GapSample>& more, std::vector<GapSample>& curve) {
  curve.insert(curve.end(), more.begin(), more.end());
  std::sort(curve.begin(), curve.end(),
            [](const GapSample& a, const GapSample& b) { return a.t < b.t; });
}

}  // namespace

double time_of_interest(const SceneResult& result) {
  return result.closest && !result.first ? result.pairs[*result.closest].closest->t : result.t;
}

std::vector<GapSample> gap_curve(const LoadedScene& loaded, double focus,
                                 const std::stop_token& stop) {
  std::vector<double> times = even_times(kFirstSamples);
  if (!std::binary_search(times.begin(), times.end(), focus)) {
    times.push_back(focus);
  }
  std::vector<GapSample> curve;
  for (int round = 0; round < kRounds && !times.empty(); ++round) {
    merge(sample_in_parallel(loaded, times, stop), curve);
    times = times_at_bends(curve);
  }
  return curve;
}

}  // namespace firstcontact
