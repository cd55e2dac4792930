/// @file
/// The ties of an island where its bodies are now: what joints and taut cables hold.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/simulation_model/detail/island_robots.h>
#include <firstcontact/simulation_model/detail/sim_tie.h>

namespace firstcontact::detail {

class ProblemBodies;
struct IslandState;
struct Plan;
struct SimulationModel;
struct StepStart;

/// An end of a tie as a contact problem has it.
struct TiedSide {
  std::optional<std::size_t> place = {};             ///< Of its body; none: the world.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]  p_WC of its body.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< [m]  Where impulses act.
  const Inertia* inertia = nullptr;                  ///< Of a body whose angular velocity is in
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();  ///< [rad]  its axes before this turn.
};

/// The row of a direction.
[[nodiscard]] TieRow row_along(const TieDirection& direction, const std::array<TiedSide, 2>& sides);

/// [m/s or rad/s]  How fast its sides part along a row, as bodies of a problem move.
[[nodiscard]] double speed_along(const TieRow& row, const std::vector<ContactBody>& bodies);

/// Whether a cable is as long as it gets, or nearly so.
[[nodiscard]] bool is_taut(const IslandState& state, const SimTie& tie, const TiePlace& place);

[[nodiscard]] TiePlace place_now(IslandState& state, const SimTie& tie);

/// Adds the bodies around the island that are tied to it.
void add_tied_bodies(IslandState& state, ProblemBodies& bodies);

/// Whether joints of an island may say anything twice: those of a loop, of a robot or of a body
/// with locked axes. Others are a tree of bodies that move freely.
[[nodiscard]] bool may_be_redundant(const IslandState& state);

/// Tells which rows of joints follow from the rows before them, where bodies are now.
[[nodiscard]] std::vector<bool> redundant_rows(IslandState& state, const ProblemBodies& bodies);

/// The rows of joints and of taut cables where bodies are now: velocities or displacements along
/// them are none.
[[nodiscard]] std::vector<TieRow> rigid_rows(IslandState& state, const ProblemBodies& bodies);

/// Adds what the ties of an impact do to robots.
void add_outer_of_ties(const ContactProblem& problem, const ContactSolution& solution,
                       const ProblemBodies& bodies, std::vector<OuterImpulse>& outer);

/// Whether bodies move against joints or taut cables, faster than what a plan may take up.
[[nodiscard]] bool any_tie_is_hit(IslandState& state);

/// [-]  How far a plan may be followed before a cable that does not stretch becomes taut.
[[nodiscard]] double share_within_cables(IslandState& state, const Plan& plan, double span);

/// Whether joints are farther apart where a plan ends than a contact distance, or taut cables
/// longer by one.
///
/// They are where a script pulls at what cannot follow, and where a singular loop has no solution.
[[nodiscard]] bool tears_ties(IslandState& state, const Plan& plan, double span);

/// Whether a scripted body that moves in the step is tied to one of these.
[[nodiscard]] bool is_pulled(const SimulationModel& model, const StepStart& start,
                             const std::vector<std::size_t>& members);

}  // namespace firstcontact::detail
