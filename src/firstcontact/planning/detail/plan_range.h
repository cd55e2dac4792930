/// @file
/// The default length of the edges of trees.

#pragma once

#include <firstcontact/edges/configuration_space.h>

namespace firstcontact::detail {

/// The longest edge of a tree by default, in the length of the space.
///
/// It is a share of the mean distance of random places.
[[nodiscard]] double default_range(const ConfigurationSpace& space);

}  // namespace firstcontact::detail
