#include <firstcontact/dynamics/detail/contact_rows.h>

#include <algorithm>

#include <firstcontact/dynamics/detail/coulomb_cone.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Of one of the two bodies: sign -1 for A, 1 for B.
void fill_side(const ContactProblem& problem, const ContactPoint& contact, int side,
               ContactRow& row) {
  const double sign = side == 0 ? -1.0 : 1.0;
  const Vector3d& arm = side == 0 ? contact.arm_A : contact.arm_B;
  const InverseInertia& inverse = problem.bodies[contact.bodies[side]].inverse_inertia;
  Jacobian& J = row.J[side];
  J.leftCols<3>() = sign * contact.frame;
  J.rightCols<3>() = -sign * contact.frame * cross_matrix(arm);
  row.response[side].topRows<3>() = inverse.mass.asDiagonal() * J.leftCols<3>().transpose();
  row.response[side].bottomRows<3>() = inverse.rotation * J.rightCols<3>().transpose();
}

}  // namespace

std::vector<ContactRow> contact_rows(const ContactProblem& problem) {
  std::vector<ContactRow> rows(problem.contacts.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactPoint& contact = problem.contacts[k];
    ContactRow& row = rows[k];
    row.bodies = contact.bodies;
    fill_side(problem, contact, 0, row);
    fill_side(problem, contact, 1, row);
    row.W = row.J[0] * row.response[0] + row.J[1] * row.response[1];
    row.friction = contact.friction;
    row.least = contact.least_normal_velocity;
    row.greatest = row.W.diagonal().maxCoeff();
  }
  return rows;
}

std::vector<Velocity> velocities(const std::vector<ContactBody>& bodies) {
  std::vector<Velocity> V(bodies.size());
  for (std::size_t b = 0; b < V.size(); ++b) {
    V[b] << bodies[b].v, bodies[b].w;
  }
  return V;
}

double residual_of(const ContactRow& row, const Vector3d& impulse, const std::vector<Velocity>& V) {
  if (!(row.greatest > 0.0)) {
    return 0.0;  // No impulse would change anything.
  }
  Vector3d u = row.excess_velocity(V);
  u[0] += row.friction * u.tail<2>().norm();
  const Vector3d change = impulse - project_on_cone(impulse - u / row.greatest, row.friction);
  return change.norm() * row.greatest;
}

double greatest_residual(const std::vector<ContactRow>& rows, const std::vector<Vector3d>& impulses,
                         const std::vector<Velocity>& V) {
  double greatest = 0.0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    greatest = std::max(greatest, residual_of(rows[k], impulses[k], V));
  }
  return greatest;
}

std::vector<Velocity> velocities_after(const ContactProblem& problem,
                                       const std::vector<ContactRow>& rows,
                                       const std::vector<Vector3d>& impulses) {
  std::vector<Velocity> V = velocities(problem.bodies);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].apply(impulses[k], V);
  }
  return V;
}

}  // namespace firstcontact::detail
