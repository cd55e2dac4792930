// The impulses of ties over a plan: those in the flights, and those that a solution adds.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/plan_ties.h>
#include <firstcontact/simulation_model/detail/response.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// The impulses of a tie on its second body.
struct TieImpulse {
  Vector3d linear = Vector3d::Zero();
  Vector3d angular = Vector3d::Zero();
};

TieImpulse sum_of(const std::vector<TieDirection>& directions,
                  const std::vector<double>& impulses) {
  TieImpulse sum;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    sum.linear += impulses[k] * directions[k].linear;
    sum.angular += impulses[k] * directions[k].angular;
  }
  return sum;
}

}  // namespace

void PlanTies::add_to(std::size_t member, Vector3d& force, Vector3d& torque) const {
  for (const Acting& acting : acting_) {
    for (std::size_t s = 0; s < 2; ++s) {
      if (acting.halfway.empty() || acting.tie->ends[s].body != state_.members[member]) {
        continue;
      }
      const TieImpulse impulse = sum_of(acting.halfway, acting.predicted);
      const double sign = (s == 0 ? -1.0 : 1.0) / span_;
      force += sign * impulse.linear;
      torque += sign * (acting.arm_halfway(s).cross(impulse.linear) + impulse.angular);
    }
  }
}

LinkLoad PlanTies::load_of(const LinkForce& force, const RobotFlight& flight) const {
  const RigidState now = state_.robots.state(force.member);
  const Inertia& inertia = state_.member(force.member).inertia;
  const Vector3d from = centre_of_mass(inertia, now.X_WB);
  const Vector3d to =
      flight.is_known ? centre_of_mass(inertia, flight.X_WB[state_.robots.link_of(force.member)])
                      : Vector3d(from + span_ * now.v_WC);
  return {force.member, force.force, force.torque + (0.5 * (from + to)).cross(force.force)};
}

std::vector<VectorXd> PlanTies::loads(const std::vector<RobotFlight>& flights) const {
  if (state_.robots.empty() || empty()) {
    return {};
  }
  const RobotFlight unknown;
  const auto flight_of = [&](std::size_t r) -> const RobotFlight& {
    return r < flights.size() ? flights[r] : unknown;
  };
  std::vector<LinkLoad> on_links;
  for (const LinkForce& force : link_forces_) {
    on_links.push_back(load_of(force, flight_of(state_.robots.robot_of(force.member))));
  }
  for (const Acting& acting : acting_) {
    const TieImpulse impulse = sum_of(acting.halfway, acting.predicted);
    for (std::size_t s = 0; s < 2 && !acting.halfway.empty(); ++s) {
      const std::optional<std::size_t>& body = acting.tie->ends[s].body;
      if (body && state_.model.bodies[*body].link_body) {
        const double sign = (s == 0 ? -1.0 : 1.0) / span_;
        on_links.push_back({state_.place.at(*body), sign * impulse.linear,
                            sign * (acting.at[s].cross(impulse.linear) + impulse.angular)});
      }
    }
  }
  std::vector<VectorXd> forces;
  for (std::size_t r = 0; r < state_.robots.size(); ++r) {
    forces.push_back(state_.robots.forces_of(r, on_links, flight_of(r), span_));
  }
  return forces;
}

/// Forces of joints turn: over a span h the trapezoidal rule errs by h^2 / 12 times the change of
/// the acceleration. For an acceleration a that turns by a small phi the change is phi x a. Along a
/// spring bodies move by the weighted mean of velocities of its row.
Move PlanTies::shift(std::size_t member) const {
  TieImpulse way;  // Mass times displacement, and moment of inertia times turn.
  for (const Acting& acting : acting_) {
    for (std::size_t s = 0; s < 2 && !acting.halfway.empty(); ++s) {
      if (acting.tie->ends[s].body != state_.members[member]) {
        continue;
      }
      const double sign = s == 0 ? -1.0 : 1.0;
      // A weld keeps the angular momentum of tumbling bodies: forces and torques turn apart there.
      if (acting.lever && acting.tie->type != TieType::weld) {
        const Vector3d linear = sum_of(acting.halfway, acting.predicted).linear;
        way.linear -= span_ / 12.0 * sign * acting.turn.cross(linear);
      }
      for (std::size_t k = 0; k < acting.springs.size(); ++k) {
        const Vector3d led = sign * acting.springs[k].lead * acting.halfway[k].linear;
        way.linear += led;
        way.angular += acting.arm_halfway(s).cross(led);
      }
    }
  }
  if (state_.member(member).link_body) {
    return {};
  }
  const InverseInertia inverse =
      inverse_inertia(state_.member(member).inertia, state_.states[member].X_WB);
  return {inverse.mass.cwiseProduct(way.linear), inverse.rotation * way.angular};
}

std::vector<VectorXd> PlanTies::shifts_of_robots(const ContactProblem& problem) const {
  std::vector<VectorXd> shifts;
  for (const Acting& acting : acting_) {
    for (const SpringInPlan& spring : acting.springs) {
      for (const TieSide& side : spring.at_end.sides) {
        const auto& link = problem.bodies[side.body].link;
        if (!link || spring.lead == 0.0) {
          continue;
        }
        for (std::size_t r = shifts.size(); r < problem.mechanisms.size(); ++r) {
          shifts.emplace_back(VectorXd::Zero(problem.mechanisms[r].velocity.size()));
        }
        shifts[link->mechanism] += problem.mechanisms[link->mechanism].inverse_mass *
                                   (link->J.transpose() * (spring.lead * side.row));
      }
    }
  }
  return shifts;
}

std::vector<double> PlanTies::part_of(const Acting& acting,
                                      const std::vector<double>& changes) const {
  const auto first = changes.begin() + static_cast<std::ptrdiff_t>(acting.first_row);
  return {first, first + static_cast<std::ptrdiff_t>(acting.changing.size())};
}

double PlanTies::greatest_change(const std::vector<double>& changes) const {
  double most = 0.0;
  double greatest = 0.0;
  for (const Acting& acting : acting_) {
    for (std::size_t k = 0; k < acting.predicted.size(); ++k) {
      const double change = changes[acting.first_row + k];
      most = std::max(most, std::abs(change));
      greatest = std::max(greatest, std::abs(acting.predicted[k] + change));
    }
  }
  return most > 0.0 ? most / greatest : 0.0;
}

VectorXd PlanTies::predicted() const {
  std::vector<double> all;
  for (const Acting& acting : acting_) {
    all.insert(all.end(), acting.predicted.begin(), acting.predicted.end());
  }
  return VectorXd::Map(all.data(), static_cast<Eigen::Index>(all.size()));
}

void PlanTies::predict(const VectorXd& impulses) {
  for (Acting& acting : acting_) {
    for (std::size_t k = 0; k < acting.predicted.size(); ++k) {
      acting.predicted[k] = impulses[static_cast<Eigen::Index>(acting.first_row + k)];
    }
  }
}

void PlanTies::forget() {
  for (Acting& acting : acting_) {
    std::ranges::fill(acting.predicted, 0.0);
    acting.halfway.clear();  // The directions of other flights do not hold.
    acting.springs.clear();
  }
}

void PlanTies::add_outer(const Acting& acting, const std::vector<double>& impulses, bool predicted,
                         std::vector<OuterImpulse>& outer) const {
  const TieImpulse impulse = sum_of(predicted ? acting.halfway : acting.changing, impulses);
  std::array<std::optional<std::size_t>, 2> robots;
  for (std::size_t s = 0; s < 2; ++s) {
    const std::optional<std::size_t>& body = acting.tie->ends[s].body;
    if (body && state_.model.bodies[*body].link_body) {
      robots[s] = state_.robots.robot_of(state_.place.at(*body));
    }
  }
  const bool is_inner = robots[0] && robots[0] == robots[1];
  for (std::size_t s = 0; s < 2; ++s) {
    if (!robots[s]) {
      continue;
    }
    OuterImpulse& sum = outer[*robots[s]];
    sum.touches = true;
    if (!is_inner) {
      const double sign = s == 0 ? -1.0 : 1.0;
      const Vector3d& point = predicted ? acting.at[s] : acting.where[s];
      sum.linear += sign * impulse.linear;
      sum.angular += sign * (point.cross(impulse.linear) + impulse.angular);
      sum.acts = true;
    }
  }
}

void PlanTies::add_changes(const std::vector<double>& changes,
                           std::vector<OuterImpulse>& outer) const {
  for (const Acting& acting : acting_) {
    add_outer(acting, part_of(acting, changes), false, outer);
  }
}

void PlanTies::add_all(const std::vector<double>& changes, std::vector<OuterImpulse>& outer) const {
  add_changes(changes, outer);
  for (const LinkForce& force : link_forces_) {
    OuterImpulse& sum = outer[state_.robots.robot_of(force.member)];
    const Inertia& inertia = state_.member(force.member).inertia;
    const RigidState now = state_.robots.state(force.member);
    const Vector3d halfway = centre_of_mass(inertia, now.X_WB) + 0.5 * span_ * now.v_WC;
    sum.linear += span_ * force.force;
    sum.angular += span_ * (force.torque + halfway.cross(force.force));
    sum.acts = true;
  }
  for (const Acting& acting : acting_) {
    add_outer(acting, acting.predicted, true, outer);
  }
}

std::vector<TieTrackPiece> PlanTies::impulses(const std::vector<double>& changes) const {
  std::vector<TieTrackPiece> all;
  for (const Acting& acting : acting_) {
    const TieImpulse predicted = sum_of(acting.halfway, acting.predicted);
    const TieImpulse change = sum_of(acting.changing, part_of(acting, changes));
    all.push_back({.tie = acting.index,
                   .linear = predicted.linear + change.linear,
                   .angular = predicted.angular + change.angular});
  }
  return all;
}

}  // namespace firstcontact::detail
