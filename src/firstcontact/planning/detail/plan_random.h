/// @file
/// Random numbers of planners: the same for a seed with every standard library.

#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace firstcontact::detail {

class PlanRandom {
 public:
  explicit PlanRandom(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  /// Below count, which is at least 1.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace firstcontact::detail
