#include <firstcontact/geometry/hierarchy.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <firstcontact/geometry/detail/spatial_order.h>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A triangle while it is being sorted: its index, and its key along the axis of the next split.
struct Item {
  float key;
  std::uint32_t triangle;
};

struct Box {
  Vector3d centre = Vector3d::Zero();
  Matrix3d axes = Matrix3d::Identity();  // One per row, right-handed.
  Vector3d extent = Vector3d::Zero();

  [[nodiscard]] double half_area() const {
    return extent.x() * extent.y() + extent.y() * extent.z() + extent.z() * extent.x();
  }
  [[nodiscard]] int longest() const {
    Eigen::Index axis = 0;
    extent.maxCoeff(&axis);
    return static_cast<int>(axis);
  }
};

/// Cosines and sines of 15, 30, 45, 60 and 75 degrees.
constexpr std::array<std::array<double, 2>, 5> kTurns{{{0.9659258262890683, 0.25881904510252074},
                                                       {0.8660254037844387, 0.5},
                                                       {0.7071067811865476, 0.7071067811865476},
                                                       {0.5, 0.8660254037844387},
                                                       {0.25881904510252074, 0.9659258262890683}}};

constexpr std::size_t kSampledTriangles = 48;     // Decide between candidate frames.
constexpr std::size_t kParallelTriangles = 8192;  // Below this a subtree is built by one task.

bool is_point(const std::array<std::uint32_t, 3>& t) { return t[0] == t[1] && t[1] == t[2]; }

class Builder {
 public:
  explicit Builder(const Mesh& mesh, const Hierarchy& hierarchy)
      : mesh_(mesh), centre_(hierarchy.centre), scale_(1.0 / hierarchy.unit) {}

  /// Builds the subtree over the items as its own array, root first; sorts the items in its order.
  std::vector<HierarchyNode> build(std::span<Item> items, std::uint32_t first_triangle) const {
    std::vector<HierarchyNode> nodes;
    if (items.size() > kParallelTriangles) {
      build_parallel(items, first_triangle, nodes);
    } else {
      nodes.reserve(items.size() / 2 + 1);
      nodes.emplace_back();
      build_serial(items, first_triangle, 0, nodes);
    }
    return nodes;
  }

 private:
  using Parts = std::array<std::span<Item>, HierarchyNode::kWidth>;

  [[nodiscard]] Vector3d vertex(std::uint32_t index) const {
    return (mesh_.vertices[index] - centre_) * scale_;
  }

  void build_serial(std::span<Item> items, std::uint32_t first_triangle, std::size_t index,
                    std::vector<HierarchyNode>& nodes) const {
    Parts parts = split_in_four(items);
    const std::size_t children = nodes.size();
    const std::size_t inner = fill_node(parts, first_triangle, children, nodes[index]);
    nodes.resize(children + inner);
    std::size_t child = children;
    for (const std::span<Item>& part : parts) {
      if (part.size() > 1) {
        build_serial(part, first_triangle + offset(items, part), child++, nodes);
      }
    }
  }

  void build_parallel(std::span<Item> items, std::uint32_t first_triangle,
                      std::vector<HierarchyNode>& nodes) const {
    Parts parts = split_in_four(items);
    std::array<std::vector<HierarchyNode>, HierarchyNode::kWidth> subtrees;
    tbb::parallel_for(0, HierarchyNode::kWidth, [&](int k) {
      if (parts[k].size() > 1) {
        subtrees[k] = build(parts[k], first_triangle + offset(items, parts[k]));
      }
    });
    nodes.resize(1);
    const std::size_t inner = fill_node(parts, first_triangle, 1, nodes[0]);
    std::size_t total = 1;
    for (const auto& subtree : subtrees) {
      total += subtree.size();
    }
    nodes.reserve(total);
    nodes.resize(1 + inner);
    std::size_t root = 1;
    for (std::vector<HierarchyNode>& subtree : subtrees) {
      if (subtree.empty()) {
        continue;
      }
      // The subtree's node i > 0 moves to nodes.size() + i - 1.
      const auto shift = static_cast<std::uint32_t>(nodes.size() - 1);
      for (HierarchyNode& node : subtree) {
        node.node_base_and_used += shift << 4;
      }
      nodes[root++] = subtree[0];
      nodes.insert(nodes.end(), subtree.begin() + 1, subtree.end());
      subtree = {};
    }
  }

  static std::uint32_t offset(std::span<Item> items, std::span<Item> part) {
    return static_cast<std::uint32_t>(part.data() - items.data());
  }

  /// Writes boxes and links; returns how many children are nodes.
  std::size_t fill_node(const Parts& parts, std::uint32_t first_triangle, std::size_t node_base,
                        HierarchyNode& node) const {
    unsigned used = 0;
    unsigned leaf = 0;
    for (int k = 0; k < HierarchyNode::kWidth; ++k) {
      const bool empty = parts[k].empty();
      used |= empty ? 0u : 1u << k;
      leaf |= parts[k].size() == 1 ? 1u << k : 0u;
      store(empty ? Box{} : fit(parts[k]), parts[k], k, node);
    }
    node.node_base_and_used = static_cast<std::uint32_t>(node_base) << 4 | used;
    node.triangle_base_and_leaf = first_triangle << 4 | leaf;
    return static_cast<std::size_t>(std::popcount(used & ~leaf));
  }

  /// Splits twice at the median; single triangles come first, so that they are neighbours.
  Parts split_in_four(std::span<Item> items) const {
    Parts parts;
    std::size_t count = 0;
    if (items.size() <= parts.size()) {
      for (std::size_t i = 0; i < items.size(); ++i) {
        parts[count++] = items.subspan(i, 1);
      }
      return parts;
    }
    const auto [low, high] = split(items);
    for (const std::span<Item>& half : {low, high}) {
      if (half.size() == 1) {
        parts[count++] = half;
      } else {
        const auto [a, b] = split(half);
        parts[count++] = a;
        parts[count++] = b;
      }
    }
    gather_single_triangles(items, std::span(parts.data(), count));
    return parts;
  }

  static void gather_single_triangles(std::span<Item> items, std::span<std::span<Item>> parts) {
    std::array<std::size_t, HierarchyNode::kWidth> sizes{};
    std::size_t singles = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (parts[k].size() == 1) {
        // Moves the part to the front; the parts before it keep their order.
        std::rotate(items.begin() + static_cast<std::ptrdiff_t>(singles), parts[k].begin(),
                    parts[k].end());
        ++singles;
      }
    }
    std::size_t count = 0;
    for (std::size_t k = 0; k < singles; ++k) {
      sizes[count++] = 1;
    }
    for (const std::span<Item>& part : parts) {
      if (part.size() > 1) {
        sizes[count++] = part.size();
      }
    }
    std::size_t begin = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      parts[k] = items.subspan(begin, sizes[k]);
      begin += sizes[k];
    }
  }

  /// Splits in two halves by the median of the triangle centres along the principal axis.
  std::pair<std::span<Item>, std::span<Item>> split(std::span<Item> items) const {
    const Vector3d axis = principal_axes(items).row(0).transpose();
    for (Item& item : items) {
      const auto& t = mesh_.triangles[item.triangle];
      item.key = static_cast<float>(axis.dot(mesh_.vertices[t[0]] + mesh_.vertices[t[1]] +
                                             mesh_.vertices[t[2]] - 3.0 * centre_) *
                                    scale_);
    }
    const std::size_t middle = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle),
                     items.end(), [](const Item& a, const Item& b) {
                       return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
                     });
    return {items.subspan(0, middle), items.subspan(middle)};
  }

  /// Finds the principal axes, one per row: unit axes by falling variance of the corners.
  Matrix3d principal_axes(std::span<const Item> items) const {
    // Large ranges are sampled: the axes only steer the quality of the boxes.
    const std::size_t stride = std::max<std::size_t>(1, items.size() / 4096);
    Vector3d sum = Vector3d::Zero();
    Matrix3d products = Matrix3d::Zero();
    double count = 0.0;
    for (std::size_t i = 0; i < items.size(); i += stride) {
      for (const std::uint32_t v : mesh_.triangles[items[i].triangle]) {
        const Vector3d p = vertex(v);
        sum += p;
        products.noalias() += p * p.transpose();
        count += 1.0;
      }
    }
    const Matrix3d covariance = products / count - (sum / count) * (sum / count).transpose();
    Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
    solver.computeDirect(covariance);
    return right_handed(solver.eigenvectors().col(2), solver.eigenvectors().col(1));
  }

  /// Makes axes from two directions that need not be exactly orthogonal or unit.
  static Matrix3d right_handed(const Vector3d& first, const Vector3d& second) {
    Matrix3d axes = Matrix3d::Identity();
    const Vector3d x = first.normalized();
    const Vector3d z = x.cross(second);
    if (!(x.squaredNorm() > 0.5) || !(z.squaredNorm() > 0.0)) {
      return axes;
    }
    axes.row(0) = x;
    axes.row(2) = z.normalized();
    axes.row(1) = axes.row(2).transpose().cross(x);
    return axes.allFinite() ? axes : Matrix3d::Identity();
  }

  template <class Use>
  void for_each_corner(std::span<const Item> items, std::size_t stride, const Use& use) const {
    for (std::size_t i = 0; i < items.size(); i += stride) {
      const auto& t = mesh_.triangles[items[i].triangle];
      use(vertex(t[0]));
      if (!is_point(t)) {
        use(vertex(t[1]));
        use(vertex(t[2]));
      }
    }
  }

  Box bounds(std::span<const Item> items, const Matrix3d& axes, std::size_t stride) const {
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
    Vector3d high = -low;
    for_each_corner(items, stride, [&](const Vector3d& p) {
      const Vector3d q = axes * p;
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    });
    return {axes.transpose() * (0.5 * (low + high)), axes, 0.5 * (high - low)};
  }

  Box fit(std::span<const Item> items) const {
    return items.size() == 1 ? fit_triangle(items) : fit_many(items);
  }

  /// Fits a box to one triangle: in the frame of the edge that gives the smallest box.
  Box fit_triangle(std::span<const Item> items) const {
    const auto& t = mesh_.triangles[items.front().triangle];
    const std::array<Vector3d, 3> p{vertex(t[0]), vertex(t[1]), vertex(t[2])};
    if (is_point(t)) {
      return {p[0], Matrix3d::Identity(), Vector3d::Zero()};
    }
    Box best = bounds(items, edge_frame(p, 0), 1);
    for (int k = 1; k < 3; ++k) {
      const Box box = bounds(items, edge_frame(p, k), 1);
      if (box.half_area() < best.half_area()) {
        best = box;
      }
    }
    return best;
  }

  static Matrix3d edge_frame(const std::array<Vector3d, 3>& p, int k) {
    return right_handed(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
  }

  /// Fits a box to many triangles: the smallest of the principal frame, its turns about the
  /// thinnest axis, and the body frame.
  Box fit_many(std::span<const Item> items) const {
    const Matrix3d principal = principal_axes(items);
    const std::size_t stride = std::max<std::size_t>(1, items.size() / kSampledTriangles);
    Matrix3d best = principal;
    double least = bounds(items, principal, stride).half_area();
    const auto consider = [&](const Matrix3d& axes) {
      const double area = bounds(items, axes, stride).half_area();
      if (area < least) {
        least = area;
        best = axes;
      }
    };
    consider(Matrix3d::Identity());
    for (const auto& [cosine, sine] : kTurns) {
      consider(right_handed((cosine * principal.row(0) + sine * principal.row(1)).transpose(),
                            (cosine * principal.row(1) - sine * principal.row(0)).transpose()));
    }
    return bounds(items, best, 1);
  }

  /// Names the axes of a box, with the longest last, so that its rotation is the smallest of eight.
  /// Its angle is at most 99 degrees. So the scalar part of the quaternion follows from the vector
  /// part.
  static Eigen::Quaterniond smallest_rotation(const Box& box) {
    const int longest = box.longest();
    const std::array<int, 2> others{(longest + 1) % 3, (longest + 2) % 3};
    const auto rows = [&](int order) {
      return std::array<int, 3>{others[order], others[1 - order], longest};
    };
    const auto sign = [](int signs, int row) { return (signs >> row & 1) != 0 ? -1.0 : 1.0; };
    int best_order = 0;
    int best_signs = 0;
    double largest_trace = -4.0;
    for (int order = 0; order < 2; ++order) {
      const std::array<int, 3> r = rows(order);
      const Vector3d diagonal(box.axes(r[0], 0), box.axes(r[1], 1), box.axes(r[2], 2));
      for (int signs = 0; signs < 8; ++signs) {
        // Right-handed: the number of negative signs is even, or odd where two rows are exchanged.
        const bool is_right_handed = ((signs ^ signs >> 1 ^ signs >> 2) & 1) == order;
        const double trace = sign(signs, 0) * diagonal[0] +
                             (sign(signs, 1) * diagonal[1] + sign(signs, 2) * diagonal[2]);
        if (is_right_handed && trace > largest_trace) {
          largest_trace = trace;
          best_order = order;
          best_signs = signs;
        }
      }
    }
    Matrix3d best;
    for (int k = 0; k < 3; ++k) {
      best.row(k) = sign(best_signs, k) * box.axes.row(rows(best_order)[k]);
    }
    Eigen::Quaterniond q(best);
    q.normalize();
    if (q.w() < 0.0) {
      q.coeffs() = -q.coeffs();
    }
    return q;
  }

  /// Rounds a box outward into its slot: the extents are computed anew for the rounded axes.
  void store(const Box& box, std::span<const Item> items, int slot, HierarchyNode& node) const {
    const Eigen::Quaterniond q = smallest_rotation(box);
    for (int k = 0; k < 3; ++k) {
      node.centre[k][slot] = static_cast<float>(box.centre[k]);
      node.rotation[k][slot] = static_cast<float>(q.vec()[k]);
      node.extent[k][slot] = 0;
    }
    const Matrix3d axes = box_axes(node, slot);
    const Vector3d centre(node.centre[0][slot], node.centre[1][slot], node.centre[2][slot]);
    Vector3d extent = Vector3d::Zero();
    for_each_corner(items, 1, [&](const Vector3d& p) {
      extent = extent.cwiseMax((axes * (p - centre)).cwiseAbs());
    });
    for (int k = 0; k < 3; ++k) {
      // 2^-48 covers the axes (2^-50), the vertices and this dot product, all of them below 2.
      node.extent[k][slot] =
          items.empty() ? std::uint16_t{0} : HierarchyNode::extent_code(extent[k] + 0x1p-48);
    }
  }

  const Mesh& mesh_;
  Vector3d centre_;
  double scale_;
};

void set_bounds(const Mesh& mesh, Hierarchy& hierarchy) {
  Vector3d low = mesh.vertices[mesh.triangles[0][0]];
  Vector3d high = low;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      low = low.cwiseMin(mesh.vertices[v]);
      high = high.cwiseMax(mesh.vertices[v]);
    }
  }
  hierarchy.centre = low + 0.5 * (high - low);
  double radius2 = 0.0;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      radius2 = std::max(radius2, (mesh.vertices[v] - hierarchy.centre).squaredNorm());
    }
  }
  hierarchy.radius = std::sqrt(radius2) * (1.0 + 0x1p-48);
  hierarchy.unit = hierarchy.radius > 0.0 ? std::exp2(std::ceil(std::log2(hierarchy.radius))) : 1.0;
}

/// Copies triangles and vertices in the order of the hierarchy.
void sort_mesh(const Mesh& mesh, std::span<const Item> items, Hierarchy& hierarchy) {
  constexpr std::uint32_t kUnseen = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> sorted(mesh.vertices.size(), kUnseen);
  hierarchy.triangles.reserve(items.size());
  hierarchy.triangle_index.reserve(items.size());
  hierarchy.vertices.reserve(mesh.vertices.size());
  hierarchy.vertex_index.reserve(mesh.vertices.size());
  for (const Item& item : items) {
    std::array<std::uint32_t, 3> triangle = mesh.triangles[item.triangle];
    for (std::uint32_t& v : triangle) {
      if (sorted[v] == kUnseen) {
        sorted[v] = static_cast<std::uint32_t>(hierarchy.vertices.size());
        hierarchy.vertices.emplace_back(mesh.vertices[v] - hierarchy.centre);
        hierarchy.vertex_index.push_back(v);
      }
      v = sorted[v];
    }
    hierarchy.triangles.push_back(triangle);
    hierarchy.triangle_index.push_back(item.triangle);
  }
}

Hierarchy build(const Mesh& mesh) {
  Hierarchy hierarchy;
  set_bounds(mesh, hierarchy);
  std::vector<Item> items(mesh.triangles.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    items[i].triangle = static_cast<std::uint32_t>(i);
  }
  hierarchy.nodes = Builder(mesh, hierarchy).build(items, 0);
  sort_mesh(mesh, items, hierarchy);
  return hierarchy;
}

/// Number of triangles from which building waits for memory more than it computes.
constexpr std::size_t kScatteredTriangles = 100'000;

}  // namespace

std::uint16_t HierarchyNode::extent_code(double value) {
  auto f = static_cast<float>(std::max(value, 0x1p-62));
  if (static_cast<double>(f) < value) {
    f = std::nextafter(f, std::numeric_limits<float>::infinity());
  }
  const auto bits = std::bit_cast<std::uint32_t>(f) - kExtentOrigin;
  constexpr std::uint32_t kDropped = (1u << kExtentShift) - 1u;
  return static_cast<std::uint16_t>((bits + kDropped) >> kExtentShift);
}

Hierarchy build_hierarchy(const Mesh& mesh) {
  if (mesh.triangles.size() <= kScatteredTriangles) {
    return build(mesh);
  }
  const detail::SpatialOrder sorted = detail::spatial_order(mesh);
  Hierarchy hierarchy = build(sorted.mesh);
  for (std::uint32_t& v : hierarchy.vertex_index) {
    v = sorted.vertex_index[v];
  }
  for (std::uint32_t& t : hierarchy.triangle_index) {
    t = sorted.triangle_index[t];
  }
  return hierarchy;
}

Eigen::Matrix3d box_axes(const HierarchyNode& node, int slot) {
  const Vector3d v(node.rotation[0][slot], node.rotation[1][slot], node.rotation[2][slot]);
  const Eigen::Quaterniond q(std::sqrt(1.0 - v.squaredNorm()), v.x(), v.y(), v.z());
  return q.toRotationMatrix();
}

}  // namespace firstcontact
