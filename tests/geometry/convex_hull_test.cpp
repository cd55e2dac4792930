#include <firstcontact/geometry/convex_hull.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/mesh_defects.h>

#include "support/rational.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using oracle::Rational;

/// The sign of det(b - a, c - a, d - a), in exact rationals.
int exact_orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const auto difference = [&](const Vector3d& p, int k) { return Rational(p[k]) - Rational(a[k]); };
  Rational sum;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    sum = sum + difference(d, k) *
                    (difference(b, i) * difference(c, j) - difference(b, j) * difference(c, i));
  }
  const Rational zero;
  return sum > zero ? 1 : zero > sum ? -1 : 0;
}

/// Closed, facing outwards, and no point outside of any face.
void expect_hull(const std::vector<Vector3d>& points, const std::string& label) {
  const Mesh hull = convex_hull(points);
  const MeshDefects found = inspect(hull);
  ASSERT_TRUE(found.closed && found.consistently_oriented) << label;
  ASSERT_EQ(found.unused_vertices, 0u) << label;
  ASSERT_EQ(hull.triangles.size(), 2 * hull.vertices.size() - 4) << label;
  for (const auto& t : hull.triangles) {
    for (const Vector3d& p : points) {
      ASSERT_LE(exact_orientation(hull.vertices[t[0]], hull.vertices[t[1]], hull.vertices[t[2]], p),
                0)
          << label;
    }
  }
  for (const Vector3d& v : hull.vertices) {
    ASSERT_NE(std::find(points.begin(), points.end(), v), points.end()) << label;
  }
}

std::vector<Vector3d> random_points(std::mt19937_64& rng, std::size_t count) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Vector3d> points;
  for (std::size_t k = 0; k < count; ++k) {
    points.emplace_back(uniform(rng), uniform(rng), uniform(rng));
  }
  return points;
}

TEST(ConvexHull, EnclosesRandomPoints) {
  std::mt19937_64 rng(1);
  for (std::size_t count = 4; count < 60; count += test::rounds(1, 5)) {
    expect_hull(random_points(rng, count), std::to_string(count));
  }
}

// Every degeneracy at once: many points in planes, on lines and at one place.
TEST(ConvexHull, EnclosesPointsOfAGrid) {
  std::mt19937_64 rng(2);
  for (int i = 0; i < test::rounds(60, 16); ++i) {
    std::vector<Vector3d> points = random_points(rng, 60);
    const double cells = 1.0 + i % 4;
    for (Vector3d& p : points) {
      p = (cells * p).array().round() * 0.1;
    }
    points.insert(points.end(), {{-9, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}});
    expect_hull(points, std::to_string(i));
  }
}

TEST(ConvexHull, EnclosesNearlyFlatPoints) {
  std::mt19937_64 rng(3);
  for (const double thickness : {1e-14, 1e-16, 1e-17, 1e-30, 1e-80, 1e-200}) {
    std::vector<Vector3d> points = random_points(rng, 40);
    for (Vector3d& p : points) {
      p.z() *= thickness;
    }
    if (thickness > 1e-90) {
      expect_hull(points, std::to_string(thickness));
    }
    // Turned, it is flat to within rounding.
    const Eigen::Quaterniond q = Eigen::Quaterniond(0.3, 0.5, -0.2, 0.7).normalized();
    for (Vector3d& p : points) {
      p = q * p;
    }
    expect_hull(points, std::to_string(thickness) + " turned");
  }
}

TEST(ConvexHull, EnclosesPointsOfAnySize) {
  std::mt19937_64 rng(4);
  for (const double size : {1e-300, 1e-60, 1e60, 1e300}) {
    std::vector<Vector3d> points = random_points(rng, 20);
    for (Vector3d& p : points) {
      p *= size;
    }
    EXPECT_EQ(convex_hull(points).triangles.size(), 2 * convex_hull(points).vertices.size() - 4);
  }
}

TEST(ConvexHull, KeepsPointsOfASphere) {
  std::mt19937_64 rng(5);
  std::vector<Vector3d> points = random_points(rng, 300);
  for (Vector3d& p : points) {
    p.normalize();
  }
  EXPECT_EQ(convex_hull(points).vertices.size(), points.size());
  points.emplace_back(0.1, 0.2, 0.3);
  EXPECT_EQ(convex_hull(points).vertices.size(), points.size() - 1);
}

TEST(ConvexHull, OfAPlaneIsAPolygon) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vector3d> points;
    for (const auto& [x, y] : {std::pair(0.0, 0.0),
                               {1.0, 0.0},
                               {1.0, 1.0},
                               {0.0, 1.0},
                               {0.5, 0.5},
                               {0.5, 0.0},
                               {0.0, 0.0},
                               {1.0, 1.0}}) {
      Vector3d p = Vector3d::Constant(7.0);
      p[(axis + 1) % 3] = x;
      p[(axis + 2) % 3] = y;
      points.push_back(p);
    }
    const Mesh hull = convex_hull(points);
    EXPECT_EQ(hull.vertices.size(), 4u);
    EXPECT_EQ(hull.triangles.size(), 2u);
    EXPECT_FALSE(make_convex_hull(points).is_solid());
  }
}

TEST(ConvexHull, OfALineIsASegment) {
  const Mesh hull = convex_hull({{1, 1, 1}, {3, 3, 3}, {2, 2, 2}, {1, 1, 1}});
  EXPECT_EQ(hull.vertices, (std::vector<Vector3d>{{1, 1, 1}, {3, 3, 3}}));
  EXPECT_EQ(hull.triangles.size(), 1u);
}

TEST(ConvexHull, OfAPointIsThatPoint) {
  EXPECT_EQ(convex_hull({{1, 2, 3}, {1, 2, 3}}).vertices.size(), 1u);
  EXPECT_EQ(convex_hull({{0, 0, 0}}).vertices.size(), 1u);
}

TEST(ConvexHull, RefusesWhatHasNone) {
  EXPECT_THROW((void)convex_hull({}), std::invalid_argument);
  EXPECT_THROW((void)convex_hull({{0, 0, NAN}}), std::invalid_argument);
}

TEST(ConvexHull, OfManyPointsIsSolid) {
  std::mt19937_64 rng(6);
  const Shape hull = make_convex_hull(random_points(rng, 100'000), 0.1);
  EXPECT_TRUE(hull.is_solid());
  EXPECT_EQ(hull.radius(), 0.1);
  EXPECT_NEAR(*inspect(hull.mesh()).signed_volume, 8.0, 0.1);
}

}  // namespace
}  // namespace firstcontact
