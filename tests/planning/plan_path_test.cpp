// Paths: proven edge by edge, kept to the bit at their ends, and never where there is none.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/plan_path.h>

#include "planning/plan_cases.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

const Configuration kBefore = {-1.5, 1.2, -0.7};
const Configuration kBehind = {1.5, 1.1, -0.9};

std::string message_of(const PlanScene& scene, const Configuration& start,
                       const std::vector<Configuration>& goals, const PlanOptions& options = {}) {
  try {
    (void)plan_path(scene, start, goals, options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expect_proven(const PlanScene& scene, const PlanResult& result, const Configuration& start,
                   const Configuration& goal) {
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  ASSERT_EQ(result.path.front(), start);
  ASSERT_EQ(result.path.back(), goal);
  ASSERT_EQ(result.clearances.size(), result.path.size() - 1);
  const EdgeChecker fresh(scene);
  for (std::size_t k = 0; k + 1 < result.path.size(); ++k) {
    const EdgeAnswer answer = fresh.check_closely(result.path[k], result.path[k + 1]);
    ASSERT_EQ(answer.verdict, EdgeVerdict::free) << k;
    EXPECT_NEAR(answer.clearance.value(), result.clearances[k].value(), 2e-6) << k;
  }
}

/// A box with walls 0.6 m from the origin, and a window of 0.5 m in one of them.
RobotScene boxed_in() {
  RobotScene scene;
  const auto add = [&](const Vector3d& size, const Vector3d& at) {
    scene.add_body("wall " + std::to_string(scene.size()), make_box(size), resting_at(at));
  };
  for (const double side : {-1.0, 1.0}) {
    add({1.2, 1.2, 0.02}, {0.0, 0.0, 0.6 * side});
    add({1.2, 0.02, 1.2}, {0.0, 0.6 * side, 0.0});
    add({0.02, 1.2, 0.35}, {-0.6, 0.0, 0.425 * side});
    add({0.02, 0.35, 1.2}, {-0.6, 0.425 * side, 0.0});
  }
  add({0.02, 1.2, 1.2}, {0.6, 0.0, 0.0});
  return scene;
}

// Two windows, and corners between them: a path of random places is seldom short.
TEST(PlanPath, LazyPrmIsNoLongerThanRrtConnect) {
  const PlanScene scene = with_gantry(boxed_in());
  const Configuration inside = {0.0, 0.1, -0.1};
  double connected = 0.0;
  double lazy = 0.0;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(rounds(10, 3)); ++seed) {
    const PlanResult first = plan_path(scene, kBehind, {inside}, {.seed = seed});
    const PlanResult result =
        plan_path(scene, kBehind, {inside}, {.planner = Planner::lazy_prm_star, .seed = seed});
    expect_proven(scene, result, kBehind, inside);
    connected += first.cost;
    lazy += result.cost;
  }
  EXPECT_LT(lazy, 1.0001 * connected);
}

// Equal goals are places without a way between them: their graph once had a path without an end.
TEST(PlanPath, LazyPrmTakesAGoalThatIsNamedTwice) {
  const PlanScene scene = with_gantry(boxed_in());
  const Configuration inside = {0.0, 0.1, -0.1};
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(rounds(3, 1)); ++seed) {
    const PlanResult result = plan_path(scene, kBehind, {inside, inside, inside},
                                        {.planner = Planner::lazy_prm_star, .seed = seed});
    expect_proven(scene, result, kBehind, inside);
  }
}

// Where more tries help, the default takes more of them.
TEST(PlanPath, ShortcutsGoOnWhileTheyHelp) {
  const PlanScene scene = with_gantry(boxed_in());
  const Configuration inside = {0.0, 0.1, -0.1};
  double by_default = 0.0;
  double at_most = 0.0;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(rounds(20, 3)); ++seed) {
    by_default += plan_path(scene, kBehind, {inside}, {.seed = seed}).cost;
    at_most += plan_path(scene, kBehind, {inside}, {.seed = seed, .shortcuts = 5000}).cost;
  }
  RecordProperty("ratio", std::to_string(by_default / at_most));
  EXPECT_LT(by_default, 1.08 * at_most);
}

TEST(PlanPath, FindsItsWayThroughAWindow) {
  const PlanScene scene = with_gantry(thin_wall(0.4));
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(rounds(20, 3)); ++seed) {
    const PlanResult result = plan_path(scene, kBefore, {kBehind}, {.seed = seed});
    expect_proven(scene, result, kBefore, kBehind);
    EXPECT_LE(result.cost, result.statistics.first_cost.value());
    EXPECT_GE(result.cost, scene.space.distance(kBefore, kBehind));
    EXPECT_EQ(result.goal, 0u);
    EXPECT_EQ(result.distance_to_goal, 0.0);
  }
}

TEST(PlanPath, TurnsABarThroughASlit) {
  // The bar is longer than the window is wide: it has to go through along its length.
  const PlanScene scene = with_bar(thin_wall(0.25), {0.05, 0.6, 0.05});
  const Configuration start = {-0.8, 0.2, 0.1, 1.0, 0.0, 0.0, 0.0};
  const Configuration goal = {0.8, -0.1, 0.2, 1.0, 0.0, 0.0, 0.0};
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(rounds(5, 1)); ++seed) {
    const PlanResult result = plan_path(scene, start, {goal}, {.seed = seed});
    expect_proven(scene, result, start, goal);
  }
}

// Most samples lie behind the walls of a box around the start; edges towards them are blocked.
TEST(PlanPath, SparesEdgesThatLeadNowhere) {
  const PlanScene scene = with_gantry(boxed_in());
  std::size_t edges = 0;
  const int seeds = 20;
  for (int seed = 1; seed <= seeds; ++seed) {
    const PlanResult result = plan_path(scene, {0.0, 0.0, 0.0}, {kBehind},
                                        {.seed = static_cast<std::uint64_t>(seed), .shortcuts = 0});
    ASSERT_EQ(result.verdict, PlanVerdict::proven) << seed;
    edges += result.statistics.edges_checked;
  }
  EXPECT_LT(edges, 34'000u);  // 25,972; without domains 42,097.
}

// One wall of 10 um across any place of a path, and its edge is not proven any more.
TEST(PlanPath, IsProvenOnlyWhereNothingIsInTheWay) {
  const PlanScene scene = with_gantry(thin_wall(0.4));
  const PlanResult result = plan_path(scene, kBefore, {kBehind});
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  Random random(5);
  const int tries = rounds(200, 20);
  int blocked = 0;
  for (int k = 0; k < tries; ++k) {
    const auto edge =
        static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(result.path.size() - 1)));
    const Configuration place =
        scene.space.interpolate(result.path[edge], result.path[edge + 1], random.uniform(0.0, 1.0));
    RobotScene walled = thin_wall(0.4);
    walled.add_body("across", make_box({0.5, 0.5, 1e-5}),
                    Motion::fixed({{place[0], place[1], place[2]}, random.rotation()}));
    const EdgeChecker checker(with_gantry(std::move(walled)));
    const EdgeAnswer answer = checker.check(result.path[edge], result.path[edge + 1]);
    blocked += answer.verdict == EdgeVerdict::blocked ? 1 : 0;
  }
  EXPECT_EQ(blocked, tries);
}

TEST(PlanPath, IsTheSameForASeed) {
  const PlanScene scene = with_gantry(thin_wall(0.4));
  const PlanResult first = plan_path(scene, kBefore, {kBehind}, {.seed = 7, .threads = 1});
  const PlanResult second = plan_path(scene, kBefore, {kBehind}, {.seed = 7, .threads = 2});
  EXPECT_EQ(first.path, second.path);
  EXPECT_EQ(first.clearances, second.clearances);
  EXPECT_EQ(first.cost, second.cost);
  EXPECT_EQ(first.statistics.edges_checked, second.statistics.edges_checked);
  EXPECT_NE(plan_path(scene, kBefore, {kBehind}, {.seed = 8}).path, first.path);
}

TEST(PlanPath, HasNoAnswerWhereThereIsNoWay) {
  // The window is as wide as the cube, less the two micrometres that a search keeps.
  const PlanScene closed = with_gantry(thin_wall(0.1));
  const PlanResult result = plan_path(closed, kBefore, {kBehind}, {.time = 0.2});
  EXPECT_EQ(result.verdict, PlanVerdict::none);
  EXPECT_TRUE(result.path.empty());
  ASSERT_FALSE(result.statistics.blocked.empty());
  std::size_t before = std::numeric_limits<std::size_t>::max();
  for (const BlockingPair& blocking : result.statistics.blocked) {
    EXPECT_LE(blocking.count, before);
    before = blocking.count;
    EXPECT_EQ(closed.scene.name(blocking.members[1]), "gantry/tool");
  }
}

TEST(PlanPath, ComesAsNearAsItMayWhereThatIsAsked) {
  const PlanScene closed = with_gantry(thin_wall(0.0));
  const PlanResult result =
      plan_path(closed, kBefore, {kBehind}, {.time = 0.1, .approximate = true});
  ASSERT_EQ(result.verdict, PlanVerdict::approximate);
  EXPECT_EQ(result.path.front(), kBefore);
  EXPECT_LT(result.path.back()[0], -0.1);
  EXPECT_EQ(result.goal, std::nullopt);
  EXPECT_NEAR(result.distance_to_goal, closed.space.distance(result.path.back(), kBehind), 1e-12);
  EXPECT_LT(result.distance_to_goal, closed.space.distance(kBefore, kBehind));
}

TEST(PlanPath, IsOnePlaceWhereTheStartIsAGoal) {
  const PlanScene scene = with_gantry(thin_wall(0.0));
  const PlanResult result = plan_path(scene, kBefore, {kBehind, kBefore});
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  EXPECT_EQ(result.path, std::vector<Configuration>{kBefore});
  EXPECT_EQ(result.goal, 1u);
  EXPECT_EQ(result.cost, 0.0);
  ASSERT_EQ(result.clearances.size(), 1u);
  EXPECT_NEAR(result.clearances[0].value(), 1.5 - 0.100005, 1e-5);
}

TEST(PlanPath, TakesWhicheverGoalItReaches) {
  const PlanScene scene = with_gantry(thin_wall(0.0));
  const Configuration inside = {0.0, 0.0, 0.0};
  const Configuration near = {-1.5, -1.5, 0.0};
  const PlanResult result = plan_path(scene, kBefore, {inside, kBehind, near});
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  EXPECT_EQ(result.goal, 2u);
  EXPECT_EQ(result.path.back(), near);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("\"wall\""), std::string::npos);
}

// The nearest free configuration of a goal takes longer than thousands of checks: only a refusal
// has it.
TEST(PlanPath, NamesBlockedGoalsBrieflyBesideAFreeOne) {
  const PlanScene scene = with_gantry(thin_wall(0.0));
  std::vector<Configuration> goals(20, Configuration{0.0, 0.0, 0.0});
  EXPECT_NE(message_of(scene, kBefore, goals).find("no goal is free: goal 0 is not free: "),
            std::string::npos);
  EXPECT_NE(message_of(scene, kBefore, goals).find("the nearest free configuration"),
            std::string::npos);
  goals.push_back(kBehind);
  const PlanResult result = plan_path(scene, kBefore, goals);
  ASSERT_EQ(result.warnings.size(), 20u);
  EXPECT_EQ(result.warnings[7], "goal 7 is not free: \"wall\" and \"gantry/tool\" are in the way");
}

TEST(PlanPath, NamesThePairOfAStartThatIsNotFree) {
  const PlanScene scene = with_gantry(thin_wall(0.0));
  const Configuration touching = {-0.07, 0.3, 0.0};
  const std::string message = message_of(scene, touching, {kBefore});
  EXPECT_NE(message.find("the start is not free: \"wall\" and \"gantry/tool\" touch, up to 0.030"),
            std::string::npos)
      << message;
  // The place that is offered is free.
  const std::size_t x = message.find("x=");
  ASSERT_NE(x, std::string::npos) << message;
  const double offered = std::stod(message.substr(x + 2));
  EXPECT_TRUE(std::abs(offered) > 0.100005) << message;
  EXPECT_NE(message_of(scene, kBefore, {touching}).find("the goal is not free"), std::string::npos);
}

// A gap of 1.5 um is more than the margin of 0, but less than what the search keeps.
TEST(PlanPath, NamesTheTolerancesThatAStartIsWithin) {
  const PlanScene scene = with_gantry(thin_wall(0.0));
  const std::string near = message_of(scene, {-0.1 - 5e-6 - 1.5e-6, 0.3, 0.0}, {kBefore});
  EXPECT_NE(near.find("are no farther apart than their margin of 0 m and 3.001e-06 m for the "
                      "tolerances of the search (move them apart, or take a smaller margin or "
                      "tolerance); the nearest free configuration"),
            std::string::npos)
      << near;
}

TEST(PlanPath, RefusesWhatCannotBePlanned) {
  const PlanScene scene = with_gantry(thin_wall(0.4));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of(scene, {-1.5, 2.5, 0.0}, {kBehind}).find("the start: joint \"y\""),
            std::string::npos);
  EXPECT_NE(message_of(scene, kBefore, {{nan, 0.0, 0.0}}).find("the goal: joint \"x\""),
            std::string::npos);
  EXPECT_NE(message_of(scene, kBefore, {}).find("at least one goal"), std::string::npos);
  EXPECT_NE(message_of(scene, kBefore, {kBehind}, {.time = 0.0}).find("the time"),
            std::string::npos);
  EXPECT_NE(message_of(scene, kBefore, {kBehind}, {.time = nan}).find("the time"),
            std::string::npos);
  const PlanScene bar = with_bar(thin_wall(0.4), {0.1, 0.1, 0.1});
  EXPECT_EQ(message_of(bar, {-1.6, 0, 0, 1, 0, 0, 0}, {{1, 0, 0, 1, 0, 0, 0}}),
            "the start is outside of the box; widen the box, or the bounds of the floating joint");
  EXPECT_EQ(message_of(bar, {-1, 0, 0, 1, 0, 0, 0}, {{1, 0, 1.6, 1, 0, 0, 0}}),
            "a goal is outside of the box; widen the box, or the bounds of the floating joint");
  PlanScene none = scene;
  none.robots = {3};
  EXPECT_NE(message_of(none, kBefore, {kBehind}).find("robot of the scene for each"),
            std::string::npos);
}

TEST(PlanPath, EndsWhenItIsStopped) {
  const PlanScene scene = with_gantry(thin_wall(0.0));
  std::stop_source source;
  std::size_t reports = 0;
  PlanOptions options{.time = 60.0, .stop = source.get_token()};
  options.progress = [&](const PlanProgress&) {
    if (++reports == 2) {
      source.request_stop();
    }
  };
  const PlanResult result = plan_path(scene, kBefore, {kBehind}, options);
  EXPECT_EQ(result.verdict, PlanVerdict::none);
  EXPECT_EQ(reports, 2u);
}

// Stopped while it is shortened, the path that is there is the answer.
TEST(PlanPath, KeepsTheBestPathWhenItIsStopped) {
  const PlanScene scene = with_gantry(thin_wall(0.4));
  std::stop_source source;
  PlanOptions options{.stop = source.get_token()};
  options.progress = [&](const PlanProgress& done) {
    if (done.cost) {
      source.request_stop();
    }
  };
  const PlanResult result = plan_path(scene, kBefore, {kBehind}, options);
  expect_proven(scene, result, kBefore, kBehind);
  EXPECT_NEAR(result.cost, result.statistics.first_cost.value(), 1e-12);
}

}  // namespace
}  // namespace firstcontact::test
