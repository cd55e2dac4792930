/// @file
/// What a planner found.

#pragma once

#include <vector>

#include <firstcontact/edges/configuration_space.h>

namespace firstcontact::detail {

/// A path from the start as far as a planner came.
struct FoundPath {
  std::vector<Configuration> places;  ///< Of proven edges; at least the start.
  bool reaches_goal = false;          ///< Else it ends as near to a goal as was reached.
};

}  // namespace firstcontact::detail
