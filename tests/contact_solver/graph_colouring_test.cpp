// Which pairs of bodies are solved at once.

#include <random>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include <firstcontact/contact_solver/detail/contact_rows.h>
#include <firstcontact/contact_solver/detail/graph_colouring.h>

#include "contact_solver/wall_problem.h"

namespace firstcontact::detail {
namespace {

using test::wall;

constexpr std::size_t kLanesOfTest = 8;

/// Bodies in a row, each touching the next one.
ContactProblem row_of_bodies(std::size_t count) {
  ContactProblem problem;
  problem.bodies.resize(count);
  for (ContactBody& body : problem.bodies) {
    body.inverse_inertia.mass.setOnes();
  }
  for (std::size_t k = 0; k + 1 < count; ++k) {
    problem.contacts.push_back({.bodies = {k, k + 1}});
  }
  return problem;
}

/// No batch has two pairs in a lane, or a moving body twice.
void expect_valid(const ContactProblem& problem, const GraphColouring& placed) {
  std::set<std::pair<std::size_t, std::size_t>> lanes;
  std::set<std::pair<std::size_t, std::size_t>> bodies;
  for (std::size_t first = 0; first < problem.contacts.size();) {
    const auto [batch, lane] = placed.places[first];
    ASSERT_LT(lane, kLanesOfTest);
    ASSERT_LT(batch, placed.counts.size());
    EXPECT_TRUE(lanes.emplace(batch, lane).second);
    for (const std::size_t body : problem.contacts[first].bodies) {
      if (is_movable(problem.bodies[body])) {
        EXPECT_TRUE(bodies.emplace(batch, body).second);
      }
    }
    const std::size_t count = count_of_pair(problem.contacts, first);
    EXPECT_GE(placed.counts[batch], count);
    first += count;
  }
}

TEST(GraphColouring, KeepTheOrderOfEachBodyAndLeaveFewLanesEmpty) {
  std::mt19937 rng(5);
  const ContactProblem problem = wall(rng, 24, 24, 0.5);
  const std::optional<GraphColouring> placed = place_pairs(problem, kLanesOfTest, true);
  ASSERT_TRUE(placed);
  expect_valid(problem, *placed);
  EXPECT_GE(placed->fill(kLanesOfTest), 0.8);
  EXPECT_LE(placed->fill(kLanesOfTest), 1.0);
  std::vector<std::size_t> next(problem.bodies.size(), 0);
  for (std::size_t first = 0; first < problem.contacts.size();
       first += count_of_pair(problem.contacts, first)) {
    for (const std::size_t body : problem.contacts[first].bodies) {
      if (is_movable(problem.bodies[body])) {
        EXPECT_GE(placed->places[first].batch, next[body]);
        next[body] = placed->places[first].batch + 1;
      }
    }
  }
}

// In their order each would wait for the one before.
TEST(GraphColouring, GiveUpTheOrderOfLongChains) {
  const ContactProblem problem = row_of_bodies(601);
  const std::optional<GraphColouring> placed = place_pairs(problem, kLanesOfTest, true);
  ASSERT_TRUE(placed);
  expect_valid(problem, *placed);
  EXPECT_GE(placed->fill(kLanesOfTest), 0.95);
  EXPECT_FALSE(place_pairs(problem, kLanesOfTest, false));
}

// In a time that grows with their number, whatever the order (0.4 ms for 4,000, once 2.6 s).
TEST(GraphColouring, AreFoundForOneBodyAmongVeryMany) {
  constexpr std::size_t kMany = 10'000;
  ContactProblem problem = row_of_bodies(kMany);
  for (std::size_t k = 1; k < kMany; ++k) {
    problem.contacts.push_back({.bodies = {0, k}});
  }
  for (std::size_t k = 0; k + 2 < kMany; ++k) {
    problem.contacts.push_back({.bodies = {k, k + 2}});
  }
  const std::optional<GraphColouring> placed = place_pairs(problem, kLanesOfTest, true);
  ASSERT_TRUE(placed);
  expect_valid(problem, *placed);
}

TEST(GraphColouring, AreNotForOneBodyThatTouchesAll) {
  ContactProblem problem = row_of_bodies(601);
  for (ContactPoint& contact : problem.contacts) {
    contact.bodies[0] = 600;
  }
  problem.contacts.back().bodies = {0, 600};
  EXPECT_FALSE(place_pairs(problem, kLanesOfTest, true));
}

}  // namespace
}  // namespace firstcontact::detail
