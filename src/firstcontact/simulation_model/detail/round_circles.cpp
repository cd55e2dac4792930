#include <firstcontact/simulation_model/detail/round_circles.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include <firstcontact/simulation_model/detail/constants.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Vertex = std::uint32_t;

/// [-]  Corners are on a circle if they are as near to it, by its radius and by their coordinates:
/// files have few digits.
constexpr double kOnCircle = 1e-5;
constexpr double kOnCircleOfCoordinates = 0x1p-23;
/// [-]  Edges of a polygon differ by less, by their length.
constexpr double kSameEdge = 0.01;
/// [rad]  Edges that turn by less are straight.
constexpr double kStraight = 1e-4;

/// The vertices that edges join to each vertex.
class JoinedVertices {
 public:
  explicit JoinedVertices(const Mesh& mesh) : first_(mesh.vertices.size() + 1, 0) {
    std::vector<std::array<Vertex, 2>> pairs;
    for (const auto& [a, b, c] : mesh.triangles) {
      for (const auto& [x, y] : {std::array{a, b}, std::array{b, c}, std::array{c, a}}) {
        pairs.push_back({x, y});
        pairs.push_back({y, x});
      }
    }
    std::ranges::sort(pairs);
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [from, to] : pairs) {
      ++first_[from + 1];
      to_.push_back(to);
    }
    for (std::size_t v = 1; v < first_.size(); ++v) {
      first_[v] += first_[v - 1];
    }
  }

  [[nodiscard]] std::span<const Vertex> of(Vertex v) const {
    return std::span(to_).subspan(first_[v], first_[v + 1] - first_[v]);
  }

 private:
  std::vector<std::size_t> first_;  // Of vertex v: first_[v] to first_[v + 1].
  std::vector<Vertex> to_;
};

/// Follows edges of one length that turn by one angle.
class PolygonFinder {
 public:
  PolygonFinder(const Mesh& mesh, const JoinedVertices& joined, double sag)
      : vertices_(mesh.vertices), joined_(joined), sag_(sag) {}

  /// The corners of the polygon that begins with two edges; empty where there is none.
  [[nodiscard]] std::vector<Vertex> from(Vertex a, Vertex b, Vertex c) const {
    const Vector3d first = vertices_[b] - vertices_[a];
    const Vector3d second = vertices_[c] - vertices_[b];
    const double length = first.norm();
    const Vector3d normal = first.cross(second);
    const double angle = std::atan2(normal.norm(), first.dot(second));
    if (std::abs(second.norm() - length) > kSameEdge * length || !is_fine(length, angle)) {
      return {};
    }
    const Eigen::AngleAxisd turn(angle, normal.normalized());
    const auto most =
        static_cast<std::size_t>(2.0 * std::numbers::pi / angle * (1.0 + kSameEdge)) + 1;
    std::vector<Vertex> corners{a, b, c};
    while (corners.size() <= most) {
      const Vertex last = corners.back();
      const Vector3d step = vertices_[last] - vertices_[corners[corners.size() - 2]];
      const std::optional<Vertex> next = nearest(last, vertices_[last] + turn * step, length);
      if (!next) {
        return {};
      }
      if (*next == a) {
        return corners;
      }
      corners.push_back(*next);
    }
    return {};
  }

  /// The circle of the corners, where there is one.
  [[nodiscard]] std::optional<RoundCircle> circle(const std::vector<Vertex>& corners) const {
    RoundCircle found;
    double extent = 0.0;
    for (const Vertex v : corners) {
      found.centre_B += vertices_[v] / static_cast<double>(corners.size());
      extent = std::max(extent, vertices_[v].cwiseAbs().maxCoeff());
    }
    Vector3d area = Vector3d::Zero();
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vector3d from = vertices_[corners[k]] - found.centre_B;
      area += from.cross(vertices_[corners[(k + 1) % corners.size()]] - found.centre_B);
      found.outer = std::max(found.outer, from.norm());
    }
    found.axis_B = area.normalized();
    const double most = kOnCircle * found.outer + kOnCircleOfCoordinates * extent;
    found.inner = found.outer;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vector3d from = vertices_[corners[k]] - found.centre_B;
      const Vector3d to = vertices_[corners[(k + 1) % corners.size()]] - found.centre_B;
      if (std::abs(from.norm() - found.outer) > most || std::abs(from.dot(found.axis_B)) > most) {
        return std::nullopt;
      }
      found.inner = std::min(found.inner, (0.5 * (from + to)).norm());
    }
    return found;
  }

 private:
  /// Whether such edges are as near to their circle as they must be.
  [[nodiscard]] bool is_fine(double length, double angle) const {
    if (!(angle > kStraight && angle < 0.5)) {
      return false;
    }
    const double radius = 0.5 * length / std::sin(0.5 * angle);
    return radius * (1.0 - std::cos(0.5 * angle)) <= std::max(sag_, kSagOfRadius * radius);
  }

  /// The vertex at a place that an edge joins to another one.
  [[nodiscard]] std::optional<Vertex> nearest(Vertex from, const Vector3d& place,
                                              double length) const {
    std::optional<Vertex> found;
    double least = kSameEdge * length;
    for (const Vertex v : joined_.of(from)) {
      const double distance = (vertices_[v] - place).norm();
      if (distance < least) {
        least = distance;
        found = v;
      }
    }
    return found;
  }

  const std::vector<Vector3d>& vertices_;
  const JoinedVertices& joined_;
  double sag_;
};

bool are_of_one_cylinder(const RoundCircle& a, const RoundCircle& b) {
  const double most = 10.0 * kOnCircle;
  const Vector3d between = b.centre_B - a.centre_B;
  return std::abs(a.outer - b.outer) <= most * a.outer && a.axis_B.cross(b.axis_B).norm() <= most &&
         between.cross(a.axis_B).norm() <= most * (a.outer + between.norm());
}

/// Whether a point is no deeper within a cylinder than its edges are.
bool is_outside(const RoundCircle& circle, const Vector3d& point_B) {
  const Vector3d from = point_B - circle.centre_B;
  return from.cross(circle.axis_B).norm() >= (1.0 - kOnCircle) * circle.inner;
}

}  // namespace

RoundCircles::RoundCircles(const Shape& shape, double sag) {
  if (shape.radius() > 0.0 || !shape.vertices_to().empty()) {
    return;
  }
  const Mesh& mesh = shape.mesh();
  const JoinedVertices joined(mesh);
  const PolygonFinder finder(mesh, joined, sag);
  of_vertex_.assign(mesh.vertices.size(), -1);
  const auto is_free = [&](Vertex v) { return of_vertex_[v] < 0; };
  const auto find_from = [&](Vertex a, Vertex b) {
    for (const Vertex c : joined.of(b)) {
      if (c == a || !is_free(c)) {
        continue;
      }
      const std::vector<Vertex> corners = finder.from(a, b, c);
      if (corners.empty() || !std::ranges::all_of(corners, is_free)) {
        continue;
      }
      if (const std::optional<RoundCircle> circle = finder.circle(corners)) {
        for (const Vertex v : corners) {
          of_vertex_[v] = static_cast<std::int32_t>(circles_.size());
        }
        circles_.push_back(*circle);
        return;
      }
    }
  };
  for (Vertex a = 0; a < mesh.vertices.size(); ++a) {
    for (const Vertex b : joined.of(a)) {
      if (is_free(a) && is_free(b)) {
        find_from(a, b);
      }
    }
  }
}

double RoundCircles::sag() const {
  double greatest = 0.0;
  for (const RoundCircle& circle : circles_) {
    greatest = std::max(greatest, circle.outer - circle.inner);
  }
  return greatest;
}

const RoundCircle* RoundCircles::around(std::uint32_t a, std::uint32_t b) const {
  const std::int32_t of_a = of_vertex_[a];
  const std::int32_t of_b = of_vertex_[b];
  if (of_a < 0 || of_b < 0) {
    return nullptr;
  }
  const RoundCircle& circle = circles_[static_cast<std::size_t>(of_a)];
  const bool is_round =
      of_a == of_b || are_of_one_cylinder(circle, circles_[static_cast<std::size_t>(of_b)]);
  return is_round ? &circle : nullptr;
}

const RoundCircle* RoundCircles::at(const Shape& shape, const Feature& feature) const {
  if (circles_.empty()) {
    return nullptr;
  }
  switch (feature.type) {
    case FeatureType::vertex: {
      const auto v = static_cast<std::uint32_t>(feature.index);
      return around(v, v);
    }
    case FeatureType::edge: {
      const auto [a, b] = shape.edge(feature.index);
      const RoundCircle* circle = around(a, b);
      const auto& v = shape.mesh().vertices;
      return circle != nullptr && is_outside(*circle, 0.5 * (v[a] + v[b])) ? circle : nullptr;
    }
    case FeatureType::face:
      break;
  }
  const auto& [a, b, c] = shape.mesh().triangles[feature.index];
  if (of_vertex_[a] == of_vertex_[b] && of_vertex_[b] == of_vertex_[c]) {
    return nullptr;  // Of a disc.
  }
  return around(a, b) != nullptr && around(b, c) != nullptr ? around(a, b) : nullptr;
}

}  // namespace firstcontact::detail
