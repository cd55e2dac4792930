#include <firstcontact/scene_files/detail/read_shape.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// Reads vectors.
///
/// @param many  "vertices", and `one` of them "vertex"
std::vector<Eigen::Vector3d> read_vectors(const JsonValue& value, const std::string& many,
                                          const std::string& one, const JsonReader& read) {
  std::vector<Eigen::Vector3d> vectors;
  for (const JsonValue& vector : read.array(value, "an array of " + many + " [x, y, z]")) {
    vectors.push_back(read.vector3(vector));
  }
  if (vectors.empty()) {
    read.fail(value, "expected at least one " + one + ", got none");
  }
  return vectors;
}

std::vector<Eigen::Vector3d> read_vertices(const JsonValue& value, const JsonReader& read) {
  return read_vectors(value, "vertices", "vertex", read);
}

std::vector<std::array<std::uint32_t, 3>> read_triangles(const JsonValue& value,
                                                         std::size_t vertex_count,
                                                         const JsonReader& read) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const JsonValue& triangle : read.array(value, "an array of triangles [i, j, k]")) {
    const JsonArray& corners = read.array(triangle, "three vertex indices");
    if (corners.size() != 3) {
      read.fail_expected("three vertex indices", triangle);
    }
    std::array<std::uint32_t, 3>& indices = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      indices[i] =
          static_cast<std::uint32_t>(read.index(corners[i], vertex_count, "a vertex index"));
    }
  }
  if (triangles.empty()) {
    read.fail(value, "expected at least one triangle, got none (a point is a triangle [i, i, i])");
  }
  return triangles;
}

/// Reads shapes of one scene.
class ShapeReader {
 public:
  ShapeReader(const SceneFolders& folders, const JsonReader& read)
      : folders_(folders), read_(read) {}

  /// A kind of shape: the key that names it, the keys beside that, and its reader.
  struct Kind {
    std::string_view key;
    std::vector<std::string_view> beside;
    void (ShapeReader::*read)(const JsonValue& shape, const JsonValue& value, BodyShape& result);
  };

  static const std::vector<Kind>& kinds() {
    static const std::vector<Kind> kKinds = {
        {"mesh", {"scale", "radius", "solid"}, &ShapeReader::mesh_file},
        {"vertices",
         {"triangles", "radius", "solid", "enclosure_error"},
         &ShapeReader::inline_mesh},
        {"sphere", {}, &ShapeReader::sphere},
        {"capsule", {}, &ShapeReader::capsule},
        {"box", {"radius"}, &ShapeReader::box},
        {"cylinder", {}, &ShapeReader::cylinder},
        {"cone", {}, &ShapeReader::cone},
        {"ellipsoid", {}, &ShapeReader::ellipsoid},
        {"convex_hull", {"radius"}, &ShapeReader::convex_hull},
        {"points", {"scale", "radius"}, &ShapeReader::points},
        {"heightmap", {"radius"}, &ShapeReader::height_map}};
    return kKinds;
  }

  BodyShape shape(const JsonValue& value) {
    const JsonObject& object = read_.object(value, known_keys());
    const Kind& kind = only_kind(value, object);
    for (const auto& [key, member] : object) {
      if (key != kind.key &&
          std::find(kind.beside.begin(), kind.beside.end(), key) == kind.beside.end()) {
        read_.fail(member, "expected no " + in_quotes(key) + " beside " + in_quotes(kind.key));
      }
    }
    BodyShape result;
    if (const JsonValue* radius = find(object, "radius")) {
      result.radius = read_.not_negative(*radius);
    }
    if (const JsonValue* solid = find(object, "solid")) {
      result.filling = read_.boolean(*solid) ? Filling::solid : Filling::surface;
    }
    (this->*kind.read)(value, *find(object, kind.key), result);
    return result;
  }

 private:
  static KnownKeys known_keys() {
    KnownKeys known{.keys = {}};
    const auto add = [&](std::string_view key) {
      if (std::find(known.keys.begin(), known.keys.end(), key) == known.keys.end()) {
        known.keys.push_back(key);
      }
    };
    for (const Kind& kind : kinds()) {
      add(kind.key);
      std::for_each(kind.beside.begin(), kind.beside.end(), add);
    }
    return known;
  }

  [[nodiscard]] const Kind& only_kind(const JsonValue& value, const JsonObject& object) const {
    const Kind* only = nullptr;
    std::vector<std::string_view> names;
    std::vector<std::string_view> found;
    for (const Kind& kind : kinds()) {
      names.push_back(kind.key);
      if (find(object, kind.key) != nullptr) {
        found.push_back(kind.key);
        only = &kind;
      }
    }
    if (found.size() != 1) {
      read_.fail(value, "expected one of " + listed(names) + ", got " +
                            (found.empty() ? "none" : listed(found)));
    }
    return *only;
  }

  [[nodiscard]] double scale(const JsonObject& object) const {
    const JsonValue* scale = find(object, "scale");
    return scale == nullptr ? 1.0 : read_.positive(*scale);
  }

  [[nodiscard]] MeshFile mesh_file(const JsonObject& object, const JsonValue& path) const {
    return {.path = read_path(path, "a mesh file", folders_, read_), .scale = scale(object)};
  }

  void mesh_file(const JsonValue& shape, const JsonValue& value, BodyShape& result) {
    result.source = mesh_file(std::get<JsonObject>(shape.value), value);
  }

  void inline_mesh(const JsonValue& shape, const JsonValue& value, BodyShape& result) {
    Mesh mesh{.vertices = read_vertices(value, read_), .triangles = {}};
    mesh.triangles = read_triangles(read_.member(shape, "triangles"), mesh.vertices.size(), read_);
    if (result.filling == Filling::solid) {
      const std::string defect = why_not_solid(mesh);
      if (!defect.empty()) {
        read_.fail(shape, "expected a closed mesh of a solid, got " + defect);
      }
    }
    if (const JsonValue* error = find(std::get<JsonObject>(shape.value), "enclosure_error")) {
      result.enclosure_error = read_.not_negative(*error);
    }
    result.source = std::move(mesh);
  }

  void sphere(const JsonValue&, const JsonValue& value, BodyShape& result) {
    (void)read_.object(value, {{"radius"}});
    result.source = SphereShape{size(read_.member(value, "radius"))};
  }

  void capsule(const JsonValue&, const JsonValue& value, BodyShape& result) {
    (void)read_.object(value, {{"radius", "length"}});
    const JsonValue& length = read_.member(value, "length");
    result.source = CapsuleShape{
        size(read_.member(value, "radius")),
        read_.not_negative(length) == 0.0 ? 0.0 : size(length),
    };
  }

  void box(const JsonValue& shape, const JsonValue& value, BodyShape& result) {
    (void)read_.object(value, {{"size"}});
    const JsonValue& lengths = read_.member(value, "size");
    result.source = BoxShape{read_.vector3(lengths)};
    for (const JsonValue& length : std::get<JsonArray>(lengths.value)) {
      (void)size(length);
    }
    if (result.radius > 0.0) {
      (void)size(*find(std::get<JsonObject>(shape.value), "radius"));
    }
  }

  void cylinder(const JsonValue&, const JsonValue& value, BodyShape& result) {
    result.source = round_shape<CylinderShape>(value);
  }

  void cone(const JsonValue&, const JsonValue& value, BodyShape& result) {
    result.source = round_shape<ConeShape>(value);
  }

  void ellipsoid(const JsonValue&, const JsonValue& value, BodyShape& result) {
    const JsonObject& object = read_.object(value, {{"radii", "enclosure_error"}});
    const JsonValue& radii = read_.member(value, "radii");
    EllipsoidShape shape{.radii = read_.vector3(radii), .enclosure_error = {}};
    for (const JsonValue& radius : std::get<JsonArray>(radii.value)) {
      (void)size(radius);
    }
    if (const JsonValue* enclosure_error = find(object, "enclosure_error")) {
      shape.enclosure_error = read_.positive(*enclosure_error);
      if (!(*shape.enclosure_error >= kLeastEllipsoidError * shape.radii.maxCoeff())) {
        read_.fail_expected("at least 2e-4 of the greatest radius", *enclosure_error);
      }
    }
    if (!(shape.radii.minCoeff() >= kFlattestEllipsoid * shape.radii.maxCoeff())) {
      read_.fail_expected("a least radius of at least 1e-30 of the greatest", radii);
    }
    result.source = shape;
  }

  template <class Round>
  [[nodiscard]] Round round_shape(const JsonValue& value) const {
    const JsonObject& object = read_.object(value, {{"radius", "length", "enclosure_error"}});
    Round result{.radius = size(read_.member(value, "radius")),
                 .length = size(read_.member(value, "length")),
                 .enclosure_error = {}};
    if (const JsonValue* enclosure_error = find(object, "enclosure_error")) {
      result.enclosure_error = read_.positive(*enclosure_error);
      if (!(*result.enclosure_error >= kLeastEnclosureError * result.radius)) {
        read_.fail_expected("at least 1e-8 of the radius", *enclosure_error);
      }
    }
    return result;
  }

  /// Reads a length that a primitive can have.
  [[nodiscard]] double size(const JsonValue& value) const {
    const double length = read_.positive(value);
    if (!(length >= kLeastSize && length <= kGreatestSize)) {
      read_.fail_expected("a length in 1e-60 ... 1e60", value);
    }
    return length;
  }

  void convex_hull(const JsonValue&, const JsonValue& value, BodyShape& result) {
    const JsonObject& object = read_.object(value, {{"mesh", "scale", "vertices"}});
    const JsonValue* mesh = find(object, "mesh");
    const JsonValue* vertices = find(object, "vertices");
    if ((mesh != nullptr) == (vertices != nullptr)) {
      read_.fail(value, std::string("expected either \"mesh\" or \"vertices\", got ") +
                            (mesh != nullptr ? "both" : "neither"));
    }
    if (mesh != nullptr) {
      result.source = ConvexHullShape{mesh_file(object, *mesh)};
    } else if (const JsonValue* scale = find(object, "scale")) {
      read_.fail(*scale, "expected no \"scale\" beside \"vertices\"");
    } else {
      result.source = ConvexHullShape{read_vertices(*vertices, read_)};
    }
  }

  void points(const JsonValue& shape, const JsonValue& value, BodyShape& result) {
    const JsonObject& object = std::get<JsonObject>(shape.value);
    if (std::holds_alternative<std::string>(value.value)) {
      result.source = PointFile{.path = read_path(value, "a point cloud", folders_, read_),
                                .scale = scale(object)};
    } else if (const JsonValue* scale = find(object, "scale")) {
      read_.fail(*scale, "expected \"scale\" beside the path of a point cloud only");
    } else {
      result.source = PointCloud{read_vectors(value, "points", "point", read_)};
    }
  }

  void height_map(const JsonValue&, const JsonValue& value, BodyShape& result) {
    (void)read_.object(value, {{"cell", "heights"}});
    const Eigen::Vector2d cell = cell_size(read_.member(value, "cell"));
    const JsonValue& heights = read_.member(value, "heights");
    if (std::holds_alternative<std::string>(heights.value)) {
      result.source = HeightFile{.path = read_path(heights, "a file of heights", folders_, read_),
                                 .cell = cell};
    } else {
      result.source = inline_heights(heights, cell);
    }
  }

  [[nodiscard]] Eigen::Vector2d cell_size(const JsonValue& value) const {
    const JsonArray& lengths = read_.array(value, "two lengths [x, y]");
    if (lengths.size() != 2) {
      read_.fail_expected("two lengths [x, y]", value);
    }
    return {size(lengths[0]), size(lengths[1])};
  }

  [[nodiscard]] HeightMap inline_heights(const JsonValue& value,
                                         const Eigen::Vector2d& cell) const {
    const std::string expected = "the path of a file of heights, or an array of two rows or more";
    const JsonArray& rows = read_.array(value, expected);
    HeightMap map{.cell = cell, .columns = 0, .heights = {}};
    for (const JsonValue& row : rows) {
      const JsonArray& heights = read_.array(row, "a row of heights");
      map.columns = map.columns == 0 ? heights.size() : map.columns;
      if (heights.size() != map.columns || map.columns < 2) {
        read_.fail_expected("a row of two heights or more, as many as in the first", row);
      }
      for (const JsonValue& height : heights) {
        map.heights.push_back(read_.number(height));
        if (!(std::abs(map.heights.back()) <= kGreatestSize)) {
          read_.fail_expected("a number of at most 1e60 in size", height);
        }
      }
    }
    if (rows.size() < 2) {
      read_.fail_expected(expected, value);
    }
    return map;
  }

  const SceneFolders& folders_;
  const JsonReader& read_;
};

}  // namespace

BodyShape read_shape(const JsonValue& value, const SceneFolders& folders, const JsonReader& read) {
  return ShapeReader(folders, read).shape(value);
}

}  // namespace firstcontact::detail
