// Prisms that stand for cylinders: found by closed forms, and as round as these.

#include <array>
#include <cstdint>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/simulation_model/detail/round_side.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

TEST(RoundSides, AreThoseOfCylinders) {
  const Shape cylinder = make_cylinder(0.1, 0.2);
  const std::optional<RoundSide> side = find_round_side(cylinder, 2e-5);
  ASSERT_TRUE(side);
  EXPECT_EQ(side->axis_B, Vector3d::UnitZ());
  EXPECT_GE(side->radius, 0.1);
  EXPECT_LE(side->radius, 0.1 + cylinder.enclosure_error());
  EXPECT_FALSE(find_round_side(cylinder, 1e-6));  // Its facets are 1e-5 m inside of the circle.
  EXPECT_FALSE(find_round_side(make_box({0.1, 0.1, 0.1}), 1e-3));
  EXPECT_FALSE(find_round_side(make_cone(0.1, 0.2), 1e-3));
  EXPECT_FALSE(find_round_side(make_capsule(0.1, 0.2), 1e-3));
}

// A corner, wherever near the lowest line, becomes that line; the gap is that of the cylinder.
TEST(RoundSides, TouchAPlaneInTheirLowestLine) {
  const Shape cylinder = make_cylinder(0.1, 0.2);
  const Shape floor = make_box({1.0, 1.0, 1.0});
  const RoundSide side = find_round_side(cylinder, 2e-5).value();
  for (const double turned : {0.0, 0.01, 0.4, 2.0}) {
    const Pose lying{{0.3, 0.0, side.radius + 1e-3},
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
    const std::array<bool, 2> rolls = make_round(
        {PlacedRoundSide{&cylinder, &side, lying},
         PlacedRoundSide{&floor, nullptr, {{0.0, 0.0, -0.5}, Eigen::Quaterniond::Identity()}}},
        contact);
    EXPECT_EQ(rolls, (std::array{true, false}));
    EXPECT_NEAR(contact.p_WA.x(), 0.3, 1e-12) << turned;
    EXPECT_NEAR(contact.p_WB.x(), 0.3, 1e-12) << turned;
    EXPECT_NEAR(contact.distance, 1e-3, 1e-12) << turned;
  }
}

}  // namespace
}  // namespace firstcontact::detail
