#include <firstcontact/island/detail/plan_ties.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/contact_solver/detail/tie_rows.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/island_ties.h>
#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/response.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// The vector between two points halfway through a plan, by the lengths at both ends. Along it, the
/// displacement between the points is the change of the length (O. Gonzalez, "Time integration and
/// discrete Hamiltonian systems", Journal of Nonlinear Science 6 (1996)). Its length is almost 1.
Vector3d mean_direction(const Vector3d& now, const Vector3d& end) {
  const Vector3d sum = now + end;
  const double lengths = now.norm() + end.norm();
  if (sum.norm() > 0.5 * lengths) {
    return sum / lengths;
  }
  return now.norm() > 0.0 ? Vector3d(now.normalized()) : Vector3d(Vector3d::UnitZ());
}

/// Three axes for a spring of no length. The first one is along the line between its points, as its
/// damper acts along that line alone.
std::vector<TieDirection> axes_of_line(const Vector3d& now, const Vector3d& end) {
  const Vector3d sum = now.dot(end) >= 0.0 ? Vector3d(now + end) : Vector3d(end - now);
  const Vector3d along =
      sum.norm() > 0.0 ? Vector3d(sum.normalized()) : Vector3d(Vector3d::UnitX());
  Eigen::Index least = 0;
  now.cwiseAbs().minCoeff(&least);
  Vector3d across = along.cross(Vector3d::Unit(least));
  if (!(across.norm() > 0.1)) {
    across = along.unitOrthogonal();
  }
  across.normalize();
  return {{.linear = along}, {.linear = across}, {.linear = along.cross(across)}};
}

/// [m]  Computes the path along a row by displacements of robots.
double way_along(const TieRow& row, const ContactProblem& problem,
                 const std::vector<VectorXd>& of_robots) {
  double way = 0.0;
  for (const TieSide& side : row.sides) {
    const auto& link = problem.bodies[side.body].link;
    if (link && !of_robots.empty()) {
      way += side.row.dot(link->J * of_robots[link->mechanism]);
    }
  }
  return way;
}

}  // namespace

PlanTies::PlanTies(IslandState& state, double span) : state_(state), span_(span) {
  for (const std::size_t t : state.ties) {
    const SimTie& tie = state.model.ties[t];
    Acting acting{.tie = &tie, .index = t, .now = place_now(state, tie)};
    if (tie.is_inextensible() && state.taut <= kMostTautEvents &&
        !is_taut(state, tie, acting.now)) {
      continue;
    }
    for (std::size_t s = 0; s < 2; ++s) {
      acting.centres_now[s] = Vector3d::Zero();
      if (tie.ends[s].body) {
        const std::size_t b = *tie.ends[s].body;
        acting.centres_now[s] = centre_of_mass(state.model.bodies[b].inertia, state.tied_pose(b));
      }
    }
    const bool is_line = !tie.is_joint() && !tie.is_vector();
    acting.predicted.assign(is_line ? 1 : directions_of(tie, acting.now).size(), 0.0);
    acting.lever = lever_of(acting);
    acting_.push_back(std::move(acting));
  }
  find_link_forces();
  find_redundant_rows();
}

void PlanTies::find_redundant_rows() {
  if (!may_be_redundant(state_)) {
    return;
  }
  ProblemBodies bodies = state_.problem_bodies();
  add_tied_bodies(state_, bodies);
  const std::vector<bool> redundant = redundant_rows(state_, bodies);
  auto next = redundant.begin();
  for (Acting& acting : acting_) {
    if (acting.tie->is_joint()) {
      const auto end = next + static_cast<std::ptrdiff_t>(acting.predicted.size());
      acting.is_redundant.assign(next, end);
      next = end;
    }
  }
}

bool PlanTies::Acting::is_out(std::size_t direction) const {
  return direction < is_redundant.size() && is_redundant[direction];
}

/// Finds the end of a joint whose body an impulse turns most; none without a free body.
std::optional<std::size_t> PlanTies::lever_of(const Acting& acting) const {
  std::optional<std::size_t> lever;
  double most = 0.0;  // [1/kg]
  for (std::size_t s = 0; s < 2 && acting.tie->is_joint(); ++s) {
    const std::optional<std::size_t>& b = acting.tie->ends[s].body;
    if (!b || !state_.place.contains(*b) || state_.model.bodies[*b].link_body) {
      continue;
    }
    const Inertia& inertia = state_.model.bodies[*b].inertia;
    const Vector3d arm = acting.now.X_WT[s].position - acting.centres_now[s];
    const double response = 3.0 * arm.squaredNorm() / inertia.about_C_B.trace();
    if (response > most) {
      most = response;
      lever = s;
    }
  }
  return lever;
}

void PlanTies::find_link_forces() {
  for (std::size_t k = 0; k < state_.size() && !state_.robots.empty(); ++k) {
    const SimBody& body = state_.member(k);
    if (body.link_body && !body.forces.empty()) {
      const MeanForce mean = mean_force(body, state_.start.time + state_.reached, span_);
      link_forces_.push_back({k, mean.force, mean.torque});
    }
  }
}

Pose PlanTies::pose_at_end(std::size_t body, const IslandFlight& flight) const {
  const auto member = state_.place.find(body);
  if (member == state_.place.end()) {
    return scripted_pose(state_.model, state_.start, body,
                         (state_.reached + span_) / state_.start.h);
  }
  const std::size_t k = member->second;
  return state_.member(k).link_body
             ? flight.robots[state_.robots.robot_of(k)].X_WB[state_.robots.link_of(k)]
             : motion_of(state_.member(k), state_.states[k].X_WB, flight.moves[k]).pose(1.0);
}

void PlanTies::follow(Acting& acting, const IslandFlight& flight) const {
  acting.end = place_of(*acting.tie, [&](std::size_t b) { return pose_at_end(b, flight); });
  for (std::size_t s = 0; s < 2; ++s) {
    acting.centres_end[s] = Vector3d::Zero();
    if (const std::optional<std::size_t>& body = acting.tie->ends[s].body) {
      acting.centres_end[s] =
          centre_of_mass(state_.model.bodies[*body].inertia, pose_at_end(*body, flight));
    }
  }
}

/// Turns the three directions of a joint's force with its lever's body. So an impulse along a long
/// arm stays along it during the search for flights, in which arms point elsewhere.
void PlanTies::turn_with_lever(Acting& acting) const {
  if (!acting.lever) {
    return;
  }
  const Eigen::Quaterniond now = acting.now.X_WT[*acting.lever].rotation.normalized();
  const Eigen::Quaterniond turn =
      acting.end.X_WT[*acting.lever].rotation.normalized() * now.conjugate();
  acting.turn = nearest_turn(turn, Vector3d::Zero());
  const Eigen::Quaterniond half = Eigen::Quaterniond::Identity().slerp(0.5, turn);
  for (std::size_t k = 0; k < 3; ++k) {
    acting.halfway[k].linear = half * acting.halfway[k].linear;
    acting.changing[k].linear = turn * acting.changing[k].linear;
  }
}

void PlanTies::set_directions(Acting& acting) const {
  const SimTie& tie = *acting.tie;
  for (std::size_t s = 0; s < 2; ++s) {
    acting.at[s] = 0.5 * (acting.now.X_WT[s].position + acting.end.X_WT[s].position);
    acting.where[s] = acting.at[s];
  }
  if (tie.is_joint()) {
    acting.halfway = directions_of(tie, acting.now);
    acting.changing = directions_of(tie, acting.end);
    turn_with_lever(acting);
    for (std::size_t k = 0; k < acting.halfway.size(); ++k) {
      TieDirection& halfway = acting.halfway[k];
      halfway.angular = 0.5 * (halfway.angular + acting.changing[k].angular);
    }
    const auto point = [&](const TiePlace& place) -> Vector3d {
      return acting.lever ? place.X_WT[*acting.lever].position : place.middle();
    };
    acting.at.fill(0.5 * (point(acting.now) + point(acting.end)));
    acting.where.fill(point(acting.end));
    return;
  }
  if (tie.is_vector()) {
    acting.halfway = axes_of_line(acting.now.between(), acting.end.between());
    acting.changing = acting.halfway;
    return;
  }
  const Vector3d along = mean_direction(acting.now.between(), acting.end.between());
  acting.halfway = {{.linear = tie.is_inextensible() ? Vector3d(along.normalized()) : along}};
  acting.changing = acting.halfway;
  if (tie.is_inextensible()) {
    acting.changing[0].linear = acting.end.between().normalized();
    acting.where = {acting.end.X_WT[0].position, acting.end.X_WT[1].position};
  }
}

std::array<TiedSide, 2> PlanTies::sides_of(const Acting& acting, const ProblemBodies& now,
                                           const IslandFlight& flight) const {
  std::array<TiedSide, 2> sides;
  const bool is_at_end = acting.tie->is_joint() || acting.tie->is_inextensible();
  for (std::size_t s = 0; s < 2; ++s) {
    sides[s].point = acting.where[s];
    sides[s].centre = is_at_end ? acting.centres_end[s]
                                : Vector3d(0.5 * (acting.centres_now[s] + acting.centres_end[s]));
    const std::optional<std::size_t>& body = acting.tie->ends[s].body;
    if (!body) {
      continue;
    }
    sides[s].place = now.place(*body);
    const std::size_t k = *sides[s].place;
    if (k < state_.size() && !state_.member(k).link_body && !flight.spins[k]) {
      sides[s].inertia = &state_.member(k).inertia;
      sides[s].turned = flight.moves[k].rotation_vector;
    }
  }
  return sides;
}

bool PlanTies::is_led_by_end(const Acting& acting, const ProblemBodies& now,
                             const std::vector<bool>& by_end) const {
  return std::ranges::any_of(acting.tie->ends, [&](const TieEnd& end) {
    return end.body && now.place(*end.body) < by_end.size() && by_end[now.place(*end.body)];
  });
}

void PlanTies::lay(const ProblemBodies& now, const IslandFlight& flight, ContactProblem& problem) {
  shifts_of_robots_ = shifts_of_robots(problem);
  problem.ties.clear();
  for (Acting& acting : acting_) {
    follow(acting, flight);
    set_directions(acting);
    acting.by_end = is_led_by_end(acting, now, flight.by_end);
    acting.first_row = problem.ties.size();
    add_rows(acting, now, flight, problem);
  }
  take_changes(now, flight.at_end);
}

void PlanTies::add_rows(Acting& acting, const ProblemBodies& now, const IslandFlight& flight,
                        ContactProblem& problem) const {
  const SimTie& tie = *acting.tie;
  const std::array<TiedSide, 2> sides = sides_of(acting, now, flight);
  acting.springs.clear();
  for (std::size_t k = 0; k < acting.changing.size(); ++k) {
    problem.ties.push_back(row_along(acting.changing[k], sides));
    if (acting.is_out(k)) {
      take_out(problem.ties.back());
    } else if (tie.is_inextensible()) {
      TieRow& row = problem.ties.back();
      row.target = std::max(0.0, tie.length - acting.now.between().norm()) / span_;
      row.greatest = -acting.predicted[0];
    } else if (!tie.is_joint()) {
      add_spring(acting, k, now, sides, flight.at_end, problem);
    }
  }
}

/// Gives the last row the numbers of a spring.
void PlanTies::add_spring(Acting& acting, std::size_t k, const ProblemBodies& now,
                          const std::array<TiedSide, 2>& sides,
                          const std::vector<ContactBody>& flown, ContactProblem& problem) const {
  SimTie tie = *acting.tie;
  tie.damping = k == 0 ? tie.damping : 0.0;  // It acts along the line.
  TieRow& row = problem.ties.back();
  if (tie.stiffness == 0.0 && tie.damping == 0.0) {
    take_out(row);
    return;
  }
  std::array<TiedSide, 2> as_they_are = sides;
  for (TiedSide& side : as_they_are) {
    side.inertia = nullptr;
  }
  const auto extension = [&](const TiePlace& place) {
    return tie.is_vector() ? place.between().dot(acting.changing[k].linear)
                           : place.between().norm() - tie.length;
  };
  SpringWay way;
  way.begin = extension(acting.now);
  way.flight = extension(acting.end) + way_along(row, problem, shifts_of_robots_);
  const TieRow at_begin = row_along(acting.changing[k], as_they_are);
  way.speed_at_begin = speed_along(at_begin, now.bodies());
  way.speed_of_flight = speed_along(row, flown);
  way.is_led_by_end = acting.by_end;
  way.inverse_mass = inverse_mass_between(row, row, problem);
  const bool is_cable = tie.type == TieType::cable;
  if (is_cable && way.begin < 0.0) {
    if (way.flight <= 0.0) {  // Slack: no force acts.
      row.least = -acting.predicted[k];
      row.greatest = -acting.predicted[k];
      return;
    }
    way.begin = 0.0;
    way.speed_at_begin = 0.0;
  }
  const SpringRow law = spring_row(tie, way, span_);
  acting.springs.push_back({at_begin, row, law.weight, way.inverse_mass});
  row.compliance = law.compliance;
  row.target = law.target - law.compliance * acting.predicted[k];
  if (is_cable) {
    row.greatest = -acting.predicted[k];
  }
}

void PlanTies::take_changes(const ProblemBodies& now, const std::vector<ContactBody>& at_end) {
  for (Acting& acting : acting_) {
    for (SpringInPlan& spring : acting.springs) {
      const double change =
          speed_along(spring.at_end, at_end) - speed_along(spring.at_begin, now.bodies());
      spring.lead = (spring.weight - 0.5) * span_ * change / spring.inverse_mass;
    }
  }
}

}  // namespace firstcontact::detail
