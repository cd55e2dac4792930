// Threads that screw_sliding on each other.

#include <firstcontact/query/detail/screw_sliding_cover.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/query/close_features.h>
#include <firstcontact/query/detail/order.h>
#include <firstcontact/query/detail/workspace_data.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>

#include "support/instruction_sets.h"
#include "support/rounds.h"
#include "support/thread_mesh.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kPitch = 0.5 / (2.0 * std::numbers::pi);
constexpr double kWider = 0.06;  // About 0.02 m more than facets are bent.

Shape rod() { return test::make_thread({.turns = 5}); }

Shape nut() { return test::make_thread({.turns = 3, .wider = kWider, .shift = 1.0}); }

/// The nut's motion along the thread, and across it as far as `wobble` [m, rad].
struct Turning {
  Pose begin;
  Vector3d linear;
  Vector3d angular;
};

Turning random_turning(double wobble, std::mt19937& rng, double most_turn = 0.4) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Vector3d(uniform(rng), uniform(rng), uniform(rng)); };
  const double from = 3.0 * uniform(rng);
  const double turn = most_turn * uniform(rng);
  const Vector3d tilt = 0.1 * wobble * vector();
  Turning turning;
  turning.begin.position = Vector3d(0.0, 0.0, kPitch * from) + wobble * vector();
  turning.begin.rotation = Eigen::AngleAxisd(tilt.norm(), tilt.stableNormalized()) *
                           Eigen::Quaterniond(Eigen::AngleAxisd(from, Vector3d::UnitZ()));
  turning.linear = Vector3d(0.0, 0.0, kPitch * turn) + wobble * vector();
  turning.angular = Vector3d(0.0, 0.0, turn) + 0.5 * wobble * vector();
  return turning;
}

Motion motion_of(const Turning& turning) {
  return Motion::constant_velocity(turning.begin, turning.linear, turning.angular);
}

/// The rod may move along, as long as it does not turn.
Motion slide(bool does) {
  return does ? Motion::constant_velocity({.position = {5.0, 1.0, 2.0}}, {0.4, 0.0, 0.7})
              : Motion::fixed();
}

Turning seen_by(Turning turning, bool slides) {
  if (slides) {
    turning.begin.position += Vector3d(5.0, 1.0, 2.0);
    turning.linear += Vector3d(0.4, 0.0, 0.7);
  }
  return turning;
}

/// Two threads, one in the other, in either order.
class Cover {
 public:
  Cover(const Shape& A, const Motion& X_WA, const Shape& B, const Motion& X_WB)
      : motion_(X_WA, X_WB, A.hierarchy().centre, B.hierarchy().centre, 1e-6),
        pair_((motion_.enter(0.0), A.hierarchy()), B.hierarchy(), motion_),
        cover_(detail::ScrewSlidingCover::of(pair_, A, B, 0.0)) {}

  [[nodiscard]] bool exists() const { return cover_.has_value(); }

  [[nodiscard]] std::set<std::pair<std::uint32_t, std::uint32_t>> left(double threshold) {
    EXPECT_TRUE(cover_->find(1.0, threshold, 1'000'000, workspace_.data()));
    std::set<std::pair<std::uint32_t, std::uint32_t>> all;
    for (const auto& [a, b] : workspace_.data().left_by_screw_sliding) {
      all.emplace(a, b);
    }
    return all;
  }

  /// [m]
  [[nodiscard]] double distance(std::uint32_t a, std::uint32_t b, double t) const {
    const TrianglePair at = pair_.place(motion_.state(t), a, b);
    return triangle_distance(at.A, at.B).distance;
  }

 private:
  ConstantRatePair motion_;
  detail::MovingPair pair_;
  std::optional<detail::ScrewSlidingCover> cover_;
  Workspace workspace_;
};

using TrianglePairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// Expects that what is not left of all pairs is never nearer than the threshold. Returns how many
/// of the others are.
std::size_t near_pairs(const Cover& cover, const TrianglePairs& left, const Shape& A,
                       const Shape& B, double threshold) {
  std::size_t near = 0;
  for (std::uint32_t a = 0; a < A.hierarchy().triangles.size(); ++a) {
    for (std::uint32_t b = 0; b < B.hierarchy().triangles.size(); ++b) {
      if (left.contains({a, b})) {
        near += cover.distance(a, b, 0.5) <= threshold ? 1 : 0;
        continue;
      }
      for (const double t : {0.0, 0.37, 0.5, 1.0}) {
        EXPECT_GT(cover.distance(a, b, t), threshold) << a << ' ' << b;
      }
    }
  }
  return near;
}

/// With a disc across the axis.
Shape capped(const Shape& thread, double z) {
  Mesh mesh = thread.mesh();
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.0, 0.0, z);
  for (std::uint32_t k = 0; k < 12; ++k) {
    const double angle = std::numbers::pi / 6.0 * k;
    mesh.vertices.emplace_back(0.8 * std::cos(angle), 0.8 * std::sin(angle), z);
    mesh.triangles.push_back({first, first + 1 + k, first + 1 + (k + 1) % 12});
  }
  return Shape(std::move(mesh));
}

using ScrewSlidingCoverOn = test::OnInstructionSet;

// Sound: what is not left is never nearer than the threshold.
TEST_P(ScrewSlidingCoverOn, LeavesEveryPairThatComesNear) {
  std::mt19937 rng(11);
  const Shape inner = rod();
  const Shape outer = nut();
  std::size_t near = 0;
  for (int round = test::rounds(0, 5); round < 6; ++round) {
    choose(GetParam());
    const bool slides = round % 2 == 1;
    const bool swapped = round % 3 == 2;
    const Motion still = slide(slides);
    const Motion turning = motion_of(seen_by(random_turning(round < 3 ? 0.01 : 0.05, rng), slides));
    Cover cover(swapped ? outer : inner, swapped ? turning : still, swapped ? inner : outer,
                swapped ? still : turning);
    ASSERT_TRUE(cover.exists());
    const double threshold = 0.005 * (1 + round % 4);
    const TrianglePairs left = cover.left(threshold);
    choose(0);  // Emulated vectors would take a minute for the distances of all pairs.
    near += near_pairs(cover, left, swapped ? outer : inner, swapped ? inner : outer, threshold);
  }
  EXPECT_GT(near, 100u);
}

INSTANTIATE_TEST_SUITE_P(, ScrewSlidingCoverOn, testing::ValuesIn(test::instruction_sets()),
                         test::instruction_set_name);

// The way between two poses is not straight: seen from the screw, a body that turns beside its axis
// is led along a bow, and nearer in the middle than at the ends.
TEST(ScrewSlidingCover, LeavesWhatComesNearOnItsWay) {
  const Shape inner = rod();
  const Shape outer = test::make_thread({.turns = 3, .wider = 0.5, .shift = 1.0});
  const Motion still = Motion::fixed();
  std::size_t near = 0;
  for (int round = 0; round < test::rounds(4, 1); ++round) {
    const double side = std::numbers::pi / 2.0 * round;
    const Motion turning =
        Motion::constant_velocity({.position = {0.48 * std::cos(side), 0.48 * std::sin(side), 0.0}},
                                  {0.0, 0.0, 0.95 * kPitch}, {0.0, 0.0, 0.95});
    Cover cover(inner, still, outer, turning);
    ASSERT_TRUE(cover.exists());
    near += near_pairs(cover, cover.left(0.05), inner, outer, 0.05);
  }
  EXPECT_GT(near, 100u);
}

// Surfaces across the axis do not screw_sliding: they come nearer by what the thread climbs.
TEST(ScrewSlidingCover, LeavesWhatIsClimbedTo) {
  const Shape inner = capped(rod(), 1.0);
  for (int round = 0; round < test::rounds(2, 1); ++round) {
    const double sign = round == 0 ? -1.0 : 1.0;
    const Shape outer = capped(nut(), 1.0 - 0.04 * sign);
    const Motion still = Motion::fixed();
    const Motion turning =
        Motion::constant_velocity({}, {0.0, 0.0, sign * 0.8 * kPitch}, {0.0, 0.0, sign * 0.8});
    Cover cover(inner, still, outer, turning);
    ASSERT_TRUE(cover.exists());
    EXPECT_GT(near_pairs(cover, cover.left(0.015), inner, outer, 0.015), 10u);
    Cover swapped(outer, turning, inner, still);
    EXPECT_GT(near_pairs(swapped, swapped.left(0.015), outer, inner, 0.015), 10u);
  }
}

// Tight: along the thread nothing is left of pairs that stay apart by little more.
TEST(ScrewSlidingCover, LeavesNothingOfAThreadThatScrewSlidings) {
  const Shape inner = rod();
  const Shape outer = nut();
  const Motion still = Motion::fixed();
  const Motion turning = Motion::constant_velocity({.position = {0.0, 0.0, 0.0}},
                                                   {0.0, 0.0, 0.4 * kPitch}, {0.0, 0.0, 0.4});
  Cover cover(inner, still, outer, turning);
  ASSERT_TRUE(cover.exists());
  EXPECT_TRUE(cover.left(0.005).empty());
  EXPECT_FALSE(cover.left(0.1).empty());
}

TEST(ScrewSlidingCover, IsNoneOfBodiesThatBothTurn) {
  const Shape inner = rod();
  const Shape outer = nut();
  const Motion turning = Motion::constant_velocity({}, Vector3d::Zero(), {0.0, 0.0, 0.4});
  EXPECT_FALSE(Cover(inner, turning, outer, turning).exists());
}

// A law: what first_contact says of threads is what distances say.
TEST(ScrewSlidingCover, LetsFirstContactBeRight) {
  std::mt19937 rng(17);
  const Shape inner = test::make_thread({.segments = 60, .turns = 8});
  const Shape outer = test::make_thread({.segments = 60, .turns = 6, .wider = 0.03, .shift = 1.0});
  const Motion still = Motion::fixed();
  const FirstContactOptions options{.margin = 0.004, .tolerance = 0.001};
  Workspace workspace;
  int hits = 0;
  int misses = 0;
  for (int round = 0; round < test::rounds(12, 6); ++round) {
    const Motion turning = motion_of(random_turning(round % 2 == 0 ? 0.004 : 0.02, rng));
    const FirstContactResult found =
        first_contact({inner, still}, {outer, turning}, workspace, options);
    ASSERT_NE(found.verdict, Verdict::undecided);
    const FirstContactResult swapped =
        first_contact({outer, turning}, {inner, still}, workspace, options);
    EXPECT_EQ(found.t, swapped.t);
    EXPECT_EQ(found.contacts.size(), swapped.contacts.size());
    const auto distance_at = [&](double t) {
      return distance({inner, still}, {outer, turning}, t, workspace).distance;
    };
    for (const double part : {0.0, 0.5, 0.9, 0.999}) {
      if (part * found.t < found.t) {
        EXPECT_GT(distance_at(part * found.t), options.margin) << round;
      }
    }
    if (found.verdict == Verdict::free) {
      ++misses;
    } else {
      ++hits;
      EXPECT_LE(distance_at(found.t), options.margin + options.tolerance) << round;
      EXPECT_FALSE(found.contacts.empty());
    }
  }
  EXPECT_GT(hits, test::rounds(2, 0));
  EXPECT_GT(misses, test::rounds(2, 0));
}

TEST(ScrewSlidingCover, SparesFirstContactMostOfItsWork) {
  const Shape inner = test::make_thread({.segments = 60, .turns = 8});
  const Shape outer = test::make_thread({.segments = 60, .turns = 6, .wider = 0.03, .shift = 1.0});
  const Motion turning = Motion::constant_velocity({}, {0.0, 0.0, 0.2 * kPitch}, {0.0, 0.0, 0.2});
  Workspace workspace;
  const FirstContactResult found = first_contact({inner, Motion::fixed()}, {outer, turning},
                                                 workspace, {.margin = 0.004, .tolerance = 0.001});
  EXPECT_EQ(found.verdict, Verdict::free);
  EXPECT_LT(found.work.node_groups + found.work.steps, 2000u);
}

// All of very many close features are listed; where the nearest ones are enough, only these.
TEST(ScrewSlidingCover, ListsTheNearestFeatures) {
  const Shape inner = test::make_thread({.segments = 60, .turns = 8});
  const Shape outer = test::make_thread({.segments = 60, .turns = 6, .wider = 0.03, .shift = 1.0});
  const Motion still = Motion::fixed();
  const Motion tilted = Motion::fixed({.position = {0.002, 0.0, 0.003}});
  Workspace workspace;
  std::vector<Contact> all;
  std::vector<Contact> few;
  close_features({inner, still}, {outer, tilted}, 0.0, 0.03, workspace, all);
  close_features({inner, still}, {outer, tilted}, 0.0, 0.03, workspace, few, 0.3);
  ASSERT_FALSE(few.empty());
  EXPECT_LT(few.size(), all.size() / 2);
  const auto nearest = [](const std::vector<Contact>& contacts) {
    return std::ranges::min(contacts, {}, &Contact::distance).distance;
  };
  EXPECT_EQ(nearest(few), nearest(all));
  EXPECT_NEAR(nearest(all), distance({inner, still}, {outer, tilted}, 0.0, workspace).distance,
              1e-12);
  EXPECT_THROW(close_features({inner, still}, {outer, tilted}, 0.0, 0.03, workspace, few, -1.0),
               std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
