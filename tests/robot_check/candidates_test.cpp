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
using detail::InstantProbe;
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
  const ProbedCandidates found = walls.search.find_until_contact(
      0, InstantProbe{[&](const GeometryCandidate& instant) {
        EXPECT_EQ(instant.window.begin, instant.window.end);
        EXPECT_TRUE(is_in_contact(walls.timeline, instant));  // All are boxes.
        ++asked;
        return false;
      }});
  EXPECT_FALSE(found.contact.has_value());
  EXPECT_GT(asked, 0u);
  EXPECT_EQ(keys_of(found.candidates), keys_of(walls.search.find(0, {})));
}

// All that may touch until the contact is kept, and nothing that begins later.
TEST(CandidateSearch, LeavesOutWhatIsLaterThanAContact) {
  const Walls walls;
  const ProbedCandidates found =
      walls.search.find_until_contact(0, InstantProbe{[&](const GeometryCandidate& instant) {
                                        return is_in_contact(walls.timeline, instant);
                                      }});
  ASSERT_TRUE(found.contact.has_value());
  EXPECT_EQ(found.contact->window.begin, 0.25);  // At the middle of the first half.
  std::size_t kept = 0;
  for (const GeometryCandidate& candidate : found.candidates) {
    EXPECT_LE(candidate.window.begin, 0.25) << candidate.pair;
    kept += walls.timeline.pairs()[candidate.pair].members[1] == 1 ? 1 : 0;
  }
  ASSERT_EQ(kept, 1u);
  // The cube touches the wall from (1 - 0.15) / 4 on.
  const TimeWindow window = found.candidates.front().window;
  EXPECT_LE(window.begin, 0.2125);
  EXPECT_GE(window.begin, 0.1);  // Halved, although the two overlap at the middle.
  EXPECT_GE(window.end, 0.25);
}

TEST(CandidateSearch, EndsAtTheFirstContactWhereAnyWillDo) {
  const Walls walls;
  std::size_t asked = 0;
  const ProbedCandidates found =
      walls.search.find_until_contact(0, InstantProbe{[&](const GeometryCandidate&) {
                                                        ++asked;
                                                        return true;
                                                      },
                                                      true});
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
  const InstantProbe probe{[](const GeometryCandidate&) { return true; }, true};
  const ProbedCandidates found = search.find_until_contact(0, probe);
  ASSERT_TRUE(found.contact.has_value());
  EXPECT_EQ(found.contact->window.begin, 1.0);
  EXPECT_EQ(timeline.pairs()[found.contact->pair].members[1], 2u);
}

}  // namespace
}  // namespace firstcontact::test
