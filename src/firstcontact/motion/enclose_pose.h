/// @file
/// Where a body can be during a window of time.

#pragma once

#include <firstcontact/math/export.h>
#include <firstcontact/math/interval_vector.h>
#include <firstcontact/motion/motion.h>

namespace firstcontact {

/// Contains R_WB and p_WC of the path's point C at every time of the window, for the exact motion.
///
/// About as wide as the motion is long, and a few roundings: the state in the middle is turned by
/// the rest of the angle, which serves any number of turns.
///
/// @param t  [-]  within the path's piece
FIRSTCONTACT_API IntervalTransform enclose_pose(const ConstantRatePath& path, const Interval& t);

/// Contains X_WB at every time of the window, across all pieces that it touches.
///
/// @param t  [-]  within [0, 1]
FIRSTCONTACT_API IntervalTransform enclose_pose(const Motion& motion, const Interval& t);

}  // namespace firstcontact
