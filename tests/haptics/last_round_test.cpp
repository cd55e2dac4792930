// What a round leaves to one that turns back.

#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/haptics/detail/last_round.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

Pose at(const Vector3d& position) { return {position, Eigen::Quaterniond::Identity()}; }

/// A touch of a tool with a body below it.
HapticTouch touch_below(double gap, std::uint32_t vertex) {
  HapticTouch touch;
  touch.contact.point = {0.1, 0.0, 0.5 * gap};
  touch.contact.normal = Vector3d::UnitZ();
  touch.contact.gap = gap;
  touch.contact.tool = 0;
  touch.contact.other = -1;
  touch.contact.body = 0;
  touch.members = {1, 0};
  touch.feature_of_other = {FeatureType::face, 7, 7};
  touch.feature_of_tool = {FeatureType::vertex, vertex, 3};
  return touch;
}

ToolDisplacements along(const Vector3d& translation, const Vector3d& rotation_vector) {
  ToolDisplacements ways;
  ways[0] = {translation, rotation_vector};
  return ways;
}

TEST(LastRound, IsNotLeftWhileNothingIsRemembered) {
  LastRound last;
  EXPECT_FALSE(last.is_left_by(along(-Vector3d::UnitX(), Vector3d::Zero()), {}, 1));
  last.keep({at(Vector3d::Zero())}, {}, along(Vector3d::UnitX(), Vector3d::Zero()));
  EXPECT_TRUE(last.is_left_by(along(-Vector3d::UnitX(), Vector3d::Zero()), {}, 1));
  last.forget();
  EXPECT_FALSE(last.is_left_by(along(-Vector3d::UnitX(), Vector3d::Zero()), {}, 1));
}

TEST(LastRound, WeighsTurnsAsTheSpringsDo) {
  LastRound last;
  last.keep({at(Vector3d::Zero())}, {}, along({1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}));
  const ToolDisplacements back = along({0.5, 0.0, 0.0}, {0.0, -1.0, 0.0});
  ToolFrames frames;
  frames.lengths[0] = 0.1;
  EXPECT_FALSE(last.is_left_by(back, frames, 1));
  frames.lengths[0] = 1.0;
  EXPECT_TRUE(last.is_left_by(back, frames, 1));
}

TEST(LastRound, LeavesWhatTouchesNoMoreWhereTheToolCarriedIt) {
  LastRound last;
  const HapticTouch kept = touch_below(1e-3, 1);
  const HapticTouch lost = touch_below(1e-3, 2);
  last.keep({at({0.0, 0.0, 0.0}), at({0.0, 0.0, -1.0})}, {kept, lost}, {});
  const std::vector<Pose> now{at({0.02, 0.0, 3e-3}), at({0.0, 0.0, -1.0})};
  const std::vector<HapticTouch> left = last.touches_left(now, {kept});
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].feature_of_tool.index, 2U);
  EXPECT_NEAR(left[0].contact.gap, 4e-3, 1e-15);
  EXPECT_LT((left[0].contact.point - Vector3d(0.12, 0.0, 2e-3)).norm(), 1e-15);
}

TEST(LastRound, DropsPlanesThatTheToolHasPassed) {
  LastRound last;
  last.keep({at({0.0, 0.0, 0.0}), at(Vector3d::Zero())}, {touch_below(1e-3, 1)}, {});
  EXPECT_TRUE(last.touches_left({at({0.0, 0.0, -2e-3}), at(Vector3d::Zero())}, {}).empty());
}

TEST(LastRound, CarriesBothPointsWhereToolsTouchEachOther) {
  LastRound last;
  HapticTouch touch = touch_below(1e-3, 1);
  touch.contact.other = 1;
  touch.contact.body = -1;
  last.keep({at({0.0, 0.0, 0.0}), at({0.0, 0.0, -1.0})}, {touch}, {});
  const std::vector<Pose> now{at({0.0, 0.0, 1e-3}), at({0.0, 0.0, -1.002})};
  const std::vector<HapticTouch> left = last.touches_left(now, {});
  ASSERT_EQ(left.size(), 1U);
  EXPECT_NEAR(left[0].contact.gap, 4e-3, 1e-15);
}

}  // namespace
}  // namespace firstcontact::detail
