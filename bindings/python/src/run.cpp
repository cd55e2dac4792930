#include "run.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <pybind11/stl/filesystem.h>

#include <firstcontact/record/load_scene_of.h>
#include <firstcontact/record/read_run.h>
#include <firstcontact/record/write_run.h>
#include <firstcontact/run_page/write_run_page.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/shape_cache.h>

#include "arrays.h"
#include "bindings.h"
#include "errors.h"
#include "scene.h"

namespace firstcontact::python {

namespace py = pybind11;
using Eigen::Vector3d;

py::tuple names_of(const RunHeader& header) {
  py::list names;
  for (const std::string& name : names_with_links(header.scene)) {
    names.append(name);
  }
  return py::tuple(names);
}

std::string without_line_feed(std::string line) {
  line.pop_back();
  return line;
}

namespace {

/// Makes an n×columns array.
template <typename Number>
py::array table(const std::vector<Number>& numbers, py::ssize_t columns) {
  return py::array_t<Number>({static_cast<py::ssize_t>(numbers.size()) / columns, columns},
                             numbers.data());
}

/// Makes an array with a row for each.
template <typename T>
py::array rows(const std::vector<T>& all, Vector3d T::*what) {
  std::vector<Vector3d> found;
  for (const T& one : all) {
    found.push_back(one.*what);
  }
  return owning(std::move(found));
}

py::array numbers_of_bodies(const RunStep& step) {
  std::vector<std::int64_t> numbers;
  for (const RunBody& body : step.bodies) {
    numbers.push_back(static_cast<std::int64_t>(body.body));
  }
  return py::array_t<std::int64_t>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

py::array which_rest(const RunStep& step) {
  const auto count = static_cast<py::ssize_t>(step.bodies.size());
  py::array_t<bool> rest(count);
  for (py::ssize_t k = 0; k < count; ++k) {
    rest.mutable_at(k) = step.bodies[static_cast<std::size_t>(k)].rests;
  }
  return rest;
}

py::array behind(const RunStep& step) {
  std::vector<double> seconds;
  for (const RunBody& body : step.bodies) {
    seconds.push_back(body.behind);
  }
  return owning(std::move(seconds));
}

py::array positions(const RunStep& step) {
  std::vector<Vector3d> found;
  for (const RunBody& body : step.bodies) {
    found.push_back(body.X_WB.position);
  }
  return owning(std::move(found));
}

/// The quaternions of poses, one a row.
template <class Posed>
py::array quaternion_rows(const std::vector<Posed>& posed) {
  std::vector<double> wxyz;
  for (const Posed& one : posed) {
    const Eigen::Quaterniond& q = one.X_WB.rotation;
    wxyz.insert(wxyz.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  return table(wxyz, 4);
}

py::array quaternions(const RunStep& step) { return quaternion_rows(step.bodies); }

py::array pieces(const RunStep& step, std::size_t number) {
  std::vector<double> row_by_row;
  for (const RunBody& body : step.bodies) {
    if (body.body != number) {
      continue;
    }
    for (const RunPiece& piece : body.pieces) {
      const Vector3d& p = piece.X_WB.position;
      const Eigen::Quaterniond& q = piece.X_WB.rotation;
      const Vector3d& t = piece.translation;
      const Vector3d& r = piece.rotation_vector;
      row_by_row.insert(row_by_row.end(), {piece.to, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(),
                                           q.z(), t.x(), t.y(), t.z(), r.x(), r.y(), r.z()});
    }
  }
  return table(row_by_row, 14);
}

/// The numbers of two bodies in each row.
template <class Element>
py::array pairs_of_bodies(const std::vector<Element>& elements) {
  std::vector<std::int64_t> bodies;
  for (const Element& element : elements) {
    bodies.push_back(static_cast<std::int64_t>(element.bodies[0]));
    bodies.push_back(static_cast<std::int64_t>(element.bodies[1]));
  }
  return table(bodies, 2);
}

py::object impacts(const RunStep& step) {
  std::vector<double> times;
  for (const RunImpact& impact : step.impacts) {
    times.push_back(impact.at);
  }
  return py::module_::import("firstcontact._tuples")
      .attr("RunImpacts")(owning(std::move(times)), pairs_of_bodies(step.impacts),
                          rows(step.impacts, &RunImpact::point),
                          rows(step.impacts, &RunImpact::impulse));
}

py::object ties(const RunStep& step) {
  return py::module_::import("firstcontact._tuples")
      .attr("RunTies")(rows(step.ties, &RunTie::force), rows(step.ties, &RunTie::torque));
}

py::object devices(const RunStep& step) {
  std::vector<std::int64_t> bodies;
  std::vector<Vector3d> positions;
  for (const RunDevice& device : step.devices) {
    bodies.push_back(static_cast<std::int64_t>(device.body));
    positions.push_back(device.X_WB.position);
  }
  return py::module_::import("firstcontact._tuples")
      .attr("RunDevices")(
          py::array_t<std::int64_t>(static_cast<py::ssize_t>(bodies.size()), bodies.data()),
          owning(std::move(positions)), quaternion_rows(step.devices),
          rows(step.devices, &RunDevice::force), rows(step.devices, &RunDevice::torque));
}

py::object contacts(const RunStep& step) {
  std::vector<double> distances;
  py::list features;
  for (const RunContact& contact : step.contacts) {
    distances.push_back(contact.distance);
    features.append(py::make_tuple(contact.feature_A, contact.feature_B));
  }
  return py::module_::import("firstcontact._tuples")
      .attr("RunContacts")(pairs_of_bodies(step.contacts), rows(step.contacts, &RunContact::point),
                           rows(step.contacts, &RunContact::normal), owning(std::move(distances)),
                           rows(step.contacts, &RunContact::impulse), py::tuple(features));
}

/// A row of numbers for each robot.
py::tuple robot_rows(const RunStep& step, std::vector<double> RunRobot::*what) {
  py::list found;
  for (const RunRobot& robot : step.robots) {
    found.append(owning(std::vector(robot.*what)));
  }
  return py::tuple(found);
}

std::string describe_step(const RunStep& step) {
  return "<RunStep " + std::to_string(step.index) + " to " +
         std::string(py::repr(py::float_(step.time))) +
         " s: " + std::to_string(step.contacts.size()) + " contacts>";
}

void bind_step(py::module_& m) {
  py::class_<RunStep>(m, "RunStep", R"(One step of a simulation; never changes.

Energies and momenta are those of the free bodies and robots at its end. Each access makes new
arrays. The rows of positions, quaternions_wxyz, linear_velocities and angular_velocities are those
of bodies.)")
      .def_readonly("index", &RunStep::index, "From 1.")
      .def_readonly("time", &RunStep::time, "[s] Simulated time at its end.")
      .def_readonly("lasted", &RunStep::lasted,
                    "[s] The step's length, less the time that is lost.")
      .def_readonly("time_lost", &RunStep::time_lost,
                    "[s] Time lost in this step, as its events were spent.")
      .def_readonly("clearance", &RunStep::clearance,
                    "[m] Proven: no pair came closer at any time of the step; infinite where there "
                    "is no pair.")
      .def_readonly("kinetic_energy", &RunStep::kinetic_energy, "[J]")
      .def_readonly("potential_energy", &RunStep::potential_energy,
                    "[J] In the field of gravity; 0 at the world's origin.")
      .def_property_readonly(
          "linear_momentum", [](const RunStep& s) { return copied(s.linear_momentum); },
          "[kg m/s] (3,)")
      .def_property_readonly(
          "angular_momentum", [](const RunStep& s) { return copied(s.angular_momentum); },
          "[kg m²/s] (3,), about the world's origin.")
      .def_readonly("residual", &RunStep::residual,
                    "[m/s] The greatest residual of the step's contact problems.")
      .def_readonly("events", &RunStep::events,
                    "Number of times within the step at which contacts were projected.")
      .def_property_readonly("bodies", &numbers_of_bodies,
                             "(k,) Numbers of the bodies that move; all others rest.")
      .def_property_readonly("positions", &positions,
                             "[m] k×3, positions of the body frames' origins in the world.")
      .def_property_readonly("quaternions_wxyz", &quaternions,
                             "[-] k×4, quaternions of the body frames.")
      .def_property_readonly(
          "linear_velocities",
          [](const RunStep& s) { return rows(s.bodies, &RunBody::linear_velocity); },
          "[m/s] k×3, velocities of the centres of mass, world axes.")
      .def_property_readonly(
          "angular_velocities",
          [](const RunStep& s) { return rows(s.bodies, &RunBody::angular_velocity); },
          "[rad/s] k×3, angular velocities, world axes.")
      .def_property_readonly(
          "rest", &which_rest,
          "(k,) bool: whether contacts hold the body in place until something disturbs them.")
      .def_property_readonly("behind", &behind,
                             "[s] (k,): the time by which the script of a body is behind, as it "
                             "waited where it would have crushed an obstacle.")
      .def_property_readonly(
          "robot_positions", [](const RunStep& s) { return robot_rows(s, &RunRobot::positions); },
          "[rad or m] A row for each robot with dynamics, as `Simulator.robot_positions`.")
      .def_property_readonly(
          "robot_velocities", [](const RunStep& s) { return robot_rows(s, &RunRobot::velocities); },
          "[rad/s or m/s] A row for each robot with dynamics, as `Simulator.robot_velocities`.")
      .def_property_readonly(
          "robot_efforts", [](const RunStep& s) { return robot_rows(s, &RunRobot::efforts); },
          "[N m or N] Efforts of the motors along each of the robots' velocities: the mean over "
          "the step; 0 without a motor.")
      .def_property_readonly("contacts", &contacts,
                             "Contacts that acted at the end, as RunContacts.")
      .def_property_readonly("ties", &ties, "The forces of springs, cables and joints, as RunTies.")
      .def_property_readonly("devices", &devices,
                             "Devices of haptic tools as the step begins, as RunDevices.")
      .def_property_readonly("impacts", &impacts,
                             "Effects of impacts within the step, as RunImpacts.")
      .def("pieces", &pieces, py::arg("body"),
           R"(Returns the motion of a body in the step: p×14, one piece a row, none where it rests.

Columns: [s] end of the piece since the step began; [m, -] position (3) and quaternion_wxyz (4) of
the body frame where the piece begins; [m] translation (3) of the centre of mass and [rad] rotation
vector (3) about it, both at a constant rate.)")
      .def(
          "to_json", [](const RunStep& s) { return without_line_feed(write_run_step(s)); },
          "The step's line in the file of a run, without the line feed.")
      .def("__repr__", &describe_step);
}

/// A file and its reader.
class HeldRun {
 public:
  explicit HeldRun(const std::filesystem::path& path)
      : stream_((require_file(path), path), std::ios::binary), reader_(stream_, path.string()) {}

  [[nodiscard]] const RunReader& reader() const { return reader_; }
  RunReader& reader() { return reader_; }

 private:
  std::ifstream stream_;
  RunReader reader_;
};

RunStep next_of(HeldRun& run) {
  std::optional<RunStep> step = run.reader().next();
  if (!step) {
    throw py::stop_iteration();
  }
  return std::move(*step);
}

void bind_reader(py::module_& m) {
  py::class_<HeldRun>(m, "RunReader", R"(Reads a run back: iterate over it for its steps, once.

It holds one step at a time. Numbers are those that were written, bit for bit. ParseError, one line
that names file and line, where the file is no run.)")
      .def(py::init<const std::filesystem::path&>(), py::arg("path"))
      .def_property_readonly(
          "names", [](const HeldRun& r) { return names_of(r.reader().header()); },
          "Names of the bodies, in order.")
      .def_property_readonly(
          "masses",
          [](const HeldRun& r) { return owning(std::vector(r.reader().header().masses)); },
          "[kg] (n,), 0 for bodies that are not free; links of robots with dynamics have theirs.")
      .def_property_readonly(
          "centres_of_mass",
          [](const HeldRun& r) { return owning(std::vector(r.reader().header().centres_of_mass)); },
          "[m] n×3, centres of mass in body frames.")
      .def_property_readonly(
          "scene",
          [](const HeldRun& r) { return std::make_shared<HeldScene>(r.reader().header().scene); },
          "The resolved Scene.")
      .def_property_readonly(
          "header_json",
          [](const HeldRun& r) { return without_line_feed(write_run_header(r.reader().header())); },
          "The first line of the file, without the line feed.")
      .def_property_readonly(
          "is_cut_off", [](const HeldRun& r) { return r.reader().is_cut_off(); },
          "Whether the file ends in the middle of a line, as a killed simulation leaves it. It is "
          "known at the end of the iteration.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &next_of);
}

/// The first line of a run, without its line feed.
RunHeader header_from(const std::string& header_json) {
  std::istringstream stream(header_json + '\n');
  return RunReader(stream, "header").header();
}

/// Names, positions and quaternions of all bodies at the begin of the run.
py::tuple start_of_run(const std::string& header_json) {
  const RunHeader header = header_from(header_json);
  std::vector<Vector3d> positions;
  std::vector<double> wxyz;
  {
    const py::gil_scoped_release release;
    ShapeCache cache;
    const LinksAsBodies linked = links_as_bodies(load_scene_of(header, cache));
    for (std::size_t b = 0; b < header.masses.size(); ++b) {
      const Pose X_WB = linked.loaded.bodies.motion(b).pose(0.0);
      const Eigen::Quaterniond& q = X_WB.rotation;
      positions.push_back(X_WB.position);
      wxyz.insert(wxyz.end(), {q.w(), q.x(), q.y(), q.z()});
    }
  }
  return py::make_tuple(names_of(header), owning(std::move(positions)), table(wxyz, 4));
}

std::string fill_run_page(const std::string& header_json, const py::sequence& steps,
                          const std::string& page_template) {
  const RunHeader header = header_from(header_json);
  RunPage page(header);
  for (const py::handle step : steps) {
    page.add(step.cast<const RunStep&>());
  }
  const py::gil_scoped_release release;
  ShapeCache cache;
  return page.write(page_template, load_scene_of(header, cache));
}

}  // namespace

void bind_run(py::module_& m) {
  bind_step(m);
  bind_reader(m);
  m.def("_start_of_run", &start_of_run, py::arg("header_json"));
  m.def("_fill_run_page", &fill_run_page, py::arg("header_json"), py::arg("steps"),
        py::arg("template"));
}

}  // namespace firstcontact::python
