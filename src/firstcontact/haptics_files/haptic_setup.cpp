#include <firstcontact/haptics_files/haptic_setup.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/haptic_sessions/detail/session_periods.h>
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

std::vector<GripMapping> grips_of(const HapticToolQuestion& tool) {
  std::vector<GripMapping> grips;
  for (const HapticGripQuestion& question : tool.grips) {
    GripMapping grip{
        .joints = {}, .button = question.button.value_or(-1), .seconds = question.seconds};
    for (const HapticGripJoint& joint : question.joints) {
      grip.joints.push_back({.joint = joint.joint, .open = joint.open, .closed = joint.closed});
    }
    grips.push_back(std::move(grip));
  }
  return grips;
}

HapticSessionOptions session_options(const HapticQuestion& question) {
  HapticSessionOptions options{.force_rate = question.force_rate,
                               .contact_rate = question.contact_rate};
  options.forces.limits.force = question.max_force;
  options.forces.limits.torque = question.max_torque;
  options.forces.limits.force_slew = question.force_slew;
  options.forces.limits.torque_slew = question.torque_slew;
  options.forces.limits.grip_effort = question.max_grip_effort;
  for (const HapticToolQuestion& tool : question.tools) {
    options.mappings.push_back({.R_WD = tool.device_axes,
                                .scale = tool.scale,
                                .X_DH = tool.handle,
                                .begins_at_handle = tool.begins_at_handle,
                                .clutch_button = tool.clutch_button.value_or(-1),
                                .dead_man_button = tool.dead_man_button.value_or(-1),
                                .grips = grips_of(tool)});
  }
  return options;
}

void add_links(const LoadedScene& loaded, const HapticToolQuestion& question, double friction,
               HapticTool& tool) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const HapticToolJoint& joint : question.joints) {
    tool.joints.push_back({.name = joint.name,
                           .start = joint.start,
                           .lower = joint.lower.value_or(-kInfinite),
                           .upper = joint.upper.value_or(kInfinite),
                           .stiffness = joint.stiffness});
  }
  for (const HapticToolLink& link : question.links) {
    HapticLink made{.name = {},
                    .parent = link.parent,
                    .X_PJ = link.X_PJ,
                    .axis = link.axis,
                    .joint = link.joint,
                    .turn = link.turn,
                    .slide = link.slide};
    if (link.body) {
      const Body& body = loaded.scene.bodies[*link.body];
      made.name = body.name;
      made.shape = loaded.bodies.shape(*link.body);
      made.friction = body.surface.friction.value_or(friction);
    }
    tool.links.push_back(std::move(made));
  }
}

/// [m]  Computes the middle of a shape's bounds along the axes of its frame.
Eigen::Vector3d middle_of_bounds(const Shape& shape) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : shape.mesh().vertices) {
    bounds.extend(vertex);
  }
  return bounds.center();
}

HapticTool tool_of(const LoadedScene& loaded, const HapticToolQuestion& question, double friction) {
  const Body& body = loaded.scene.bodies[question.body];
  const Shape& shape = loaded.bodies.shape(question.body);
  HapticTool tool{.name = body.name,
                  .shape = shape,
                  .X_WB = std::get<FixedMotion>(body.motion).pose,
                  .p_BC = question.centre.value_or(middle_of_bounds(shape)),
                  .friction = body.surface.friction.value_or(friction),
                  .coupling = {.stiffness = question.stiffness,
                               .angular_stiffness = question.angular_stiffness,
                               .damping = question.damping}};
  add_links(loaded, question, friction, tool);
  return tool;
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
    require_of_haptics(!body.surface.restitution, "expected no \"restitution\" of \"" + body.name +
                                                      "\": a tool does not bounce");
    require_of_haptics(!body.surface.velocity,
                       "expected no surface of \"" + body.name + "\" that runs along the body");
  }
  require_of_haptics(
      scene.options.margin == 0.0 && scene.pair_margins.empty() && scene.group_margins.empty(),
      "expected no margins of pairs");
  detail::make_robots_bodies(scene, cache);
  require_of_haptics(!scene.simulation,
                     "expected no \"simulation\": none of it would be felt; \"friction\" is a key "
                     "of \"haptics\" and of the \"surface\" of bodies");
  scene.simulation.emplace();
  for (const HapticToolQuestion& tool : question.tools) {
    scene.bodies[tool.body].free.emplace().mass = 1.0;
    for (const HapticToolLink& link : tool.links) {
      if (link.body) {
        scene.bodies[*link.body].free.emplace().mass = 1.0;
      }
    }
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
  std::vector<std::size_t> links;
  for (const HapticToolQuestion& tool : question.tools) {
    for (const HapticToolLink& link : tool.links) {
      if (link.body) {
        links.push_back(*link.body);
      }
    }
  }
  for (std::size_t b = 0; b < loaded.scene.bodies.size(); ++b) {
    if (std::ranges::find(setup.bodies, b) == setup.bodies.end() &&
        std::ranges::find(links, b) == links.end()) {
      setup.scene.bodies.push_back(body_of(loaded, b, question.friction));
      setup.bodies.push_back(b);
    }
  }
  const std::size_t first_link = setup.bodies.size();
  setup.bodies.insert(setup.bodies.end(), links.begin(), links.end());
  for (std::size_t tool = 0; tool < setup.bodies.size(); ++tool) {
    const bool is_of_tool = tool < question.tools.size();
    for (std::size_t other = is_of_tool ? tool + 1 : std::max(tool + 1, first_link);
         other < setup.bodies.size(); ++other) {
      const auto [first, second] = std::minmax(setup.bodies[tool], setup.bodies[other]);
      if (!margin_of_pair(loaded, {first, second})) {
        setup.scene.ignored_pairs.push_back({tool, other});
      }
    }
  }
  return setup;
}

}  // namespace firstcontact
