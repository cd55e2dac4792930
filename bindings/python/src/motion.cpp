#include "motion.h"

#include <array>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <firstcontact/motion/rotation_forms.h>

#include "arrays.h"
#include "bindings.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;
using Eigen::Vector3d;

Eigen::Quaterniond quaternion_from(py::handle value) {
  const std::vector<double> wxyz = numbers_from(value, "quaternion_wxyz");
  if (wxyz.size() != 4) {
    throw py::value_error("quaternion_wxyz: expected 4 numbers, got " +
                          std::to_string(wxyz.size()));
  }
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

namespace {

py::tuple plain(const Vector3d& v) { return py::make_tuple(v.x(), v.y(), v.z()); }

py::tuple plain(const Eigen::Quaterniond& q) { return py::make_tuple(q.w(), q.x(), q.y(), q.z()); }

Pose make_pose(const py::object& position, const py::object& quaternion_wxyz, const py::object& rpy,
               const py::object& rotation_vector) {
  if ((quaternion_wxyz.is_none() ? 0 : 1) + (rpy.is_none() ? 0 : 1) +
          (rotation_vector.is_none() ? 0 : 1) >
      1) {
    throw py::value_error("Pose: expected one of quaternion_wxyz, rpy, rotation_vector");
  }
  Pose pose;
  pose.position = vector_from(position, "position");
  if (!quaternion_wxyz.is_none()) {
    pose.rotation = quaternion_from(quaternion_wxyz);
  } else if (!rpy.is_none()) {
    pose.rotation = rotation_from_rpy(vector_from(rpy, "rpy"));
  } else if (!rotation_vector.is_none()) {
    pose.rotation = rotation_from_vector(vector_from(rotation_vector, "rotation_vector"));
  }
  (void)Motion::fixed(pose);  // Refuses what no motion could take.
  return pose;
}

Pose pose_of(const py::object& value) {
  const py::array_t<double> array = matrix_from(value, "matrix");
  if (array.shape(0) != 4 || array.shape(1) != 4) {
    throw py::value_error("matrix: expected an array of shape (4, 4)");
  }
  try {
    return pose_from_matrix(
        Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.data()));
  } catch (const std::invalid_argument& error) {
    throw py::value_error(std::string("matrix: ") + error.what());
  }
}

py::array_t<double> matrix_of(const Pose& pose) {
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix;
  matrix.setIdentity();
  matrix.topLeftCorner<3, 3>() = pose.rotation.normalized().toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose.position;
  return py::array_t<double>({4, 4}, matrix.data());
}

RecordedMotion constant_velocity(const Pose& start, const py::object& translation,
                                 const py::object& rotation_vector) {
  const Vector3d moved = vector_from(translation, "translation");
  const Vector3d turned = vector_from(rotation_vector, "rotation_vector");
  return {Motion::constant_velocity(start, moved, turned), "constant_velocity",
          py::make_tuple(start, plain(moved), plain(turned))};
}

RecordedMotion screw(const Pose& start, const py::object& axis_point,
                     const py::object& axis_direction, double angle, double translation) {
  const Vector3d point = vector_from(axis_point, "axis_point");
  const Vector3d direction = vector_from(axis_direction, "axis_direction");
  return {Motion::screw(start, point, direction, angle, translation), "screw",
          py::make_tuple(start, plain(point), plain(direction), angle, translation)};
}

RecordedMotion waypoints(const py::object& times, const std::vector<Pose>& poses, Between between) {
  const std::vector<double> numbers = numbers_from(times, "times");
  return {
      Motion::waypoints(numbers, poses, between), "waypoints",
      py::make_tuple(py::tuple(py::cast(numbers)), py::tuple(py::cast(poses)), py::cast(between))};
}

std::string describe_motion(const RecordedMotion& motion) {
  return std::string("Motion.") + motion.factory + std::string(py::repr(motion.arguments));
}

bool equal(const Pose& a, const Pose& b) {
  return a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs();
}

void bind_pose(py::module_& m) {
  py::class_<Pose>(m, "Pose", R"(Pose of a body in the world: p_world = position + R p_body.

The rotation is that of the quaternion divided by its exact length. `rpy` and `rotation_vector` are
converted in double precision. Proofs hold for the converted numbers.)")
      .def(py::init(&make_pose), py::arg("position") = py::make_tuple(0.0, 0.0, 0.0),
           py::kw_only(),  // A quaternion by its place may be meant as xyzw.
           py::arg("quaternion_wxyz") = py::none(), py::arg("rpy") = py::none(),
           py::arg("rotation_vector") = py::none(),
           R"(position: [m] (3,), of the body's origin in the world.
quaternion_wxyz: [-] (4,), any length but zero. rpy: [rad] (3,), about the fixed axes x, then y,
then z. rotation_vector: [rad] (3,), axis times angle. At most one of these three.)")
      .def_static("from_matrix", &pose_of, py::arg("matrix"),
                  "Makes a pose of a matrix: [-, m] 4×4, its rotation rigid to 1e-9.")
      .def_property_readonly(
          "position", [](const Pose& pose) { return copied(pose.position); }, "[m] (3,)")
      .def_property_readonly(
          "quaternion_wxyz",
          [](const Pose& pose) {
            return py::array(py::cast(std::array<double, 4>{pose.rotation.w(), pose.rotation.x(),
                                                            pose.rotation.y(), pose.rotation.z()}));
          },
          "[-] (4,), the quaternion as given.")
      .def_property_readonly("matrix", &matrix_of,
                             "The pose as a matrix: [-, m] 4×4, rounded to doubles.")
      .def("__eq__",
           [](const Pose& a, const py::object& b) {
             return py::isinstance<Pose>(b) && equal(a, b.cast<const Pose&>());
           })
      .def("__hash__",
           [](const Pose& pose) {
             return py::hash(py::make_tuple(plain(pose.position), plain(pose.rotation)));
           })
      .def("__repr__",
           [](const Pose& pose) {
             return "Pose(" + std::string(py::repr(plain(pose.position))) +
                    ", quaternion_wxyz=" + std::string(py::repr(plain(pose.rotation))) + ")";
           })
      .def(py::pickle(
          [](const Pose& pose) {
            return py::make_tuple(plain(pose.position), plain(pose.rotation));
          },
          [](const py::tuple& state) {
            return make_pose(state[0], state[1], py::none(), py::none());
          }));
}

}  // namespace

void bind_motion(py::module_& m) {
  bind_pose(m);
  py::class_<RecordedMotion>(m, "Motion",
                             R"(Motion of a body over the step, t in [0, 1]; never changes.

The motion is the exact real-number function that the doubles given to its factory define.
All factories raise ValueError on NaN, infinities, zero quaternions or axes.)")
      .def_static(
          "fixed",
          [](const Pose& pose) {
            return RecordedMotion{Motion::fixed(pose), "fixed", py::make_tuple(pose)};
          },
          py::arg("pose") = Pose{}, "Makes a motion that rests at `pose`.")
      .def_static(
          "constant_velocity",
          [](const Pose& start, const Pose& to) {
            return RecordedMotion{Motion::constant_velocity(start, to), "constant_velocity",
                                  py::make_tuple(start, to)};
          },
          py::arg("start"), py::arg("to"),
          "Makes a motion from one pose to another, by the shortest rotation.")
      .def_static(
          "constant_velocity", &constant_velocity, py::arg("start"), py::arg("translation"),
          py::arg("rotation_vector") = py::make_tuple(0.0, 0.0, 0.0),
          R"(Makes a motion at constant rates: the origin moves on a line, the body turns about it.

translation: [m] (3,), over the step, world frame. rotation_vector: [rad] (3,), axis times angle
over the step, world frame; any number of turns.)")
      .def_static(
          "screw",
          [](const Pose& start, const Pose& to) {
            return RecordedMotion{Motion::screw(start, to), "screw", py::make_tuple(start, to)};
          },
          py::arg("start"), py::arg("to"),
          "Makes a motion from one pose to another, by the shortest rotation.")
      .def_static(
          "screw", &screw, py::arg("start"), py::arg("axis_point"), py::arg("axis_direction"),
          py::arg("angle"), py::arg("translation"),
          R"(Makes a screw motion: rotation about one axis, and translation along it, from a pose.

axis_point: [m] (3,), world frame. axis_direction: [-] (3,), any length but zero, world frame.
angle: [rad] over the step; any number of turns. translation: [m] along the axis over the step.)")
      .def_static("waypoints", &waypoints, py::arg("times"), py::arg("poses"),
                  py::arg("between") = Between::constant_velocity,
                  R"(Makes a motion through n poses; at rest before the first and after the last.

times: [-] (n,), in [0, 1], strictly increasing. poses: n of them. between: kind of motion from pose
to pose.)")
      .def_property_readonly(
          "breaks",
          [](const py::object& self) {
            return view(self.cast<const RecordedMotion&>().motion.breaks(), self);
          },
          "[-] (n + 1,), the ends of the n smooth pieces: 0 first, 1 last. A view.")
      .def(
          "pose", [](const RecordedMotion& self, double t) { return self.motion.pose(t); },
          py::arg("t"), "The pose at t, rounded to doubles; t is clamped to [0, 1].")
      .def("__eq__",
           [](const RecordedMotion& a, const py::object& b) {
             return py::isinstance<RecordedMotion>(b) &&
                    a.motion.compare(b.cast<const RecordedMotion&>().motion) == 0;
           })
      .def("__hash__",
           [](const RecordedMotion& motion) {
             return py::hash(
                 py::make_tuple(py::tuple(py::cast(std::vector<double>(
                                    motion.motion.breaks().begin(), motion.motion.breaks().end()))),
                                plain(motion.motion.pose(0.0).position)));
           })
      .def("__repr__", &describe_motion)
      .def(py::pickle(
          [](const RecordedMotion& motion) {
            return py::make_tuple(motion.factory, motion.arguments);
          },
          [](const py::tuple& state) {
            const py::object factory = py::type::of<RecordedMotion>().attr(state[0]);
            return factory(*py::tuple(state[1])).cast<RecordedMotion>();
          }));
}

}  // namespace firstcontact::python
