#include <firstcontact/geometry/mass_properties.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <firstcontact/geometry/primitives.h>

#include "support/random.h"

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

Matrix3d diagonal(double x, double y, double z) { return Vector3d(x, y, z).asDiagonal(); }

void expect_near(const MassProperties& got, const MassProperties& expected, double relative) {
  const double size = std::cbrt(expected.volume);
  EXPECT_NEAR(got.volume, expected.volume, relative * expected.volume);
  EXPECT_LE((got.p_BC - expected.p_BC).norm(), relative * (size + expected.p_BC.norm()));
  EXPECT_LE((got.about_C - expected.about_C).norm(), relative * expected.about_C.norm());
}

MassProperties of_box(const Vector3d& size) {
  const Vector3d s = size.cwiseProduct(size) * (size.prod() / 12.0);
  return {size.prod(), Vector3d::Zero(), diagonal(s.y() + s.z(), s.z() + s.x(), s.x() + s.y())};
}

Mesh moved(Mesh mesh, const Quaterniond& rotation, const Vector3d& translation) {
  for (Vector3d& v : mesh.vertices) {
    v = rotation * v + translation;
  }
  return mesh;
}

Mesh reversed(Mesh mesh) {
  for (auto& t : mesh.triangles) {
    std::swap(t[1], t[2]);
  }
  return mesh;
}

Mesh joined(Mesh mesh, const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return mesh;
}

Mesh box(const Vector3d& size) { return make_box(size).mesh(); }

std::string refusal(const Mesh& mesh, double radius = 0.0) {
  try {
    (void)mass_properties(Shape(mesh, radius));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(MassProperties, OfABoxAreInClosedForm) {
  expect_near(mass_properties(make_box({1.0, 2.0, 3.0})), of_box({1.0, 2.0, 3.0}), 1e-15);
  expect_near(mass_properties(make_box({1e-4, 5.0, 7.0})), of_box({1e-4, 5.0, 7.0}), 1e-14);
}

TEST(MassProperties, OfATetrahedronAreInClosedForm) {
  const Mesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                  .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  // Over the unit tetrahedron: x^2 gives 1/60, x y 1/120; the centre of mass is at 1/4.
  const double square = 1.0 / 60.0 - 1.0 / 96.0;
  const double product = 1.0 / 120.0 - 1.0 / 96.0;
  const Matrix3d about_C =
      (3.0 * square - square + product) * Matrix3d::Identity() - product * Matrix3d::Ones();
  expect_near(mass_properties(Shape(mesh)), {1.0 / 6.0, Vector3d::Constant(0.25), about_C}, 1e-14);
}

TEST(MassProperties, OfABallAndACapsuleAreInClosedForm) {
  const double ball = 4.0 / 3.0 * kPi * 8.0;
  expect_near(mass_properties(make_sphere(2.0)),
              {ball, Vector3d::Zero(), 0.4 * ball * 4.0 * Matrix3d::Identity()}, 1e-15);
  // Sum of the cylinder and the two half balls, each about its own centre of mass and moved.
  const double cylinder = kPi * 4.0 * 3.0;
  const double offset = 1.5 + 3.0 / 8.0 * 2.0;
  const double across =
      cylinder * (9.0 / 12.0 + 4.0 / 4.0) + ball * (83.0 / 320.0 * 4.0 + offset * offset);
  const double along = cylinder * 2.0 + ball * 0.4 * 4.0;
  expect_near(mass_properties(make_capsule(2.0, 3.0)),
              {cylinder + ball, Vector3d::Zero(), diagonal(across, across, along)}, 1e-14);
}

TEST(MassProperties, OfAThickenedEdgeFollowItsPlace) {
  const Vector3d a(1, 2, 3);
  const Vector3d b(4, 2, 3);
  const Shape edge({.vertices = {a, b}, .triangles = {{0, 1, 1}}}, 0.5);
  const MassProperties along_z = mass_properties(make_capsule(0.5, 3.0));
  const Vector3d moments = along_z.about_C.diagonal();
  expect_near(mass_properties(edge),
              {along_z.volume, 0.5 * (a + b), diagonal(moments.z(), moments.x(), moments.y())},
              1e-14);
}

// The oracle are the triangles around them, ever finer.
TEST(MassProperties, OfCurvedBodiesAreThoseOfFineTriangles) {
  const Vector3d radii(0.3, 0.7, 0.5);
  for (const double error : {1e-3, 1e-4}) {
    for (const Shape& shape : {make_cylinder(0.7, 0.4, error), make_cone(0.7, 1.9, error),
                               make_ellipsoid(radii, 4.0 * error)}) {
      expect_near(mass_properties(shape), mass_properties(shape.as_triangles()), 60.0 * error);
      EXPECT_LT(mass_properties(shape).volume, mass_properties(shape.as_triangles()).volume);
    }
  }
  const double m = kPi * 0.25 * 2.0;
  const double across = m * (3.0 * 0.25 + 4.0) / 12.0;
  expect_near(mass_properties(make_cylinder(0.5, 2.0, 1e-2)),
              {m, Vector3d::Zero(), diagonal(across, across, 0.125 * m)}, 1e-15);
}

TEST(MassProperties, OfAPrismAroundACylinderAreWithinItsError) {
  const double error = 1e-4;
  const MassProperties got = mass_properties(make_cylinder(1.0, 2.0, error).as_triangles());
  const auto exact = [](double r) {
    const double m = kPi * r * r * 2.0;
    const double across = m * (3.0 * r * r + 4.0) / 12.0;
    return MassProperties{m, Vector3d::Zero(), diagonal(across, across, 0.5 * m * r * r)};
  };
  const MassProperties least = exact(1.0);
  const MassProperties most = exact(1.0 + error);
  EXPECT_GT(got.volume, least.volume);
  EXPECT_LT(got.volume, most.volume);
  EXPECT_LE(got.p_BC.norm(), 1e-14);
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(got.about_C(k, k), least.about_C(k, k)) << k;
    EXPECT_LT(got.about_C(k, k), most.about_C(k, k)) << k;
  }
}

TEST(MassProperties, MoveWithTheMesh) {
  test::Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Mesh mesh = make_cone(0.3, 2.0, 0.01).mesh();
    const MassProperties rest = mass_properties(Shape(mesh));
    const Quaterniond R = random.rotation();
    const Vector3d translation = random.vector(0.0, 10.0);
    const Matrix3d about_C = R * rest.about_C * R.inverse();
    expect_near(mass_properties(Shape(moved(mesh, R, translation))),
                {rest.volume, R * rest.p_BC + translation, about_C}, 1e-13);
  }
}

TEST(MassProperties, KeepTheirPrecisionFarAway) {
  // Whole numbers, so that the box itself is exact at the new place.
  const Mesh mesh = moved(box({2, 4, 6}), Quaterniond::Identity(), {1e6, -1e6, 1e6});
  MassProperties expected = of_box({2, 4, 6});
  expected.p_BC = {1e6, -1e6, 1e6};
  expect_near(mass_properties(Shape(mesh)), expected, 1e-15);
}

TEST(MassProperties, OfAMeshInsideOutAreThoseOfTheMesh) {
  expect_near(mass_properties(Shape(reversed(box({1, 2, 3})))), of_box({1, 2, 3}), 1e-15);
}

TEST(MassProperties, LeaveOutCavities) {
  const MassProperties outer = of_box({3, 3, 3});
  const MassProperties inner = of_box({1, 2, 1});
  const Mesh hollow = joined(box({3, 3, 3}), reversed(box({1, 2, 1})));
  const MassProperties expected{outer.volume - inner.volume, Vector3d::Zero(),
                                outer.about_C - inner.about_C};
  expect_near(mass_properties(Shape(hollow)), expected, 1e-14);
  expect_near(mass_properties(Shape(reversed(hollow))), expected, 1e-14);
}

TEST(MassProperties, AddParts) {
  const Mesh right = moved(box({1, 1, 1}), Quaterniond::Identity(), {4, 0, 0});
  const MassProperties got = mass_properties(Shape(joined(box({1, 1, 1}), right)));
  EXPECT_NEAR(got.volume, 2.0, 1e-14);
  EXPECT_LE((got.p_BC - Vector3d(2, 0, 0)).norm(), 1e-14);
  EXPECT_NEAR(got.about_C(0, 0), 2.0 / 6.0, 1e-14);
  EXPECT_NEAR(got.about_C(1, 1), 2.0 / 6.0 + 2.0 * 4.0, 1e-14);
}

TEST(MassProperties, RefuseAPartInsideOutThatIsNoCavity) {
  const Mesh right = moved(box({1, 1, 1}), Quaterniond::Identity(), {4, 0, 0});
  const std::string why = refusal(joined(box({2, 2, 2}), reversed(right)));
  EXPECT_NE(why.find("part of vertex 8 faces the other way"), std::string::npos) << why;
}

TEST(MassProperties, CountVerticesAtOnePlaceAsOne) {
  Mesh soup;
  const Mesh whole = box({1, 2, 3});
  for (const auto& t : whole.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) {
      soup.vertices.push_back(whole.vertices[v]);
    }
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  expect_near(mass_properties(Shape(soup)), of_box({1, 2, 3}), 1e-15);
}

TEST(MassProperties, GiveARoundedMeshTheMassOfItsCore) {
  expect_near(mass_properties(Shape(box({1, 2, 3}), 0.1)), of_box({1, 2, 3}), 1e-15);
}

TEST(MassProperties, RefuseWhatEnclosesNoSpaceAndSayTheMend) {
  Mesh open = box({1, 1, 1});
  open.triangles.pop_back();
  EXPECT_NE(refusal(open).find("3 edges are open"), std::string::npos) << refusal(open);
  EXPECT_NE(refusal(open).find("give mass, centre_of_mass and inertia"), std::string::npos);

  Mesh twisted = box({1, 1, 1});
  std::swap(twisted.triangles[0][0], twisted.triangles[0][1]);
  EXPECT_NE(refusal(twisted).find("face opposite sides"), std::string::npos) << refusal(twisted);

  // A sheet, doubled back to back, far away and askew: only rounding encloses anything.
  const Mesh sheet{.vertices = {{0, 0, 0}, {1, 0.1, 0.2}, {0.3, 1, 0.1}},
                   .triangles = {{0, 1, 2}, {0, 2, 1}}};
  const Mesh far = moved(sheet, Quaterniond(1, 2, 3, 4).normalized(), {1e6, 2e6, 3e6});
  EXPECT_NE(refusal(far).find("no volume"), std::string::npos) << refusal(far);

  const Mesh point{.vertices = {{0, 0, 0}}, .triangles = {{0, 0, 0}}};
  EXPECT_NE(refusal(point).find("no volume"), std::string::npos) << refusal(point);

  const Mesh cloud{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                   .triangles = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}};
  EXPECT_NE(refusal(cloud, 0.1).find("no volume"), std::string::npos) << refusal(cloud, 0.1);
}

// Thin but real: the bound on rounding does not refuse it.
TEST(MassProperties, OfAThinPlateAreFound) {
  const Mesh plate = moved(box({1, 1, 1e-6}), Quaterniond(1, 2, 3, 4).normalized(), {0, 0, 0});
  EXPECT_NEAR(mass_properties(Shape(plate)).volume, 1e-6, 1e-14);
}

}  // namespace
}  // namespace firstcontact
