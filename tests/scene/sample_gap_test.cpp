#include <firstcontact/scene/sample_gap.h>

#include <limits>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/read_scene.h>
#include <firstcontact/scene/write_result.h>

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
