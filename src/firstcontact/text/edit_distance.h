/// @file
/// The distance of two words, to find the meaning of a misspelt name.

#pragma once

#include <cstddef>
#include <string_view>

namespace firstcontact::detail {

/// The least number of letters to insert, remove, replace or swap with a neighbour.
///
/// This is the optimal string alignment distance. The time is proportional to the product of the
/// lengths.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace firstcontact::detail
