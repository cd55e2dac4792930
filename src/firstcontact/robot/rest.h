/// @file
/// Tests whether a motion is a rest.

#pragma once

#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/robot/robot_motion.h>

namespace firstcontact {

/// Whether a motion has one piece, which neither turns nor moves.
///
/// Whole turns count as turning, though the poses at both ends are the same.
[[nodiscard]] FIRSTCONTACT_API bool rests(const Motion& motion);

/// Whether a coordinate has one value at all times.
[[nodiscard]] FIRSTCONTACT_API bool rests(const CoordinatePath& path);

/// Whether the motion of a joint is a rest.
[[nodiscard]] FIRSTCONTACT_API bool rests(const JointMotion& motion);

}  // namespace firstcontact
