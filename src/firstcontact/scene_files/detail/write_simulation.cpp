#include <firstcontact/scene_files/detail/write_simulation.h>

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/simulation.h>
#include <firstcontact/scene_files/detail/result_json.h>

namespace firstcontact::detail {
namespace {

JsonValue three(const std::array<bool, 3>& locks) {
  return {.value = JsonArray{{.value = locks[0]}, {.value = locks[1]}, {.value = locks[2]}}};
}

JsonValue rows_of(const Eigen::Matrix3d& matrix) {
  JsonArray rows;
  for (Eigen::Index i = 0; i < 3; ++i) {
    rows.push_back(to_json(Eigen::Vector3d(matrix.row(i))));
  }
  return {.value = std::move(rows)};
}

JsonValue timed(const TimedForce& force) {
  JsonObject object{{"from", to_json(force.from)}};
  if (std::isfinite(force.to)) {
    object.push_back({"to", to_json(force.to)});
  }
  object.push_back({"force", to_json(force.force)});
  object.push_back({"torque", to_json(force.torque)});
  return {.value = std::move(object)};
}

template <class T>
void add_given(const char* key, const std::optional<T>& value, JsonObject& object) {
  if (value) {
    object.push_back({key, to_json(*value)});
  }
}

void add_surface(const Surface& surface, JsonObject& object) {
  add_given("friction", surface.friction, object);
  add_given("restitution", surface.restitution, object);
  add_given("velocity", surface.velocity, object);
}

JsonObject dynamics(const FreeBody& free, const Surface& surface) {
  JsonObject object;
  add_given("density", free.density, object);
  add_given("mass", free.mass, object);
  add_given("centre_of_mass", free.centre_of_mass, object);
  if (free.inertia) {
    object.push_back({"inertia", rows_of(*free.inertia)});
  }
  object.push_back({"linear_velocity", to_json(free.linear_velocity)});
  object.push_back({"angular_velocity", to_json(free.angular_velocity)});
  add_surface(surface, object);
  object.push_back({"locked_translation", three(free.locked_translation)});
  object.push_back({"locked_rotation", three(free.locked_rotation)});
  JsonArray forces;
  for (const TimedForce& force : free.forces) {
    forces.push_back(timed(force));
  }
  object.push_back({"forces", {.value = std::move(forces)}});
  return object;
}

JsonValue target_json(const std::vector<TimedNumber>& target) {
  JsonArray rows;
  for (const TimedNumber& row : target) {
    rows.push_back({.value = JsonArray{to_json(row.time), to_json(row.number)}});
  }
  return {.value = std::move(rows)};
}

JsonValue motor_json(const JointMotor& motor) {
  constexpr std::array kKeys{"position", "velocity", "torque"};
  JsonObject object{{kKeys.at(static_cast<std::size_t>(motor.kind)),
                     motor.target.empty() ? to_json("trajectory") : target_json(motor.target)}};
  add_given("stiffness", motor.stiffness, object);
  if (motor.stiffness) {
    object.push_back({"damping", to_json(motor.damping)});
  }
  add_given("effort", motor.effort, object);
  return {.value = std::move(object)};
}

template <class T, class Write>
JsonValue two_or_null(const std::array<std::optional<T>, 2>& values, const Write& write) {
  JsonArray pair;
  for (const std::optional<T>& value : values) {
    pair.push_back(value ? write(*value) : JsonValue{.value = JsonNull{}});
  }
  return {.value = std::move(pair)};
}

JsonValue tie_json(const Tie& tie, const Scene& scene) {
  JsonObject object{{"type", to_json(kTieTypeWords[static_cast<std::size_t>(tie.type)])},
                    {"bodies", two_or_null(tie.bodies, [&](std::size_t member) {
                       return to_json(member_name(scene, member));
                     })}};
  if (tie.points[0] || tie.points[1]) {
    object.push_back({"points", two_or_null(tie.points, [](const Eigen::Vector3d& point) {
                        return to_json(point);
                      })});
  }
  add_given("length", tie.length, object);
  add_given("stiffness", tie.stiffness, object);
  if (tie.damping > 0.0) {
    object.push_back({"damping", to_json(tie.damping)});
  }
  if (tie.type == TieType::hinge) {
    object.push_back({"axis", to_json(tie.axis)});
  }
  return {.value = std::move(object)};
}

}  // namespace

JsonValue robot_dynamics_to_json(const SceneRobot& robot) {
  const RobotDynamics& dynamics = *robot.dynamics;
  JsonObject object{{"base", to_json(dynamics.has_free_base ? "free" : "fixed")}};
  if (dynamics.has_free_base) {
    object.push_back({"linear_velocity", to_json(dynamics.linear_velocity)});
    object.push_back({"angular_velocity", to_json(dynamics.angular_velocity)});
  }
  JsonObject velocities;
  for (const auto& [name, velocity] : dynamics.velocities) {
    velocities.push_back({name, to_json(velocity)});
  }
  object.push_back({"velocities", {.value = std::move(velocities)}});
  JsonObject motors;
  for (const auto& [joint, motor] : dynamics.motors) {
    motors.push_back({robot.model.joints()[joint].name, motor_json(motor)});
  }
  object.push_back({"motors", {.value = std::move(motors)}});
  add_given("density", dynamics.density, object);
  add_surface(dynamics.surface, object);
  return {.value = std::move(object)};
}

void add_dynamics(const Body& body, JsonObject& object) {
  if (body.free) {
    object.push_back({"dynamics", {.value = dynamics(*body.free, body.surface)}});
  } else if (body.surface.friction || body.surface.restitution || body.surface.velocity) {
    JsonObject surface;
    add_surface(body.surface, surface);
    object.push_back({"surface", {.value = std::move(surface)}});
  }
}

JsonValue simulation_to_json(const Scene& scene) {
  const Simulation& simulation = *scene.simulation;
  JsonObject object{{"duration", to_json(simulation.duration)},
                    {"step", to_json(simulation.step)},
                    {"gravity", to_json(simulation.gravity)},
                    {"friction", to_json(simulation.friction)},
                    {"restitution", to_json(simulation.restitution)}};
  if (simulation.impacts != ImpactLaw::sequential) {
    object.push_back(
        {"impacts", to_json(kImpactLawWords[static_cast<std::size_t>(simulation.impacts)])});
  }
  if (simulation.jams != JamRule::lose_time) {
    object.push_back({"jams", to_json(kJamRuleWords[static_cast<std::size_t>(simulation.jams)])});
  }
  add_given("contact_distance", simulation.contact_distance, object);
  object.push_back({"events", to_json(simulation.events)});
  JsonArray pairs;
  for (const PairSurface& pair : simulation.pairs) {
    JsonObject entry{{"bodies", two(to_json(member_name(scene, pair.bodies[0])),
                                    to_json(member_name(scene, pair.bodies[1])))}};
    add_surface(pair.surface, entry);
    pairs.push_back({.value = std::move(entry)});
  }
  object.push_back({"pairs", {.value = std::move(pairs)}});
  if (!simulation.ties.empty()) {
    JsonArray ties;
    for (const Tie& tie : simulation.ties) {
      ties.push_back(tie_json(tie, scene));
    }
    object.push_back({"ties", {.value = std::move(ties)}});
  }
  return {.value = std::move(object)};
}

}  // namespace firstcontact::detail
