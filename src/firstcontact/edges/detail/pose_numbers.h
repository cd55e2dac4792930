/// @file
/// The seven numbers of a configuration that are a pose: a position [m], a quaternion w, x, y, z.

#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact::detail {

/// The count of numbers of a pose.
inline constexpr std::size_t kPoseNumbers = 7;

/// The pose whose numbers begin at `first`.
[[nodiscard]] Pose pose_at(const Configuration& q, std::size_t first);

/// Writes the numbers of a pose from `first` on.
void set_pose(const Pose& pose, std::size_t first, Configuration& q);

/// [rad]  The angle of the shortest rotation between two quaternions of any length.
[[nodiscard]] double angle_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to);

/// Whether two configurations have the same numbers of a pose.
[[nodiscard]] bool is_same_pose(const Configuration& a, const Configuration& b, std::size_t first);

/// The reason why seven numbers are no pose; none where they are one.
[[nodiscard]] std::optional<std::string> defect_of_pose(const Configuration& q, std::size_t first);

/// Whether the position is within the sampled box, as far as that has ends.
[[nodiscard]] bool is_in_box(const SpacePose& pose, const Configuration& q, std::size_t first);

/// The length of an edge of a body whose points are within `reach` of its origin [m]: the path
/// length of the origin plus the reach times the angle.
[[nodiscard]] double body_distance(const Pose& from, const Pose& to, double reach);

/// Draws a pose evenly: in the box, turned in any way.
[[nodiscard]] Pose sample_pose(const SpacePose& pose, RandomNumbers& random);

}  // namespace firstcontact::detail
