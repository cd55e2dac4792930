#include <firstcontact/foreign_scenes/detail/rigid_ipc_meshes.h>

#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string_view>

#include <Eigen/Geometry>

#include <firstcontact/geometry/weld.h>
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/sha256.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Counts the vertices of an OBJ text; 0 where it has elements, or anything other than vertices.
std::size_t count_if_alone(std::string_view text) {
  std::size_t count = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    if (line.starts_with("v ")) {
      ++count;
    } else if (line.find_first_not_of(" \t\r") != line.npos && !line.starts_with('#')) {
      return 0;
    }
  }
  return count;
}

/// Parses a mesh as read_mesh, except that vertices alone are points.
Mesh parse(const fs::path& path, std::string text) {
  if (path.extension() != ".obj") {
    return read_mesh(path);
  }
  const std::size_t alone = count_if_alone(text);
  for (std::size_t k = 1; k <= alone; ++k) {
    text += "\np " + std::to_string(k);
  }
  Mesh mesh = parse_obj(text, path.string());
  weld(mesh);
  return mesh;
}

}  // namespace

fs::path RigidIpcMeshes::find(const JsonValue& name, const JsonReader& read) const {
  const std::string& text = read.string(name, "a mesh file");
  std::error_code ignored;
  fs::path beside = fixture_.parent_path() / text;
  if (is_file(beside)) {
    return beside;
  }
  std::string looked = write_json(beside.string());
  for (fs::path folder = fs::absolute(fixture_, ignored).parent_path();;
       folder = folder.parent_path()) {
    const fs::path meshes = folder / "meshes";
    if (fs::is_directory(meshes, ignored)) {
      if (is_file(meshes / text)) {
        return fs::proximate(meshes / text, ignored);
      }
      looked += ", " + write_json((meshes / text).string());
    }
    if (folder == folder.root_path() || folder.empty()) {
      break;
    }
  }
  read.fail(name,
            "expected a mesh file, beside this one or in a folder \"meshes\" of a folder "
            "above it; found none at " +
                looked);
}

const Mesh& RigidIpcMeshes::load(const fs::path& path) {
  const auto known = loaded_.find(path);
  if (known != loaded_.end()) {
    return known->second.mesh;
  }
  std::string text = read_file(path, "a mesh file");
  std::string digest = sha256(text);
  return loaded_.insert({path, {parse(path, std::move(text)), std::move(digest)}})
      .first->second.mesh;
}

std::string RigidIpcMeshes::digests() const {
  std::string lines;
  for (const auto& [path, loaded] : loaded_) {
    lines += loaded.digest + '\n';
  }
  return lines;
}

std::vector<fs::path> RigidIpcMeshes::files() const {
  std::vector<fs::path> files;
  for (const auto& [path, loaded] : loaded_) {
    files.push_back(path);
  }
  return files;
}

Eigen::Vector3d extent(const Mesh& mesh) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    bounds.extend(vertex);
  }
  return bounds.sizes();
}

Mesh scaled(Mesh mesh, const Eigen::Vector3d& factors) {
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = vertex.cwiseProduct(factors);
  }
  return mesh;
}

Mesh moved(Mesh mesh, const Eigen::Vector3d& translation) {
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex += translation;
  }
  return mesh;
}

std::vector<Mesh> split_components(const Mesh& mesh) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) {
      parent[v] = parent[parent[v]];
      v = parent[v];
    }
    return v;
  };
  for (const auto& t : mesh.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  std::vector<Mesh> parts;
  std::vector<std::uint32_t> part_of(mesh.vertices.size(), kNone);
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNone);
  for (const auto& t : mesh.triangles) {
    std::uint32_t& part = part_of[root(t[0])];
    if (part == kNone) {
      part = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    Mesh& own = parts[part];
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (number[t[k]] == kNone) {
        number[t[k]] = static_cast<std::uint32_t>(own.vertices.size());
        own.vertices.push_back(mesh.vertices[t[k]]);
      }
      corners[k] = number[t[k]];
    }
    own.triangles.push_back(corners);
  }
  return parts;
}

}  // namespace firstcontact::detail
