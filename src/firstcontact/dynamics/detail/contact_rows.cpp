#include <firstcontact/dynamics/detail/contact_rows.h>

#include <algorithm>

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
Jacobian jacobian(const ContactPoint& contact, int side) {
  const double sign = side == 0 ? -1.0 : 1.0;
  Jacobian J;
  J.leftCols<3>() = sign * contact.frame;
  J.rightCols<3>() =
      -sign * contact.frame * cross_matrix(side == 0 ? contact.arm_A : contact.arm_B);
  return J;
}

Eigen::Matrix<double, 6, 3> response(const InverseInertia& inverse, const Jacobian& J) {
  Eigen::Matrix<double, 6, 3> response;
  response.topRows<3>() = inverse.mass.asDiagonal() * J.leftCols<3>().transpose();
  response.bottomRows<3>() = inverse.rotation * J.rightCols<3>().transpose();
  return response;
}

ContactRow make_row(const ContactProblem& problem, const ContactPoint& contact) {
  std::array<Jacobian, 2> J;
  std::array<Eigen::Matrix<double, 6, 3>, 2> responses;
  Matrix3d W = Matrix3d::Zero();
  for (int side = 0; side < 2; ++side) {
    J[side] = jacobian(contact, side);
    responses[side] = response(problem.bodies[contact.bodies[side]].inverse_inertia, J[side]);
    W += J[side] * responses[side];
  }
  const ContactResponse own(W);
  for (int side = 0; side < 2; ++side) {
    J[side] = (own.turn() * J[side]).eval();
    responses[side] = (responses[side] * own.turn().transpose()).eval();
  }
  return {contact.bodies, J, responses, own, contact.friction, contact.least_normal_velocity};
}

}  // namespace

std::vector<ContactRow> contact_rows(const ContactProblem& problem) {
  std::vector<ContactRow> rows;
  rows.reserve(problem.contacts.size());
  for (const ContactPoint& contact : problem.contacts) {
    rows.push_back(make_row(problem, contact));
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
  if (!(row.greatest() > 0.0)) {
    return 0.0;  // No impulse would change anything.
  }
  Vector3d u = row.excess_velocity(V);
  u[0] += row.friction * u.tail<2>().norm();
  const Vector3d change = impulse - project_on_cone(impulse - u / row.greatest(), row.friction);
  return change.norm() * row.greatest();
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
