// Boxes and polytopes around shapes hold all of their triangles, rounding included.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <firstcontact/geometry/point_cloud.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/geometry/shape_bounds.h>

#include "support/random.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;
using Long = long double;  // 64 bits of mantissa: enough beside slacks of 2^-46.
using Vector3L = Eigen::Matrix<Long, 3, 1>;

Vector3L exact(const Vector3d& v) { return v.cast<Long>(); }

void expect_hold(const ShapeBounds& bounds, const std::vector<Vector3d>& places,
                 std::uint64_t seed) {
  const Eigen::Matrix<Long, 3, 3> axes = bounds.axes.cast<Long>();
  for (const Vector3d& vertex : places) {
    const Vector3L p = exact(vertex) - exact(bounds.centre);
    const Vector3L local = axes * p;
    for (int k = 0; k < 3; ++k) {
      ASSERT_LE(std::abs(local[k]), static_cast<Long>(bounds.half_extents[k])) << seed;
    }
    ASSERT_LE(p.norm(), static_cast<Long>(bounds.reach)) << seed;
  }
  Random random(seed);
  for (int i = 0; i < 50; ++i) {
    const Vector3L n = exact(random.direction());
    Long vertices = -std::numeric_limits<Long>::infinity();
    for (const Vector3d& vertex : places) {
      vertices = std::max(vertices, n.dot(exact(vertex) - exact(bounds.centre)));
    }
    const Long corners = (bounds.corners.cast<Long>() * n).maxCoeff();
    ASSERT_LE(vertices, corners + static_cast<Long>(bounds.error)) << seed;
  }
}

void expect_holds(const Shape& shape, std::uint64_t seed) {
  expect_hold(shape.bounds(), shape.mesh().vertices, seed);
}

/// A handful of triangles: round, flat, or a needle; anywhere.
Mesh soup(Random& random, double far, int count) {
  const Vector3d middle = far * random.direction();
  const Vector3d stretch(1.0, random.chance(0.3) ? 0.0 : random.logarithmic(1e-6, 1.0),
                         random.chance(0.3) ? 0.0 : random.logarithmic(1e-6, 1.0));
  const Eigen::Quaterniond turn = random.rotation();
  Mesh mesh;
  for (int i = 0; i < 3 * count; ++i) {
    mesh.vertices.push_back(middle + turn * stretch.cwiseProduct(random.vector(0.0, 1.0)));
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TEST(ShapeBounds, HoldAllTriangles) {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed);
    const double far = seed % 4 == 0 ? 0.0 : random.logarithmic(1e-3, 1e6);
    const int count = seed % 3 == 0 ? 1 : 1 + static_cast<int>(random.uniform(0.0, 60.0));
    expect_holds(Shape(soup(random, far, count)), seed);
  }
}

/// Seen from the centre that its motion carries.
TEST(ShapeBounds, HoldAShapeThatDeformsAtAllTimes) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const Shape shape(soup(random, seed % 4 == 0 ? 0.0 : 10.0, 1 + static_cast<int>(seed % 40)));
    std::vector<Vector3d> to;
    for (const Vector3d& vertex : shape.mesh().vertices) {
      to.push_back(vertex + random.vector(0.0, 3.0));
    }
    const Vector3d translation = random.vector(0.0, 2.0);
    const Shape deforming = shape.deforming(to, translation);
    for (const double t : {0.0, 0.25, 0.8, 1.0}) {
      std::vector<Vector3d> places;
      for (std::size_t k = 0; k < to.size(); ++k) {
        places.push_back((1.0 - t) * shape.mesh().vertices[k] + t * (to[k] - translation));
      }
      expect_hold(deforming.bounds(), places, seed);
    }
  }
}

TEST(ShapeBounds, OfOnePointIsThatPoint) {
  const Shape sphere = make_sphere(0.5);
  const ShapeBounds& bounds = sphere.bounds();
  EXPECT_LT(bounds.reach, 1e-12);
  EXPECT_EQ(bounds.corners.rows(), 1);
  expect_holds(make_point_cloud({{1e6, 2.0, -3.0}}), 0);
}

/// A box stands for a shape whose hull has too many corners to look through.
TEST(ShapeBounds, OfManyCornersAreThoseOfTheBox) {
  Random random(1);
  std::vector<Vector3d> points;
  for (int i = 0; i < 3000; ++i) {
    points.push_back(random.direction().cwiseProduct(Vector3d(3.0, 2.0, 1.0)));
  }
  const Shape ball = make_point_cloud(points);
  EXPECT_EQ(ball.bounds().corners.rows(), 8);
  expect_holds(ball, 1);
  EXPECT_NEAR(ball.bounds().half_extents.maxCoeff(), 3.0, 0.05);
  EXPECT_NEAR(ball.bounds().half_extents.minCoeff(), 1.0, 0.05);
}

/// Tight.
TEST(ShapeBounds, OfABoxIsTheBox) {
  const Vector3d size(0.3, 1.2, 5.0);
  const Shape box = make_box(size);
  const ShapeBounds& bounds = box.bounds();
  EXPECT_TRUE(bounds.half_extents.isApprox(0.5 * size, 1e-13));
  EXPECT_NEAR(bounds.reach, 0.5 * size.norm(), 1e-12);
  EXPECT_EQ(bounds.corners.rows(), 8);
}

}  // namespace
}  // namespace firstcontact::test
