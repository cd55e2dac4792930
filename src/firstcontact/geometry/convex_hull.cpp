#include <firstcontact/geometry/convex_hull.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/geometry/detail/orientation.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/math/float_environment.h>

namespace firstcontact {
namespace {

using detail::orientation;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Index = std::uint32_t;

/// Scales points to at most 1 in size, as multiples of 2^-300.
std::vector<Vector3d> normalised(const std::vector<Vector3d>& points) {
  double greatest = 0.0;
  for (const Vector3d& p : points) {
    if (!p.allFinite()) {
      throw std::invalid_argument("convex_hull: a point is not finite");
    }
    greatest = std::max(greatest, p.cwiseAbs().maxCoeff());
  }
  const int exponent = greatest > 0.0 ? std::ilogb(greatest) + 1 : 0;
  const auto round = [&](double x) {
    const double scaled = std::ldexp(x, -exponent);
    return std::abs(scaled) >= 0x1p-240 ? scaled
                                        : std::ldexp(std::nearbyint(std::ldexp(scaled, 300)), -300);
  };
  std::vector<Vector3d> result;
  result.reserve(points.size());
  for (const Vector3d& p : points) {
    result.emplace_back(round(p.x()), round(p.y()), round(p.z()));
  }
  return result;
}

/// Projects a point along axis k.
Vector2d shadow_of(const Vector3d& p, int k) { return {p[(k + 1) % 3], p[(k + 2) % 3]}; }

/// Four points that span space; fewer where all points lie in a plane, on a line, at one place.
class Simplex {
 public:
  explicit Simplex(const std::vector<Vector3d>& points) : points_(points) {
    add_farthest([&](const Vector3d& p) { return -p.x(); });
    add_farthest([&](const Vector3d& p) { return (p - at(0)).squaredNorm(); });
    add_exact([&](Index i) { return off_line(i); },
              [&](const Vector3d& p) { return (p - at(0)).cross(at(1) - at(0)).squaredNorm(); });
    add_exact([&](Index i) { return orientation(at(0), at(1), at(2), points_[i]) != 0; },
              [&](const Vector3d& p) {
                return std::abs((p - at(0)).dot((at(1) - at(0)).cross(at(2) - at(0))));
              });
    if (is_full() && orientation(at(0), at(1), at(2), at(3)) > 0) {
      // Seen from the fourth corner, the others turn to the right.
      std::swap(corners_[0], corners_[1]);
    }
  }

  [[nodiscard]] bool is_full() const { return corners_.size() == 4; }
  [[nodiscard]] const std::vector<Index>& corners() const { return corners_; }

 private:
  [[nodiscard]] const Vector3d& at(std::size_t k) const { return points_[corners_[k]]; }

  /// Whether a point is off the line through the first two, by its shadows on the three planes.
  [[nodiscard]] bool off_line(Index i) const {
    for (int k = 0; k < 3; ++k) {
      if (orientation(shadow_of(at(0), k), shadow_of(at(1), k), shadow_of(points_[i], k)) != 0) {
        return true;
      }
    }
    return false;
  }

  /// Adds the first two points; a second only where it differs.
  template <class Measure>
  void add_farthest(const Measure& measure) {
    Index best = 0;
    for (Index i = 1; i < points_.size(); ++i) {
      best = measure(points_[i]) > measure(points_[best]) ? i : best;
    }
    if (corners_.empty() || points_[best] != at(0)) {
      corners_.push_back(best);
      return;
    }
    // Squares of tiny distances are 0.
    const auto other =
        std::find_if(points_.begin(), points_.end(), [&](const Vector3d& p) { return p != at(0); });
    if (other != points_.end()) {
      corners_.push_back(static_cast<Index>(other - points_.begin()));
    }
  }

  /// Adds the farthest point that adds a dimension, exactly. Adds nothing where no point does, or
  /// where an earlier step added nothing.
  template <class Adds, class Measure>
  void add_exact(const Adds& adds, const Measure& measure) {
    if (corners_.size() < expected_++) {
      return;
    }
    Index best = 0;
    double farthest = -1.0;
    for (Index i = 0; i < points_.size(); ++i) {
      const double distance = measure(points_[i]);
      if (distance > farthest && adds(i)) {
        farthest = distance;
        best = i;
      }
    }
    if (farthest >= 0.0) {
      corners_.push_back(best);
    }
  }

  const std::vector<Vector3d>& points_;
  std::vector<Index> corners_;
  std::size_t expected_ = 2;
};

/// Grows a simplex, face by face, by the farthest point outside of it.
///
/// A point sees a face if it lies strictly on its outer side. The faces that a point sees are
/// replaced by those between the point and their rim.
///
/// A point that lost the face that it saw, and sees no new face, is inside. Derivation: of a point
/// that sees two faces across an edge of the rim, the new face of that edge is seen too.
class QuickHull {
 public:
  QuickHull(const std::vector<Vector3d>& points, const std::vector<Index>& simplex)
      : points_(points) {
    add_simplex(simplex);
    std::vector<Index> all(points.size());
    for (Index i = 0; i < all.size(); ++i) {
      all[i] = i;
    }
    distribute(all, 0);
    while (!waiting_.empty()) {
      const Index face = waiting_.back();
      waiting_.pop_back();
      if (faces_[face].alive && !faces_[face].outside.empty()) {
        grow(face);
      }
    }
  }

  [[nodiscard]] std::vector<std::array<Index, 3>> triangles() const {
    std::vector<std::array<Index, 3>> result;
    for (const Face& face : faces_) {
      if (face.alive) {
        result.push_back(face.corners);
      }
    }
    return result;
  }

 private:
  struct Face {
    std::array<Index, 3> corners{};     ///< They turn to the left, seen from outside.
    std::array<Index, 3> neighbours{};  ///< Across the edges from corner k to k + 1.
    std::vector<Index> outside;         ///< Points that see it; each is listed with one face only.
    Vector3d normal = Vector3d::Zero();
    bool alive = true;
    bool seen = false;
  };

  /// An edge of the rim, with the face beyond the edge, which stays.
  struct RimEdge {
    Index from = 0;
    Index to = 0;
    Index beyond = 0;
  };

  [[nodiscard]] bool sees(Index point, const Face& face) const {
    const auto& c = face.corners;
    return orientation(points_[c[0]], points_[c[1]], points_[c[2]], points_[point]) > 0;
  }

  Index add_face(Index a, Index b, Index c) {
    Face face;
    face.corners = {a, b, c};
    face.normal = (points_[b] - points_[a]).cross(points_[c] - points_[a]);
    faces_.push_back(std::move(face));
    return static_cast<Index>(faces_.size() - 1);
  }

  void add_simplex(const std::vector<Index>& s) {
    add_face(s[0], s[1], s[2]);
    add_face(s[0], s[3], s[1]);
    add_face(s[1], s[3], s[2]);
    add_face(s[2], s[3], s[0]);
    faces_[0].neighbours = {1, 2, 3};
    faces_[1].neighbours = {3, 2, 0};
    faces_[2].neighbours = {1, 3, 0};
    faces_[3].neighbours = {2, 1, 0};
  }

  /// Gives each point to one of the faces from `first` on that it sees.
  void distribute(const std::vector<Index>& points, Index first) {
    for (const Index point : points) {
      for (Index f = first; f < faces_.size(); ++f) {
        if (sees(point, faces_[f])) {
          faces_[f].outside.push_back(point);
          break;
        }
      }
    }
    for (Index f = first; f < faces_.size(); ++f) {
      if (!faces_[f].outside.empty()) {
        waiting_.push_back(f);
      }
    }
  }

  /// The farthest point need not be found exactly: any point outside will do.
  [[nodiscard]] Index farthest(const Face& face) const {
    const auto height = [&](Index i) { return face.normal.dot(points_[i]); };
    return *std::max_element(face.outside.begin(), face.outside.end(),
                             [&](Index i, Index j) { return height(i) < height(j); });
  }

  void grow(Index start) {
    const Index point = farthest(faces_[start]);
    const std::vector<Index> seen = collect_seen(start, point);
    const std::vector<RimEdge> rim = collect_rim(seen);
    std::vector<Index> points;
    for (const Index f : seen) {
      points.insert(points.end(), faces_[f].outside.begin(), faces_[f].outside.end());
      faces_[f].alive = false;
      faces_[f].outside = {};
    }
    const Index first = static_cast<Index>(faces_.size());
    add_cone(rim, point);
    std::erase(points, point);
    distribute(points, first);
  }

  std::vector<Index> collect_seen(Index start, Index point) {
    std::vector<Index> seen{start};
    faces_[start].seen = true;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      for (const Index neighbour : std::array(faces_[seen[k]].neighbours)) {
        if (!faces_[neighbour].seen && sees(point, faces_[neighbour])) {
          faces_[neighbour].seen = true;
          seen.push_back(neighbour);
        }
      }
    }
    return seen;
  }

  /// Collects the rim in the order in which the edges follow each other.
  [[nodiscard]] std::vector<RimEdge> collect_rim(const std::vector<Index>& seen) const {
    std::vector<RimEdge> edges;
    for (const Index f : seen) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Index beyond = faces_[f].neighbours[k];
        if (!faces_[beyond].seen) {
          edges.push_back({faces_[f].corners[k], faces_[f].corners[(k + 1) % 3], beyond});
        }
      }
    }
    std::sort(edges.begin(), edges.end(),
              [](const RimEdge& a, const RimEdge& b) { return a.from < b.from; });
    std::vector<RimEdge> rim{edges.front()};
    while (rim.back().to != rim.front().from) {
      rim.push_back(
          *std::lower_bound(edges.begin(), edges.end(), rim.back().to,
                            [](const RimEdge& edge, Index vertex) { return edge.from < vertex; }));
    }
    return rim;
  }

  /// Adds the faces between the rim and a point.
  void add_cone(const std::vector<RimEdge>& rim, Index point) {
    const Index first = static_cast<Index>(faces_.size());
    const auto count = static_cast<Index>(rim.size());
    for (Index k = 0; k < count; ++k) {
      const RimEdge& edge = rim[k];
      const Index face = add_face(edge.from, edge.to, point);
      faces_[face].neighbours = {edge.beyond, first + (k + 1) % count,
                                 first + (k + count - 1) % count};
      Face& beyond = faces_[edge.beyond];
      for (std::size_t j = 0; j < 3; ++j) {
        if (beyond.corners[j] == edge.to && beyond.corners[(j + 1) % 3] == edge.from) {
          beyond.neighbours[j] = face;
        }
      }
    }
  }

  const std::vector<Vector3d>& points_;
  std::vector<Face> faces_;
  std::vector<Index> waiting_;
};

/// Finds the coordinate to leave out: the one whose shadow of the plane has the greatest area.
int thrown_axis(const std::vector<Vector3d>& points, const std::vector<Index>& simplex) {
  const Vector3d& a = points[simplex[0]];
  const Vector3d& b = points[simplex[1]];
  const Vector3d& c = points[simplex[2]];
  const Vector3d normal = (b - a).cross(c - a).cwiseAbs();
  int thrown = -1;
  for (int k = 0; k < 3; ++k) {
    const bool has_area = orientation(shadow_of(a, k), shadow_of(b, k), shadow_of(c, k)) != 0;
    if (has_area && (thrown < 0 || normal[k] > normal[thrown])) {
      thrown = k;
    }
  }
  return thrown;
}

/// Finds the convex polygon of points in one plane, as a fan. It uses the shadow on the coordinate
/// plane nearest to theirs (A. M. Andrew, "Another efficient algorithm for convex hulls in two
/// dimensions", Information Processing Letters 9, 1979).
std::vector<std::array<Index, 3>> planar_hull(const std::vector<Vector3d>& points,
                                              const std::vector<Index>& simplex) {
  const int thrown = thrown_axis(points, simplex);
  const auto shadow = [&](Index i) { return shadow_of(points[i], thrown); };
  std::vector<Index> order(points.size());
  for (Index i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  std::sort(order.begin(), order.end(), [&](Index i, Index j) {
    const Vector2d a = shadow(i);
    const Vector2d b = shadow(j);
    return a.x() != b.x() ? a.x() < b.x() : a.y() != b.y() ? a.y() < b.y() : i < j;
  });
  const auto half = [&](std::vector<Index>& polygon, auto begin, auto end) {
    const std::size_t before = polygon.size();
    for (auto i = begin; i != end; ++i) {
      while (polygon.size() >= before + 2 && orientation(shadow(polygon[polygon.size() - 2]),
                                                         shadow(polygon.back()), shadow(*i)) <= 0) {
        polygon.pop_back();
      }
      if (polygon.size() == before || shadow(polygon.back()) != shadow(*i)) {
        polygon.push_back(*i);
      }
    }
    polygon.pop_back();  // The last point begins the other half.
  };
  std::vector<Index> polygon;
  half(polygon, order.begin(), order.end());
  half(polygon, order.rbegin(), order.rend());
  std::vector<std::array<Index, 3>> triangles;
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    triangles.push_back({polygon[0], polygon[k], polygon[k + 1]});
  }
  return triangles;
}

/// Finds the segment of points on one line.
std::vector<std::array<Index, 3>> linear_hull(const std::vector<Vector3d>& points) {
  const auto [low, high] =
      std::minmax_element(points.begin(), points.end(), [](const Vector3d& a, const Vector3d& b) {
        return std::array{a.x(), a.y(), a.z()} < std::array{b.x(), b.y(), b.z()};
      });
  const auto a = static_cast<Index>(low - points.begin());
  const auto b = static_cast<Index>(high - points.begin());
  return points[a] != points[b] ? std::vector{std::array{a, b, b}}
                                : std::vector{std::array{a, a, a}};
}

std::vector<std::array<Index, 3>> hull_triangles(const std::vector<Vector3d>& points) {
  const Simplex simplex(points);
  switch (simplex.corners().size()) {
    case 4:
      return QuickHull(points, simplex.corners()).triangles();
    case 3:
      return planar_hull(points, simplex.corners());
    default:
      return linear_hull(points);
  }
}

/// Makes a mesh of the points that the triangles use, in their order.
Mesh compact(const std::vector<Vector3d>& points, std::vector<std::array<Index, 3>> triangles) {
  constexpr Index kUnused = std::numeric_limits<Index>::max();
  std::vector<Index> number(points.size(), kUnused);
  for (const auto& t : triangles) {
    for (const Index v : t) {
      number[v] = 0;
    }
  }
  Mesh mesh;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (number[i] != kUnused) {
      number[i] = static_cast<Index>(mesh.vertices.size());
      mesh.vertices.push_back(points[i]);
    }
  }
  for (auto& t : triangles) {
    for (Index& v : t) {
      v = number[v];
    }
  }
  mesh.triangles = std::move(triangles);
  return mesh;
}

}  // namespace

Mesh convex_hull(const std::vector<Vector3d>& points) {
  if (points.empty()) {
    throw std::invalid_argument("convex_hull: there are no points");
  }
  const FloatEnvironmentGuard guard;
  return compact(points, hull_triangles(normalised(points)));
}

Shape make_convex_hull(const std::vector<Vector3d>& points, double radius) {
  Mesh hull = convex_hull(points);
  const bool encloses =
      hull.vertices.size() > 3 && hull.triangles.size() == 2 * hull.vertices.size() - 4;
  const Filling filling = encloses ? Filling::solid : Filling::surface;
  // Queries visit every point of a set: for a hull of many points its triangles are faster.
  constexpr std::size_t kMostPoints = 64;
  const bool has_set_radius = radius == 0.0 || (radius >= kLeastSize && radius <= kGreatestSize);
  const bool is_in_range =
      std::all_of(hull.vertices.begin(), hull.vertices.end(),
                  [](const Vector3d& p) { return p.cwiseAbs().maxCoeff() <= kGreatestSize; });
  if (hull.vertices.size() > kMostPoints || !has_set_radius || !is_in_range) {
    return Shape(std::move(hull), radius, filling);
  }
  const ConvexSet set = ConvexSet::hull(hull.vertices, radius);
  return Shape(std::move(hull), filling, 0.0, set);
}

}  // namespace firstcontact
