/// @file
/// The tolerance that the rounding of doubles explains, for a contact that states one of its own.

#pragma once

#include <cstddef>

namespace firstcontact::detail {

class SceneCourses;

/// [m]  The part of one member in what doubles explain, over the whole step; that of a pair is the
/// sum of both, and at least the tolerance that was asked.
///
/// A check takes a larger tolerance than the asked one for two reasons. Distances are not told
/// apart below a share of the sizes and places of the two, and no time below 2^-53 of the step,
/// in which fast members go further. Both shares here are 8 times what a check takes at most, or
/// more.
[[nodiscard]] double explained_tolerance(const SceneCourses& courses, std::size_t member);

}  // namespace firstcontact::detail
