// One ProvenEdges that several threads ask at once answers as it answers one.

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "planning/ompl_proven.h"
#include "planning/plan_cases.h"
#include "support/at_once.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

namespace ob = ompl::base;

constexpr std::size_t kThreads = 2;

/// The answer about a motion, and its last valid state.
struct MotionAnswer {
  bool is_valid = false;
  bool is_valid_at_end = false;
  double last = -1.0;
  Configuration reached = {};

  bool operator==(const MotionAnswer&) const = default;
};

MotionAnswer ask(const Proven& proven, const Configuration& from, const Configuration& to) {
  ob::State* start = proven.state(from);
  ob::State* end = proven.state(to);
  ob::State* reached = proven.state(from);
  MotionAnswer answer;
  std::pair<ob::State*, double> last(reached, -1.0);
  answer.is_valid = proven.si->checkMotion(start, end, last);
  answer.is_valid_at_end = proven.si->isValid(end);
  answer.last = last.second;
  answer.reached = OmplStates(*proven.space, proven.edges->space()).read(reached);
  EXPECT_EQ(proven.si->checkMotion(start, end), answer.is_valid);
  for (ob::State* state : {start, end, reached}) {
    proven.si->freeState(state);
  }
  return answer;
}

TEST(OmplThreads, AnswerAsOne) {
  const Proven proven(with_gantry(thin_wall(0.4)));
  Random random(3);
  std::vector<Configuration> places;
  const auto count = static_cast<std::size_t>(rounds(500, 50));
  for (std::size_t k = 0; k <= count; ++k) {
    Configuration q;
    for (int axis = 0; axis < 3; ++axis) {
      q.push_back(random.uniform(-1.5, 1.5));
    }
    places.push_back(std::move(q));
  }
  std::vector<MotionAnswer> alone;
  for (std::size_t k = 0; k < count; ++k) {
    alone.push_back(ask(proven, places[k], places[k + 1]));
  }
  const unsigned int valid = proven.validator->getValidMotionCount();
  const unsigned int invalid = proven.validator->getInvalidMotionCount();
  std::array<std::vector<MotionAnswer>, kThreads> answers;
  at_once(kThreads, [&](std::size_t thread) {
    answers[thread].resize(count);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t motion = thread == 0 ? k : count - 1 - k;
      answers[thread][motion] = ask(proven, places[motion], places[motion + 1]);
    }
  });
  for (const std::vector<MotionAnswer>& several : answers) {
    EXPECT_EQ(several, alone);
  }
  // No motion is lost from the counts.
  EXPECT_EQ(proven.validator->getValidMotionCount(), (1 + kThreads) * valid);
  EXPECT_EQ(proven.validator->getInvalidMotionCount(), (1 + kThreads) * invalid);
  EXPECT_GT(valid, 0u);
  EXPECT_GT(invalid, 0u);
}

}  // namespace
}  // namespace firstcontact::test
