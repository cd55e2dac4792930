#include <firstcontact/contact_solver/detail/contradiction.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/LU>

#include <firstcontact/contact_solver/detail/coulomb_cone.h>

namespace firstcontact::detail {
namespace {

/// [-]  A wedge that closes squeezes a body out faster than that, but not by so much.
constexpr double kOutOfReach = 30.0;

/// [m/s]  That a row has, or asks for.
double fastest(const ContactRows& rows) {
  double speed = 0.0;
  for (const ContactRow& row : rows.contacts) {
    speed = std::max(speed, row.excess_velocity(rows.free_velocities).norm());
  }
  for (const DriveRow& row : rows.drives) {
    speed = std::max(speed, std::abs(row.excess_velocity(0.0, rows.free_velocities)));
  }
  return speed;
}

/// [kg]  That coordinates have for a row, if the least of their velocities that add up to the row's
/// do it: the row's own response may be of a mass that is smaller by far, as on a long arm.
double mass_along(const Eigen::VectorXd& J, const Eigen::MatrixXd& mass) {
  const double squared = J.squaredNorm();
  return squared > 0.0 ? J.dot(mass * J) / (squared * squared) : 0.0;
}

/// [kg]  The greatest mass of a body, and of a mechanism for its contacts and ties.
double heaviest(const ContactProblem& problem, const ContactRows& rows) {
  double heaviest = 0.0;
  for (const ContactBody& body : problem.bodies) {
    for (const double inverse : body.inverse_inertia.mass) {
      heaviest = !body.link && inverse > 0.0 ? std::max(heaviest, 1.0 / inverse) : heaviest;
    }
  }
  for (std::size_t m = 0; m < problem.mechanisms.size(); ++m) {
    const Eigen::MatrixXd mass = problem.mechanisms[m].inverse_mass.inverse();
    const Eigen::Index at = rows.layout.mechanism[m];
    for (const ContactRow& row : rows.contacts) {
      for (const RowSide& side : row.sides) {
        if (side.is_link() && side.at == at) {
          heaviest = std::max(heaviest, mass_along(side.J_q.row(0), mass));
        }
      }
    }
    for (const DriveRow& row : rows.drives) {
      for (const TieRowSide& side : row.tie) {
        heaviest = side.at == at ? std::max(heaviest, mass_along(side.J, mass)) : heaviest;
      }
    }
  }
  for (const DriveRow& row : rows.drives) {
    heaviest = row.own > 0.0 ? std::max(heaviest, 1.0 / row.own) : heaviest;
  }
  return heaviest;
}

/// An impulse of a drive that may grow without end, 0 of any other one.
double endless_part(const DriveRow& row, double impulse) {
  const bool is_endless = std::isinf(impulse > 0.0 ? row.greatest : row.least);
  return is_endless && row.compliance == 0.0 ? impulse : 0.0;
}

}  // namespace

Contradiction::Contradiction(const ContactProblem& problem, const ContactRows& rows,
                             const MassWhitenedCoordinates& coordinates)
    : coordinates_(coordinates),
      rows_(rows),
      out_of_reach_(kOutOfReach * fastest(rows) *
                    std::sqrt(static_cast<double>(coordinates.size()) * heaviest(problem, rows))) {}

bool Contradiction::is_shown_by(const Impulses& impulses, const std::vector<double>& bias,
                                const Eigen::VectorXd& V) const {
  Impulses endless{.contacts = impulses.contacts, .drives = {}};
  double closing = 0.0;  // [J]
  for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
    Eigen::Vector3d u = rows_.contacts[k].excess_velocity(V);
    u[0] += bias[k];
    closing -= impulses.contacts[k].dot(u);
  }
  for (std::size_t k = 0; k < rows_.drives.size(); ++k) {
    const DriveRow& row = rows_.drives[k];
    endless.drives.push_back(endless_part(row, impulses.drives[k]));
    closing -= endless.drives.back() * row.excess_velocity(0.0, V);
  }
  return closing > out_of_reach_ * coordinates_.moved_by(endless).norm();
}

}  // namespace firstcontact::detail
