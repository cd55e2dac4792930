#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <firstcontact/robot_files/read_srdf.h>

#include "arguments.h"
#include "arrays.h"
#include "bindings.h"
#include "errors.h"
#include "robots.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;
using std::filesystem::path;

namespace {

py::object to_tuple(const Mimic& mimic) {
  return tuple_type("Mimic")(mimic.joint, mimic.multiplier, mimic.offset);
}

py::object to_tuple(const Joint& joint) {
  return tuple_type("Joint")(joint.name, joint.type, joint.parent, joint.child, joint.X_PJ,
                             copied(joint.axis), joint.limits.lower, joint.limits.upper,
                             joint.limits.velocity, joint.limits.effort,
                             joint.mimic ? to_tuple(*joint.mimic) : py::none());
}

py::tuple joints_of(const RobotModel& model) {
  py::list joints;
  for (const Joint& joint : model.joints()) {
    joints.append(to_tuple(joint));
  }
  return py::tuple(joints);
}

py::tuple link_names(const RobotModel& model) {
  py::list names;
  for (const Link& link : model.links()) {
    names.append(link.name);
  }
  return py::tuple(names);
}

/// The names of the coordinates of joint `index`.
std::vector<std::string> coordinate_names(const RobotModel& model, std::size_t index) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < coordinate_count(model.joints()[index].type); ++k) {
    names.push_back(coordinate_name(model, {index, k}));
  }
  return names;
}

py::tuple coordinates_of(const RobotModel& model) {
  py::list names;
  for (std::size_t k = 0; k < model.joints().size(); ++k) {
    for (const std::string& name : coordinate_names(model, k)) {
      if (!model.joints()[k].mimic) {
        names.append(name);
      }
    }
  }
  return py::tuple(names);
}

HeldRobotModel read_model(const path& urdf, std::vector<path> package_roots, bool visual,
                          bool visual_where_missing) {
  require_file(urdf);
  if (visual && visual_where_missing) {
    throw std::invalid_argument("read_urdf: expected one of visual and visual_where_missing");
  }
  RobotFile file{.urdf = urdf,
                 .package_roots = std::move(package_roots),
                 .surface = visual                 ? RobotSurface::visual
                            : visual_where_missing ? RobotSurface::collision_or_visual
                                                   : RobotSurface::collision};
  const py::gil_scoped_release release;
  RobotModel model = read_robot_model(file);
  return {std::move(file), std::move(model)};
}

py::dict groups_of(const RobotSemantics& semantics, const RobotModel& model) {
  py::dict groups;
  for (const RobotGroup& group : semantics.groups) {
    py::list links;
    for (const std::size_t link : group.links) {
      links.append(model.links()[link].name);
    }
    py::list joints;
    for (const std::size_t joint : group.joints) {
      joints.append(model.joints()[joint].name);
    }
    groups[py::str(group.name)] = tuple_type("RobotGroup")(py::tuple(links), py::tuple(joints));
  }
  return groups;
}

py::dict states_of(const RobotSemantics& semantics, const RobotModel& model) {
  py::dict states;
  for (const GroupState& state : semantics.states) {
    py::dict positions;
    for (const GroupState::JointValue& value : state.values) {
      const std::vector<std::string> names = coordinate_names(model, value.joint);
      for (std::size_t k = 0; k < names.size(); ++k) {
        positions[py::str(names[k])] = value.coordinates.at(k);
      }
    }
    states[py::str(state.group + "/" + state.name)] = positions;
  }
  return states;
}

py::tuple disabled_of(const RobotSemantics& semantics, const RobotModel& model) {
  py::list pairs;
  for (const DisabledPair& pair : semantics.disabled) {
    pairs.append(py::make_tuple(model.links()[pair.link].name, model.links()[pair.other].name));
  }
  return py::tuple(pairs);
}

py::dict end_effectors_of(const RobotSemantics& semantics, const RobotModel& model) {
  py::dict tools;
  for (const EndEffector& tool : semantics.end_effectors) {
    tools[py::str(tool.name)] =
        tuple_type("EndEffector")(tool.group, model.links()[tool.parent_link].name);
  }
  return tools;
}

py::object read_semantics(const path& file, const HeldRobotModel& robot) {
  require_file(file);
  const RobotSemantics semantics = read_srdf(file, robot.model);
  return tuple_type("RobotSemantics")(
      file.string(), disabled_of(semantics, robot.model), groups_of(semantics, robot.model),
      states_of(semantics, robot.model), end_effectors_of(semantics, robot.model),
      py::tuple(py::cast(semantics.warnings)));
}

}  // namespace

path path_of(const py::object& value, const std::string& name, const std::string& what) {
  return argument<path>(py::hasattr(value, "path") ? value.attr("path") : value, name, what);
}

void bind_robot_model(py::module_& m) {
  py::class_<HeldRobotModel>(m, "RobotModel", R"(A robot, read from URDF: a tree of links.

Its meshes are read when a question needs them. A pickled model holds its path, to be read again.)")
      .def_property_readonly("name", [](const HeldRobotModel& r) { return r.model.name(); })
      .def_property_readonly(
          "path", [](const HeldRobotModel& r) { return r.file.urdf.string(); }, "Of its file.")
      .def_property_readonly(
          "links", [](const HeldRobotModel& r) { return link_names(r.model); }, "Their names.")
      .def_property_readonly(
          "joints", [](const HeldRobotModel& r) { return joints_of(r.model); }, "Joints.")
      .def_property_readonly(
          "root", [](const HeldRobotModel& r) { return r.model.links()[r.model.root()].name; },
          "The link that no joint carries.")
      .def_property_readonly(
          "coordinates", [](const HeldRobotModel& r) { return coordinates_of(r.model); },
          "Names in trajectories of the coordinates that move by themselves: a joint's name; for a "
          "planar joint NAME/x, NAME/y, NAME/theta.")
      .def("__repr__",
           [](const HeldRobotModel& r) {
             return "<RobotModel " + std::string(py::repr(py::str(r.model.name()))) + " of " +
                    std::to_string(r.model.links().size()) + " links, " +
                    std::to_string(r.model.joints().size()) + " joints>";
           })
      .def(py::pickle(
          [](const HeldRobotModel& r) {
            return py::make_tuple(r.file.urdf, r.file.package_roots,
                                  r.file.surface == RobotSurface::visual,
                                  r.file.surface == RobotSurface::collision_or_visual);
          },
          [](const py::tuple& state) {
            return read_model(state[0].cast<path>(), state[1].cast<std::vector<path>>(),
                              state[2].cast<bool>(), state[3].cast<bool>());
          }));
  m.def("read_urdf", &read_model, py::arg("path"), py::arg("package_roots") = py::tuple(),
        py::arg("visual") = false, py::arg("visual_where_missing") = false, R"(Reads a robot.

package_roots: folders that hold packages, for `package://`; those above the file are searched
anyway. visual: uses the visual geometry of links, not their collision geometry.
visual_where_missing: uses it for links without collision geometry. ParseError where the file cannot
be used.)");
  m.def("read_srdf", &read_semantics, py::arg("path"), py::arg("robot"),
        "Reads an SRDF: the pairs not to test, groups and named states of a robot.");
}

}  // namespace firstcontact::python
