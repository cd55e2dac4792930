/// @file
/// The places that a planner reached, with the edges between them.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <firstcontact/edges/configuration_space.h>

namespace firstcontact {

/// The kinds of trees that a planner grows.
enum class SearchTreeKind {
  from_start,  ///< A tree whose root is the start.
  from_goals,  ///< One tree for each goal, all of them together.
  roadmap,     ///< The graph of a roadmap planner: start, goals and samples.
};

/// The words of a kind in files, in this order.
inline constexpr std::array<const char*, 3> kSearchTreeWords{"start", "goals", "roadmap"};

/// Places that are free, and those edges between them that the search proved free.
struct SearchTree {
  SearchTreeKind kind = SearchTreeKind::from_start;
  std::vector<Configuration> places = {};
  /// [s]  Time of each place where the environment moves; else empty.
  std::vector<double> times = {};
  /// The two ends of each edge, by the numbers of places.
  ///
  /// In a tree the first is the parent of the second, and each place but a root has one parent.
  /// Trees from goals grow backward in time: the mover goes from the second to the first.
  std::vector<std::array<std::size_t, 2>> edges = {};
};

}  // namespace firstcontact
