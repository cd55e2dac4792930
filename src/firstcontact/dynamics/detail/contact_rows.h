/// @file
/// The contacts of a problem as rows, ready for its solvers.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/dynamics/contact_problem.h>
#include <firstcontact/dynamics/detail/coulomb_cone.h>

namespace firstcontact::detail {

/// Velocity (v, w) of a body.
using Velocity = Eigen::Matrix<double, 6, 1>;
using Jacobian = Eigen::Matrix<double, 3, 6>;

/// u = J_B V_B + J_A V_A, in the contact's frame with the tangents of its response.
struct ContactRow {
  std::array<std::size_t, 2> bodies;
  std::array<Jacobian, 2> J;
  std::array<Eigen::Matrix<double, 6, 3>, 2> response;  // M^-1 J^T
  ContactResponse own;                                  // To its own impulse, J M^-1 J^T.
  double friction;
  double least;  // [m/s]  Normal velocity.

  [[nodiscard]] double greatest() const { return own.greatest(); }
  [[nodiscard]] Eigen::Vector3d velocity(const std::vector<Velocity>& V) const {
    return J[0] * V[bodies[0]] + J[1] * V[bodies[1]];
  }
  void apply(const Eigen::Vector3d& impulse, std::vector<Velocity>& V) const {
    V[bodies[0]] += response[0] * impulse;
    V[bodies[1]] += response[1] * impulse;
  }
  /// u - least n
  [[nodiscard]] Eigen::Vector3d excess_velocity(const std::vector<Velocity>& V) const {
    Eigen::Vector3d u = velocity(V);
    u[0] -= least;
    return u;
  }
};

[[nodiscard]] std::vector<ContactRow> contact_rows(const ContactProblem& problem);

[[nodiscard]] std::vector<Velocity> velocities(const std::vector<ContactBody>& bodies);

/// [m/s]  As contact_residual(), of one contact.
[[nodiscard]] double residual_of(const ContactRow& row, const Eigen::Vector3d& impulse,
                                 const std::vector<Velocity>& V);

[[nodiscard]] double greatest_residual(const std::vector<ContactRow>& rows,
                                       const std::vector<Eigen::Vector3d>& impulses,
                                       const std::vector<Velocity>& V);

/// What a solver starts from and leaves behind: velocities that belong to the impulses.
struct Projection {
  std::vector<Velocity> velocities;
  std::vector<Eigen::Vector3d> impulses;  // [N s]
  double residual = 0.0;                  // [m/s]
  int iterations = 0;
};

/// The free velocities changed by impulses.
[[nodiscard]] std::vector<Velocity> velocities_after(const ContactProblem& problem,
                                                     const std::vector<ContactRow>& rows,
                                                     const std::vector<Eigen::Vector3d>& impulses);

void project_in_contact_space(const std::vector<ContactRow>& rows, const ProjectionOptions& options,
                              Projection& projection);

void project_in_motion_space(const ContactProblem& problem, const std::vector<ContactRow>& rows,
                             const ProjectionOptions& options, Projection& projection);

}  // namespace firstcontact::detail
