#include <firstcontact/geometry/primitives.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <firstcontact/geometry/mesh_defects.h>

namespace firstcontact {
namespace {

TEST(Sphere, IsAPointWithARadius) {
  const Shape sphere = make_sphere(0.5);
  EXPECT_EQ(sphere.mesh().vertices.size(), 1u);
  EXPECT_EQ(sphere.radius(), 0.5);
  EXPECT_EQ(sphere.enclosure_error(), 0.0);
}

TEST(Capsule, IsAnEdgeWithARadius) {
  const Shape capsule = make_capsule(0.5, 2.0);
  ASSERT_EQ(capsule.edge_count(), 1u);
  EXPECT_EQ(capsule.mesh().vertices[0], Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(capsule.mesh().vertices[1], Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(capsule.radius(), 0.5);
}

TEST(Box, IsClosedAndFacesOutwards) {
  const Shape box = make_box({1.0, 2.0, 3.0});
  const MeshDefects found = inspect(box.mesh());
  EXPECT_TRUE(found.closed);
  ASSERT_TRUE(found.signed_volume);
  EXPECT_DOUBLE_EQ(*found.signed_volume, 6.0);
  EXPECT_TRUE(box.is_solid());
}

TEST(Box, NumbersItsFacesBySide) {
  const Shape box = make_box({1.0, 2.0, 3.0});
  const Mesh& mesh = box.mesh();
  for (std::size_t k = 0; k < 12; ++k) {
    const auto& t = mesh.triangles[k];
    const Eigen::Vector3d normal = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                                       .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                                       .normalized();
    Eigen::Vector3d expected = Eigen::Vector3d::Zero();
    expected[static_cast<int>(k / 4)] = k % 4 < 2 ? -1.0 : 1.0;
    EXPECT_TRUE(normal.isApprox(expected)) << k;
  }
}

/// The distance of the z axis from each side edge of the ring of n vertices, in long double.
long double least_distance(const Mesh& mesh, std::size_t n) {
  long double least = 1e300L;
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector3d& a = mesh.vertices[k];
    const Eigen::Vector3d& b = mesh.vertices[(k + 1) % n];
    const long double dx = static_cast<long double>(b.x()) - a.x();
    const long double dy = static_cast<long double>(b.y()) - a.y();
    const long double area =
        static_cast<long double>(a.x()) * b.y() - static_cast<long double>(a.y()) * b.x();
    least = std::min(least, area / std::sqrt(dx * dx + dy * dy));
  }
  return least;
}

struct Round {
  double radius;
  double error;  // relative
};

class RoundTest : public testing::TestWithParam<Round> {};

TEST_P(RoundTest, EnclosesTheExactBodyAsTightlyAsAsked) {
  const auto [radius, relative] = GetParam();
  const double asked = relative * radius;
  const Shape cylinder = make_cylinder(radius, radius, asked);
  const std::size_t n = (cylinder.mesh().vertices.size() - 2) / 2;
  EXPECT_GE(least_distance(cylinder.mesh(), n), static_cast<long double>(radius));
  EXPECT_LE(cylinder.enclosure_error(), asked);
  EXPECT_GE(cylinder.enclosure_error(), 0.2 * asked) << "more corners than needed";
  for (const Eigen::Vector3d& v : cylinder.mesh().vertices) {
    EXPECT_LE(std::hypot(static_cast<long double>(v.x()), static_cast<long double>(v.y())),
              static_cast<long double>(radius) + cylinder.enclosure_error());
  }
  const Shape cone = make_cone(radius, radius, asked);
  EXPECT_EQ(cone.enclosure_error(), cylinder.enclosure_error());
  EXPECT_GE(least_distance(cone.mesh(), n), static_cast<long double>(radius));
}

INSTANTIATE_TEST_SUITE_P(Sizes, RoundTest,
                         testing::Values(Round{1.0, 1e-4}, Round{0.3, 1e-2}, Round{1e-50, 1e-4},
                                         Round{7e50, 1e-5},
                                         Round{0.1, FIRSTCONTACT_SANITIZED ? 1e-6 : 1e-8},
                                         Round{3.0, 0.5}, Round{1.0, 1.2}));

TEST(Cylinder, IsClosedAndFacesOutwards) {
  const Shape cylinder = make_cylinder(0.5, 2.0);
  const MeshDefects found = inspect(cylinder.mesh());
  EXPECT_TRUE(found.closed);
  ASSERT_TRUE(found.signed_volume);
  EXPECT_NEAR(*found.signed_volume, std::numbers::pi * 0.25 * 2.0, 1e-3);
  EXPECT_LE(cylinder.enclosure_error(), 0.5e-4);
}

TEST(Cone, IsClosedAndFacesOutwards) {
  const Shape cone = make_cone(0.5, 2.0);
  const MeshDefects found = inspect(cone.mesh());
  EXPECT_TRUE(found.closed);
  ASSERT_TRUE(found.signed_volume);
  EXPECT_NEAR(*found.signed_volume, std::numbers::pi * 0.25 * 2.0 / 3.0, 1e-3);
}

TEST(Primitive, RefusesLengthsOutOfRange) {
  EXPECT_THROW((void)make_sphere(0.0), std::invalid_argument);
  EXPECT_THROW((void)make_sphere(std::nan("")), std::invalid_argument);
  EXPECT_THROW((void)make_capsule(1.0, -1.0), std::invalid_argument);
  EXPECT_THROW((void)make_box({1.0, 0.0, 1.0}), std::invalid_argument);
  EXPECT_THROW((void)make_cylinder(1.0, INFINITY), std::invalid_argument);
  EXPECT_THROW((void)make_cone(1.0, 1.0, 1e-12), std::invalid_argument);
}

TEST(Solid, NamesWhatKeepsAMeshFromIt) {
  Mesh mesh = make_box({1.0, 1.0, 1.0}).mesh();
  const auto message = [&] {
    try {
      Shape(mesh, 0.0, Filling::solid);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(), "");
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  EXPECT_EQ(message(),
            "Shape: a solid needs a closed mesh, this one has neighbouring triangles that face "
            "opposite sides");
  mesh.triangles.push_back(mesh.triangles[0]);
  EXPECT_EQ(message(),
            "Shape: a solid needs a closed mesh, this one has 3 edges of more than two triangles");
  mesh.triangles.resize(11);
  mesh.triangles.erase(mesh.triangles.begin());
  EXPECT_EQ(message(), "Shape: a solid needs a closed mesh, this one has 4 open edges");
}

TEST(ComponentVertices, AreOneOfEach) {
  Mesh mesh = make_box({1.0, 1.0, 1.0}).mesh();
  EXPECT_EQ(Shape(mesh).component_vertices().size(), 1u);
  mesh.vertices.emplace_back(5.0, 0.0, 0.0);
  mesh.triangles.push_back({8, 8, 8});
  EXPECT_EQ(Shape(mesh).component_vertices().size(), 2u);
}

}  // namespace
}  // namespace firstcontact
