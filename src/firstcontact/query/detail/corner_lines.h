/// @file
/// The lines that the corners of two bodies move on, in double-double.

#pragma once

#include <cstdint>

#include <firstcontact/motion/relative_state.h>
#include <firstcontact/narrowphase/precise_linear_contact.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// Two triangles, and how far their corners may be from the exact motion's.
struct LinearTriangles {
  PreciseLinearFeature A;
  PreciseLinearFeature B;
  double position_error = 0.0;  ///< [m]
};

/// Two bodies; refers to them.
class CornerLines {
 public:
  CornerLines(const MovingShape& A, const MovingShape& B) : A_(A), B_(B) {}

  /// Whether corners move on lines for all of the step, each at its own constant velocity: neither
  /// body turns, and double-doubles hold the sizes.
  [[nodiscard]] bool exist(const RelativeState& state) const;

  /// @param triangle_A,triangle_B  in the hierarchies' order
  [[nodiscard]] LinearTriangles triangles(std::uint32_t triangle_A, std::uint32_t triangle_B) const;

 private:
  MovingShape A_;
  MovingShape B_;
};

}  // namespace firstcontact::detail
