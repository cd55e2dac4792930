/// @file
/// The lines on which the corners of two bodies move, in double-double.

#pragma once

#include <cstdint>

#include <firstcontact/motion/relative_state.h>
#include <firstcontact/narrowphase/precise_linear_contact.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// Two triangles, and a bound of the distance of their corners from those of the exact motion.
struct LinearTriangles {
  PreciseLinearFeature A;
  PreciseLinearFeature B;
  double position_error = 0.0;  ///< [m]
};

/// The lines of the corners of two bodies; refers to the bodies.
class CornerLines {
 public:
  CornerLines(const MovingShape& A, const MovingShape& B) : A_(A), B_(B) {}

  /// Whether each corner moves on a line at a constant velocity for all of the step.
  ///
  /// That is so where neither body turns, and double-doubles hold the sizes.
  [[nodiscard]] bool exist(const RelativeState& state) const;

  /// Two triangles with the lines of their corners.
  ///
  /// @param triangle_A,triangle_B  in the hierarchies' order
  [[nodiscard]] LinearTriangles triangles(std::uint32_t triangle_A, std::uint32_t triangle_B) const;

 private:
  MovingShape A_;
  MovingShape B_;
};

}  // namespace firstcontact::detail
