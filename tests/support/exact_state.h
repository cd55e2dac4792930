/// @file
/// Exact pose of a body at one time.

#pragma once

#include <cstddef>

#include "support/exact_motion.h"

namespace firstcontact::oracle {

/// A piece of an exact motion at one time.
class ExactState {
 public:
  ExactState(const MotionPiece& piece, double t)
      : piece_(piece),
        s_((Wide(t) - Wide(piece.t_begin)) / (Wide(piece.t_end) - Wide(piece.t_begin))) {}

  /// Returns the body point at the end of the levers.
  [[nodiscard]] Vector3<Wide> center() const {
    return piece_.pivot + s_ * piece_.travel + rotated(piece_.lever);
  }
  /// Returns a column of R_WB.
  [[nodiscard]] Vector3<Wide> column(std::size_t j) const { return rotated(piece_.R.column[j]); }

 private:
  [[nodiscard]] Vector3<Wide> rotated(const Vector3<Wide>& v) const {
    if (piece_.angle.is_zero()) {
      return v;
    }
    const Wide angle = s_ * piece_.angle;
    const Vector3<Wide> along = dot(piece_.axis, v) * piece_.axis;
    return along + cos(angle) * (v - along) + sin(angle) * cross(piece_.axis, v);
  }

  const MotionPiece& piece_;
  Wide s_;
};

}  // namespace firstcontact::oracle
