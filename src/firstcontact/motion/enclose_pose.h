/// @file
/// Enclosures of the pose of a body over a window of time.

#pragma once

#include <firstcontact/math/export.h>
#include <firstcontact/math/interval_vector.h>
#include <firstcontact/motion/motion.h>

namespace firstcontact {

/// Encloses R_WB and p_WC of the path's point C at every time of the window, for the exact motion.
///
/// The width is about the length of the motion, and a few roundings. The state in the middle is
/// turned by the rest of the angle. This serves any number of turns.
///
/// @param t  [-]  within the path's piece
FIRSTCONTACT_API IntervalTransform enclose_pose(const ConstantRatePath& path, const Interval& t);

/// Encloses X_WB at every time of the window, across all pieces that it touches.
///
/// @param t  [-]  within [0, 1]
FIRSTCONTACT_API IntervalTransform enclose_pose(const Motion& motion, const Interval& t);

}  // namespace firstcontact
