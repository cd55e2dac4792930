#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/sample_gap.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/gap_bound.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_result.h>

#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::body;
using test::falling;
using test::scene;

/// A triangle falls 4 m through another one: gap |1 - 4 t|.
LoadedScene fall() {
  ShapeCache cache;
  return load_scene(
      parse_scene(scene(body("floor") + "," + body("stone", falling("1", "-4"))), "s"), cache);
}

TEST(SampleGap, IsTheDistanceAtEachTime) {
  Workspace workspace;
  const std::vector<double> times{0.0, 0.125, 0.25, 0.5, 1.0};
  const std::vector<GapSample> samples = sample_gap(fall(), times, workspace);
  ASSERT_EQ(samples.size(), 5u);
  const double expected[] = {1.0, 0.5, 0.0, 1.0, 3.0};
  for (std::size_t k = 0; k < samples.size(); ++k) {
    EXPECT_EQ(samples[k].t, times[k]);
    EXPECT_NEAR(samples[k].distance, expected[k], 1e-15);
    EXPECT_EQ(samples[k].contact, k == 2);
  }
}

TEST(SampleGap, MissesWhatLiesBetween) {
  Workspace workspace;
  const SamplingReport report =
      report_sampling(4.5, sample_gap(fall(), times_at_rate(4.5, 1.0), workspace));
  EXPECT_EQ(report.samples, 5u);
  EXPECT_EQ(report.in_contact, 0u);
  EXPECT_NEAR(report.least->distance, 1.0 / 9.0, 1e-15);
}

SceneResult check(const LoadedScene& loaded) {
  ManyBodiesWorkspace workspace;
  return check_scene(loaded, workspace);
}

/// The value of a polyline at t.
double at(const std::vector<GapPoint>& points, double t) {
  const auto after = std::find_if(points.begin(), points.end(),
                                  [&](const GapPoint& point) { return point.t >= t; });
  if (after == points.begin() || after->t == t) {
    return after->distance;
  }
  const GapPoint& before = *(after - 1);
  return before.distance +
         (after->distance - before.distance) * (t - before.t) / (after->t - before.t);
}

TEST(GapLowerBound, IsNeverAboveTheGapAndTouchesItAtTheSamples) {
  // Turns as it falls past the floor's edge, so that the gap is no straight line.
  const std::string turn = R"("motion": {"type": "constant_velocity",
      "from": {"position": [1.2, 0.3, 1]}, "translation": [0.1, 0, -2], "rotation_vector": [1, 4, 2]})";
  ShapeCache cache;
  const LoadedScene loaded =
      load_scene(parse_scene(scene(body("floor") + "," + body("stone", turn)), "s"), cache);
  Workspace workspace;
  for (const std::size_t count : {2u, 5u, 33u, 257u}) {
    const std::vector<GapSample> samples = sample_gap(loaded, even_times(count), workspace);
    SceneResult nothing_known;
    const std::vector<GapPoint> bound = gap_lower_bound(loaded, nothing_known, samples);
    ASSERT_TRUE(std::is_sorted(bound.begin(), bound.end(),
                               [](const GapPoint& x, const GapPoint& y) { return x.t < y.t; }));
    for (const GapSample& sample : sample_gap(loaded, even_times(1001), workspace)) {
      EXPECT_LE(at(bound, sample.t), sample.distance + 1e-12) << sample.t;
      if (count == 257) {
        EXPECT_GE(at(bound, sample.t), sample.distance - 0.08);
      }
    }
    for (const GapSample& sample : samples) {
      EXPECT_NEAR(at(bound, sample.t), sample.distance, 1e-9);
    }
  }
}

TEST(GapLowerBound, IsAtLeastTheMarginWhereThatIsProven) {
  ShapeCache cache;
  const LoadedScene loaded =
      load_scene(parse_scene(scene(body("floor") + "," + body("stone", falling("1", "-0.5")),
                                   R"("options": {"margin": 0.4})"),
                             "s"),
                 cache);
  Workspace workspace;
  const std::vector<GapSample> few = sample_gap(loaded, even_times(2), workspace);
  for (const GapPoint& point : gap_lower_bound(loaded, check(loaded), few)) {
    EXPECT_GE(point.distance, 0.4 * (1.0 - 1e-9));
  }
}

// The whole gap of |1 - 4 t| is made of cones of rate 4.
TEST(GapLowerBound, IsTightForAFall) {
  const LoadedScene loaded = fall();
  EXPECT_NEAR(greatest_gap_rate(loaded.bodies), 4.0, 1e-6);
  Workspace workspace;
  const std::vector<GapSample> samples = sample_gap(loaded, std::vector{0.0, 1.0}, workspace);
  const std::vector<GapPoint> bound = gap_lower_bound(loaded, check(loaded), samples);
  for (const double t : {0.0, 0.1, 0.25, 0.3, 0.9, 1.0}) {
    EXPECT_NEAR(at(bound, t), std::abs(1.0 - 4.0 * t), 1e-6);
  }
}

TEST(SampleGap, EndsOnAStop) {
  Workspace workspace;
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(sample_gap(fall(), even_times(5), workspace, stop.get_token()).empty());
}

TEST(EvenTimes, ReachBothEnds) {
  EXPECT_EQ(even_times(5), (std::vector{0.0, 0.25, 0.5, 0.75, 1.0}));
  EXPECT_EQ(even_times(0), (std::vector{0.0, 1.0}));
}

TEST(TimesAtRate, BeginAtTheStartAndStayInside) {
  EXPECT_EQ(times_at_rate(2.0, 1.0), (std::vector{0.0, 0.5, 1.0}));
  EXPECT_EQ(times_at_rate(240.0, 0.05).size(), 13u);
  EXPECT_EQ(times_at_rate(1.0, 0.5), (std::vector{0.0}));
  for (const double t : times_at_rate(1000.0, 0.3)) {
    EXPECT_LE(t, 1.0);
  }
}

TEST(TimesAtRate, RefusesWhatIsNoRate) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double rate : {0.0, -1.0, 1e9, nan}) {
    EXPECT_THROW((void)times_at_rate(rate, 1.0), std::invalid_argument) << rate;
  }
}

}  // namespace
}  // namespace firstcontact
