#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/robot/robot_motion.h>
#include <firstcontact/scene/body_motion.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/separation/detail/triangles_meet.h>
#include <firstcontact/verification/detail/coordinate_course.h>
#include <firstcontact/verification/detail/rigid_motion.h>
#include <firstcontact/verification/detail/robot_course.h>

#include "scene/crane.h"
#include "support/random.h"

namespace firstcontact {
namespace {

using detail::BodyInstant;
using detail::CoveredMotion;
using Eigen::Vector3d;

/// Where a point at `y` from the pivot is.
Vector3d place(const BodyInstant& now, const Vector3d& y) { return now.pivot + now.R * y; }

Pose random_pose(test::Random& random) {
  const Vector3d position = random.vector(0.0, 3.0);
  return {position, random.rotation()};
}

std::vector<BodyMotion> random_motions(test::Random& random) {
  const Pose from = random_pose(random);
  const Pose to = random_pose(random);
  const Vector3d way = random.vector(0.0, 2.0);
  const Vector3d turn = random.vector(0.0, 9.0);
  std::vector<BodyMotion> motions{FixedMotion{from}, ConstantVelocityMotion{from, way, turn},
                                  ScrewMotion{from, way, turn, 4.0, 0.5},
                                  ScrewMotion{from, way, turn, -7.0, 0.3}};
  for (const Between between : {Between::constant_velocity, Between::screw}) {
    motions.emplace_back(TwoPoseMotion{from, to, between});
    // Poses that are nearly the same: the axis of an arc is far away.
    Pose near = from;
    near.position += way;
    near.rotation = from.rotation * Eigen::Quaterniond(Eigen::AngleAxisd(1e-7, way.normalized()));
    motions.emplace_back(TwoPoseMotion{from, near, between});
    motions.emplace_back(WaypointMotion{{0.5, 1.0, 2.5}, {from, to, random_pose(random)}, between});
  }
  return motions;
}

// The library's own poses, by arithmetic of its own, lie within the enclosures.
TEST(RigidMotion, IsTheMotionOfTheScene) {
  test::Random random(1);
  constexpr double kDuration = 3.0;
  for (int round = 0; round < 50; ++round) {
    const Vector3d p_BP = random.vector(0.0, 1.0);
    for (const BodyMotion& motion : random_motions(random)) {
      const Motion expected = normalised_motion(motion, kDuration);
      for (const detail::RigidMotion& piece : detail::rigid_motions(motion, kDuration, p_BP)) {
        for (const double part : {0.0, 0.3, 1.0}) {
          const double t = piece.from() + part * (piece.to() - piece.from());
          const BodyInstant now = piece.around(t, 0.0, Vector3d::Zero());
          const Pose pose = expected.pose(t);
          EXPECT_LT((pose.position + pose.rotation * p_BP - now.pivot).norm(),
                    1e-13 + now.pivot_error)
              << motion.index();
          EXPECT_LT((pose.rotation.toRotationMatrix() - now.R).norm(), 1e-13 + now.turn_error);
          EXPECT_LT(now.pivot_error + now.turn_error, 1e-12) << motion.index();
        }
      }
    }
  }
}

/// No point leaves its line of the first order by more than the bound of the second.
void expect_bounded(const CoveredMotion& motion, test::Random& random) {
  const double middle = 0.5 * (motion.from() + motion.to());
  const double half = random.uniform(0.05, 1.0) * 0.5 * (motion.to() - motion.from());
  const BodyInstant now = motion.around(middle, half, Vector3d::Zero());
  for (int k = 0; k < 20; ++k) {
    const Vector3d y = random.vector(0.0, 1.0);
    const Vector3d n = random.direction();
    const double bend = now.constant_rates
                            ? now.spin.norm() * now.spin.cross(n).norm() * (y.norm() + now.lever)
                            : now.acceleration + now.turn_acceleration * y.norm();
    const Vector3d velocity = now.velocity + now.spin.cross(now.R * y);
    const double h = random.uniform(-1.0, 1.0) * half;
    const Vector3d there = place(motion.around(middle + h, 0.0, Vector3d::Zero()), y);
    const double off = n.dot(there - place(now, y) - h * velocity);
    EXPECT_LE(std::abs(off), 0.5 * h * h * bend * (1.0 + 1e-9) + 1e-12);
  }
}

TEST(RigidMotion, BoundsItsAcceleration) {
  test::Random random(2);
  for (int round = 0; round < 30; ++round) {
    const Vector3d p_BP = random.vector(0.0, 1.0);
    for (const BodyMotion& motion : random_motions(random)) {
      for (const detail::RigidMotion& piece : detail::rigid_motions(motion, 3.0, p_BP)) {
        expect_bounded(piece, random);
      }
    }
  }
}

/// The crane on a base that turns, along a random trajectory.
SceneRobot moving_crane(test::Random& random, int derivatives, Turning turning) {
  SceneRobot robot{.name = "crane", .file = {}, .model = test::crane()};
  robot.base =
      ConstantVelocityMotion{random_pose(random), random.vector(0.0, 1.0), random.vector(0.0, 3.0)};
  robot.trajectory.joint_names = {"lift", "turn", "rail/x", "rail/y", "rail/theta"};
  robot.trajectory.turning = turning;
  for (const double time : {0.25, 1.0, 1.5, 3.0}) {
    TrajectoryPoint point{.time = time};
    for (int k = 0; k < 5; ++k) {
      point.positions.push_back(random.uniform(-4.0, 4.0));
      if (derivatives >= 1) {
        point.velocities.push_back(random.uniform(-2.0, 2.0));
      }
      if (derivatives >= 2) {
        point.accelerations.push_back(random.uniform(-2.0, 2.0));
      }
    }
    robot.trajectory.points.push_back(point);
  }
  return robot;
}

/// An arm of two hinges with a body that floats between them, on a base that turns.
SceneRobot floating_arm(test::Random& random) {
  RobotDescription arm{
      .name = "arm",
      .links = {{"ground", {}, {}}, {"post", {}, {}}, {"boat", {}, {}}, {"mast", {}, {}}},
      .joints = {}};
  const Eigen::Vector3d p = random.vector(0.0, 1.0);
  arm.joints.push_back({.name = "swing",
                        .type = JointType::continuous,
                        .parent = "ground",
                        .child = "post",
                        .X_PJ = {p, random.rotation()}});
  arm.joints.push_back({.name = "float",
                        .type = JointType::floating,
                        .parent = "post",
                        .child = "boat",
                        .X_PJ = {p, random.rotation()}});
  arm.joints.push_back({.name = "turn",
                        .type = JointType::continuous,
                        .parent = "boat",
                        .child = "mast",
                        .X_PJ = {p, random.rotation()}});
  SceneRobot robot{.name = "arm", .file = {}, .model = RobotModel(arm)};
  robot.base =
      ConstantVelocityMotion{random_pose(random), random.vector(0.0, 1.0), random.vector(0.0, 3.0)};
  robot.trajectory.joint_names = {"swing", "turn"};
  for (std::size_t k = 0; k < 7; ++k) {
    robot.trajectory.joint_names.push_back(coordinate_name(robot.model, {1, k}));
  }
  for (const double time : {0.25, 1.0, 1.5, 3.0}) {
    TrajectoryPoint point{.time = time};
    point.positions = {random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0)};
    for (const double number : positions_of_pose(random_pose(random))) {
      point.positions.push_back(number);
    }
    robot.trajectory.points.push_back(point);
  }
  return robot;
}

/// The library's own poses, by arithmetic of its own, are those of the course.
void expect_motion_of(const SceneRobot& robot, double duration, test::Random& random) {
  const RobotMotion expected(
      robot.model, joint_motions(robot.model, robot.trajectory, robot.state, duration).joints,
      normalised_motion(robot.base, duration));
  const detail::RobotCourse course(robot, duration);
  EXPECT_EQ(course.breaks(),
            std::vector<double>(expected.breaks().begin(), expected.breaks().end()));
  for (std::size_t link = 0; link < robot.model.links().size(); ++link) {
    const Vector3d p = random.vector(0.0, 1.0);
    const IntervalTransform X_LP = detail::exact_transform({p, {1, 0, 0, 0}});
    for (const auto& motion : course.motions(std::nullopt, link, X_LP, 0.0, 1.0)) {
      for (const double part : {0.0, 0.4, 1.0}) {
        const double t = motion->from() + part * (motion->to() - motion->from());
        const double inside = 0.5 * (motion->from() + motion->to());
        const LinkPose pose =
            expected.path(link, inside).pose(t, DoubleDoubleVector3(0.0, 0.0, 0.0));
        const BodyInstant now = motion->around(t, 0.0, Vector3d::Zero());
        EXPECT_LT((pose.p_OL + pose.R_FL * p - now.pivot).norm(), 1e-12);
        EXPECT_LT((pose.R_FL - now.R).norm(), 1e-12);
        EXPECT_LT(now.pivot_error + now.turn_error, 1e-11);
      }
    }
  }
}

TEST(RobotCourse, IsTheMotionOfAFloatingJoint) {
  test::Random random(6);
  for (int round = 0; round < 24; ++round) {
    SceneRobot robot = floating_arm(random);
    expect_motion_of(robot, 3.0, random);
    // At rest where its state has it.
    const Pose held = random_pose(random);
    for (std::size_t k = 0; k < 7; ++k) {
      robot.state[coordinate_name(robot.model, {1, k})] = positions_of_pose(held).at(k);
    }
    robot.trajectory = {
        .joint_names = {"swing"},
        .points = {{.time = 0.5, .positions = {1.0}}, {.time = 2.0, .positions = {-1.0}}}};
    expect_motion_of(robot, 3.0, random);
  }
}

TEST(RobotCourse, BoundsTheAccelerationOfAFloatingJoint) {
  test::Random random(7);
  for (int round = 0; round < 24; ++round) {
    const SceneRobot robot = floating_arm(random);
    const detail::RobotCourse course(robot, 3.0);
    const IntervalTransform X_LP = detail::exact_transform({random.vector(0.0, 1.0), {1, 0, 0, 0}});
    for (std::size_t link = 0; link < robot.model.links().size(); ++link) {
      for (const auto& motion : course.motions(std::nullopt, link, X_LP, 0.0, 1.0)) {
        expect_bounded(*motion, random);
      }
    }
  }
}

// A bound of infinity would hold, too: a boat that drives at 3 m/s on a disc that turns at 2 rad/s,
// one metre off its middle, has Coriolis' 12 m/s^2 and the disc's 4 m/s^2 per metre.
TEST(RobotCourse, BoundsAFloatingJointTightly) {
  SceneRobot robot{
      .name = "disc",
      .file = {},
      .model = RobotModel({.name = "disc",
                           .links = {{"base", {}, {}}, {"disc", {}, {}}, {"boat", {}, {}}},
                           .joints = {{.name = "turn",
                                       .type = JointType::revolute,
                                       .parent = "base",
                                       .child = "disc",
                                       .axis = Vector3d::UnitZ()},
                                      {.name = "drive",
                                       .type = JointType::floating,
                                       .parent = "disc",
                                       .child = "boat"}}})};
  robot.trajectory.joint_names = {"turn", "drive/trans_x"};
  robot.trajectory.points = {{.time = 0.0, .positions = {0.0, -0.5}},
                             {.time = 1.0, .positions = {2.0, 2.5}}};
  const detail::RobotCourse course(robot, 1.0);
  const IntervalTransform X_LP = detail::exact_transform({{0.0, 0.0, 0.0}, {1, 0, 0, 0}});
  const auto motions = course.motions(std::nullopt, 2, X_LP, 0.0, 1.0);
  ASSERT_EQ(motions.size(), 1u);
  const BodyInstant now = motions[0]->around(0.5, 0.0, Vector3d::Zero());
  EXPECT_NEAR(now.acceleration, 12.0 + 4.0, 1e-9);
  EXPECT_NEAR(now.velocity.norm(), std::hypot(3.0, 2.0), 1e-12);
}

TEST(RobotCourse, IsTheMotionOfTheRobot) {
  test::Random random(3);
  constexpr double kDuration = 3.0;
  for (int round = 0; round < 24; ++round) {
    const SceneRobot robot =
        moving_crane(random, round % 3, round % 2 == 0 ? Turning::as_given : Turning::shortest);
    expect_motion_of(robot, kDuration, random);
  }
}

TEST(RobotCourse, BoundsItsAcceleration) {
  test::Random random(4);
  for (int round = 0; round < 24; ++round) {
    const SceneRobot robot = moving_crane(random, round % 3, Turning::as_given);
    const detail::RobotCourse course(robot, 3.0);
    const IntervalTransform X_LP = detail::exact_transform({random.vector(0.0, 1.0), {1, 0, 0, 0}});
    for (std::size_t link = 0; link < robot.model.links().size(); ++link) {
      for (const auto& motion : course.motions(std::nullopt, link, X_LP, 0.0, 1.0)) {
        expect_bounded(*motion, random);
      }
    }
  }
}

// A bound of infinity would hold, too: one joint alone is bounded by what it does.
TEST(RobotCourse, BoundsOneTurnTightly) {
  SceneRobot robot{.name = "arm",
                   .file = {},
                   .model = RobotModel({.name = "arm",
                                        .links = {{"base", {}, {}}, {"bar", {}, {}}},
                                        .joints = {{.name = "turn",
                                                    .type = JointType::revolute,
                                                    .parent = "base",
                                                    .child = "bar",
                                                    .axis = Vector3d::UnitZ()}}})};
  robot.trajectory.joint_names = {"turn"};
  robot.trajectory.points = {{.time = 0.0, .positions = {0.0}}, {.time = 1.0, .positions = {2.0}}};
  const detail::RobotCourse course(robot, 1.0);
  const IntervalTransform X_LP = detail::exact_transform({{1.0, 0.0, 0.0}, {1, 0, 0, 0}});
  const auto motions = course.motions(std::nullopt, 1, X_LP, 0.0, 1.0);
  ASSERT_EQ(motions.size(), 1u);
  const BodyInstant now = motions[0]->around(0.5, 0.25, Vector3d::Zero());
  EXPECT_NEAR(now.acceleration, 4.0, 1e-9);
  EXPECT_NEAR(now.turn_acceleration, 4.0, 1e-9);
  EXPECT_NEAR(now.velocity.norm(), 2.0, 1e-12);
}

// An error of 1 mrad of a joint moves a point at 2 m by 2 mm.
TEST(RobotCourse, BoundsTrackingErrors) {
  test::Random random(5);
  SceneRobot robot = moving_crane(random, 0, Turning::as_given);
  const std::size_t turn = robot.model.find_joint("turn").value();
  robot.tracking_error[turn] = {.angle = 1e-3};
  const detail::RobotCourse course(robot, 3.0);
  ASSERT_TRUE(course.has_tracking_errors());
  const std::size_t mast = robot.model.find_link("mast").value();
  const IntervalTransform X_LP = detail::exact_transform({{0.0, 2.0, 0.0}, {1, 0, 0, 0}});
  for (const auto& motion : course.motions(std::nullopt, mast, X_LP, 0.0, 1.0)) {
    const BodyInstant now = motion->around(motion->from(), 0.0, Vector3d::Zero());
    EXPECT_NEAR(now.tracking, 2e-3, 1e-9);
    EXPECT_NEAR(now.turn_tracking, 1e-3, 1e-9);
  }
}

detail::IntervalTriangle triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return {enclose(a), enclose(b), enclose(c)};
}

TEST(TrianglesMeet, ProvesWhatPassesThrough) {
  const auto floor = triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  EXPECT_TRUE(detail::triangles_meet(triangle({0, 0, 1}, {0, 0, -1}, {5, 5, 5}), floor));
  EXPECT_TRUE(detail::triangles_meet(floor, triangle({0, 0, 1}, {0, 0, -1}, {5, 5, 5})));
  EXPECT_TRUE(detail::triangles_meet(triangle({0, 0, -1}, {0, 0, 1}, {5, 5, 5}), floor));
  EXPECT_FALSE(detail::triangles_meet(triangle({0, 0, 1}, {0, 0, 1e-9}, {5, 5, 5}), floor));
  EXPECT_FALSE(detail::triangles_meet(triangle({3, 0, 1}, {3, 0, -1}, {5, 5, 5}), floor));
  // Touching is not proven.
  EXPECT_FALSE(detail::triangles_meet(triangle({0, 0, 0}, {0, 0, 1}, {5, 5, 5}), floor));
}

}  // namespace
}  // namespace firstcontact
