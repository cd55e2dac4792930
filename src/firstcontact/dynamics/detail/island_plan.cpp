#include <firstcontact/dynamics/detail/island_plan.h>

#include <algorithm>

#include <firstcontact/dynamics/detail/project_again.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Half of what is missing to the rest distance is made up for in a plan.
constexpr double kPush = 0.5;

/// A touch ahead takes the place of what the same features say if that is as near as this part of
/// the smaller body and points as much the same way.
constexpr double kReplacedWithin = 0.1;
constexpr double kReplacedNormal = 1.0 - 1e-3;  // [-]  Cosine.

}  // namespace

IslandPlanner::FreeFlight IslandPlanner::free_flight() const {
  FreeFlight flight;
  flight.at_end = bodies_.bodies();
  for (std::size_t k = 0; k < state_.size(); ++k) {
    const SimBody& body = state_.member(k);
    if (body.piece) {
      flight.rotation_vectors.emplace_back(Vector3d::Zero());
      continue;  // Flies with its robot.
    }
    Vector3d force = body.inertia.mass * state_.world.gravity;
    Vector3d torque = Vector3d::Zero();
    const double from = state_.start.time + state_.reached;
    for (const TimedForce& timed : body.forces) {
      // The mean over the span.
      const double share =
          std::max(0.0, std::min(timed.to, from + span_) - std::max(timed.from, from)) / span_;
      force += share * timed.force;
      torque += share * timed.torque;
    }
    flight.at_end[k].v += span_ * flight.at_end[k].inverse_inertia.mass.cwiseProduct(force);
    const FreeTurn turn = free_turn(body.inertia, state_.states[k], torque, span_);
    flight.at_end[k].w = turned_along(body.inertia, turn.w_WB, -turn.rotation_vector);
    flight.rotation_vectors.push_back(turn.rotation_vector);
  }
  return flight;
}

IslandPlanner::IslandPlanner(IslandState& state, double span)
    : state_(state), span_(span), bodies_(state.problem_bodies()) {
  for (const auto& [pair, manifold] : state_.manifolds) {
    state_.add_others(pair, bodies_);
    for (const Touch& touch : manifold.touches) {
      // What will bounce has to arrive first.
      const ContactPoint contact = contact_at(touch, bodies_, 0.0, 0.0);
      if (!state_.bounces(pair, -normal_velocity(contact, bodies_.bodies()))) {
        constraints_.emplace(
            pair, Constraint{touch, -state_.world.distances.way_to_rest(touch.gap) / span_});
      }
    }
  }
  flight_ = free_flight();
}

std::array<Vector3d, 2> IslandPlanner::arms_of(const Constraint& constraint) const {
  if (constraint.arms) {
    return *constraint.arms;
  }
  const ContactPoint contact = contact_at(constraint.touch, bodies_, 0.0, 0.0);
  return {contact.arm_A, contact.arm_B};
}

/// Whether a constraint is about the same place of one of the bodies, seen from there.
bool IslandPlanner::is_at(const TouchAhead& ahead, const Constraint& constraint) const {
  // Features and normals tell most apart, and cost least.
  if (!same_features(constraint.touch, ahead.touch) ||
      !(constraint.touch.normal.dot(ahead.touch.normal) >= kReplacedNormal)) {
    return false;
  }
  const std::array<Vector3d, 2> arms = arms_of(constraint);
  const double apart =
      std::min((arms[0] - ahead.contact.arm_A).norm(), (arms[1] - ahead.contact.arm_B).norm());
  return apart <= kReplacedWithin * smaller_reach(state_.world, ahead.touch.bodies);
}

void IslandPlanner::add(const TouchAhead& ahead) {
  const BodyPair& pair = ahead.touch.bodies;
  state_.add_others(pair, bodies_);
  Constraint constraint{.touch = ahead.touch,
                        .least = ahead.least,
                        .arms = {{ahead.contact.arm_A, ahead.contact.arm_B}}};
  const auto [first, end] = constraints_.equal_range(pair);
  const auto found =
      std::find_if(first, end, [&](const auto& entry) { return is_at(ahead, entry.second); });
  if (found == end) {
    constraints_.emplace(pair, std::move(constraint));
    return;
  }
  constraint.touch.impulse = found->second.touch.impulse;
  found->second = std::move(constraint);
}

ContactProblem IslandPlanner::problem_now() const {
  ContactProblem problem{.bodies = bodies_.bodies()};
  std::ranges::copy(flight_.at_end, problem.bodies.begin());
  for (const auto& [pair, constraint] : constraints_) {
    ContactPoint contact =
        contact_at(constraint.touch, bodies_, state_.world.laws.friction(pair), constraint.least);
    if (constraint.arms) {
      contact.arm_A = (*constraint.arms)[0];
      contact.arm_B = (*constraint.arms)[1];
    }
    contact.guess *= span_ / state_.start.h;
    contact.least_normal_velocity -= drift_along(pair, contact) / span_;
    problem.contacts.push_back(contact);
  }
  return problem;
}

/// All of it, or what changed since the last plan.
PlanSolution IslandPlanner::solve(const ContactProblem& problem) {
  std::vector<std::size_t> changed;
  std::size_t k = 0;
  for (auto& [pair, constraint] : constraints_) {
    if (constraint.is_new) {
      changed.push_back(k);
      constraint.is_new = false;
    }
    ++k;
  }
  if (last_) {
    if (std::optional<PlanSolution> again = project_plan_again(state_, problem, *last_, changed)) {
      return std::move(*again);
    }
  }
  return project_plan(state_, problem);
}

Plan IslandPlanner::plan() {
  ContactProblem problem = problem_now();
  const std::vector<RobotPlan> free =
      state_.robots.fly(problem, state_.start.time + state_.reached, span_);
  last_ = solve(problem);
  const ContactSolution& solution = last_->velocities;
  Plan made{.at_end = solution.bodies, .residual = solution.residual};
  std::size_t k = 0;
  for (auto& [pair, constraint] : constraints_) {
    Touch acting = constraint.touch;
    acting.impulse = problem.contacts[k].frame.transpose() * solution.impulses[k];
    constraint.touch.impulse = acting.impulse / (span_ / state_.start.h);
    made.touches.push_back(acting);
    ++k;
  }
  made.at_end.resize(state_.size());
  const std::vector<bool> by_end = led_by_end(problem, bodies_.bodies(), solution);
  set_moves(bodies_.bodies(), solution, by_end, made);
  made.robots = state_.robots.plan(problem, solution, free, by_end, span_);
  push_apart(made);
  state_.robots.set_moves(made.robots, state_.states, span_, made.moves);
  return made;
}

/// [m]  What the drift of links adds to the way along a contact's normal.
double IslandPlanner::drift_along(const BodyPair& pair, const ContactPoint& contact) const {
  double way = 0.0;
  for (int side = 0; side < 2; ++side) {
    if (state_.world.bodies[pair[side]].piece) {
      const std::size_t k = state_.place.at(pair[side]);
      const Move drift = state_.robots.drift(k, state_.states[k].X_WB);
      const Vector3d& arm = side == 0 ? contact.arm_A : contact.arm_B;
      const Vector3d at_contact = drift.translation + drift.rotation_vector.cross(arm);
      way += (side == 0 ? -1.0 : 1.0) * contact.frame.row(0).dot(at_contact);
    }
  }
  return way;
}

/// The mean of the velocities at both ends is exact under constant forces; where it would break a
/// constraint, as at one that only begins to act, or somewhere in nearly any heap, those at the end
/// lead the bodies in contact.
std::vector<bool> IslandPlanner::led_by_end(const ContactProblem& problem,
                                            const std::vector<ContactBody>& before,
                                            const ContactSolution& solution) const {
  std::vector<ContactBody> mean = solution.bodies;
  for (std::size_t b = 0; b < mean.size(); ++b) {
    mean[b].v = 0.5 * (before[b].v + solution.bodies[b].v);
    mean[b].w = 0.5 * (before[b].w + solution.bodies[b].w);
  }
  const double slack = 2.0 * projection_options(state_, problem).tolerance;
  const bool mean_is_allowed =
      std::ranges::all_of(problem.contacts, [&](const ContactPoint& contact) {
        return normal_velocity(contact, mean) >= contact.least_normal_velocity - slack;
      });
  std::vector<bool> by_end(before.size(), false);
  if (!mean_is_allowed) {
    for (const ContactPoint& contact : problem.contacts) {
      by_end[contact.bodies[0]] = true;
      by_end[contact.bodies[1]] = true;
    }
  }
  return by_end;
}

/// Those of pieces of links are their robots' matter.
void IslandPlanner::set_moves(const std::vector<ContactBody>& before,
                              const ContactSolution& solution, const std::vector<bool>& by_end,
                              Plan& plan) const {
  for (std::size_t k = 0; k < state_.size(); ++k) {
    const Vector3d& w_free = flight_.at_end[k].w;
    const Vector3d& w = solution.bodies[k].w;
    const Vector3d turn =
        by_end[k] ? Vector3d(w - 0.5 * (before[k].w + w_free)) : Vector3d(0.5 * (w - w_free));
    const Vector3d& v = solution.bodies[k].v;
    plan.moves.push_back({span_ * (by_end[k] ? v : Vector3d(0.5 * (before[k].v + v))),
                          flight_.rotation_vectors[k] + span_ * turn});
  }
}

/// Adds displacements that lead pairs back to their distance of rest.
void IslandPlanner::push_apart(Plan& plan) {
  if (!state_.is_too_near() || span_ < stall(state_.start.h)) {
    return;
  }
  if (!push_) {
    push_ = find_push();
  }
  state_.robots.displace(push_->mechanisms, plan.robots);
  for (std::size_t k = 0; k < state_.size(); ++k) {
    plan.moves[k].translation += push_->bodies[k].v;
    plan.moves[k].rotation_vector += push_->bodies[k].w;
  }
}

/// Displacements, in metres in place of metres per second: least in the kinetic metric, and
/// without velocity, so that they add no energy of motion.
ContactSolution IslandPlanner::find_push() {
  const ContactDistances& distances = state_.world.distances;
  ProblemBodies bodies = state_.problem_bodies();
  const ProjectionOptions options{
      .tolerance = 1e-2 * distances.least, .enough = 0.3 * distances.least, .sweeps = 50};
  ContactProblem problem;
  std::vector<std::size_t> too_near;
  for (const auto& [pair, manifold] : state_.manifolds) {
    for (const Touch& touch : manifold.touches) {
      state_.add_others(pair, bodies);
      const double missing = distances.least - touch.gap;
      if (kPush * missing > options.tolerance) {
        too_near.push_back(problem.contacts.size());
      }
      Touch unknown = touch;
      unknown.impulse.setZero();
      problem.contacts.push_back(
          contact_at(unknown, bodies, 0.0, missing > 0.0 ? kPush * missing : missing));
    }
  }
  problem.bodies = bodies.bodies();
  for (ContactBody& body : problem.bodies) {
    body.v.setZero();
    body.w.setZero();
  }
  state_.robots.add_mechanisms(problem);
  for (ContactMechanism& mechanism : problem.mechanisms) {
    mechanism.velocity.setZero();
  }
  if (problem.mechanisms.empty()) {  // Most have room: only those around move.
    ContactSolution around = project_again(problem, problem.bodies, too_near, options);
    if (around.residual <= (is_heap(state_, problem) ? options.enough : options.tolerance)) {
      return around;
    }
  }
  return project_on_contacts(problem, options);
}

}  // namespace firstcontact::detail
