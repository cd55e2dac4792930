#include <firstcontact/haptic_devices/operator_path.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace firstcontact {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

ViaPoint via(double time, const Vector3d& position, double angle = 0.0) {
  return {time, {position, Quaterniond(AngleAxisd(angle, Vector3d::UnitZ()))}};
}

double angle_between(const Quaterniond& a, const Quaterniond& b) { return a.angularDistance(b); }

TEST(OperatorPath, GoesThroughItsPointsAndStopsThere) {
  const std::vector<ViaPoint> points{via(1.0, {0.0, 0.0, 0.0}), via(3.0, {0.2, 0.0, 0.0}, 1.0),
                                     via(4.0, {0.2, 0.1, 0.0}, -0.5)};
  const OperatorPath path(points);
  EXPECT_EQ(path.end_time(), 4.0);
  std::size_t hint = 0;
  for (const ViaPoint& point : points) {
    const HandTarget target = path.at(point.time, hint);
    EXPECT_TRUE(target.X_DH.position.isApprox(point.X_DH.position, 1e-15) ||
                (target.X_DH.position - point.X_DH.position).norm() < 1e-15);
    EXPECT_LT(angle_between(target.X_DH.rotation, point.X_DH.rotation), 1e-7);
    EXPECT_EQ(target.velocity.norm(), 0.0);
    EXPECT_EQ(target.angular_velocity.norm(), 0.0);
  }
  EXPECT_EQ(path.at(-7.0, hint).X_DH.position, points.front().X_DH.position);
  EXPECT_EQ(path.at(99.0, hint).X_DH.position, points.back().X_DH.position);
}

// The closed form of least jerk: half of the way at half of the time, at 15/8 of the mean speed.
TEST(OperatorPath, HasTheLeastJerk) {
  const OperatorPath path({via(0.0, {0.0, 0.0, 0.0}), via(2.0, {0.0, 0.4, 0.0}, 0.8)});
  std::size_t hint = 0;
  const HandTarget middle = path.at(1.0, hint);
  EXPECT_NEAR(middle.X_DH.position.y(), 0.2, 1e-15);
  EXPECT_NEAR(middle.velocity.y(), 1.875 * 0.2, 1e-15);
  EXPECT_NEAR(middle.angular_velocity.z(), 1.875 * 0.4, 1e-14);
  EXPECT_NEAR(angle_between(middle.X_DH.rotation, Quaterniond::Identity()), 0.4, 1e-14);
}

TEST(OperatorPath, HasRatesThatAreItsDerivatives) {
  const OperatorPath path(random_via_points({.seed = 4, .count = 12, .max_angle = 2.0}));
  std::size_t hint = 0;
  const double h = 1e-6;
  for (double time = 0.01; time < path.end_time(); time += 0.0371) {
    const HandTarget before = path.at(time - h, hint);
    const HandTarget after = path.at(time + h, hint);
    const HandTarget here = path.at(time, hint);
    const Vector3d velocity = (after.X_DH.position - before.X_DH.position) / (2.0 * h);
    const AngleAxisd turn(after.X_DH.rotation * before.X_DH.rotation.conjugate());
    EXPECT_LT((velocity - here.velocity).norm(), 1e-6) << time;
    EXPECT_LT((turn.angle() * turn.axis() / (2.0 * h) - here.angular_velocity).norm(), 1e-5)
        << time;
  }
}

TEST(OperatorPath, DoesNotDependOnTheHint) {
  const OperatorPath path(random_via_points({.seed = 5, .count = 30}));
  std::size_t forward = 0;
  for (double time = 0.0; time < path.end_time(); time += 0.05) {
    std::size_t far = 1000;
    EXPECT_EQ(path.at(time, forward).X_DH.position, path.at(time, far).X_DH.position);
  }
}

TEST(OperatorPath, RefusesPointsOutOfOrder) {
  EXPECT_THROW(OperatorPath({}), std::invalid_argument);
  EXPECT_THROW(OperatorPath({via(0.0, Vector3d::Zero()), via(0.0, Vector3d::Ones())}),
               std::invalid_argument);
  EXPECT_THROW(OperatorPath({via(std::numeric_limits<double>::quiet_NaN(), Vector3d::Zero())}),
               std::invalid_argument);
  ViaPoint zero = via(0.0, Vector3d::Zero());
  zero.X_DH.rotation.coeffs().setZero();
  EXPECT_THROW(OperatorPath({zero}), std::invalid_argument);
}

TEST(RandomViaPoints, StayWithinTheirLimits) {
  RandomPathOptions options;
  options.seed = 9;
  options.count = 500;
  options.radius = 0.2;
  options.max_angle = 0.7;
  options.centre.position = {1.0, 2.0, 3.0};
  const std::vector<ViaPoint> points = random_via_points(options);
  double farthest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = (points[i].X_DH.position - options.centre.position).norm();
    EXPECT_LE(distance, options.radius);
    farthest = std::max(farthest, distance);
    EXPECT_LE(angle_between(points[i].X_DH.rotation, Quaterniond::Identity()), 0.7 + 1e-7);
    if (i > 0) {
      const double way = (points[i].X_DH.position - points[i - 1].X_DH.position).norm();
      EXPECT_LE(way, options.fastest * (points[i].time - points[i - 1].time) + 1e-12);
    }
  }
  EXPECT_GT(farthest, 0.9 * options.radius);  // They fill the ball.
}

TEST(RandomViaPoints, AreTheSameForOneSeed) {
  const auto a = random_via_points({.seed = 1, .count = 5});
  const auto b = random_via_points({.seed = 1, .count = 5});
  const auto c = random_via_points({.seed = 2, .count = 5});
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.back().X_DH.position, b.back().X_DH.position);
  EXPECT_NE(a.back().X_DH.position, c.back().X_DH.position);
}

TEST(RandomViaPoints, RefuseOptionsOutsideTheirRange) {
  EXPECT_THROW((void)random_via_points({.count = 0}), std::invalid_argument);
  EXPECT_THROW((void)random_via_points({.radius = -1.0}), std::invalid_argument);
  EXPECT_THROW((void)random_via_points({.max_angle = 4.0}), std::invalid_argument);
  EXPECT_THROW((void)random_via_points({.slowest = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)random_via_points({.slowest = 2.0, .fastest = 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
