// Support functions of convex sets: upper bounds of the exact ones, whatever the direction, and not
// much above; points that lie in the set; boxes and triangles around it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <firstcontact/geometry/convex_hull.h>
#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/primitives.h>

#include "support/random.h"
#include "support/wide.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using oracle::Wide;

Wide wide_dot(const Vector3d& a, const Vector3d& b) {
  return Wide(a.x()) * Wide(b.x()) + Wide(a.y()) * Wide(b.y()) + Wide(a.z()) * Wide(b.z());
}

Wide wide_abs(double x) { return Wide(std::abs(x)); }

/// Contains the greater of both.
Wide greater(const Wide& a, const Wide& b) { return (a - b).is_negative() ? b : a; }

Wide radius_along(const Vector3d& n, double r) {
  return Wide(r) * sqrt(square(Wide(n.x())) + square(Wide(n.y())));
}

/// max n . x over the core.
Wide exact_support(const ConvexCore& core, const Vector3d& n) {
  const Vector3d& s = core.size;
  const Wide shift = wide_dot(n, core.origin);
  switch (core.kind) {
    case ConvexKind::point:
      return shift;
    case ConvexKind::segment:
      return shift + wide_abs(n.z()) * Wide(s.z());
    case ConvexKind::box:
      return shift + wide_abs(n.x()) * Wide(s.x()) + wide_abs(n.y()) * Wide(s.y()) +
             wide_abs(n.z()) * Wide(s.z());
    case ConvexKind::cylinder:
      return shift + wide_abs(n.z()) * Wide(s.z()) + radius_along(n, s.x());
    case ConvexKind::cone:
      return shift +
             greater(Wide(n.z()) * Wide(s.z()), radius_along(n, s.x()) - Wide(n.z()) * Wide(s.z()));
    case ConvexKind::ellipsoid:
      return shift + sqrt(square(Wide(n.x()) * Wide(s.x())) + square(Wide(n.y()) * Wide(s.y())) +
                          square(Wide(n.z()) * Wide(s.z())));
    case ConvexKind::hull:
      break;
  }
  Wide most = wide_dot(n, core.points[0]);
  for (const Vector3d& p : core.points) {
    most = greater(most, wide_dot(n, p));
  }
  return shift + most;
}

std::vector<ConvexSet> random_sets(test::Random& random) {
  const auto size = [&] { return random.logarithmic(0.01, 10.0); };
  std::vector<Vector3d> points;
  for (int k = 0; k < 12; ++k) {
    points.push_back(random.vector(0.0, 2.0));
  }
  const double radius = size();
  const double length = size();
  const double side = size();
  const Vector3d box(side, radius, length);
  return {ConvexSet::sphere(radius),        ConvexSet::capsule(radius, length),
          ConvexSet::box(box, 0.01),        ConvexSet::cylinder(radius, length),
          ConvexSet::cylinder(radius, 0.0), ConvexSet::cone(radius, length, 0.1),
          ConvexSet::ellipsoid(box),        ConvexSet::hull(points)};
}

/// Draws a direction of any length, sometimes along an axis or nearly so.
Vector3d any_direction(test::Random& random) {
  Vector3d n = random.direction();
  if (random.chance(0.2)) {
    n[static_cast<int>(random.uniform(0.0, 2.999))] = 0.0;
  }
  if (random.chance(0.2)) {
    n.x() *= random.logarithmic(1e-200, 1.0);
    n.y() *= random.logarithmic(1e-200, 1.0);
  }
  return random.chance(0.5) ? n : Vector3d(random.logarithmic(1e-150, 1e150) * n);
}

TEST(ConvexSet, SupportBoundIsNeverBelow) {
  test::Random random(1);
  for (int round = 0; round < 300; ++round) {
    for (const ConvexSet& set : random_sets(random)) {
      const ConvexCore core =
          set.core_from(random.chance(0.5) ? Vector3d(Vector3d::Zero()) : random.vector(0.0, 0.5));
      const Vector3d n = any_direction(random);
      const double bound = core.support_bound(n);
      const Wide exact = exact_support(core, n);
      ASSERT_GE((Wide(bound) - exact).lower(), 0.0)
          << "kind " << static_cast<int>(core.kind) << " n " << n.transpose();
      // Not much above, or infinity would do.
      const double slack = 0x1p-46 * n.lpNorm<1>() * core.reach + 1e-150 * core.reach + 1e-300;
      ASSERT_LE((Wide(bound) - exact).upper(), slack) << static_cast<int>(core.kind);
    }
  }
}

TEST(ConvexSet, SupportBoundIncludesTheRounding) {
  const ConvexSet ball = ConvexSet::sphere(0.5);
  const Vector3d n(3.0, 0.0, 4.0);
  EXPECT_GE(ball.support_bound(n), 2.5);
  EXPECT_LE(ball.support_bound(n), 2.5 * (1.0 + 1e-13));
}

TEST(ConvexSet, SupportBoundOfNaNProvesNothing) {
  const Vector3d n(std::nan(""), 0.0, 1.0);
  EXPECT_FALSE(ConvexSet::cylinder(1.0, 1.0).core().support_bound(n) < 1e300);
}

/// How far along n the set reaches beyond a point of it, at most, as part of the reach.
TEST(ConvexSet, SupportPointsLieInTheSetAndFarAlong) {
  test::Random random(2);
  for (int round = 0; round < 200; ++round) {
    for (const ConvexSet& set : random_sets(random)) {
      const ConvexCore& core = set.core();
      const Vector3d n = random.direction();
      const Vector3d p = core.support_point(n);
      ASSERT_GE(n.dot(p), core.support_bound(n) - 1e-13 * core.reach - 1e-300);
      for (int k = 0; k < 20; ++k) {  // No direction separates it from the set.
        const Vector3d m = random.direction();
        ASSERT_LE((wide_dot(m, p) - exact_support(core, m)).lower(), 0x1p-49 * core.reach);
      }
      ASSERT_LE(p.norm(), core.reach * (1.0 + 1e-15));
    }
  }
}

TEST(ConvexSet, SupportPointsOfTinyDirectionsLieInTheSet) {
  const ConvexSet cylinder = ConvexSet::cylinder(1.0, 2.0);
  for (const double tiny : {0.0, 1e-320, 1e-200, 1e-150, 1e-100}) {
    const Vector3d p = cylinder.core().support_point({tiny, -tiny, 1.0});
    EXPECT_LE(std::hypot(p.x(), p.y()), 1.0 + 1e-15) << tiny;
    EXPECT_EQ(p.z(), 1.0);
  }
}

TEST(ConvexSet, ReachAcrossCoversEveryPoint) {
  test::Random random(3);
  for (int round = 0; round < 200; ++round) {
    for (const ConvexSet& set : random_sets(random)) {
      const ConvexCore core = set.core_from(random.vector(0.0, 0.1));
      const Vector3d u = random.direction();
      const double most = core.reach_across(u);
      for (int k = 0; k < 20; ++k) {
        ASSERT_LE(core.support_point(random.direction()).cross(u).norm(), most * (1.0 + 1e-14));
      }
    }
  }
}

TEST(ConvexSet, ReachAcrossOfBodiesOfRevolutionIsTheirRadius) {
  for (const ConvexSet& set : {ConvexSet::cylinder(0.25, 8.0), ConvexSet::cone(0.25, 8.0)}) {
    EXPECT_NEAR(set.core().reach_across(Vector3d::UnitZ()), 0.25, 1e-12);
  }
  EXPECT_NEAR(ConvexSet::capsule(0.25, 8.0).core().reach_across(Vector3d::UnitZ()), 0.0, 1e-12);
}

TEST(ConvexSet, RefusesLengthsOutOfRange) {
  const double nan = std::nan("");
  EXPECT_THROW((void)ConvexSet::sphere(0.0), std::invalid_argument);
  EXPECT_THROW((void)ConvexSet::sphere(nan), std::invalid_argument);
  EXPECT_THROW((void)ConvexSet::cylinder(1.0, -1.0), std::invalid_argument);
  EXPECT_THROW((void)ConvexSet::cone(1.0, 0.0), std::invalid_argument);
  EXPECT_THROW((void)ConvexSet::ellipsoid({1.0, 1.0, 0.0}), std::invalid_argument);
  EXPECT_THROW((void)ConvexSet::box({1.0, 1.0, 1.0}, nan), std::invalid_argument);
  EXPECT_THROW((void)ConvexSet::hull({}), std::invalid_argument);
  EXPECT_THROW((void)ConvexSet::hull({{nan, 0.0, 0.0}}), std::invalid_argument);
}

std::vector<Shape> curved_shapes() {
  return {make_cylinder(0.3, 1.7),          make_cylinder(2.0, 0.1, 0.05),
          make_cone(0.5, 0.2, 0.03),        make_cone(0.4, 3.0),
          make_ellipsoid({1.0, 0.5, 0.25}), make_ellipsoid({0.01, 3.0, 1.0}, 0.1)};
}

TEST(ConvexShape, TrianglesEncloseItToWithinTheirError) {
  test::Random random(4);
  for (const Shape& shape : curved_shapes()) {
    ASSERT_TRUE(shape.is_curved());
    const ConvexCore& core = shape.convex_set()->core();
    for (int k = 0; k < 500; ++k) {
      const Vector3d n = random.direction();
      double most = -std::numeric_limits<double>::infinity();
      for (const Vector3d& v : shape.mesh().vertices) {
        most = std::max(most, n.dot(v));
      }
      const double exact = exact_support(core, n).nearest();
      ASSERT_GE(most, exact - 1e-14) << k;
      ASSERT_LE(most, exact + shape.enclosure_error() + 1e-14) << k;
    }
  }
}

TEST(ConvexShape, EllipsoidHasTheErrorThatIsAsked) {
  for (const double asked : {1e-3, 0.05}) {
    const Shape shape = make_ellipsoid({1.0, 0.7, 0.2}, asked);
    EXPECT_LE(shape.enclosure_error(), asked);
    EXPECT_GE(shape.enclosure_error(), 0.2 * asked) << "more triangles than needed";
  }
  EXPECT_THROW((void)make_ellipsoid({1.0, 1.0, 1.0}, 1e-5), std::invalid_argument);
  EXPECT_THROW((void)make_ellipsoid({1.0, 1.0, 1e-31}), std::invalid_argument);
  EXPECT_THROW((void)make_ellipsoid({1.0, std::nan(""), 1.0}), std::invalid_argument);
  EXPECT_TRUE(make_ellipsoid({1e-60, 1e-59, 1e-55}).is_solid());
  EXPECT_TRUE(make_ellipsoid({1e59, 1e58, 1e55}).is_solid());
}

TEST(ConvexShape, BoxOfItsHierarchyContainsIt) {
  test::Random random(5);
  std::vector<Shape> shapes = curved_shapes();
  shapes.push_back(make_box({1.0, 2.0, 3.0}));
  shapes.push_back(make_sphere(0.5));
  for (const Shape& shape : shapes) {
    const Hierarchy& hierarchy = shape.convex_hierarchy();
    const ConvexCore core = shape.convex_core();
    EXPECT_EQ(hierarchy.centre, shape.hierarchy().centre);
    const HierarchyNode& node = hierarchy.nodes.front();
    ASSERT_EQ(node.used(), 1u);
    ASSERT_TRUE(node.is_leaf(0));
    const Eigen::Matrix3d axes = box_axes(node, 0);
    const Vector3d centre(node.centre[0][0], node.centre[1][0], node.centre[2][0]);
    EXPECT_LE(node.half_extent(0, 0), node.half_extent(2, 0));
    EXPECT_LE(node.half_extent(1, 0), node.half_extent(2, 0));
    for (int k = 0; k < 200; ++k) {
      const Vector3d p = core.support_point(random.direction()) / hierarchy.unit - centre;
      for (int axis = 0; axis < 3; ++axis) {
        const double along = std::abs(axes.row(axis).dot(p));
        ASSERT_LE(along, static_cast<double>(node.half_extent(axis, 0)));
      }
    }
    for (int axis = 0; axis < 3; ++axis) {  // Tight: both sides touch.
      const Vector3d n = axes.row(axis).transpose();
      const double width = core.support_bound(n) + core.support_bound(-n);
      ASSERT_LE(2.0 * static_cast<double>(node.half_extent(axis, 0)) * hierarchy.unit,
                width * 1.01 + 1e-12);
    }
  }
}

TEST(ConvexShape, KnowsItsSetUntilItIsTakenAway) {
  EXPECT_EQ(make_sphere(1.0).convex_set()->core().kind, ConvexKind::point);
  EXPECT_FALSE(make_sphere(1.0).is_curved()) << "its simplices are exact";
  EXPECT_EQ(make_capsule(1.0, 2.0).convex_set()->rounding(), 1.0);
  EXPECT_EQ(make_box({1.0, 1.0, 1.0}).convex_set()->core().kind, ConvexKind::box);
  EXPECT_EQ(make_convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).convex_set()->core().points.size(),
            3u);
  const Shape cylinder = make_cylinder(0.5, 1.0);
  const Shape prism = cylinder.as_triangles();
  EXPECT_EQ(prism.convex_set(), nullptr);
  EXPECT_FALSE(prism.is_curved());
  EXPECT_EQ(prism.enclosure_error(), cylinder.enclosure_error());
  EXPECT_EQ(&prism.mesh() == &cylinder.mesh(), false);
  EXPECT_EQ(prism.mesh().triangles.size(), cylinder.mesh().triangles.size());
  EXPECT_NE(prism.compare(cylinder), 0);
  EXPECT_EQ(prism.compare(prism.as_triangles()), 0);
  EXPECT_EQ(Shape(prism.mesh(), 0.0, Filling::solid).convex_set(), nullptr);
}

}  // namespace
}  // namespace firstcontact
