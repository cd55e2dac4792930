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

/// The answer of a second proof of a path.
struct PathVerification {
  ProofVerdict verdict = ProofVerdict::not_proven;
  std::string problem;  ///< One sentence; empty where all is proven.
  /// The pair that is left open or too close; times are those within the edge, from 0 to 1.
  std::optional<ProofMoment> problem_at = {};
  std::optional<std::size_t> problem_edge = {};  ///< From 0.
  std::size_t edges = 0;                         ///< Number of proven edges, from the start on.
  bool reaches_goal = false;  ///< Whether the last waypoint is one of the goals; else the path is
                              ///< approximate.
  std::size_t tested = 0;     ///< Number of pairs with a member that moves along edges.
  std::vector<std::string> warnings = {};  ///< Warnings of reading the scene's files.
};

/// Proves a path again, edge by edge, with other code than that which plans.
///
/// The proof is about the exact motion between the two waypoints of each edge. It covers every
/// tested pair with a member that moves along edges, at all times of the edge, the ends included.
/// - The pair is farther apart than its margin and the extra clearance, strictly.
/// - The pair comes no closer than the `clearance` of the edge, except for 2^-20 of it and
///   rounding.
///
/// With tracking errors the first holds for all motions within them, and the second is left out.
/// For a path of one waypoint the proof is about that place. Where the environment moves, edges run
/// at the times of the file. Every link of the mover then counts as one that moves.
///
/// A path begins where its scene has the mover. One that calls itself proven ends at the goal that
/// it names. Both hold bit for bit. The distance to the nearest goal is measured again. Joints keep
/// their limits, except for 1e-9.
///
/// Not proven again are costs and how the path was found.
///
/// @throws std::invalid_argument if a mesh or robot file has changed since the path was planned, or
///         the scene is not covered
/// @throws ParseError if a file cannot be loaded
[[nodiscard]] FIRSTCONTACT_API PathVerification
verify_path(const PlannedPath& path, const VerifyResultOptions& options = {});

}  // namespace firstcontact
