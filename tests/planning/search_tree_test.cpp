// The trees that a planner keeps: complete, free edge by edge, and without effect on the path.

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/search_tree.h>

#include "planning/plan_cases.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

const Configuration kRoot = {-1.5, 1.2, -0.7};
const Configuration kGoal = {1.5, 1.1, -0.9};
const Configuration kOtherGoal = {1.5, 1.1, 0.9};

std::size_t places_in(const std::vector<SearchTree>& trees) {
  std::size_t count = 0;
  for (const SearchTree& tree : trees) {
    count += tree.places.size();
  }
  return count;
}

/// Proves every edge anew, by a checker that the planner has not seen.
void expect_free_edges(const PlanScene& scene, const SearchTree& tree) {
  const EdgeChecker fresh(scene);
  std::vector<Configuration> from;
  std::vector<Configuration> to;
  for (const auto& [a, b] : tree.edges) {
    ASSERT_LT(std::max(a, b), tree.places.size());
    from.push_back(tree.places[a]);
    to.push_back(tree.places[b]);
  }
  const std::vector<EdgeAnswer> answers = fresh.check(from, to);
  for (std::size_t k = 0; k < answers.size(); ++k) {
    ASSERT_EQ(answers[k].verdict, EdgeVerdict::free) << "edge " << k;
  }
}

/// Expects one parent of each place but the roots, which come first.
void expect_tree(const SearchTree& tree, const std::vector<Configuration>& roots) {
  ASSERT_EQ(tree.edges.size() + roots.size(), tree.places.size());
  for (std::size_t k = 0; k < roots.size(); ++k) {
    EXPECT_EQ(tree.places[k], roots[k]);
  }
  for (std::size_t k = 0; k < tree.edges.size(); ++k) {
    EXPECT_EQ(tree.edges[k][1], k + roots.size());
    EXPECT_LT(tree.edges[k][0], tree.edges[k][1]);
  }
}

/// Whether each place of a path without shortcuts is a place of a tree.
bool holds_all(const std::vector<SearchTree>& trees, const std::vector<Configuration>& path) {
  return std::ranges::all_of(path, [&](const Configuration& q) {
    return std::ranges::any_of(trees, [&](const SearchTree& tree) {
      return std::ranges::find(tree.places, q) != tree.places.end();
    });
  });
}

TEST(SearchTree, HoldsAllPlacesOfBothTreesWithFreeEdges) {
  const PlanScene scene = with_gantry(thin_wall(0.2));
  const PlanResult result =
      plan_path(scene, kRoot, {kGoal, kOtherGoal}, {.seed = 3, .shortcuts = 0, .keep_trees = true});
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  ASSERT_EQ(result.trees.size(), 2u);
  EXPECT_EQ(result.trees[0].kind, SearchTreeKind::from_start);
  EXPECT_EQ(result.trees[1].kind, SearchTreeKind::from_goals);
  EXPECT_EQ(places_in(result.trees), result.statistics.nodes);
  EXPECT_GT(result.trees[0].edges.size(), 10u);
  expect_tree(result.trees[0], {kRoot});
  expect_tree(result.trees[1], {kGoal, kOtherGoal});
  for (const SearchTree& tree : result.trees) {
    EXPECT_TRUE(tree.times.empty());
    expect_free_edges(scene, tree);
  }
  EXPECT_TRUE(holds_all(result.trees, result.path));
}

TEST(SearchTree, HoldsTheProvenEdgesOfARoadmap) {
  const PlanScene scene = with_gantry(thin_wall(0.4));
  const PlanResult result =
      plan_path(scene, kRoot, {kGoal},
                {.planner = Planner::lazy_prm_star, .seed = 2, .shortcuts = 0, .keep_trees = true});
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  ASSERT_EQ(result.trees.size(), 1u);
  EXPECT_EQ(result.trees[0].kind, SearchTreeKind::roadmap);
  // Those of the trees that led to its first paths count, too.
  EXPECT_LT(places_in(result.trees), result.statistics.nodes);
  EXPECT_GE(places_in(result.trees), 1000u);
  EXPECT_GE(result.trees[0].edges.size(), result.path.size() - 1);
  expect_free_edges(scene, result.trees[0]);
  EXPECT_TRUE(holds_all(result.trees, result.path));
}

TEST(SearchTree, IsKeptOfASearchWithoutAnAnswer) {
  const PlanScene closed = with_gantry(thin_wall(0.0));
  const PlanResult result = plan_path(closed, kRoot, {kGoal}, {.time = 0.2, .keep_trees = true});
  ASSERT_EQ(result.verdict, PlanVerdict::none);
  EXPECT_EQ(places_in(result.trees), result.statistics.nodes);
  EXPECT_GT(places_in(result.trees), 2u);
  for (const SearchTree& tree : result.trees) {
    expect_free_edges(closed, tree);
  }
}

// In contact a tree takes over places that other trees have found.
TEST(SearchTree, HasFreeEdgesInContact) {
  const PlanScene scene = with_gantry(thin_wall(0.1001));
  const PlanResult result =
      plan_path(scene, {-0.5, 0.05, 0.02}, {{0.5, 0.0, 0.03}},
                {.contacts = ContactUse::both, .time = 0.5, .shortcuts = 0, .keep_trees = true});
  EXPECT_EQ(places_in(result.trees), result.statistics.nodes);
  EXPECT_GT(result.statistics.contacts.nodes, 0u);
  for (const SearchTree& tree : result.trees) {
    expect_free_edges(scene, tree);
  }
}

TEST(SearchTree, ChangesNoPathAndIsTheSameForAnyNumberOfThreads) {
  const PlanScene scene = with_gantry(thin_wall(0.2));
  const std::vector<Planner> planners{Planner::rrt_connect, Planner::lazy_prm_star};
  const auto tested = static_cast<std::size_t>(rounds(2, 1));  // A roadmap takes 43,000 edges.
  for (const Planner planner : std::span(planners).first(tested)) {
    const auto answer = [&](bool keep, int threads) {
      return plan_path(scene, kRoot, {kGoal},
                       {.planner = planner,
                        .seed = 5,
                        .time = 300.0,  // Only the clock could part them.
                        .keep_trees = keep,
                        .threads = threads});
    };
    const PlanResult without = answer(false, 1);
    const PlanResult one = answer(true, 1);
    const PlanResult four = answer(true, 4);
    ASSERT_EQ(without.verdict, PlanVerdict::proven);
    EXPECT_TRUE(without.trees.empty());
    EXPECT_EQ(without.path, one.path);
    EXPECT_EQ(without.clearances, one.clearances);
    EXPECT_EQ(without.statistics.edges_checked, one.statistics.edges_checked);
    EXPECT_EQ(one.path, four.path);
    ASSERT_EQ(one.trees.size(), four.trees.size());
    for (std::size_t k = 0; k < one.trees.size(); ++k) {
      EXPECT_EQ(one.trees[k].places, four.trees[k].places);
      EXPECT_EQ(one.trees[k].edges, four.trees[k].edges);
    }
  }
}

// The time may end in any of the searches from which lazy PRM* takes its paths. What was found
// before is kept.
TEST(SearchTree, KeepsThePathsOfARoadmapWhoseTimeEnds) {
  const PlanScene scene = with_gantry(thin_wall(0.2));
  const double once =
      plan_path(scene, kRoot, {kGoal}, {.seed = 5, .time = 60.0}).statistics.seconds;
  int found = 0;
  const int tries = rounds(8, 2);
  for (int round = 0; round < tries; ++round) {
    const PlanResult result = plan_path(
        scene, kRoot, {kGoal},
        {.planner = Planner::lazy_prm_star, .seed = 5, .time = once * (0.5 + 6.0 * round / tries)});
    if (result.verdict == PlanVerdict::proven) {
      ++found;
      EXPECT_EQ(result.path.front(), kRoot);
      EXPECT_EQ(result.path.back(), kGoal);
    }
  }
  EXPECT_GT(found, rounds(0, -1));  // Two tries may both end too early.
}

}  // namespace
}  // namespace firstcontact::test
