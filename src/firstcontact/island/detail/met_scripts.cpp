#include <firstcontact/island/detail/met_scripts.h>

#include <algorithm>
#include <optional>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/island_ties.h>
#include <firstcontact/simulation_model/detail/manifold.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [m]  The displacement of a point of a body by its script in the step; nothing where it does not
/// move.
std::optional<Vector3d> scripted_way(IslandState& state, std::size_t body, const Vector3d& point) {
  const Move& move = state.start.scripted[body];
  if (move.is_none()) {
    return std::nullopt;
  }
  const Vector3d arm =
      point - centre_of_mass(state.model.bodies[body].inertia, state.pose_of(body));
  return move.translation + move.rotation_vector.cross(arm);
}

}  // namespace

void MetScripts::add(const IslandState& state, std::size_t body, double closing, Ways& ways) {
  try_again_ = try_again_ || state.start.waited[body];
  double& most = ways.try_emplace(body, 0.0).first->second;
  most = std::max(most, closing);
}

void MetScripts::add(IslandState& state, const ManifoldPoint& touch, Ways& ways) {
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t body = touch.bodies[side];
    if (const std::optional<Vector3d> way = scripted_way(state, body, touch.point)) {
      add(state, body, (side == 0 ? 1.0 : -1.0) * touch.normal.dot(*way), ways);
    }
  }
}

void MetScripts::meet(IslandState& state, const ManifoldPoint& touch) { add(state, touch, met_); }

void MetScripts::meet_in_plan(IslandState& state, const ManifoldPoint& touch) {
  add(state, touch, in_plan_);
  add(state, touch, met_);
}

void MetScripts::meet_ties(IslandState& state) {
  for (const std::size_t t : state.ties) {
    const SimTie& tie = state.model.ties[t];
    const TiePlace place = place_now(state, tie);
    for (std::size_t s = 0; s < 2; ++s) {
      const std::optional<std::size_t>& body = tie.ends[s].body;
      const auto way = body ? scripted_way(state, *body, place.X_WT[s].position) : std::nullopt;
      if (way) {
        add(state, *body, way->norm(), met_);
      }
    }
  }
}

std::vector<std::size_t> MetScripts::crushing() const {
  for (const Ways* ways : {&in_plan_, &met_}) {
    double fastest = 0.0;  // [m]
    for (const auto& [body, closing] : *ways) {
      fastest = std::max(fastest, closing);
    }
    std::vector<std::size_t> found;
    for (const auto& [body, closing] : *ways) {
      if (closing > 0.5 * fastest) {
        found.push_back(body);
      }
    }
    if (!found.empty()) {
      return found;
    }
  }
  std::vector<std::size_t> all;
  for (const auto& [body, closing] : met_) {
    all.push_back(body);
  }
  return all;
}

}  // namespace firstcontact::detail
