#include <firstcontact/scene/detail/read_shape.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/scene/detail/make_shape.h>
#include <firstcontact/scene/detail/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr std::string_view kPackage = "package://";

bool is_file(const std::filesystem::path& path) {
  // A NUL would end the name for the operating system, and another file would be opened.
  std::error_code error;
  return path.native().find('\0') == std::string::npos &&
         std::filesystem::is_regular_file(path, error);
}

std::filesystem::path find_in_packages(const JsonValue& value, const std::string& uri,
                                       const SceneFolders& folders, const JsonReader& read) {
  const std::string below = uri.substr(kPackage.size());
  for (const std::filesystem::path& root : folders.package_roots) {
    if (is_file(root / below)) {
      return root / below;
    }
  }
  if (folders.package_roots.empty()) {
    read.fail(value, "expected \"package_roots\" in the scene, to find " + in_quotes(uri));
  }
  read.fail(value, "expected a file, found " + in_quotes(uri) + " in none of the " +
                       std::to_string(folders.package_roots.size()) +
                       " package_roots (looked for " +
                       in_quotes((folders.package_roots.front() / below).string()) + ")");
}

std::filesystem::path read_mesh_path(const JsonValue& value, const SceneFolders& folders,
                                     const JsonReader& read) {
  const std::string& name = read.string(value, "the path of a mesh file");
  if (name.starts_with(kPackage)) {
    return find_in_packages(value, name, folders, read);
  }
  std::filesystem::path path = folders.scene / name;
  if (!is_file(path)) {
    read.fail(value, "expected a mesh file, found none at " + in_quotes(path.string()));
  }
  return path;
}

std::vector<Eigen::Vector3d> read_vertices(const JsonValue& value, const JsonReader& read) {
  std::vector<Eigen::Vector3d> vertices;
  for (const JsonValue& vertex : read.array(value, "an array of vertices [x, y, z]")) {
    vertices.push_back(read.vector3(vertex));
  }
  if (vertices.empty()) {
    read.fail(value, "expected at least one vertex, got none");
  }
  return vertices;
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

  /// Of each kind: the key that names it, what may stand beside that, and how it is read.
  struct Kind {
    std::string_view key;
    std::vector<std::string_view> beside;
    void (ShapeReader::*read)(const JsonValue& shape, const JsonValue& value, BodyShape& result);
  };

  static const std::vector<Kind>& kinds() {
    static const std::vector<Kind> kKinds = {
        {"mesh", {"scale", "radius", "solid"}, &ShapeReader::mesh_file},
        {"vertices", {"triangles", "radius", "solid"}, &ShapeReader::inline_mesh},
        {"sphere", {}, &ShapeReader::sphere},
        {"capsule", {}, &ShapeReader::capsule},
        {"box", {}, &ShapeReader::box},
        {"cylinder", {}, &ShapeReader::cylinder},
        {"cone", {}, &ShapeReader::cone}};
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
    KnownKeys known{.keys = {}, .later = {"convex_hull", "points", "heightmap"}};
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

  void mesh_file(const JsonValue& shape, const JsonValue& value, BodyShape& result) {
    const JsonValue* scale = find(std::get<JsonObject>(shape.value), "scale");
    result.source = MeshFile{.path = read_mesh_path(value, folders_, read_),
                             .scale = scale == nullptr ? 1.0 : read_.positive(*scale)};
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
    result.source = std::move(mesh);
  }

  void sphere(const JsonValue&, const JsonValue& value, BodyShape& result) {
    (void)read_.object(value, {{"radius"}});
    result.source = SphereShape{read_.positive(read_.member(value, "radius"))};
    require_makeable(value, result);
  }

  void capsule(const JsonValue&, const JsonValue& value, BodyShape& result) {
    (void)read_.object(value, {{"radius", "length"}});
    result.source = CapsuleShape{read_.positive(read_.member(value, "radius")),
                                 read_.not_negative(read_.member(value, "length"))};
    require_makeable(value, result);
  }

  void box(const JsonValue&, const JsonValue& value, BodyShape& result) {
    (void)read_.object(value, {{"size"}});
    const JsonValue& size = read_.member(value, "size");
    result.source = BoxShape{read_.vector3(size)};
    for (const JsonValue& length : std::get<JsonArray>(size.value)) {
      (void)read_.positive(length);
    }
    require_makeable(value, result);
  }

  void cylinder(const JsonValue&, const JsonValue& value, BodyShape& result) {
    result.source = round_shape<CylinderShape>(value);
    require_makeable(value, result);
  }

  void cone(const JsonValue&, const JsonValue& value, BodyShape& result) {
    result.source = round_shape<ConeShape>(value);
    require_makeable(value, result);
  }

  template <class Round>
  Round round_shape(const JsonValue& value) {
    const JsonObject& object = read_.object(value, {{"radius", "length", "enclosure_error"}});
    Round result{.radius = read_.positive(read_.member(value, "radius")),
                 .length = read_.positive(read_.member(value, "length")),
                 .enclosure_error = {}};
    if (const JsonValue* enclosure_error = find(object, "enclosure_error")) {
      result.enclosure_error = read_.positive(*enclosure_error);
    }
    return result;
  }

  /// What only the shapes themselves know to refuse, such as a size too large to square.
  void require_makeable(const JsonValue& value, const BodyShape& shape) {
    try {
      (void)make_shape(shape);
    } catch (const std::invalid_argument& error) {
      read_.fail(value, error.what());
    }
  }

  const SceneFolders& folders_;
  const JsonReader& read_;
};

}  // namespace

BodyShape read_shape(const JsonValue& value, const SceneFolders& folders, const JsonReader& read) {
  return ShapeReader(folders, read).shape(value);
}

}  // namespace firstcontact::detail
