#include "benchmarks/support/timing.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <limits>

namespace firstcontact::benchmarks {

double thread_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

void evict_caches() {
  static const auto last_level =
      static_cast<std::size_t>(std::max(sysconf(_SC_LEVEL3_CACHE_SIZE), 32L << 20));
  static std::vector<char> buffer(2 * last_level);
  constexpr std::size_t kCacheLine = 64;
  for (std::size_t i = 0; i < buffer.size(); i += kCacheLine) {
    static_cast<volatile char&>(buffer[i]) = static_cast<char>(buffer[i] + 1);
  }
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace firstcontact::benchmarks
