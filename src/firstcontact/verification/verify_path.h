/// @file
/// Proves a planned path a second time, by other code.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/verification/proof_verdict.h>
#include <firstcontact/verification/verify_result.h>

namespace firstcontact {

struct PlannedPath;

struct PathVerification {
  ProofVerdict verdict = ProofVerdict::not_proven;
  std::string problem;  ///< One sentence; empty where all is proven.
  /// The pair that is left open or too close; times are those within the edge, from 0 to 1.
  std::optional<ProofMoment> problem_at = {};
  std::optional<std::size_t> problem_edge = {};  ///< From 0.
  std::size_t edges = 0;                         ///< Proven, from the start on.
  bool reaches_goal = false;  ///< The last waypoint is one of the goals; else it is approximate.
  std::size_t tested = 0;     ///< Pairs of which one moves along edges.
  std::vector<std::string> warnings = {};  ///< Of reading the scene's files.
};

/// Proves a path again, edge by edge, with other code than that which plans.
///
/// Proven is of each edge, for the exact motion between its two waypoints: every tested pair of
/// which one moves along edges is farther apart than its margin and the extra clearance, strictly,
/// at all times of the edge, both ends included; and no such pair comes closer than the `clearance`
/// of the edge, but for 2^-20 of it and rounding. With tracking errors the first holds for all
/// motions within them, and the second is left out. Of a path of one waypoint this is proven of the
/// place. Where the surroundings move, edges run at the times of the file, and every link of the
/// mover counts as one that moves. A path begins where its scene has the mover, and one that calls
/// itself proven ends at the goal that it names, both bit for bit. The distance to the nearest goal
/// is measured again. Joints keep their limits, but for 1e-9.
///
/// Not proven again are costs and how the path was found.
///
/// @throws std::invalid_argument if a mesh or robot file is not what it was when the path was
///         planned, or the scene is not covered; ParseError if a file cannot be loaded
[[nodiscard]] FIRSTCONTACT_API PathVerification
verify_path(const PlannedPath& path, const VerifyResultOptions& options = {});

}  // namespace firstcontact
