#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/scene/whole_turn_jumps.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/trajectory_files/read_trajectory.h>

#include "arrays.h"
#include "bindings.h"
#include "errors.h"
#include "robots.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;
using std::filesystem::path;

namespace {

using Numbers = std::vector<double> TrajectoryPoint::*;

void require_finite(const std::vector<double>& numbers, const char* name) {
  for (const double number : numbers) {
    if (!std::isfinite(number)) {
      throw py::value_error(std::string(name) + ": expected finite numbers, got " +
                            std::string(py::repr(py::float_(number))));
    }
  }
}

/// Puts the rows of an n×joints array into the points.
void take_rows(const py::object& value, const char* name, Numbers numbers, Trajectory& trajectory) {
  const py::array_t<double> rows = matrix_from(value, name);
  const std::size_t joints = trajectory.joint_names.size();
  const std::size_t points = trajectory.points.size();
  if (static_cast<std::size_t>(rows.shape(0)) != points ||
      static_cast<std::size_t>(rows.shape(1)) != joints) {
    throw py::value_error(
        std::string(name) + ": expected an array of shape (" + std::to_string(points) + ", " +
        std::to_string(joints) + "), a row for each time and a column for each joint, got shape (" +
        std::to_string(rows.shape(0)) + ", " + std::to_string(rows.shape(1)) + ")");
  }
  for (std::size_t k = 0; k < points; ++k) {
    const double* row = rows.data(static_cast<py::ssize_t>(k), 0);
    trajectory.points[k].*numbers = {row, row + joints};
    require_finite(trajectory.points[k].*numbers, name);
  }
}

void take_times(const py::object& value, Trajectory& trajectory) {
  double last = -1.0;
  for (const double time : numbers_from(value, "times")) {
    if (!(time >= 0.0 && time > last && std::isfinite(time))) {
      throw py::value_error("times: expected numbers >= 0 that increase, got " +
                            std::string(py::repr(py::float_(time))));
    }
    trajectory.points.push_back({.time = time});
    last = time;
  }
  if (trajectory.points.empty()) {
    throw py::value_error("times: expected at least one, got none");
  }
}

Trajectory make_trajectory(std::vector<std::string> joint_names, const py::object& times,
                           const py::object& positions, const py::object& velocities,
                           const py::object& accelerations, Turning turning) {
  Trajectory trajectory{.joint_names = std::move(joint_names), .points = {}, .turning = turning};
  const std::set<std::string> names(trajectory.joint_names.begin(), trajectory.joint_names.end());
  if (names.size() != trajectory.joint_names.size() || names.empty()) {
    throw py::value_error("joint_names: expected one or more, each once");
  }
  take_times(times, trajectory);
  take_rows(positions, "positions", &TrajectoryPoint::positions, trajectory);
  if (!velocities.is_none()) {
    take_rows(velocities, "velocities", &TrajectoryPoint::velocities, trajectory);
  }
  if (!accelerations.is_none()) {
    if (velocities.is_none()) {
      throw py::value_error("accelerations: expected velocities beside them");
    }
    take_rows(accelerations, "accelerations", &TrajectoryPoint::accelerations, trajectory);
  }
  return trajectory;
}

py::array times_of(const Trajectory& trajectory) {
  std::vector<double> times;
  for (const TrajectoryPoint& point : trajectory.points) {
    times.push_back(point.time);
  }
  return owning(std::move(times));
}

/// An array of one kind of numbers; None where the points have none.
py::object rows_of(const Trajectory& trajectory, Numbers numbers) {
  if ((trajectory.points.front().*numbers).empty()) {
    return py::none();
  }
  std::vector<double> all;
  for (const TrajectoryPoint& point : trajectory.points) {
    all.insert(all.end(), (point.*numbers).begin(), (point.*numbers).end());
  }
  return py::array_t<double>({static_cast<py::ssize_t>(trajectory.points.size()),
                              static_cast<py::ssize_t>(trajectory.joint_names.size())},
                             all.data());
}

/// The arguments that make the trajectory again.
py::tuple state_of(const Trajectory& trajectory) {
  return py::make_tuple(trajectory.joint_names, times_of(trajectory),
                        rows_of(trajectory, &TrajectoryPoint::positions),
                        rows_of(trajectory, &TrajectoryPoint::velocities),
                        rows_of(trajectory, &TrajectoryPoint::accelerations), trajectory.turning,
                        trajectory.warnings);
}

Trajectory trajectory_from(const py::tuple& state) {
  Trajectory trajectory = make_trajectory(state[0].cast<std::vector<std::string>>(), state[1],
                                          state[2], state[3], state[4], state[5].cast<Turning>());
  trajectory.warnings = state[6].cast<std::vector<std::string>>();
  return trajectory;
}

bool equal(const Trajectory& a, const Trajectory& b) {
  const auto same = [](const TrajectoryPoint& p, const TrajectoryPoint& q) {
    return p.time == q.time && p.positions == q.positions && p.velocities == q.velocities &&
           p.accelerations == q.accelerations;
  };
  return a.joint_names == b.joint_names && a.turning == b.turning &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), same);
}

py::object read_request(const path& file, const HeldRobotModel& robot) {
  require_file(file);
  const PlanningRequest request = read_planning_request(file, robot.model);
  if (request.goals.front().link) {
    throw ParseError(file.string(),
                     "expected a goal of joint positions, got the pose of a link; a scene's "
                     "\"plan\" has such goals");
  }
  if (request.goals.size() > 1) {
    throw ParseError(file.string(), "goal_constraints: expected one goal, got " +
                                        std::to_string(request.goals.size()) +
                                        "; `firstcontact plan` finds a path to any of them");
  }
  const auto dict = [](const JointPositions& positions) {
    py::dict result;
    for (const auto& [name, position] : positions) {
      result[py::str(name)] = position;
    }
    return result;
  };
  return py::module_::import("firstcontact._tuples")
      .attr("PlanningRequest")(dict(request.start), dict(request.goals.front().positions),
                               request.base, py::tuple(py::cast(request.warnings)),
                               request.velocity_scaling, request.acceleration_scaling,
                               request.planning_time);
}

void bind_class(py::module_& m) {
  py::class_<Trajectory>(m, "Trajectory", R"(Positions of the joints of a robot at some times.

Between them the motion is linear, with velocities cubic, with accelerations too quintic. The robot
rests before the first time and after the last. A trajectory never changes.)")
      .def(py::init(&make_trajectory), py::arg("joint_names"), py::arg("times"),
           py::arg("positions"), py::arg("velocities") = py::none(),
           py::arg("accelerations") = py::none(), py::arg("turning") = Turning::as_given,
           R"(joint_names: of the columns; a planar joint has NAME/x, NAME/y, NAME/theta.
times: [s] (n,), >= 0, strictly increasing. positions: [rad or m] n×joints, a row for each time.
velocities, accelerations: [per s, per s^2] as positions. turning: the way of continuous joints and
of the angles of planar ones between the points, "long" by the numbers, or "short".)")
      .def_property_readonly(
          "joint_names", [](const Trajectory& t) { return py::tuple(py::cast(t.joint_names)); },
          "Names of the columns.")
      .def_property_readonly("times", &times_of, "[s] (n,)")
      .def_property_readonly(
          "positions", [](const Trajectory& t) { return rows_of(t, &TrajectoryPoint::positions); },
          "[rad or m] n×joints, a row for each time.")
      .def_property_readonly(
          "velocities",
          [](const Trajectory& t) { return rows_of(t, &TrajectoryPoint::velocities); },
          "[rad/s or m/s] n×joints, or None.")
      .def_property_readonly(
          "accelerations",
          [](const Trajectory& t) { return rows_of(t, &TrajectoryPoint::accelerations); },
          "[rad/s^2 or m/s^2] n×joints, or None.")
      .def_property_readonly(
          "turning", [](const Trajectory& t) { return t.turning; },
          "Turning: the way of continuous joints between the points.")
      .def_property_readonly(
          "warnings", [](const Trajectory& t) { return py::tuple(py::cast(t.warnings)); },
          "Warnings about the file that was read.")
      .def(
          "unwrapped",
          [](const Trajectory& t, const HeldRobotModel& robot) {
            return unwrapped(robot.model, t);
          },
          py::arg("robot"),
          R"(Makes the trajectory of a recording whose angles wrap, without jumps of whole turns.

No step between its points then exceeds half a turn for joints of the RobotModel that can turn by
more than a turn.)")
      .def("__len__", [](const Trajectory& t) { return t.points.size(); })
      .def("__eq__",
           [](const Trajectory& a, const py::object& b) {
             return py::isinstance<Trajectory>(b) && equal(a, b.cast<const Trajectory&>());
           })
      .def("__hash__",
           [](const Trajectory& t) {
             return py::hash(py::make_tuple(t.points.size(), t.points.back().time,
                                            py::tuple(py::cast(t.points.back().positions))));
           })
      .def("__repr__",
           [](const Trajectory& t) {
             return "<Trajectory of " + std::to_string(t.joint_names.size()) + " joints, " +
                    std::to_string(t.points.size()) + " points until " +
                    std::string(py::repr(py::float_(t.points.back().time))) + " s>";
           })
      .def(py::pickle([](const Trajectory& t) { return state_of(t); }, &trajectory_from));
}

}  // namespace

void bind_trajectory(py::module_& m) {
  bind_class(m);
  m.def(
      "read_trajectory",
      [](const path& file, const HeldRobotModel& robot, bool unwrap) {
        require_file(file);
        const py::gil_scoped_release release;
        Trajectory read = read_trajectory(file, robot.model);
        return unwrap ? unwrapped(robot.model, std::move(read)) : read;
      },
      py::arg("path"), py::arg("robot"), py::arg("unwrap") = false,
      R"(Reads a trajectory: .csv, or .json and .yaml as the tool and ROS write them.

robot: the RobotModel with the joints. unwrap: removes jumps of whole turns from a recording whose
angles wrap. ParseError where the file cannot be used.)");
  m.def("read_request", &read_request, py::arg("path"), py::arg("robot"),
        "Reads a MoveIt request, whose goal is one of joint positions.");
}

}  // namespace firstcontact::python
