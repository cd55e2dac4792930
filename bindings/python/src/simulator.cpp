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

/// A simulator that one thread at a time may use. Looked at with the GIL.
class HeldSimulator {
 public:
  explicit HeldSimulator(const LoadedScene& loaded) : simulator_(loaded) {}

  /// @throws std::runtime_error while another thread has it busy
  Simulator& idle() {
    if (is_busy_) {
      throw std::runtime_error("Simulator: another thread takes a step; it may be used after that");
    }
    return simulator_;
  }

  /// Calls without the GIL.
  template <typename Action>
  auto call(const Action& action) {
    Simulator& simulator = idle();
    const Busy busy(is_busy_);
    const py::gil_scoped_release release;
    return action(simulator);
  }

 private:
  /// Made and destroyed with the GIL.
  class Busy {
   public:
    explicit Busy(bool& flag) : flag_(flag) { flag_ = true; }
    ~Busy() { flag_ = false; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

   private:
    bool& flag_;
  };

  Simulator simulator_;
  bool is_busy_ = false;
};

/// @throws std::invalid_argument unless > 0 and finite
void require_positive(const char* name, std::optional<double> seconds) {
  if (seconds && !(*seconds > 0.0 && std::isfinite(*seconds))) {
    throw std::invalid_argument(std::string(name) + " must be > 0 and finite, got " +
                                std::to_string(*seconds));
  }
}

std::unique_ptr<HeldSimulator> make(const py::object& scene, std::optional<double> duration,
                                    std::optional<double> step, bool lenient) {
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
  return std::make_unique<HeldSimulator>(held->sharing(std::move(changed))->loaded());
}

const Simulation& simulation_of(HeldSimulator& held) {
  return *held.idle().header().scene.simulation;
}

/// A row of each body.
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

/// The number of a body that is given by its number or its name.
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

/// A row of numbers of each robot.
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

/// A step that was done stays done, whatever signal came: unlike a query it is not asked again.
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
          "Of the bodies, in order.")
      .def_property_readonly(
          "masses", [](HeldSimulator& s) { return owning(std::vector(s.idle().header().masses)); },
          "[kg] (n,), 0 of bodies that are not free.")
      .def_property_readonly(
          "centres_of_mass",
          [](HeldSimulator& s) { return owning(std::vector(s.idle().header().centres_of_mass)); },
          "[m] n×3, body frames.")
      .def_property_readonly(
          "scene",
          [](HeldSimulator& s) { return std::make_shared<HeldScene>(s.idle().header().scene); },
          "The resolved Scene.")
      .def_property_readonly(
          "warnings", [](HeldSimulator& s) { return s.idle().loaded().warnings; },
          "What one should know of the scene that was read.")
      .def_property_readonly(
          "pair_counts",
          [](HeldSimulator& s) { return pair_counts_tuple(s.idle().loaded().pair_counts); },
          "PairCounts: which pairs are held apart.")
      .def_property_readonly(
          "dt", [](HeldSimulator& s) { return simulation_of(s).step; }, "[s] Of one step.")
      .def_property_readonly(
          "duration", [](HeldSimulator& s) { return simulation_of(s).duration; },
          "[s] Of the scene; steps may go on after it.")
      .def_property_readonly(
          "steps_of_duration",
          [](HeldSimulator& s) { return simulation_step_count(simulation_of(s)); },
          "Steps that the duration takes.")
      .def_property_readonly(
          "header_json",
          [](HeldSimulator& s) { return without_line_feed(write_run_header(s.idle().header())); },
          "The first line of the file of a run, without the line feed.");
}

void bind_state(py::class_<HeldSimulator>& type) {
  type.def_property_readonly(
          "time", [](HeldSimulator& s) { return s.idle().time(); }, "[s] Simulated so far.")
      .def_property_readonly(
          "step_count", [](HeldSimulator& s) { return s.idle().step_count(); }, "Steps taken.")
      .def_property_readonly("positions", &positions,
                             "[m] n×3, of the body frames' origins in the world.")
      .def_property_readonly("quaternions_wxyz", &quaternions, "[-] n×4, of the body frames.")
      .def_property_readonly(
          "linear_velocities", [](HeldSimulator& s) { return rows(s, &RigidState::v_WC); },
          "[m/s] n×3, of the centres of mass, world axes; of bodies that are not free over the "
          "last "
          "step.")
      .def_property_readonly(
          "angular_velocities", [](HeldSimulator& s) { return rows(s, &RigidState::w_WB); },
          "[rad/s] n×3, world axes; likewise.")
      .def_property_readonly(
          "robot_positions",
          [](HeldSimulator& s) { return robot_rows(s, &MechanismState::positions); },
          "[rad or m] A row for each robot with dynamics: its joints in the order of the URDF, a "
          "free base before them. Of a pose: its position, then its quaternion w, x, y, z.")
      .def_property_readonly(
          "robot_velocities",
          [](HeldSimulator& s) { return robot_rows(s, &MechanismState::velocities); },
          "[rad/s or m/s] Likewise; of a pose: linear, then angular.")
      .def(
          "set_robot_state", &set_robot_state, py::arg("robot"), py::kw_only(),
          py::arg("positions") = py::none(), py::arg("velocities") = py::none(),
          R"(Puts a robot with dynamics elsewhere, or gives it other velocities; what is left out stays.

robot: its number among them. positions, velocities: rows as in `robot_positions`. ValueError where
their sizes are wrong, a quaternion is zero or a link would meet something: then nothing is changed.)")
      .def("set_state", &set_state, py::arg("body"), py::kw_only(),
           py::arg("position") = py::none(), py::arg("quaternion_wxyz") = py::none(),
           py::arg("linear_velocity") = py::none(), py::arg("angular_velocity") = py::none(),
           R"(Moves a free body elsewhere, or gives it other velocities; what is left out stays.

body: its number or its name. position: [m] (3,), of the body frame's origin in the world.
quaternion_wxyz: [-] (4,), of the body frame, any length but zero. linear_velocity: [m/s] (3,), of
the centre of mass. angular_velocity: [rad/s] (3,). World axes; locked ones stay at rest. ValueError
where the body is not free or would meet another one: then nothing is changed.)");
}

}  // namespace

void bind_simulator(py::module_& m) {
  py::class_<HeldSimulator> type(
      m, "Simulator",
      R"(Bodies that move under forces and contacts; what is free never interpenetrates.

Step by step, the in-between motion of every body is known, and every pair is proven apart over all
of it. The same on every run, and as the tool's `firstcontact simulate`. Rows of arrays are bodies
in the scene's order, then the geometries of robots' links; arrays are new ones at each look.)");
  type.def(
      py::init(&make), py::arg("scene"), py::kw_only(), py::arg("duration") = py::none(),
      py::arg("step") = py::none(), py::arg("lenient") = false,
      R"(scene: as check takes it, with "dynamics" of bodies; or the path of a fixture of Rigid IPC.
duration, step: [s] in place of the scene's. lenient: as of load_scene. ValueError where two bodies meet at the start, or a mass
cannot be found.)");
  bind_state(type);
  bind_looks(type);
  type.def("step", &step)
      .def("step", &step_until, py::arg("stop"),
           R"(Takes a step: the scene's, or as far as could be proven.

Other threads run meanwhile. Ctrl-C raises KeyboardInterrupt; then a step was taken whole, or nothing
has changed: `step_count` says which. stop: a StopSource; None where it was stopped, then nothing has
changed.)")
      .def(
          "resume", [](HeldSimulator& s, const RunStep& last) { s.idle().resume(last); },
          py::arg("step"),
          R"(Goes on after a step of a run of the same scene, bit for bit as that run did.

step: as from RunReader, or from an earlier `step`. ValueError where it is not of such a run.)")
      .def("__repr__", &describe_simulator);
}

}  // namespace firstcontact::python
