// Polygons that stand for circles: found by closed forms, and as round as these.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/simulation_model/detail/round_contact.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// A ring of rectangular section about z, with polygons of n sides, moved by an offset.
Shape make_ring(std::uint32_t n, double inner, double outer, double height,
                const Vector3d& offset = Vector3d::Zero()) {
  Mesh mesh;
  const std::array<std::array<double, 2>, 4> section{
      {{inner, 0.0}, {outer, 0.0}, {outer, height}, {inner, height}}};
  for (std::uint32_t k = 0; k < n; ++k) {
    const double angle = kTurn * k / n;
    for (const auto& [r, z] : section) {
      mesh.vertices.push_back(offset + Vector3d(r * std::cos(angle), r * std::sin(angle), z));
    }
    for (std::uint32_t s = 0; s < 4; ++s) {
      const std::uint32_t a = 4 * k + s;
      const std::uint32_t b = 4 * k + (s + 1) % 4;
      const std::uint32_t c = 4 * ((k + 1) % n) + (s + 1) % 4;
      const std::uint32_t d = 4 * ((k + 1) % n) + s;
      mesh.triangles.push_back({a, d, c});
      mesh.triangles.push_back({a, c, b});
    }
  }
  return Shape(std::move(mesh));
}

TEST(RoundCircles, AreTheRimsOfACylinder) {
  const Shape cylinder = make_cylinder(0.1, 0.2);
  const RoundCircles found(cylinder, 2e-5);
  ASSERT_EQ(found.circles().size(), 2u);
  for (const RoundCircle& circle : found.circles()) {
    EXPECT_NEAR(std::abs(circle.axis_B.z()), 1.0, 1e-12);
    EXPECT_NEAR(std::abs(circle.centre_B.z()), 0.1, 1e-12);
    EXPECT_LE(circle.inner, 0.1 + 1e-12);
    EXPECT_GE(circle.outer, 0.1);
    EXPECT_LE(circle.outer, 0.1 + cylinder.enclosure_error());
  }
}

TEST(RoundCircles, AreNotWhatHasCorners) {
  EXPECT_TRUE(RoundCircles(make_box({0.1, 0.1, 0.1}), 1e-5).circles().empty());
  EXPECT_TRUE(RoundCircles(make_capsule(0.1, 0.2), 1e-3).circles().empty());
  EXPECT_TRUE(RoundCircles(make_ring(6, 0.05, 0.1, 0.02), 1e-5).circles().empty());
  EXPECT_TRUE(RoundCircles(make_ring(63, 0.05, 0.1, 0.02), 1e-6).circles().empty());
}

// Files of few digits: each coordinate is off by half of the last one.
TEST(RoundCircles, AreFoundWhereFilesHaveSixDigits) {
  Mesh mesh = make_ring(64, 0.25, 0.3, 0.1, {0.0, 2.0, 0.0}).mesh();
  for (Vector3d& vertex : mesh.vertices) {
    vertex = (vertex * 1e6).array().round().matrix() / 1e6;
  }
  EXPECT_EQ(RoundCircles(Shape(std::move(mesh)), 1e-9).circles().size(), 4u);
}

/// A height map: smooth lines of edges of nearly one length, that never close.
Shape make_waves(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t k = 0; k <= n; ++k) {
      const double x = 6.0 * i / n;
      const double y = 6.0 * k / n;
      mesh.vertices.emplace_back(x, y, 0.3 * std::sin(x) + 0.3 * std::cos(0.8 * y));
      if (i < n && k < n) {
        const std::uint32_t v = (n + 1) * i + k;
        mesh.triangles.push_back({v, v + n + 1, v + n + 2});
        mesh.triangles.push_back({v, v + n + 2, v + 1});
      }
    }
  }
  return Shape(std::move(mesh));
}

TEST(RoundCircles, AreNotOnSmoothSurfaces) {
  EXPECT_TRUE(RoundCircles(make_waves(200), 1e-3).circles().empty());
}

TEST(RoundCircles, KnowOnWhichSideTheSurfaceIs) {
  const Shape ring = make_ring(90, 0.05, 0.1, 0.02);
  const RoundCircles found(ring, 1e-9);
  for (const RoundCircle& circle : found.circles()) {
    EXPECT_EQ(circle.is_hole, circle.outer < 0.06);
    EXPECT_EQ(circle.is_rim, circle.outer > 0.06);
  }
}

TEST(RoundCircles, AreThoseOfARingWhereverItIs) {
  const Vector3d offset(3.0, -2.0, 0.5);
  const Shape ring = make_ring(180, 0.05, 0.1, 0.02, offset);
  const RoundCircles found(ring, 1e-9);
  ASSERT_EQ(found.circles().size(), 4u);
  std::vector<double> radii;
  for (const RoundCircle& circle : found.circles()) {
    const Vector3d from = circle.centre_B - offset;
    EXPECT_NEAR(std::hypot(from.x(), from.y()), 0.0, 1e-12);
    EXPECT_NEAR(circle.inner, circle.outer * std::cos(kTurn / 360.0), 1e-12);
    radii.push_back(circle.outer);
  }
  std::ranges::sort(radii);
  EXPECT_NEAR(radii[1], 0.05, 1e-12);
  EXPECT_NEAR(radii[2], 0.1, 1e-12);
}

// The flat ends of a ring have edges from corner to corner, but only their rims are round.
TEST(RoundCircles, HaveTheSidesAndTheRimsOnly) {
  const Shape ring = make_ring(180, 0.05, 0.1, 0.02);
  const RoundCircles found(ring, 1e-9);
  for (std::uint32_t t = 0; t < ring.mesh().triangles.size(); ++t) {
    const auto& [a, b, c] = ring.mesh().triangles[t];
    const auto& v = ring.mesh().vertices;
    const Vector3d normal = (v[b] - v[a]).cross(v[c] - v[a]).normalized();
    const bool is_side = std::abs(normal.z()) < 0.5;
    const OnCircle on = found.at(ring, {FeatureType::face, t, t});
    EXPECT_EQ(on.circle != nullptr, is_side) << t;
    EXPECT_EQ(on.is_side, is_side) << t;
  }
}

// A corner, wherever near the lowest line, becomes that line; the gap is that of the cylinder.
TEST(RoundContacts, TouchAPlaneInTheirLowestLine) {
  const Shape cylinder = make_cylinder(0.1, 0.2);
  const Shape floor = make_box({1.0, 1.0, 1.0});
  const RoundCircles circles(cylinder, 2e-5);
  const double radius = circles.circles().at(0).outer;
  for (const double turned : {0.0, 0.01, 0.4, 2.0}) {
    const Pose lying{{0.3, 0.0, radius + 1e-3},
                     Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX()) *
                         Eigen::AngleAxisd(turned, Vector3d::UnitZ())};
    std::size_t lowest = 0;
    const auto place = [&](std::size_t v) -> Vector3d {
      return lying.position + lying.rotation * cylinder.mesh().vertices[v];
    };
    for (std::size_t v = 0; v < cylinder.mesh().vertices.size(); ++v) {
      lowest = place(v).z() < place(lowest).z() ? v : lowest;
    }
    Contact contact;
    contact.feature_A = {FeatureType::vertex, static_cast<std::uint32_t>(lowest), 0};
    contact.feature_B = {FeatureType::face, 10, 10};
    contact.p_WA = place(lowest);
    contact.p_WB = {contact.p_WA.x(), contact.p_WA.y(), 0.0};
    contact.n_AB_W = -Vector3d::UnitZ();
    contact.distance = contact.p_WA.z();
    const PlacedRound on_floor{.shape = &floor,
                               .pose = {{0.0, 0.0, -0.5}, Eigen::Quaterniond::Identity()}};
    const auto round =
        make_round({PlacedRound{.shape = &cylinder, .circles = &circles, .pose = lying}, on_floor},
                   1.0, contact);
    EXPECT_NE(round[0].circle, nullptr);
    EXPECT_FALSE(round[0].is_hole);
    EXPECT_EQ(round[1].circle, nullptr);
    EXPECT_NEAR(contact.p_WA.x(), 0.3, 1e-12) << turned;
    EXPECT_NEAR(contact.p_WB.x(), 0.3, 1e-12) << turned;
    EXPECT_NEAR(contact.distance, 1e-3, 1e-12) << turned;
  }
}

/// A ring that hangs on a round pin, turned about the axis of both, and its contact with a corner
/// near the highest point of its hole.
struct HangingRing {
  static constexpr double kPin = 0.01;  // [m]  Radius.
  static constexpr double kGap = 1e-3;  // [m]  From the pin to the circle that the sides touch.
  Shape ring = make_ring(180, 0.05, 0.1, 0.02, {0.0, 0.0, -0.01});
  Shape pin = make_capsule(kPin, 0.1);
  RoundCircles circles{ring, 1e-9};
  Contact contact;

  Pose pose(double direction, double turned) const {
    const double from_axis = 0.05 * std::cos(kTurn / 360.0) - kGap - kPin;
    return {from_axis * Vector3d(-std::cos(direction), -std::sin(direction), 0.0),
            Eigen::Quaterniond(Eigen::AngleAxisd(turned, Vector3d::UnitZ()))};
  }

  std::array<RoundFeature, 2> touch(double direction, double turned) {
    const Pose X = pose(direction, turned);
    double best = -1.0;
    for (std::uint32_t v = 0; v < ring.mesh().vertices.size(); v += 4) {
      const Vector3d at = X.position + X.rotation * ring.mesh().vertices[v];
      const Vector3d from_pin(at.x(), at.y(), 0.0);
      const double along =
          from_pin.normalized().dot(Vector3d(std::cos(direction), std::sin(direction), 0.0));
      if (along > best) {
        best = along;
        contact.feature_B = {FeatureType::vertex, v, 0};
        contact.p_WB = at;
        contact.n_AB_W = from_pin.normalized();
        contact.p_WA = kPin * *contact.n_AB_W + Vector3d(0.0, 0.0, at.z());
        contact.distance = from_pin.norm() - kPin;
      }
    }
    contact.feature_A = {FeatureType::edge, 0, 0};
    const Pose upright{Vector3d::Zero(), Eigen::Quaterniond::Identity()};
    return make_round({PlacedRound{.shape = &pin, .pose = upright},
                       PlacedRound{.shape = &ring, .circles = &circles, .pose = X}},
                      1.0, contact);
  }
};

TEST(RoundContacts, OfAHoleAreInTheLineOfTheAxes) {
  for (const double direction : {0.3, 1.7, 4.0}) {
    for (const double turned : {0.0, 0.01, 0.02, 3.0}) {
      HangingRing hanging;
      const auto round = hanging.touch(direction, turned);
      ASSERT_NE(round[1].circle, nullptr) << direction << " " << turned;
      EXPECT_TRUE(round[1].is_hole);
      EXPECT_LT(round[1].radius(), 0.0);
      const Vector3d n(std::cos(direction), std::sin(direction), 0.0);
      EXPECT_NEAR((*hanging.contact.n_AB_W - n).norm(), 0.0, 1e-9) << direction << " " << turned;
      EXPECT_NEAR(hanging.contact.distance, HangingRing::kGap, 1e-9) << direction << " " << turned;
    }
  }
}

}  // namespace
}  // namespace firstcontact::detail
