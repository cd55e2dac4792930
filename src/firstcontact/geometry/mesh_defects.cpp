#include <firstcontact/geometry/mesh_defects.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/geometry/detail/vertex_components.h>

namespace firstcontact {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

void check_indices(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t v : mesh.triangles[i]) {
      if (v >= mesh.vertices.size()) {
        throw std::invalid_argument("inspect: triangle " + std::to_string(i) +
                                    " refers to vertex " + std::to_string(v) + " of " +
                                    std::to_string(mesh.vertices.size()));
      }
    }
  }
}

bool has_repeated_corner(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

bool is_degenerate(const Mesh& mesh, const Triangle& t) {
  if (has_repeated_corner(t)) {
    return true;
  }
  Eigen::Vector3d a = mesh.vertices[t[1]] - mesh.vertices[t[0]];
  Eigen::Vector3d b = mesh.vertices[t[2]] - mesh.vertices[t[0]];
  // Scaled to size 1, so that squares neither overflow nor vanish.
  const double size = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  a /= size;
  b /= size;
  const double longest =
      std::max({a.squaredNorm(), b.squaredNorm(), Eigen::Vector3d(b - a).squaredNorm()});
  return !(0.5 * a.cross(b).norm() > 1e-12 * longest);
}

/// Runs of edges through triangles, sorted into buckets by the smaller vertex. Each entry is the
/// larger vertex times two, plus one where the triangle runs towards the smaller.
struct EdgeRuns {
  std::vector<std::size_t> first;
  std::vector<std::uint64_t> runs;
};

template <class Use>
void for_each_edge(const Triangle& t, const Use& use) {
  if (has_repeated_corner(t)) {
    return;
  }
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t a = t[k];
    const std::uint32_t b = t[(k + 1) % 3];
    use(std::min(a, b), 2 * std::uint64_t{std::max(a, b)} + (a > b ? 1 : 0));
  }
}

EdgeRuns collect_runs(const Mesh& mesh) {
  EdgeRuns table;
  table.first.assign(mesh.vertices.size() + 1, 0);
  for (const Triangle& t : mesh.triangles) {
    for_each_edge(t, [&](std::uint32_t a, std::uint64_t) { ++table.first[a + 1]; });
  }
  std::partial_sum(table.first.begin(), table.first.end(), table.first.begin());
  table.runs.resize(table.first.back());
  std::vector<std::size_t> next(table.first.begin(), table.first.end() - 1);
  for (const Triangle& t : mesh.triangles) {
    for_each_edge(t, [&](std::uint32_t a, std::uint64_t run) { table.runs[next[a]++] = run; });
  }
  return table;
}

void count_edges(const Mesh& mesh, MeshDefects& defects) {
  EdgeRuns table = collect_runs(mesh);
  defects.consistently_oriented = true;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const std::size_t end = table.first[v + 1];
    std::sort(table.runs.data() + table.first[v], table.runs.data() + end);
    for (std::size_t i = table.first[v]; i < end;) {
      const std::size_t begin = i;
      std::size_t backward = 0;
      for (; i < end && table.runs[i] / 2 == table.runs[begin] / 2; ++i) {
        backward += table.runs[i] % 2;
      }
      const std::size_t triangles = i - begin;
      ++defects.edges;
      defects.open_edges += triangles == 1 ? 1 : 0;
      defects.nonmanifold_edges += triangles > 2 ? 1 : 0;
      if (triangles == 2 && backward != 1) {
        defects.consistently_oriented = false;
      }
    }
  }
  defects.closed = defects.edges > 0 && defects.open_edges == 0 && defects.nonmanifold_edges == 0;
}

std::size_t count_doubled(const Mesh& mesh) {
  std::vector<Triangle> sorted;
  sorted.reserve(mesh.triangles.size());
  for (Triangle t : mesh.triangles) {
    if (!has_repeated_corner(t)) {
      std::sort(t.begin(), t.end());
      sorted.push_back(t);
    }
  }
  std::sort(sorted.begin(), sorted.end());
  return static_cast<std::size_t>(sorted.end() - std::unique(sorted.begin(), sorted.end()));
}

void count_vertices(const Mesh& mesh, MeshDefects& defects) {
  std::vector<bool> used(mesh.vertices.size(), false);
  DisjointSets components = detail::vertex_components(mesh);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      used[v] = true;
    }
  }
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3d& p = mesh.vertices[v];
    defects.nonfinite_vertices += p.allFinite() ? 0 : 1;
    if (!used[v]) {
      ++defects.unused_vertices;
      continue;
    }
    defects.components += components.root(v) == v ? 1 : 0;
    if (p.allFinite()) {
      defects.bounds.extend(p);
    }
  }
}

double signed_volume(const Mesh& mesh, const Eigen::Vector3d& origin) {
  double six_volumes = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - origin;
    const Eigen::Vector3d b = mesh.vertices[t[1]] - origin;
    const Eigen::Vector3d c = mesh.vertices[t[2]] - origin;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

}  // namespace

MeshDefects inspect(const Mesh& mesh) {
  check_indices(mesh);
  MeshDefects defects;
  count_edges(mesh, defects);
  count_vertices(mesh, defects);
  defects.doubled_triangles = count_doubled(mesh);
  for (const Triangle& t : mesh.triangles) {
    defects.degenerate_triangles += is_degenerate(mesh, t) ? 1 : 0;
  }
  if (defects.closed && defects.consistently_oriented && defects.nonfinite_vertices == 0) {
    defects.signed_volume = signed_volume(mesh, defects.bounds.center());
  }
  return defects;
}

std::string why_not_solid(const Mesh& mesh) {
  check_indices(mesh);
  MeshDefects found;
  count_edges(mesh, found);
  if (found.open_edges > 0) {
    return std::to_string(found.open_edges) + " open edges";
  }
  if (found.nonmanifold_edges > 0) {
    return std::to_string(found.nonmanifold_edges) + " edges of more than two triangles";
  }
  if (!found.closed) {
    return "no surface";
  }
  return found.consistently_oriented ? "" : "neighbouring triangles that face opposite sides";
}

}  // namespace firstcontact
