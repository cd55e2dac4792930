/// @file
/// Bodies that act on each other within a step, advanced together.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/query/workspace.h>
#include <firstcontact/record/run_step.h>
#include <firstcontact/simulation_model/detail/island_robots.h>
#include <firstcontact/simulation_model/detail/manifold.h>
#include <firstcontact/simulation_model/detail/move.h>

namespace firstcontact::detail {

struct StepContext;

/// A piece of a step without impacts.
struct TrackPiece {
  double to = 0.0;  ///< [s]  End of the piece, since the step began.
  Pose X_WB;        ///< Pose at its begin.
  Move move;
  RigidState begin;  ///< Velocities at its begin.
  RigidState end;    ///< Pose and velocities at its end.
};

/// The impulse of a tie over a piece.
struct TieTrackPiece {
  std::size_t tie = 0;  ///< Index of the tie in the model.
  double from = 0.0;    ///< [s]  Begin, since the step began.
  double to = 0.0;      ///< [s]  End, since the step began.
  /// [N s]  Impulse on the second body, at its point.
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  /// [N m s]  Angular impulse on the second body, about its point.
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};

/// Whether the bodies of an island are at rest.
enum class Rest {
  no,
  begins,   ///< From the end of the step on: the velocities are 0 there.
  goes_on,  ///< Since an earlier step.
};

/// The motion of the bodies of an island over a step, or over the part of it that is proven free.
struct IslandTrack {
  std::vector<std::size_t> members;             ///< Free bodies.
  std::vector<std::vector<TrackPiece>> pieces;  ///< Pieces of each member.
  std::vector<RobotTrack> robots = {};          ///< The robots whose links are members.
  std::vector<ManifoldPoint> touches = {};      ///< Those that acted last, with their impulses.
  std::vector<RunImpact> impacts = {};          ///< In the order of time.
  std::vector<TieTrackPiece> ties = {};
  std::vector<std::size_t> crushing = {};  ///< Scripted bodies that jam the island,
  double crushed = 0.0;  ///< [s]  and the time from which they do; 0 if it is not known.
  double reached = 0.0;  ///< [s]  Time of the step that was reached.
  /// [m]  Bound of the distance of pairs with a member; infinite if none was near.
  double clearance = 0.0;
  double residual = 0.0;  ///< [m/s]
  std::size_t events = 0;
  Rest rests = Rest::no;
};

/// Advances the free bodies `members` among all fixed and scripted bodies around them, without any
/// other. They have all links of a robot, or none.
///
/// The following repeats until the step is over. The velocities are those that result from gravity,
/// forces and the contacts within the band (Gauss' principle). The in-between motion over the rest
/// of the step is searched for its first contact. A slight contact becomes a constraint of the same
/// span. For any other contact all bodies move until it, and the impact is projected there. Where
/// that brings a pair nearer than its rest gap, plans become shorter than the rest of the step.
///
/// @param bare_robots  robots of the island without geometry; they touch nothing
/// @returns  nothing if it was stopped
[[nodiscard]] std::optional<IslandTrack> advance_island(
    const StepContext& step, std::vector<std::size_t> members, Workspace& workspace,
    const std::vector<std::size_t>& bare_robots = {});

}  // namespace firstcontact::detail
