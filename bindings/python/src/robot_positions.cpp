#include <map>
#include <string>

#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/trajectory.h>

#include "arguments.h"
#include "robots.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

void warn(const std::string& text) {
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) {
    throw py::error_already_set();  // Warnings may be errors.
  }
}

void add_positions(const py::handle& value, const SceneRobot& robot, JointPositions& positions) {
  if (PyUnicode_Check(value.ptr())) {
    for (const auto& [name, position] :
         group_state(robot.model, robot.semantics, value.cast<std::string>())) {
      positions[name] = position;
    }
  } else if (PyMapping_Check(value.ptr()) && py::hasattr(value, "items")) {
    for (const auto& [name, position] : argument<std::map<std::string, double>>(
             py::dict(py::reinterpret_borrow<py::object>(value)), "positions",
             "a dict of numbers by name")) {
      if (names_fixed_joint(robot.model, name)) {
        warn("a position is given for a fixed joint, " + name + "; it is where the URDF has it");
        continue;
      }
      (void)find_coordinate(robot.model, name);
      positions[name] = position;
    }
  } else if (py::isinstance<py::sequence>(value)) {
    for (const py::handle element : py::reinterpret_borrow<py::sequence>(value)) {
      add_positions(element, robot, positions);
    }
  } else {
    throw py::type_error(
        "positions: expected a dict by joint, the name of a state of the SRDF, or "
        "a sequence of these, got " +
        std::string(py::repr(value)));
  }
}

}  // namespace

JointPositions positions_from(const py::object& value, const SceneRobot& robot) {
  JointPositions positions;
  add_positions(value, robot, positions);
  return positions;
}

}  // namespace firstcontact::python
