/// @file
/// The ties of an island at the present places of its bodies: the rows of joints and taut cables.

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

/// An end of a tie in a contact problem.
struct TiedSide {
  std::optional<std::size_t> place = {};  ///< Index of its body in the problem; none for the world.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]  p_WC of its body.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< [m]  Point at which impulses act.
  /// Set for a body whose angular velocity is given in its axes before the turn `turned`.
  const Inertia* inertia = nullptr;
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();  ///< [rad]
};

/// Makes the row of a direction.
[[nodiscard]] TieRow row_along(const TieDirection& direction, const std::array<TiedSide, 2>& sides);

/// [m/s or rad/s]  Computes the speed at which the sides part along a row, as bodies of a problem
/// move.
[[nodiscard]] double speed_along(const TieRow& row, const std::vector<ContactBody>& bodies);

/// Whether a cable has its full length, or almost so.
[[nodiscard]] bool is_taut(const IslandState& state, const SimTie& tie, const TiePlace& place);

/// Finds the present place of a tie.
[[nodiscard]] TiePlace place_now(IslandState& state, const SimTie& tie);

/// Adds the bodies around the island that are tied to it.
void add_tied_bodies(IslandState& state, ProblemBodies& bodies);

/// Whether joints of an island may be redundant: those of a loop, of a robot or of a body with
/// locked axes. Other joints form a tree of bodies that move freely.
[[nodiscard]] bool may_be_redundant(const IslandState& state);

/// Finds the rows of joints that follow from the rows before them, at the present places.
[[nodiscard]] std::vector<bool> redundant_rows(IslandState& state, const ProblemBodies& bodies);

/// Makes the rows of joints and of taut cables at the present places of bodies. Velocities or
/// displacements along them are 0.
[[nodiscard]] std::vector<TieRow> rigid_rows(IslandState& state, const ProblemBodies& bodies);

/// Adds the impulses of ties on robots at an impact.
void add_outer_of_ties(const ContactProblem& problem, const ContactSolution& solution,
                       const ProblemBodies& bodies, std::vector<OuterImpulse>& outer);

/// Whether bodies move against joints or taut cables, faster than a plan may correct.
[[nodiscard]] bool any_tie_is_hit(IslandState& state);

/// [-]  Finds the share of a plan before a cable that does not stretch becomes taut.
[[nodiscard]] double share_within_cables(IslandState& state, const Plan& plan, double span);

/// Whether joints are farther apart at the end of a plan than a contact distance, or taut cables
/// longer by one. Those that are already get no farther apart.
///
/// This happens where a script pulls a body that cannot follow, and where a singular loop has no
/// solution.
[[nodiscard]] bool tears_ties(IslandState& state, const Plan& plan, double span);

/// Whether a scripted body that moves in the step is tied to one of these.
[[nodiscard]] bool is_pulled(const SimulationModel& model, const StepStart& start,
                             const std::vector<std::size_t>& members);

}  // namespace firstcontact::detail
