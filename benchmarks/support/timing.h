/// @file
/// Times of single queries: processor time of this thread, cold caches, quantiles.

#pragma once

#include <vector>

namespace firstcontact::benchmarks {

/// [us]  Returns the processor time that this thread has used; other load on the machine does not
/// count.
[[nodiscard]] double thread_time();

/// [us]  Measures the processor time of one call.
template <typename Function>
[[nodiscard]] double time_of(const Function& function) {
  const double begin = thread_time();
  function();
  return thread_time() - begin;
}

/// Fills the caches with other data: reads and writes a buffer larger than all of them.
void evict_caches();

/// Returns the value that a part q of the sorted values does not exceed; NaN where there are none.
[[nodiscard]] double quantile(std::vector<double> values, double q);

}  // namespace firstcontact::benchmarks
