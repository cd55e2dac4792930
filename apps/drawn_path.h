/// @file
/// A planned path and the search for it, as lines in the world that a page draws.

#pragma once

#include <vector>

#include <firstcontact/page/path_look.h>
#include <firstcontact/planning/search_tree.h>

namespace firstcontact {
struct LoadedScene;
struct PlanResult;
struct PlannedPath;
struct ScenePlan;
}  // namespace firstcontact

namespace firstcontact::app {

/// The lines of a path, taken from the scene that plays it.
///
/// @param times   [s]  when the scene is at each waypoint
/// @param played  scene_in_motion() of the path
[[nodiscard]] PathLook drawn_path(const PlannedPath& path, const std::vector<double>& times,
                                  const LoadedScene& played);

/// The look of a search that found no path: the goal, and the pairs that blocked.
[[nodiscard]] PathLook drawn_failure(const ScenePlan& plan, const PlanResult& result);

/// The trees of a search, with the edges that came first; at most 20,000 lines of all movers.
[[nodiscard]] std::vector<TreeLook> drawn_trees(const ScenePlan& plan,
                                                const std::vector<SearchTree>& trees);

}  // namespace firstcontact::app
