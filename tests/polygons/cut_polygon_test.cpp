#include <firstcontact/polygons/detail/cut_polygon.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/rational.h"
#include "support/rounds.h"

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using oracle::Rational;
using Ring = std::vector<Vector3d>;
using Triangle = std::array<std::uint32_t, 3>;

/// A polygon with exact coordinates in a plane: whole numbers below 2^20, mapped by whole numbers.
struct Polygon {
  Ring vertices;
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t> hole_begins;
};

struct Flat {
  double x = 0.0;
  double y = 0.0;
};

/// Puts rings into a plane of whole-number axes, at the scale 2^exponent: all stays exact.
Polygon placed(const std::vector<std::vector<Flat>>& rings, std::mt19937& rng, int exponent) {
  std::uniform_int_distribution<int> entry(-7, 7);
  Vector3d u;
  Vector3d v;
  do {
    u = Vector3d(entry(rng), entry(rng), entry(rng));
    v = Vector3d(entry(rng), entry(rng), entry(rng));
  } while (u.cross(v).norm() < 1.0);
  const Vector3d origin(entry(rng), entry(rng), entry(rng));
  Polygon polygon;
  for (const auto& ring : rings) {
    if (!polygon.corners.empty()) {
      polygon.hole_begins.push_back(static_cast<std::uint32_t>(polygon.corners.size()));
    }
    for (const Flat& p : ring) {
      polygon.corners.push_back(static_cast<std::uint32_t>(polygon.vertices.size()));
      polygon.vertices.push_back((origin + p.x * u + p.y * v) * std::ldexp(1.0, exponent));
    }
  }
  return polygon;
}

std::vector<Triangle> fan_of(const Polygon& polygon) {
  std::vector<Triangle> fan;
  for (std::size_t i = 1; i + 1 < polygon.corners.size(); ++i) {
    fan.push_back({polygon.corners[0], polygon.corners[i], polygon.corners[i + 1]});
  }
  return fan;
}

std::vector<Triangle> triangles_of(const Polygon& polygon, const PolygonCut& cut) {
  return cut.is_fan ? fan_of(polygon) : cut.triangles;
}

using Exact = std::array<Rational, 3>;

Exact exact(const Vector3d& p) { return {Rational(p.x()), Rational(p.y()), Rational(p.z())}; }

/// Twice the area vector of a triangle.
Exact area_vector(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Exact p = exact(a);
  const Exact q = exact(b);
  const Exact r = exact(c);
  Exact result;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    result[k] = (q[i] - p[i]) * (r[j] - p[j]) - (q[j] - p[j]) * (r[i] - p[i]);
  }
  return result;
}

Exact operator+(const Exact& a, const Exact& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

Rational dot(const Exact& a, const Exact& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Exact area_vector(const Polygon& polygon) {
  Exact sum;
  const std::size_t end =
      polygon.hole_begins.empty() ? polygon.corners.size() : polygon.hole_begins.front();
  for (std::size_t i = 1; i + 1 < end; ++i) {
    sum = sum + area_vector(polygon.vertices[polygon.corners[0]],
                            polygon.vertices[polygon.corners[i]],
                            polygon.vertices[polygon.corners[i + 1]]);
  }
  return sum;
}

/// Directed edges, by number of vertex, and how often each occurs less its reverse.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> boundary(
    const std::vector<Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      if (a != b) {
        edges[std::minmax(a, b)] += a < b ? 1 : -1;
      }
    }
  }
  std::erase_if(edges, [](const auto& entry) { return entry.second == 0; });
  return edges;
}

/// The oracle: triangles that all turn as the polygon does, whose areas sum to its own exactly,
/// and whose boundary is the polygon's, cover it once. (All turn one way and the boundary is a
/// simple ring: each point then has as many triangles about it as windings.)
void expect_cut_inside(const Polygon& polygon, bool is_strict) {
  const PolygonCut cut = cut_polygon(polygon.vertices, {polygon.corners, polygon.hole_begins});
  ASSERT_FALSE(cut.crosses);
  const std::vector<Triangle> triangles = triangles_of(polygon, cut);
  const Exact normal = area_vector(polygon);
  for (const Triangle& t : triangles) {
    const Rational turn = dot(normal, area_vector(polygon.vertices[t[0]], polygon.vertices[t[1]],
                                                  polygon.vertices[t[2]]));
    ASSERT_FALSE(turn < Rational(0.0));
    ASSERT_TRUE(!is_strict || cut.is_fan || turn > Rational(0.0));
  }
  std::vector<Triangle> rings;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> expected;
  std::size_t begin = 0;
  for (std::size_t ring = 0; ring <= polygon.hole_begins.size(); ++ring) {
    const std::size_t end =
        ring < polygon.hole_begins.size() ? polygon.hole_begins[ring] : polygon.corners.size();
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t a = polygon.corners[i];
      const std::uint32_t b = polygon.corners[i + 1 == end ? begin : i + 1];
      expected[std::minmax(a, b)] += a < b ? 1 : -1;
    }
    begin = end;
  }
  std::erase_if(expected, [](const auto& entry) { return entry.second == 0; });
  EXPECT_EQ(boundary(triangles), expected);
  EXPECT_EQ(triangles.size(), polygon.corners.size() - 2 + 2 * polygon.hole_begins.size());
}

// ---- Simple rings of whole numbers

/// Points at growing angles about the origin; concave by its radii.
std::vector<Flat> star(int n, std::mt19937& rng) {
  std::uniform_real_distribution<double> radius(1e4, 1e6);
  std::vector<Flat> ring;
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.25) / n;
    const double r = radius(rng);
    ring.push_back({std::round(r * std::cos(angle)), std::round(r * std::sin(angle))});
  }
  return ring;
}

/// Teeth of random length upwards, and flat corners below.
std::vector<Flat> comb(int teeth, std::mt19937& rng) {
  std::uniform_int_distribution<int> length(2, 1000);
  std::vector<Flat> ring;
  for (int i = 0; i <= teeth; ++i) {
    ring.push_back({8.0 * i, 0.0});
  }
  for (int i = teeth; i-- > 0;) {
    ring.push_back({8.0 * i + 6.0, 1.0 + length(rng)});
    ring.push_back({8.0 * i + 2.0, 1.0});
  }
  return ring;
}

/// A band of width 1 that winds inwards.
std::vector<Flat> spiral(int corners) {
  std::vector<Flat> outside;
  std::vector<Flat> inside;
  double reach = 2.0 * corners + 4.0;
  constexpr std::array<std::array<int, 2>, 4> kCorners = {{{1, -1}, {1, 1}, {-1, 1}, {-1, -1}}};
  for (int i = 0; i < corners; ++i) {
    const auto& [sx, sy] = kCorners[i % 4];
    outside.push_back({sx * reach, sy * reach});
    inside.push_back({sx * (reach - 1.0), sy * (reach - 1.0)});
    reach -= 2.0;
  }
  outside.insert(outside.end(), inside.rbegin(), inside.rend());
  return outside;
}

/// Each edge with its middle as a further, flat corner; coordinates are doubled for it.
std::vector<Flat> with_flat_corners(const std::vector<Flat>& ring) {
  std::vector<Flat> result;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Flat& a = ring[i];
    const Flat& b = ring[(i + 1) % ring.size()];
    result.push_back({2.0 * a.x, 2.0 * a.y});
    result.push_back({a.x + b.x, a.y + b.y});
  }
  return result;
}

std::vector<Flat> rotated(std::vector<Flat> ring, std::size_t by) {
  std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(by % ring.size()),
              ring.end());
  return ring;
}

std::vector<Flat> simple_ring(int round, std::mt19937& rng) {
  std::uniform_int_distribution<int> size(4, 40);
  const int n = size(rng);
  std::vector<Flat> ring = round % 3 == 0   ? star(n, rng)
                           : round % 3 == 1 ? comb(n, rng)
                                            : spiral(n);
  if (round % 2 == 1) {
    ring = with_flat_corners(ring);
  }
  if (round % 5 < 2) {
    std::reverse(ring.begin(), ring.end());
  }
  return rotated(std::move(ring), rng());
}

TEST(CutPolygon, CoversSimpleRingsOnceAndNothingElse) {
  std::mt19937 rng(1);
  for (int round = 0; round < test::rounds(600, 60); ++round) {
    SCOPED_TRACE(round);
    const int exponent = static_cast<int>(rng() % 61) - 40;
    expect_cut_inside(placed({simple_ring(round, rng)}, rng, exponent), true);
  }
}

// At the ends of what doubles hold, decisions stay exact.
TEST(CutPolygon, HoldsAtExtremeScales) {
  std::mt19937 rng(2);
  for (const int exponent : {-1000, -700, -480, 480, 700, 970}) {
    for (int round = 0; round < test::rounds(30, 6); ++round) {
      SCOPED_TRACE(std::to_string(exponent) + " " + std::to_string(round));
      expect_cut_inside(placed({simple_ring(round, rng)}, rng, exponent), true);
    }
  }
}

TEST(CutPolygon, LeavesHolesOpen) {
  std::mt19937 rng(3);
  for (int round = 0; round < test::rounds(200, 20); ++round) {
    SCOPED_TRACE(round);
    const double step = 1000.0;
    const int count = 1 + static_cast<int>(rng() % 6);
    std::vector<std::vector<Flat>> rings = {
        {{0.0, 0.0}, {count * step, 0.0}, {count * step, step}, {0.0, step}}};
    if (round % 3 == 1) {  // A concave outer ring.
      rings[0].push_back({-step, 3.0 * step});
      rings[0].push_back({-step, -step});
    }
    for (int hole = 0; hole < count; ++hole) {
      std::vector<Flat> ring = rotated(star(3 + static_cast<int>(rng() % 20), rng), rng());
      for (Flat& p : ring) {
        p = {std::round(p.x / 2100.0) + (hole + 0.5) * step, std::round(p.y / 2100.0) + 0.5 * step};
        p = {2.0 * p.x, 2.0 * p.y};
      }
      if (rng() % 2 == 0) {
        std::reverse(ring.begin(), ring.end());
      }
      rings.push_back(std::move(ring));
    }
    for (Flat& p : rings[0]) {
      p = {2.0 * p.x, 2.0 * p.y};
    }
    const Polygon polygon = placed(rings, rng, static_cast<int>(rng() % 41) - 20);
    const PolygonCut cut = cut_polygon(polygon.vertices, {polygon.corners, polygon.hole_begins});
    ASSERT_FALSE(cut.crosses);
    const Exact normal = area_vector(polygon);
    Rational area;
    for (const Triangle& t : cut.triangles) {
      const Rational part = dot(normal, area_vector(polygon.vertices[t[0]], polygon.vertices[t[1]],
                                                    polygon.vertices[t[2]]));
      ASSERT_TRUE(part > Rational(0.0));
      area = area + part;
    }
    Rational expected = dot(normal, normal);
    for (std::size_t hole = 0; hole < polygon.hole_begins.size(); ++hole) {
      Polygon ring = polygon;
      const std::size_t end = hole + 1 < polygon.hole_begins.size() ? polygon.hole_begins[hole + 1]
                                                                    : polygon.corners.size();
      ring.corners.assign(
          polygon.corners.begin() + static_cast<std::ptrdiff_t>(polygon.hole_begins[hole]),
          polygon.corners.begin() + static_cast<std::ptrdiff_t>(end));
      ring.hole_begins.clear();
      const Rational part = dot(normal, area_vector(ring));
      expected = part < Rational(0.0) ? expected + part : expected - part;
    }
    EXPECT_TRUE(area == expected);
    EXPECT_EQ(cut.triangles.size(), polygon.corners.size() - 2 + 2 * polygon.hole_begins.size());
  }
}

Polygon in_plane(const std::vector<Flat>& ring) {
  Polygon polygon;
  for (const Flat& p : ring) {
    polygon.corners.push_back(static_cast<std::uint32_t>(polygon.vertices.size()));
    polygon.vertices.emplace_back(p.x, p.y, 0.0);
  }
  return polygon;
}

double area_of(const Polygon& polygon, const std::vector<Triangle>& triangles) {
  double area = 0.0;
  for (const Triangle& t : triangles) {
    area += 0.5 * (polygon.vertices[t[1]] - polygon.vertices[t[0]])
                      .cross(polygon.vertices[t[2]] - polygon.vertices[t[0]])
                      .z();
  }
  return area;
}

bool covers_edge(const Polygon& polygon, const std::vector<Triangle>& triangles, std::size_t i) {
  const Vector3d& a = polygon.vertices[polygon.corners[i]];
  const Vector3d& b = polygon.vertices[polygon.corners[(i + 1) % polygon.corners.size()]];
  return a == b || std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
           const auto has = [&](const Vector3d& p) {
             return std::any_of(t.begin(), t.end(),
                                [&](auto v) { return polygon.vertices[v] == p; });
           };
           return has(a) && has(b);
         });
}

// Exporters write rings that touch themselves for holes and for inexact drawings.
TEST(CutPolygon, CoversRingsThatTouchThemselves) {
  struct Case {
    const char* name;
    std::vector<Flat> ring;
    double area;
  };
  const std::vector<Case> cases = {
      {"a square with a hole at the end of a bridge",
       {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}},
       32.0},
      {"a spike outwards", {{0, 0}, {4, 0}, {4, 4}, {7, 7}, {4, 4}, {0, 4}}, 16.0},
      {"a spike inwards, then a notch",
       {{0, 0}, {4, 0}, {4, 4}, {3, 2}, {4, 4}, {2, 4}, {2, 1}, {0, 4}},
       13.0},
      {"a spike along an edge, and beyond it", {{0, 0}, {9, 0}, {4, 0}, {4, 4}, {0, 4}}, 16.0},
      {"repeated corners of a dart", {{0, 0}, {0, 0}, {9, 9}, {1, 1}, {1, 1}, {0, 9}}, 0.0},
      {"two squares that share a corner",
       {{0, 0}, {2, 0}, {2, 2}, {4, 2}, {4, 4}, {2, 4}, {2, 2}, {0, 2}},
       8.0},
      {"a notch whose tip lies on the edge across",
       {{0, 0}, {8, 0}, {8, 4}, {4, 0}, {2, 4}, {0, 4}},
       20.0},
      {"a line there and back, with a bend", {{0, 0}, {4, 0}, {4, 4}, {4, 0}}, 0.0},
      {"a line", {{0, 0}, {4, 0}, {2, 0}, {-2, 0}}, 0.0},
      {"a point", {{1, 1}, {1, 1}, {1, 1}, {1, 1}}, 0.0}};
  for (const Case& c : cases) {
    for (std::size_t shift = 0; shift < c.ring.size(); ++shift) {
      SCOPED_TRACE(std::string(c.name) + " from corner " + std::to_string(shift));
      const Polygon polygon = in_plane(rotated(c.ring, shift));
      const PolygonCut cut = cut_polygon(polygon.vertices, {polygon.corners, {}});
      ASSERT_FALSE(cut.crosses);
      const std::vector<Triangle> triangles = triangles_of(polygon, cut);
      if (c.area != 0.0) {
        EXPECT_DOUBLE_EQ(area_of(polygon, triangles), c.area);
      }
      for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
        EXPECT_TRUE(covers_edge(polygon, triangles, i)) << i;
      }
    }
  }
}

TEST(CutPolygon, TellsRingsThatCross) {
  for (const std::vector<Flat>& ring :
       {std::vector<Flat>{{0, 0}, {4, 4}, {4, 0}, {0, 4}},
        std::vector<Flat>{{0, 0}, {5, 4}, {4, 0}, {0, 4}},
        std::vector<Flat>{{0, 3}, {2, -3}, {-3, 1}, {3, 1}, {-2, -3}},
        std::vector<Flat>{{0, 0}, {9, 0}, {9, 9}, {3, 9}, {3, -3}, {6, -3}, {6, 6}, {0, 6}}}) {
    for (std::size_t shift = 0; shift < ring.size(); ++shift) {
      const Polygon polygon = in_plane(rotated(ring, shift));
      EXPECT_TRUE(cut_polygon(polygon.vertices, {polygon.corners, {}}).crosses) << shift;
    }
  }
}

TEST(CutPolygon, KeepsTheFanOfConvexRings) {
  std::mt19937 rng(4);
  for (int n = 4; n < 40; ++n) {
    std::vector<Flat> ring;
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / n;
      ring.push_back({std::round(1e5 * std::cos(angle)), std::round(1e5 * std::sin(angle))});
    }
    for (const auto& each : {ring, with_flat_corners(ring)}) {
      const Polygon polygon = placed({each}, rng, -10);
      const PolygonCut cut = cut_polygon(polygon.vertices, {polygon.corners, {}});
      EXPECT_TRUE(cut.is_fan) << n;
      EXPECT_FALSE(cut.is_concave) << n;
      const Vector3d normal = newell_normal(polygon.vertices, polygon.corners);
      EXPECT_EQ(is_plainly_convex(polygon.vertices, polygon.corners, normal),
                each.size() == ring.size());
    }
  }
}

TEST(CutPolygon, CutsADartAlongItsInnerDiagonal) {
  const Polygon dart = in_plane({{0, 0}, {2, 1}, {0, 4}, {1, 1}});
  for (std::uint32_t shift = 0; shift < 4; ++shift) {
    Polygon polygon = dart;
    std::rotate(polygon.corners.begin(), polygon.corners.begin() + shift, polygon.corners.end());
    const PolygonCut cut = cut_polygon(polygon.vertices, {polygon.corners, {}});
    EXPECT_TRUE(cut.is_concave);
    for (const Triangle& t : triangles_of(polygon, cut)) {
      EXPECT_EQ(std::count(t.begin(), t.end(), 1u), 1);
      EXPECT_EQ(std::count(t.begin(), t.end(), 3u), 1);
    }
  }
}

// A quadrilateral of two crossing diagonals: their distance is what the two cuts differ by.
TEST(DeviationFromPlane, IsTheDistanceOfAQuadrilateralsDiagonals) {
  const Ring vertices = {{1, 0, 0.25}, {0, 1, -0.5}, {-1, 0, 0.25}, {0, -1, -0.5}};
  const std::vector<std::uint32_t> corners = {0, 1, 2, 3};
  const Vector3d normal = newell_normal(vertices, corners);
  EXPECT_NEAR(deviation_from_plane(vertices, corners, normal), 0.75, 1e-12);
}

// Needles have normals of few bits, and are not to be taken for folded polygons by it.
TEST(DeviationFromPlane, DoesNotMistakeRounding) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int round = 0; round < 1000; ++round) {
    const Vector3d u = Vector3d(any(rng), any(rng), any(rng)).normalized();
    const Vector3d v =
        Vector3d(any(rng), any(rng), any(rng)) * std::pow(10.0, 8.0 * any(rng) - 8.0);
    const Ring vertices = {Vector3d::Zero(), u, u + v, v};
    const std::vector<std::uint32_t> corners = {0, 1, 2, 3};
    const Vector3d normal = newell_normal(vertices, corners);
    EXPECT_LT(deviation_from_plane(vertices, corners, normal), 1e-15) << round;
  }
}

// Work grows as n log n: rings of this size take a fraction of a second.
TEST(CutPolygon, IsQuickOnManyCorners) {
  std::mt19937 rng(6);
  const int n = test::rounds(50'000, 1000);
  for (const auto& ring : {star(2 * n, rng), comb(n, rng), spiral(n)}) {
    for (const bool turned : {false, true}) {
      std::vector<Flat> flat = ring;
      for (Flat& p : flat) {
        p = turned ? Flat{p.y, -p.x} : p;
      }
      const auto before = std::chrono::steady_clock::now();
      const Polygon polygon = in_plane(flat);
      const PolygonCut cut = cut_polygon(polygon.vertices, {polygon.corners, {}});
      EXPECT_FALSE(cut.crosses);
      EXPECT_EQ(cut.triangles.size(), polygon.corners.size() - 2);
      EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(20));
    }
  }
}

}  // namespace
}  // namespace firstcontact::detail
