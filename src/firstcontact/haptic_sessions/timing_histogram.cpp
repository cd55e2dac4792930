#include <firstcontact/haptic_sessions/timing_histogram.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace firstcontact {
namespace {

constexpr unsigned kFirstOctave = 4;
constexpr unsigned kBitsInOctave = 3;

}  // namespace

std::int64_t TimingHistogram::begin_of(std::size_t bucket) noexcept {
  if (bucket == 0) {
    return 0;
  }
  const std::size_t octave = bucket >> kBitsInOctave;
  const std::size_t part = bucket & ((1U << kBitsInOctave) - 1);
  return static_cast<std::int64_t>(((std::uint64_t{1} << kBitsInOctave) + part)
                                   << (octave + kFirstOctave - kBitsInOctave));
}

void TimingHistogram::add(std::int64_t duration_ns) noexcept {
  const auto duration = static_cast<std::uint64_t>(std::max<std::int64_t>(duration_ns, 0));
  std::size_t bucket = 0;
  if (duration >= std::uint64_t{1} << kFirstOctave) {
    const auto octave = static_cast<unsigned>(std::bit_width(duration)) - 1;
    const std::uint64_t part =
        duration >> (octave - kBitsInOctave) & ((std::uint64_t{1} << kBitsInOctave) - 1);
    bucket = ((octave - kFirstOctave) << kBitsInOctave) + static_cast<std::size_t>(part);
  }
  ++counts_[std::min(bucket, kBuckets - 1)];
  ++count_;
  greatest_ = std::max(greatest_, duration_ns);
}

std::int64_t TimingHistogram::quantile_ns(double share) const noexcept {
  const double wanted = share * static_cast<double>(count_);
  std::uint64_t sum = 0;
  for (std::size_t k = 0; k < kBuckets; ++k) {
    sum += counts_[k];
    if (sum > 0 && static_cast<double>(sum) >= wanted) {
      return k + 1 < kBuckets ? std::min(begin_of(k + 1), greatest_) : greatest_;
    }
  }
  return greatest_;
}

}  // namespace firstcontact
