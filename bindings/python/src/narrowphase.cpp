#include <firstcontact/narrowphase/edge_edge_contact.h>
#include <firstcontact/narrowphase/linear_contact.h>
#include <firstcontact/narrowphase/vertex_face_contact.h>

#include <stdexcept>
#include <string>

#include "arrays.h"
#include "bindings.h"
#include "motion.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;
using Eigen::Vector3d;

namespace {

/// Reads N corners, one per row.
template <std::size_t N>
std::array<Vector3d, N> corners_from(const py::object& value, const char* name) {
  const std::vector<Vector3d> points = points_from(value, name);
  if (points.size() != N) {
    throw py::value_error(std::string(name) + ": expected " + std::to_string(N) + " points, got " +
                          std::to_string(points.size()));
  }
  std::array<Vector3d, N> corners;
  std::copy(points.begin(), points.end(), corners.begin());
  return corners;
}

template <std::size_t N>
std::array<LinearPoint, N> moving_corners(const py::object& value, const char* name) {
  if (!PyTuple_Check(value.ptr()) || PyTuple_GET_SIZE(value.ptr()) != 2) {
    throw py::type_error(std::string(name) + ": expected a pair (corners at 0, corners at 1)");
  }
  const auto from = corners_from<N>(value.cast<py::tuple>()[0], name);
  const auto to = corners_from<N>(value.cast<py::tuple>()[1], name);
  std::array<LinearPoint, N> corners;
  for (std::size_t k = 0; k < N; ++k) {
    corners[k] = {.from = from[k], .to = to[k]};
  }
  return corners;
}

LinearPoint moving_point(const py::object& value, const char* name) {
  if (!PyTuple_Check(value.ptr()) || PyTuple_GET_SIZE(value.ptr()) != 2) {
    throw py::type_error(std::string(name) + ": expected a pair (point at 0, point at 1)");
  }
  const auto pair = value.cast<py::tuple>();
  return {.from = vector_from(pair[0], name), .to = vector_from(pair[1], name)};
}

void bind_linear(py::module_& m) {
  py::class_<LinearContact>(m, "LinearContact", "First contact of two deforming features.")
      .def_readonly("verdict", &LinearContact::verdict)
      .def_readonly("t", &LinearContact::t,
                    "[-] Time before which they are proven apart; 1 when free.")
      .def_readonly("tolerance_used", &LinearContact::tolerance_used,
                    "[m] Tolerance that holds in place of the one asked for; larger only where "
                    "doubles of t need it.")
      .def_readonly("steps", &LinearContact::steps)
      .def("__repr__", [](const LinearContact& found) {
        return "<LinearContact: " + std::string(py::str(py::cast(found.verdict))) +
               " at t = " + std::string(py::repr(py::float_(found.t))) + ">";
      });
  m.def(
      "linear_vertex_face_contact",
      [](const py::object& vertex, const py::object& face, double margin, double tolerance,
         int maximum_steps) {
        return linear_vertex_face_contact(
            moving_point(vertex, "vertex"), moving_corners<3>(face, "face"),
            {.margin = margin, .tolerance = tolerance, .maximum_steps = maximum_steps});
      },
      py::arg("vertex"), py::arg("face"), py::kw_only(), py::arg("margin") = 0.0,
      py::arg("tolerance") = 1e-6, py::arg("maximum_steps") = 10'000,
      R"(Finds the first time at which a vertex and a face, moving on lines, are within the margin.

vertex: [m] the pair of its positions at 0 and at 1, each (3,). face: likewise, each 3×3.
margin, tolerance: [m].)");
  m.def(
      "linear_edge_edge_contact",
      [](const py::object& A, const py::object& B, double margin, double tolerance,
         int maximum_steps) {
        return linear_edge_edge_contact(
            moving_corners<2>(A, "A"), moving_corners<2>(B, "B"),
            {.margin = margin, .tolerance = tolerance, .maximum_steps = maximum_steps});
      },
      py::arg("A"), py::arg("B"), py::kw_only(), py::arg("margin") = 0.0,
      py::arg("tolerance") = 1e-6, py::arg("maximum_steps") = 10'000,
      R"(Finds the first time at which two edges, whose ends move on lines, are within the margin.

A, B: [m] the pair of the ends at 0 and at 1, each 2×3. margin, tolerance: [m].)");
}

/// The relative motion about the bodies' origins.
ElementaryMotion elementary_motion(const RecordedMotion& A, const RecordedMotion& B) {
  if (A.motion.breaks().size() > 2 || B.motion.breaks().size() > 2) {
    throw py::value_error("elementary tests take motions of one piece, not waypoints");
  }
  return ElementaryMotion(
      RelativeMotion(A.motion.path(0, Vector3d::Zero()), B.motion.path(0, Vector3d::Zero()), 0.0));
}

void bind_elementary(py::module_& m) {
  py::class_<ElementaryContact>(m, "ElementaryContact", "Outcome of an elementary test.")
      .def_readonly("verdict", &ElementaryContact::verdict)
      .def_readonly("t_lower", &ElementaryContact::t_lower,
                    "[-] Time before which the features provably do not meet.")
      .def_readonly("t_upper", &ElementaryContact::t_upper,
                    "[-] For `contact` the end of the isolating interval, else t_lower.")
      .def_readonly("existence_proven", &ElementaryContact::existence_proven,
                    "For `contact`: whether it is proven that the features meet in the interval.")
      .def_readonly("steps", &ElementaryContact::steps)
      .def("__repr__", [](const ElementaryContact& found) {
        return "<ElementaryContact: " + std::string(py::str(py::cast(found.verdict))) +
               " at t = " + std::string(py::repr(py::float_(found.t_lower))) + ">";
      });
  m.def(
      "vertex_face_contact",
      [](const py::object& face_A, const RecordedMotion& X_WA, const py::object& vertex_B,
         const RecordedMotion& X_WB, double t_begin, double t_end, double time_tolerance,
         int maximum_steps) {
        return vertex_face_contact(elementary_motion(X_WA, X_WB), corners_from<3>(face_A, "face_A"),
                                   vector_from(vertex_B, "vertex_B"),
                                   {.t_begin = t_begin,
                                    .t_end = t_end,
                                    .time_tolerance = time_tolerance,
                                    .maximum_steps = maximum_steps});
      },
      py::arg("face_A"), py::arg("X_WA"), py::arg("vertex_B"), py::arg("X_WB"), py::kw_only(),
      py::arg("t_begin") = 0.0, py::arg("t_end") = 1.0, py::arg("time_tolerance") = 1e-10,
      py::arg("maximum_steps") = 10'000,
      R"(Finds the first time at which a vertex of body B lies on a face of body A.

face_A: [m] 3×3, in A's frame. vertex_B: [m] (3,), in B's frame. X_WA, X_WB: motions of one piece.)");
  m.def(
      "edge_edge_contact",
      [](const py::object& edge_A, const RecordedMotion& X_WA, const py::object& edge_B,
         const RecordedMotion& X_WB, double t_begin, double t_end, double time_tolerance,
         int maximum_steps) {
        return edge_edge_contact(elementary_motion(X_WA, X_WB), corners_from<2>(edge_A, "edge_A"),
                                 corners_from<2>(edge_B, "edge_B"),
                                 {.t_begin = t_begin,
                                  .t_end = t_end,
                                  .time_tolerance = time_tolerance,
                                  .maximum_steps = maximum_steps});
      },
      py::arg("edge_A"), py::arg("X_WA"), py::arg("edge_B"), py::arg("X_WB"), py::kw_only(),
      py::arg("t_begin") = 0.0, py::arg("t_end") = 1.0, py::arg("time_tolerance") = 1e-10,
      py::arg("maximum_steps") = 10'000,
      R"(Finds the first time at which an edge of body A crosses an edge of body B.

edge_A, edge_B: [m] 2×3, each in its body's frame. X_WA, X_WB: motions of one piece.)");
}

}  // namespace

void bind_narrowphase(py::module_& m) {
  bind_linear(m);
  bind_elementary(m);
}

}  // namespace firstcontact::python
