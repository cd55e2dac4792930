/// @file
/// The contacts of a problem as rows, ready for its solvers.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/coulomb_cone.h>

namespace firstcontact::detail {

/// Whether impulses move a body that is no link.
inline bool is_movable(const ContactBody& body) {
  return !body.link && (body.inverse_inertia.mass.any() || body.inverse_inertia.rotation.any());
}

/// The indices of a problem's velocities in one vector. First (v, w) of each body that is no link,
/// then the coordinates of each mechanism.
struct VelocityLayout {
  explicit VelocityLayout(const ContactProblem& problem);

  std::vector<Eigen::Index> body;  // For a link that of its mechanism.
  std::vector<Eigen::Index> mechanism;
  Eigen::Index size = 0;
};

/// The share of one of the two bodies in a contact: u_s = J V, and impulses change V by M^-1 J^T.
struct RowSide {
  using Jacobian = Eigen::Matrix<double, 3, 6>;
  using Response = Eigen::Matrix<double, 6, 3>;

  Eigen::Index at = 0;  // Index in the vector of velocities.
  Jacobian J = Jacobian::Zero();
  Response response = Response::Zero();
  // For a mechanism, in place of J and response.
  Eigen::Matrix3Xd J_q = {};
  Eigen::MatrixX3d response_q = {};

  [[nodiscard]] bool is_link() const { return J_q.cols() > 0; }
  [[nodiscard]] Eigen::Vector3d velocity(const Eigen::VectorXd& V) const {
    return is_link() ? Eigen::Vector3d(J_q * V.segment(at, J_q.cols()))
                     : Eigen::Vector3d(J * V.segment<6>(at));
  }
  void apply(const Eigen::Vector3d& impulse, Eigen::VectorXd& V) const {
    if (is_link()) {
      V.segment(at, J_q.cols()) += response_q * impulse;
    } else {
      V.segment<6>(at) += response * impulse;
    }
  }
};

/// A contact as a row: u = J_A V_A + J_B V_B, in its frame with the tangents of its response.
struct ContactRow {
  /// The sides of A and B. Two links of one mechanism are one side; then the other has zeros.
  std::array<RowSide, 2> sides;
  ContactResponse own;  // Response to its own impulse, J M^-1 J^T.
  double friction;
  Eigen::Vector3d target;  // [m/s]  The least normal velocity, and the velocity at which it sticks.

  [[nodiscard]] double greatest() const { return own.greatest(); }
  [[nodiscard]] Eigen::Vector3d velocity(const Eigen::VectorXd& V) const {
    return sides[0].velocity(V) + sides[1].velocity(V);
  }
  void apply(const Eigen::Vector3d& impulse, Eigen::VectorXd& V) const {
    sides[0].apply(impulse, V);
    sides[1].apply(impulse, V);
  }
  [[nodiscard]] Eigen::Vector3d excess_velocity(const Eigen::VectorXd& V) const {
    return velocity(V) - target;
  }
};

/// Makes the row of a contact.
///
/// @param layout  of the problem
[[nodiscard]] ContactRow make_row(const ContactProblem& problem, const VelocityLayout& layout,
                                  const ContactPoint& contact);

/// Solves one contact with all others held. Returns the change of its velocity [m/s].
inline double solve_alone(const ContactRow& row, Eigen::Vector3d& impulse, Eigen::VectorXd& V) {
  if (!(row.greatest() > 0.0)) {
    return 0.0;
  }
  const Eigen::Vector3d u = row.excess_velocity(V);
  if (u[0] >= 0.0 && impulse.isZero(0.0)) {
    return 0.0;
  }
  const Eigen::Vector3d u_free = u - row.own.W() * impulse;
  const Eigen::Vector3d solved = row.own.impulse(u_free, row.friction);
  const Eigen::Vector3d change = solved - impulse;
  row.apply(change, V);
  impulse = solved;
  return change.norm() * row.greatest();
}

/// The share of one body in a tie: J V is added to the velocity, and impulses change V by the
/// response.
struct TieRowSide {
  Eigen::Index at = 0;  // Index in the vector of velocities.
  Eigen::VectorXd J = {};
  Eigen::VectorXd response = {};
};

/// A drive of one coordinate, or a tie.
struct DriveRow {
  Eigen::Index at = 0;          // Index of the first velocity of its mechanism.
  Eigen::Index place = 0;       // Index of its coordinate.
  Eigen::VectorXd column = {};  // Column of the mechanism's inverse mass.
  double own;                   // Response to its own impulse, with its compliance.
  double target;
  double compliance;
  double least;
  double greatest;
  std::vector<TieRowSide> tie = {};  // Sides of a tie, in place of the first three.

  [[nodiscard]] double velocity(const Eigen::VectorXd& V) const {
    if (tie.empty()) {
      return V[place];
    }
    double u = 0.0;
    for (const TieRowSide& side : tie) {
      u += side.J.dot(V.segment(side.at, side.J.size()));
    }
    return u;
  }
  /// Computes u + compliance r - target.
  [[nodiscard]] double excess_velocity(double impulse, const Eigen::VectorXd& V) const {
    return velocity(V) + compliance * impulse - target;
  }
  void apply(double impulse, Eigen::VectorXd& V) const {
    if (tie.empty()) {
      V.segment(at, column.size()) += impulse * column;
    }
    for (const TieRowSide& side : tie) {
      V.segment(side.at, side.response.size()) += impulse * side.response;
    }
  }
};

/// A contact problem for its solvers.
struct ContactRows {
  explicit ContactRows(const ContactProblem& problem);

  VelocityLayout layout;
  Eigen::VectorXd free_velocities;
  std::vector<ContactRow> contacts;
  std::vector<DriveRow> drives;  // The drives, then the ties.
};

/// The impulses of all rows.
struct Impulses {
  std::vector<Eigen::Vector3d> contacts;  // [N s]  In the frames of the rows.
  std::vector<double> drives;             // [N m s or N s]  Those of drives, then of ties.
};

/// [m/s]  Computes the residual of one contact as in contact_residual(). It is not finite where it
/// cannot be computed.
[[nodiscard]] double residual_of(const ContactRow& row, const Eigen::Vector3d& impulse,
                                 const Eigen::VectorXd& V);

/// [m/s]  Computes the greatest residual of all rows, as contact_residual().
[[nodiscard]] double greatest_residual(const ContactRows& rows, const Impulses& impulses,
                                       const Eigen::VectorXd& V);

/// The start and the result of a solver: velocities that belong to the impulses.
struct Projection {
  Eigen::VectorXd velocities = {};
  Impulses impulses = {};
  double residual = 0.0;  // [m/s]
  int iterations = 0;
};

/// Computes the velocities after impulses, from the free ones.
[[nodiscard]] Eigen::VectorXd velocities_after(const ContactRows& rows, const Impulses& impulses);

/// Makes the solution: the problem's bodies, mechanisms and drives with a projection's velocities
/// and impulses.
[[nodiscard]] ContactSolution solution_of(const ContactProblem& problem, const ContactRows& rows,
                                          const Projection& projection, ProjectionSpace space);

}  // namespace firstcontact::detail
