// One EdgeChecker that several threads ask at once answers as it answers one.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <firstcontact/edges/edge_checker.h>

#include "planning/plan_cases.h"
#include "support/at_once.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

constexpr std::size_t kThreads = 2;

std::uint64_t bits_of(const std::optional<double>& number) {
  return number ? std::bit_cast<std::uint64_t>(*number) : ~std::uint64_t{0};
}

/// All numbers of the answers about an edge and its end.
using Answer = std::array<std::uint64_t, 9>;

Answer ask(const EdgeChecker& checker, const Configuration& from, const Configuration& to) {
  const EdgeAnswer edge = checker.check(from, to);
  const EdgeAnswer closely = checker.check_closely(from, to);
  const EdgeAnswer quickly = checker.check_quickly(from, to);
  const StateAnswer end = checker.state(to);
  return {static_cast<std::uint64_t>(edge.verdict),
          bits_of(edge.fraction),
          bits_of(edge.clearance),
          bits_of(closely.fraction),
          bits_of(closely.clearance),
          static_cast<std::uint64_t>(quickly.verdict),
          static_cast<std::uint64_t>(end.verdict),
          bits_of(end.clearance),
          checker.is_free(to) ? 1u : 0u};
}

TEST(EdgeCheckerThreads, AnswerAsOne) {
  RobotScene walls = thin_wall(0.4);
  walls.add_body("ball", make_sphere(0.2), resting_at({0.5, 0.3, 0.0}));
  const EdgeChecker checker(with_bar(std::move(walls), {0.05, 0.3, 0.05}));
  Random random(3);
  std::vector<Configuration> places;
  const auto count = static_cast<std::size_t>(rounds(200, 20));
  for (std::size_t k = 0; k <= count; ++k) {
    const Eigen::Quaterniond turn = random.rotation();
    const Eigen::Vector3d at = random.vector(0.0, 1.0);
    places.push_back({at.x(), at.y(), at.z(), turn.w(), turn.x(), turn.y(), turn.z()});
  }
  std::vector<Answer> alone;
  for (std::size_t k = 0; k < count; ++k) {
    alone.push_back(ask(checker, places[k], places[k + 1]));
  }
  // All threads ask the same at about the same time, one of them from the back.
  std::array<std::vector<Answer>, kThreads> answers;
  at_once(kThreads, [&](std::size_t thread) {
    answers[thread].resize(count);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t edge = thread == 0 ? k : count - 1 - k;
      answers[thread][edge] = ask(checker, places[edge], places[edge + 1]);
    }
  });
  for (const std::vector<Answer>& several : answers) {
    EXPECT_EQ(several, alone);
  }
}

}  // namespace
}  // namespace firstcontact::test
