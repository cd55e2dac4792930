/// @file
/// How long the edges of trees are where nobody chose it.

#pragma once

#include <firstcontact/edges/configuration_space.h>

namespace firstcontact::detail {

/// The longest edge of a tree: a share of the mean distance of random places, in the length of the
/// space.
[[nodiscard]] double default_range(const ConfigurationSpace& space);

}  // namespace firstcontact::detail
