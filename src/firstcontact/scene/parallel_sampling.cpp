#include <firstcontact/scene/parallel_sampling.h>

#include <algorithm>
#include <cstddef>
#include <future>
#include <thread>

#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {
namespace {

/// Every `stride`-th of the times.
std::vector<double> every(std::span<const double> times, std::size_t first, std::size_t stride) {
  std::vector<double> some;
  for (std::size_t k = first; k < times.size(); k += stride) {
    some.push_back(times[k]);
  }
  return some;
}

}  // namespace

std::vector<GapSample> sample_in_parallel(const LoadedScene& loaded, std::span<const double> times,
                                          const std::stop_token& stop) {
  const std::size_t count = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::future<std::vector<GapSample>>> running;
  for (std::size_t k = 0; k < count; ++k) {
    running.push_back(std::async(std::launch::async, [&, k] {
      Workspace workspace;
      return sample_gap(loaded, every(times, k, count), workspace, stop);
    }));
  }
  std::vector<GapSample> samples;
  for (auto& thread : running) {
    const std::vector<GapSample> some = thread.get();
    samples.insert(samples.end(), some.begin(), some.end());
  }
  std::sort(samples.begin(), samples.end(),
            [](const GapSample& a, const GapSample& b) { return a.t < b.t; });
  return samples;
}

}  // namespace firstcontact
