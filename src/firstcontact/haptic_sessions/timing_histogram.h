/// @file
/// A histogram of durations.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <firstcontact/math/export.h>

namespace firstcontact {

/// Counts durations in buckets of an eighth of an octave, from 16 ns on.
///
/// Every duration counts, late ones too. The number of buckets is fixed, so adding allocates
/// nothing.
class FIRSTCONTACT_API TimingHistogram {
 public:
  static constexpr std::size_t kBuckets = 320;  ///< Up to 2^44 ns; the last holds all longer ones.

  void add(std::int64_t duration_ns) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::uint64_t count_of(std::size_t bucket) const noexcept {
    return counts_[bucket];
  }
  /// [ns]  The begin of a bucket; 0 for the first.
  [[nodiscard]] static std::int64_t begin_of(std::size_t bucket) noexcept;
  [[nodiscard]] std::int64_t greatest_ns() const noexcept { return greatest_; }

  /// [ns]  A duration that at least this share of all do not exceed: the end of a bucket, or the
  /// greatest duration. 0 where there is none.
  ///
  /// @param share  in [0, 1]
  [[nodiscard]] std::int64_t quantile_ns(double share) const noexcept;

 private:
  std::array<std::uint64_t, kBuckets> counts_{};
  std::uint64_t count_ = 0;
  std::int64_t greatest_ = 0;
};

}  // namespace firstcontact
