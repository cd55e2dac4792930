/// @file
/// True first contact of two small triangle soups, slow and independent of the library. It proves
/// separation by intervals over windows of time, with brute force over all pairs.

#pragma once

#include <cstddef>
#include <memory>

#include "support/moving_soup.h"

namespace firstcontact::oracle {

enum class TruthKind {
  free,     ///< Proven: d(t) > margin on all of [0, 1].
  contact,  ///< Proven: d > margin on [0, lo), d(t') <= margin + 1e-20 size at some t' in [lo, hi].
  gave_up,  ///< The least gap is within 1e-20 of the size of zero, or the proof needs too many
            ///< windows.
};

struct Truth {
  TruthKind kind = TruthKind::gave_up;
  double lo = 0.0;          ///< [-]  Bound, rounded downwards.
  double hi = 1.0;          ///< [-]  Bound, rounded upwards.
  std::size_t windows = 0;  ///< Number of windows of time that were tested.
};

/// [m]  Bounds lower <= d(t) <= upper.
struct DistanceBounds {
  double lower = 0.0;
  double upper = 0.0;
};

class FirstContactOracle {
 public:
  FirstContactOracle(const MovingSoup& A, const MovingSoup& B, double margin);
  ~FirstContactOracle();
  FirstContactOracle(const FirstContactOracle&) = delete;
  FirstContactOracle& operator=(const FirstContactOracle&) = delete;

  /// @param window_budget  number of windows after which it gives up
  Truth first_contact(std::size_t window_budget = 20'000);

  /// Bounds the distance of the thickened soups at one time.
  DistanceBounds distance(double t);

  /// Returns whether d(t) <= margin + tolerance is proven, with an exact sum.
  bool within(double t, double tolerance);

  /// [m]  Returns the greatest of the soups' radii (about the middle of their boxes) and the
  /// margin.
  [[nodiscard]] double size() const;

 private:
  class Search;
  std::unique_ptr<Search> search_;
};

}  // namespace firstcontact::oracle
