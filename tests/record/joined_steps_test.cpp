// Two parts of a step as one.

#include <cstdint>

#include <gtest/gtest.h>

#include <firstcontact/record/detail/joined_steps.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

RunContact contact(std::uint32_t vertex, double impulse) {
  RunContact made;
  made.bodies = {0, 1};
  made.feature_A.index = vertex;
  made.impulse = {0.0, 0.0, impulse};
  return made;
}

/// A part with one of everything that is summed or averaged.
RunStep part(std::uint32_t index, double lasted, double size) {
  return {.index = index,
          .time = lasted,
          .lasted = lasted,
          .clearance = 1.0 / size,
          .residual = size,
          .events = index,
          .bodies = {{.body = 1, .pieces = {{.to = lasted, .X_WB = {}}}}},
          .robots = {{.robot = 0, .efforts = {size}}},
          .contacts = {contact(3, size), contact(4 + index, size)},
          .impacts = {{.at = 0.5 * lasted}},
          .ties = {{.force = Vector3d(size, 0.0, 0.0), .torque = Vector3d(0.0, size, 0.0)}}};
}

TEST(JoinedSteps, SumAndAverageBothParts) {
  const RunStep whole = detail::joined(part(7, 0.25, 2.0), part(8, 0.75, 6.0));
  EXPECT_EQ(whole.index, 7);
  EXPECT_EQ(whole.lasted, 1.0);
  EXPECT_EQ(whole.clearance, 1.0 / 6.0);
  EXPECT_EQ(whole.residual, 6.0);
  EXPECT_EQ(whole.events, 15);
  ASSERT_EQ(whole.bodies[0].pieces.size(), 2);
  EXPECT_EQ(whole.bodies[0].pieces[0].to, 0.25);
  EXPECT_EQ(whole.bodies[0].pieces[1].to, whole.lasted);
  ASSERT_EQ(whole.impacts.size(), 2);
  EXPECT_EQ(whole.impacts[0].at, 0.125);
  EXPECT_EQ(whole.impacts[1].at, 0.625);
  // Means over time: 2 for a quarter, 6 for three quarters.
  EXPECT_EQ(whole.robots[0].efforts[0], 5.0);
  EXPECT_EQ(whole.ties[0].force.x(), 5.0);
  EXPECT_EQ(whole.ties[0].torque.y(), 5.0);
}

TEST(JoinedSteps, HaveTheImpulsesOfBothParts) {
  RunStep first = part(7, 0.25, 2.0);
  RunStep second = part(8, 0.75, 6.0);
  first.contacts = {contact(3, 2.0), contact(4, 1.0), contact(5, 0.5), contact(6, 0.0)};
  first.contacts[0].point.x() = 1.0;  // It moved on, but its features are the same.
  first.contacts[1].point.x() = 0.9;  // At other features: the nearest has its impulse.
  first.contacts[2].bodies = {0, 2};  // This pair parted,
  first.contacts[2].point.y() = 3.0;
  first.contacts[3].bodies = {0, 3};  // as this one, that did not press.
  second.contacts = {contact(7, 6.0), contact(3, 8.0)};
  second.contacts[0].point.x() = 1.0;
  const RunStep whole = detail::joined(first, second);
  ASSERT_EQ(whole.contacts.size(), 2);
  EXPECT_EQ(whole.contacts[0].impulse.z(), 6.0 + 1.0);
  EXPECT_EQ(whole.contacts[1].impulse.z(), 8.0 + 2.0);
  ASSERT_EQ(whole.impacts.size(), 3);
  EXPECT_EQ(whole.impacts[1].at, 0.25);
  EXPECT_EQ(whole.impacts[1].bodies, (BodyPair{0, 2}));
  EXPECT_EQ(whole.impacts[1].point.y(), 3.0);
  EXPECT_EQ(whole.impacts[1].impulse.z(), 0.5);
}

TEST(JoinedSteps, OfWhichTheSecondLastedNoTimeAreTheFirst) {
  const RunStep whole = detail::joined(part(7, 0.25, 2.0), part(8, 0.0, 6.0));
  EXPECT_EQ(whole.lasted, 0.25);
  EXPECT_EQ(whole.robots[0].efforts[0], 2.0);
  EXPECT_EQ(whole.ties[0].force.x(), 2.0);
}

}  // namespace
}  // namespace firstcontact
