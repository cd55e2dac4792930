/// @file
/// Proofs that no velocities meet the laws of a contact problem, such as between the jaws of a
/// press.

#pragma once

#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>
#include <firstcontact/contact_solver/detail/mass_whitened_coordinates.h>

namespace firstcontact::detail {

/// A test by Farkas' lemma for cones. Let impulses r in the cones move nothing, G^T r = 0, and let
/// their contacts close, -r^T u > 0. Then no velocities u + G dx keep all of them open.
///
/// Multipliers move bodies, so G^T r is not 0. Velocities that meet the laws are then at least -r^T
/// u / |G^T r| away in the kinetic metric. Between the jaws of a press r grows from round to round,
/// but G^T r does not.
class Contradiction {
 public:
  /// Prepares the test.
  ///
  /// @param rows         of the problem
  /// @param coordinates  of the problem; both outlive this
  Contradiction(const ContactProblem& problem, const ContactRows& rows,
                const MassWhitenedCoordinates& coordinates);

  /// Whether velocities that meet the laws are out of reach. That is thirty times as far as if all
  /// bodies took the greatest speed that a contact has or wants. Torques count: they give contacts
  /// a speed also where all is at rest.
  ///
  /// @param impulses  in the cones
  /// @param bias      [m/s]  mu |u_t| of each contact; if a contact slid faster, its law would be
  ///         another one
  /// @param V         velocities of these impulses
  [[nodiscard]] bool is_shown_by(const Impulses& impulses, const std::vector<double>& bias,
                                 const Eigen::VectorXd& V) const;

 private:
  const MassWhitenedCoordinates& coordinates_;
  const ContactRows& rows_;
  double out_of_reach_;  // [sqrt(J)]
};

}  // namespace firstcontact::detail
