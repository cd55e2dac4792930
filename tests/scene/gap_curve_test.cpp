// The gap of moving balls is known at each time: what is sampled, proven and drawn agrees with it.

#include <firstcontact/scene/gap_curve.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/gap_bound.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/parallel_sampling.h>
#include <firstcontact/scene/sample_gap.h>

#include "scene/load_text.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::load_text;
using test::moving_ball;

/// A ball passes another one: their centres are (3 - 6 t, 1) apart, their radii 0.25 and 0.5.
const std::string kPassing = moving_ball("rests", "0.25", "[0, 0, 0]", "[0, 0, 0]") + "," +
                             moving_ball("passes", "0.5", "[3, 1, 0]", "[-6, 0, 0]");

double passing_gap(double t) { return std::hypot(3.0 - 6.0 * t, 1.0) - 0.75; }

SceneResult check_all(const LoadedScene& loaded, const CheckOptions& options = {}) {
  ManyBodiesWorkspace workspace;
  return check_scene(loaded, workspace, options);
}

std::vector<GapSample> samples_of(const LoadedScene& loaded, const std::vector<double>& times) {
  Workspace workspace;
  return sample_gap(loaded, times, workspace);
}

/// The polyline at t.
double value_at(const std::vector<GapPoint>& points, double t) {
  const auto after = std::find_if(points.begin(), points.end(),
                                  [&](const GapPoint& point) { return point.t >= t; });
  if (after == points.begin() || after->t == t) {
    return after->distance;
  }
  const GapPoint& before = *(after - 1);
  return std::lerp(before.distance, after->distance, (t - before.t) / (after->t - before.t));
}

TEST(SampleGap, AgreesWithTheClosedFormOfBalls) {
  const LoadedScene loaded = load_text(test::scene(kPassing));
  for (const GapSample& sample : samples_of(loaded, even_times(301))) {
    EXPECT_NEAR(sample.distance, passing_gap(sample.t), 1e-14) << sample.t;
    EXPECT_LE(sample.lower_bound, passing_gap(sample.t) + 1e-15) << sample.t;
    EXPECT_NEAR(sample.lower_bound, passing_gap(sample.t), 1e-12) << sample.t;
    EXPECT_FALSE(sample.contact);
  }
}

TEST(SampleGap, IsThatOfTheNearestPairThatIsTested) {
  const std::string third = "," + moving_ball("near", "0.5", "[3, 0.9, 0]", "[-6, 0, 0]");
  const std::string rules = R"("pairs": {"ignore": [["near", "rests"], ["near", "passes"]]})";
  const LoadedScene ignored = load_text(test::scene(kPassing + third, rules));
  for (const GapSample& sample : samples_of(ignored, even_times(11))) {
    EXPECT_NEAR(sample.distance, passing_gap(sample.t), 1e-14);
  }
  const LoadedScene none =
      load_text(test::scene(kPassing, R"("pairs": {"ignore": [["passes", "rests"]]})"));
  for (const GapSample& sample : samples_of(none, even_times(3))) {
    EXPECT_TRUE(std::isinf(sample.distance));
    EXPECT_FALSE(sample.contact);
  }
}

// Also where a pair far away has the greater margin, and one nearby is not within its own.
TEST(SampleGap, IsInContactWithinTheMarginOfAPair) {
  const std::string far = "," + moving_ball("far", "0.5", "[0, -9, 0]", "[0, 0, 0]");
  const LoadedScene loaded =
      load_text(test::scene(kPassing + far, R"("pairs": {"margin": [["far", "rests", 8.25]]})"));
  for (const GapSample& sample : samples_of(loaded, even_times(5))) {
    EXPECT_TRUE(sample.contact) << sample.t;
    EXPECT_NEAR(sample.distance, passing_gap(sample.t), 1e-14);
  }
  const LoadedScene alone = load_text(test::scene(kPassing, R"("options": {"margin": 0.5})"));
  for (const GapSample& sample : samples_of(alone, even_times(101))) {
    EXPECT_EQ(sample.contact, passing_gap(sample.t) <= 0.5) << sample.t;
  }
}

TEST(SampleGap, RefusesTimesOutsideOfTheStep) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::string& bodies : {kPassing, moving_ball("a", "1", "[0, 0, 0]", "[0, 0, 0]")}) {
    const LoadedScene loaded = load_text(test::scene(bodies));
    for (const double wrong : {-1e-9, 1.0 + 1e-9, nan}) {
      EXPECT_THROW((void)samples_of(loaded, {0.5, wrong}), std::invalid_argument) << wrong;
    }
  }
}

TEST(SampleInParallel, GivesTheSamplesOfOneProcessor) {
  const LoadedScene loaded = load_text(test::scene(kPassing));
  const std::vector<double> times = even_times(77);
  const std::vector<GapSample> alone = samples_of(loaded, times);
  const std::vector<GapSample> samples = sample_in_parallel(loaded, times);
  ASSERT_EQ(samples.size(), alone.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    EXPECT_EQ(samples[k].t, times[k]);
    EXPECT_EQ(samples[k].distance, alone[k].distance);
    EXPECT_NEAR(samples[k].lower_bound, alone[k].lower_bound, 1e-12);
    EXPECT_EQ(samples[k].contact, alone[k].contact);
  }
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(sample_in_parallel(loaded, times, stop.get_token()).empty());
}

// Between its samples the curve is drawn as lines: they are off by little of its height.
TEST(GapCurve, IsDrawnWithinATwentiethOfItsHeight) {
  const LoadedScene loaded = load_text(test::scene(kPassing));
  const double focus = 0.123456789;
  const std::vector<GapSample> curve = gap_curve(loaded, focus);
  EXPECT_EQ(curve.front().t, 0.0);
  EXPECT_EQ(curve.back().t, 1.0);
  EXPECT_EQ(std::count_if(curve.begin(), curve.end(),
                          [&](const GapSample& sample) { return sample.t == focus; }),
            1);
  double height = 0.0;
  for (const GapSample& sample : curve) {
    height = std::max(height, sample.distance);
  }
  for (std::size_t k = 1; k < curve.size(); ++k) {
    ASSERT_LT(curve[k - 1].t, curve[k].t);
    const double middle = 0.5 * (curve[k - 1].t + curve[k].t);
    const double drawn = 0.5 * (curve[k - 1].distance + curve[k].distance);
    EXPECT_NEAR(drawn, passing_gap(middle), 0.05 * height) << middle;
  }
}

// A turn of 20 rad: a bar's end comes near the ball seven times. More samples where it bends.
TEST(GapCurve, HasMoreSamplesWhereItBends) {
  const std::string bar = R"({"name": "bar", "shape": {"capsule": {"radius": 0.1, "length": 2}},
      "motion": {"type": "constant_velocity", "rotation_vector": [200, 0, 0], "translation": [0, 0, 0]}})";
  const LoadedScene bent =
      load_text(test::scene(bar + "," + moving_ball("b", "0.1", "[0, 1.4, 0]", "[0, 0, 0]")));
  const LoadedScene straight =
      load_text(test::scene(moving_ball("a", "0.1", "[0, 0, 0]", "[0, 0, 0]") + "," +
                            moving_ball("b", "0.1", "[1, 0, 0]", "[1, 0, 0]")));
  EXPECT_EQ(gap_curve(straight, 0.5).size(), 129u);
  EXPECT_EQ(gap_curve(straight, 0.3).size(), 130u);
  EXPECT_GT(gap_curve(bent, 0.5).size(), 200u);
}

TEST(GapCurve, EndsWithFewerSamplesOnAStop) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(gap_curve(load_text(test::scene(kPassing)), 0.5, stop.get_token()).empty());
}

TEST(TimeOfInterest, IsTheContactOrTheClosestApproach) {
  const LoadedScene misses = load_text(test::scene(kPassing));
  EXPECT_NEAR(time_of_interest(check_all(misses, {.closest = true})), 0.5, 1e-2);
  EXPECT_EQ(time_of_interest(check_all(misses)), 1.0);
  const LoadedScene hits = load_text(test::scene(kPassing, R"("options": {"margin": 1})"));
  const SceneResult result = check_all(hits, {.closest = true});
  EXPECT_EQ(time_of_interest(result), result.t);
  // |(3 - 6 t, 1)| = 1.75 m.
  EXPECT_NEAR(result.t, (3.0 - std::sqrt(1.75 * 1.75 - 1.0)) / 6.0, 1e-5);
}

TEST(GreatestGapRate, IsTheSumOfTheTwoGreatestSpeeds) {
  const auto rate = [](const std::string& bodies) {
    return greatest_gap_rate(load_text(test::scene(bodies)).bodies);
  };
  const std::string slow = moving_ball("slow", "1", "[0, 0, 0]", "[0, 0.5, 0]");
  const std::string a = moving_ball("a", "1", "[0, 5, 0]", "[0, 3, 4]");
  const std::string b = moving_ball("b", "1", "[0, 9, 0]", "[2, 0, 0]");
  EXPECT_NEAR(rate(slow + "," + a + "," + b), 7.0, 1e-9);
  EXPECT_NEAR(rate(b + "," + slow), 2.5, 1e-9);
  EXPECT_GE(rate(b + "," + slow), 2.5);
  EXPECT_EQ(rate(moving_ball("a", "1", "[0, 0, 0]", "[0, 0, 0]")), 0.0);
  // The far corner of a box that turns about an axis through its centre: half the diagonal.
  const std::string box = R"({"name": "box", "shape": {"box": {"size": [2, 2, 1]}}, "motion":
      {"type": "constant_velocity", "rotation_vector": [0, 0, 3], "translation": [0, 0, 0]}})";
  EXPECT_NEAR(rate(box), 3.0 * 1.5, 1e-9);
  EXPECT_GE(rate(box), 3.0 * std::numbers::sqrt2);
  // About an axis 10 m from it.
  const std::string orbit = R"({"name": "orbit", "shape": {"sphere": {"radius": 0.5}}, "motion":
      {"type": "screw", "axis_point": [10, 0, 0], "axis_direction": [0, 0, 1], "angle": 2,
       "translation": 0}})";
  EXPECT_NEAR(rate(orbit), 2.0 * 10.5, 1e-9);
}

// Certified: at no time is the gap below the polyline. Tight: with many samples it is near.
TEST(GapLowerBound, HoldsForBallsAndGetsNearThem) {
  const LoadedScene loaded = load_text(test::scene(kPassing));
  const SceneResult result = check_all(loaded, {.closest = true});
  EXPECT_NEAR(result.clearance, 0.25, 1e-5);
  for (const std::size_t count : {2u, 3u, 10u, 1000u}) {
    const std::vector<GapPoint> bound =
        gap_lower_bound(loaded, result, samples_of(loaded, even_times(count)));
    for (const double t : even_times(2000)) {
      EXPECT_LE(value_at(bound, t), passing_gap(t)) << count << " at " << t;
      EXPECT_GE(value_at(bound, t), 0.25 - 1e-5) << count << " at " << t;
      if (count == 1000) {
        EXPECT_GE(value_at(bound, t), passing_gap(t) - 6.0 / 999.0);
      }
    }
  }
}

// With a margin the clearance is proven up to the contact, and lost after it.
TEST(GapLowerBound, ClaimsTheClearanceOnlyUntilTheContact) {
  const LoadedScene loaded = load_text(test::scene(kPassing, R"("options": {"margin": 1})"));
  const SceneResult result = check_all(loaded);
  ASSERT_EQ(result.verdict, Verdict::contact);
  EXPECT_NEAR(result.clearance, 1.0, 1e-5);
  for (const std::size_t count : {2u, 5u, 50u}) {
    const std::vector<GapPoint> bound =
        gap_lower_bound(loaded, result, samples_of(loaded, even_times(count)));
    for (const double t : even_times(1000)) {
      EXPECT_LE(value_at(bound, t), passing_gap(t)) << count << " at " << t;
    }
  }
}

TEST(GapLowerBound, IsNothingWhereNoPairIsTested) {
  const LoadedScene loaded =
      load_text(test::scene(kPassing, R"("pairs": {"ignore": [["passes", "rests"]]})"));
  const std::vector<GapSample> samples = samples_of(loaded, even_times(3));
  EXPECT_TRUE(gap_lower_bound(loaded, check_all(loaded), samples).empty());
}

// After a contact nothing is proven but what samples give: never below zero.
TEST(GapLowerBound, IsNeverNegative) {
  const std::string bodies = moving_ball("a", "1", "[0, 0, 0]", "[0, 0, 0]") + "," +
                             moving_ball("b", "1", "[5, 0, 0]", "[-10, 0, 0]");
  const LoadedScene loaded = load_text(test::scene(bodies));
  const SceneResult result = check_all(loaded);
  for (const std::size_t count : {2u, 7u, 100u}) {
    const std::vector<GapPoint> bound =
        gap_lower_bound(loaded, result, samples_of(loaded, even_times(count)));
    for (const double t : even_times(500)) {
      EXPECT_GE(value_at(bound, t), 0.0);
      EXPECT_LE(value_at(bound, t), std::max(0.0, std::abs(5.0 - 10.0 * t) - 2.0) + 1e-12) << t;
    }
  }
}

}  // namespace
}  // namespace firstcontact
