#include <firstcontact/simulation/detail/island_plan.h>

#include <algorithm>

#include <firstcontact/contact_solver/detail/re_solve.h>
#include <firstcontact/scene/simulation.h>
#include <firstcontact/simulation/detail/constants.h>
#include <firstcontact/simulation/detail/contact_distances.h>
#include <firstcontact/simulation/detail/island_state.h>
#include <firstcontact/simulation/detail/sim_body.h>
#include <firstcontact/simulation/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

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
    Vector3d force = body.inertia.mass * state_.model.gravity;
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
    : state_(state), span_(span), bodies_(state.problem_bodies()), flight_(free_flight()) {
  for (const auto& [pair, manifold] : state_.manifolds) {
    state_.add_others(pair, bodies_);
  }
  set_bodies();
  for (const auto& [pair, manifold] : state_.manifolds) {
    for (const ManifoldPoint& touch : manifold.touches) {
      // What will bounce has to arrive first.
      const ContactPoint contact = contact_at(touch, bodies_, 0.0, 0.0);
      if (!state_.bounces(pair, -normal_velocity(contact, bodies_.bodies()))) {
        append(touch, contact_of(touch, -state_.model.distances.way_to_rest(touch.gap) / span_));
      }
    }
  }
  first_ahead_ = touches_.size();
  robots_by_end_.assign(state_.robots.size(), false);
  if (!state_.robots.empty()) {
    choose_rules();
    fly_robots();
  }
}

/// [m/s]  Velocities this much too small are allowed by a contact.
double IslandPlanner::slack() const { return 2.0 * projection_options(state_, problem_).tolerance; }

/// Velocities at the end will lead the robots in contact where a contact that pressed before closes
/// now: then the mean of both ends would close it.
void IslandPlanner::choose_rules() {
  const double least = slack();
  const auto closes = [&](const ContactPoint& contact) {
    return contact.guess[0] > 0.0 &&
           normal_velocity(contact, bodies_.bodies()) < contact.least_normal_velocity - 2.0 * least;
  };
  if (std::ranges::none_of(problem_.contacts, closes)) {
    return;
  }
  for (const ContactPoint& contact : problem_.contacts) {
    for (const std::size_t place : contact.bodies) {
      if (place < state_.size() && state_.member(place).piece) {
        robots_by_end_[state_.robots.robot_of(place)] = true;
      }
    }
  }
}

void IslandPlanner::fly_robots() {
  state_.robots.fly(state_.start.time + state_.reached, span_, robots_by_end_, flights_);
  state_.robots.set(flights_, problem_);
}

/// Flies robots anew where that has to be. Returns whether there were any.
bool IslandPlanner::lead_robots_by_end(const std::vector<bool>& by_end) {
  std::vector<bool> led = state_.robots.led_by_end(problem_, last_->velocities, flights_, by_end,
                                                   state_.start.time + state_.reached, span_);
  for (std::size_t r = 0; r < led.size(); ++r) {
    led[r] = led[r] || robots_by_end_[r];
  }
  if (led == robots_by_end_) {
    return false;
  }
  robots_by_end_ = std::move(led);
  fly_robots();
  last_.reset();
  return true;
}

/// Those of the problem, with their free velocities. Others that contacts ahead bring come last.
void IslandPlanner::set_bodies() {
  for (std::size_t b = problem_.bodies.size(); b < bodies_.bodies().size(); ++b) {
    problem_.bodies.push_back(b < state_.size() ? flight_.at_end[b] : bodies_.bodies()[b]);
  }
}

/// Its guess is the impulse of the touch, of a whole step.
ContactPoint IslandPlanner::contact_of(const ManifoldPoint& touch, double least) const {
  ContactPoint contact =
      contact_at(touch, bodies_, state_.model.laws.friction(touch.bodies), least);
  contact.guess *= span_ / state_.start.h;
  contact.least_normal_velocity -= drift_along(touch.bodies, contact) / span_;
  return contact;
}

void IslandPlanner::append(const ManifoldPoint& touch, const ContactPoint& contact) {
  changed_.push_back(touches_.size());
  touches_.push_back(touch);
  problem_.contacts.push_back(contact);
}

/// Whether a contact is about the same place of one of the bodies, seen from there.
bool IslandPlanner::is_at(const PredictedContact& ahead, std::size_t k) const {
  // Features and normals tell most apart, and cost least.
  const ManifoldPoint& touch = touches_[k];
  if (!same_features(touch, ahead.touch) ||
      !(touch.normal.dot(ahead.touch.normal) >= kReplacedNormal)) {
    return false;
  }
  const ContactPoint& contact = problem_.contacts[k];
  const double apart = std::min((contact.arm_A - ahead.contact.arm_A).norm(),
                                (contact.arm_B - ahead.contact.arm_B).norm());
  return apart <= kReplacedWithin * smaller_reach(state_.model, ahead.touch.bodies);
}

/// The contact whose place a touch ahead takes.
std::optional<std::size_t> IslandPlanner::find(const PredictedContact& ahead) const {
  const BodyPair& pair = ahead.touch.bodies;
  const auto end_touching = touches_.begin() + static_cast<std::ptrdiff_t>(first_ahead_);
  auto touch =
      std::ranges::lower_bound(touches_.begin(), end_touching, pair, {}, &ManifoldPoint::bodies);
  for (; touch != end_touching && touch->bodies == pair; ++touch) {
    const auto k = static_cast<std::size_t>(touch - touches_.begin());
    if (is_at(ahead, k)) {
      return k;
    }
  }
  const auto [first, end] = ahead_.equal_range(pair);
  const auto found =
      std::find_if(first, end, [&](const auto& entry) { return is_at(ahead, entry.second); });
  return found == end ? std::nullopt : std::optional(found->second);
}

void IslandPlanner::add(const PredictedContact& ahead) {
  const BodyPair& pair = ahead.touch.bodies;
  state_.add_others(pair, bodies_);
  set_bodies();
  ContactPoint contact = ahead.contact;
  contact.bodies = {bodies_.place(pair[0]), bodies_.place(pair[1])};
  contact.friction = state_.model.laws.friction(pair);
  contact.least_normal_velocity = ahead.least - drift_along(pair, contact) / span_;
  const std::optional<std::size_t> k = find(ahead);
  if (!k) {
    ahead_.emplace(pair, touches_.size());
    append(ahead.touch, contact);
    return;
  }
  if (*k >= first_ahead_) {
    keep_push_from(contact);
  }
  const ContactPoint& before = problem_.contacts[*k];
  contact.guess = contact.frame * (before.frame.transpose() * before.guess);
  touches_[*k] = ahead.touch;
  problem_.contacts[*k] = contact;
  changed_.push_back(*k);
}

/// All of it, or what changed since the last plan.
void IslandPlanner::solve() {
  std::optional<PlanSolution> again;
  if (last_) {
    again = project_plan_again(state_, problem_, *last_, changed_);
  }
  last_ = again ? std::move(*again) : project_plan(state_, problem_);
  changed_.clear();
  for (std::size_t k = 0; k < problem_.contacts.size(); ++k) {
    problem_.contacts[k].guess = last_->velocities.impulses[k];
  }
}

Plan IslandPlanner::plan() {
  solve();
  std::vector<bool> by_end = led_by_end();
  if (!state_.robots.empty() && lead_robots_by_end(by_end)) {
    solve();
    by_end = led_by_end();
  }
  const ContactSolution& solution = last_->velocities;
  Plan made{.at_end = solution.bodies, .residual = solution.residual};
  made.at_end.resize(state_.size());
  set_moves(by_end, made);
  const std::vector<OuterImpulse> outer =
      outer_impulses(problem_, *last_, bodies_, state_.robots.size());
  made.robots = state_.robots.plan(problem_, solution, flights_, by_end, outer,
                                   state_.start.time + state_.reached, span_);
  push_apart(made);
  state_.robots.keep_momenta(outer, span_, made.robots);
  state_.robots.set_moves(made.robots, state_.states, span_, made.moves);
  return made;
}

std::vector<ManifoldPoint> IslandPlanner::touches() const {
  std::vector<ManifoldPoint> touches = touches_;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    const ContactPoint& contact = problem_.contacts[k];
    touches[k].impulse = contact.frame.transpose() * contact.guess;
  }
  return touches;
}

/// [m]  What the drift of links adds to the way along a contact's normal.
double IslandPlanner::drift_along(const BodyPair& pair, const ContactPoint& contact) const {
  double way = 0.0;
  for (int side = 0; side < 2; ++side) {
    if (state_.model.bodies[pair[side]].piece) {
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
std::vector<bool> IslandPlanner::led_by_end() const {
  const std::vector<ContactBody>& before = bodies_.bodies();
  std::vector<ContactBody> mean = last_->velocities.bodies;
  for (std::size_t b = 0; b < mean.size(); ++b) {
    mean[b].v = 0.5 * (before[b].v + mean[b].v);
    mean[b].w = 0.5 * (before[b].w + mean[b].w);
  }
  const double least = slack();
  const bool mean_is_allowed =
      std::ranges::all_of(problem_.contacts, [&](const ContactPoint& contact) {
        return normal_velocity(contact, mean) >= contact.least_normal_velocity - least;
      });
  std::vector<bool> by_end(before.size(), false);
  if (!mean_is_allowed) {
    for (const ContactPoint& contact : problem_.contacts) {
      by_end[contact.bodies[0]] = true;
      by_end[contact.bodies[1]] = true;
    }
  }
  return by_end;
}

/// Those of pieces of links are their robots' matter.
void IslandPlanner::set_moves(const std::vector<bool>& by_end, Plan& plan) const {
  const std::vector<ContactBody>& before = bodies_.bodies();
  const std::vector<ContactBody>& after = last_->velocities.bodies;
  for (std::size_t k = 0; k < state_.size(); ++k) {
    const Vector3d& w_free = flight_.at_end[k].w;
    const Vector3d& w = after[k].w;
    const Vector3d turn =
        by_end[k] ? Vector3d(w - 0.5 * (before[k].w + w_free)) : Vector3d(0.5 * (w - w_free));
    const Vector3d& v = after[k].v;
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

/// Displacements that bring a touch ahead about once more are to be found anew, with it: it may be
/// of features that were beyond the band, on the other side of a link, say. Held by velocities
/// alone, it would be reached over and over again, in ever shorter plans.
void IslandPlanner::keep_push_from(const ContactPoint& contact) {
  if (!push_) {
    return;
  }
  push_->bodies.resize(problem_.bodies.size());  // Others that came since do not move.
  if (normal_velocity(contact, push_->bodies) < -kPushTolerance * state_.model.distances.least) {
    push_.reset();
  }
}

/// Displacements, in metres in place of metres per second: least in the kinetic metric, and
/// without velocity, so that they add no energy of motion.
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
  if (problem.mechanisms.empty()) {  // Most have room: only those around move.
    ProjectionOptions around_options = options;
    around_options.sweeps = kPushSweepsAround;
    ContactSolution around =
        re_solve(problem, {.bodies = problem.bodies}, too_near, around_options);
    if (around.residual <= (is_heap(state_, problem) ? options.enough : options.tolerance)) {
      return around;
    }
  }
  return project_on_contacts(problem, options);
}

}  // namespace firstcontact::detail
