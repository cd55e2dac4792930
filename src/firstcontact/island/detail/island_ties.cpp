#include <firstcontact/island/detail/island_ties.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/Geometry>

#include <firstcontact/contact_solver/detail/tie_rows.h>
#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/island_response.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/math/disjoint_sets.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/response.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// The ends at the present places of bodies. Impulses of joints act in the middle of their two
/// points.
std::array<TiedSide, 2> sides_now(const SimTie& tie, const TiePlace& place,
                                  const ProblemBodies& bodies) {
  std::array<TiedSide, 2> sides;
  for (std::size_t s = 0; s < 2; ++s) {
    if (tie.ends[s].body) {
      sides[s].place = bodies.place(*tie.ends[s].body);
      sides[s].centre = bodies.centre(*sides[s].place);
    }
    sides[s].point = tie.is_joint() ? place.middle() : place.X_WT[s].position;
  }
  return sides;
}

/// Adds the rows of a joint at the present places of its bodies.
void add_joint_now(IslandState& state, const SimTie& tie, const ProblemBodies& bodies,
                   std::vector<TieRow>& rows) {
  const TiePlace place = place_now(state, tie);
  const std::array<TiedSide, 2> sides = sides_now(tie, place, bodies);
  for (const TieDirection& direction : directions_of(tie, place)) {
    rows.push_back(row_along(direction, sides));
  }
}

/// Finds the place of a tie, a share of a plan ahead.
TiePlace place_ahead(IslandState& state, const SimTie& tie, const Plan& plan, double span,
                     double share) {
  return place_of(tie, [&](std::size_t body) {
    const auto member = state.place.find(body);
    if (member == state.place.end()) {
      return scripted_pose(state.model, state.start, body,
                           (state.reached + share * span) / state.start.h);
    }
    const std::size_t k = member->second;
    if (state.member(k).link_body) {  // Its piece of the run is a chord of the path by its joints.
      return state.robots.pose_ahead(k, plan.robots, share);
    }
    return motion_of(state.member(k), state.states[k].X_WB, plan.moves[k]).pose(share);
  });
}

/// [m]  The length of a cable, a share of a plan ahead.
double length_at(IslandState& state, const SimTie& tie, const Plan& plan, double span,
                 double share) {
  return place_ahead(state, tie, plan, span, share).between().norm();
}

/// [m]  The distance by which a joint is apart, or a cable beyond its length. Angles between the
/// sides of a joint count by the reach of its bodies.
double torn_at(const IslandState& state, const SimTie& tie, const TiePlace& place) {
  if (tie.is_inextensible()) {
    return place.between().norm() - tie.length;
  }
  if (!tie.is_joint()) {
    return 0.0;
  }
  double reach = 0.0;
  for (const TieEnd& end : tie.ends) {
    reach = std::max(reach, end.body ? state.model.bodies[*end.body].reach : 0.0);
  }
  const std::vector<double> off = displacements_of(tie, place);
  double most = 0.0;
  for (std::size_t k = 0; k < off.size(); ++k) {
    most = std::max(most, (k < 3 ? 1.0 : reach) * std::abs(off[k]));
  }
  return most;
}

}  // namespace

TieRow row_along(const TieDirection& direction, const std::array<TiedSide, 2>& sides) {
  TieRow row;
  for (std::size_t s = 0; s < 2; ++s) {
    const TiedSide& side = sides[s];
    if (!side.place) {
      continue;
    }
    const double sign = s == 0 ? -1.0 : 1.0;
    Vector3d angular =
        sign * ((side.point - side.centre).cross(direction.linear) + direction.angular);
    if (side.inertia != nullptr) {
      angular = turned_along(*side.inertia, angular, -side.turned);
    }
    TieSide made{.body = *side.place};
    made.row << sign * direction.linear, angular;
    row.sides.push_back(made);
  }
  return row;
}

double speed_along(const TieRow& row, const std::vector<ContactBody>& bodies) {
  double u = 0.0;
  for (const TieSide& side : row.sides) {
    u += side.row.head<3>().dot(bodies[side.body].v) + side.row.tail<3>().dot(bodies[side.body].w);
  }
  return u;
}

bool may_be_redundant(const IslandState& state) {
  DisjointSets sets(state.size() + 1);
  for (const std::size_t t : state.ties) {
    const SimTie& tie = state.model.ties[t];
    std::array<std::uint32_t, 2> ends{};
    for (std::size_t s = 0; s < 2; ++s) {
      const std::optional<std::size_t>& body = tie.ends[s].body;
      const bool is_free =
          body && moves_freely(state.model.bodies[*body]) && state.place.contains(*body);
      ends[s] =
          sets.root(static_cast<std::uint32_t>(is_free ? state.place.at(*body) : state.size()));
    }
    if (tie.is_joint() && ends[0] == ends[1]) {
      return true;
    }
    if (tie.is_joint()) {
      sets.join(ends[0], ends[1]);
    }
  }
  return false;
}

std::vector<bool> redundant_rows(IslandState& state, const ProblemBodies& bodies) {
  ContactProblem problem{.bodies = bodies.bodies()};
  for (const std::size_t t : state.ties) {
    if (state.model.ties[t].is_joint()) {
      add_joint_now(state, state.model.ties[t], bodies, problem.ties);
    }
  }
  if (!may_be_redundant(state)) {
    return std::vector<bool>(problem.ties.size(), false);
  }
  state.robots.add_mechanisms(problem);
  return find_redundant(problem);
}

bool is_taut(const IslandState& state, const SimTie& tie, const TiePlace& place) {
  return place.between().norm() >= tie.length - kTautOfDistance * state.model.distances.least;
}

TiePlace place_now(IslandState& state, const SimTie& tie) {
  return place_of(tie, [&](std::size_t body) { return state.tied_pose(body); });
}

void add_tied_bodies(IslandState& state, ProblemBodies& bodies) {
  for (const std::size_t t : state.ties) {
    for (const TieEnd& end : state.model.ties[t].ends) {
      if (end.body) {
        state.add_others({*end.body, *end.body}, bodies);
      }
    }
  }
}

std::vector<TieRow> rigid_rows(IslandState& state, const ProblemBodies& bodies) {
  const std::vector<bool> redundant = redundant_rows(state, bodies);
  std::vector<TieRow> rows;
  std::size_t next = 0;  // Index among the rows of joints.
  for (const std::size_t t : state.ties) {
    const SimTie& tie = state.model.ties[t];
    if (tie.is_joint()) {
      const std::size_t first = rows.size();
      add_joint_now(state, tie, bodies, rows);
      for (std::size_t k = first; k < rows.size(); ++k) {
        if (redundant[next++]) {
          take_out(rows[k]);
        }
      }
      continue;
    }
    const TiePlace place = place_now(state, tie);
    if (tie.is_inextensible() && is_taut(state, tie, place)) {
      rows.push_back(
          row_along({.linear = place.between().normalized()}, sides_now(tie, place, bodies)));
      rows.back().greatest = 0.0;
    }
  }
  return rows;
}

void add_outer_of_ties(const ContactProblem& problem, const ContactSolution& solution,
                       const ProblemBodies& bodies, std::vector<OuterImpulse>& outer) {
  for (std::size_t k = 0; k < problem.ties.size() && !outer.empty(); ++k) {
    const std::vector<TieSide>& sides = problem.ties[k].sides;
    const auto robot_of = [&](const TieSide& side) {
      const auto& link = problem.bodies[side.body].link;
      return link ? std::optional(link->mechanism) : std::nullopt;
    };
    const bool is_inner =
        sides.size() == 2 && robot_of(sides[0]) && robot_of(sides[0]) == robot_of(sides[1]);
    for (const TieSide& side : sides) {
      if (is_inner || !robot_of(side) || solution.ties[k] == 0.0) {
        continue;
      }
      OuterImpulse& sum = outer[*robot_of(side)];
      const Vector3d linear = solution.ties[k] * side.row.head<3>();
      sum.linear += linear;
      sum.angular += bodies.centre(side.body).cross(linear) + solution.ties[k] * side.row.tail<3>();
      sum.acts = true;
    }
  }
}

bool any_tie_is_hit(IslandState& state) {
  if (state.ties.empty()) {
    return false;
  }
  ProblemBodies bodies = state.problem_bodies();
  add_tied_bodies(state, bodies);
  const double slow = std::max(slowest_bounce(state), 100.0 * kLeastTolerance);
  return std::ranges::any_of(rigid_rows(state, bodies), [&](const TieRow& row) {
    const double u = speed_along(row, bodies.bodies());
    return u > slow || (row.greatest > 0.0 && u < -slow);
  });
}

double share_within_cables(IslandState& state, const Plan& plan, double span) {
  constexpr int kHalvings = 60;
  double share = 1.0;
  for (const std::size_t t : state.ties) {
    const SimTie& tie = state.model.ties[t];
    if (!tie.is_inextensible() || is_taut(state, tie, place_now(state, tie)) ||
        !(length_at(state, tie, plan, span, share) > tie.length)) {
      continue;
    }
    double low = 0.0;
    double high = share;
    for (int k = 0; k < kHalvings && low < high; ++k) {
      const double middle = 0.5 * (low + high);
      (length_at(state, tie, plan, span, middle) <= tie.length ? low : high) = middle;
    }
    share = low;
  }
  return share;
}

bool tears_ties(IslandState& state, const Plan& plan, double span) {
  return std::ranges::any_of(state.ties, [&](std::size_t t) {
    const SimTie& tie = state.model.ties[t];
    const TiePlace place = place_now(state, tie);
    if (tie.is_inextensible() && state.taut <= kMostTautEvents && !is_taut(state, tie, place)) {
      return false;  // The plan is followed until the cable is taut.
    }
    const double now = torn_at(state, tie, place);
    const double most = std::max(state.model.distances.least, now);
    return torn_at(state, tie, place_ahead(state, tie, plan, span, 1.0)) > most;
  });
}

bool is_pulled(const SimulationModel& model, const StepStart& start,
               const std::vector<std::size_t>& members) {
  if (model.ties.empty()) {
    return false;
  }
  const auto moves = [&](const TieEnd& end) {
    return end.body && !start.scripted[*end.body].is_none();
  };
  return std::ranges::any_of(members, [&](std::size_t member) {
    return std::ranges::any_of(model.ties_of[member], [&](std::size_t t) {
      return std::ranges::any_of(model.ties[t].ends, moves);
    });
  });
}

}  // namespace firstcontact::detail
