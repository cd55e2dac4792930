/// @file
/// The truth about the first contact of two small triangle soups, slow and independent of the
/// library: interval proofs of separation over windows of time, brute force over all pairs.

#pragma once

#include <cstddef>
#include <memory>

#include "support/moving_soup.h"

namespace firstcontact::oracle {

enum class TruthKind {
  free,     ///< Proven: d(t) > margin on all of [0, 1].
  contact,  ///< Proven: d > margin on [0, lo), d(t') <= margin + 1e-20 size at some t' in [lo, hi].
  gave_up,  ///< The least gap is neither above zero by 1e-20 of the size nor below, or too dear.
};

struct Truth {
  TruthKind kind = TruthKind::gave_up;
  double lo = 0.0;          ///< [-]  Rounded downwards.
  double hi = 1.0;          ///< [-]  Rounded upwards.
  std::size_t windows = 0;  ///< Windows of time that were looked at.
};

/// [m]  lower <= d(t) <= upper.
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

  /// @param window_budget  gives up after so many windows
  Truth first_contact(std::size_t window_budget = 20'000);

  /// The distance of the thickened soups at one time.
  DistanceBounds distance(double t);

  /// Whether d(t) <= margin + tolerance is proven, the sum taken exactly.
  bool within(double t, double tolerance);

  /// [m]  The larger of the two soups' radii (about the middle of their boxes), and the margin.
  [[nodiscard]] double size() const;

 private:
  class Search;
  std::unique_ptr<Search> search_;
};

}  // namespace firstcontact::oracle
