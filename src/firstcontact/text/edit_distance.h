/// @file
/// How far two words are apart: finds what a misspelt name means.

#pragma once

#include <cstddef>
#include <string_view>

namespace firstcontact::detail {

/// The least number of letters to insert, remove, replace or swap with a neighbour (the optimal
/// string alignment distance). Takes time in proportion to the product of the lengths.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace firstcontact::detail
