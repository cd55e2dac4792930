#include <firstcontact/haptics_files/haptic_setup.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/haptics/detail/session_periods.h>
#include <firstcontact/haptics_files/detail/rigid_robots.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/simulation_duration.h>

namespace firstcontact {
namespace {

void require_of_haptics(bool holds, const std::string& what) {
  if (!holds) {
    throw std::invalid_argument("haptics: " + what);
  }
}

const HapticQuestion& question_of(const Scene& scene) {
  require_of_haptics(scene.haptics.has_value(),
                     "expected \"haptics\" with \"tools\" in the scene (docs/haptics.md)");
  return *scene.haptics;
}

HapticSessionOptions session_options(const HapticQuestion& question) {
  HapticSessionOptions options{.force_rate = question.force_rate,
                               .contact_rate = question.contact_rate};
  options.forces.limits.force = question.max_force;
  options.forces.limits.torque = question.max_torque;
  options.forces.limits.force_slew = question.force_slew;
  options.forces.limits.torque_slew = question.torque_slew;
  for (const HapticToolQuestion& tool : question.tools) {
    options.mappings.push_back({.R_WD = tool.device_axes,
                                .scale = tool.scale,
                                .X_DH = tool.handle,
                                .begins_at_handle = tool.begins_at_handle,
                                .clutch_button = tool.clutch_button.value_or(-1),
                                .dead_man_button = tool.dead_man_button.value_or(-1)});
  }
  return options;
}

HapticTool tool_of(const LoadedScene& loaded, const HapticToolQuestion& question, double friction) {
  const Body& body = loaded.scene.bodies[question.body];
  const Shape& shape = loaded.bodies.shape(question.body);
  return {.name = body.name,
          .shape = shape,
          .X_WB = std::get<FixedMotion>(body.motion).pose,
          .p_BC = question.centre.value_or(shape.bounds().centre),
          .friction = body.surface.friction.value_or(friction),
          .coupling = {.stiffness = question.stiffness,
                       .angular_stiffness = question.angular_stiffness,
                       .damping = question.damping}};
}

HapticBody body_of(const LoadedScene& loaded, std::size_t number, double friction) {
  const Body& body = loaded.scene.bodies[number];
  HapticBody made{.name = body.name,
                  .shape = loaded.bodies.shape(number),
                  .friction = body.surface.friction.value_or(friction)};
  if (const auto* fixed = std::get_if<FixedMotion>(&body.motion)) {
    made.X_WB = fixed->pose;
  } else {
    made.course = loaded.bodies.motion(number);
  }
  return made;
}

}  // namespace

void prepare_haptics(Scene& scene, ShapeCache& cache, double duration, double latency) {
  const HapticQuestion& question = question_of(scene);
  constexpr double kLongest = 1e9;     // [s]
  constexpr double kMostLatency = 10;  // [s]
  require_of_haptics(duration > 0.0 && duration <= kLongest,
                     "the duration must be > 0 s and at most 1e9 s");
  require_of_haptics(latency >= 0.0 && latency <= kMostLatency, "the latency must be 0 s to 10 s");
  for (const Body& body : scene.bodies) {
    require_of_haptics(!body.free, "expected no \"dynamics\" of \"" + body.name + "\"");
    require_of_haptics(!std::holds_alternative<VertexMotion>(body.motion),
                       "expected no vertices of \"" + body.name + "\" that move");
    require_of_haptics(!body.surface.velocity,
                       "expected no surface of \"" + body.name + "\" that runs along the body");
  }
  require_of_haptics(
      scene.options.margin == 0.0 && scene.pair_margins.empty() && scene.group_margins.empty(),
      "expected no margins of pairs");
  detail::make_robots_bodies(scene, cache);
  scene.simulation.emplace();
  for (const HapticToolQuestion& tool : question.tools) {
    scene.bodies[tool.body].free.emplace().mass = 1.0;
  }
  HapticSessionOptions options = session_options(question);
  options.contact_latency_ns = std::llround(1e9 * latency);
  const detail::SessionPeriods periods = detail::session_periods(options);
  scene.simulation->step = 1e-9 * static_cast<double>(periods.cycle_ns);
  scene.simulation->gravity.setZero();
  scene.simulation->friction = question.friction;
  set_simulation_duration(scene, duration);
}

HapticSetup haptic_setup(const LoadedScene& loaded) {
  const HapticQuestion& question = question_of(loaded.scene);
  HapticSetup setup{.options = session_options(question)};
  setup.scene.duration = loaded.scene.duration;
  setup.scene.contact_distance = question.contact_distance;
  for (const HapticToolQuestion& tool : question.tools) {
    setup.scene.tools.push_back(tool_of(loaded, tool, question.friction));
    setup.bodies.push_back(tool.body);
  }
  for (std::size_t b = 0; b < loaded.scene.bodies.size(); ++b) {
    if (std::ranges::find(setup.bodies, b) == setup.bodies.end()) {
      setup.scene.bodies.push_back(body_of(loaded, b, question.friction));
      setup.bodies.push_back(b);
    }
  }
  for (std::size_t tool = 0; tool < question.tools.size(); ++tool) {
    for (std::size_t other = tool + 1; other < setup.bodies.size(); ++other) {
      const auto [first, second] = std::minmax(setup.bodies[tool], setup.bodies[other]);
      if (!margin_of_pair(loaded, {first, second})) {
        setup.scene.ignored_pairs.push_back({tool, other});
      }
    }
  }
  return setup;
}

}  // namespace firstcontact
