/// @file
/// Sees that no velocities meet the laws of a contact problem, such as between the jaws of a press.

#pragma once

#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>
#include <firstcontact/contact_solver/detail/mass_whitened_coordinates.h>

namespace firstcontact::detail {

/// Farkas' lemma for cones: where impulses r in the cones move nothing, G^T r = 0, and their
/// contacts close, -r^T u > 0, then no velocities u + G dx keep all of them open.
///
/// Multipliers move bodies, and G^T r is not 0. What meets the laws is then at least
/// -r^T u / |G^T r| away in the kinetic metric. Between the jaws of a press r grows from round to
/// round, but not what it moves.
class Contradiction {
 public:
  /// @param rows         of the problem
  /// @param coordinates  likewise; outlive this, as the rows do
  Contradiction(const ContactProblem& problem, const ContactRows& rows,
                const MassWhitenedCoordinates& coordinates);

  /// Whether what meets the laws is out of reach: thirty times as far as if all bodies took the
  /// fastest speed that a contact has or asks for.
  ///
  /// @param impulses  in the cones
  /// @param bias      [m/s]  mu |u_t| of each contact; if a contact slid faster, its law would be
  ///                  another one
  /// @param V         velocities of these impulses
  [[nodiscard]] bool is_shown_by(const Impulses& impulses, const std::vector<double>& bias,
                                 const Eigen::VectorXd& V) const;

 private:
  const MassWhitenedCoordinates& coordinates_;
  const ContactRows& rows_;
  double out_of_reach_;  // [sqrt(J)]
};

}  // namespace firstcontact::detail
