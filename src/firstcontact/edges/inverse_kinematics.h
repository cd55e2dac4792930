/// @file
/// Places of joints that bring a link to a pose: numerical inverse kinematics with limits.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// A frame of a link that is to be at a pose.
struct LinkPoseGoal {
  std::size_t link = 0;   ///< The link, in the mover's model.
  std::size_t mover = 0;  ///< The mover, in the space; the other movers stay where they start.
  Pose X_LT = {};         ///< The frame T, fixed in the link.
  Pose X_WT = {};         ///< The pose that T shall have.
  double position_tolerance = 1e-6;  ///< [m]  > 0
  double rotation_tolerance = 1e-6;  ///< [rad]  > 0; pi or more: any rotation will do.
};

/// A place of the joints, and the errors of T's pose there.
struct ReachedPose {
  Configuration q;
  double position_error = 0.0;  ///< [m]  An upper bound, rounding included.
  /// [rad]  An upper bound of the angle between the two rotations, rounding included.
  double rotation_error = 0.0;
};

/// The options of reach_pose().
struct ReachOptions {
  std::size_t places = 8;  ///< Most places that are found.
  /// Number of places at which the search begins: the start, then random ones.
  std::size_t tries = 300;
  /// Whether a place is acceptable, such as a free one; others are passed over. All, where empty.
  std::function<bool(const Configuration&)> accepts = {};
  std::uint64_t seed = 1;
  /// Time at which the search ends with the places found so far.
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  std::stop_token stop = {};  ///< Ends the search in the same way.
};

/// Finds places that bring a link to a pose, within all limits; those nearest to the start first.
///
/// Damped least squares (C. Wampler, "Manipulator inverse kinematic solutions based on vector
/// formulations and damped least-squares methods", IEEE Transactions on Systems, Man, and
/// Cybernetics 16 (1986)), from the start and from random places. Coordinates that would leave
/// their limits are held there while the others go on. Poses of floating joints and bodies stay.
/// Where the pose itself is not reached, a second search heads for its tolerances alone. The result
/// is the same for a seed. An empty result proves nothing: there may be a place.
///
/// @param start  a configuration of the space
/// @returns  places with both errors within the tolerances. No two are closer than 1e-3 by the
/// space's length. Where no place reaches the pose, accepted or not: the nearest one, whose errors
/// are larger. Empty where none was accepted, and where the time was over before the first.
/// @throws std::invalid_argument for a space without coordinates, an unknown link, a start of
/// another size,
///         a pose that is not finite or has a zero quaternion, or a tolerance that is not > 0
[[nodiscard]] FIRSTCONTACT_API std::vector<ReachedPose> reach_pose(
    const ConfigurationSpace& space, const LinkPoseGoal& goal, const Configuration& start,
    const ReachOptions& options = {});

/// Whether a place meets the tolerances of a goal.
[[nodiscard]] FIRSTCONTACT_API bool reaches(const ReachedPose& place, const LinkPoseGoal& goal);

}  // namespace firstcontact
