/// @file
/// C++ counterpart of benchmarks/python/overhead.py: the time of one query, and of a batch by one
/// and by two threads. The program prints JSON.
///
///     cpp_baseline CALLS

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <thread>
#include <vector>

#include <firstcontact/query/first_contact.h>

namespace {

using Eigen::Vector3d;
using firstcontact::FirstContactResult;
using firstcontact::Mesh;
using firstcontact::Motion;
using firstcontact::Shape;
using firstcontact::Verdict;
using firstcontact::Workspace;

constexpr std::size_t kJobs = 10'000;
constexpr int kCallsOfATurn = 1'000;

double thread_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// [us]  Times a query with the least work: two triangles that never come near each other.
///
/// Every call makes its own result, as from Python. The fastest of many short turns counts.
double time_of_call(int calls) {
  const Shape triangle({.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}});
  const Motion rest = Motion::fixed();
  const Motion away = Motion::constant_velocity({.position = {0, 0, 9}}, Vector3d(0, 0, 1));
  Workspace workspace;
  double least = 1e9;
  for (int turn = 0; turn < calls / kCallsOfATurn; ++turn) {
    const double begin = thread_time();
    for (int k = 0; k < kCallsOfATurn; ++k) {
      const FirstContactResult result =
          firstcontact::first_contact({triangle, rest}, {triangle, away}, workspace);
      if (result.verdict != Verdict::free) {
        std::exit(1);
      }
    }
    least = std::min(least, thread_time() - begin);
  }
  return 1e6 * least / kCallsOfATurn;
}

Shape knot(std::uint32_t segments, std::uint32_t sides) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  Mesh mesh;
  for (std::uint32_t i = 0; i < segments; ++i) {
    const double s = kTurn * i / segments;
    const Vector3d centre((2 + std::cos(3 * s)) * std::cos(2 * s),
                          (2 + std::cos(3 * s)) * std::sin(2 * s), std::sin(3 * s));
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double a = kTurn * k / sides;
      mesh.vertices.emplace_back(centre +
                                 0.4 * Vector3d(std::cos(a), std::sin(a), std::sin(a + s)));
      const std::uint32_t j = (i + 1) % segments;
      const std::uint32_t l = (k + 1) % sides;
      const std::uint32_t a0 = i * sides + k;
      const std::uint32_t a1 = i * sides + l;
      const std::uint32_t b0 = j * sides + k;
      const std::uint32_t b1 = j * sides + l;
      mesh.triangles.push_back({a0, b0, a1});
      mesh.triangles.push_back({a1, b0, b1});
    }
  }
  return Shape(mesh);
}

struct Batch {
  double seconds = 0.0;
  int contacts = 0;
};

/// Measures the wall time of a batch, from motions to results.
Batch time_of_batch(const Shape& shape, const std::vector<Motion>& motions, int threads) {
  const Motion rest = Motion::fixed();
  const auto begin = std::chrono::steady_clock::now();
  std::vector<FirstContactResult> results(motions.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    Workspace workspace;
    for (std::size_t k = next++; k < motions.size(); k = next++) {
      results[k] = firstcontact::first_contact({shape, rest}, {shape, motions[k]}, workspace);
    }
  };
  {
    std::vector<std::jthread> others;
    for (int k = 1; k < threads; ++k) {
      others.emplace_back(work);
    }
    work();
  }
  Batch batch;
  batch.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const FirstContactResult& result : results) {
    batch.contacts += result.verdict != Verdict::free ? 1 : 0;
  }
  return batch;
}

}  // namespace

int main(int argc, char** argv) {
  const int calls = argc > 1 ? std::atoi(argv[1]) : 200'000;
  const Shape shape = knot(100, 5);
  std::vector<Motion> motions;
  for (std::size_t k = 0; k < kJobs; ++k) {
    const double x =
        -8.0 + 16.0 * static_cast<double>((k * 7919) % kJobs) / static_cast<double>(kJobs);
    motions.push_back(Motion::constant_velocity({.position = {x, 0.1, 9}}, Vector3d(0, 0, -18),
                                                Vector3d(0.5, 1, 0.25)));
  }
  const double call = time_of_call(calls);
  const Batch one = time_of_batch(shape, motions, 1);
  const Batch two = time_of_batch(shape, motions, 2);
  std::printf(
      "{\"call_cpp_us\": %.17g, \"batch_cpp_1_s\": %.17g, \"batch_cpp_2_s\": %.17g, \"contacts\": "
      "%d}\n",
      call, one.seconds, two.seconds, two.contacts);
}
