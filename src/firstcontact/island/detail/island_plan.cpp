#include <firstcontact/island/detail/island_plan.h>

#include <algorithm>
#include <map>

#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/island_ties.h>
#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/scene/simulation.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/contact_distances.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
using Eigen::Vector3d;

RigidState state_ahead(const IslandState& state, const Plan& plan, std::size_t member,
                       double share) {
  const SimBody& body = state.member(member);
  const RigidState& begin = state.states[member];
  const Move& move = plan.moves[member];
  const ContactBody& end = plan.at_end[member];
  RigidState ahead;
  ahead.X_WB = motion_of(body, begin.X_WB, move).pose(share);
  ahead.X_WB.rotation.normalize();
  ahead.v_WC = begin.v_WC + share * (end.v - begin.v_WC);
  ahead.w_WB = turned_along(body.inertia, begin.w_WB + share * (end.w - begin.w_WB),
                            share * move.rotation_vector);
  return ahead;
}

IslandPlanner::FreeFlight IslandPlanner::free_flight() const {
  FreeFlight flight;
  flight.at_end = bodies_.bodies();
  for (std::size_t k = 0; k < state_.size(); ++k) {
    const SimBody& body = state_.member(k);
    if (body.link_body) {
      flight.rotation_vectors.emplace_back(Vector3d::Zero());
      flight.torques.emplace_back(Vector3d::Zero());
      continue;  // It flies with its robot.
    }
    auto [force, torque] = mean_force(body, state_.start.time + state_.reached, span_);
    force += body.inertia.mass * state_.model.gravity;
    if (!ties_.empty()) {
      ties_.add_to(k, force, torque);
    }
    flight.at_end[k].v += span_ * flight.at_end[k].inverse_inertia.mass.cwiseProduct(force);
    const FreeTurn turn = free_turn(body.inertia, state_.states[k], torque, span_);
    flight.at_end[k].w = turned_along(body.inertia, turn.w_WB, -turn.rotation_vector);
    flight.rotation_vectors.push_back(turn.rotation_vector);
    flight.torques.push_back(torque);
  }
  return flight;
}

IslandPlanner::IslandPlanner(IslandState& state, double span, bool symmetric)
    : state_(state),
      span_(span),
      bodies_(state.problem_bodies()),
      ties_(state, span),
      flight_(free_flight()),
      symmetric_(symmetric || is_heap(state, state.touches())) {
  for (const auto& [pair, manifold] : state_.manifolds) {
    state_.add_others(pair, bodies_);
  }
  add_tied_bodies(state_, bodies_);
  set_bodies();
  by_end_ = symmetric_;
  for (const auto& [pair, manifold] : state_.manifolds) {
    const double lowest = least_gap(manifold);
    for (const ManifoldPoint& touch : manifold.touches) {
      // A touch that will bounce has to arrive first.
      const ContactPoint contact = contact_at(touch, bodies_, 0.0, 0.0);
      if (!state_.bounces(pair, -normal_velocity(contact, bodies_.bodies()))) {
        // In a heap each touch stops where it is, as solutions are too rough for the nearest gap.
        const double way =
            state_.model.distances.way_to_rest(touch.gap, symmetric_ ? touch.gap : lowest);
        acting_.push_back(acting(touch, -way / span_));
        append(touch, symmetric_ ? along_way(acting_.back()) : by_mean(acting_.back()));
      }
    }
  }
  first_ahead_ = touches_.size();
  robots_by_end_.assign(state_.robots.size(), false);
  if (!state_.robots.empty()) {
    fly_robots();
  } else if (!ties_.empty()) {
    lay_ties();
  }
}

/// Sets the bodies of the problem, with their free velocities. Others, of predicted contacts, come
/// last.
void IslandPlanner::set_bodies() {
  for (std::size_t b = problem_.bodies.size(); b < bodies_.bodies().size(); ++b) {
    problem_.bodies.push_back(b < state_.size() ? flight_.at_end[b] : bodies_.bodies()[b]);
  }
}

ContactSide IslandPlanner::side_of(const ManifoldPoint& touch, std::size_t side) const {
  const std::size_t body = touch.bodies[side];
  const std::size_t place = bodies_.place(body);
  const ContactBody& moving = bodies_.bodies()[place];
  return {&state_.model.bodies[body],
          touch.round[side],
          state_.pose_of(body).rotation.normalized().toRotationMatrix(),
          bodies_.centre(place),
          moving.v,
          moving.w};
}

/// Makes an acting contact. Its guess is the impulse of the touch, of a whole step.
ActingContact IslandPlanner::acting(const ManifoldPoint& touch, double least) const {
  std::array<ContactSide, 2> sides{side_of(touch, 0), side_of(touch, 1)};
  ActingContact made;
  made.now = state_.contact(touch, bodies_, least);
  made.is_round = follows_curve(made.now, sides, span_) || turns_on_corner(touch, sides, span_);
  if (!made.is_round) {  // It goes with its features of the polygon.
    sides[0].round = {};
    sides[1].round = {};
  }
  made.now.guess *= span_ / state_.start.h;
  made.halfway = {{made.now.arm_A, made.now.arm_B}, made.now.frame};
  made.is_held = least == 0.0 || made.now.guess[0] > 0.0;
  made.least = least - drift_along(touch.bodies, made.now) / span_;
  if (most_change(made.now, sides, span_) <= kLeastTolerance) {
    made.change_of_belt = change_of_belt(touch, made.now, sides, made.now.frame);
    return made;
  }
  const double distance = distance_of(touch);
  made.halfway = moved_contact(touch, made.now, distance, sides, 0.5 * span_);
  const MovedContact there = moved_contact(touch, made.now, distance, sides, span_);
  made.change = there.velocity(sides) - made.halfway.velocity(sides);
  made.change_of_belt = change_of_belt(touch, made.now, sides, there.frame);
  return made;
}

/// [m/s]  Computes the change of the velocity at which a contact sticks, to the end of the plan.
/// Belts turn with their bodies, and carry the contact to places that move otherwise.
///
/// @param frame  of the contact there
Eigen::Vector2d IslandPlanner::change_of_belt(const ManifoldPoint& touch, const ContactPoint& now,
                                              const std::array<ContactSide, 2>& sides,
                                              const Eigen::Matrix3d& frame) const {
  Eigen::Vector2d there = Eigen::Vector2d::Zero();
  bool runs = false;
  for (std::size_t s = 0; s < 2; ++s) {
    const Vector3d& belt = state_.model.laws.belt(touch.bodies[s]);
    if (belt.any()) {
      const Vector3d& w = sides[s].w;
      const Vector3d now_running = sides[s].R_WB * belt;
      const Vector3d carried = span_ * (turn(0.5 * span_ * w) * now_running);
      // Where the contact goes over a face, its path is that of the other body.
      const Vector3d by_way = goes_over(touch, sides, s) ? Vector3d::Zero() : w.cross(carried);
      const Vector3d running = turn(span_ * w) * now_running + by_way;
      there += (s == 0 ? 1.0 : -1.0) * (frame * running).tail<2>();
      runs = true;
    }
  }
  return runs ? Eigen::Vector2d(there - now.sticking_velocity) : Eigen::Vector2d::Zero();
}

void IslandPlanner::append(const ManifoldPoint& touch, const ContactPoint& contact) {
  changed_.push_back(touches_.size());
  touches_.push_back(touch);
  problem_.contacts.push_back(contact);
}

/// Whether a contact is at about the same place of one of the bodies, in that body's frame.
bool IslandPlanner::is_at(const PredictedContact& ahead, std::size_t k) const {
  // Features and normals distinguish most contacts, and are cheap to compare.
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

/// Finds the contact that a predicted contact replaces.
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

bool IslandPlanner::has(const PredictedContact& ahead) const {
  const std::optional<std::size_t> k = find(ahead);
  return k && (*k >= first_ahead_ || acting_[*k].is_replaced);
}

void IslandPlanner::add(const PredictedContact& ahead) {
  if (lifts(ahead)) {
    return;
  }
  const BodyPair& pair = ahead.touch.bodies;
  state_.add_others(pair, bodies_);
  set_bodies();
  ContactPoint contact = ahead.contact;
  contact.bodies = {bodies_.place(pair[0]), bodies_.place(pair[1])};
  contact.friction = state_.model.laws.friction(pair);
  contact.sticking_velocity = state_.belt_velocity(pair, contact.frame);
  contact.least_normal_velocity = ahead.least - drift_along(pair, contact) / span_;
  const std::optional<std::size_t> k = find(ahead);
  if (!k) {
    ahead_.emplace(pair, touches_.size());
    append(ahead.touch, contact);
    return;
  }
  if (*k >= first_ahead_) {
    keep_push_from(contact);
  } else {
    acting_[*k].is_replaced = true;
  }
  const ContactPoint& before = problem_.contacts[*k];
  contact.guess = contact.frame * (before.frame.transpose() * before.guess);
  touches_[*k] = ahead.touch;
  problem_.contacts[*k] = contact;
  changed_.push_back(*k);
}

/// Solves all of the problem, or only the changes since the last plan.
void IslandPlanner::solve() {
  std::optional<PlanSolution> again;
  if (last_) {
    again = project_plan_again(state_, problem_, *last_, changed_);
  }
  std::optional<double> free;
  if (spins_ || loads_) {
    const double of_robots =
        kinetic_energy(problem_.mechanisms, velocities_of(problem_.mechanisms));
    const double of_bodies = spins_ ? spins_->energy : free_energy(state_, problem_) - of_robots;
    free = of_bodies + (loads_ ? loads_->energy : of_robots);
  }
  last_ = again ? std::move(*again) : project_plan(state_, problem_, free);
  changed_.clear();
  impulses_.clear();
  for (std::size_t k = 0; k < problem_.contacts.size(); ++k) {
    ContactPoint& contact = problem_.contacts[k];
    contact.guess = last_->velocities.impulses[k];
    impulses_.emplace_back(contact.frame.transpose() * contact.guess);
  }
  for (std::size_t k = 0; k < problem_.ties.size(); ++k) {
    problem_.ties[k].guess = last_->velocities.ties[k];
  }
}

/// Finds the impulses: those that agree with the rules of the plan and its curves.
///
/// @returns whether those of ties were found
bool IslandPlanner::find_solution() {
  if (!state_.robots.empty()) {
    choose_rules();
  }
  solve();
  for (int pass = 0; pass < kPassesOfCurves && !by_end_; ++pass) {
    const bool slides = follow_slides();  // First: it looks at the contacts as they were solved.
    const bool turns = follow_curves();
    const bool spins = follow_spins();
    // The first flight of a robot at rest turned away, so that its contacts had other arms.
    const bool swings = (pass == 0 || turn_of_links() < kSwing) && follow_loads();
    if (spins || swings) {
      last_.reset();
    }
    if (!turns && !slides && last_) {
      break;
    }
    solve();
  }
  by_end_ = by_end_ || !mean_is_allowed();
  end_spins();
  if (!state_.robots.empty() && lead_robots_by_end(led_by_end())) {
    solve();
    by_end_ = by_end_ || !mean_is_allowed();
    end_spins();
  }
  const bool finds_ties = ties_.empty() || follow_ties();
  end_spins();
  return finds_ties;
}

/// Makes the motions of free bodies by the impulses; those of robots follow.
Plan IslandPlanner::plan_of_bodies(const std::vector<bool>& by_end) {
  const ContactSolution& solution = last_->velocities;
  Plan made{.at_end = solution.bodies,
            .residual = solution.residual,
            .is_limited = last_->is_limited,
            .is_solved = last_->slips || is_solved(state_, solution)};
  made.at_end.resize(state_.size());
  const bool by_chords = by_end_ && !symmetric_ && state_.robots.empty() && ties_.empty() &&
                         !is_heap(state_, problem_.contacts.size()) && any_turns();
  const std::vector<ContactBody> after = by_chords ? along_chords().bodies : solution.bodies;
  const std::vector<std::optional<std::size_t>> carriers = this->carriers();
  for (std::size_t k = 0; k < state_.size(); ++k) {
    const Vector3d turning = carriers[k] ? solution.bodies[*carriers[k]].w : Vector3d::Zero();
    made.moves.push_back(move_of(k, by_end[k], turning, after[k]));
  }
  return made;
}

Plan IslandPlanner::plan() {
  const bool finds_ties = find_solution();
  const ContactSolution& solution = last_->velocities;
  const std::vector<bool> by_end = led_by_end();
  Plan made = plan_of_bodies(by_end);
  if (!is_finite(solution)) {
    made.is_refused = true;
    return made;
  }
  made.finds_ties = finds_ties;
  std::vector<OuterImpulse> outer =
      outer_impulses(problem_, *last_, bodies_, state_.robots.size(), span_);
  std::vector<OuterImpulse> changes = changes_of(outer);
  ties_.add_changes(solution.ties, changes);
  ties_.add_all(solution.ties, outer);
  made.ties = ties_.impulses(solution.ties);
  made.robots = state_.robots.plan(problem_, solution, flights_, by_end, changes, plan_span());
  shift_robots(made);
  state_.robots.set_moves(made.robots, state_.states, span_, share_of_drift(), made.moves);
  if (leads_nowhere(made)) {
    made.is_refused = true;
  } else {
    settle(outer, made);
  }
  return made;
}

std::vector<ManifoldPoint> IslandPlanner::touches() const {
  std::vector<ManifoldPoint> touches = touches_;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    touches[k].impulse = impulses_[k];
  }
  return touches;
}

/// [-]  The fraction of its links' drift that a plan corrects. All of it in a short plan would be a
/// speed to which contacts respond: 30 um in a nanosecond.
double IslandPlanner::share_of_drift() const {
  return std::min(1.0, span_ / (kSpanOfDrift * state_.start.h));
}

/// [m]  The path along a contact's normal that the drift of links adds.
double IslandPlanner::drift_along(const BodyPair& pair, const ContactPoint& contact) const {
  double way = 0.0;
  for (int side = 0; side < 2; ++side) {
    if (state_.model.bodies[pair[side]].link_body) {
      const std::size_t k = state_.place.at(pair[side]);
      const Move drift = state_.robots.drift(k, state_.states[k].X_WB).part(share_of_drift());
      const Vector3d& arm = side == 0 ? contact.arm_A : contact.arm_B;
      const Vector3d at_contact = drift.translation + drift.rotation_vector.cross(arm);
      way += (side == 0 ? -1.0 : 1.0) * contact.frame.row(0).dot(at_contact);
    }
  }
  return way;
}

/// Whether the mean of the velocities at both ends keeps every constraint. It is exact under
/// constant forces. A constraint that only begins to act breaks it, as happens in almost any heap.
bool IslandPlanner::mean_is_allowed() const {
  const std::vector<ContactBody>& before = bodies_.bodies();
  std::vector<ContactBody> mean = last_->velocities.bodies;
  for (std::size_t b = 0; b < mean.size(); ++b) {
    mean[b].v = 0.5 * (before[b].v + mean[b].v);
    mean[b].w = 0.5 * (before[b].w + mean[b].w);
  }
  const double slack = slack_of_mean();
  for (std::size_t k = 0; k < problem_.contacts.size(); ++k) {
    const bool is_kept = is_on_curve(k) && last_->velocities.impulses[k][0] > 0.0;
    const double missing = least_of_mean(k) - normal_velocity(problem_.contacts[k], mean);
    const bool is_close =
        missing <= slack ||
        (is_kept && missing * span_ <= most_from_curve(k, last_->velocities.bodies));
    if (!is_close) {
      return false;
    }
  }
  std::size_t end = 0;
  for (std::size_t first = 0; first < first_ahead_; first = end) {
    while (end < first_ahead_ && touches_[end].bodies == touches_[first].bodies) {
      ++end;
    }
    if (stops_early(first, end)) {
      return false;
    }
  }
  return true;
}

/// Whether a contact acts when the plan begins, and no predicted one has taken its place.
bool IslandPlanner::acts(std::size_t k) const {
  return k < first_ahead_ && !acting_[k].is_replaced;
}

/// [m/s]  Slower relative motions of a contact are too short in a plan to matter.
double IslandPlanner::least_speed() const {
  return kSlackOfMean * state_.model.distances.least / span_;
}

/// [m/s]  The most by which the mean of a normal velocity may be below its least one.
double IslandPlanner::slack_of_mean() const {
  return 2.0 * projection_options(state_, problem_).tolerance + least_speed();
}

/// [m/s]  The least mean normal velocity of a contact.
double IslandPlanner::least_of_mean(std::size_t k) const {
  return acts(k) ? acting_[k].least : problem_.contacts[k].least_normal_velocity;
}

/// Whether any contact changes with the motion of its bodies.
bool IslandPlanner::any_turns() const {
  const double tolerance = projection_options(state_, problem_).tolerance;
  return std::ranges::any_of(acting_, [&](const ActingContact& acting) {
    return acting.change.cwiseAbs().maxCoeff() > tolerance;
  });
}

/// Finds the velocities from the begin of a plan to its end. Where contacts turn, velocities at the
/// end point along their circles there, and these point along the chords.
ContactSolution IslandPlanner::along_chords() const {
  ContactProblem problem = problem_;
  for (std::size_t k = 0; k < first_ahead_; ++k) {
    if (acts(k)) {
      const Vector3d guess = problem.contacts[k].guess;
      problem.contacts[k] = along_way(acting_[k]);
      problem.contacts[k].guess = guess;
    }
  }
  return project_way(state_, problem, span_).velocities;
}

/// Finds the bodies of the problem that move by the velocities at the end.
std::vector<bool> IslandPlanner::led_by_end() const {
  std::vector<bool> by_end(bodies_.bodies().size(), false);
  if (by_end_) {
    for (const ContactPoint& contact : problem_.contacts) {
      by_end[contact.bodies[0]] = true;
      by_end[contact.bodies[1]] = true;
    }
  } else if (!state_.robots.empty()) {
    const std::vector<std::optional<std::size_t>> carriers = this->carriers();
    std::transform(carriers.begin(), carriers.end(), by_end.begin(),
                   [](const auto& carrier) { return carrier.has_value(); });
  }
  return by_end;
}

/// Makes the motion of a member from its velocity at the end. The motion of a link body is its
/// robot's.
///
/// @param by_end   whether it moves by that velocity, or by the mean of those at both ends
/// @param turning  [rad/s]  of its carrier: halfway the velocity has turned by half of the turn
///         less
Move IslandPlanner::move_of(std::size_t k, bool by_end, const Vector3d& turning,
                            const ContactBody& after) const {
  const ContactBody& before = bodies_.bodies()[k];
  const Vector3d& w_free = flight_.at_end[k].w;
  if (by_end) {
    const Vector3d change = after.w - 0.5 * (before.w + w_free);
    return {span_ * (turn(-0.5 * span_ * turning) * after.v),
            flight_.rotation_vectors[k] + span_ * change};
  }
  const Move shift = ties_.shift(k);
  const Vector3d change = 0.5 * (after.w - w_free);
  return {0.5 * span_ * (before.v + after.v) + shift.translation,
          flight_.rotation_vectors[k] + span_ * change + shift.rotation_vector};
}

}  // namespace firstcontact::detail
