// Shortcuts that pass corners at about the tolerance: they stay proven, and no path gets longer.

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/plan_work.h>
#include <firstcontact/planning/detail/shorten_path.h>

#include "planning/plan_cases.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

constexpr int kSteps = 4;
constexpr double kApart = 0.8;     // [m]  From step to step.
constexpr double kHalfCube = 0.1;  // [m]  Of the gantry.

/// Steps under the way of the gantry, with a corner between each two; [m] how far each is below it.
PlanScene over_steps(const std::vector<double>& gaps) {
  RobotScene scene;
  for (int k = 0; k < kSteps; ++k) {
    const double x = kApart * (k - 0.5 * (kSteps - 1));
    scene.add_body("step" + std::to_string(k), make_box({0.2, 2.0, 4.0}),
                   resting_at({x, -1.0 - kHalfCube - gaps[static_cast<std::size_t>(k)], 0.0}));
  }
  return with_gantry(std::move(scene));
}

/// A way that climbs over each step.
std::vector<Configuration> climbing() {
  std::vector<Configuration> path = {{-1.9, 0.0, 0.0}};
  for (int k = 0; k < kSteps; ++k) {
    const double x = kApart * (k - 0.5 * (kSteps - 1));
    path.push_back({x, 0.5, 0.1});
    path.push_back({x + 0.5 * kApart, 0.0, 0.0});
  }
  path.push_back({1.9, 0.0, 0.0});
  return path;
}

/// A path that was shortened, and its cost before and after.
struct Shortened {
  std::vector<Configuration> path;
  double before = 0.0;
  double after = 0.0;
};

Shortened shortened(const PlanScene& scene, std::uint64_t seed) {
  const PlanOptions options;
  const EdgeChecker checker(scene,
                            {.tolerance = options.tolerance,
                             .extra_clearance = options.extra_clearance + 2.0 * options.tolerance});
  const auto begin = detail::PlanWork::Clock::now();
  detail::PlanWork work(checker, options, begin, begin + std::chrono::hours(1));
  Shortened result{.path = climbing()};
  result.before = detail::cost_of(scene.space, result.path);
  RandomNumbers random(seed);
  detail::shorten_path(work, result.path, 200, random);
  result.after = detail::cost_of(scene.space, result.path);
  return result;
}

TEST(GrazingShortcuts, StayProvenAndNeverCostMore) {
  Random random(12);
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(rounds(40, 4)); ++seed) {
    std::vector<double> gaps;
    for (int k = 0; k < kSteps; ++k) {
      gaps.push_back((random.chance(0.3) ? -1.0 : 1.0) * random.logarithmic(1e-7, 1e-5));
    }
    const PlanScene scene = over_steps(gaps);
    const Shortened found = shortened(scene, seed);
    EXPECT_LE(found.after, found.before) << seed;
    EXPECT_EQ(found.path.front(), climbing().front());
    EXPECT_EQ(found.path.back(), climbing().back());
    const EdgeChecker again(scene);
    const EdgeChecker strict(scene, {.tolerance = 1e-10, .extra_clearance = 0.0});
    for (std::size_t k = 0; k + 1 < found.path.size(); ++k) {
      EXPECT_EQ(again.check(found.path[k], found.path[k + 1]).verdict, EdgeVerdict::free) << seed;
      EXPECT_EQ(strict.check(found.path[k], found.path[k + 1]).verdict, EdgeVerdict::free) << seed;
    }
  }
}

// Tight: what is 1e-5 m away leaves the straight way, and what is in it by as little does not.
TEST(GrazingShortcuts, AreTakenWhereTheyAreFree) {
  const double straight = 3.8;
  EXPECT_EQ(shortened(over_steps(std::vector<double>(kSteps, 1e-5)), 1).after, straight);
  EXPECT_GT(shortened(over_steps(std::vector<double>(kSteps, -1e-5)), 1).after, straight);
}

}  // namespace
}  // namespace firstcontact::test
