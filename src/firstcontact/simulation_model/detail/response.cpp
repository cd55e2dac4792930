#include <firstcontact/simulation_model/detail/response.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <firstcontact/simulation_model/detail/manifold.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The frame of a contact, by rows: the normal and two tangents that depend on nothing else.
Matrix3d frame_of(const Vector3d& normal) {
  Eigen::Index least = 0;
  normal.cwiseAbs().minCoeff(&least);
  Matrix3d frame;
  frame.row(0) = normal.transpose();
  const Vector3d tangent = normal.cross(Vector3d::Unit(least)).normalized();
  frame.row(1) = tangent.transpose();
  frame.row(2) = normal.cross(tangent).transpose();
  return frame;
}

/// The solution between two, by velocities and impulses.
ContactSolution between(const ContactSolution& from, const ContactSolution& to, double share) {
  ContactSolution mixed = to;
  for (std::size_t b = 0; b < mixed.bodies.size(); ++b) {
    mixed.bodies[b].v = (1.0 - share) * from.bodies[b].v + share * to.bodies[b].v;
    mixed.bodies[b].w = (1.0 - share) * from.bodies[b].w + share * to.bodies[b].w;
  }
  for (std::size_t m = 0; m < mixed.mechanisms.size(); ++m) {
    mixed.mechanisms[m] = (1.0 - share) * from.mechanisms[m] + share * to.mechanisms[m];
  }
  for (std::size_t k = 0; k < mixed.drives.size(); ++k) {
    mixed.drives[k] = (1.0 - share) * from.drives[k] + share * to.drives[k];
  }
  for (std::size_t k = 0; k < mixed.ties.size(); ++k) {
    mixed.ties[k] = (1.0 - share) * from.ties[k] + share * to.ties[k];
  }
  for (std::size_t k = 0; k < mixed.impulses.size(); ++k) {
    mixed.impulses[k] = (1.0 - share) * from.impulses[k] + share * to.impulses[k];
  }
  return mixed;
}

/// Whether a problem has a contact with a scripted body, or a tie to one.
bool touches_scripted(const ContactProblem& problem, std::size_t members) {
  const auto is_scripted = [&](std::size_t place) {
    const ContactBody& body = problem.bodies[place];
    return place >= members && (body.v.any() || body.w.any());
  };
  return std::ranges::any_of(problem.contacts,
                             [&](const ContactPoint& contact) {
                               return std::ranges::any_of(contact.bodies, is_scripted);
                             }) ||
         std::ranges::any_of(problem.ties, [&](const TieRow& tie) {
           return std::ranges::any_of(tie.sides, is_scripted, &TieSide::body);
         });
}

}  // namespace

std::size_t ProblemBodies::add(std::size_t body, const ContactBody& with, const Vector3d& p_WC) {
  const std::size_t place = bodies_.size();
  place_[body] = place;
  bodies_.push_back(with);
  centres_.push_back(p_WC);
  return place;
}

ContactPoint contact_at(const ManifoldPoint& touch, const ProblemBodies& bodies, double friction,
                        double least_normal_velocity) {
  ContactPoint contact;
  contact.bodies = {bodies.place(touch.bodies[0]), bodies.place(touch.bodies[1])};
  contact.arm_A = touch.point - bodies.centre(contact.bodies[0]);
  contact.arm_B = touch.point - bodies.centre(contact.bodies[1]);
  contact.frame = frame_of(touch.normal);
  contact.friction = friction;
  contact.least_normal_velocity = least_normal_velocity;
  contact.guess = contact.frame * touch.impulse;
  return contact;
}

Vector3d relative_velocity(const ContactPoint& contact, const std::vector<ContactBody>& bodies) {
  const ContactBody& A = bodies[contact.bodies[0]];
  const ContactBody& B = bodies[contact.bodies[1]];
  return contact.frame * (B.v + B.w.cross(contact.arm_B) - A.v - A.w.cross(contact.arm_A));
}

double normal_velocity(const ContactPoint& contact, const std::vector<ContactBody>& bodies) {
  return relative_velocity(contact, bodies)[0];
}

ContactSolution project_impact(
    ContactProblem problem, const std::vector<double>& restitution, std::size_t members,
    const std::function<double(const std::vector<ContactBody>&,
                               const std::vector<Eigen::VectorXd>&)>& energy,
    const ProjectionOptions& options) {
  bool bounces = false;
  std::vector<double> rebound(problem.contacts.size());
  for (std::size_t k = 0; k < rebound.size(); ++k) {
    const double approach = std::min(0.0, normal_velocity(problem.contacts[k], problem.bodies));
    rebound[k] = -restitution[k] * approach;
    bounces = bounces || rebound[k] > 0.0;
    problem.contacts[k].least_normal_velocity = 0.0;
  }
  const double before = energy(problem.bodies, velocities_of(problem.mechanisms));
  ContactSolution plastic = project_on_contacts(problem, options);
  if (!bounces) {
    return plastic;
  }
  for (std::size_t k = 0; k < rebound.size(); ++k) {
    problem.contacts[k].least_normal_velocity = rebound[k];
  }
  ContactSolution bounced = project_on_contacts(problem, options);
  if (touches_scripted(problem, members)) {
    return bounced;  // A scripted body that nothing stops may add energy.
  }
  const auto energy_at = [&](double share) {
    const ContactSolution mixed = between(plastic, bounced, share);
    return energy(mixed.bodies, mixed.mechanisms);
  };
  const double allowed = before * (1.0 + 1e-12);
  if (energy_at(1.0) <= allowed) {
    return bounced;
  }
  double low = 0.0;
  double high = 1.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (energy_at(middle) <= allowed ? low : high) = middle;
  }
  return between(plastic, bounced, low);
}

ContactSolution unchanged(const ContactProblem& problem) {
  return {.bodies = problem.bodies,
          .mechanisms = velocities_of(problem.mechanisms),
          .impulses = std::vector<Vector3d>(problem.contacts.size(), Vector3d::Zero()),
          .drives = std::vector<double>(problem.drives.size(), 0.0),
          .ties = std::vector<double>(problem.ties.size(), 0.0)};
}

std::vector<Eigen::VectorXd> velocities_of(const std::vector<ContactMechanism>& mechanisms) {
  std::vector<Eigen::VectorXd> velocities;
  velocities.reserve(mechanisms.size());
  for (const ContactMechanism& mechanism : mechanisms) {
    velocities.push_back(mechanism.velocity);
  }
  return velocities;
}

double kinetic_energy(const std::vector<ContactMechanism>& mechanisms,
                      const std::vector<Eigen::VectorXd>& velocities) {
  double sum = 0.0;
  for (std::size_t m = 0; m < mechanisms.size(); ++m) {
    const Eigen::VectorXd& v = velocities[m];
    sum += 0.5 * v.dot(mechanisms[m].inverse_mass.llt().solve(v));
  }
  return sum;
}

}  // namespace firstcontact::detail
