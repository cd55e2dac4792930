// Pairs in contact at an end of the path: held to their distances as executed, and open in between.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/retiming/retime.h>
#include <firstcontact/retiming/retiming_scene.h>
#include <firstcontact/retiming/write_trajectory.h>

#include "retiming_cases.h"

namespace firstcontact::test {
namespace {

constexpr std::array kAllModes{RetimingMode::stop, RetimingMode::blend, RetimingMode::time_optimal};
constexpr BodyPair kBallAndPost{2, 3};
constexpr double kMarginOfAll = 0.01;  // [m]
constexpr double kStartGap = 0.001;    // [m]
constexpr double kHeld = 0.0009375;    // [m]  15/16 of it.
const std::vector<RateLimits> kOfSlides(2, {1.0, 4.0, 80.0});

/// The ball starts 1 mm beside a post, within the margin.
RetimingScene beside_post() {
  RetimingScene where = gantry_among({{{0.1 + kStartGap, 0.0}, 0.05}});
  where.scene.rules() = PairRules(kMarginOfAll);
  return where;
}

RetimingScene held_beside_post(std::vector<double> opens_at = {}, PathEnd at = PathEnd::start) {
  RetimingScene where = beside_post();
  where.holds = {
      {.members = kBallAndPost, .distance = kHeld, .opens_at = std::move(opens_at), .at = at}};
  return where;
}

WaypointPath slides_along(std::vector<std::vector<double>> waypoints) {
  return {{"x", "y"}, std::move(waypoints)};
}

/// [m]  From the post to the ball, at places of the slides.
double gap_at(double x, double y) { return std::hypot(0.1 + kStartGap - x, y) - 0.1; }

double least_gap(const TimedMotion& motion, double from, double to) {
  double least = 1e9;
  for (double t = from; t <= to; t += 2e-4) {
    least = std::min(least, gap_at(controller_state(motion, 0, t).position,
                                   controller_state(motion, 1, t).position));
  }
  return least;
}

const WaypointPath kThereAndBack = slides_along({{0, 0}, {-0.3, 0}, {-0.3, 0.2}, {0, 0}});

TEST(ContactPairs, AreRefusedWithoutAHold) {
  const RetimedMotion retimed = retime(kThereAndBack, kOfSlides, beside_post());
  EXPECT_EQ(retimed.proof.contact.verdict, Verdict::contact_at_start);
}

TEST(ContactPairs, AreHeldToTheirDistanceAllTheTime) {
  const RetimingScene where = held_beside_post();
  for (const RetimingMode mode : kAllModes) {
    const RetimedMotion retimed = retime(kThereAndBack, kOfSlides, where, {.mode = mode});
    ASSERT_TRUE(retimed.proof.is_proven());
    EXPECT_EQ(retimed.mode, mode);
    EXPECT_GE(least_gap(retimed.motion, 0.0, retimed.motion.duration()), kHeld);
    ASSERT_EQ(retimed.proof.held.size(), 1u);
    EXPECT_EQ(retimed.proof.held[0].to, retimed.motion.duration());
  }
  // A hold that is more than the pair has at the start is not proven.
  RetimingScene farther = where;
  farther.holds[0].distance = kStartGap * (1.0 + 1e-3);
  EXPECT_EQ(retime(kThereAndBack, kOfSlides, farther).proof.contact.verdict,
            Verdict::contact_at_start);
}

TEST(ContactPairs, ComeNoDeeper) {
  // The last edge ends a tenth of a millimetre nearer than the start.
  const WaypointPath deeper = slides_along({{0, 0}, {-0.3, 0}, {1e-4, 0}});
  const RetimingScene where = held_beside_post();
  const RetimedMotion retimed = retime(deeper, kOfSlides, where);
  EXPECT_FALSE(retimed.proof.is_proven());
  EXPECT_EQ(retimed.proof.contact.verdict, Verdict::contact);
  const double t = retimed.proof.contact_time();
  EXPECT_NEAR(gap_at(controller_state(retimed.motion, 0, t).position, 0.0), kHeld, 1e-5);
  RetimingScene half = where;
  half.holds[0].distance = 0.5 * kStartGap;
  EXPECT_TRUE(retime(deeper, kOfSlides, half).proof.is_proven());
}

TEST(ContactPairs, KeepTheirMarginOnceTheyHaveOpened) {
  const WaypointPath back = slides_along({{0, 0}, {-0.3, 0}, {-0.3, 0.2}, {-0.005, 0}});
  const RetimingScene where = held_beside_post({-0.3, 0});
  for (const RetimingMode mode : kAllModes) {
    const RetimedMotion retimed = retime(back, kOfSlides, where, {.mode = mode});
    // It comes back to 6 mm, which the hold would allow and the margin does not.
    ASSERT_EQ(retimed.proof.contact.verdict, Verdict::contact);
    const double t = retimed.proof.contact_time();
    EXPECT_GT(t, retimed.proof.held.at(0).to);
    EXPECT_NEAR(gap_at(controller_state(retimed.motion, 0, t).position,
                       controller_state(retimed.motion, 1, t).position),
                kMarginOfAll, 1e-5);
    EXPECT_TRUE(retime(back, kOfSlides, held_beside_post(), {.mode = mode}).proof.is_proven());
  }
}

TEST(ContactPairs, OpenAtTheirWaypointInAllModes) {
  const WaypointPath away = slides_along({{0, 0}, {-0.1, 0}, {-0.3, 0.2}, {-0.5, 0}, {-0.6, 0.3}});
  const RetimingScene where = held_beside_post({-0.1, 0});
  double before = 1e9;
  for (const RetimingMode mode : kAllModes) {
    const RetimedMotion retimed = retime(away, kOfSlides, where, {.mode = mode});
    ASSERT_TRUE(retimed.proof.is_proven());
    EXPECT_EQ(retimed.mode, mode);
    EXPECT_LE(retimed.motion.duration(), before);
    before = retimed.motion.duration();
    if (mode != RetimingMode::stop) {
      EXPECT_EQ(retimed.blends, 2u);  // Not 3: the robot rests where the pair opens.
    }
    const double open = retimed.proof.held.at(0).to;
    EXPECT_LT(open, retimed.motion.duration());
    EXPECT_NEAR(controller_state(retimed.motion, 0, open).position, -0.1, 1e-9);
    EXPECT_GE(least_gap(retimed.motion, 0.0, open), kHeld);
    EXPECT_GE(least_gap(retimed.motion, open, retimed.motion.duration()), kMarginOfAll);
  }
}

TEST(ContactPairs, HaveToBeOpenAtTheirWaypoint) {
  // The first edge ends at 9 mm, which is less than the margin.
  const WaypointPath away = slides_along({{0, 0}, {-0.008, 0}, {-0.3, 0}});
  const RetimedMotion retimed = retime(away, kOfSlides, held_beside_post({-0.008, 0}));
  EXPECT_EQ(retimed.proof.contact.verdict, Verdict::contact);
  EXPECT_NEAR(retimed.proof.contact_time(), retimed.proof.held.at(0).to, 1e-9);
  // Also where no edge is left.
  const WaypointPath single = slides_along({{0, 0}, {-0.008, 0}});
  EXPECT_FALSE(retime(single, kOfSlides, held_beside_post({-0.008, 0})).proof.is_proven());
  const WaypointPath far = slides_along({{0, 0}, {-0.3, 0}});
  EXPECT_TRUE(retime(far, kOfSlides, held_beside_post({-0.3, 0})).proof.is_proven());
}

TEST(ContactPairs, CloseAtTheGoal) {
  const WaypointPath home = slides_along({{-0.6, 0.3}, {-0.3, 0.2}, {-0.1, 0}, {0, 0}});
  const RetimingScene where = held_beside_post({-0.1, 0}, PathEnd::goal);
  for (const RetimingMode mode : kAllModes) {
    const RetimedMotion retimed = retime(home, kOfSlides, where, {.mode = mode});
    ASSERT_TRUE(retimed.proof.is_proven());
    const double from = retimed.proof.held.at(0).from;
    EXPECT_GT(from, 0.0);
    EXPECT_EQ(retimed.proof.held[0].to, retimed.motion.duration());
    EXPECT_GE(least_gap(retimed.motion, 0.0, from), kMarginOfAll);
    EXPECT_GE(least_gap(retimed.motion, from, retimed.motion.duration()), kHeld);
  }
  // Held from the last edge on alone: the pair may not be near at the start.
  const WaypointPath both = slides_along({{-0.005, 0}, {-0.3, 0.2}, {-0.1, 0}, {0, 0}});
  EXPECT_EQ(retime(both, kOfSlides, where).proof.contact.verdict, Verdict::contact_at_start);
}

/// Open at both ends: until the first rest at one place, and from the last rest at another one on.
RetimingScene open_at_both_ends(const std::vector<double>& after,
                                const std::vector<double>& before) {
  RetimingScene where = held_beside_post(after);
  where.holds.push_back(held_beside_post(before, PathEnd::goal).holds.front());
  return where;
}

TEST(ContactPairs, OpenAtBothEnds) {
  const WaypointPath round_trip =
      slides_along({{0, 0}, {-0.1, 0}, {-0.3, 0.2}, {-0.5, 0}, {-0.3, -0.2}, {-0.1, 0.01}, {0, 0}});
  const RetimingScene where = open_at_both_ends({-0.1, 0}, {-0.1, 0.01});
  for (const RetimingMode mode : kAllModes) {
    const RetimedMotion retimed = retime(round_trip, kOfSlides, where, {.mode = mode});
    ASSERT_TRUE(retimed.proof.is_proven());
    EXPECT_EQ(retimed.mode, mode);
    const double end = retimed.motion.duration();
    ASSERT_EQ(retimed.proof.held.size(), 2u);
    const double open = retimed.proof.held[0].to;
    const double closes = retimed.proof.held[1].from;
    EXPECT_LT(open, closes);
    EXPECT_EQ(retimed.proof.held[0].from, 0.0);
    EXPECT_EQ(retimed.proof.held[1].to, end);
    EXPECT_GE(least_gap(retimed.motion, 0.0, open), kHeld);
    EXPECT_GE(least_gap(retimed.motion, open, closes), kMarginOfAll);
    EXPECT_GE(least_gap(retimed.motion, closes, end), kHeld);
    const std::string text = write_trajectory(retimed.motion, TrajectoryFormat::yaml);
    const TimedMotion read = parse_timed_motion(text, "way.yaml", joined_model(where));
    EXPECT_TRUE(prove_motion(read, kOfSlides, where).is_proven());
  }
}

TEST(ContactPairs, KeepTheirMarginBetweenTwoOpenEnds) {
  const WaypointPath near = slides_along(
      {{0, 0}, {-0.1, 0}, {-0.3, 0.2}, {-0.005, 0}, {-0.3, -0.2}, {-0.1, 0.01}, {0, 0}});
  const RetimingScene where = open_at_both_ends({-0.1, 0}, {-0.1, 0.01});
  for (const RetimingMode mode : kAllModes) {
    const RetimedMotion retimed = retime(near, kOfSlides, where, {.mode = mode});
    ASSERT_EQ(retimed.proof.contact.verdict, Verdict::contact);
    EXPECT_GT(retimed.proof.contact_time(), retimed.proof.held.at(0).to);
    EXPECT_LT(retimed.proof.contact_time(), retimed.proof.held.at(1).from);
  }
}

// One place may be where the pair has opened and where its way back begins: it is open there.
TEST(ContactPairs, AreOpenWhereTwoEndsMeet) {
  for (const RetimingMode mode : kAllModes) {
    const WaypointPath there = slides_along({{0, 0}, {-0.1, 0}, {0, 0}});
    const RetimingScene where = open_at_both_ends({-0.1, 0}, {-0.1, 0});
    EXPECT_TRUE(retime(there, kOfSlides, where, {.mode = mode}).proof.is_proven());
    // At 9 mm, which each hold would allow and the margin does not.
    const WaypointPath too_near = slides_along({{0, 0}, {-0.008, 0}, {0, 0}});
    const RetimingScene never = open_at_both_ends({-0.008, 0}, {-0.008, 0});
    const RetimedMotion retimed = retime(too_near, kOfSlides, never, {.mode = mode});
    EXPECT_EQ(retimed.proof.contact.verdict, Verdict::contact);
    EXPECT_NEAR(retimed.proof.contact_time(), retimed.proof.held.at(0).to, 1e-9);
  }
  const WaypointPath swapped = slides_along({{0, 0}, {-0.1, 0}, {-0.2, 0}, {0, 0}});
  EXPECT_THROW((void)retime(swapped, kOfSlides, open_at_both_ends({-0.2, 0}, {-0.1, 0})),
               std::invalid_argument);
}

TEST(ContactPairs, AreHeldBesidePaddings) {
  RetimingScene where = held_beside_post();
  where.scene.set_padding(kBallAndPost[0], 0.02);
  EXPECT_TRUE(retime(kThereAndBack, kOfSlides, where).proof.is_proven());
  // Other pairs keep the padding: a second post is 25 mm beside the way.
  where.scene.add_body("other", make_sphere(0.05),
                       Motion::fixed({{-0.2, -0.125, 0.0}, Eigen::Quaterniond::Identity()}));
  const ExecutedProof proof = retime(kThereAndBack, kOfSlides, where).proof;
  EXPECT_EQ(proof.contact.verdict, Verdict::contact);
  EXPECT_EQ(proof.contact.pairs.at(proof.contact.first.value()).members, (BodyPair{2, 4}));
}

TEST(ContactPairs, CountTrackingErrors) {
  RetimingScene where = held_beside_post();
  where.scene.set_tracking_error(0, "x", {.angle = 0.0, .distance = 5e-5});
  EXPECT_TRUE(retime(kThereAndBack, kOfSlides, where).proof.is_proven());
  where.scene.set_tracking_error(0, "x", {.angle = 0.0, .distance = 7e-5});
  EXPECT_FALSE(retime(kThereAndBack, kOfSlides, where).proof.is_proven());
}

TEST(ContactPairs, AreProvenOfAFileThatIsReadBack) {
  const WaypointPath away = slides_along({{0, 0}, {-0.1, 0}, {-0.3, 0.2}, {-0.5, 0}});
  const RetimingScene where = held_beside_post({-0.1, 0});
  const RetimedMotion retimed = retime(away, kOfSlides, where, {.mode = RetimingMode::blend});
  const std::string text = write_trajectory(retimed.motion, TrajectoryFormat::yaml);
  const TimedMotion read = parse_timed_motion(text, "way.yaml", joined_model(where));
  const ExecutedProof proof = prove_motion(read, kOfSlides, where, {.closest = true});
  EXPECT_TRUE(proof.is_proven());
  const PairAnswer& closest = proof.contact.pairs.at(proof.contact.closest.value());
  EXPECT_EQ(closest.members, kBallAndPost);
  EXPECT_NEAR(closest.closest->distance, kStartGap, 1e-5);
  EXPECT_EQ(closest.closest->t, 0.0);
  // Without the rest nothing ends the time for which the pair is held.
  RetimingScene elsewhere = held_beside_post({-0.2, 0});
  EXPECT_THROW((void)prove_motion(read, kOfSlides, elsewhere), std::invalid_argument);
}

// Truth: on random ways about the post, in and out of the margin, what is proven holds by samples.
TEST(ContactPairs, HoldWhereverTheyAreProven) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> side(-0.25, 0.25);
  std::array<int, 2> counts{};
  for (int round = 0; round < 60; ++round) {
    WaypointPath path = slides_along({{0, 0}});
    for (int k = 0; k < 3; ++k) {
      path.waypoints.push_back({-0.2 + side(rng), side(rng)});
    }
    const bool opens = round % 2 == 0;
    const RetimingScene where = held_beside_post(opens ? path.waypoints[1] : std::vector<double>());
    const RetimedMotion retimed =
        retime(path, kOfSlides, where, {.mode = kAllModes.at(static_cast<std::size_t>(round) % 3)});
    const double end = retimed.motion.duration();
    const double open = retimed.proof.held.at(0).to;
    const double kept = std::min(least_gap(retimed.motion, 0.0, open) - kHeld,
                                 opens ? least_gap(retimed.motion, open, end) - kMarginOfAll : 1.0);
    EXPECT_EQ(retimed.proof.is_proven(), kept > 0.0) << round;
    ++counts.at(retimed.proof.is_proven() ? 1 : 0);
  }
  EXPECT_GT(counts[0], 5);
  EXPECT_GT(counts[1], 20);
}

// The place where a pair has opened may be the end of the path.
TEST(ContactPairs, OpenAtTheEndOfTheOnlyEdge) {
  for (const RetimingMode mode : kAllModes) {
    const RetimedMotion retimed = retime(slides_along({{0, 0}, {-0.3, 0}}), kOfSlides,
                                         held_beside_post({-0.3, 0}), {.mode = mode});
    EXPECT_TRUE(retimed.proof.is_proven());
  }
}

}  // namespace
}  // namespace firstcontact::test
