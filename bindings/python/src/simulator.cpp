#include <firstcontact/math/number_text.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/simulation/simulator.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include <firstcontact/record/write_run.h>
#include <firstcontact/scene/simulation_duration.h>

#include "arrays.h"
#include "bindings.h"
#include "busy.h"
#include "interrupts.h"
#include "motion.h"
#include "query.h"
#include "reports.h"
#include "run.h"
#include "scene.h"

namespace firstcontact::python {

namespace py = pybind11;
using Eigen::Vector3d;

namespace {

/// A simulator that one thread at a time may use. Its fields are read with the GIL.
class HeldSimulator {
 public:
  explicit HeldSimulator(const LoadedScene& loaded) : simulator_(loaded) {}

  /// Marks the simulator as busy.
  ///
  /// @throws std::runtime_error while another thread has it busy
  Simulator& idle() {
    require_idle(is_busy_, "Simulator");
    return simulator_;
  }

  /// Makes a call without the GIL.
  template <typename Action>
  auto call(const Action& action) {
    Simulator& simulator = idle();
    const Busy busy(is_busy_);
    const py::gil_scoped_release release;
    return action(simulator);
  }

 private:
  Simulator simulator_;
  bool is_busy_ = false;
};

/// Requires a positive number.
///
/// @throws std::invalid_argument unless > 0 and finite
void require_positive(const char* name, std::optional<double> seconds) {
  if (seconds && !(*seconds > 0.0 && std::isfinite(*seconds))) {
    throw std::invalid_argument(std::string(name) + " must be > 0 and finite, got " +
                                detail::shortest(*seconds));
  }
}

std::unique_ptr<HeldSimulator> make(const py::object& scene, std::optional<double> duration,
                                    std::optional<double> step, bool lenient, int threads) {
  require_positive("duration", duration);
  require_positive("step", step);
  const auto held = py::module_::import("firstcontact._check")
                        .attr("load_simulation_scene")(scene, py::arg("lenient") = lenient)
                        .cast<std::shared_ptr<HeldScene>>();
  const py::gil_scoped_release release;
  Scene changed = held->scene();
  if (!changed.simulation) {
    throw std::invalid_argument(
        "scene: expected \"simulation\" or a body with \"dynamics\"; without them nothing moves "
        "freely (see check for scripted motion)");
  }
  if (duration) {
    set_simulation_duration(changed, *duration);
  }
  changed.simulation->step = step.value_or(changed.simulation->step);
  auto made = std::make_unique<HeldSimulator>(held->sharing(std::move(changed))->loaded());
  made->idle().set_threads(threads);
  return made;
}

const Simulation& simulation_of(HeldSimulator& held) {
  return *held.idle().header().scene.simulation;
}

/// A row for each body.
py::array rows(HeldSimulator& held, Vector3d RigidState::*what) {
  std::vector<Vector3d> found;
  for (const RigidState& state : held.idle().states()) {
    found.push_back(state.*what);
  }
  return owning(std::move(found));
}

py::array positions(HeldSimulator& held) {
  std::vector<Vector3d> found;
  for (const RigidState& state : held.idle().states()) {
    found.push_back(state.X_WB.position);
  }
  return owning(std::move(found));
}

py::array quaternions(HeldSimulator& held) {
  const std::vector<RigidState>& states = held.idle().states();
  py::array_t<double> wxyz({static_cast<py::ssize_t>(states.size()), py::ssize_t{4}});
  auto rows = wxyz.mutable_unchecked<2>();
  for (std::size_t b = 0; b < states.size(); ++b) {
    const Eigen::Quaterniond& q = states[b].X_WB.rotation;
    const auto row = static_cast<py::ssize_t>(b);
    rows(row, 0) = q.w();
    rows(row, 1) = q.x();
    rows(row, 2) = q.y();
    rows(row, 3) = q.z();
  }
  return wxyz;
}

/// The number of a body from its number or its name.
std::size_t body_from(const Simulator& simulator, const py::object& body) {
  const std::vector<std::string> bodies = names_with_links(simulator.header().scene);
  if (py::isinstance<py::str>(body)) {
    const auto name = body.cast<std::string>();
    const auto found = std::ranges::find(bodies, name);
    if (found == bodies.end()) {
      throw py::value_error("body: there is none of the name \"" + name + '"');
    }
    return static_cast<std::size_t>(found - bodies.begin());
  }
  const py::object index = py::reinterpret_steal<py::object>(PyNumber_Index(body.ptr()));
  if (!index) {
    PyErr_Clear();
    throw py::type_error("body: expected a number or a name, got " +
                         std::string(Py_TYPE(body.ptr())->tp_name));
  }
  if (index < py::int_(0) || index >= py::int_(bodies.size())) {
    throw py::value_error("body: expected a number from 0 to " + std::to_string(bodies.size() - 1) +
                          ", got " + std::string(py::str(index)));
  }
  return index.cast<std::size_t>();
}

void set_state(HeldSimulator& held, const py::object& body, const py::object& position,
               const py::object& quaternion_wxyz, const py::object& linear_velocity,
               const py::object& angular_velocity) {
  const std::size_t number = body_from(held.idle(), body);
  RigidState state = held.idle().states()[number];
  if (!position.is_none()) {
    state.X_WB.position = vector_from(position, "position");
  }
  if (!quaternion_wxyz.is_none()) {
    state.X_WB.rotation = quaternion_from(quaternion_wxyz);
  }
  if (!linear_velocity.is_none()) {
    state.v_WC = vector_from(linear_velocity, "linear_velocity");
  }
  if (!angular_velocity.is_none()) {
    state.w_WB = vector_from(angular_velocity, "angular_velocity");
  }
  held.call([&](Simulator& simulator) { simulator.set_state(number, state); });
}

/// A row of numbers for each robot.
py::tuple robot_rows(HeldSimulator& held, Eigen::VectorXd MechanismState::*what) {
  py::list found;
  for (const MechanismState& state : held.idle().robot_states()) {
    const Eigen::VectorXd& row = state.*what;
    found.append(owning(std::vector<double>(row.begin(), row.end())));
  }
  return py::tuple(found);
}

Eigen::VectorXd row_from(const py::object& numbers, const char* name,
                         const Eigen::VectorXd& otherwise) {
  if (numbers.is_none()) {
    return otherwise;
  }
  const std::vector<double> row = numbers_from(numbers, name);
  return Eigen::Map<const Eigen::VectorXd>(row.data(), static_cast<Eigen::Index>(row.size()));
}

void set_robot_state(HeldSimulator& held, std::size_t robot, const py::object& positions,
                     const py::object& velocities) {
  const std::vector<MechanismState>& states = held.idle().robot_states();
  if (robot >= states.size()) {
    throw py::value_error("robot: expected a number below " + std::to_string(states.size()) +
                          ", got " + std::to_string(robot));
  }
  const MechanismState state{row_from(positions, "positions", states[robot].positions),
                             row_from(velocities, "velocities", states[robot].velocities)};
  held.call([&](Simulator& simulator) { simulator.set_robot_state(robot, state); });
}

Vector3d vector_or(const py::object& numbers, const char* name, const Vector3d& otherwise) {
  return numbers.is_none() ? otherwise : vector_from(numbers, name);
}

void apply_force(HeldSimulator& held, const py::object& body, const py::object& force,
                 const py::object& torque, const py::object& point) {
  std::optional<Vector3d> p_WP;
  if (!point.is_none()) {
    p_WP = vector_from(point, "point");
  }
  held.idle().apply_force(body_from(held.idle(), body), vector_or(force, "force", Vector3d::Zero()),
                          vector_or(torque, "torque", Vector3d::Zero()), p_WP);
}

/// The one target that is given.
///
/// @throws std::invalid_argument unless exactly one of them is given
JointMotor::Kind kind_of(std::optional<double> position, std::optional<double> velocity,
                         std::optional<double> torque) {
  if (position.has_value() + velocity.has_value() + torque.has_value() != 1) {
    throw std::invalid_argument("set_motor: expected one of position, velocity and torque");
  }
  return position   ? JointMotor::Kind::position
         : velocity ? JointMotor::Kind::velocity
                    : JointMotor::Kind::torque;
}

void set_motor(HeldSimulator& held, std::size_t robot, const std::string& joint,
               std::optional<double> position, std::optional<double> velocity,
               std::optional<double> torque, std::optional<double> stiffness,
               std::optional<double> damping, std::optional<double> effort) {
  const JointMotor::Kind kind = kind_of(position, velocity, torque);
  Simulator& simulator = held.idle();
  JointMotor motor = simulator.motor(robot, joint).value_or(JointMotor{});
  if (kind != JointMotor::Kind::position) {
    motor.stiffness.reset();
    motor.damping = 0.0;
  }
  motor.kind = kind;
  motor.target = {{0.0, position.value_or(velocity.value_or(torque.value_or(0.0)))}};
  motor.stiffness = stiffness ? stiffness : motor.stiffness;
  motor.damping = damping.value_or(motor.damping);
  motor.effort = effort ? effort : motor.effort;
  simulator.set_motor(robot, joint, motor);
}

void set_surface(HeldSimulator& held, const py::object& body, std::optional<double> friction,
                 std::optional<double> restitution, const py::object& velocity) {
  Surface surface{.friction = friction, .restitution = restitution};
  if (!velocity.is_none()) {
    surface.velocity = vector_from(velocity, "velocity");
  }
  held.idle().set_surface(body_from(held.idle(), body), surface);
}

void set_pair_surface(HeldSimulator& held, const py::object& a, const py::object& b,
                      std::optional<double> friction, std::optional<double> restitution) {
  held.idle().set_pair_surface({body_from(held.idle(), a), body_from(held.idle(), b)},
                               {.friction = friction, .restitution = restitution});
}

/// A finished step stays, whatever signal came: unlike a query it is not repeated.
std::optional<RunStep> step_until(HeldSimulator& held, OrNone<std::stop_source> user) {
  while (true) {
    QueryStop stop(user);
    QueryStop::handle_pending();
    std::optional<RunStep> done =
        held.call([&](Simulator& simulator) { return simulator.step(stop.token()); });
    if (done || !stop.was_interrupted()) {
      return done;
    }
  }
}

RunStep step(HeldSimulator& held) { return step_until(held, {}).value(); }

std::string describe_simulator(HeldSimulator& held) {
  const Simulator& simulator = held.idle();
  return "<Simulator of " + std::to_string(simulator.states().size()) + " bodies after " +
         std::to_string(simulator.step_count()) + " steps, " +
         std::string(py::repr(py::float_(simulator.time()))) + " s>";
}

void bind_looks(py::class_<HeldSimulator>& type) {
  type.def_property_readonly(
          "names", [](HeldSimulator& s) { return names_of(s.idle().header()); },
          "Names of the bodies, in order.")
      .def_property_readonly(
          "masses", [](HeldSimulator& s) { return owning(std::vector(s.idle().header().masses)); },
          "[kg] (n,), 0 for bodies that are not free; links of robots with dynamics have theirs.")
      .def_property_readonly(
          "centres_of_mass",
          [](HeldSimulator& s) { return owning(std::vector(s.idle().header().centres_of_mass)); },
          "[m] n×3, centres of mass in body frames.")
      .def_property_readonly(
          "scene",
          [](HeldSimulator& s) { return std::make_shared<HeldScene>(s.idle().header().scene); },
          "The resolved Scene.")
      .def_property_readonly(
          "warnings", [](HeldSimulator& s) { return s.idle().loaded().warnings; },
          "Warnings about the scene that was read.")
      .def_property_readonly(
          "pair_counts",
          [](HeldSimulator& s) { return pair_counts_tuple(s.idle().loaded().pair_counts); },
          "PairCounts: the pairs that are held apart.")
      .def_property_readonly(
          "dt", [](HeldSimulator& s) { return simulation_of(s).step; }, "[s] Length of one step.")
      .def_property_readonly(
          "duration", [](HeldSimulator& s) { return simulation_of(s).duration; },
          "[s] Duration of the scene; steps may go on after it.")
      .def_property_readonly(
          "steps_of_duration",
          [](HeldSimulator& s) { return simulation_step_count(simulation_of(s)); },
          "Number of steps of the duration.")
      .def_property_readonly(
          "header_json",
          [](HeldSimulator& s) { return without_line_feed(write_run_header(s.idle().header())); },
          "The first line of the file of a run, without the line feed.");
}

void bind_state(py::class_<HeldSimulator>& type) {
  type.def_property_readonly(
          "time", [](HeldSimulator& s) { return s.idle().time(); }, "[s] Simulated time so far.")
      .def_property_readonly(
          "step_count", [](HeldSimulator& s) { return s.idle().step_count(); }, "Steps taken.")
      .def_property_readonly("positions", &positions,
                             "[m] n×3, positions of the body frames' origins in the world.")
      .def_property_readonly("quaternions_wxyz", &quaternions,
                             "[-] n×4, quaternions of the body frames.")
      .def_property_readonly(
          "linear_velocities", [](HeldSimulator& s) { return rows(s, &RigidState::v_WC); },
          "[m/s] n×3, velocities of the centres of mass, world axes; those of bodies that are not "
          "free over the last step.")
      .def_property_readonly(
          "angular_velocities", [](HeldSimulator& s) { return rows(s, &RigidState::w_WB); },
          "[rad/s] n×3, angular velocities, world axes; likewise.")
      .def_property_readonly(
          "robot_positions",
          [](HeldSimulator& s) { return robot_rows(s, &MechanismState::positions); },
          "[rad or m] A row for each robot with dynamics: its joints in the order of the URDF, a "
          "free base before them. A pose has its position, then its quaternion w, x, y, z.")
      .def_property_readonly(
          "robot_velocities",
          [](HeldSimulator& s) { return robot_rows(s, &MechanismState::velocities); },
          "[rad/s or m/s] A row for each robot with dynamics; a pose has linear, then angular "
          "velocity.")
      .def("set_robot_state", &set_robot_state, py::arg("robot"), py::kw_only(),
           py::arg("positions") = py::none(), py::arg("velocities") = py::none(),
           R"(Sets the place or the velocities of a robot with dynamics; arguments left out stay.

robot: its number among them. positions, velocities: rows as in `robot_positions`. ValueError where
their sizes are wrong, a quaternion is zero, a joint would be beyond its limits or a link would meet
something: then nothing is changed.)")
      .def("set_state", &set_state, py::arg("body"), py::kw_only(),
           py::arg("position") = py::none(), py::arg("quaternion_wxyz") = py::none(),
           py::arg("linear_velocity") = py::none(), py::arg("angular_velocity") = py::none(),
           R"(Moves a free body elsewhere, or gives it other velocities; arguments left out stay.

body: its number or its name. position: [m] (3,), of the body frame's origin in the world.
quaternion_wxyz: [-] (4,), of the body frame, any length but zero. linear_velocity: [m/s] (3,), of
the centre of mass. angular_velocity: [rad/s] (3,). World axes; locked ones stay at rest. ValueError
where the body is not free or would meet another one: then nothing is changed.)");
}

void bind_commands(py::class_<HeldSimulator>& type) {
  const auto none = py::none();
  type.def("apply_force", &apply_force, py::arg("body"), py::arg("force") = none,
           py::arg("torque") = none, py::arg("point") = none,
           R"(Adds a force and a torque to those on a free body, for the next step alone.

body: its number or its name. force: [N] (3,). torque: [N m] (3,). point: [m] (3,), on which the
force acts, which adds a torque; else the centre of mass. World axes. Several calls add up.
ValueError where the body is not free or a link.)")
      .def("set_motor", &set_motor, py::arg("robot"), py::arg("joint"), py::kw_only(),
           py::arg("position") = none, py::arg("velocity") = none, py::arg("torque") = none,
           py::arg("stiffness") = none, py::arg("damping") = none, py::arg("effort") = none,
           R"(Gives a joint a motor, or another target, from the next step on.

robot: its number among those with dynamics. joint: the name of a joint of one coordinate.
position, velocity, torque: one of them; [rad, rad/s, N m], or [m, m/s, N] along a slide.
stiffness, damping: make a position a spring and a damper, [N m/rad, N m s/rad]. effort: [N m or N],
at most. Arguments left out stay as the joint's motor has them.)")
      .def(
          "set_gravity",
          [](HeldSimulator& s, const py::object& gravity) {
            s.idle().set_gravity(vector_from(gravity, "gravity"));
          },
          py::arg("gravity"), "Changes gravity from the next step on: [m/s²] (3,).")
      .def("set_surface", &set_surface, py::arg("body"), py::kw_only(), py::arg("friction") = none,
           py::arg("restitution") = none, py::arg("velocity") = none,
           R"(Changes the surface of a body from the next step on; arguments left out stay.

body: its number or its name. friction: [-] >= 0. restitution: [-] in [0, 1]. velocity: [m/s] (3,),
of a belt, body axes.)")
      .def("set_pair_surface", &set_pair_surface, py::arg("body_a"), py::arg("body_b"),
           py::kw_only(), py::arg("friction") = none, py::arg("restitution") = none,
           "Changes the surface of a pair of bodies likewise, in place of their two surfaces' "
           "values.");
}

}  // namespace

void bind_simulator(py::module_& m) {
  py::class_<HeldSimulator> type(
      m, "Simulator",
      R"(Simulator of bodies that move under forces and contacts; free bodies never interpenetrate.

In each step the in-between motion of every body is known, and every pair is proven apart over all
of it. It is the same on every run, and as the tool's `firstcontact simulate`. Rows of arrays are
bodies in the scene's order, then the geometries of robots' links. Each access makes new arrays.)");
  type.def(py::init(&make), py::arg("scene"), py::kw_only(), py::arg("duration") = py::none(),
           py::arg("step") = py::none(), py::arg("lenient") = false, py::arg("threads") = 0,
           R"(scene: as for check, with "dynamics" of bodies; or the path of a fixture of Rigid IPC.
duration, step: [s] in place of the scene's. lenient: as for load_scene. threads: at most so many; 0
for one on each core; the run is the same. ValueError where two bodies meet at the start, or a mass
cannot be found.)");
  bind_state(type);
  bind_commands(type);
  bind_looks(type);
  type.def("step", &step)
      .def("step", &step_until, py::arg("stop"),
           R"(Takes a step: the scene's, or as far as could be proven.

Other threads run meanwhile. Ctrl-C raises KeyboardInterrupt; then a step was taken whole, or
nothing has changed, as `step_count` shows. stop: a StopSource; returns None where it was stopped,
and then nothing has changed.)")
      .def(
          "resume", [](HeldSimulator& s, const RunStep& last) { s.idle().resume(last); },
          py::arg("step"),
          R"(Goes on after a step of a run of the same scene, bit for bit as that run did.

step: from RunReader, or from an earlier `step`. A record has no commands: forces, motors, gravity
and surfaces are those of this simulator. ValueError where the step is not of such a run.)")
      .def("__repr__", &describe_simulator);
}

}  // namespace firstcontact::python
