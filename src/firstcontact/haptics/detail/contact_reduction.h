/// @file
/// Reduces very many contacts to few that permit about the same motions.

#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/detail/contact_coordinates.h>

namespace firstcontact::detail {

/// The contacts that are kept.
struct ReducedContacts {
  std::vector<std::size_t> kept;  ///< Indices, increasing.
  double angle = 0.0;             ///< [rad]  See reduce_contacts(); 0 where all are kept.
};

/// Chooses contacts whose admissible cone is that of all, within an angle.
///
/// A motion x that all chosen contacts permit (n . u >= 0) leaves the half space of any other by at
/// most this angle: row . x >= -sin(angle) |row| |x|, in the coordinates of the metric. With
/// friction the same holds for the four edges n +- mu t of each cone. So the forces of dropped
/// contacts are near forces of chosen ones. Gaps do not count: listed contacts lie within a narrow
/// band.
///
/// Derivation. The rows of a dropped contact are within half the angle of those of a seen contact,
/// or are seen themselves. Seen rows are within half the angle of the cone of the rows of kept
/// contacts. Normals are so for the cone of normals, edges for that of edges. Angles to a convex
/// cone add up as those between directions. So row = sum of shares row_k + rest, with shares >= 0
/// and |rest| <= sin(angle) |row|, and row . x >= rest . x. The rest is that of a projection on the
/// cone (RowCone).
///
/// @param angle  [rad]  > 0; it is doubled until no more than `most` are kept
/// @param most   1 to kMostHapticContacts
/// @param deadline  after it nothing is claimed (angle pi), and contacts that differ most are kept
[[nodiscard]] ReducedContacts reduce_contacts(
    std::span<const HapticContact> contacts, const ToolFrames& frames, std::size_t tools,
    double angle, std::size_t most,
    const std::optional<std::chrono::steady_clock::time_point>& deadline = {});

}  // namespace firstcontact::detail
