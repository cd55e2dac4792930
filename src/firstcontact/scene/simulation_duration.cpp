#include <firstcontact/scene/simulation_duration.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/scene/body_motion.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/simulation.h>

namespace firstcontact {
namespace {

/// A motion over a longer time, at the same rates; the overloads are picked by std::visit.
struct LongerMotion {
  double from;  // [s]
  double to;    // [s]  > from

  BodyMotion operator()(const FixedMotion& motion) const { return motion; }

  BodyMotion operator()(ConstantVelocityMotion motion) const {
    motion.translation *= to / from;
    motion.rotation_vector *= to / from;
    return motion;
  }

  BodyMotion operator()(ScrewMotion motion) const {
    motion.angle *= to / from;
    motion.translation *= to / from;
    return motion;
  }

  BodyMotion operator()(const TwoPoseMotion& motion) const {
    return WaypointMotion{{0.0, from}, {motion.from, motion.to}, motion.between};
  }

  BodyMotion operator()(const WaypointMotion& motion) const { return motion; }

  BodyMotion operator()(const VertexMotion&) const {
    throw std::invalid_argument("expected no body that deforms where a simulation goes on");
  }
};

}  // namespace

void set_simulation_duration(Scene& scene, double duration) {
  if (!scene.simulation || !(duration > 0.0)) {
    throw std::invalid_argument("set_simulation_duration: expected a simulation and a time > 0");
  }
  if (duration > scene.duration) {
    const LongerMotion longer{scene.duration, duration};
    std::vector<BodyMotion> motions;  // All of them are made first, as one may be refused.
    for (const Body& body : scene.bodies) {
      motions.push_back(std::visit(longer, body.motion));
    }
    for (std::size_t k = 0; k < motions.size(); ++k) {
      scene.bodies[k].motion = std::move(motions[k]);
    }
    for (SceneRobot& robot : scene.robots) {
      robot.base = std::visit(longer, robot.base);
    }
    scene.duration = duration;
  }
  scene.simulation->duration = duration;
}

std::size_t simulation_step_count(const Simulation& simulation) {
  constexpr double kRounding = 1e-12;  // [-]  Above the rounding of a quotient of whole steps.
  constexpr double kMost = 1e8;
  const double count = std::ceil(simulation.duration / simulation.step * (1.0 - kRounding));
  if (!(count <= kMost)) {
    std::array<char, 128> text{};
    (void)std::snprintf(text.data(), text.size(),
                        "simulation: expected at most %g steps, got %g s in steps of %g s", kMost,
                        simulation.duration, simulation.step);
    throw std::invalid_argument(text.data());
  }
  return static_cast<std::size_t>(count);
}

}  // namespace firstcontact
