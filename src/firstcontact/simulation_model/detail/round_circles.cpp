#include <firstcontact/simulation_model/detail/round_circles.h>

#include <algorithm>
#include <array>
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

/// [-]  Greatest distance of a corner from its circle, by the radius, and by the coordinates, as
/// files have few digits.
constexpr double kOnCircle = 1e-5;
constexpr double kOnCircleOfCoordinates = 0x1p-23;
/// [-]  Greatest difference of a polygon's edges, by their length; and of the angles between them,
/// by theirs.
constexpr double kSameEdge = 0.01;
/// [rad]  Edges that turn by less are straight. Edges that turn by more than kSharp are no circle.
constexpr double kStraight = 1e-4;
constexpr double kSharp = 0.5;
/// [-]  Least cosine between the normal and the radius of a surface that faces away from an axis.
constexpr double kFacesAway = 0.3;

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
  std::vector<std::size_t> first_;  // Row of vertex v: first_[v] to first_[v + 1].
  std::vector<Vertex> to_;
};

/// Finds polygons of edges of one length that turn by one angle.
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
    // Other curves, as smooth surfaces and helices have, end after a few edges.
    const double off = kSameEdge * angle * length +
                       4.0 * kOnCircleOfCoordinates * vertices_[b].cwiseAbs().maxCoeff();
    std::vector<Vertex> corners{a, b, c};
    while (corners.size() <= most) {
      const Vertex last = corners.back();
      const Vector3d step = vertices_[last] - vertices_[corners[corners.size() - 2]];
      const std::optional<Vertex> next = nearest(last, vertices_[last] + turn * step, off);
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
  /// Whether such edges are near enough to their circle.
  [[nodiscard]] bool is_fine(double length, double angle) const {
    if (!(angle > kStraight)) {
      return false;
    }
    if (std::isinf(sag_) || angle >= kSharp) {
      return std::isinf(sag_);
    }
    const double radius = 0.5 * length / std::sin(0.5 * angle);
    return radius * (1.0 - std::cos(0.5 * angle)) <= std::max(sag_, kSagOfRadius * radius);
  }

  /// The vertex at a place that an edge joins to a given one.
  [[nodiscard]] std::optional<Vertex> nearest(Vertex from, const Vector3d& place,
                                              double off) const {
    std::optional<Vertex> found;
    double least = off;
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

/// Whether a point is no deeper within a cylinder than the cylinder's edges.
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
  find_sides(mesh);
}

/// Finds the sides of the circles that have a surface.
void RoundCircles::find_sides(const Mesh& mesh) {
  for (const auto& triangle : mesh.triangles) {
    const auto& v = mesh.vertices;
    const Vector3d normal =
        (v[triangle[1]] - v[triangle[0]]).cross(v[triangle[2]] - v[triangle[0]]).stableNormalized();
    for (const Vertex corner : triangle) {
      if (of_vertex_[corner] >= 0) {
        RoundCircle& circle = circles_[static_cast<std::size_t>(of_vertex_[corner])];
        const double cosine = normal.dot(v[corner] - circle.centre_B) / circle.outer;
        circle.is_rim = circle.is_rim || cosine > kFacesAway;
        circle.is_hole = circle.is_hole || cosine < -kFacesAway;
      }
    }
  }
}

double RoundCircles::sag() const {
  double greatest = 0.0;
  for (const RoundCircle& circle : circles_) {
    greatest = std::max(greatest, circle.sag());
  }
  return greatest;
}

/// The circle of an edge or of a triangle.
OnCircle RoundCircles::between(const Shape& shape, std::span<const std::uint32_t> corners) const {
  const auto& v = shape.mesh().vertices;
  Vector3d middle = Vector3d::Zero();
  bool is_side = false;
  for (const std::uint32_t corner : corners) {
    if (of_vertex_[corner] < 0) {
      return {};
    }
    middle += v[corner] / static_cast<double>(corners.size());
    is_side = is_side || of_vertex_[corner] != of_vertex_[corners[0]];
  }
  const RoundCircle& circle = circles_[static_cast<std::size_t>(of_vertex_[corners[0]])];
  for (const std::uint32_t corner : corners) {
    const RoundCircle& other = circles_[static_cast<std::size_t>(of_vertex_[corner])];
    if (&other != &circle && !are_of_one_cylinder(circle, other)) {
      return {};
    }
  }
  const bool is_round = is_outside(circle, middle) && (is_side || corners.size() < 3);
  return is_round ? OnCircle{&circle, is_side} : OnCircle{};
}

OnCircle RoundCircles::at(const Shape& shape, const Feature& feature) const {
  if (circles_.empty()) {
    return {};
  }
  switch (feature.type) {
    case FeatureType::vertex:
      return of_vertex_[feature.index] < 0
                 ? OnCircle{}
                 : OnCircle{&circles_[static_cast<std::size_t>(of_vertex_[feature.index])], false};
    case FeatureType::edge:
      return between(shape, shape.edge(feature.index));
    case FeatureType::face:
      break;
  }
  return between(shape, shape.mesh().triangles[feature.index]);
}

}  // namespace firstcontact::detail
