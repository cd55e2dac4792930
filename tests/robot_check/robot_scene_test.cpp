// A scene of robots: what it tests, where its members are, and what it refuses.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot_check/robot_scene.h>

#include "robot/planar_arm.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

RobotMotion still_arm(std::size_t bars) {
  return planar_motion(std::vector<CoordinatePath>(bars, CoordinatePath::constant(0.0)));
}

template <class Use>
std::string error_of(const Use& use) {
  try {
    use();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(RobotScene, NumbersBodiesAndLinksInTheOrderOfAdding) {
  RobotScene scene;
  EXPECT_EQ(scene.add_body("table", make_box({1, 1, 1})), 0u);
  EXPECT_EQ(scene.add_robot("arm", still_arm(2)), 0u);
  EXPECT_EQ(scene.add_body("ball", make_sphere(0.1)), 4u);
  EXPECT_EQ(scene.add_robot("other", still_arm(1)), 1u);
  EXPECT_EQ(scene.size(), 7u);
  EXPECT_EQ(scene.first_member(0), 1u);
  EXPECT_EQ(scene.first_member(1), 5u);
  EXPECT_EQ(scene.name(3), "arm/l1");
  EXPECT_EQ(scene.find_member("other/l0"), 6u);
  EXPECT_EQ(scene.find_member("other"), std::nullopt);
  EXPECT_EQ(scene.robot_link(3), (RobotLink{0, 2}));
  EXPECT_EQ(scene.robot_link(4), std::nullopt);
  EXPECT_EQ(scene.geometries(1).size(), 0u);
}

TEST(RobotScene, WhatNeverMovesAgainstEachOtherIsNotTested) {
  RobotDescription hand{.name = "hand", .links = {}, .joints = {}};
  for (const char* name : {"palm", "flange", "camera", "thumb", "nail"}) {
    Link link{name, {}, {}};
    link.collision.push_back({.name = "", .X_LG = {}, .source = {}, .shape = make_sphere(0.1)});
    hand.links.push_back(link);
  }
  hand.joints = {{.name = "a", .type = JointType::fixed, .parent = "palm", .child = "flange"},
                 {.name = "b", .type = JointType::fixed, .parent = "flange", .child = "camera"},
                 {.name = "c", .type = JointType::continuous, .parent = "palm", .child = "thumb"},
                 {.name = "d", .type = JointType::continuous, .parent = "thumb", .child = "nail"}};
  RobotScene scene(PairRules(0.25));
  const std::vector<DisabledPair> disabled = {{2, 4, ""}};
  scene.add_robot("hand", {RobotModel(hand), {{"c", ramp(0, 1)}, {"d", ramp(0, 1)}}}, disabled);
  scene.add_body("floor", make_box({1, 1, 1}));
  scene.add_body("wall", make_box({1, 1, 1}));
  scene.add_body("ball", make_sphere(1.0), Motion::constant_velocity({}, Vector3d(1, 0, 0)));
  EXPECT_EQ(scene.margin({0, 2}), std::nullopt);  // Joined by fixed joints.
  EXPECT_EQ(scene.margin({0, 3}), std::nullopt);  // Adjacent.
  EXPECT_EQ(scene.margin({2, 4}), std::nullopt);  // Disabled.
  EXPECT_EQ(scene.margin({5, 6}), std::nullopt);  // Both at rest.
  EXPECT_EQ(scene.margin({0, 4}), 0.25);
  EXPECT_EQ(scene.margin({2, 3}), 0.25);
  EXPECT_EQ(scene.margin({0, 5}), 0.25);
  EXPECT_EQ(scene.margin({5, 7}), 0.25);
  scene.set_padding(0, 0.5);
  scene.set_padding(5, 1.0);
  EXPECT_EQ(scene.margin({0, 5}), 1.75);
  scene.rules().set_margin({0, 5}, 2.0);
  EXPECT_EQ(scene.margin({0, 5}), 3.5);
  // A body that is carried for a while does not rest.
  scene.attach({.body = 6, .link = 4, .t_from = 0.5});
  EXPECT_EQ(scene.margin({5, 6}), 1.25);
}

TEST(RobotScene, AnAttachedBodyFollowsItsLink) {
  RobotScene scene;
  const double turn = 0.5 * std::numbers::pi;
  scene.add_robot("arm", planar_motion({ramp(0.0, 2.0 * turn)}));
  const std::size_t ball = scene.add_body(
      "ball", make_sphere(0.1), Motion::constant_velocity({}, Vector3d(2, 0, 4), {0, 0, 1}));
  scene.attach({.body = ball, .link = 1, .t_from = 0.5, .t_to = 0.75});
  // Taken at (1, 0, 2) while the arm is at a right angle.
  EXPECT_LE((scene.pose(ball, 0.25).position - Vector3d(0.5, 0, 1)).norm(), 1e-15);
  EXPECT_LE((scene.pose(ball, 0.5).position - Vector3d(1, 0, 2)).norm(), 1e-15);
  const double more = 0.5 * turn;  // [rad]  That the arm turns while it holds the ball.
  const Vector3d put_down(std::cos(more), std::sin(more), 2.0);
  EXPECT_LE((scene.pose(ball, 0.75).position - put_down).norm(), 1e-15);
  EXPECT_LE((scene.pose(ball, 1.0).position - put_down).norm(), 1e-15);
  const Eigen::AngleAxisd turned(scene.pose(ball, 1.0).rotation);
  EXPECT_NEAR(turned.angle(), 0.5 + more, 1e-15);
  const auto stretches = scene.stretches(ball);
  ASSERT_EQ(stretches.size(), 3u);
  EXPECT_EQ(stretches[1].t_begin, 0.5);
  EXPECT_EQ(stretches[2].t_begin, 0.75);
}

TEST(RobotScene, ABodyIsHandedOver) {
  RobotScene scene;
  scene.add_robot("left", planar_motion({ramp(0.0, 1.0)}));
  scene.add_robot("right", planar_motion({ramp(0.0, -1.0)}));
  const std::size_t ball = scene.add_body("ball", make_sphere(0.1), Motion::fixed());
  // In the other order of time than it happens.
  scene.attach({.body = ball, .link = 3, .t_from = 0.5});
  scene.attach({.body = ball, .link = 1, .t_from = 0.0, .t_to = 0.5});
  EXPECT_EQ(scene.stretches(ball).size(), 2u);
  EXPECT_NEAR(Eigen::AngleAxisd(scene.pose(ball, 0.5).rotation).angle(), 0.5, 1e-15);
  EXPECT_NEAR(Eigen::AngleAxisd(scene.pose(ball, 1.0).rotation).angle(), 0.0, 1e-15);
}

TEST(RobotScene, MimicJointsFollowTheErrorOfTheirs) {
  Joint left{.name = "left", .type = JointType::prismatic, .parent = "palm", .child = "l"};
  Joint right{.name = "right", .type = JointType::continuous, .parent = "palm", .child = "r"};
  right.mimic = Mimic{.joint = "left", .multiplier = -3.0, .offset = 1.0};
  const RobotModel model({.name = "hand",
                          .links = {{"palm", {}, {}}, {"l", {}, {}}, {"r", {}, {}}},
                          .joints = {left, right}});
  RobotScene scene;
  scene.add_robot("hand", {model, {{"left", ramp(0.0, 0.1)}}});
  scene.set_tracking_error(0, "left", {.distance = 0.01});
  EXPECT_EQ(scene.tracking_errors(0)[0].distance, 0.01);
  EXPECT_NEAR(scene.tracking_errors(0)[1].angle, 0.03, 1e-15);
  EXPECT_NE(
      error_of([&] { scene.set_tracking_error(0, "right", {.angle = 0.1}); }).find("mimics 'left'"),
      std::string::npos);
}

TEST(RobotScene, NamesWhatIsWrong) {
  RobotScene scene;
  scene.add_robot("arm", still_arm(2));
  scene.add_body("ball", make_sphere(0.1));
  const auto is_named = [](const std::string& error, const std::string& what) {
    return error.find(what) != std::string::npos;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto add = [&](const char* name) {
    return error_of([&] { scene.add_body(name, make_sphere(0.1)); });
  };
  EXPECT_TRUE(is_named(add("ball"), "'ball' is there twice"));
  EXPECT_TRUE(is_named(add("arm"), "'arm' is there twice"));
  EXPECT_TRUE(is_named(add("arm/l0"), "'arm/l0' is there twice"));
  EXPECT_TRUE(is_named(add(""), "empty"));
  EXPECT_TRUE(is_named(error_of([&] { scene.add_robot("ball", still_arm(1)); }), "'ball'"));
  const std::vector<DisabledPair> beyond = {{0, 9, ""}};
  EXPECT_TRUE(is_named(error_of([&] { scene.add_robot("b", still_arm(1), beyond); }), "link 9"));
  EXPECT_EQ(scene.size(), 4u);  // The refused bodies left nothing.
  for (const double bad : {-1.0, nan, infinity}) {
    EXPECT_TRUE(is_named(error_of([&] { scene.set_padding(3, bad); }), "'ball'"));
    EXPECT_TRUE(
        is_named(error_of([&] { scene.set_tracking_error(0, "j0", {.angle = bad}); }), "'j0'"));
  }
  EXPECT_TRUE(is_named(error_of([&] { scene.set_padding(9, 0.1); }), "member 9"));
  EXPECT_TRUE(is_named(error_of([&] { scene.set_tracking_error(0, "x", {}); }), "'x'"));
  EXPECT_TRUE(is_named(error_of([&] { scene.set_tracking_error(7, "j0", {}); }), "robot 7"));
  EXPECT_TRUE(is_named(error_of([&] { scene.set_tracking_error(0, "j0", {.distance = 1.0}); }),
                       "does not slide"));
  const auto attach = [&](const Attachment& attachment) {
    return error_of([&] { scene.attach(attachment); });
  };
  EXPECT_TRUE(is_named(attach({.body = 9, .link = 1}), "member 9"));
  EXPECT_TRUE(is_named(attach({.body = 3, .link = 1, .touch_links = {8}}), "member 8"));
  EXPECT_TRUE(is_named(attach({.body = 1, .link = 2}), "only bodies"));
  EXPECT_TRUE(is_named(attach({.body = 3, .link = 3}), "is no link"));
  for (const auto& [from, to] : std::vector<std::array<double, 2>>{
           {0.5, 0.5}, {0.6, 0.5}, {-0.1, 0.5}, {0.5, 1.1}, {nan, 0.5}, {0.5, nan}}) {
    EXPECT_TRUE(is_named(attach({.body = 3, .link = 1, .t_from = from, .t_to = to}), "[0, 1]"));
  }
  EXPECT_TRUE(
      is_named(attach({.body = 3, .link = 1, .t_from = 0.2, .X_LB = Pose{}}), "t_from = 0"));
  EXPECT_EQ(attach({.body = 3, .link = 1, .t_from = 0.2, .t_to = 0.6}), "no error");
  EXPECT_TRUE(is_named(attach({.body = 3, .link = 1, .t_from = 0.5}), "twice at a time"));
  EXPECT_EQ(attach({.body = 3, .link = 1, .t_from = 0.6}), "no error");
}

TEST(RobotScene, RefusesLinksWithoutShapes) {
  RobotDescription bare{.name = "bare", .links = {{"a", {}, {}}}, .joints = {}};
  bare.links[0].collision.push_back({.name = "", .X_LG = {}, .source = {}, .shape = {}});
  RobotScene scene;
  const std::string error = error_of([&] { scene.add_robot("r", {RobotModel(bare), {}}); });
  EXPECT_NE(error.find("'r/a' has a collision geometry without its shape"), std::string::npos);
}

}  // namespace
}  // namespace firstcontact::test
