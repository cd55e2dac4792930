// Which geometries may touch, and what a probe of instants spares.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot_check/detail/candidates.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::test {
namespace {

using detail::CandidateSearch;
using detail::GeometryCandidate;
using detail::ProbedCandidates;
using detail::RobotTimeline;
using Eigen::Vector3d;

Motion from_to(const Vector3d& from, const Vector3d& to) {
  const auto identity = Eigen::Quaterniond::Identity();
  return Motion::constant_velocity(Pose{from, identity}, Pose{to, identity});
}

/// A cube of side 0.2 m goes from x = 0 to x = 4 m, through walls at 1, 2 and 3 m.
RobotScene three_walls() {
  RobotScene scene;
  scene.add_body("cube", make_box({0.2, 0.2, 0.2}), from_to({0.0, 0.0, 0.0}, {4.0, 0.0, 0.0}));
  for (const double x : {1.0, 2.0, 3.0}) {
    const Vector3d at(x, 0.0, 0.0);
    scene.add_body("wall " + std::to_string(scene.size()), make_box({0.1, 2.0, 2.0}),
                   Motion::fixed({at, Eigen::Quaterniond::Identity()}));
  }
  return scene;
}

using Key = std::tuple<std::size_t, double, double>;

std::vector<Key> keys_of(const std::vector<GeometryCandidate>& candidates) {
  std::vector<Key> keys;
  for (const GeometryCandidate& candidate : candidates) {
    keys.emplace_back(candidate.pair, candidate.window.begin, candidate.window.end);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// Where the cube is in a wall, from the closed form.
bool is_in_contact(const RobotTimeline& timeline, const GeometryCandidate& candidate) {
  const double x = static_cast<double>(timeline.pairs()[candidate.pair].members[1]);
  return std::abs(4.0 * candidate.window.begin - x) <= 0.15;
}

struct Walls {
  RobotScene scene = three_walls();
  RobotTimeline timeline{scene};
  CandidateSearch search{timeline};
};

TEST(CandidateSearch, IsTheSameWhereAProbeSeesNothing) {
  const Walls walls;
  std::size_t asked = 0;
  const ProbedCandidates found =
      walls.search.find_unless_contact(0, [&](const GeometryCandidate& instant) {
        EXPECT_EQ(instant.window.begin, instant.window.end);
        EXPECT_TRUE(is_in_contact(walls.timeline, instant));  // All are boxes.
        ++asked;
        return false;
      });
  EXPECT_FALSE(found.contact.has_value());
  EXPECT_GT(asked, 0u);
  EXPECT_EQ(keys_of(found.candidates), keys_of(walls.search.find(0, {})));
}

// Windows that are searched at once and candidates together are all that may touch.
TEST(CandidateSearch, SearchesOrKeepsAllThatMayTouch) {
  const Walls walls;
  std::vector<GeometryCandidate> all;
  std::vector<GeometryCandidate> kept =
      walls.search.find_until_contact(0, [&](const GeometryCandidate& searched) {
        all.push_back(searched);
        return 1.0;
      });
  EXPECT_FALSE(all.empty());
  all.insert(all.end(), kept.begin(), kept.end());
  for (std::size_t pair = 0; pair < walls.timeline.pairs().size(); ++pair) {
    const double x = static_cast<double>(walls.timeline.pairs()[pair].members[1]);
    // The cube touches the wall from (x - 0.15) / 4 to (x + 0.15) / 4.
    for (double t = (x - 0.15) / 4.0; t <= (x + 0.15) / 4.0; t += 0.005) {
      EXPECT_TRUE(std::ranges::any_of(all,
                                      [&](const GeometryCandidate& candidate) {
                                        return candidate.pair == pair &&
                                               candidate.window.begin <= t &&
                                               t <= candidate.window.end;
                                      }))
          << pair << " at " << t;
    }
  }
}

// All that may touch until the contact is searched or kept, and nothing that begins later.
TEST(CandidateSearch, LeavesOutWhatIsLaterThanAContact) {
  const Walls walls;
  constexpr double kContact = 0.2125;  // The cube touches the first wall from (1 - 0.15) / 4 on.
  double first = 1.0;
  std::vector<std::size_t> searched;
  const std::vector<GeometryCandidate> kept =
      walls.search.find_until_contact(0, [&](const GeometryCandidate& candidate) {
        const double x = static_cast<double>(walls.timeline.pairs()[candidate.pair].members[1]);
        EXPECT_LE(candidate.window.begin, first);
        searched.push_back(candidate.pair);
        const double touches = (x - 0.15) / 4.0;
        if (candidate.window.begin <= (x + 0.15) / 4.0 && touches <= candidate.window.end) {
          first = std::min(first, std::max(touches, candidate.window.begin));
        }
        return first;
      });
  for (const GeometryCandidate& candidate : kept) {
    EXPECT_LE(candidate.window.begin, 0.25) << candidate.pair;
    const double x = static_cast<double>(walls.timeline.pairs()[candidate.pair].members[1]);
    first = x == 1.0 && candidate.window.begin <= kContact ? kContact : first;
  }
  EXPECT_DOUBLE_EQ(first, kContact);
  // The last wall is out of reach by then.
  EXPECT_TRUE(std::ranges::none_of(
      searched, [&](std::size_t pair) { return walls.timeline.pairs()[pair].members[1] == 3; }));
}

TEST(CandidateSearch, EndsAtTheFirstContactWhereAnyWillDo) {
  const Walls walls;
  std::size_t asked = 0;
  const ProbedCandidates found = walls.search.find_unless_contact(0, [&](const GeometryCandidate&) {
    ++asked;
    return true;
  });
  EXPECT_EQ(asked, 1u);
  EXPECT_TRUE(found.candidates.empty());
  ASSERT_TRUE(found.contact.has_value());
}

// The last place of an edge is seen before all others: that of a planner is often blocked.
TEST(CandidateSearch, LooksAtTheEndFirstWhereAnyContactWillDo) {
  RobotScene scene;
  scene.add_body("cube", make_box({0.2, 0.2, 0.2}), from_to({0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}));
  for (const double x : {1.0, 2.0}) {
    scene.add_body("wall " + std::to_string(scene.size()), make_box({0.1, 2.0, 2.0}),
                   Motion::fixed({{x, 0.0, 0.0}, Eigen::Quaterniond::Identity()}));
  }
  const RobotTimeline timeline(scene);
  const CandidateSearch search(timeline);
  const ProbedCandidates found =
      search.find_unless_contact(0, [](const GeometryCandidate&) { return true; });
  ASSERT_TRUE(found.contact.has_value());
  EXPECT_EQ(found.contact->window.begin, 1.0);
  EXPECT_EQ(timeline.pairs()[found.contact->pair].members[1], 2u);
}

}  // namespace
}  // namespace firstcontact::test
