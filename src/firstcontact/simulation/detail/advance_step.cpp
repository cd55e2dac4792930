#include <firstcontact/simulation/detail/advance_step.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include <firstcontact/island/detail/island.h>
#include <firstcontact/record/detail/joined_steps.h>
#include <firstcontact/scene/simulation.h>
#include <firstcontact/simulation/detail/island_threads.h>
#include <firstcontact/simulation/detail/islands.h>
#include <firstcontact/simulation/detail/record_step.h>
#include <firstcontact/simulation/detail/simulation_state.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/manifold.h>
#include <firstcontact/simulation_model/detail/script.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>

namespace firstcontact::detail {
namespace {

/// A part of a step in which scripts are straight, or a part of such.
struct Part {
  double length = 0.0;  // [s]
  bool is_whole = true;
  bool is_rest = false;  // Whether it follows a part that ended where scripts begin to crush.

  [[nodiscard]] bool can_end_at(double time) const {
    return is_whole && time > kLeastBeforeWait * length && time < length;
  }
  [[nodiscard]] Part rest(double whole) const {
    return {is_rest ? 0.0 : whole - length, false, true};
  }
};

class StepAdvance {
 public:
  StepAdvance(const SimulationModel& model, const Script& script, const Simulation& settings,
              IslandThreads& threads, const std::stop_token& stop, SimulationState& state)
      : model_(model),
        script_(script),
        may_wait_(settings.jams == JamRule::wait),
        left_(settings.step),
        threads_(threads),
        stop_(stop),
        state_(state),
        waits_(state.states.size(), false) {}

  std::optional<RunStep> run() {
    script_.return_to(state_.states, state_.time, state_.behind);
    for (const double length : script_.parts(state_.time, state_.behind)) {
      for (Part part{.length = length}; part.length > 0.0; part = part.rest(length)) {
        if (!add(part)) {
          return std::nullopt;
        }
        if (whole_->time_lost > 0.0) {
          whole_->time_lost += std::max(0.0, left_);
          return finished();
        }
      }
    }
    return finished();
  }

 private:
  /// Adds a part. Returns false if it was stopped.
  bool add(Part& part) {
    std::optional<RunStep> done = advance(part);
    if (!done) {
      return false;
    }
    left_ -= part.length;
    whole_ = whole_ ? joined(std::move(*whole_), std::move(*done)) : std::move(done);
    return true;
  }

  std::optional<RunStep> finished() {
    state_.count = whole_->index;
    state_.contacts = whole_->contacts;
    state_.contacts_lasted = whole_->lasted;
    state_.ties = whole_->ties;
    state_.is_stuck = is_lost(*whole_);
    return std::move(whole_);
  }

  /// Advances a part until nothing is crushed that could be spared.
  std::optional<RunStep> advance(Part& part) {
    StepStart start{.time = state_.time,
                    .states = state_.states,
                    .robots = state_.robots,
                    .rests = state_.rests,
                    .waited = waited(part.is_rest),
                    .begins_step = !whole_};
    for (;;) {
      start.h = part.length;
      start.waits = waits_;
      start.scripted = script_.moves(state_.states, state_.time, start.h, state_.behind, waits_);
      std::optional<std::vector<IslandTrack>> tracks =
          advance_islands(model_, start, guesses(), threads_, stop_);
      if (!tracks) {
        return std::nullopt;
      }
      if (!may_wait_ || !spare(*tracks, start, part)) {
        return record_step(model_, start, *tracks, state_);
      }
    }
  }

  /// Shortens a part, or lets bodies wait in it, where they would crush something.
  ///
  /// It returns whether there was any.
  bool spare(const std::vector<IslandTrack>& tracks, const StepStart& start, Part& part) {
    std::vector<std::size_t> crushing;
    double crushed = start.h;  // [s]  Until then nothing is crushed.
    for (const IslandTrack& track : tracks) {
      if (!track.crushing.empty()) {
        std::ranges::copy(track.crushing, std::back_inserter(crushing));
        crushed = std::min(crushed, track.crushed);
      }
    }
    if (part.can_end_at(crushed)) {
      part = {.length = crushed, .is_whole = false};
      return true;
    }
    return script_.wait(crushing, start.scripted, waits_);
  }

  /// Whether the script of each body stood still at the end of the step before.
  ///
  /// @param all  whether they stand still now
  [[nodiscard]] std::vector<bool> waited(bool all) const {
    std::vector<bool> waited;
    for (std::size_t b = 0; b < state_.states.size(); ++b) {
      const RigidState& state = state_.states[b];
      const bool stands = state_.behind[b] > 0.0 && !state.v_WC.any() && !state.w_WB.any();
      waited.push_back(stands || all || state_.is_stuck);
    }
    return waited;
  }

  /// The manifold points of the step before, as its record has them, so that resumed runs go on
  /// alike.
  [[nodiscard]] std::vector<ManifoldPoint> guesses() const {
    const auto surface = [this](std::size_t body, const Feature& feature) {
      return model_.neighbours[body]->surface_index(feature);
    };
    std::vector<ManifoldPoint> touches;
    touches.reserve(state_.contacts.size());
    for (const RunContact& contact : state_.contacts) {
      touches.push_back({.bodies = contact.bodies,
                         .feature_A = contact.feature_A,
                         .feature_B = contact.feature_B,
                         .surface = {surface(contact.bodies[0], contact.feature_A),
                                     surface(contact.bodies[1], contact.feature_B)},
                         .point = contact.point,
                         .normal = contact.normal,
                         .impulse = contact.impulse});
    }
    return touches;
  }

  const SimulationModel& model_;
  const Script& script_;
  bool may_wait_;
  double left_;  // [s]  Time left of the step.
  IslandThreads& threads_;
  const std::stop_token& stop_;
  SimulationState& state_;
  std::vector<bool> waits_;  // For each body whether it waits in the rest of the step.
  std::optional<RunStep> whole_ = {};
};

}  // namespace

std::optional<RunStep> advance_step(const SimulationModel& model, const Script& script,
                                    const Simulation& settings, IslandThreads& threads,
                                    const std::stop_token& stop, SimulationState& state) {
  return StepAdvance(model, script, settings, threads, stop, state).run();
}

bool is_lost(const RunStep& step) { return step.lasted < kLostOfStep * step.time_lost; }

}  // namespace firstcontact::detail
