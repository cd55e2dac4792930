// What OMPL makes of paths: shortcuts, splines, hybrids and repairs are proven again.

#include <gtest/gtest.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathHybridization.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "planning/ompl_proven.h"
#include "planning/plan_cases.h"
#include "support/random.h"

namespace firstcontact::test {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// A space with two places on both sides of an obstacle.
struct Across {
  std::string name;
  PlanScene scene;
  Configuration start;
  Configuration goal;
};

std::vector<Across> both_sides() {
  RobotScene sheet;
  sheet.add_body("sheet", make_box({1e-5, 1.0, 1.0}));
  std::vector<Across> all;
  all.push_back({"joints", with_gantry(thin_wall(0.5)), {-1.5, 1.2, -0.7}, {1.5, 1.1, -0.9}});
  all.push_back({"body",
                 with_bar(std::move(sheet), {0.05, 0.3, 0.05}),
                 {-0.8, 0.1, 0.0, 1.0, 0.0, 0.0, 0.0},
                 {0.8, -0.1, 0.0, 0.8, 0.0, 0.0, 0.6}});
  return all;
}

/// A path of RRT, which has many waypoints.
og::PathGeometricPtr found_path(const Proven& proven, const Across& across) {
  og::RRT planner(proven.si);
  planner.setRange(0.3);
  return solve(planner, problem_between(proven, across.start, across.goal));
}

TEST(OmplPaths, AreProvenAfterEachStepOfTheSimplifier) {
  using Step = std::function<void(og::PathSimplifier&, og::PathGeometric&)>;
  const std::vector<std::pair<std::string, Step>> steps = {
      {"reduceVertices", [](auto& by, auto& path) { by.reduceVertices(path); }},
      {"shortcutPath", [](auto& by, auto& path) { by.shortcutPath(path, 100, 100); }},
      {"collapseCloseVertices", [](auto& by, auto& path) { by.collapseCloseVertices(path); }},
      {"smoothBSpline", [](auto& by, auto& path) { by.smoothBSpline(path, 4); }},
      {"perturbPath", [](auto& by, auto& path) { by.perturbPath(path, 0.2, 50, 50); }},
      {"simplifyMax", [](auto& by, auto& path) { by.simplifyMax(path); }}};
  for (const Across& across : both_sides()) {
    const Proven proven(across.scene);
    const og::PathGeometricPtr found = found_path(proven, across);
    ASSERT_NE(found, nullptr) << across.name;
    ASSERT_EQ(unproven_edge(proven, *found), std::nullopt) << across.name;
    og::PathSimplifier simplifier(proven.si);
    og::PathGeometric all = *found;
    for (const auto& [name, step] : steps) {
      og::PathGeometric one = *found;
      step(simplifier, one);
      EXPECT_EQ(unproven_edge(proven, one), std::nullopt) << across.name << ", " << name;
      EXPECT_LE(one.length(), found->length() * (1.0 + 1e-12)) << across.name << ", " << name;
      step(simplifier, all);
      EXPECT_EQ(unproven_edge(proven, all), std::nullopt) << across.name << ", all up to " << name;
    }
    EXPECT_LT(all.length(), 0.9 * found->length()) << across.name;
  }
}

TEST(OmplPaths, AreProvenAsHybrids) {
  for (const Across& across : both_sides()) {
    const Proven proven(across.scene);
    og::PathHybridization hybrids(proven.si);
    double least = 1e9;
    unsigned int tried = 0;
    for (int k = 0; k < 6; ++k) {
      const og::PathGeometricPtr found = found_path(proven, across);
      ASSERT_NE(found, nullptr) << across.name;
      least = std::min(least, found->length());
      tried += hybrids.recordPath(found, true);
    }
    hybrids.computeHybridPath();
    ASSERT_NE(hybrids.getHybridPath(), nullptr) << across.name;
    EXPECT_GT(tried, 0u) << across.name;
    EXPECT_EQ(unproven_edge(proven, *hybrids.getHybridPath()), std::nullopt) << across.name;
    EXPECT_LE(hybrids.getHybridPath()->length(), least * (1.0 + 1e-12)) << across.name;
  }
}

TEST(OmplPaths, AreProvenOnceRepaired) {
  for (const Across& across : both_sides()) {
    const Proven proven(across.scene);
    const og::PathGeometricPtr found = found_path(proven, across);
    ASSERT_NE(found, nullptr) << across.name;
    const OmplStates states(*proven.space, proven.edges->space());
    Random random(7);
    const std::size_t pose = across.name == "body" ? 3 : across.start.size();
    int broken = 0;
    int repaired = 0;
    for (int k = 0; k < 40; ++k) {
      og::PathGeometric path = *found;
      // Another interior waypoint each time, moved by up to 0.5 m.
      const std::size_t count = path.getStateCount();
      ASSERT_GT(count, 2u);
      ob::State* moved =
          path.getState(1 + static_cast<unsigned int>(k) % static_cast<unsigned int>(count - 2));
      Configuration q = states.read(moved);
      for (std::size_t c = 0; c < std::min<std::size_t>(pose, 3); ++c) {
        q[c] += random.uniform(-0.5, 0.5);
      }
      states.write(q, moved);
      const auto [was_valid, is_valid] = path.checkAndRepair(100);
      broken += was_valid ? 0 : 1;
      if (is_valid) {
        repaired += was_valid ? 0 : 1;
        EXPECT_EQ(unproven_edge(proven, path), std::nullopt) << across.name << " " << k;
      }
      EXPECT_EQ(path.check(), !unproven_edge(proven, path).has_value()) << across.name << " " << k;
    }
    EXPECT_GT(broken, 0) << across.name;
    EXPECT_GT(repaired, 0) << across.name;
  }
}

}  // namespace
}  // namespace firstcontact::test
