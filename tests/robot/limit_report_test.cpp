// Where a motion leaves its limits: closed forms, dense samples, and what must not be reported.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <firstcontact/robot/limit_report.h>

#include "robot/chain_case.h"
#include "support/random.h"

namespace firstcontact::test {
namespace {

constexpr std::array<double, 2> kBothEnds = {0.0, 1.0};

RobotMotion hinge(const CoordinatePath& path, const JointLimits& limits,
                  JointType type = JointType::revolute) {
  Joint joint{.name = "j", .type = type, .parent = "base", .child = "arm"};
  joint.limits = limits;
  return {
      RobotModel({.name = "r", .links = {{"base", {}, {}}, {"arm", {}, {}}}, .joints = {joint}}),
      {{"j", path}}};
}

CoordinatePath straight(double from, double to) {
  const std::array<double, 2> q = {from, to};
  return CoordinatePath::linear(kBothEnds, q);
}

TEST(LimitReport, FindsWhereARampLeavesALimit) {
  const JointLimits limits{.lower = -1.0, .upper = 0.5, .velocity = 0.25};
  const auto report = limit_report(hinge(straight(0.0, 2.0), limits), 10.0);
  ASSERT_EQ(report.size(), 1u);  // 2 rad in 10 s are slower than 0.25 rad/s.
  EXPECT_EQ(report[0].joint, 0u);
  EXPECT_EQ(report[0].what, JointLimit::upper_position);
  EXPECT_EQ(report[0].limit, 0.5);
  EXPECT_NEAR(report[0].excess, 1.5, 1e-14);
  EXPECT_EQ(report[0].t_excess, 1.0);
  ASSERT_EQ(report[0].intervals.size(), 1u);
  EXPECT_NEAR(report[0].intervals[0].begin, 0.25, 1e-9);
  EXPECT_GE(report[0].intervals[0].begin, 0.25 - 1e-14);
  EXPECT_EQ(report[0].intervals[0].end, 1.0);
  // In 4 s it is twice as fast as allowed, all the time.
  const auto fast = limit_report(hinge(straight(0.0, -2.0), limits), 4.0);
  ASSERT_EQ(fast.size(), 2u);
  EXPECT_EQ(fast[0].what, JointLimit::lower_position);
  EXPECT_EQ(fast[1].what, JointLimit::velocity);
  EXPECT_NEAR(fast[1].excess, 0.25, 1e-12);
  ASSERT_EQ(fast[1].intervals.size(), 1u);
  EXPECT_EQ(fast[1].intervals[0].begin, 0.0);
  EXPECT_EQ(fast[1].intervals[0].end, 1.0);
}

TEST(LimitReport, TakesAVelocityLimitOfZeroForNone) {
  const JointLimits limits{.lower = -9.0, .upper = 9.0, .velocity = 0.0};
  EXPECT_TRUE(limit_report(hinge(straight(0.0, 2.0), limits), 1.0).empty());
}

TEST(LimitReport, ReachingALimitIsNotLeavingIt) {
  const JointLimits limits{.lower = -0.3, .upper = 0.7, .velocity = 1.0};
  EXPECT_TRUE(limit_report(hinge(straight(-0.3, 0.7), limits), 1.0).empty());
  EXPECT_TRUE(limit_report(hinge(CoordinatePath::constant(0.7), limits), 1.0).empty());
  // A cubic at rest on the limit in the middle.
  const std::array<double, 3> t = {0.0, 0.37, 1.0};
  const std::array<double, 3> q = {0.1, 0.7, 0.2};
  const std::array<double, 3> v = {0.0, 0.0, 0.0};
  EXPECT_TRUE(limit_report(hinge(CoordinatePath::cubic(t, q, v), limits), 10.0).empty());
  EXPECT_EQ(limit_report(hinge(straight(-0.3, 0.7 + 1e-8), limits), 1.1).size(), 1u);
}

/// t (1 - t) is greatest, 1/4, in the middle, and 3/16 at both quarters.
TEST(LimitReport, APolynomialLeavesInItsMiddleOnly) {
  const std::vector<std::vector<double>> parabola = {{0.0, 1.0, -1.0}};
  const RobotMotion motion =
      hinge(CoordinatePath::polynomials(kBothEnds, parabola), {.upper = 0.1875, .velocity = 0.8});
  const auto report = limit_report(motion, 1.0);
  ASSERT_EQ(report.size(), 2u);
  ASSERT_EQ(report[0].intervals.size(), 1u);
  EXPECT_NEAR(report[0].intervals[0].begin, 0.25, 1e-8);
  EXPECT_NEAR(report[0].intervals[0].end, 0.75, 1e-8);
  EXPECT_NEAR(report[0].excess, 0.0625, 1e-9);
  EXPECT_NEAR(report[0].t_excess, 0.5, 1e-4);
  // The rate 1 - 2 t is beyond 0.8 at both ends, in opposite directions.
  EXPECT_EQ(report[1].what, JointLimit::velocity);
  ASSERT_EQ(report[1].intervals.size(), 2u);
  EXPECT_EQ(report[1].intervals[0].begin, 0.0);
  EXPECT_NEAR(report[1].intervals[0].end, 0.1, 1e-8);
  EXPECT_NEAR(report[1].intervals[1].begin, 0.9, 1e-8);
  EXPECT_EQ(report[1].intervals[1].end, 1.0);
}

TEST(LimitReport, ContinuousJointsHaveNoEnds) {
  const JointLimits limits{.lower = -1.0, .upper = 1.0, .velocity = 100.0};
  EXPECT_TRUE(limit_report(hinge(straight(0.0, 50.0), limits, JointType::continuous), 1.0).empty());
}

TEST(LimitReport, AMimicJointHasLimitsOfItsOwn) {
  Joint left{.name = "left", .type = JointType::prismatic, .parent = "palm", .child = "l"};
  Joint right{.name = "right", .type = JointType::prismatic, .parent = "palm", .child = "r"};
  right.mimic = Mimic{.joint = "left", .multiplier = -2.0, .offset = 0.01};
  right.limits = {.lower = -0.03};
  const RobotMotion motion(RobotModel({.name = "hand",
                                       .links = {{"palm", {}, {}}, {"l", {}, {}}, {"r", {}, {}}},
                                       .joints = {left, right}}),
                           {{"left", straight(0.0, 0.04)}});
  const auto report = limit_report(motion, 1.0);
  ASSERT_EQ(report.size(), 1u);
  EXPECT_EQ(report[0].joint, 1u);
  EXPECT_NEAR(report[0].intervals[0].begin, 0.5, 1e-6);
  EXPECT_NEAR(report[0].excess, 0.04, 1e-12);
}

/// Random paths of all kinds: samples beyond a limit lie in the intervals, and each interval holds
/// one; the greatest excess is that of the samples, but for their distance.
TEST(LimitReport, AgreesWithDenseSamples) {
  constexpr int kSamples = 2000;
  int violations = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const CoordinateCase path = random_coordinate(random, 1.0, false);
    const JointLimits limits{.lower = -0.8, .upper = 0.6, .velocity = 1.5};
    const RobotMotion motion = hinge(path.path, limits);
    const std::vector<CoordinateSegment> segments = motion.coordinate(0);
    const double duration = random.uniform(0.5, 2.0);
    const auto report = limit_report(motion, duration);
    // At a break the greater one of both sides: rates may jump there.
    const auto value = [&](JointLimit what, double t) {
      double greatest = -std::numeric_limits<double>::infinity();
      for (const CoordinateSegment& segment : segments) {
        if (segment.t_begin <= t && t <= segment.t_end) {
          const CoordinateSegment::State q = segment.state(t);
          greatest =
              std::max(greatest, what == JointLimit::velocity ? std::abs(q.rate) / duration - 1.5
                                 : what == JointLimit::upper_position ? q.value.hi - 0.6
                                                                      : -0.8 - q.value.hi);
        }
      }
      return greatest;
    };
    for (const JointLimit what :
         {JointLimit::lower_position, JointLimit::upper_position, JointLimit::velocity}) {
      const auto found =
          std::find_if(report.begin(), report.end(),
                       [what](const LimitViolation& violation) { return violation.what == what; });
      double greatest = -std::numeric_limits<double>::infinity();
      for (int i = 0; i <= kSamples; ++i) {
        const double t = static_cast<double>(i) / kSamples;
        greatest = std::max(greatest, value(what, t));
        const auto holds = [t](const TimeWindow& x) { return x.begin <= t && t <= x.end; };
        const bool reported = found != report.end() &&
                              std::any_of(found->intervals.begin(), found->intervals.end(), holds);
        ASSERT_TRUE(reported || value(what, t) <= 1e-9 + 1e-12) << seed << " at " << t;
      }
      if (found == report.end()) {
        continue;
      }
      ++violations;
      ASSERT_GE(found->excess, greatest - 1e-9) << seed;
      ASSERT_LE(found->excess, greatest + 0.05) << seed;
      ASSERT_NEAR(found->excess, value(what, found->t_excess), 1e-8) << seed;
      for (const TimeWindow& interval : found->intervals) {
        ASSERT_GT(std::max({value(what, interval.begin), value(what, interval.end),
                            value(what, 0.5 * (interval.begin + interval.end))}),
                  0.0)
            << seed;
      }
    }
  }
  EXPECT_GE(violations, 100);
}

TEST(LimitReport, RefusesWhatIsNoDuration) {
  const RobotMotion motion = hinge(straight(0.0, 1.0), {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, nan, infinity}) {
    EXPECT_THROW(static_cast<void>(limit_report(motion, bad)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(limit_report(motion, 1.0, bad)), std::invalid_argument);
  }
}

}  // namespace
}  // namespace firstcontact::test
