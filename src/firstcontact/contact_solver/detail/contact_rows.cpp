#include <firstcontact/contact_solver/detail/contact_rows.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// The Jacobian of one of the two bodies: sign -1 for A, 1 for B.
RowSide::Jacobian jacobian(const ContactPoint& contact, int side) {
  const double sign = side == 0 ? -1.0 : 1.0;
  RowSide::Jacobian J;
  J.leftCols<3>() = sign * contact.frame;
  J.rightCols<3>() =
      -sign * contact.frame * cross_matrix(side == 0 ? contact.arm_A : contact.arm_B);
  return J;
}

RowSide::Response response(const InverseInertia& inverse, const RowSide::Jacobian& J) {
  RowSide::Response response;
  response.topRows<3>() = inverse.mass.asDiagonal() * J.leftCols<3>().transpose();
  response.bottomRows<3>() = inverse.rotation * J.rightCols<3>().transpose();
  return response;
}

RowSide make_side(const ContactProblem& problem, const VelocityLayout& layout,
                  const ContactPoint& contact, int side) {
  const std::size_t b = contact.bodies[side];
  const ContactBody& body = problem.bodies[b];
  RowSide made{.at = layout.body[b]};
  if (body.link) {
    made.J_q = jacobian(contact, side) * body.link->J;
  } else {
    made.J = jacobian(contact, side);
    made.response = response(body.inverse_inertia, made.J);
  }
  return made;
}

/// Turns a side to a frame with other tangents.
void turn(const Matrix3d& by, RowSide& side) {
  if (side.is_link()) {
    side.J_q = (by * side.J_q).eval();
    side.response_q = (side.response_q * by.transpose()).eval();
  } else {
    side.J = (by * side.J).eval();
    side.response = (side.response * by.transpose()).eval();
  }
}

DriveRow make_row(const ContactProblem& problem, const VelocityLayout& layout,
                  const JointDrive& drive) {
  const auto k = static_cast<Eigen::Index>(drive.coordinate);
  const Eigen::Index at = layout.mechanism[drive.mechanism];
  const VectorXd column = problem.mechanisms[drive.mechanism].inverse_mass.col(k);
  return {.at = at,
          .place = at + k,
          .column = column,
          .own = column[k] + drive.compliance,
          .target = drive.target,
          .compliance = drive.compliance,
          .least = drive.least,
          .greatest = drive.greatest};
}

TieRowSide make_side(const ContactProblem& problem, const VelocityLayout& layout,
                     const TieSide& side) {
  const ContactBody& body = problem.bodies[side.body];
  TieRowSide made{.at = layout.body[side.body]};
  if (body.link) {
    made.J = body.link->J.transpose() * side.row;
    return made;
  }
  made.J = side.row;
  made.response = VectorXd(6);
  made.response << body.inverse_inertia.mass.cwiseProduct(side.row.head<3>()),
      body.inverse_inertia.rotation * side.row.tail<3>();
  return made;
}

/// Makes the row of a tie. Two links of one mechanism are one side.
DriveRow make_row(const ContactProblem& problem, const VelocityLayout& layout, const TieRow& tie) {
  DriveRow row{.own = tie.compliance,
               .target = tie.target,
               .compliance = tie.compliance,
               .least = tie.least,
               .greatest = tie.greatest};
  for (const TieSide& side : tie.sides) {
    TieRowSide made = make_side(problem, layout, side);
    if (!row.tie.empty() && row.tie.front().at == made.at) {
      row.tie.front().J += made.J;
    } else {
      row.tie.push_back(std::move(made));
    }
  }
  for (std::size_t s = 0; s < row.tie.size(); ++s) {
    TieRowSide& side = row.tie[s];
    if (const auto& link = problem.bodies[tie.sides[s].body].link) {
      side.response = problem.mechanisms[link->mechanism].inverse_mass * side.J;
    }
    row.own += side.J.dot(side.response);
  }
  return row;
}

VectorXd free_velocities(const ContactProblem& problem, const VelocityLayout& layout) {
  VectorXd V(layout.size);
  for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
    const ContactBody& body = problem.bodies[b];
    if (!body.link) {
      V.segment<6>(layout.body[b]) << body.v, body.w;
    }
  }
  for (std::size_t m = 0; m < problem.mechanisms.size(); ++m) {
    const VectorXd& velocity = problem.mechanisms[m].velocity;
    V.segment(layout.mechanism[m], velocity.size()) = velocity;
  }
  return V;
}

double residual_of(const DriveRow& row, double impulse, const VectorXd& V) {
  if (!(row.own > 0.0)) {
    return 0.0;  // No impulse would change anything.
  }
  const double wanted = impulse - row.excess_velocity(impulse, V) / row.own;
  return std::abs(impulse - std::clamp(wanted, row.least, row.greatest)) * row.own;
}

}  // namespace

ContactRow make_row(const ContactProblem& problem, const VelocityLayout& layout,
                    const ContactPoint& contact) {
  std::array<RowSide, 2> sides{make_side(problem, layout, contact, 0),
                               make_side(problem, layout, contact, 1)};
  if (sides[0].is_link() && sides[1].is_link() && sides[0].at == sides[1].at) {
    sides[0].J_q += sides[1].J_q;
    sides[1].J_q.setZero();
  }
  Matrix3d W = Matrix3d::Zero();
  for (int s = 0; s < 2; ++s) {
    RowSide& side = sides[s];
    if (side.is_link()) {
      const MechanismLink& link = *problem.bodies[contact.bodies[s]].link;
      side.response_q = problem.mechanisms[link.mechanism].inverse_mass * side.J_q.transpose();
      W += side.J_q * side.response_q;
    } else {
      W += side.J * side.response;
    }
  }
  const ContactResponse own(W);
  for (RowSide& side : sides) {
    turn(own.turn(), side);
  }
  const Vector3d target(contact.least_normal_velocity, contact.sticking_velocity.x(),
                        contact.sticking_velocity.y());
  return {std::move(sides), own, contact.friction, own.turn() * target};
}

double residual_of(const ContactRow& row, const Vector3d& impulse, const VectorXd& V) {
  if (!(row.greatest() > 0.0)) {
    return 0.0;  // No impulse would change anything.
  }
  Vector3d u = row.excess_velocity(V);
  u[0] += row.friction * u.tail<2>().norm();
  const Vector3d change = impulse - project_on_cone(impulse - u / row.greatest(), row.friction);
  return change.norm() * row.greatest();
}

VelocityLayout::VelocityLayout(const ContactProblem& problem) {
  for (const ContactBody& b : problem.bodies) {
    body.push_back(size);
    size += b.link ? 0 : 6;
  }
  for (const ContactMechanism& m : problem.mechanisms) {
    mechanism.push_back(size);
    size += m.velocity.size();
  }
  for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
    if (problem.bodies[b].link) {
      body[b] = mechanism[problem.bodies[b].link->mechanism];
    }
  }
}

ContactRows::ContactRows(const ContactProblem& problem)
    : layout(problem), free_velocities(detail::free_velocities(problem, layout)) {
  contacts.reserve(problem.contacts.size());
  for (const ContactPoint& contact : problem.contacts) {
    contacts.push_back(make_row(problem, layout, contact));
  }
  for (const JointDrive& drive : problem.drives) {
    drives.push_back(make_row(problem, layout, drive));
  }
  for (const TieRow& tie : problem.ties) {
    drives.push_back(make_row(problem, layout, tie));
  }
}

double greatest_residual(const ContactRows& rows, const Impulses& impulses, const VectorXd& V) {
  double greatest = 0.0;
  const auto add = [&](double residual) {
    greatest = std::isfinite(residual) ? std::max(greatest, residual)
                                       : std::numeric_limits<double>::infinity();
  };
  for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
    add(residual_of(rows.contacts[k], impulses.contacts[k], V));
  }
  for (std::size_t k = 0; k < rows.drives.size(); ++k) {
    add(residual_of(rows.drives[k], impulses.drives[k], V));
  }
  return greatest;
}

VectorXd velocities_after(const ContactRows& rows, const Impulses& impulses) {
  VectorXd V = rows.free_velocities;
  for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
    rows.contacts[k].apply(impulses.contacts[k], V);
  }
  for (std::size_t k = 0; k < rows.drives.size(); ++k) {
    rows.drives[k].apply(impulses.drives[k], V);
  }
  return V;
}

ContactSolution solution_of(const ContactProblem& problem, const ContactRows& rows,
                            const Projection& projection, ProjectionSpace space) {
  ContactSolution solution;
  for (std::size_t m = 0; m < problem.mechanisms.size(); ++m) {
    solution.mechanisms.emplace_back(projection.velocities.segment(
        rows.layout.mechanism[m], problem.mechanisms[m].velocity.size()));
  }
  solution.bodies = problem.bodies;
  for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
    ContactBody& body = solution.bodies[b];
    const Eigen::Matrix<double, 6, 1> V =
        body.link
            ? Eigen::Matrix<double, 6, 1>(body.link->J * solution.mechanisms[body.link->mechanism])
            : Eigen::Matrix<double, 6, 1>(projection.velocities.segment<6>(rows.layout.body[b]));
    body.v = V.head<3>();
    body.w = V.tail<3>();
  }
  for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
    solution.impulses.emplace_back(rows.contacts[k].own.turn().transpose() *
                                   projection.impulses.contacts[k]);
  }
  const auto first_tie =
      projection.impulses.drives.begin() + static_cast<std::ptrdiff_t>(problem.drives.size());
  solution.drives.assign(projection.impulses.drives.begin(), first_tie);
  solution.ties.assign(first_tie, projection.impulses.drives.end());
  solution.residual = projection.residual;
  solution.space = space;
  solution.iterations = projection.iterations;
  return solution;
}

}  // namespace firstcontact::detail
