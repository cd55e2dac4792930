/// @file
/// The tolerance that the rounding of doubles explains, for a contact with a tolerance of its own.

#pragma once

#include <cstddef>

namespace firstcontact::detail {

class SceneCourses;

/// [m]  The share of one member in the explained tolerance, over the whole step.
///
/// That of a pair is the sum of both, and at least the tolerance that was asked for. A check takes
/// a larger tolerance for two reasons. It does not distinguish distances below a share of the sizes
/// and places of the two. It does not distinguish times below 2^-53 of the step, in which fast
/// members move farther. Both shares here are at least 8 times the greatest that a check takes.
[[nodiscard]] double explained_tolerance(const SceneCourses& courses, std::size_t member);

}  // namespace firstcontact::detail
