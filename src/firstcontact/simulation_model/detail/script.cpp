#include <firstcontact/simulation_model/detail/script.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {

namespace {

/// [-]  Of the contact distance: how far a script may be from a straight piece.
constexpr double kBendOfDistance = 0.5;

/// [-]  Of a step: what is left of it after the scene is over counts from here on.
constexpr double kLeastRest = 1e-9;

}  // namespace

Script::Script(const LoadedScene& loaded, const SimulationModel& model)
    : loaded_(loaded),
      tolerance_(kBendOfDistance * model.distances.least),
      step_(loaded.scene.simulation->step) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const SimBody& body = model.bodies[b];
    if (body.kind == BodyKind::scripted) {
      bodies_.push_back(b);
      motions_.push_back({loaded.bodies.motion(b), body.reach + body.inertia.p_BC.norm()});
    }
  }
}

double Script::share(double time) const { return std::min(1.0, time / loaded_.scene.duration); }

std::vector<double> Script::parts(double time) const {
  const double from = share(time);
  const double to = share(time + step_);
  if (bodies_.empty() || !(from < to)) {
    return {step_};
  }
  const std::vector<double> ends = straight_parts(motions_, from, to, tolerance_);
  if (ends.empty()) {
    throw std::invalid_argument("the scripted bodies move too wildly in the step at " +
                                std::to_string(time) +
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

std::vector<Move> Script::moves(const std::vector<RigidState>& states, double time,
                                double length) const {
  std::vector<Move> moves(states.size());
  const double from = share(time);
  const double to = share(time + length);
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const Pose& X_WB = states[bodies_[k]].X_WB;
    const Motion& motion = motions_[k].motion;
    moves[bodies_[k]] = {motion.pose(to).position - X_WB.position,
                         rotation_along(motion, from, to, X_WB.rotation)};
  }
  return moves;
}

}  // namespace firstcontact::detail
