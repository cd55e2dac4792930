// A plan gives the same contacts, whether another plan was searched before it or not.

#include <algorithm>
#include <random>
#include <stop_token>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/island/detail/impact_search.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/simulation_model/detail/obstacles.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>
#include <firstcontact/simulation_model/detail/step_start.h>

#include "simulation/random_body.h"

namespace firstcontact::detail {
namespace {

using test::random_rotation;
using test::random_vector;

constexpr std::size_t kBoxes = 30;
constexpr double kSpan = 0.1;  // [s]

/// Boxes in a plate's neighbourhood, the plate first.
LoadedScene boxes_beside_a_plate(ShapeCache& cache) {
  std::string scene = R"({"firstcontact": 1, "simulation": {}, "bodies": [
      {"name": "plate", "shape": {"box": {"size": [9, 9, 1]}}})";
  for (std::size_t k = 1; k <= kBoxes; ++k) {
    scene += R"(, {"name": ")" + std::to_string(k) +
             R"(", "shape": {"box": {"size": [1, 0.6, 0.4]}}, "dynamics": {}})";
  }
  return load_scene(parse_scene(scene + "]}", "test.json"), cache);
}

/// An island of all boxes on a lattice, turned at random.
class Island {
 public:
  explicit Island(std::mt19937& rng)
      : loaded_(boxes_beside_a_plate(cache_)),
        linked_(links_as_bodies(loaded_)),
        model_(loaded_, linked_),
        start_(start(rng)),
        around_(model_, start_),
        state({model_, start_, around_, guesses_, stop_}, members()) {
    state.find_manifolds(guesses_, workspace);
  }

 private:
  static std::vector<std::size_t> members() {
    std::vector<std::size_t> all;
    for (std::size_t k = 1; k <= kBoxes; ++k) {
      all.push_back(k);
    }
    return all;
  }

  [[nodiscard]] static StepStart start(std::mt19937& rng) {
    StepStart start{.h = kSpan,
                    .states = std::vector<RigidState>(kBoxes + 1),
                    .scripted = std::vector<Move>(kBoxes + 1)};
    for (std::size_t k = 1; k <= kBoxes; ++k) {  // On a lattice, so that none overlap.
      const auto place = [&](std::size_t i) { return 1.4 * static_cast<double>(i) - 2.0; };
      start.states[k].X_WB = {
          {place(k % 4), place(k / 4 % 4), 1.3 + 1.4 * static_cast<double>(k / 16)},
          random_rotation(rng)};
    }
    return start;
  }

  ShapeCache cache_;
  LoadedScene loaded_;
  LinksAsBodies linked_;
  SimulationModel model_;
  StepStart start_;
  Obstacles around_;
  std::vector<ManifoldPoint> guesses_;
  std::stop_token stop_;

 public:
  IslandState state;
  Workspace workspace;
};

Plan random_plan(std::mt19937& rng) {
  Plan plan;
  for (std::size_t k = 0; k < kBoxes; ++k) {
    plan.moves.push_back({random_vector(rng, 0.3), random_vector(rng, 0.3)});
  }
  return plan;
}

void expect_same(const std::vector<Impact>& found, const std::vector<Impact>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].bodies, expected[k].bodies);
    EXPECT_EQ(found[k].t, expected[k].t);
    EXPECT_EQ(found[k].is_slight, expected[k].is_slight);
    ASSERT_EQ(found[k].ahead.size(), expected[k].ahead.size());
    for (std::size_t i = 0; i < found[k].ahead.size(); ++i) {
      EXPECT_EQ(found[k].ahead[i].least, expected[k].ahead[i].least);
      EXPECT_EQ(found[k].ahead[i].touch.point, expected[k].ahead[i].touch.point);
      EXPECT_EQ(found[k].ahead[i].touch.normal, expected[k].ahead[i].touch.normal);
      EXPECT_EQ(found[k].ahead[i].contact.arm_A, expected[k].ahead[i].contact.arm_A);
    }
  }
}

// Pairs of which neither body moves otherwise than in the plan before are not asked again.
TEST(ImpactSearch, FindsTheSameAfterOtherPlans) {
  std::mt19937 rng(1);
  std::size_t hits = 0;
  for (int island = 0; island < 10; ++island) {
    Island boxes(rng);
    ImpactSearch search(boxes.state, kSpan, boxes.workspace);
    Plan plan = random_plan(rng);
    for (int round = 0; round < 6; ++round) {
      const std::vector<Impact> found = search.find(plan);
      ImpactSearch afresh(boxes.state, kSpan, boxes.workspace);
      expect_same(found, afresh.find(plan));
      EXPECT_EQ(search.clearance(), afresh.clearance());
      hits += found.size();
      const Plan other = random_plan(rng);
      for (std::size_t k = 0; k < kBoxes; ++k) {
        if (rng() % 4 == 0) {
          plan.moves[k] = other.moves[k];
        }
      }
    }
  }
  EXPECT_GE(hits, 200);
}

// Against queries of all pairs.
TEST(ImpactSearch, LeavesOutNoPair) {
  std::mt19937 rng(2);
  std::size_t hits = 0;
  for (int island = 0; island < 10; ++island) {
    Island boxes(rng);
    IslandState& state = boxes.state;
    const Plan plan = random_plan(rng);
    const std::vector<Impact> found = ImpactSearch(state, kSpan, boxes.workspace).find(plan);
    for (std::size_t a = 0; a <= kBoxes; ++a) {
      for (std::size_t b = std::max<std::size_t>(a + 1, 1); b <= kBoxes; ++b) {
        const auto motion = [&](std::size_t body) {
          return motion_of(state.model.bodies[body], state.pose_of(body),
                           body == 0 ? Move() : plan.moves[body - 1]);
        };
        FirstContactOptions options;
        options.margin = state.model.distances.least;
        options.tolerance = 1e-9;
        const FirstContactResult truth =
            first_contact({state.model.bodies[a].shape, motion(a)},
                          {state.model.bodies[b].shape, motion(b)}, boxes.workspace, options);
        const auto hit = std::ranges::find(found, BodyPair{a, b}, &Impact::bodies);
        if (truth.verdict != Verdict::free) {
          ++hits;
          ASSERT_NE(hit, found.end()) << a << " " << b;
          EXPECT_LE(hit->t, truth.t + 1e-6);
        }
      }
    }
  }
  EXPECT_GE(hits, 30);
}

}  // namespace
}  // namespace firstcontact::detail
