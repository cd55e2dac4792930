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

/// A part of a step without impacts.
struct TrackPiece {
  double to = 0.0;  ///< [s]  Since the step began.
  Pose X_WB;        ///< At its begin.
  Move move;
  RigidState begin;  ///< Velocities at its begin.
  RigidState end;    ///< Pose and velocities at its end.
};

/// The impulse of a tie over a piece.
struct TieTrackPiece {
  std::size_t tie = 0;                                ///< Of the model.
  double from = 0.0;                                  ///< [s]  Since the step began.
  double to = 0.0;                                    ///< [s]
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [N s]    On the second body, at its
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [N m s]  point.
};

/// Whether the bodies of an island are at rest.
enum class Rest {
  no,
  begins,   ///< From the end of the step on: their velocities are none there.
  goes_on,  ///< Since a step before.
};

/// How the bodies of an island move over a step, or over as much of it as could be proven free.
struct IslandTrack {
  std::vector<std::size_t> members;             ///< Free bodies.
  std::vector<std::vector<TrackPiece>> pieces;  ///< Of each member.
  std::vector<RobotTrack> robots = {};          ///< Whose links are members.
  std::vector<ManifoldPoint> touches = {};      ///< That acted last, with their impulses.
  std::vector<RunImpact> impacts = {};          ///< In the order of time.
  std::vector<TieTrackPiece> ties = {};
  std::vector<std::size_t> crushing = {};  ///< Scripted bodies that jam the island,
  double crushed = 0.0;                    ///< and [s] from when on they do; 0 if it is not known.
  double reached = 0.0;                    ///< [s]
  double clearance = 0.0;  ///< [m]  No pair with a member came closer; infinite if none was near.
  double residual = 0.0;   ///< [m/s]
  std::size_t events = 0;
  Rest rests = Rest::no;
};

/// Advances the free bodies `members`, of a robot all its links or none, with all fixed and
/// scripted bodies around them, and without any other.
///
/// Until the step is over: velocities are what gravity, forces and the contacts within the band
/// make of them (Gauss' principle); the in-between motion over the rest of the step is asked for
/// its first contact. Where it is slight, it becomes a constraint of the same span; else all move
/// until it, and the impact is projected there. Where that brings a pair nearer than where it
/// rests, less than the rest of the step is planned at a time.
///
/// @param bare_robots  robots of the island without geometry; they touch nothing
/// @returns  nothing if it was stopped
[[nodiscard]] std::optional<IslandTrack> advance_island(
    const StepContext& step, std::vector<std::size_t> members, Workspace& workspace,
    const std::vector<std::size_t>& bare_robots = {});

}  // namespace firstcontact::detail
