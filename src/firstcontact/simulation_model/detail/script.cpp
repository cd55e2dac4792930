#include <firstcontact/simulation_model/detail/script.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include <firstcontact/math/number_text.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {

namespace {

/// [-]  Greatest distance of a script from a straight piece, by the contact distance.
constexpr double kBendOfDistance = 0.5;

/// [-]  Part of a step: a longer rest of it counts after the end of the scene.
constexpr double kLeastRest = 1e-9;

/// [-]  Part of the tolerance of scripts; a body that moves by less stands still.
constexpr double kLeastWay = 1e-6;

/// Samples of a step to find when a script came by, and steps of a search from there.
constexpr int kSamples = 32;
constexpr int kThirds = 24;

}  // namespace

Script::Script(const LinksAsBodies& linked, const SimulationModel& model)
    : loaded_(linked.loaded),
      tolerance_(kBendOfDistance * model.distances.least),
      step_(loaded_.scene.simulation->step) {
  const std::size_t first_link = model.bodies.size() - linked.geometries.size();
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const SimBody& body = model.bodies[b];
    if (body.kind == BodyKind::scripted) {
      bodies_.push_back(b);
      motions_.push_back({loaded_.bodies.motion(b), body.reach + body.inertia.p_BC.norm()});
      movers_.push_back(b < first_link ? b : first_link + linked.geometries[b - first_link].robot);
    }
  }
}

double Script::share(double time) const { return std::min(1.0, time / loaded_.scene.duration); }

std::vector<double> Script::parts(double time, const std::vector<double>& behind) const {
  std::map<double, std::vector<ScriptedMotion>> together;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    together[behind[bodies_[k]]].push_back(motions_[k]);
  }
  if (together.size() <= 1) {
    return together.empty() ? std::vector{step_}
                            : parts_of(together.begin()->second, time - together.begin()->first);
  }
  std::vector<double> ends;  // [s]  Since the step began.
  for (const auto& [seconds, motions] : together) {
    double end = 0.0;
    for (const double length : parts_of(motions, time - seconds)) {
      ends.push_back(end += length);
    }
  }
  std::ranges::sort(ends);
  std::vector<double> lengths;
  double begin = 0.0;
  for (const double end : ends) {
    if (end - begin > kLeastRest * step_ && step_ - end > kLeastRest * step_) {
      lengths.push_back(end - begin);
      begin = end;
    }
  }
  lengths.push_back(step_ - begin);
  return lengths;
}

/// The parts of a step for bodies with one clock.
std::vector<double> Script::parts_of(const std::vector<ScriptedMotion>& motions,
                                     double time) const {
  const double from = share(time);
  const double to = share(time + step_);
  if (!(from < to)) {
    return {step_};
  }
  const std::vector<double> ends = straight_parts(motions, from, to, tolerance_);
  if (ends.empty()) {
    throw std::invalid_argument("the scripted bodies move too wildly in the step at " +
                                detail::shortest(time) +
                                " s: they bend away from any of 10,000 straight pieces of it by "
                                "more than half the contact distance; choose a smaller step");
  }
  std::vector<double> lengths;
  double begin = time;
  for (const double end : ends) {
    lengths.push_back(end * loaded_.scene.duration - begin);
    begin = end * loaded_.scene.duration;
  }
  const double rest = time + step_ - begin;
  if (to == 1.0 && rest > kLeastRest * step_) {
    lengths.push_back(rest);
  } else if (lengths.size() == 1) {
    lengths.front() = step_;
  } else {
    lengths.back() += rest;
  }
  return lengths;
}

std::vector<Move> Script::moves(const std::vector<RigidState>& states, double time, double length,
                                const std::vector<double>& behind,
                                const std::vector<bool>& waits) const {
  std::vector<Move> moves(states.size());
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const std::size_t b = bodies_[k];
    if (waits[b]) {
      continue;
    }
    const double from = share(time - behind[b]);
    const double to = share(time - behind[b] + length);
    const Pose& X_WB = states[b].X_WB;
    const Motion& motion = motions_[k].motion;
    moves[b] = {motion.pose(to).position - X_WB.position,
                rotation_along(motion, from, to, X_WB.rotation)};
  }
  return moves;
}

bool Script::wait(const std::vector<std::size_t>& bodies, const std::vector<Move>& moves,
                  std::vector<bool>& waits) const {
  std::vector<std::size_t> waiting;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const Move& move = moves[bodies_[k]];
    const double way = move.translation.norm() + motions_[k].reach * move.rotation_vector.norm();
    if (way > kLeastWay * tolerance_ && std::ranges::find(bodies, bodies_[k]) != bodies.end()) {
      waiting.push_back(movers_[k]);
    }
  }
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const bool has_to = std::ranges::find(waiting, movers_[k]) != waiting.end();
    waits[bodies_[k]] = waits[bodies_[k]] || has_to;
  }
  return !waiting.empty();
}

void Script::return_to(const std::vector<RigidState>& states, double time,
                       std::vector<double>& behind) const {
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const auto here = movers_.begin() + static_cast<std::ptrdiff_t>(k);
    const bool is_first = std::find(movers_.begin(), here, movers_[k]) == here;
    if (!is_first || !(behind[bodies_[k]] > 0.0)) {
      continue;
    }
    const double stopped = time - behind[bodies_[k]];
    if (const std::optional<double> at = came_by(movers_[k], states, stopped, time)) {
      for (std::size_t other = k; other < bodies_.size(); ++other) {
        if (movers_[other] == movers_[k]) {
          behind[bodies_[other]] = time - *at;
        }
      }
    }
  }
}

/// [m]  Bound of the distance of a mover's points from their places in its script.
double Script::distance_at(std::size_t mover, const std::vector<RigidState>& states,
                           double time) const {
  double farthest = 0.0;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (movers_[k] == mover) {
      const Pose there = motions_[k].motion.pose(share(time));
      const Pose& X_WB = states[bodies_[k]].X_WB;
      farthest =
          std::max(farthest, (there.position - X_WB.position).norm() +
                                 motions_[k].reach * there.rotation.angularDistance(X_WB.rotation));
    }
  }
  return farthest;
}

/// [s]  The time in the last step at which the script last had a mover at its present place.
///
/// If several such times are within a sample of each other, any of them may be found.
///
/// @param stopped  [s]  no earlier than this
std::optional<double> Script::came_by(std::size_t mover, const std::vector<RigidState>& states,
                                      double stopped, double time) const {
  const double begin = std::max(stopped, time - step_);
  const double sample = (time - begin) / kSamples;
  for (int k = kSamples; k > 0; --k) {
    double from = begin + (k - 1) * sample;
    double to = std::min(time, from + 2.0 * sample);
    for (int third = 0; third < kThirds; ++third) {
      const double by = (to - from) / 3.0;
      if (distance_at(mover, states, from + by) < distance_at(mover, states, to - by)) {
        to -= by;
      } else {
        from += by;
      }
    }
    if (distance_at(mover, states, to) <= tolerance_) {
      return to;
    }
  }
  return std::nullopt;
}

}  // namespace firstcontact::detail
