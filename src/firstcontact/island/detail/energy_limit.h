/// @file
/// The energy that contacts and motors may leave to an island.

#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {

struct IslandState;

/// Whether a drive is a motor that no force holds back.
[[nodiscard]] bool is_unbounded(const JointDrive& drive);

/// [J]  The energy of the members and their robots.
[[nodiscard]] double energy_of(const IslandState& state, const ContactProblem& problem,
                               const std::vector<ContactBody>& bodies,
                               const std::vector<Eigen::VectorXd>& mechanisms);

/// Whether motors without bound squeeze bodies out much faster than they want to move links.
///
/// The laws of contacts permit that where a wedge closes slowly. Such motors yield, as where
/// contacts have no solution. Much faster means: the root of the energy is kMostSqueeze times as
/// large as before, plus that of all bodies at the speed of the motors' targets.
///
/// @param free  [J]  energy before; if nothing, that of the problem's velocities
[[nodiscard]] bool squeezes_out(const IslandState& state, const ContactProblem& problem,
                                const ContactSolution& solution, std::optional<double> free);

/// Limits the energy of a solution: contacts add none.
///
/// Without moving bodies around, rest meets all contacts, so the projection on them makes no
/// velocity longer in the kinetic metric. A scripted body adds at most its own speed twice, and so
/// does a belt. A contact that turns may need as much as a belt of its change of velocity: its
/// velocities at the end point along its circle there. The planner limits what such contacts add
/// over a plan. For a problem without solution, as for a crushed body, the solver's answer is
/// arbitrary. It is shortened to the energy before, or to that of moving with the script. An
/// isolated island keeps its momenta. Motors add what they want, as long as there is a solution.
/// Where motors without bound yield there is none. All bodies are then at most as fast as these
/// motors want to move links, and bounded motors add their work.
///
/// @param yields  whether motors without bound yield in the solution
/// @param free    [J]  energy before; if nothing, that of the problem's velocities
/// @returns whether it was shortened
bool limit_energy(const IslandState& state, const ContactProblem& problem,
                  ContactSolution& solution, bool yields = false,
                  std::optional<double> free = std::nullopt);

}  // namespace firstcontact::detail
