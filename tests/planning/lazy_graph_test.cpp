// The graph of Lazy PRM* against a search from nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/detail/lazy_graph.h>
#include <firstcontact/math/random_numbers.h>

namespace firstcontact::test {
namespace {

constexpr std::size_t kGoals = 3;  // Nodes 1 to 3.

/// The least cost from node 0 to a goal, by relaxing all edges as often as there are nodes.
double least_cost(const detail::LazyGraph& graph, std::size_t edges) {
  std::vector<double> cost(graph.size(), std::numeric_limits<double>::infinity());
  cost[0] = 0.0;
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (std::size_t k = 0; k < edges; ++k) {
      const auto& edge = graph.edge(k);
      for (const auto& [from, to] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
        if (!edge.is_blocked && cost[from] + edge.length < cost[to]) {
          cost[to] = cost[from] + edge.length;
          has_changed = true;
        }
      }
    }
  }
  return *std::min_element(cost.begin() + 1, cost.begin() + 1 + kGoals);
}

double cost_of(const detail::LazyGraph& graph, const std::vector<std::size_t>& path) {
  double cost = path.empty() ? std::numeric_limits<double>::infinity() : 0.0;
  std::size_t node = 0;
  for (const std::size_t edge : path) {
    EXPECT_FALSE(graph.edge(edge).is_blocked);
    cost += graph.edge(edge).length;
    node = graph.other_end(edge, node);
  }
  EXPECT_TRUE(path.empty() || (node >= 1 && node <= kGoals));
  return cost;
}

/// Adds places, blocks edges of the shortest paths, and compares each path with a search from
/// nothing.
///
/// @param copies  [-]  share of the places that are in the place of an earlier one, or very near
void expect_shortest_paths(double copies) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomNumbers random(seed);
    detail::LazyGraph graph;
    std::vector<Eigen::Vector2d> places;
    std::size_t edges = 0;
    for (int round = 0; round < 150; ++round) {
      if (!places.empty() && random.uniform() < copies) {
        const double apart = random.below(2) == 0 ? 0.0 : 1e-18;
        places.emplace_back(places[random.below(places.size())] + Eigen::Vector2d(apart, apart));
      } else {
        places.emplace_back(random.uniform(), random.uniform());
      }
      const std::size_t added = places.size() - 1;
      double to_goal = std::numeric_limits<double>::infinity();
      // Goals come first, so that bounds of later nodes hold.
      for (std::size_t goal = 1; goal <= std::min(added, kGoals); ++goal) {
        to_goal = std::min(to_goal, (places[added] - places[goal]).norm());
      }
      const bool is_goal = added >= 1 && added <= kGoals;
      ASSERT_EQ(graph.add_node(added == 0 || is_goal ? 0.0 : to_goal, is_goal), added);
      for (int k = 0; k < 4 && added > 0; ++k) {
        const std::size_t other = random.below(added);
        graph.add_edge(other, added, (places[other] - places[added]).norm(), false);
        ++edges;
      }
      if (added < kGoals) {
        continue;
      }
      for (int k = 0; k < 3; ++k) {
        const std::vector<std::size_t> path = graph.shortest_path();
        const double least = least_cost(graph, edges);
        if (std::isinf(least)) {
          ASSERT_TRUE(path.empty());
          break;
        }
        ASSERT_NEAR(cost_of(graph, path), least, 1e-12) << seed << ' ' << round;
        graph.block(path[random.below(path.size())]);
      }
    }
  }
}

TEST(LazyGraph, KeepsTheShortestPath) { expect_shortest_paths(0.0); }

// Equal goals, and a path that is taken twice, have edges of no length.
TEST(LazyGraph, KeepsTheShortestPathOfEqualPlaces) {
  for (const double copies : {0.1, 0.5, 0.9}) {
    expect_shortest_paths(copies);
  }
}

}  // namespace
}  // namespace firstcontact::test
