#include <firstcontact/motion/enclose_pose.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "motion/motion_cases.h"
#include "support/exact_state.h"
#include "support/library_case.h"

namespace firstcontact::oracle {
namespace {

bool contains(const IntervalVector3& box, const Vector3<Wide>& p) {
  const auto inside = [](const Interval& interval, const Wide& x) {
    return !(x - Wide(interval.lower())).is_negative() &&
           !(Wide(interval.upper()) - x).is_negative();
  };
  return inside(box.c[0], p.x) && inside(box.c[1], p.y) && inside(box.c[2], p.z);
}

/// A random window of t in [0, 1] of some width, at times no longer than the step.
Interval random_window(std::mt19937_64& random, double width) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double begin = uniform(random) * (1.0 - width);
  return Interval(begin, std::min(1.0, begin + width));
}

const MotionPiece& piece_at(const std::vector<MotionPiece>& pieces, double t) {
  return *std::find_if(pieces.begin(), pieces.end(),
                       [t](const MotionPiece& piece) { return t <= piece.t_end; });
}

TEST(EnclosePose, ContainsTheExactPose) {
  std::mt19937_64 random(1);
  for (const MotionCase& c : all_motions(10)) {
    SCOPED_TRACE(c.name);
    const Motion motion = to_motion(c.input);
    const std::vector<MotionPiece> pieces = motion_pieces(c.input, {0.0, 0.0, 0.0});
    for (const double width : {0.0, 1e-9, 1e-3, 0.1, 1.0}) {
      const Interval window = random_window(random, width);
      const IntervalTransform X_WB = enclose_pose(motion, window);
      std::uniform_real_distribution<double> inside(window.lower(), window.upper());
      for (const double t : {window.lower(), inside(random), inside(random), window.upper()}) {
        const ExactState exact_state(piece_at(pieces, t), t);
        ASSERT_TRUE(contains(X_WB.position, exact_state.center())) << t;
        for (std::size_t j = 0; j < 3; ++j) {
          ASSERT_TRUE(contains(X_WB.rotation.columns[j], exact_state.column(j))) << t;
        }
      }
    }
  }
}

double width(const IntervalVector3& box) {
  return std::max({box.c[0].width_bound(), box.c[1].width_bound(), box.c[2].width_bound()});
}

/// About as wide as the way in the window, else the entire space would do.
TEST(EnclosePose, IsAsWideAsTheMotionIsLong) {
  std::mt19937_64 random(2);
  for (const MotionCase& c : all_motions(10)) {
    SCOPED_TRACE(c.name);
    const Motion motion = to_motion(c.input);
    for (std::size_t k = 0; k + 1 < motion.breaks().size(); ++k) {
      const ConstantRatePath path = motion.path(k, Eigen::Vector3d(0.3, -0.2, 0.5));
      const double length = path.t_end() - path.t_begin();
      for (const double part : {0.0, 1e-9, 1e-3}) {
        // Small turns: the box of a long arc is as wide as its circle.
        const double time = std::min(part * length, path.rate() > 0.0 ? 0.01 / path.rate() : 1.0);
        const Interval window(path.t_begin(), path.t_begin() + time);
        const IntervalTransform X = enclose_pose(path, window);
        const double angle = path.rate() * time;
        const double way =
            path.pivot_velocity().value().norm() * time + angle * path.lever_length();
        const double sizes = path.pivot_begin().value().norm() + path.lever_length();
        EXPECT_LE(width(X.position), 2.0 * way + 1e-14 * sizes);
        for (const IntervalVector3& column : X.rotation.columns) {
          EXPECT_LE(width(column), 3.0 * angle + 1e-13);
        }
      }
    }
  }
}

TEST(EnclosePose, StaysBoundedOverAThousandTurns) {
  const Motion motion = Motion::constant_velocity(Pose{}, Eigen::Vector3d(1.0, 0.0, 0.0),
                                                  Eigen::Vector3d(0.0, 0.0, 6283.185307179586));
  const IntervalTransform X =
      enclose_pose(motion.path(0, Eigen::Vector3d(0.0, 2.0, 0.0)), Interval(0.0, 1.0));
  EXPECT_LE(X.position.c[1].magnitude(), 10.0);
  EXPECT_LE(X.position.c[2].magnitude(), 1e-12);
}

}  // namespace
}  // namespace firstcontact::oracle
