/// @file
/// The accuracy with which a robot follows its nominal motion.

#pragma once

#include <firstcontact/math/export.h>

namespace firstcontact {

struct Joint;

/// The most by which a joint may be off its nominal motion, at any time.
struct TrackingError {
  double angle = 0.0;     ///< [rad]  For a joint that turns; >= 0.
  double distance = 0.0;  ///< [m]  For a joint that slides; >= 0.
};

/// The error of a joint of one coordinate, in the unit of the coordinate.
///
/// @param coordinate  [rad or m]
/// @throws std::invalid_argument if the joint has no coordinate, or more than one
[[nodiscard]] FIRSTCONTACT_API TrackingError tracking_error_of(const Joint& joint,
                                                               double coordinate);

}  // namespace firstcontact
