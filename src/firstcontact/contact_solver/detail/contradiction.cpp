#include <firstcontact/contact_solver/detail/contradiction.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/LU>

#include <firstcontact/contact_solver/detail/coulomb_cone.h>

namespace firstcontact::detail {
namespace {

/// [-]  A wedge that closes squeezes a body out faster than its rows move, but not by this factor.
constexpr double kOutOfReach = 30.0;

/// The impulses that drives and ties cannot do without, such as that of a torque.
Impulses least_impulses(const ContactRows& rows) {
  Impulses least;
  least.contacts.assign(rows.contacts.size(), Eigen::Vector3d::Zero());
  for (const DriveRow& row : rows.drives) {
    least.drives.push_back(std::clamp(0.0, row.least, row.greatest));
  }
  return least;
}

/// [m/s]  The greatest speed that a row has or wants. At rest a torque alone gives it one.
double fastest(const ContactRows& rows) {
  const Impulses least = least_impulses(rows);
  const Eigen::VectorXd driven = velocities_after(rows, least);
  double speed = 0.0;
  for (const ContactRow& row : rows.contacts) {
    speed = std::max({speed, row.excess_velocity(rows.free_velocities).norm(),
                      row.excess_velocity(driven).norm()});
  }
  for (std::size_t k = 0; k < rows.drives.size(); ++k) {
    const DriveRow& row = rows.drives[k];
    speed = std::max({speed, std::abs(row.excess_velocity(0.0, rows.free_velocities)),
                      std::abs(row.excess_velocity(least.drives[k], driven))});
  }
  return speed;
}

/// [kg]  The mass of coordinates along a row, for the least velocities that move it. The row's own
/// response may be that of a much smaller mass: on a long arm a body turns out of the way.
double mass_along(const Eigen::VectorXd& J, const Eigen::MatrixXd& mass) {
  const double squared = J.squaredNorm();
  return squared > 0.0 ? J.dot(mass * J) / (squared * squared) : 0.0;
}

/// [kg]  The greatest mass of the bodies that are no links.
double heaviest_body(const ContactProblem& problem) {
  double heaviest = 0.0;
  for (const ContactBody& body : problem.bodies) {
    for (const double inverse : body.inverse_inertia.mass) {
      heaviest = !body.link && inverse > 0.0 ? std::max(heaviest, 1.0 / inverse) : heaviest;
    }
  }
  return heaviest;
}

/// [kg]  The greatest mass of a mechanism for its contacts and ties.
///
/// @param at  index of the mechanism's first velocity
double heaviest_along(const ContactRows& rows, const ContactMechanism& mechanism, Eigen::Index at) {
  const Eigen::MatrixXd mass = mechanism.inverse_mass.inverse();
  double heaviest = 0.0;
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
  return heaviest;
}

/// [kg]  The greatest mass of bodies, of mechanisms for their contacts and ties, and of drives.
double heaviest(const ContactProblem& problem, const ContactRows& rows) {
  double heaviest = heaviest_body(problem);
  for (std::size_t m = 0; m < problem.mechanisms.size(); ++m) {
    heaviest =
        std::max(heaviest, heaviest_along(rows, problem.mechanisms[m], rows.layout.mechanism[m]));
  }
  for (const DriveRow& row : rows.drives) {
    heaviest = row.own > 0.0 ? std::max(heaviest, 1.0 / row.own) : heaviest;
  }
  return heaviest;
}

/// The impulse of a drive that may grow without end, 0 for any other drive.
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
