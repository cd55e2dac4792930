// Displacements without velocity that bring joints of ties together where a plan ends.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <firstcontact/contact_solver/detail/tie_rows.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/island_ties.h>
#include <firstcontact/island/detail/plan_ties.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/response.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [-]  The least part of a spring's response across joints with which displacements hold it. With
/// less joints hold it, up to rounding.
constexpr double kLeastHeld = 1e-6;

}  // namespace

Pose PlanTies::pose_at(std::size_t body, const std::vector<Pose>& at_end) const {
  const auto member = state_.place.find(body);
  return member != state_.place.end() ? at_end[member->second]
                                      : scripted_pose(state_.model, state_.start, body,
                                                      (state_.reached + span_) / state_.start.h);
}

TiePlace PlanTies::place_at(const Acting& acting, const std::vector<Pose>& at_end) const {
  return place_of(*acting.tie, [&](std::size_t body) { return pose_at(body, at_end); });
}

std::array<TiedSide, 2> PlanTies::settled_sides(const Acting& acting, const TiePlace& place,
                                                const std::vector<Pose>& at_end,
                                                const ProblemBodies& now) const {
  std::array<TiedSide, 2> sides;
  for (std::size_t s = 0; s < 2; ++s) {
    sides[s].point = acting.tie->is_joint() ? place.middle() : place.X_WT[s].position;
    if (const std::optional<std::size_t>& body = acting.tie->ends[s].body) {
      sides[s].place = now.place(*body);
      sides[s].centre = centre_of_mass(state_.model.bodies[*body].inertia, pose_at(*body, at_end));
    }
  }
  return sides;
}

std::vector<PlanTies::LedSpring> PlanTies::led_springs(const std::vector<Pose>& at_end) const {
  std::vector<LedSpring> springs;
  for (std::size_t k = 0; k < acting_.size(); ++k) {
    const auto leads = [](const SpringInPlan& spring) { return spring.weight > 0.5; };
    if (acting_[k].tie->stiffness > 0.0 && std::ranges::any_of(acting_[k].springs, leads)) {
      springs.push_back({k, place_at(acting_[k], at_end).between()});
    }
  }
  std::ranges::stable_sort(springs, std::greater<>(), [&](const LedSpring& spring) {
    return acting_[spring.acting].tie->stiffness;
  });
  return springs;
}

double PlanTies::add_settling(const std::vector<Pose>& at_end, const std::vector<double>& changes,
                              const ProblemBodies& now, ContactProblem& problem) const {
  double farthest = 0.0;
  for (const Acting& acting : acting_) {
    const SimTie& tie = *acting.tie;
    if (!tie.is_joint() && !tie.is_inextensible()) {
      continue;
    }
    const TiePlace place = place_at(acting, at_end);
    const std::array<TiedSide, 2> sides = settled_sides(acting, place, at_end, now);
    if (tie.is_joint()) {
      const std::vector<TieDirection> directions = directions_of(tie, place);
      const std::vector<double> off = displacements_of(tie, place);
      for (std::size_t k = 0; k < directions.size(); ++k) {
        problem.ties.push_back(row_along(directions[k], sides));
        problem.ties.back().target = -off[k];
        if (acting.is_out(k)) {
          take_out(problem.ties.back());
        } else {
          farthest = std::max(farthest, std::abs(off[k]));
        }
      }
      continue;
    }
    const double over = place.between().norm() - tie.length;
    const bool pulls = acting.predicted[0] + changes[acting.first_row] < 0.0;
    problem.ties.push_back(row_along({.linear = place.between().normalized()}, sides));
    problem.ties.back().target = -over;
    if (!pulls) {
      problem.ties.back().greatest = 0.0;
    }
    farthest = std::max(farthest, pulls ? std::abs(over) : over);
  }
  return farthest;
}

double PlanTies::hold(const std::vector<LedSpring>& springs, const std::vector<Pose>& at_end,
                      const ProblemBodies& now, ContactProblem& problem) const {
  const std::size_t first = problem.ties.size();
  for (const LedSpring& spring : springs) {
    const Acting& acting = acting_[spring.acting];
    const TiePlace place = place_at(acting, at_end);
    const std::array<TiedSide, 2> sides = settled_sides(acting, place, at_end, now);
    const Vector3d between = place.between();
    const auto add = [&](const Vector3d& along, double wanted) {
      problem.ties.push_back(row_along({.linear = along}, sides));
      problem.ties.back().target = wanted;
    };
    if (acting.tie->is_vector()) {
      for (int k = 0; k < 3; ++k) {
        add(Vector3d::Unit(k), spring.between[k] - between[k]);
      }
    } else {
      add(between.normalized(), spring.between.norm() - between.norm());
    }
  }
  const std::vector<bool> redundant = find_redundant(problem, first, kLeastHeld);
  double farthest = 0.0;
  for (std::size_t k = first; k < problem.ties.size(); ++k) {
    if (redundant[k]) {
      take_out(problem.ties[k]);
    } else {
      farthest = std::max(farthest, std::abs(problem.ties[k].target));
    }
  }
  return farthest;
}

}  // namespace firstcontact::detail
