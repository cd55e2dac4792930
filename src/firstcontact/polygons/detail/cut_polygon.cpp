#include <firstcontact/polygons/detail/cut_polygon.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/polygons/detail/exact_orientation.h>
#include <firstcontact/polygons/detail/plane_sweep.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Vertices = std::span<const Vector3d>;
using Corners = std::span<const std::uint32_t>;

/// Bounds of the range of PlanePoint.
constexpr double kLeast = 0x1p-484;
constexpr double kGreatest = 0x1p480;
constexpr int kGreatestExponent = 480;

/// A coordinate below kLeast as a multiple of 2^-537.
double in_range(double x) {
  constexpr double kRound = 0x1.8p-485;
  return std::abs(x) < kLeast ? (x + kRound) - kRound : x;
}

/// The corners' positions, scaled by a power of two where they leave the range of exact decisions.
std::vector<Vector3d> positions_in_range(Vertices vertices, Corners corners) {
  std::vector<Vector3d> positions;
  positions.reserve(corners.size());
  double greatest = 0.0;
  bool fits = true;
  for (const std::uint32_t corner : corners) {
    positions.push_back(vertices[corner]);
    for (const double x : positions.back()) {
      greatest = std::max(greatest, std::abs(x));
      fits = fits && (x == 0.0 || std::abs(x) >= kLeast);
    }
  }
  if (greatest == 0.0 || (fits && greatest <= kGreatest)) {
    return positions;
  }
  const int shift = kGreatestExponent - 1 - std::ilogb(greatest);
  for (Vector3d& p : positions) {
    p = p.unaryExpr([&](double x) { return in_range(std::ldexp(x, shift)); });
  }
  return positions;
}

/// A view along an axis, from the side from which the outer ring turns counter-clockwise.
struct View {
  int x = 0;
  int y = 1;

  [[nodiscard]] PlanePoint operator()(const Vector3d& p) const { return {p[x], p[y]}; }
  [[nodiscard]] int depth() const { return 3 - x - y; }
};

std::vector<PlanePoint> seen(std::span<const Vector3d> ring, const View& view) {
  std::vector<PlanePoint> points(ring.size());
  std::transform(ring.begin(), ring.end(), points.begin(), view);
  return points;
}

/// The axis along which to look at a ring of area 0.
///
/// It is that of the largest area of the ring's parts, or for a line that of its least extent.
int axis_of_empty_ring(std::span<const Vector3d> ring) {
  constexpr double kLine = 1e-12;
  Eigen::AlignedBox3d bounds;
  Vector3d areas = Vector3d::Zero();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector3d& next = ring[i + 1 == ring.size() ? 0 : i + 1];
    areas += (ring[i] - ring[0]).cross(next - ring[0]).cwiseAbs();
    bounds.extend(ring[i]);
  }
  int axis = 0;
  if (areas.maxCoeff(&axis) <= kLine * bounds.sizes().squaredNorm()) {
    bounds.sizes().minCoeff(&axis);
  }
  return axis;
}

/// The view in which the ring is largest.
View best_view(std::span<const Vector3d> ring) {
  Vector3d areas;
  for (int k = 0; k < 3; ++k) {
    areas[k] = twice_area(seen(ring, {(k + 1) % 3, (k + 2) % 3}));
  }
  int axis = 0;
  if (areas.cwiseAbs().maxCoeff(&axis) == 0.0) {
    axis = axis_of_empty_ring(ring);
  }
  View view{(axis + 1) % 3, (axis + 2) % 3};
  if (areas[axis] < 0.0) {
    std::swap(view.x, view.y);
  }
  return view;
}

bool is_concave(std::span<const PlanePoint> ring) {
  std::vector<PlanePoint> distinct(ring.begin(), ring.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  for (std::size_t i = 0; i < distinct.size(); ++i) {
    const std::size_t n = distinct.size();
    if (orientation(distinct[i], distinct[(i + 1) % n], distinct[(i + 2) % n]) < 0) {
      return true;
    }
  }
  return false;
}

/// Whether the triangles about the first corner cover exactly the ring's inside.
///
/// That is so where the other corners, as seen from the first, turn counter-clockwise by less than
/// a whole turn.
bool fan_fits(std::span<const PlanePoint> ring) {
  const PlanePoint& o = ring.front();
  std::size_t first = 1;
  while (first < ring.size() && ring[first] == o) {
    ++first;
  }
  bool is_past_half = false;
  bool is_back = false;  // Whether the walk is at the first corner again, which is right only at
                         // the end.
  for (std::size_t k = first; k < ring.size(); ++k) {
    if (ring[k] == o) {
      is_back = true;
      continue;
    }
    const int step = k == first ? 0 : orientation(o, ring[k - 1], ring[k]);
    const bool turns_about = k > first && step == 0 && (ring[k - 1] < o) != (ring[k] < o);
    const int from_start = orientation(o, ring[first], ring[k]);
    if (is_back || step < 0 || turns_about || (is_past_half && from_start >= 0)) {
      return false;
    }
    is_past_half = from_start < 0;
  }
  return true;
}

/// The rings as points in ascending order, none twice, and edges between them.
struct Drawing {
  std::vector<PlanePoint> points;
  std::vector<std::uint32_t> vertices;  ///< One vertex at each point.
  std::vector<RingEdge> edges;
};

/// Draws a polygon; nothing where it folds over, so that separate corners look like one point.
std::optional<Drawing> draw(std::span<const Vector3d> positions, std::span<const PlanePoint> points,
                            const PolygonRings& polygon, int depth) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return points[i] != points[j] ? points[i] < points[j] : i < j;
  });
  Drawing drawing;
  std::vector<std::uint32_t> rank(points.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint32_t i = order[k];
    if (k == 0 || points[order[k - 1]] != points[i]) {
      drawing.points.push_back(points[i]);
      drawing.vertices.push_back(polygon.corners[i]);
    } else if (positions[order[k - 1]][depth] != positions[i][depth]) {
      return std::nullopt;
    }
    rank[i] = static_cast<std::uint32_t>(drawing.points.size() - 1);
  }
  std::size_t begin = 0;
  for (std::size_t ring = 0; ring <= polygon.hole_begins.size(); ++ring) {
    const bool is_last = ring == polygon.hole_begins.size();
    const std::size_t end = is_last ? points.size() : polygon.hole_begins[ring];
    const bool is_reversed = ring > 0 && twice_area(points.subspan(begin, end - begin)) > 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const RingEdge edge{rank[i], rank[i + 1 == end ? begin : i + 1]};
      if (edge.from != edge.to) {
        drawing.edges.push_back(is_reversed ? RingEdge{edge.to, edge.from} : edge);
      }
    }
    begin = end;
  }
  return drawing;
}

}  // namespace

PolygonCut cut_polygon(Vertices vertices, const PolygonRings& polygon) {
  const std::vector<Vector3d> positions = positions_in_range(vertices, polygon.corners);
  const bool has_holes = !polygon.hole_begins.empty();
  const std::size_t outer = has_holes ? polygon.hole_begins.front() : positions.size();
  const View view = best_view({positions.data(), outer});
  const std::vector<PlanePoint> points = seen(positions, view);
  const std::span<const PlanePoint> outer_ring(points.data(), outer);
  PolygonCut cut;
  cut.is_concave = is_concave(outer_ring);
  if (!has_holes && fan_fits(outer_ring)) {
    return cut;
  }
  cut.is_fan = false;
  const std::optional<Drawing> drawing = draw(positions, points, polygon, view.depth());
  auto triangles = drawing ? triangulate_rings(drawing->points, drawing->edges,
                                               has_holes ? WindingRule::positive_winding
                                                         : WindingRule::any_winding)
                           : std::nullopt;
  cut.crosses = !triangles;
  if (triangles) {
    for (auto& triangle : *triangles) {
      for (std::uint32_t& corner : triangle) {
        corner = drawing->vertices[corner];
      }
    }
    cut.triangles = std::move(*triangles);
  }
  return cut;
}

Vector3d newell_normal(Vertices vertices, Corners corners) {
  const Vector3d& origin = vertices[corners.front()];
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += (vertices[corners[i]] - origin).cross(vertices[corners[i + 1]] - origin);
  }
  return normal;
}

bool is_plainly_convex(Vertices vertices, Corners corners, const Vector3d& normal) {
  // Each determinant has a relative error below 16 u of the product of its factors' lengths; the
  // bound leaves a factor of 50. Below kUnderflow, bits may be lost otherwise.
  constexpr double kError = 1e-13;
  constexpr double kUnderflow = 1e-250;
  const double normal2 = normal.squaredNorm();
  const auto turns_left = [&](const Vector3d& u, const Vector3d& v) {
    const double turn = u.cross(v).dot(normal);
    const double size = u.squaredNorm() * v.squaredNorm() * normal2;
    return turn > 0.0 && size > kUnderflow && turn * turn > kError * kError * size &&
           size <= std::numeric_limits<double>::max();
  };
  const std::size_t n = corners.size();
  const Vector3d& origin = vertices[corners[0]];
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d& a = vertices[corners[i]];
    const Vector3d& b = vertices[corners[i + 1 < n ? i + 1 : i + 1 - n]];
    const Vector3d& c = vertices[corners[i + 2 < n ? i + 2 : i + 2 - n]];
    if (!turns_left(b - a, c - b)) {
      return false;
    }
    // Four left turns make one round; more turns may make several.
    if (n > 4 && i > 0 && i + 1 < n && !turns_left(a - origin, b - origin)) {
      return false;
    }
  }
  return true;
}

double deviation_from_plane(Vertices vertices, Corners corners, const Vector3d& normal) {
  const double length = normal.norm();
  if (!(length > 0.0) || !std::isfinite(length)) {
    return 0.0;
  }
  const Vector3d& origin = vertices[corners.front()];
  double least = 0.0;
  double greatest = 0.0;
  double size2 = 0.0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Vector3d p = vertices[corners[i]] - origin;
    const double height = normal.dot(p);
    least = std::min(least, height);
    greatest = std::max(greatest, height);
    size2 = std::max(size2, p.squaredNorm());
  }
  // The normal has an error of its own: each of its n - 2 terms is rounded to 4 u of at most size2.
  const double u = 0x1p-53;
  const double normal_error = 8.0 * u * static_cast<double>(corners.size()) * size2;
  const double rounding = 2.0 * normal_error * std::sqrt(size2);
  return std::max(0.0, (greatest - least - rounding) / length);
}

}  // namespace firstcontact::detail
