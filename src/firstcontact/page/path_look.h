/// @file
/// The looks of a planned path and of the search for it on a page.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/planned_path.h>

namespace firstcontact {

/// The lines along which a point of a mover runs, one for each edge.
struct TracedLines {
  std::string name;  ///< Name of the member that the point belongs to.
  /// [m]  Places in the world, joined by straight lines.
  std::vector<std::vector<Eigen::Vector3d>> lines = {};
};

/// An edge of a path on a page.
struct PathEdgeLook {
  std::optional<double> clearance = {};  ///< [m]  Proven; none where no pair is tested.
  double from = 0.0;                     ///< [-]  Step time t at which the page plays the edge.
  double to = 0.0;                       ///< [-]
};

/// A tree of a search on a page.
struct TreeLook {
  std::string kind;        ///< One of kSearchTreeWords.
  std::size_t places = 0;  ///< Number of places of the whole tree.
  std::size_t edges = 0;   ///< Number of edges of the whole tree, of which the first are drawn.
  std::vector<TracedLines> movers = {};  ///< One for each mover.
};

/// A member where it is at the goal.
struct GoalLook {
  std::size_t member = 0;
  Pose X_WM;
};

/// A path with its search, ready to be drawn. Without a path it has neither edges nor curves.
struct PathLook {
  std::string verdict;  ///< One of kPlanVerdictWords.
  std::vector<PathEdgeLook> edges = {};
  std::vector<TracedLines> movers = {};  ///< One for each mover, with a line for each edge.
  std::vector<TreeLook> trees = {};
  std::vector<NamedBlockingPair> blocked = {};  ///< The most frequent first.
  std::vector<GoalLook> goal = {};              ///< Members that move; only without a path.
};

}  // namespace firstcontact
