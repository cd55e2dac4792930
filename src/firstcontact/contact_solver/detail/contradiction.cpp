#include <firstcontact/contact_solver/detail/contradiction.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

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

/// [kg]  The greatest mass that a side of a contact feels, or a drive.
double heaviest(const ContactRows& rows) {
  double mass = 0.0;
  for (const ContactRow& row : rows.contacts) {
    for (const RowSide& side : row.sides) {
      const double response = side.is_link() ? side.J_q.row(0).dot(side.response_q.col(0))
                                             : side.J.row(0).dot(side.response.col(0));
      mass = response > 0.0 ? std::max(mass, 1.0 / response) : mass;
    }
  }
  for (const DriveRow& row : rows.drives) {
    mass = row.own > 0.0 ? std::max(mass, 1.0 / row.own) : mass;
  }
  return mass;
}

/// An impulse of a drive that may grow without end, 0 of any other one.
double endless_part(const DriveRow& row, double impulse) {
  const bool is_endless = std::isinf(impulse > 0.0 ? row.greatest : row.least);
  return is_endless && row.compliance == 0.0 ? impulse : 0.0;
}

}  // namespace

Contradiction::Contradiction(const MassWhitenedCoordinates& coordinates, const ContactRows& rows)
    : coordinates_(coordinates),
      rows_(rows),
      out_of_reach_(kOutOfReach * fastest(rows) *
                    std::sqrt(static_cast<double>(coordinates.size()) * heaviest(rows))) {}

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
