#include "signed_distance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kLeaf = 4;  // [triangles]
constexpr double kOpposed = -0.2;   // [-]  Cosine of normals from which on they are opposed.

/// Finds the nearest place of a triangle.
///
/// @returns  the feature: 0 to 2 a corner, 3 to 5 the edge that begins at it, 6 the face
int nearest_of(const std::array<Vector3d, 3>& corners, const Vector3d& p, Vector3d& place) {
  // C. Ericson, "Real-Time Collision Detection" (2005), section 5.1.5.
  const auto& [a, b, c] = corners;
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0.0 && d2 <= 0.0) {
    place = a;
    return 0;
  }
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0.0 && d4 <= d3) {
    place = b;
    return 1;
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    place = a + (d1 / (d1 - d3)) * ab;
    return 3;
  }
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0.0 && d5 <= d6) {
    place = c;
    return 2;
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    place = a + (d2 / (d2 - d6)) * ac;
    return 5;
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    place = b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
    return 4;
  }
  const double sum = va + vb + vc;
  place = a + (vb / sum) * ab + (vc / sum) * ac;
  return 6;
}

double squared_distance(const Vector3d& lower, const Vector3d& upper, const Vector3d& p) {
  return (p - p.cwiseMax(lower).cwiseMin(upper)).squaredNorm();
}

/// Finds the first vertex at the place of each vertex, to 10 nm.
std::vector<std::uint32_t> merged(const std::vector<Vector3d>& vertices) {
  std::vector<std::uint32_t> same;
  std::map<std::array<std::int64_t, 3>, std::uint32_t> known;
  for (const Vector3d& vertex : vertices) {
    const std::array key{std::llround(1e8 * vertex[0]), std::llround(1e8 * vertex[1]),
                         std::llround(1e8 * vertex[2])};
    same.push_back(
        known.try_emplace({key[0], key[1], key[2]}, static_cast<std::uint32_t>(same.size()))
            .first->second);
  }
  return same;
}

}  // namespace

SignedDistance::SignedDistance(const Mesh& mesh) {
  for (const auto& corners : mesh.triangles) {
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corners[k] = mesh.vertices[corners[k]];
    }
    triangle.normal = (triangle.corners[1] - triangle.corners[0])
                          .cross(triangle.corners[2] - triangle.corners[0]);
    const double length = triangle.normal.norm();
    triangle.normal /= length > 0.0 ? length : 1.0;
    triangles_.push_back(triangle);
  }
  set_pseudo_normals(mesh);
  std::erase_if(triangles_, [](const Triangle& t) { return t.normal.isZero(0.0); });
  build(0, static_cast<std::uint32_t>(triangles_.size()));
}

// J. A. Baerentzen, H. Aanaes, "Signed distance computation using the angle weighted pseudonormal",
// IEEE Transactions on Visualization and Computer Graphics 11 (2005).
void SignedDistance::set_pseudo_normals(const Mesh& mesh) {
  const std::vector<std::uint32_t> same = merged(mesh.vertices);
  std::vector<Vector3d> of_vertices(mesh.vertices.size(), Vector3d::Zero());
  std::map<std::pair<std::uint32_t, std::uint32_t>, Vector3d> of_edges;
  const auto vertex = [&](std::size_t t, std::size_t k) { return same[mesh.triangles[t][k % 3]]; };
  const auto edge = [&](std::size_t t, std::size_t k) -> Vector3d& {
    const auto [a, b] = std::minmax({vertex(t, k), vertex(t, k + 1)});
    return of_edges.try_emplace({a, b}, Vector3d::Zero()).first->second;
  };
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& triangle = triangles_[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d to_next = triangle.corners[(k + 1) % 3] - triangle.corners[k];
      const Vector3d to_last = triangle.corners[(k + 2) % 3] - triangle.corners[k];
      const double angle = std::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last));
      of_vertices[vertex(t, k)] += angle * triangle.normal;
      edge(t, k) += triangle.normal;
    }
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      triangles_[t].pseudo[k] = of_vertices[vertex(t, k)];
      triangles_[t].pseudo[k + 3] = edge(t, k);
    }
  }
}

void SignedDistance::build(std::uint32_t begin, std::uint32_t end) {
  const std::size_t at = nodes_.size();
  Node node{.lower = Vector3d::Constant(1e300), .upper = Vector3d::Constant(-1e300)};
  for (std::uint32_t t = begin; t < end; ++t) {
    for (const Vector3d& corner : triangles_[t].corners) {
      node.lower = node.lower.cwiseMin(corner);
      node.upper = node.upper.cwiseMax(corner);
    }
  }
  node.first = begin;
  node.count = end - begin;
  nodes_.push_back(node);
  if (node.count <= kLeaf) {
    return;
  }
  int axis = 0;
  (node.upper - node.lower).maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle,
                   triangles_.begin() + end, [axis](const Triangle& a, const Triangle& b) {
                     return a.corners[0][axis] + a.corners[1][axis] + a.corners[2][axis] <
                            b.corners[0][axis] + b.corners[1][axis] + b.corners[2][axis];
                   });
  build(begin, middle);
  nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[at].count = 0;
  build(middle, end);
}

bool SignedDistance::nearest(const Vector3d& point, double most, const Vector3d* against,
                             std::uint32_t& hint, NearestPlace& found) const {
  double best = most * most;
  bool has_found = false;
  const auto test = [&](std::uint32_t t) {
    const Triangle& triangle = triangles_[t];
    if (against != nullptr && triangle.normal.dot(*against) > kOpposed) {
      return;
    }
    Vector3d place;
    const int feature = nearest_of(triangle.corners, point, place);
    const double distance = (point - place).squaredNorm();
    if (distance < best) {
      best = distance;
      has_found = true;
      hint = t;
      const Vector3d& normal =
          feature < 6 ? triangle.pseudo[static_cast<std::size_t>(feature)] : triangle.normal;
      found = {.distance = std::sqrt(distance),
               .place = place,
               .normal = triangle.normal,
               .is_inside = normal.dot(point - place) < 0.0};
    }
  };
  test(hint);
  std::array<std::uint32_t, 64> stack{};
  std::size_t size = 1;
  while (size > 0) {
    const std::uint32_t at = stack[--size];
    const Node& node = nodes_[at];
    if (squared_distance(node.lower, node.upper, point) >= best) {
      continue;
    }
    if (node.count > 0) {
      for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
        test(t);
      }
      continue;
    }
    const auto far = [&](std::uint32_t child) {
      return squared_distance(nodes_[child].lower, nodes_[child].upper, point);
    };
    const bool second_is_nearer = far(node.first) < far(at + 1);
    stack[size++] = second_is_nearer ? at + 1 : node.first;
    stack[size++] = second_is_nearer ? node.first : at + 1;
  }
  return has_found;
}

}  // namespace firstcontact
