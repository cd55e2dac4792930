/// @file
/// The path that a planner found.

#pragma once

#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/planning/search_tree.h>

namespace firstcontact::detail {

/// A path from the start, as far as a planner came.
struct FoundPath {
  std::vector<Configuration> places;  ///< Places between proven edges; at least the start.
  bool reaches_goal = false;  ///< Whether it ends at a goal; else it ends as near to a goal as the
                              ///< search came.
  std::vector<SearchTree> trees = {};  ///< Empty without PlanOptions::keep_trees.
};

}  // namespace firstcontact::detail
