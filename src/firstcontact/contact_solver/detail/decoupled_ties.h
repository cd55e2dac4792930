/// @file
/// A contact problem whose rigid ties do not answer each other's impulses.

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {

/// [-]  Finds the least part of a rigid tie's response that the ties before it leave; 1 without
/// any.
[[nodiscard]] double least_left_of_ties(const ContactRows& rows);

/// The rows of a problem in which combinations take the place of its rigid ties. A rigid tie does
/// not yield, and its impulse has no bounds.
///
/// An impulse turns a small body on a long arm, and moves it little. So the three rows of its joint
/// almost agree, and no penalty suits all of them. Combinations without a response to each other
/// have a penalty each. Gram and Schmidt's method makes them, with the inverse of the kinetic
/// metric as its product. The row with the most response left comes next. No row has a share above
/// 1 of a combination, so residuals stay residuals [m/s].
class DecoupledTies {
 public:
  /// Combines the rigid ties of a problem.
  ///
  /// @param rows  of the problem
  DecoupledTies(const ContactProblem& problem, const ContactRows& rows);

  /// Whether there are no two rigid ties, and so nothing to combine.
  [[nodiscard]] bool empty() const { return rigid_.size() < 2; }

  /// The rows with the combinations.
  [[nodiscard]] const ContactRows& rows() const { return rows_; }

  /// Gives all combinations the velocities that they want, whatever other rows do then. Each needs
  /// its own impulse alone.
  ///
  /// @param projection  of these rows
  void meet(Projection& projection) const;

  /// Computes the impulses of these rows that act as impulses of the problem's.
  [[nodiscard]] Impulses combined(Impulses impulses) const;

  /// Computes the impulses of the problem's rows that act as impulses of these.
  [[nodiscard]] Impulses separate(Impulses impulses) const;

 private:
  ContactRows rows_;
  std::vector<std::size_t> rigid_ = {};  // Indices of rigid ties among the drives, in their order.
  Eigen::MatrixXd shares_ = {};          // Unit lower triangle: ties by combinations.
};

}  // namespace firstcontact::detail
