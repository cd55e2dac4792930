#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pybind11/operators.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <firstcontact/geometry/convex_hull.h>
#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/geometry/deforming_body.h>
#include <firstcontact/geometry/height_map.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/geometry/point_cloud.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/geometry/weld.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/mesh_files/read_points.h>

#include "arrays.h"
#include "bindings.h"
#include "errors.h"
#include "motion.h"
#include "reports.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;
using std::filesystem::path;

namespace {

/// Runs a call while other threads of Python run.
template <typename Work>
auto without_gil(const Work& work) {
  const py::gil_scoped_release release;
  return work();
}

py::object to_tuple(Mesh mesh) {
  return mesh_tuple(owning(std::move(mesh.vertices)), owning(std::move(mesh.triangles)));
}

Shape make_shape(const py::object& mesh, double radius, Filling filling, double enclosure_error) {
  Mesh owned = mesh_from(mesh);
  return without_gil([&] { return Shape(std::move(owned), radius, filling, enclosure_error); });
}

py::object to_tuple(const HeightMap& map) {
  const auto columns = static_cast<py::ssize_t>(map.columns);
  const auto rows = static_cast<py::ssize_t>(map.heights.size()) / columns;
  return py::module_::import("firstcontact._tuples")
      .attr("HeightMap")(py::make_tuple(map.cell.x(), map.cell.y()),
                         py::array_t<double>({rows, columns}, map.heights.data()));
}

HeightMap height_map_from(const py::object& value) {
  if (!PyTuple_Check(value.ptr()) || PyTuple_GET_SIZE(value.ptr()) != 2) {
    throw py::type_error("map: expected a pair (cell, heights)");
  }
  const py::array_t<double> heights = matrix_from(PyTuple_GET_ITEM(value.ptr(), 1), "heights");
  return {.cell = vector2_from(PyTuple_GET_ITEM(value.ptr(), 0), "cell"),
          .columns = static_cast<std::size_t>(heights.shape(1)),
          .heights = {heights.data(), heights.data() + heights.size()}};
}

/// Reads a file, which has to exist.
template <typename Read>
auto read_file(const path& file, const Read& read) {
  require_file(file);
  return without_gil([&] { return read(file); });
}

using ParseMesh = Mesh (*)(std::string_view, const std::string&);
using ParsePoints = std::vector<Eigen::Vector3d> (*)(std::string_view, const std::string&);

void bind_parser(py::module_& m, const char* name, ParseMesh parse) {
  m.def(
      name,
      [parse](std::string_view data, const std::string& source) {
        return to_tuple(without_gil([&] { return parse(data, source); }));
      },
      py::arg("data"), py::arg("source"),
      "Parses the content of a file, str or bytes, without welding. source: names the file in a "
      "ParseError.");
}

void bind_parser(py::module_& m, const char* name, ParsePoints parse) {
  m.def(
      name,
      [parse](std::string_view data, const std::string& source) {
        return owning(without_gil([&] { return parse(data, source); }));
      },
      py::arg("data"), py::arg("source"),
      "Parses the content of a file, str or bytes: [m] n×3. source: names the file in a "
      "ParseError.");
}

py::object bounds_of(const MeshDefects& defects) {
  if (defects.bounds.isEmpty()) {
    return py::none();
  }
  return py::make_tuple(copied(defects.bounds.min()), copied(defects.bounds.max()));
}

void bind_defects(py::module_& m) {
  py::class_<MeshDefects>(
      m, "MeshDefects",
      R"(Counts of unusual triangles and vertices of a mesh; none of them makes a query wrong.

Vertices count by their numbers, so weld them first.)")
      .def_readonly("edges", &MeshDefects::edges, "Number of unique edges.")
      .def_readonly("open_edges", &MeshDefects::open_edges, "Number of edges of one triangle.")
      .def_readonly("nonmanifold_edges", &MeshDefects::nonmanifold_edges,
                    "Number of edges of three triangles or more.")
      .def_readonly("degenerate_triangles", &MeshDefects::degenerate_triangles,
                    "Number of triangles with equal corners, or area <= 1e-12 (longest edge)^2.")
      .def_readonly("doubled_triangles", &MeshDefects::doubled_triangles,
                    "Number of triangles with the corners of an earlier one, in any order.")
      .def_readonly("nonfinite_vertices", &MeshDefects::nonfinite_vertices)
      .def_readonly("unused_vertices", &MeshDefects::unused_vertices)
      .def_readonly("components", &MeshDefects::components,
                    "Number of sets of triangles joined by shared vertices.")
      .def_readonly("closed", &MeshDefects::closed, "Whether every edge has exactly two triangles.")
      .def_readonly("consistently_oriented", &MeshDefects::consistently_oriented,
                    "Whether two triangles run each of their edges in opposite directions.")
      .def_property_readonly("bounds", &bounds_of,
                             "[m] Least and greatest corner, each (3,), of the vertices that "
                             "triangles use; None where there are none.")
      .def_readonly("signed_volume", &MeshDefects::signed_volume,
                    "[m^3] Volume of a closed, consistently oriented mesh, else None.");
}

/// The convex set of a shape: its kind and its numbers; None where it has none.
py::object set_state(const Shape& shape) {
  const ConvexSet* set = shape.convex_set();
  if (set == nullptr) {
    return py::none();
  }
  const ConvexCore& core = set->core();
  return py::make_tuple(static_cast<int>(core.kind), core.size.x(), core.size.y(), core.size.z());
}

/// @param points  of a hull
ConvexSet set_from(const py::tuple& state, double rounding, std::vector<Eigen::Vector3d> points) {
  const auto number = [&](std::size_t k) { return state[k].cast<double>(); };
  const Eigen::Vector3d size(number(1), number(2), number(3));
  switch (static_cast<ConvexKind>(state[0].cast<int>())) {
    case ConvexKind::point:
      return ConvexSet::sphere(rounding);
    case ConvexKind::segment:
      return ConvexSet::capsule(rounding, 2.0 * size.z());
    case ConvexKind::box:
      return ConvexSet::box(2.0 * size, rounding);
    case ConvexKind::cylinder:
      return ConvexSet::cylinder(size.x(), 2.0 * size.z(), rounding);
    case ConvexKind::cone:
      return ConvexSet::cone(size.x(), 2.0 * size.z(), rounding);
    case ConvexKind::ellipsoid:
      return ConvexSet::ellipsoid(size);
    case ConvexKind::hull:
      break;
  }
  return ConvexSet::hull(std::move(points), rounding);
}

Shape shape_from(const py::tuple& state) {
  const auto radius = state[1].cast<double>();
  const auto filling = state[2].cast<Filling>();
  const auto enclosure_error = state[3].cast<double>();
  if (state.size() < 5 || state[4].is_none()) {
    return make_shape(state[0], radius, filling, enclosure_error);
  }
  Mesh mesh = mesh_from(state[0]);
  const ConvexSet set = set_from(state[4].cast<py::tuple>(), radius, mesh.vertices);
  return without_gil([&] { return Shape(std::move(mesh), filling, enclosure_error, set); });
}

/// The data of which a pickled shape is made again.
py::tuple shape_state(const py::object& self) {
  const Shape& shape = self.cast<const Shape&>();
  if (shape.hierarchy().deforms()) {
    throw py::type_error(
        "a deforming shape cannot be pickled; pickle what move_vertices was given");
  }
  return py::make_tuple(
      py::make_tuple(view(shape.mesh().vertices, self), view(shape.mesh().triangles, self)),
      shape.radius(), shape.is_solid() ? Filling::solid : Filling::surface, shape.enclosure_error(),
      set_state(shape));
}

void bind_shape(py::module_& m) {
  py::class_<Shape>(
      m, "Shape", R"(A union of simplices thickened by a radius, with its bounding-volume hierarchy.

A shape never changes. Build it once and use it in many queries, also from many threads.)")
      .def(py::init(&make_shape), py::arg("mesh"), py::arg("radius") = 0.0,
           py::arg("filling") = Filling::surface, py::arg("enclosure_error") = 0.0,
           R"(Copies the mesh once and builds the hierarchy.

mesh: a Mesh, or any pair (vertices, triangles): n×3 numbers [m], at least one triangle m×3.
radius: [m] thickens every simplex; >= 0. filling: "solid" needs a closed mesh whose triangles agree
on their inner side. enclosure_error: [m] distance by which triangles may enclose a curved body.
ValueError on an empty mesh, a vertex that is not finite, an index out of range.)")
      .def_property_readonly(
          "vertices",
          [](const py::object& self) {
            return view(self.cast<const Shape&>().mesh().vertices, self);
          },
          "[m] n×3, body frame. A read-only view of the shape's own memory.")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) {
            return view(self.cast<const Shape&>().mesh().triangles, self);
          },
          "Vertex numbers m×3 of uint32, rows of `vertices`. A read-only view of the shape's own "
          "memory.")
      .def_property_readonly(
          "mesh",
          [](const py::object& self) {
            const Mesh& mesh = self.cast<const Shape&>().mesh();
            return mesh_tuple(view(mesh.vertices, self), view(mesh.triangles, self));
          },
          "Both views.")
      .def_property_readonly("radius", &Shape::radius, "[m]")
      .def_property_readonly("is_solid", &Shape::is_solid)
      .def_property_readonly("enclosure_error", &Shape::enclosure_error,
                             "[m] Bound of the distance of the triangles from the enclosed body; 0 "
                             "where they are exact.")
      .def_property_readonly("is_curved", &Shape::is_curved,
                             "Whether the triangles only enclose the shape. Queries of rigid "
                             "bodies use the exact cylinder, cone or ellipsoid.")
      .def_property_readonly("edge_count", &Shape::edge_count)
      .def(
          "edge",
          [](const Shape& shape, std::size_t index) {
            if (index >= shape.edge_count()) {
              throw py::index_error("edge " + std::to_string(index) + " of " +
                                    std::to_string(shape.edge_count()));
            }
            return py::make_tuple(shape.edge(index)[0], shape.edge(index)[1]);
          },
          py::arg("index"), "The two vertices of an edge, the smaller number first.")
      .def("__eq__",
           [](const Shape& a, const py::object& b) {
             return py::isinstance<Shape>(b) && a.compare(b.cast<const Shape&>()) == 0;
           })
      .def("__hash__",
           [](const Shape& shape) {
             return py::hash(py::make_tuple(shape.mesh().vertices.size(),
                                            shape.mesh().triangles.size(), shape.radius()));
           })
      .def("__repr__",
           [](const Shape& shape) {
             return "<Shape of " + std::to_string(shape.mesh().vertices.size()) + " vertices, " +
                    std::to_string(shape.mesh().triangles.size()) + " triangles" +
                    (shape.radius() > 0.0
                         ? ", radius " + std::string(py::repr(py::float_(shape.radius()))) + " m"
                         : "") +
                    (shape.is_solid() ? ", solid>" : ">");
           })
      .def(py::pickle(&shape_state, &shape_from));
}

void bind_makers(py::module_& m) {
  m.def("make_sphere", &make_sphere, py::arg("radius"),
        "Makes a ball about the origin. radius: [m] > 0.");
  m.def(
      "make_capsule", &make_capsule, py::arg("radius"), py::arg("length"),
      R"(Makes a capsule: all points within the radius of a segment along z, centred at the origin.

radius: [m] > 0. length: [m] of the segment, without the caps; >= 0.)");
  m.def(
      "make_box",
      [](const py::object& size, double radius) {
        return make_box(vector_from(size, "size"), radius);
      },
      py::arg("size"), py::arg("radius") = 0.0,
      R"(Makes a box along the axes, centred at the origin; with a radius, a rounded box.

size: [m] (3,), without the radius; > 0. radius: [m] thickens the box on all sides, and rounds its
edges and corners; >= 0.)");
  m.def("make_cylinder", &make_cylinder, py::arg("radius"), py::arg("length"),
        py::arg("enclosure_error") = py::none(),
        R"(Makes a cylinder about z, centred at the origin. Queries use it exactly.

radius: [m] > 0. length: [m] along z; > 0. enclosure_error: [m] the most by which the triangles
around it stand out; 1e-4 of the radius where it is None.)");
  m.def("make_cone", &make_cone, py::arg("radius"), py::arg("length"),
        py::arg("enclosure_error") = py::none(),
        R"(Makes a cone about z: base at -length / 2, tip at length / 2. Queries use it exactly.

radius: [m] of the base; > 0. length: [m] > 0. enclosure_error: as of make_cylinder.)");
  m.def(
      "make_ellipsoid",
      [](const py::object& radii, std::optional<double> enclosure_error) {
        const Eigen::Vector3d owned = vector_from(radii, "radii");
        return without_gil([&] { return make_ellipsoid(owned, enclosure_error); });
      },
      py::arg("radii"), py::arg("enclosure_error") = py::none(),
      R"(Makes an ellipsoid along the axes, centred at the origin. Queries use it exactly.

radii: [m] (3,), half of its length along each axis; > 0. enclosure_error: [m] as of make_cylinder;
5e-3 of the greatest radius where it is None.)");
  m.def(
      "make_convex_hull",
      [](const py::object& points, double radius) {
        const std::vector<Eigen::Vector3d> owned = points_from(points, "points");
        return without_gil([&] { return make_convex_hull(owned, radius); });
      },
      py::arg("points"), py::arg("radius") = 0.0,
      "Makes the convex hull of points a shape; solid where it encloses space. points: [m] n×3. "
      "radius: [m].");
  m.def(
      "convex_hull",
      [](const py::object& points) {
        const std::vector<Eigen::Vector3d> owned = points_from(points, "points");
        return to_tuple(without_gil([&] { return convex_hull(owned); }));
      },
      py::arg("points"),
      "Makes the convex hull of points a closed Mesh over some of them in their order; exact. "
      "points: [m] n×3, at least one.");
  m.def(
      "make_point_cloud",
      [](const py::object& points, double radius) {
        std::vector<Eigen::Vector3d> owned = points_from(points, "points");
        return without_gil([&] { return make_point_cloud(std::move(owned), radius); });
      },
      py::arg("points"), py::arg("radius") = 0.0,
      "Makes a union of balls. points: [m] n×3, at least one. radius: [m] >= 0.");
  m.def(
      "make_height_map",
      [](const py::object& map, double radius) {
        const HeightMap owned = height_map_from(map);
        return without_gil([&] { return make_height_map(owned, radius); });
      },
      py::arg("map"), py::arg("radius") = 0.0,
      R"(Makes the surface through the samples of a height map, with two triangles a cell.

map: a HeightMap, or any pair (cell, heights): [m] (2,) and [m] rows×columns. radius: [m] >= 0.)");
}

py::object move(const Shape& shape, const py::object& to) {
  const std::vector<Eigen::Vector3d> places = points_from(to, "to");
  DeformingBody body = without_gil([&] { return move_vertices(shape, places); });
  // The motion carries the frame from the origin at a constant velocity.
  const Eigen::Vector3d translation = body.X_WS.pose(1.0).position;
  RecordedMotion motion{
      std::move(body.X_WS), "constant_velocity",
      py::make_tuple(Pose{}, py::make_tuple(translation.x(), translation.y(), translation.z()),
                     py::make_tuple(0.0, 0.0, 0.0))};
  return py::module_::import("firstcontact._tuples")
      .attr("MovingShape")(std::move(body.shape), std::move(motion));
}

/// @throws std::invalid_argument
void scale_by(double factor, std::vector<Eigen::Vector3d>& points) {
  if (!(factor > 0.0 && std::isfinite(factor))) {
    throw std::invalid_argument("scale must be > 0, got " + detail::shortest(factor));
  }
  if (factor != 1.0) {
    for (Eigen::Vector3d& point : points) {
      point *= factor;
    }
  }
}

MeshReading scaled_mesh(const path& file, double scale, bool lenient) {
  return read_file(file, [&](const path& found) {
    MeshReading reading = read_mesh_file(found, {.lenient = lenient});
    scale_by(scale, reading.mesh.vertices);
    return reading;
  });
}

PointReading scaled_points(const path& file, double scale, bool lenient) {
  return read_file(file, [&](const path& found) {
    PointReading reading = read_points_file(found, {.lenient = lenient});
    scale_by(scale, reading.points);
    return reading;
  });
}

void bind_readers(py::module_& m) {
  m.def(
      "read_mesh",
      [](const path& file, double scale, bool lenient) {
        return to_tuple(scaled_mesh(file, scale, lenient).mesh);
      },
      py::arg("path"), py::kw_only(), py::arg("scale") = 1.0, py::arg("lenient") = false,
      R"(Reads OBJ, STL, PLY, OFF (in double precision), DAE, GLB or glTF; welds equal vertices.

scale: [-] of coordinates; 0.001 reads millimetres where the format has no unit. lenient: unknown
names are warnings of read_mesh_file, not errors. FileNotFoundError where there is no such file,
ParseError where it cannot be used.)");
  m.def(
      "read_mesh_file",
      [](const path& file, double scale, bool lenient) {
        MeshReading reading = scaled_mesh(file, scale, lenient);
        const std::string report = write_file_reports({&reading.report, 1});
        return report_function("mesh_reading")(to_tuple(std::move(reading.mesh)), report);
      },
      py::arg("path"), py::kw_only(), py::arg("scale") = 1.0, py::arg("lenient") = false,
      "Reads a MeshReading: the mesh, and the report on its file. Options and errors as "
      "read_mesh.");
  m.def(
      "read_points",
      [](const path& file, double scale, bool lenient) {
        return owning(scaled_points(file, scale, lenient).points);
      },
      py::arg("path"), py::kw_only(), py::arg("scale") = 1.0, py::arg("lenient") = false,
      "Reads the points of a PLY, PCD or XYZ file: [m] n×3. Options and errors as read_mesh.");
  m.def(
      "read_points_file",
      [](const path& file, double scale, bool lenient) {
        PointReading reading = scaled_points(file, scale, lenient);
        const std::string report = write_file_reports({&reading.report, 1});
        return report_function("point_reading")(owning(std::move(reading.points)), report);
      },
      py::arg("path"), py::kw_only(), py::arg("scale") = 1.0, py::arg("lenient") = false,
      "Reads a PointReading: the points, and the report on their file. Options and errors as "
      "read_points.");
  m.def(
      "read_heights",
      [](const path& file, const py::object& cell) {
        const Eigen::Vector2d size = vector2_from(cell, "cell");
        return to_tuple(
            read_file(file, [&](const path& found) { return read_heights(found, size); }));
      },
      py::arg("path"), py::arg("cell"),
      "Reads a height map as numpy.savetxt writes it. cell: [m] (2,). Errors as read_mesh.");
  bind_parser(m, "parse_obj", &parse_obj);
  bind_parser(m, "parse_stl", &parse_stl);
  bind_parser(m, "parse_ply", &parse_ply);
  bind_parser(m, "parse_off", &parse_off);
  bind_parser(m, "parse_pcd", &parse_pcd);
  bind_parser(m, "parse_xyz", &parse_xyz);
  bind_parser(m, "parse_ply_points", &parse_ply_points);
}

void bind_inspection(py::module_& m) {
  m.def(
      "weld",
      [](const py::object& mesh) {
        Mesh welded = mesh_from(mesh);
        without_gil([&] { return weld(welded); });
        return to_tuple(std::move(welded));
      },
      py::arg("mesh"),
      "Merges vertices of equal coordinates into the first of them; unused ones stay.");
  m.def(
      "inspect",
      [](const py::object& mesh) {
        const Mesh inspected = mesh_from(mesh);
        return without_gil([&] { return inspect(inspected); });
      },
      py::arg("mesh"), "Counts unusual triangles and vertices of a mesh.");
  m.def(
      "why_not_solid",
      [](const py::object& mesh) {
        const Mesh inspected = mesh_from(mesh);
        return without_gil([&] { return why_not_solid(inspected); });
      },
      py::arg("mesh"),
      "The reason why a mesh encloses no space, as \"12 open edges\"; empty if it does.");
}

}  // namespace

void bind_geometry(py::module_& m) {
  bind_shape(m);
  m.def("move_vertices", &move, py::arg("shape"), py::arg("to"),
        R"(Makes a MovingShape whose vertices each move on a line: from those of the shape to `to`.

to: [m] n×3, world frame, one for each vertex of the shape.)");
  bind_makers(m);
  bind_readers(m);
  bind_defects(m);
  bind_inspection(m);
}

}  // namespace firstcontact::python
