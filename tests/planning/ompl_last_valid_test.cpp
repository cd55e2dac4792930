// The last valid state of a motion: near the first contact, which is bracketed independently.

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <ompl/base/ScopedState.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "planning/box_walk.h"
#include "planning/ompl_proven.h"
#include "planning/plan_cases.h"

namespace firstcontact::test {
namespace {

namespace ob = ompl::base;

constexpr double kLeastShare = 0.999;  // [-]  The least last valid share of the first contact.
constexpr double kNearContact = 2e-6;  // [m]  More than the tolerance and the extra clearance.
constexpr double kFinestStep = 1e-6;   // [-]

/// The boxes of a configuration, and how far no pair moves on an edge.
struct BoxCase {
  std::function<std::vector<PlacedBox>(const Configuration&)> boxes;
  std::function<double(const Configuration&, const Configuration&)> way;
  std::vector<std::array<std::size_t, 2>> pairs;
};

/// Proves last valid states of random edges; returns the number of edges that were blocked.
int expect_last_valid_states(const Proven& proven, const BoxCase& of, int edges) {
  const OmplStates states(*proven.space, proven.edges->space());
  ob::ScopedState<> from(proven.space);
  ob::ScopedState<> to(proven.space);
  ob::ScopedState<> between(proven.space);
  ob::ScopedState<> reached(proven.space);
  int blocked = 0;
  for (int k = 0; k < edges; ++k) {
    from.random();
    to.random();
    const Configuration start = states.read(from.get());
    if (!proven.edges->is_free(start)) {
      continue;
    }
    std::pair<ob::State*, double> last(reached.get(), -1.0);
    if (proven.validator->checkMotion(from.get(), to.get(), last)) {
      continue;
    }
    ++blocked;
    const MovingBoxes boxes{.at =
                                [&](double share) {
                                  proven.space->interpolate(from.get(), to.get(), share,
                                                            between.get());
                                  return of.boxes(states.read(between.get()));
                                },
                            .pairs = of.pairs,
                            .speed = of.way(start, states.read(to.get()))};
    const WalkedEdge walked = walk(boxes, kNearContact, kFinestStep);
    EXPECT_TRUE(walked.near_from) << k;
    // Sound: not beyond the contact. Tight: at least 0.999 of the way to it.
    EXPECT_LE(last.second, walked.met_by.value_or(1.0)) << k;
    EXPECT_GE(last.second, kLeastShare * walked.near_from.value_or(1.0)) << k;
    EXPECT_EQ(proven.edges->check(start, states.read(reached.get())).verdict, EdgeVerdict::free)
        << k;
    proven.space->interpolate(from.get(), to.get(), last.second, between.get());
    EXPECT_TRUE(proven.space->equalStates(between.get(), reached.get())) << k;
  }
  return blocked;
}

std::vector<PlacedBox> boxes_at(const std::vector<Eigen::Vector3d>& places,
                                const Eigen::Vector3d& half) {
  std::vector<PlacedBox> all;
  for (const Eigen::Vector3d& at : places) {
    all.push_back({Eigen::Isometry3d(Eigen::Translation3d(at)), half});
  }
  return all;
}

void add_boxes(RobotScene& scene, const std::vector<PlacedBox>& boxes) {
  for (const PlacedBox& box : boxes) {
    scene.add_body("box" + std::to_string(scene.size()),
                   make_box({2 * box.half.x(), 2 * box.half.y(), 2 * box.half.z()}),
                   resting_at(box.X_WB.translation()));
  }
}

std::vector<std::array<std::size_t, 2>> pairs_with_all(std::size_t moving, std::size_t all) {
  std::vector<std::array<std::size_t, 2>> pairs;
  for (std::size_t a = 0; a < moving; ++a) {
    for (std::size_t b = a + 1; b < all; ++b) {
      pairs.push_back({a, b});
    }
  }
  return pairs;
}

TEST(OmplLastValid, IsNearTheContactOfAnArm) {
  const std::vector<PlacedBox> still = boxes_at(
      {{0.5, 0.5, 0.0}, {-0.6, 0.3, 0.2}, {0.4, -0.5, -0.4}, {0.0, 0.8, 0.5}}, {0.05, 0.05, 0.05});
  const BoxArm arm({{.is_continuous = true},
                    {},
                    {.follows = 1, .multiplier = -0.75, .offset = 0.25},
                    {},
                    {},
                    {}});
  RobotScene scene;
  add_boxes(scene, still);
  const std::size_t number = scene.add_robot("arm", arm.rest());
  const Proven proven(
      PlanScene{.scene = std::move(scene), .robots = {number}, .space = arm.space()});
  const BoxCase of{
      .boxes =
          [&](const Configuration& q) {
            std::vector<PlacedBox> all = arm.links(q);
            all.insert(all.end(), still.begin(), still.end());
            return all;
          },
      .way = [&](const Configuration& a, const Configuration& b) { return 2.0 * arm.way(a, b); },
      .pairs = pairs_with_all(6, 6 + still.size())};
  EXPECT_GT(expect_last_valid_states(proven, of, 400), 40);
}

TEST(OmplLastValid, IsNearTheContactOfABody) {
  const Eigen::Vector3d half{0.25, 0.1, 0.04};
  const std::vector<PlacedBox> still = boxes_at(
      {{0.3, 0.3, 0.0}, {-0.6, 0.3, 0.2}, {0.4, -0.5, -0.4}, {0.0, 0.9, 0.5}}, {0.2, 0.3, 0.1});
  RobotScene scene;
  add_boxes(scene, still);
  const Proven proven(with_bar(std::move(scene), {2 * half.x(), 2 * half.y(), 2 * half.z()}));
  const BoxCase of{
      .boxes =
          [&](const Configuration& q) {
            std::vector<PlacedBox> all = {placed_box(q, half)};
            all.insert(all.end(), still.begin(), still.end());
            return all;
          },
      .way = [&](const Configuration& a, const Configuration& b) { return way_of_box(a, b, half); },
      .pairs = pairs_with_all(1, 1 + still.size())};
  EXPECT_GT(expect_last_valid_states(proven, of, 300), 100);
}

}  // namespace
}  // namespace firstcontact::test
