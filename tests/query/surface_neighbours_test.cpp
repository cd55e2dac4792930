// Places where a surface bulges, as the neighbours of its edges and vertices show them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/query/detail/surface_neighbours.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

Vector3d random_direction(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
}

Feature vertex(std::uint32_t index) { return {FeatureType::vertex, index, 0}; }
Feature edge(const Shape& shape, std::uint32_t a, std::uint32_t b) {
  return {FeatureType::edge, shape.edge_index(a, b), 0};
}

/// How far the farthest vertex reaches along a direction.
double reach(const Shape& shape, const Vector3d& direction) {
  double farthest = -1e9;
  for (const Vector3d& p : shape.mesh().vertices) {
    farthest = std::max(farthest, p.dot(direction));
  }
  return farthest;
}

// On a convex body no neighbour reaches farther just where nothing else does.
TEST(SurfaceNeighbours, OfAConvexBodyAreOutermostWhereItReachesFarthest) {
  const Shape cube = make_box({1.0, 2.0, 3.0});
  const SurfaceNeighbours neighbours(cube, 0.0);
  std::mt19937 rng(1);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d direction = random_direction(rng);
    const double farthest = reach(cube, direction);
    int outermost = 0;
    for (std::uint32_t v = 0; v < cube.mesh().vertices.size(); ++v) {
      const bool is_farthest = cube.mesh().vertices[v].dot(direction) == farthest;
      ASSERT_EQ(neighbours.is_outermost(vertex(v), direction), is_farthest) << i << " " << v;
      outermost += is_farthest;
    }
    ASSERT_EQ(outermost, 1) << i;
  }
}

TEST(SurfaceNeighbours, EdgesBulgeBetweenTheNormalsOfTheirFaces) {
  const Shape cube = make_box({2.0, 2.0, 2.0});
  const SurfaceNeighbours neighbours(cube, 0.0);
  for (std::uint32_t e = 0; e < cube.edge_count(); ++e) {
    const auto [a, b] = cube.edge(e);
    const Vector3d middle = 0.5 * (cube.mesh().vertices[a] + cube.mesh().vertices[b]);
    const Vector3d along = (cube.mesh().vertices[b] - cube.mesh().vertices[a]).normalized();
    const Feature feature{FeatureType::edge, e, 0};
    // An edge of the cube has its middle at (1, 1, 0) or the like, the diagonal of a face at (1, 0,
    // 0): there a direction that is turned off the normal, across the edge, leaves the edge.
    const Vector3d outwards = middle.normalized();
    const bool is_diagonal = middle.squaredNorm() < 1.5;
    EXPECT_TRUE(neighbours.is_outermost(feature, outwards)) << e;
    // Which side of a flat face is inside is not known, nor asked.
    EXPECT_EQ(neighbours.is_outermost(feature, -outwards), is_diagonal) << e;
    const Vector3d across = along.cross(outwards);
    for (const double side : {-0.3, 0.3}) {
      EXPECT_EQ(neighbours.is_outermost(feature, (outwards + side * across).normalized()),
                !is_diagonal)
          << e;
    }
  }
}

// A sliding corner touches only surfaces below it.
TEST(SurfaceNeighbours, RoundingOfADirectionDoesNotHideAFlatEdge) {
  const Shape cube = make_box({2.0, 2.0, 2.0});
  const SurfaceNeighbours neighbours(cube, 0.0);
  for (std::uint32_t e = 0; e < cube.edge_count(); ++e) {
    const auto [a, b] = cube.edge(e);
    const Vector3d middle = 0.5 * (cube.mesh().vertices[a] + cube.mesh().vertices[b]);
    const Vector3d along = (cube.mesh().vertices[b] - cube.mesh().vertices[a]).normalized();
    const Vector3d across = along.cross(middle.normalized());
    EXPECT_TRUE(neighbours.is_outermost({FeatureType::edge, e, 0},
                                        (middle.normalized() + 1e-8 * across).normalized()))
        << e;
  }
}

// A face that lies on another one, tilted within the band of contact, touches with all its corners.
TEST(SurfaceNeighbours, CornersOfATiltedFaceAreOutermostWithinTheSlack) {
  const Shape cube = make_box({2.0, 2.0, 2.0});
  constexpr double kSlack = 1e-3;
  const SurfaceNeighbours neighbours(cube, kSlack);
  for (const double raised : {0.9 * kSlack, 1.1 * kSlack}) {  // Height of the edge at x = 1.
    const Vector3d down = Vector3d(-raised / 2.0, 0.0, -1.0).normalized();
    for (std::uint32_t v = 0; v < cube.mesh().vertices.size(); ++v) {
      const Vector3d& p = cube.mesh().vertices[v];
      const bool is_low = p.z() < 0.0 && (p.x() < 0.0 || raised < kSlack);
      EXPECT_EQ(neighbours.is_outermost(vertex(v), down), is_low) << v << " " << raised;
    }
  }
}

// The caps of a cylinder are fans around their middle.
TEST(SurfaceNeighbours, OnlyTheMiddleOfACapIsWithinAFlatFace) {
  const Shape cylinder = make_cylinder(1.0, 2.0);
  const SurfaceNeighbours neighbours(cylinder, 0.0);
  int within = 0;
  for (std::uint32_t v = 0; v < cylinder.mesh().vertices.size(); ++v) {
    const bool is_middle = cylinder.mesh().vertices[v].head<2>().norm() < 0.5;
    within += is_middle;
    EXPECT_EQ(neighbours.extent(vertex(v)), is_middle ? Extent::plane : Extent::corner) << v;
  }
  EXPECT_EQ(within, 2);
}

TEST(SurfaceNeighbours, FlatAreTheDiagonalsOfABoxAlone) {
  const Shape cube = make_box({2.0, 2.0, 2.0});
  const SurfaceNeighbours neighbours(cube, 1e-3);
  for (std::uint32_t e = 0; e < cube.edge_count(); ++e) {
    const auto [a, b] = cube.edge(e);
    const double length = (cube.mesh().vertices[b] - cube.mesh().vertices[a]).norm();
    EXPECT_EQ(neighbours.is_flat_edge({FeatureType::edge, e, 0}), length > 2.5) << e;
  }
  EXPECT_FALSE(neighbours.is_flat_edge(vertex(0)));
  EXPECT_FALSE(neighbours.is_flat_edge({FeatureType::face, 0, 0}));
  const Shape sheet(Mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}});
  EXPECT_FALSE(SurfaceNeighbours(sheet, 0.0).is_flat_edge(edge(sheet, 0, 1)));
}

/// A valley along y: two slopes of 45 degrees that meet at the bottom, edge 0-1.
Shape valley() {
  return Shape(
      Mesh{.vertices = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 1}, {-1, 1, 1}, {1, 0, 1}, {1, 1, 1}},
           .triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}}});
}

TEST(SurfaceNeighbours, ValleyDoesNotBulge) {
  const Shape shape = valley();
  const SurfaceNeighbours neighbours(shape, 0.0);
  std::mt19937 rng(2);
  for (int i = 0; i < 1000; ++i) {
    Vector3d up = random_direction(rng);
    up = Vector3d(up.x(), 0.0, std::abs(up.z())).normalized();
    ASSERT_FALSE(neighbours.is_outermost(edge(shape, 0, 1), up)) << up.transpose();
  }
  EXPECT_TRUE(neighbours.is_outermost(edge(shape, 0, 1), -Vector3d::UnitZ()));
}

// At the border of a sheet nothing is in the way outwards, or on either side of it.
TEST(SurfaceNeighbours, BorderOfASheetBulgesOutwardsAndSideways) {
  const Shape sheet(Mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}});
  const SurfaceNeighbours neighbours(sheet, 0.0);
  const Feature border = edge(sheet, 0, 1);
  EXPECT_TRUE(neighbours.is_outermost(border, -Vector3d::UnitY()));
  EXPECT_TRUE(neighbours.is_outermost(border, Vector3d::UnitZ()));
  EXPECT_TRUE(neighbours.is_outermost(border, -Vector3d::UnitZ()));
  EXPECT_FALSE(neighbours.is_outermost(border, Vector3d::UnitY()));
  EXPECT_TRUE(neighbours.is_outermost(vertex(0), Vector3d(-1, -1, 0).normalized()));
  EXPECT_FALSE(neighbours.is_outermost(vertex(0), Vector3d(-1, 1, 0).normalized()));
}

TEST(SurfaceNeighbours, FacesAndLonePointsHaveNone) {
  const Shape ball = make_sphere(0.5);
  EXPECT_TRUE(SurfaceNeighbours(ball, 0.0).is_outermost(vertex(0), Vector3d::UnitX()));
  const Shape cube = make_box({1.0, 1.0, 1.0});
  EXPECT_TRUE(
      SurfaceNeighbours(cube, 0.0).is_outermost({FeatureType::face, 0, 0}, Vector3d::UnitX()));
}

/// A floor of 2 by 2 squares of 1 m, whose last corner is raised.
Shape floor_of_squares(double raised) {
  Mesh mesh;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      mesh.vertices.emplace_back(x, y, x == 2 && y == 2 ? raised : 0.0);
    }
  }
  for (std::uint32_t x = 0; x < 2; ++x) {
    for (std::uint32_t y = 0; y < 2; ++y) {
      const std::uint32_t a = 3 * x + y;
      mesh.triangles.push_back({a, a + 3, a + 1});
      mesh.triangles.push_back({a + 1, a + 3, a + 4});
    }
  }
  return Shape(std::move(mesh));
}

TEST(SurfaceNeighbours, KnowHowFarAFlatFaceGoesOn) {
  const Shape flat = floor_of_squares(0.0);
  const SurfaceNeighbours of_flat(flat, 0.0);
  EXPECT_EQ(of_flat.flat_around(vertex(4)), 1.0);
  EXPECT_EQ(of_flat.flat_around(vertex(0)), 0.0);  // On the rim.
  EXPECT_NEAR(of_flat.flat_around(edge(flat, 1, 4)), std::sqrt(0.5) * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(of_flat.flat_around(edge(flat, 0, 1)), 0.0);
  const Shape bent = floor_of_squares(0.1);
  const SurfaceNeighbours of_bent(bent, 0.0);
  EXPECT_EQ(of_bent.flat_around(edge(bent, 5, 7)), 0.0);
  EXPECT_EQ(of_bent.flat_around(vertex(4)), 1.0);  // The last triangle does not meet it.
}

TEST(SurfaceNeighbours, NumberAllTrianglesOfAFlatFaceAlike) {
  const auto surface = [](const SurfaceNeighbours& of, std::uint32_t triangle) {
    return of.surface_index({FeatureType::face, triangle, triangle});
  };
  const Shape bent = floor_of_squares(0.1);
  const SurfaceNeighbours of_bent(bent, 0.0);
  for (std::uint32_t t = 0; t < 7; ++t) {
    EXPECT_EQ(surface(of_bent, t), 0U) << t;
  }
  EXPECT_EQ(surface(of_bent, 7), 7U);
  const Shape cube = make_box({1.0, 1.0, 1.0});
  const SurfaceNeighbours of_cube(cube, 0.0);
  std::vector<std::uint32_t> found;
  for (std::uint32_t t = 0; t < 12; ++t) {
    found.push_back(surface(of_cube, t));
    const std::uint32_t first = found.back();
    EXPECT_EQ(surface(of_cube, first), first);
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  EXPECT_EQ(found.size(), 6U);
  EXPECT_EQ(of_cube.surface_index(vertex(3)), 3U);
}

}  // namespace
}  // namespace firstcontact::detail
