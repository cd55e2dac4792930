#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_hull.h>
#include <firstcontact/geometry/mass_properties.h>
#include <firstcontact/geometry/primitives.h>

#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

void expect_near(const MassProperties& got, const MassProperties& expected, double relative) {
  const double size = std::cbrt(expected.volume);
  EXPECT_NEAR(got.volume, expected.volume, relative * expected.volume);
  EXPECT_LE((got.p_BC - expected.p_BC).norm(), relative * (size + expected.p_BC.norm()));
  EXPECT_LE((got.about_C - expected.about_C).norm(), relative * expected.about_C.norm());
}

/// A rounded cube by its sections across an axis: squares, rounded by the section of the ball.
MassProperties of_rounded_cube(double side, double radius) {
  const auto section = [&](double rounding) {
    return side * side + 4.0 * side * rounding + kPi * rounding * rounding;
  };
  double volume = side * section(radius);
  double second = section(radius) * side * side * side / 12.0;
  constexpr int kParts = 20'000;
  for (int k = 0; k <= kParts; ++k) {  // Simpson's rule over an angle, where all is smooth.
    const double angle = 0.5 * kPi * k / kParts;
    const double weight = (k == 0 || k == kParts ? 1.0
                           : k % 2 == 1          ? 4.0
                                                 : 2.0) /
                          3.0 * (0.5 * kPi / kParts) * radius * std::cos(angle);
    const double height = 0.5 * side + radius * std::sin(angle);
    const double area = section(radius * std::cos(angle));
    volume += 2.0 * weight * area;
    second += 2.0 * weight * area * height * height;
  }
  return {volume, Vector3d::Zero(), 2.0 * second * Matrix3d::Identity()};
}

TEST(ThickHull, ARoundedCubeIsTheSumOfItsSections) {
  for (const auto& [side, radius] :
       {std::pair(1.0, 0.3), std::pair(0.2, 5.0), std::pair(3.0, 1e-3)}) {
    expect_near(mass_properties(make_box(Vector3d::Constant(side), radius)),
                of_rounded_cube(side, radius), 1e-12);
  }
  const double volume = mass_properties(make_box({1.0, 2.0, 3.0}, 0.5)).volume;
  EXPECT_NEAR(volume, 6.0 + 22.0 * 0.5 + kPi * 0.25 * 6.0 + 4.0 / 3.0 * kPi * 0.125, 1e-13);
}

TEST(ThickHull, ASmallBoxIsABallAndALongOneACapsule) {
  expect_near(mass_properties(make_box(Vector3d::Constant(1e-9), 2.0)),
              mass_properties(make_sphere(2.0)), 2e-9);
  expect_near(mass_properties(make_box({1e-6, 1e-6, 3.0}, 2.0)),
              mass_properties(make_capsule(2.0, 3.0)), 2e-6);
}

/// Directions evenly over the sphere, along a spiral.
std::vector<Vector3d> directions(int count) {
  std::vector<Vector3d> all;
  for (int k = 0; k < count; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / count;
    const double angle = kPi * (1.0 + std::sqrt(5.0)) * k;
    const double rho = std::sqrt(1.0 - z * z);
    all.emplace_back(rho * std::cos(angle), rho * std::sin(angle), z);
  }
  return all;
}

/// The solid of balls around corners, each by points on it: inscribed, so a little smaller.
MassProperties of_inscribed(const std::vector<Vector3d>& corners, double radius, int count) {
  std::vector<Vector3d> around;
  for (const Vector3d& direction : directions(count)) {
    for (const Vector3d& corner : corners) {
      around.push_back(corner + radius * direction);
    }
  }
  return mass_properties(make_convex_hull(around));
}

/// What two inscribed solids tend to. The error falls as one over the number of points.
MassProperties extrapolated(const MassProperties& coarse, const MassProperties& fine) {
  const double volume = fine.volume + (fine.volume - coarse.volume) / 3.0;
  const Vector3d centre = fine.p_BC + (fine.p_BC - coarse.p_BC) / 3.0;
  return {volume, centre, fine.about_C + (fine.about_C - coarse.about_C) / 3.0};
}

TEST(ThickHull, RandomHullsAreThoseOfManyPoints) {
  test::Random random(7);
  constexpr std::array kCounts = {4u, 5u, 8u, 20u, 80u};
  for (const std::size_t count : std::span(kCounts).first(test::rounds(5, 3))) {
    const double radius = random.uniform(0.05, 0.8);
    std::vector<Vector3d> points;
    for (std::size_t k = 0; k < count; ++k) {
      points.push_back(Vector3d(5, -3, 2) + Vector3d(random.uniform(-1, 1), random.uniform(-1, 1),
                                                     random.uniform(-1, 1)));
    }
    const std::vector<Vector3d> corners = convex_hull(points).vertices;
    const MassProperties coarse = of_inscribed(corners, radius, 2'000);
    const MassProperties fine = of_inscribed(corners, radius, 8'000);
    const MassProperties got = mass_properties(make_convex_hull(points, radius));
    expect_near(got, extrapolated(coarse, fine), 2e-4);
    EXPECT_GT(got.volume, fine.volume);
  }
}

/// A flat hull has no space of its own, but its radius has: a plate with a round rim.
TEST(ThickHull, AFlatHullIsAPlate) {
  const std::vector<Vector3d> square{
      {-0.1, -0.1, 0.0}, {0.1, -0.1, 0.0}, {0.1, 0.1, 0.0}, {-0.1, 0.1, 0.0}};
  const double r = 0.05;
  // J. Steiner: area, half perimeter, ball.
  EXPECT_NEAR(mass_properties(make_convex_hull(square, r)).volume,
              0.04 * 2.0 * r + 0.4 * kPi * r * r + 4.0 / 3.0 * kPi * r * r * r, 1e-16);
  test::Random random(8);
  for (const std::size_t count : {3u, 4u, 5u, 9u, 40u}) {
    const double radius = random.uniform(0.2, 0.8);
    std::vector<Vector3d> points;
    for (std::size_t k = 0; k < count; ++k) {
      points.emplace_back(5.0 + random.uniform(-1, 1), -3.0, random.uniform(-1, 1));
    }
    const std::vector<Vector3d> corners = convex_hull(points).vertices;
    const MassProperties got = mass_properties(make_convex_hull(points, radius));
    // Turned, its corners are in one plane but for rounding.
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.0, Vector3d(1, 2, 3).normalized()));
    std::vector<Vector3d> turned;
    for (const Vector3d& point : points) {
      turned.push_back(turn * point);
    }
    const MassProperties same = mass_properties(make_convex_hull(turned, radius));
    const Matrix3d R = turn.toRotationMatrix();
    expect_near({same.volume, R.transpose() * same.p_BC, R.transpose() * same.about_C * R}, got,
                1e-12);
    const MassProperties fine = of_inscribed(corners, radius, 8'000);
    expect_near(got, extrapolated(of_inscribed(corners, radius, 2'000), fine), 5e-4);
    EXPECT_GT(got.volume, fine.volume);
  }
}

// A mesh that is flat but not convex encloses nothing.
TEST(ThickHull, ASheetWithANotchIsNone) {
  const Mesh notched{.vertices = {{0, 0, 0}, {1, -1, 0}, {0.2, 0, 0}, {1, 1, 0}},
                     .triangles = {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_THROW((void)mass_properties(Shape(notched, 0.1)), std::invalid_argument);
  const Mesh bent{.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}},
                  .triangles = {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_THROW((void)mass_properties(Shape(bent, 0.1)), std::invalid_argument);
}

// Faces of several triangles, and triangles that face inwards, change nothing.
TEST(ThickHull, DoesNotDependOnHowFacesAreCut) {
  const MassProperties box = mass_properties(make_box({1.0, 2.0, 3.0}, 0.25));
  Mesh mesh = make_box({1.0, 2.0, 3.0}).mesh();
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(-0.5, 0.1, 0.2);
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);  // The side at -x.
  for (const auto& [a, b] :
       {std::pair(0u, 4u), std::pair(4u, 6u), std::pair(6u, 2u), std::pair(2u, 0u)}) {
    mesh.triangles.push_back({a, b, middle});
  }
  expect_near(mass_properties(Shape(mesh, 0.25, Filling::solid)), box, 1e-13);
  for (auto& triangle : mesh.triangles) {
    std::swap(triangle[1], triangle[2]);
  }
  expect_near(mass_properties(Shape(mesh, 0.25, Filling::solid)), box, 1e-13);
}

// Two cubes apart, and a cube with a dent: their radius has no mass.
TEST(ThickHull, OnlyConvexSolidsHaveAThickSkin) {
  Mesh two = make_box({1.0, 1.0, 1.0}).mesh();
  const Mesh one = two;
  for (const Vector3d& vertex : one.vertices) {
    two.vertices.push_back(vertex + Vector3d(3, 0, 0));
  }
  for (const auto& t : one.triangles) {
    two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  }
  EXPECT_NEAR(mass_properties(Shape(two, 0.1, Filling::solid)).volume, 2.0, 1e-14);
  Mesh dented = one;
  dented.vertices.emplace_back(-0.3, 0.0, 0.0);
  dented.triangles.erase(dented.triangles.begin(), dented.triangles.begin() + 2);
  for (const auto& [a, b] :
       {std::pair(0u, 4u), std::pair(4u, 6u), std::pair(6u, 2u), std::pair(2u, 0u)}) {
    dented.triangles.push_back({a, b, 8});
  }
  EXPECT_NEAR(mass_properties(Shape(one, 0.1)).volume, 1.0, 1e-14);  // A surface.
  EXPECT_NEAR(mass_properties(Shape(dented, 0.1, Filling::solid)).volume, 1.0 - 0.2 / 3.0, 1e-14);
}

}  // namespace
}  // namespace firstcontact
