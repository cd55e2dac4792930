#include <firstcontact/geometry/shape.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/geometry/detail/convex_hierarchy.h>
#include <firstcontact/geometry/detail/vertex_components.h>
#include <firstcontact/geometry/feature_table.h>
#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/geometry/screw_sliding_bounds.h>
#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/math/double_double.h>
#include <firstcontact/math/number_text.h>

namespace firstcontact {
namespace {

using detail::vertex_components;

void require_length(const char* what, double length) {
  if (!(length >= 0.0 && std::isfinite(length))) {
    throw std::invalid_argument(std::string("Shape: ") + what + " must be finite and >= 0, got " +
                                detail::shortest(length));
  }
}

void require_position(const std::string& what, const Eigen::Vector3d& position) {
  // Beyond this, squares and products of lengths would overflow.
  constexpr double kMaximumCoordinate = 1e60;
  if (!(position.cwiseAbs().maxCoeff() <= kMaximumCoordinate) || position.hasNaN()) {
    throw std::invalid_argument("Shape: " + what + " is not finite or beyond 1e60 m");
  }
}

void validate(const Mesh& mesh) {
  if (mesh.triangles.empty()) {
    throw std::invalid_argument("Shape: the mesh has no triangles");
  }
  if (mesh.triangles.size() >= (std::size_t{1} << 28)) {
    throw std::invalid_argument("Shape: more than 2^28 triangles");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t v : mesh.triangles[i]) {
      if (v >= mesh.vertices.size()) {
        throw std::invalid_argument("Shape: triangle " + std::to_string(i) + " refers to vertex " +
                                    std::to_string(v) + " of " +
                                    std::to_string(mesh.vertices.size()));
      }
      require_position("vertex " + std::to_string(v), mesh.vertices[v]);
    }
  }
}

void require_solid(const Mesh& mesh) {
  const std::string defect = why_not_solid(mesh);
  if (!defect.empty()) {
    throw std::invalid_argument("Shape: a solid needs a closed mesh, this one has " + defect);
  }
}

/// Unique edges, in buckets by their smaller vertex. Those of vertex v are the numbers from
/// first[v] to first[v + 1], with their larger vertices in rising order.
struct EdgeTable {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> larger;
};

template <class Use>
void for_each_triangle_edge(const Mesh& mesh, const Use& use) {
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      if (a != b) {
        use(std::min(a, b), std::max(a, b));
      }
    }
  }
}

EdgeTable collect_edges(const Mesh& mesh) {
  EdgeTable table;
  table.first.assign(mesh.vertices.size() + 1, 0);
  for_each_triangle_edge(mesh, [&](std::uint32_t a, std::uint32_t) { ++table.first[a + 1]; });
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    table.first[v + 1] += table.first[v];
  }
  table.larger.resize(table.first.back());
  std::vector<std::uint32_t> next(table.first.begin(), table.first.end() - 1);
  for_each_triangle_edge(mesh,
                         [&](std::uint32_t a, std::uint32_t b) { table.larger[next[a]++] = b; });
  // Sorts each bucket and closes the gaps that its duplicates leave.
  std::uint32_t write = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto begin = table.larger.begin() + (v == 0 ? 0 : next[v - 1]);
    const auto end = table.larger.begin() + next[v];
    std::sort(begin, end);
    const auto last = std::unique(begin, end);
    table.first[v] = write;
    write = static_cast<std::uint32_t>(std::copy(begin, last, table.larger.begin() + write) -
                                       table.larger.begin());
  }
  table.first.back() = write;
  table.larger.resize(write);
  table.larger.shrink_to_fit();
  return table;
}

std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
  return std::rotl((hash ^ word) * 0x9e3779b97f4a7c15u, 29);
}

std::uint64_t mix_vector(std::uint64_t hash, const Eigen::Vector3d& v) {
  for (int k = 0; k < 3; ++k) {
    hash = mix(hash, std::bit_cast<std::uint64_t>(v[k]));
  }
  return hash;
}

std::uint64_t content_hash(const Mesh& mesh, double radius, Filling filling) {
  std::uint64_t hash = mix(mesh.triangles.size(), std::bit_cast<std::uint64_t>(radius));
  hash = filling == Filling::solid ? mix(hash, 1) : hash;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    hash = mix_vector(hash, v);
  }
  for (const auto& t : mesh.triangles) {
    hash = mix(hash, std::uint64_t{t[0]} << 32 | t[1]);
    hash = mix(hash, t[2]);
  }
  return hash;
}

std::vector<std::uint32_t> list_components(const Mesh& mesh, const Hierarchy& hierarchy) {
  DisjointSets sets = vertex_components(mesh);
  std::vector<bool> seen(mesh.vertices.size(), false);
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t v = 0; v < hierarchy.vertices.size(); ++v) {
    const std::uint32_t root = sets.root(hierarchy.vertex_index[v]);
    if (!seen[root]) {
      seen[root] = true;
      vertices.push_back(v);
    }
  }
  return vertices;
}

}  // namespace

namespace {

/// Finds the own features of a shape; they are computed when first needed.
std::vector<std::uint8_t> find_own_features(const Shape& shape) {
  const Mesh& mesh = shape.mesh();
  std::vector<bool> has_vertex(mesh.vertices.size(), false);
  std::vector<bool> has_edge(shape.edge_count(), false);
  std::vector<std::uint8_t> own;
  own.reserve(mesh.triangles.size());
  for (const std::uint32_t triangle : shape.hierarchy().triangle_index) {
    const auto& t = mesh.triangles[triangle];
    unsigned features = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t next = t[(k + 1) % 3];
      if (t[k] == next) {
        features = 0x3f;
        break;
      }
      const std::uint32_t edge = shape.edge_index(t[k], next);
      features |= has_vertex[t[k]] ? 0u : 1u << k;
      features |= has_edge[edge] ? 0u : 8u << k;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      has_vertex[t[k]] = true;
      if (t[k] != t[(k + 1) % 3]) {
        has_edge[shape.edge_index(t[k], t[(k + 1) % 3])] = true;
      }
    }
    own.push_back(static_cast<std::uint8_t>(features));
  }
  return own;
}

struct LazyBounds {
  std::once_flag found;
  ShapeBounds bounds;
};

struct LazyFeatures {
  std::once_flag found;
  std::vector<std::uint8_t> of_triangles;
  std::once_flag tabled;
  FeatureTable table;
};

struct LazyScrewSliding {
  std::once_flag found;
  std::optional<ScrewSlidingSurface> surface;
};

/// The convex set that a shape is, in the body frame.
struct ExactSet {
  explicit ExactSet(const ConvexSet& given) : set(given) {}

  ConvexSet set;
  std::once_flag found;
  Hierarchy hierarchy;
};

std::optional<ScrewSlidingSurface> find_screw_sliding_surface(const Hierarchy& hierarchy) {
  const std::optional<ScrewSliding> screw_sliding = find_screw_sliding(hierarchy);
  if (!screw_sliding) {
    return std::nullopt;
  }
  ScrewSlidingSurface surface{.screw_sliding = *screw_sliding,
                              .order = order_along(*screw_sliding, hierarchy),
                              .bounds = {}};
  const Eigen::Vector3d p_SB = -(screw_sliding->R_SB * screw_sliding->p_BS);
  bound_screw_sliding(*screw_sliding, hierarchy, surface.order,
                      {{screw_sliding->R_SB, screw_sliding->R_SB}, {p_SB, p_SB}}, false,
                      surface.bounds);
  surface.bounds.release_vertices();
  return surface;
}

}  // namespace

struct Shape::Data {
  Mesh mesh;
  double radius = 0.0;
  Filling filling = Filling::surface;
  double enclosure_error = 0.0;
  EdgeTable edges;
  Hierarchy hierarchy;
  std::vector<Eigen::Vector3d> to;  // Empty where it does not deform.
  Eigen::Vector3d translation_to = Eigen::Vector3d::Zero();
  std::vector<std::uint32_t> components;
  std::uint64_t hash = 0;
  std::shared_ptr<LazyBounds> bounds = std::make_shared<LazyBounds>();
  std::shared_ptr<LazyScrewSliding> screw_sliding = std::make_shared<LazyScrewSliding>();
  // The same at all times.
  std::shared_ptr<LazyFeatures> own_features = std::make_shared<LazyFeatures>();
  std::shared_ptr<ExactSet> exact;  // Null where none is known.
};

Shape::Shape(Mesh mesh, double radius, Filling filling, double enclosure_error) {
  require_length("radius", radius);
  require_length("enclosure_error", enclosure_error);
  validate(mesh);
  if (filling == Filling::solid) {
    require_solid(mesh);
  }
  auto data = std::make_shared<Data>();
  data->mesh = std::move(mesh);
  data->radius = radius;
  data->filling = filling;
  data->enclosure_error = enclosure_error;
  data->edges = collect_edges(data->mesh);
  data->hierarchy = build_hierarchy(data->mesh);
  data->components = list_components(data->mesh, data->hierarchy);
  data->hash = content_hash(data->mesh, radius, filling);
  data_ = std::move(data);
}

Shape::Shape(Mesh mesh, Filling filling, double enclosure_error, const ConvexSet& set)
    : Shape(std::move(mesh), set.rounding(), filling, enclosure_error) {
  auto data = std::make_shared<Data>(*data_);
  data->exact = std::make_shared<ExactSet>(set);
  if (enclosure_error > 0.0) {  // Otherwise the triangles are the same body.
    data->hash = mix(data->hash, 2 + static_cast<std::uint64_t>(set.core().kind));
  }
  data_ = std::move(data);
}

Shape Shape::as_triangles() const {
  if (!data_->exact) {
    return *this;
  }
  auto data = std::make_shared<Data>(*data_);
  data->exact.reset();
  data->hash = content_hash(data->mesh, data->radius, data->filling);
  Shape shape = *this;
  shape.data_ = std::move(data);
  return shape;
}

Shape Shape::deforming(std::span<const Eigen::Vector3d> to,
                       const Eigen::Vector3d& translation) const {
  if (to.size() != data_->mesh.vertices.size()) {
    throw std::invalid_argument("Shape: deforming needs a place for each of the " +
                                std::to_string(data_->mesh.vertices.size()) + " vertices, got " +
                                std::to_string(to.size()));
  }
  if (data_->enclosure_error > 0.0) {
    throw std::invalid_argument("Shape: triangles that enclose a curved body cannot deform");
  }
  require_position("the translation", translation);
  for (std::size_t v = 0; v < to.size(); ++v) {
    require_position("where vertex " + std::to_string(v) + " moves to", to[v]);
  }
  const Hierarchy& rest = data_->hierarchy;
  const DoubleDoubleVector3 centre =
      DoubleDoubleVector3(rest.centre) + DoubleDoubleVector3(translation);
  std::vector<Eigen::Vector3d> relative;
  relative.reserve(rest.vertex_index.size());
  std::uint64_t hash = mix_vector(data_->hash, translation);
  for (const std::uint32_t v : rest.vertex_index) {
    relative.push_back((DoubleDoubleVector3(to[v]) - centre).value());
    hash = mix_vector(hash, to[v]);
  }
  auto data = std::make_shared<Data>(*data_);
  data->hierarchy = deforming_hierarchy(rest, std::move(relative));
  data->to.assign(to.begin(), to.end());
  data->translation_to = translation;
  data->hash = hash;
  data->exact.reset();
  data->bounds = std::make_shared<LazyBounds>();
  data->screw_sliding = std::make_shared<LazyScrewSliding>();
  Shape shape = *this;
  shape.data_ = std::move(data);
  return shape;
}

const Mesh& Shape::mesh() const { return data_->mesh; }

std::span<const Eigen::Vector3d> Shape::vertices_to() const { return data_->to; }

const Eigen::Vector3d& Shape::translation_to() const { return data_->translation_to; }

double Shape::radius() const { return data_->radius; }

bool Shape::is_solid() const { return data_->filling == Filling::solid; }

double Shape::enclosure_error() const { return data_->enclosure_error; }

const ConvexSet* Shape::convex_set() const { return data_->exact ? &data_->exact->set : nullptr; }

bool Shape::is_curved() const {
  if (!data_->exact || !(data_->enclosure_error > 0.0)) {
    return false;
  }
  const ConvexKind kind = data_->exact->set.core().kind;
  return kind == ConvexKind::cylinder || kind == ConvexKind::cone || kind == ConvexKind::ellipsoid;
}

ConvexCore Shape::convex_core() const {
  assert(data_->exact);
  const Hierarchy& hierarchy = data_->hierarchy;
  ConvexCore core = data_->exact->set.core_from(hierarchy.centre);
  if (core.kind == ConvexKind::hull) {
    core.origin.setZero();
    core.points = hierarchy.vertices;
    core.reach = hierarchy.radius;
  }
  // The triangles enclose the set. Bounds of motions are made for their radius, with a small
  // excess.
  core.reach = std::min(core.reach, hierarchy.radius * (1.0 + 0x1p-46));
  return core;
}

const Hierarchy& Shape::convex_hierarchy() const {
  assert(data_->exact);
  ExactSet& exact = *data_->exact;
  std::call_once(exact.found, [&] {
    exact.hierarchy = detail::convex_hierarchy(convex_core(), data_->hierarchy.centre);
  });
  return exact.hierarchy;
}

std::span<const std::uint32_t> Shape::component_vertices() const { return data_->components; }

std::size_t Shape::edge_count() const { return data_->edges.larger.size(); }

std::array<std::uint32_t, 2> Shape::edge(std::size_t index) const {
  const EdgeTable& edges = data_->edges;
  const auto number = static_cast<std::uint32_t>(index);
  const auto after = std::upper_bound(edges.first.begin(), edges.first.end(), number);
  return {static_cast<std::uint32_t>(after - edges.first.begin() - 1), edges.larger.at(index)};
}

std::uint32_t Shape::edge_index(std::uint32_t vertex, std::uint32_t other) const {
  const EdgeTable& edges = data_->edges;
  const auto [a, b] = std::minmax(vertex, other);
  const auto begin = edges.larger.begin() + edges.first.at(a);
  const auto end = edges.larger.begin() + edges.first.at(a + 1);
  const auto found = std::lower_bound(begin, end, b);
  if (found == end || *found != b) {
    throw std::invalid_argument("Shape::edge_index: no triangle has an edge between vertices " +
                                std::to_string(vertex) + " and " + std::to_string(other));
  }
  return static_cast<std::uint32_t>(found - edges.larger.begin());
}

const Hierarchy& Shape::hierarchy() const { return data_->hierarchy; }

std::span<const std::uint8_t> Shape::own_features() const {
  std::call_once(data_->own_features->found,
                 [&] { data_->own_features->of_triangles = find_own_features(*this); });
  return data_->own_features->of_triangles;
}

const FeatureTable& Shape::feature_table() const {
  std::call_once(data_->own_features->tabled,
                 [&] { data_->own_features->table = firstcontact::feature_table(*this); });
  return data_->own_features->table;
}

const ShapeBounds& Shape::bounds() const {
  std::call_once(data_->bounds->found,
                 [&] { data_->bounds->bounds = shape_bounds(data_->hierarchy); });
  return data_->bounds->bounds;
}

const ScrewSlidingSurface* Shape::screw_sliding() const {
  assert(!data_->hierarchy.deforms());
  std::call_once(data_->screw_sliding->found, [&] {
    data_->screw_sliding->surface = find_screw_sliding_surface(data_->hierarchy);
  });
  return data_->screw_sliding->surface ? &*data_->screw_sliding->surface : nullptr;
}

int Shape::compare(const Shape& other) const {
  if (data_ == other.data_ || data_->hash == other.data_->hash) {
    return 0;
  }
  return data_->hash < other.data_->hash ? -1 : 1;
}

}  // namespace firstcontact
