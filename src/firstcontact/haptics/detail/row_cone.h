/// @file
/// The convex cone of a few rows, and whether another row is near it.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <firstcontact/haptics/detail/cone_projection.h>

namespace firstcontact::detail {

/// The cone of all sums of rows with shares >= 0.
///
/// Source: C. L. Lawson, R. J. Hanson, "Solving Least Squares Problems" (1974), chapter 23. The
/// search ends as soon as a sum is near enough.
class RowCone {
 public:
  explicit RowCone(std::size_t coordinates) : n_(coordinates) {}

  void add(const Coordinates& row);

  /// Whether a sum of rows was found within a distance of a row.
  [[nodiscard]] bool is_near(const Coordinates& row, double distance);

 private:
  [[nodiscard]] const double* row_at(std::size_t number) const { return &rows_[number * n_]; }
  [[nodiscard]] double product(const double* a, const double* b) const;
  [[nodiscard]] bool solve(const Coordinates& row);
  [[nodiscard]] bool meet(const Coordinates& row);
  void measure(const Coordinates& row);

  std::size_t n_;
  std::vector<double> rows_;         // One after another.
  std::vector<std::size_t> active_;  // Rows with a share.
  std::vector<double> shares_;       // Of these.
  std::vector<double> wanted_;       // Shares without bounds.
  std::array<std::array<double, kMostCoordinates>, kMostCoordinates> factor_ = {};  // Lower.
  Coordinates rest_ = {};  // The row less the sum.
};

}  // namespace firstcontact::detail
