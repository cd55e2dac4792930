#include <algorithm>
#include <cstddef>
#include <vector>

#include <firstcontact/contact_solver/detail/re_solve.h>
#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/island_ties.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/contact_distances.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {

/// Adds displacements that bring pairs back to their rest gap.
void IslandPlanner::push_apart(Plan& plan) {
  if (!state_.is_too_near() || span_ < kLeastSpanOfPush * state_.start.h) {
    return;
  }
  if (!push_) {
    push_ = find_push();
    limit_push(state_.model.distances.least, *push_);
  }
  displace(*push_, plan);
}

/// Adds displacements to the motions of a plan.
void IslandPlanner::displace(const ContactSolution& displacement, Plan& plan) const {
  state_.robots.displace(displacement.mechanisms, plan.robots);
  for (std::size_t k = 0; k < state_.size(); ++k) {
    plan.moves[k].translation += displacement.bodies[k].v;
    plan.moves[k].rotation_vector += displacement.bodies[k].w;
  }
}

/// Limits a displacement: it takes no time, so no point moves by more than a distance. For bodies
/// that are pushed apart it is the contact distance. Where bodies jam a long way sideways may gain
/// little, as in a chain that is almost taut. The constraints permit a share of a displacement,
/// too.
///
/// @param most  [m]
void IslandPlanner::limit_push(double most, ContactSolution& push) const {
  double greatest = 0.0;  // [m]
  for (std::size_t k = 0; k < state_.size(); ++k) {
    const ContactBody& body = push.bodies[k];
    greatest = std::max(greatest, body.v.norm() + state_.member(k).reach * body.w.norm());
  }
  if (greatest <= most) {
    return;
  }
  for (ContactBody& body : push.bodies) {
    body.v *= most / greatest;
    body.w *= most / greatest;
  }
  for (Eigen::VectorXd& mechanism : push.mechanisms) {
    mechanism *= most / greatest;
  }
}

/// Discards displacements that would cause a predicted contact again; they are found anew, with it.
/// It may be of features that were beyond the band, as on the other side of a link. Held by
/// velocities alone, it would be reached again and again, in ever shorter plans.
void IslandPlanner::keep_push_from(const ContactPoint& contact) {
  if (!push_) {
    return;
  }
  push_->bodies.resize(problem_.bodies.size());  // Bodies that came since do not move.
  if (normal_velocity(contact, push_->bodies) < -kPushTolerance * state_.model.distances.least) {
    push_.reset();
  }
}

/// Sets the bodies, robots, stops and ties of a problem of displacements.
void IslandPlanner::set_at_rest(ContactProblem& problem) const {
  problem.bodies = bodies_.bodies();
  for (ContactBody& body : problem.bodies) {
    body.v.setZero();
    body.w.setZero();
  }
  state_.robots.add_mechanisms(problem);
  for (ContactMechanism& mechanism : problem.mechanisms) {
    mechanism.velocity.setZero();
  }
  state_.robots.add_stops(problem);
  problem.ties = rigid_rows(state_, bodies_);
}

/// Finds displacements, in metres in place of metres per second. They are least in the kinetic
/// metric, and without velocity, so that they add no kinetic energy.
ContactSolution IslandPlanner::find_push() const {
  const ContactDistances& distances = state_.model.distances;
  const ProjectionOptions options{.tolerance = kPushTolerance * distances.least,
                                  .enough = kPushEnough * distances.least,
                                  .sweeps = kPushSweeps};
  ContactProblem problem;
  std::vector<std::size_t> too_near;
  for (const auto& [pair, manifold] : state_.manifolds) {
    for (const ManifoldPoint& touch : manifold.touches) {
      const double missing = distances.least - touch.gap;
      if (kPush * missing > options.tolerance) {
        too_near.push_back(problem.contacts.size());
      }
      ManifoldPoint unknown = touch;
      unknown.impulse.setZero();
      problem.contacts.push_back(
          contact_at(unknown, bodies_, 0.0, missing > 0.0 ? kPush * missing : missing));
    }
  }
  for (std::size_t k = first_ahead_; k < problem_.contacts.size(); ++k) {
    const ContactPoint& ahead = problem_.contacts[k];
    problem.contacts.push_back(
        {.bodies = ahead.bodies, .arm_A = ahead.arm_A, .arm_B = ahead.arm_B, .frame = ahead.frame});
  }
  set_at_rest(problem);
  if (problem.mechanisms.empty() &&
      problem.ties.empty()) {  // Most have room: only the bodies around them move.
    ProjectionOptions around_options = options;
    around_options.sweeps = kPushSweepsAround;
    ContactSolution around =
        re_solve(problem, {.bodies = problem.bodies}, too_near, around_options);
    if (around.residual <=
        (is_heap(state_, problem.contacts.size()) ? options.enough : options.tolerance)) {
      return around;
    }
  }
  return project_on_contacts(problem, options);
}

}  // namespace firstcontact::detail
