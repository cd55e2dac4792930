// The laws of the motion contract, on every kind of motion, against the exact motion in 256 bits.
// That a path stays within its stated errors: path_against_exact_motion_test.

#include <firstcontact/motion/motion_contract.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "motion/motion_cases.h"
#include "support/exact_state.h"
#include "support/library_case.h"

namespace firstcontact::oracle {
namespace {

using Eigen::Vector3d;

const Vector3<double> kPoint{0.3, -0.2, 0.5};

Vector3d to_eigen(const Vector3<double>& v) { return {v.x, v.y, v.z}; }

double distance(const Vector3d& p, const Vector3<Wide>& exact_point) {
  return norm(exact(Vector3<double>{p.x(), p.y(), p.z()}) - exact_point).upper();
}

/// [m]  What the rounding of a pose is relative to.
double size(const MotionPiece& piece) {
  return norm(piece.pivot).upper() + norm(piece.lever).upper() + norm(piece.travel).upper() + 1.0;
}

TEST(MotionContract, PiecesFollowEachOtherFromZeroToOne) {
  for (const MotionCase& c : all_motions(20)) {
    SCOPED_TRACE(c.name);
    const Motion motion = to_motion(c.input);
    const auto breaks = motion.breaks();
    ASSERT_GE(breaks.size(), 2u);
    EXPECT_EQ(breaks.front(), 0.0);
    EXPECT_EQ(breaks.back(), 1.0);
    for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
      EXPECT_LT(breaks[k], breaks[k + 1]);
      const ConstantRatePath path = motion.path(k, Vector3d::Zero());
      EXPECT_EQ(path.t_begin(), breaks[k]);
      EXPECT_EQ(path.t_end(), breaks[k + 1]);
      EXPECT_GE(path.rate(), 0.0);
    }
  }
}

/// The poses that a motion is given, and when.
std::vector<std::pair<double, PoseInput>> given_poses(const MotionInput& input) {
  switch (input.kind) {
    case MotionKind::waypoints:
    case MotionKind::screw_waypoints: {
      std::vector<std::pair<double, PoseInput>> given;
      for (std::size_t i = 0; i < input.times.size(); ++i) {
        given.emplace_back(input.times[i], input.poses[i]);
      }
      given.emplace_back(0.0, input.poses.front());
      given.emplace_back(1.0, input.poses.back());
      return given;
    }
    case MotionKind::constant_velocity_between:
    case MotionKind::screw_between:
      return {{0.0, input.poses[0]}, {1.0, input.poses[1]}};
    default:
      return {{0.0, input.poses[0]}};
  }
}

TEST(MotionContract, InterpolatesTheGivenPoses) {
  for (const MotionCase& c : all_motions(20)) {
    SCOPED_TRACE(c.name);
    const Motion motion = to_motion(c.input);
    double reach = 1.0;
    for (const MotionPiece& piece : motion_pieces(c.input, {0.0, 0.0, 0.0})) {
      reach = std::max(reach, size(piece));
    }
    for (const auto& [t, given] : given_poses(c.input)) {
      const Pose pose = motion.pose(t);
      const Eigen::Quaterniond q(given.rotation.w, given.rotation.x, given.rotation.y,
                                 given.rotation.z);
      EXPECT_LE((pose.position - to_eigen(given.position)).norm(), 1e-15 * reach) << t;
      EXPECT_LE((pose.rotation.toRotationMatrix() - q.normalized().toRotationMatrix()).norm(),
                1e-14)
          << t;
    }
  }
}

TEST(MotionContract, IsContinuousWhereItsPiecesMeet) {
  for (const MotionCase& c : all_motions(50)) {
    SCOPED_TRACE(c.name);
    const Motion motion = to_motion(c.input);
    for (std::size_t k = 1; k + 1 < motion.breaks().size(); ++k) {
      const double t = motion.breaks()[k];
      const ConstantRatePath before = motion.path(k - 1, to_eigen(kPoint));
      const ConstantRatePath after = motion.path(k, to_eigen(kPoint));
      const DoubleDoubleVector3 gap =
          before.pivot(t) + before.precise_lever(t) - after.pivot(t) - after.precise_lever(t);
      const double sizes = before.pivot(t).value().norm() + after.pivot(t).value().norm() +
                           before.lever_length() + after.lever_length();
      EXPECT_LE(gap.value().norm(),
                before.position_error() + after.position_error() + 0x1p-88 * sizes);
      EXPECT_LE((before.state(t).R_WB - after.state(t).R_WB).norm(), 1e-14);
    }
  }
}

TEST(MotionContract, IsRigid) {
  for (const MotionCase& c : all_motions(20)) {
    SCOPED_TRACE(c.name);
    const Motion motion = to_motion(c.input);
    for (const double t : {0.0, 0.1, 0.37, 0.5, 0.731, 1.0}) {
      const Eigen::Matrix3d R = motion.pose(t).rotation.toRotationMatrix();
      EXPECT_LE((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
      EXPECT_GT(R.determinant(), 0.0);
    }
    for (std::size_t k = 0; k + 1 < motion.breaks().size(); ++k) {
      const ConstantRatePath path = motion.path(k, to_eigen(kPoint));
      const Eigen::Matrix3d R = path.state(0.5 * (path.t_begin() + path.t_end())).R_WB;
      EXPECT_LE((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    }
  }
}

/// Times of a piece: its ends and random ones.
std::vector<double> times_of(const MotionPiece& piece, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(piece.t_begin, piece.t_end);
  return {piece.t_begin, uniform(random), uniform(random), uniform(random), piece.t_end};
}

/// The displacement that the bound allows and the actual one, along n from t to t'.
struct SecondOrder {
  double allowed = 0.0;
  double moved = 0.0;
};

/// The velocity of the center is travel + rate axis x lever, in the path's own numbers.
SecondOrder second_order(const MotionPiece& piece, const ConstantRatePath& path, const Vector3d& n,
                         double t, double other) {
  const Vector3d lever = path.precise_lever(t).value();
  const Vector3d velocity = path.pivot_velocity().value() + path.rate() * path.axis().cross(lever);
  const Vector3<Wide> way = ExactState(piece, other).center() - ExactState(piece, t).center();
  const Wide time = Wide(other) - Wide(t);
  const Vector3<Wide> straight =
      time * exact(Vector3<double>{velocity.x(), velocity.y(), velocity.z()});
  const Wide moved = dot(exact(Vector3<double>{n.x(), n.y(), n.z()}), way - straight);
  const double acceleration =
      path.rate() * path.rate() * n.cross(path.axis()).norm() * path.lever_length();
  return {0.5 * acceleration * (other - t) * (other - t),
          std::max(std::abs(moved.lower()), std::abs(moved.upper()))};
}

TEST(MotionContract, BoundsHowAPointMovesAlongADirection) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (const MotionCase& c : all_motions(20)) {
    SCOPED_TRACE(c.name);
    const Motion motion = to_motion(c.input);
    const std::vector<MotionPiece> pieces = motion_pieces(c.input, kPoint);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const ConstantRatePath path = motion.path(k, to_eigen(kPoint));
      const double rounding =
          1e-14 * (path.rate() * path.lever_length() + path.pivot_velocity().value().norm()) *
              (path.t_end() - path.t_begin()) +
          2.0 * path.position_error();
      for (const double t : times_of(pieces[k], random)) {
        for (const double other : times_of(pieces[k], random)) {
          const Vector3d n = Vector3d(normal(random), normal(random), normal(random)).normalized();
          const SecondOrder bound = second_order(pieces[k], path, n, t, other);
          ASSERT_LE(bound.moved, bound.allowed * (1.0 + 1e-12) + rounding) << t << " " << other;
        }
      }
    }
  }
}

/// Along the lever, soon after, nearly all of it is used.
TEST(MotionContract, BoundsTightly) {
  for (const MotionCase& c : all_motions(20)) {
    SCOPED_TRACE(c.name);
    const Motion motion = to_motion(c.input);
    const std::vector<MotionPiece> pieces = motion_pieces(c.input, kPoint);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const ConstantRatePath path = motion.path(k, to_eigen(kPoint));
      const double turn = path.rate() * (path.t_end() - path.t_begin());
      // Below that, the rounding of the velocity hides the second order.
      if (turn < 0.01 || path.lever_length() * turn < 1e-6 * path.pivot_velocity().value().norm()) {
        continue;
      }
      const double t = path.t_begin();
      const double other = t + std::min(0.1 / path.rate(), path.t_end() - t);
      const Vector3d n = path.precise_lever(t).value().normalized();
      const SecondOrder bound = second_order(pieces[k], path, n, t, other);
      ASSERT_GE(bound.moved, 0.99 * bound.allowed);
    }
  }
}

/// The axis whose first non-zero component is positive.
TEST(MotionContract, TurnsHalfTurnsAboutThePositiveAxis) {
  const auto middle_of = [](const Eigen::Quaterniond& to) {
    return Motion::constant_velocity(Pose{}, Pose{Vector3d::Zero(), to}).pose(0.5).rotation;
  };
  const double h = std::sqrt(0.5);
  for (const double sign : {1.0, -1.0}) {
    EXPECT_LE((middle_of({0.0, sign, 0.0, 0.0}) * Vector3d::UnitY() - Vector3d::UnitZ()).norm(),
              1e-15);
    EXPECT_LE((middle_of({0.0, 0.0, sign, 0.0}) * Vector3d::UnitZ() - Vector3d::UnitX()).norm(),
              1e-15);
    EXPECT_LE((middle_of({0.0, 0.0, 0.0, sign}) * Vector3d::UnitX() - Vector3d::UnitY()).norm(),
              1e-15);
    const Vector3d axis = middle_of({0.0, sign * h, -sign * h, 0.0}).vec().normalized();
    const Vector3d expected(h, -h, 0.0);
    EXPECT_LE(std::min((axis - expected).norm(), (axis + expected).norm()), 1e-15);
  }
}

TEST(MotionContract, PlacesABodyAfterAThousandTurns) {
  // 2 pi is no double: the exact motion of the doubles decides.
  for (const MotionCase& c : sudden_motions()) {
    SCOPED_TRACE(c.name);
    const Motion motion = to_motion(c.input);
    const MotionPiece piece = motion_pieces(c.input, {0.0, 0.0, 0.0}).back();
    EXPECT_LE(distance(motion.pose(1.0).position, ExactState(piece, 1.0).center()),
              1e-15 * size(piece));
  }
}

// The reciprocal of such a time is infinite, and where a body is then was not a number.
TEST(MotionContract, RefusesTimesWithoutAReciprocal) {
  const std::vector<Pose> poses(2);
  const auto made = [&](double first) {
    return Motion::waypoints(std::vector<double>{first, 1.0}, poses, Between::constant_velocity);
  };
  EXPECT_THROW((void)made(1e-320), std::invalid_argument);
  EXPECT_NO_THROW((void)made(1e-200));
  EXPECT_NO_THROW((void)made(0.0));
}

}  // namespace
}  // namespace firstcontact::oracle
