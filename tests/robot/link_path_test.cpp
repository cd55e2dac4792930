// Poses and motion bounds of links against the oracle, 256 bits, for chains of all joints.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <firstcontact/robot/robot_motion.h>

#include "robot/chain_case.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;
using oracle::Wide;

std::size_t tip(const ChainCase& c) { return c.motion.model().links().size() - 1; }

Vector3d rounded(const oracle::Vector3<Wide>& v) {
  return {v.x.nearest(), v.y.nearest(), v.z.nearest()};
}

TEST(LinkPath, PosesStayWithinTheirErrorsOfTheExactChain) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const ChainCase c = random_chain(seed, {.joints = 1 + static_cast<int>(seed % 12)});
    const LinkMotion motion = c.motion.link(tip(c));
    for (const double t : {0.0, 0.123, 0.61, 0.99}) {
      const LinkPose pose = motion.at(t).pose(t);
      const Vector3d p_LP(0.2, -0.1, 0.3);
      const Vector3d p_FP = pose.p_OL + pose.R_FL * p_LP;
      const double error =
          norm(exact_point(p_FP) - oracle::exact_place(c.exact(t), Wide(t), exact_point(p_LP)))
              .upper();
      // The sum that this test rounds, too.
      ASSERT_LE(error, pose.position_error + pose.rotation_error * p_LP.norm() + 1e-15)
          << seed << " at " << t;
      ASSERT_LE(pose.position_error, 1e-12);  // Else an error of infinity would pass.
      ASSERT_LE(pose.rotation_error, 1e-12);
    }
  }
}

/// Velocity and acceleration of a point, by differences of the oracle's places over 2^-60: within
/// 2^-60 of the next derivatives.
TEST(LinkPath, DerivativesStayWithinTheirErrorsOfTheExactChain) {
  LinkScratch scratch;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const ChainCase c = random_chain(seed, {.joints = 1 + static_cast<int>(seed % 12)});
    const LinkMotion motion = c.motion.link(tip(c));
    const Vector3d p_LP(0.2, -0.1, 0.3);
    for (const double t : {0.123, 0.61, 0.97}) {
      const LinkState state = motion.at(t).state(t, scratch);
      const auto chain = c.exact(t);
      const Wide h = Wide(1.0).scaled(-60);
      const auto place = [&](const Wide& at) {
        return oracle::exact_place(chain, at, exact_point(p_LP));
      };
      const auto before = place(Wide(t) - h);
      const auto here = place(Wide(t));
      const auto after = place(Wide(t) + h);
      const Wide per_h = Wide(1.0).scaled(60);
      const auto v_exact = rounded((per_h * Wide(0.5)) * (after - before));
      const auto a_exact = rounded((per_h * per_h) * (after - here - (here - before)));

      const Vector3d e = state.pose.R_FL * p_LP;
      const Vector3d inward = state.spin.cross(e);
      const Vector3d v = state.velocity + inward;
      const Vector3d a = state.acceleration + state.spin_rate.cross(e) + state.spin.cross(inward);
      const double far = p_LP.norm();
      const double turning = state.pose.rotation_error * far;
      const double w = state.spin.norm() + state.spin_error;
      const double turn = state.spin_rate.norm() + state.spin_rate_error + w * w;
      // With what this test rounds.
      const double v_error = state.velocity_error + state.spin_error * far + w * turning +
                             1e-15 * (state.velocity.norm() + w * far);
      const double a_error =
          state.acceleration_error + (state.spin_rate_error + 2.0 * w * state.spin_error) * far +
          turn * turning + 1e-15 * (state.acceleration.norm() + turn * far + a_exact.norm());
      ASSERT_LE((v - v_exact).norm(), v_error) << seed << " at " << t;
      ASSERT_LE((a - a_exact).norm(), a_error) << seed << " at " << t;
      // Else errors of infinity would pass: of sums in which little cancels.
      ASSERT_LE(state.velocity_error, 1e-10 * (1.0 + w)) << seed;
      ASSERT_LE(state.acceleration_error, 1e-10 * (1.0 + w) * (1.0 + w)) << seed;
    }
  }
}

/// A law: what the scratch memory remembers of other links and times changes no bit of an answer.
TEST(LinkScratch, ChangesNothing) {
  const ChainCase c = random_chain(7, {.joints = 9});
  const std::size_t links = c.motion.model().links().size();
  LinkScratch used;
  Random random(1);
  for (int trial = 0; trial < 3000; ++trial) {
    // More times than it remembers, some of them again and again; links that share joints.
    const double t = 0.02 * std::floor(random.uniform(0.0, 50.0));
    const auto link = static_cast<std::size_t>(random.uniform(1.0, static_cast<double>(links)));
    const auto frame = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(link)));
    const LinkPath path =
        random.chance(0.5) ? c.motion.path(link, t) : c.motion.path(frame, link, t);
    const DoubleDoubleVector3 origin = random.chance(0.5) ? path.anchor() : DoubleDoubleVector3();
    LinkScratch fresh;
    const LinkPose pose = path.pose(t, origin);
    const LinkState state = path.state(t, used, origin);
    ASSERT_EQ(state.pose.p_OL, pose.p_OL) << trial;
    ASSERT_EQ(state.pose.R_FL, pose.R_FL) << trial;
    ASSERT_EQ(state.pose.position_error, pose.position_error) << trial;
    const double to = std::min(t + 0.01 * random.uniform(0.0, 1.0), path.t_end());
    const auto bounds = path.window(t, t, to, {.radius = 0.1}, used, origin).bounds();
    const auto same = path.window(t, t, to, {.radius = 0.1}, fresh, origin).bounds();
    ASSERT_EQ(bounds.rate, same.rate) << trial;
    ASSERT_EQ(bounds.jerk, same.jerk) << trial;
    ASSERT_EQ(path.swept(t, t, to, {.radius = 0.1}, used).speed,
              path.swept(t, t, to, {.radius = 0.1}, fresh).speed)
        << trial;
  }
}

/// The common part of two links cancels: their bounds contain neither the base nor the joints
/// before.
TEST(LinkPath, RelativeMotionStartsAtTheLastCommonAncestor) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const ChainCase c = random_chain(seed, {.joints = 8});
    const std::size_t middle = 4;  // The child of joint 3.
    const RelativeLinkMotion relative = c.motion.relative(middle, tip(c));
    const double t = 0.37;
    const LinkPose own = relative.A.at(t).pose(t);
    EXPECT_EQ(own.R_FL, Eigen::Matrix3d::Identity());
    EXPECT_EQ(own.p_OL, Vector3d::Zero());
    const LinkPose pose = relative.B.at(t).pose(t);
    const auto exact = oracle::exact_place(c.exact(t, 4, false), Wide(t), exact_point({0, 0, 0}));
    ASSERT_LE(norm(exact_point(pose.p_OL) - exact).upper(), pose.position_error) << seed;
    LinkScratch scratch;
    EXPECT_EQ(relative.A.at(t).window(t, t, t, {.radius = 1.0}, scratch).bounds().rate, 0.0);
  }
}

/// Far from the world's origin only the difference to the origin asked for is rounded.
TEST(LinkPath, LargeOffsetsOfTheBaseCostNoPrecision) {
  const ChainCase c = random_chain(5, {.joints = 4, .turning_only = true});
  std::map<std::string, JointMotion> joints;
  for (const Joint& joint : c.motion.model().joints()) {
    joints.emplace(joint.name, CoordinatePath::constant(0.3));
  }
  const Vector3d far(1e9, -3e8, 7e8);
  const RobotMotion near_motion(c.motion.model(), joints, Motion::fixed());
  const RobotMotion far_motion(c.motion.model(), joints,
                               Motion::fixed({far, Eigen::Quaterniond::Identity()}));
  const LinkPose a = near_motion.link(tip(c)).at(0.5).pose(0.5);
  const LinkPose b = far_motion.link(tip(c)).at(0.5).pose(0.5, DoubleDoubleVector3(far));
  EXPECT_LE((a.p_OL - b.p_OL).norm(), 1e-15);
  EXPECT_LE(b.position_error, 1e-13);
}

/// A window in one piece in which all joints together turn (or slide) by about `travel`, so that no
/// link turns by more.
struct WindowCase {
  ChainCase chain;
  LinkMotion motion;
  RoundedBox box;
  double from = 0.0;
  double to = 0.0;
};

WindowCase random_window(std::uint64_t seed, const ChainOptions& options, double travel) {
  Random random(seed + 1000);
  ChainCase chain = random_chain(seed, options);
  LinkMotion motion = chain.motion.link(tip(chain));
  WindowCase w{std::move(chain), std::move(motion), {}, 0.0, 0.0};
  const Eigen::Matrix3d axes = random.rotation().toRotationMatrix();
  w.box = {.centre = random.vector(0.0, 0.2),
           .axes = axes,
           .half_extents = {random.uniform(0.0, 0.1), random.uniform(0.0, 0.1),
                            random.uniform(0.0, 0.1)},
           .radius = random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.1)};
  const auto& pieces = w.motion.pieces();
  const LinkPath& piece = pieces[static_cast<std::size_t>(random.uniform(0.0, 0.999) *
                                                          static_cast<double>(pieces.size()))];
  w.from = piece.t_begin() + random.uniform(0.0, 0.5) * (piece.t_end() - piece.t_begin());
  double rate = options.turning_only ? 0.0 : 2.0;  // Rate of the base and of joints with a pose.
  for (const auto& joint : w.chain.coordinates) {
    for (const auto& pieces_of_one : joint) {
      for (const oracle::ExactCoordinate& q : pieces_of_one) {
        if (q.t_begin <= w.from && w.from < q.t_end) {
          double most = 0.0;
          for (int i = 0; i <= 4; ++i) {
            const double t = w.from + i * 0.01;
            const Wide dt = Wide(1.0).scaled(-60);
            const Wide slope = (q.value(Wide(t) + dt) - q.value(Wide(t))).scaled(60);
            most = std::max(most, std::abs(slope.nearest()));
          }
          rate += most;
        }
      }
    }
  }
  w.to = std::min(w.from + travel / rate, piece.t_end());
  return w;
}

/// Points of the box: its corners, moved on by the radius along n in the frame F.
std::vector<Vector3d> extreme_points(const RoundedBox& box) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 8; ++i) {
    const Vector3d signs(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    points.push_back(box.centre +
                     box.axes.transpose() * signs.cwiseProduct(box.half_extents) * (1.0 - 1e-15));
  }
  return points;
}

/// Sound: no point gains more along n than the bound says, at any time after t.
TEST(LinkWindow, NoPointOutrunsTheBound) {
  LinkScratch scratch;
  for (std::uint64_t seed = 0; seed < test::rounds(100, 25); ++seed) {
    // From far below the test of tightness to whole turns of every joint.
    const double travel = std::array<double, 5>{1e-3, 0.01, 0.1, 1.0, 20.0}[seed % 5];
    const WindowCase w = random_window(seed, {.joints = 1 + static_cast<int>(seed % 12)}, travel);
    const LinkPath& path = w.motion.at(0.5 * (w.from + w.to));
    const LinkWindow window = path.window(w.from, w.from, w.to, w.box, scratch);
    Random random(seed);
    const Vector3d n = (1.0 - 1e-15) * random.direction();
    const DirectedBound bound = window.displacement(w.box, n);
    const double speed = window.speed_bound(w.box, n);
    const LinkPath::Swept swept = path.swept(w.from, w.from, w.to, w.box, scratch);
    if (travel <= 0.01) {  // Tight: the length of the chain, which it leaves out, says no more.
      ASSERT_LE(swept.speed, 1.05 * window.bounds().rate) << seed;
    }
    const auto chain = w.chain.exact(w.from);
    for (Vector3d point : extreme_points(w.box)) {
      point += (1.0 - 1e-15) * w.box.radius * random.direction();
      const auto start = oracle::exact_place(chain, Wide(w.from), exact_point(point));
      for (const double share : {1e-6, 0.01, 0.3, 0.7, 1.0}) {
        const double t = w.from + share * (w.to - w.from);
        const Wide tau = Wide(t) - Wide(w.from);
        const auto moved = oracle::exact_place(chain, Wide(t), exact_point(point)) - start;
        const Wide gain = dot(exact_point(n), moved);
        const Wide most =
            Wide(bound.speed) * tau + Wide(bound.acceleration) * tau * tau * Wide(0.5);
        ASSERT_LE((gain - most).lower(), 0.0) << seed << " " << share;
        const auto velocity = oracle::nearly_exact_velocity(chain, t, exact_point(point));
        ASSERT_LE(dot(exact_point(n), velocity).lower(), speed + 1e-18) << seed << " " << share;
        ASSERT_LE(norm(velocity).lower(), window.bounds().rate + 1e-18) << seed;
        ASSERT_LE(norm(velocity).lower(), swept.speed + 1e-18) << seed;
      }
    }
  }
}

/// The greatest speed along n, and over all directions, of the box in the window.
struct TrueSpeeds {
  double along = -1e300;
  double any = 0.0;
};

TrueSpeeds true_speeds(const WindowCase& w, const Vector3d& n) {
  TrueSpeeds speeds;
  const auto chain = w.chain.exact(w.from);
  for (int i = 0; i <= 4; ++i) {
    const double t = w.from + i * (w.to - w.from) / 4.0;
    for (const Vector3d& point : extreme_points(w.box)) {
      const Vector3d v = rounded(oracle::nearly_exact_velocity(chain, t, exact_point(point)));
      speeds.along = std::max(speeds.along, n.dot(v));
      speeds.any = std::max(speeds.any, v.norm());
    }
  }
  return speeds;
}

struct Excess {
  double worst = 0.0;
  double mean = 0.0;
};

/// Excess of the bound of speed over the true greatest speed.
///
/// It is in units of the greatest speed over all directions.
Excess excess_of_speed(const ChainOptions& options, double travel) {
  LinkScratch scratch;
  Excess excess;
  constexpr int kCases = rounds(40, 12);
  for (std::uint64_t seed = 0; seed < kCases; ++seed) {
    WindowCase w = random_window(seed, options, travel);
    w.box.radius = 0.0;  // The corners are all there is.
    const LinkPath& path = w.motion.at(0.5 * (w.from + w.to));
    const LinkWindow window = path.window(0.5 * (w.from + w.to), w.from, w.to, w.box, scratch);
    Random random(seed);
    const Vector3d n = random.direction();
    const TrueSpeeds speeds = true_speeds(w, n);
    const double over = (window.speed_bound(w.box, n) - speeds.along) / speeds.any;
    EXPECT_GE(over, -1e-9) << seed;
    excess.worst = std::max(excess.worst, over);
    excess.mean += over / kCases;
  }
  return excess;
}

/// A law: bounds of a point and of each metre from it hold for a ball around it, and are those of a
/// ball where that is small.
TEST(LinkWindow, BoundsGrowWithTheReachByNoMoreThanTheirSlopes) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed + 900);
    const ChainCase c = random_chain(seed, {.joints = 1 + static_cast<int>(seed % 12)});
    const double t = random.uniform(0.0, 0.9);
    const LinkPath path = c.motion.path(c.motion.model().links().size() - 1, t);
    const double to = std::min(t + random.logarithmic(1e-3, 1.0), path.t_end());
    const Vector3d centre = random.vector(0.0, 0.3);
    LinkScratch scratch;
    const LinkWindow point = path.window(t, t, to, {.centre = centre}, scratch);
    for (const double reach : {1e-6, 0.1, 10.0}) {
      const CoordinateSegment::Bounds ball =
          path.window(t, t, to, {.centre = centre, .radius = reach}, scratch).bounds();
      const auto by_slope = [&](double CoordinateSegment::Bounds::*bound) {
        return point.bounds().*bound + reach * point.per_metre().*bound;
      };
      ASSERT_LE(ball.rate, by_slope(&CoordinateSegment::Bounds::rate) * (1.0 + 1e-11)) << seed;
      ASSERT_LE(ball.acceleration,
                by_slope(&CoordinateSegment::Bounds::acceleration) * (1.0 + 1e-11))
          << seed;
      ASSERT_LE(ball.jerk, by_slope(&CoordinateSegment::Bounds::jerk) * (1.0 + 1e-11)) << seed;
      if (reach < 1e-5) {
        ASSERT_GE(ball.jerk, by_slope(&CoordinateSegment::Bounds::jerk) * (1.0 - 1e-9)) << seed;
      }
    }
  }
}

/// Tight: where the joints together turn by 0.1 rad, and still by 0.3, the excess is at most half
/// of the greatest speed over all directions; by 0.01 rad, a few percent of it. By 0.7 rad, 0.1 for
/// each joint, it is so on average only: such a window wants to be seen in three parts.
TEST(LinkWindow, IsTightOnShortWindows) {
  for (const bool turning_only : {true, false}) {
    const ChainOptions options{.joints = 7, .turning_only = turning_only};
    const Excess tenth = excess_of_speed(options, 0.1);
    EXPECT_LE(tenth.worst, 0.5);
    EXPECT_LE(tenth.mean, 0.02);
    const Excess hundredth = excess_of_speed(options, 0.01);
    EXPECT_LE(hundredth.worst, 0.02);
    EXPECT_LE(hundredth.mean, 0.002);
    EXPECT_LE(excess_of_speed(options, 0.3).worst, 0.5);
    EXPECT_LE(excess_of_speed(options, 0.7).mean, 0.5);
  }
}

}  // namespace
}  // namespace firstcontact::test
