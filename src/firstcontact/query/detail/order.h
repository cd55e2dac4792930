/// @file
/// The order in which two bodies are treated, and the pieces of time that they share.

#pragma once

#include <algorithm>
#include <cstddef>

#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// Whether A comes before B by content, so that a query and its swap do the same arithmetic.
inline bool in_order(const MovingShape& A, const MovingShape& B) {
  const int shapes = A.shape.compare(B.shape);
  return shapes != 0 ? shapes < 0 : A.X_WS.compare(B.X_WS) <= 0;
}

/// Walks the pieces of time over which both motions are smooth.
class SharedPiece {
 public:
  SharedPiece(const Motion& A, const Motion& B) : A_(A.breaks()), B_(B.breaks()) {}

  [[nodiscard]] bool valid() const { return begin_ < 1.0; }
  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] double end() const { return std::min(A_[index_A_ + 1], B_[index_B_ + 1]); }
  [[nodiscard]] std::size_t index_A() const { return index_A_; }
  [[nodiscard]] std::size_t index_B() const { return index_B_; }

  void next() {
    begin_ = end();
    index_A_ += A_[index_A_ + 1] == begin_ ? 1 : 0;
    index_B_ += B_[index_B_ + 1] == begin_ ? 1 : 0;
  }

 private:
  std::span<const double> A_;
  std::span<const double> B_;
  std::size_t index_A_ = 0;
  std::size_t index_B_ = 0;
  double begin_ = 0.0;
};

}  // namespace firstcontact::detail
