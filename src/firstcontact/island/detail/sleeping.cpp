#include <firstcontact/island/detail/sleeping.h>

#include <algorithm>
#include <utility>

#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/island_response.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/island_ties.h>
#include <firstcontact/scene/simulation.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/obstacles.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>

namespace firstcontact::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// [m/s]  Bounds the speed of any point of the body.
double greatest_speed(const SimBody& body, const Vector3d& v, const Vector3d& w) {
  return v.norm() + body.reach * w.norm();
}

/// Whether contacts press each member, or ties hold it.
bool are_all_held(const IslandState& state, const std::vector<ManifoldPoint>& touches) {
  std::vector<bool> is_held(state.size(), false);
  for (std::size_t k = 0; k < state.size() && !state.ties.empty(); ++k) {
    is_held[k] = !state.model.ties_of[state.members[k]].empty();
  }
  for (const ManifoldPoint& touch : touches) {
    for (const std::size_t b : touch.bodies) {
      const auto member = state.place.find(b);
      if (member != state.place.end() && !touch.impulse.isZero(0.0)) {
        is_held[member->second] = true;
      }
    }
  }
  return std::ranges::all_of(is_held, [](bool held) { return held; });
}

/// Whether a force begins or ends between the begin of the step before and the end of this one.
bool changes(const TimedForce& force, const StepStart& start) {
  const auto is_within = [&](double time) {
    return time > start.time - start.h && time < start.time + start.h;
  };
  return is_within(force.from) || is_within(force.to);
}

/// Whether any scripted body that moves in the step may get near the body.
bool is_disturbed(const SimulationModel& model, const StepStart& start, const Obstacles& around,
                  std::size_t body) {
  const double reach = model.distances.near + model.laws.greatest_margin();
  const AlignedBox3d box =
      widened(swept_box(model.bodies[body], start.states[body].X_WB, {}), reach);
  bool found = false;
  around.for_each_overlap(box,
                          [&](std::size_t b) { found = found || !start.scripted[b].is_none(); });
  return found;
}

}  // namespace

bool falls_asleep(const IslandState& state, const Plan& plan,
                  const std::vector<ManifoldPoint>& touches) {
  const double seeming = (state.ties.empty() ? 1.0 : kRestOfTied) *
                         std::min(kRestOfExactTolerance * exact_tolerance(state),
                                  kRestOfGravity * state.model.gravity.norm() * state.start.h);
  // A sleeping body bears in all steps the load of this one, which has to be its weight alone.
  if (!state.start.begins_step || is_pulled(state.model, state.start, state.members) ||
      !state.robots.empty() || state.is_too_near() || !(plan.residual <= seeming)) {
    return false;
  }
  for (std::size_t k = 0; k < state.size(); ++k) {
    const SimBody& body = state.member(k);
    const RigidState& begin = state.start.states[state.members[k]];
    if (!(greatest_speed(body, begin.v_WC, begin.w_WB) <= seeming) ||
        !(greatest_speed(body, plan.at_end[k].v, plan.at_end[k].w) <= seeming) ||
        is_disturbed(state.model, state.start, state.around, state.members[k])) {
      return false;
    }
  }
  return are_all_held(state, touches);
}

bool stays_asleep(const StepContext& step, const std::vector<std::size_t>& members) {
  return !is_pulled(step.model, step.start, members) &&
         std::ranges::all_of(members, [&](std::size_t b) {
           return step.start.rests[b] &&
                  std::ranges::none_of(
                      step.model.bodies[b].forces,
                      [&](const auto& force) { return changes(force, step.start); }) &&
                  !is_disturbed(step.model, step.start, step.around, b);
         });
}

IslandTrack track_asleep(const StepContext& step, std::vector<std::size_t> members) {
  IslandTrack track;
  track.members = std::move(members);
  for (const std::size_t b : track.members) {
    const RigidState& state = step.start.states[b];
    track.pieces.push_back({{step.start.h, state.X_WB, {}, state, state}});
  }
  track.reached = step.start.h;
  // Pairs that fall asleep are not too near, and are held to half of their gap at least.
  track.clearance = 0.5 * step.model.distances.pushed;
  track.rests = Rest::goes_on;
  return track;
}

}  // namespace firstcontact::detail
