/// @file
/// Mass-whitened coordinates of a contact problem: its kinetic metric is Euclid's in them.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/block_rows.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {

/// Computes a square root S of the inverse inertia, S S^T = M^-1; columns of locked axes are zero.
[[nodiscard]] Eigen::Matrix<double, 6, 6> square_root(const InverseInertia& inverse);

/// Coordinates x with V = V_free + S x for each body and mechanism, S S^T = M^-1. So |V - V_free|_M
/// = |x|, and bodies that nothing moves have no coordinates.
class MassWhitenedCoordinates {
 public:
  /// Makes the coordinates of a problem.
  ///
  /// @param rows  of the problem
  MassWhitenedCoordinates(const ContactProblem& problem, const ContactRows& rows);

  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] const BlockRows<3>& contacts() const { return contacts_; }
  [[nodiscard]] const BlockRows<1>& drives() const { return drives_; }

  /// Computes the displacement x by impulses: V(x) = V_free + M^-1 J^T r.
  [[nodiscard]] Eigen::VectorXd moved_by(const Impulses& impulses) const;

  /// Makes the matrix with room for all I + G^T D G.
  [[nodiscard]] BlockCholesky factorisation();

 private:
  /// A body or a mechanism that moves by itself.
  struct Part {
    Eigen::Index in_V;
    Eigen::Index in_x;
    Eigen::MatrixXd root;  // S
  };

  void add_part(Eigen::Index in_V, Eigen::MatrixXd root);
  [[nodiscard]] std::vector<std::array<std::size_t, 2>> connected_blocks() const;
  [[nodiscard]] const Part* part_of(Eigen::Index in_V) const;
  void add_side(const RowSide& side);

  std::vector<Part> parts_;
  std::vector<std::size_t> part_at_;  // Index in parts_ by the first velocity.
  BlockRows<3> contacts_;
  BlockRows<1> drives_;
  Eigen::Index size_ = 0;
};

}  // namespace firstcontact::detail
