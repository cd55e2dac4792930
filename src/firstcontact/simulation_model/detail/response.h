/// @file
/// Contact problems of an island: the effect of its contacts on velocities.

#pragma once

#include <cstddef>
#include <functional>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>

namespace firstcontact::detail {

struct ManifoldPoint;

/// The bodies of a problem: the members of an island first, in their order there.
///
/// Behind them come the fixed and scripted bodies that they touch.
class ProblemBodies {
 public:
  /// Adds a body.
  ///
  /// @returns its place
  std::size_t add(std::size_t body, const ContactBody& with, const Eigen::Vector3d& p_WC);

  [[nodiscard]] bool has(std::size_t body) const { return place_.contains(body); }
  [[nodiscard]] std::size_t place(std::size_t body) const { return place_.at(body); }
  [[nodiscard]] const std::vector<ContactBody>& bodies() const { return bodies_; }
  [[nodiscard]] const Eigen::Vector3d& centre(std::size_t place) const { return centres_[place]; }

 private:
  std::unordered_map<std::size_t, std::size_t> place_;
  std::vector<ContactBody> bodies_;
  std::vector<Eigen::Vector3d> centres_;  // [m]  p_WC
};

/// Makes a contact of the problem at a manifold point, whose impulse starts the solver.
///
/// Arms are those of the bodies' present centres.
[[nodiscard]] ContactPoint contact_at(const ManifoldPoint& touch, const ProblemBodies& bodies,
                                      double friction, double least_normal_velocity);

/// [m/s]  The velocity of B's point relative to A's, in the contact's frame.
[[nodiscard]] Eigen::Vector3d relative_velocity(const ContactPoint& contact,
                                                const std::vector<ContactBody>& bodies);

/// [m/s]  The part of that velocity along the normal.
[[nodiscard]] double normal_velocity(const ContactPoint& contact,
                                     const std::vector<ContactBody>& bodies);

/// Projects an impact: all contacts answer at once by Newton's law, each with its restitution.
///
/// Newton's law with friction can add energy (T. R. Kane, D. A. Levinson, "Dynamics: Theory and
/// Applications", 1985). Where it would, all restitutions are lowered by one factor until no energy
/// is added. The velocities are then on the line from the answer without restitution, which loses
/// energy, to the one with it.
///
/// @param restitution  one for each contact, whose least normal velocity is replaced
/// @param members      number of the first bodies, whose energy counts
/// @param energy       [J]  of velocities of bodies and mechanisms
[[nodiscard]] ContactSolution project_impact(
    ContactProblem problem, const std::vector<double>& restitution, std::size_t members,
    const std::function<double(const std::vector<ContactBody>&,
                               const std::vector<Eigen::VectorXd>&)>& energy,
    const ProjectionOptions& options);

/// The solution with unchanged velocities.
[[nodiscard]] ContactSolution unchanged(const ContactProblem& problem);

/// The velocities of the mechanisms.
[[nodiscard]] std::vector<Eigen::VectorXd> velocities_of(
    const std::vector<ContactMechanism>& mechanisms);

/// [J]  The sum of 1/2 v^T M v over the mechanisms, with these velocities.
[[nodiscard]] double kinetic_energy(const std::vector<ContactMechanism>& mechanisms,
                                    const std::vector<Eigen::VectorXd>& velocities);

}  // namespace firstcontact::detail
