// The lines that a page draws of trees: bounded in number, and where the mover is.

#include "drawn_path.h"

#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>

namespace firstcontact::app {
namespace {

ScenePlan plan_of_a_box() {
  const Scene scene = parse_scene(R"({"firstcontact": 1,
      "bodies": [{"name": "box", "shape": {"box": {"size": [1, 1, 1]}}}],
      "plan": {"body": "box", "goal": {"position": [9, 0, 0]}}})",
                                  "scene.json");
  ShapeCache cache;
  return make_scene_plan(scene, scene.plan.value(), cache);
}

/// A tree whose places are 1 mm apart along x.
SearchTree tree_of(SearchTreeKind kind, std::size_t edges) {
  SearchTree tree{.kind = kind};
  for (std::size_t k = 0; k <= edges; ++k) {
    tree.places.push_back({1e-3 * static_cast<double>(k), 0, 0, 1, 0, 0, 0});
    if (k > 0) {
      tree.edges.push_back({k - 1, k});
    }
  }
  return tree;
}

TEST(DrawnTrees, KeepTheirFirstEdges) {
  const std::vector<TreeLook> drawn = drawn_trees(
      plan_of_a_box(),
      {tree_of(SearchTreeKind::from_start, 25'000), tree_of(SearchTreeKind::from_goals, 1'000)});
  ASSERT_EQ(drawn.size(), 2u);
  EXPECT_EQ(drawn[0].kind, "start");
  EXPECT_EQ(drawn[1].kind, "goals");
  EXPECT_EQ(drawn[0].places, 25'001u);
  EXPECT_EQ(drawn[0].edges, 25'000u);
  ASSERT_EQ(drawn[0].movers.size(), 1u);
  EXPECT_EQ(drawn[0].movers[0].name, "box");
  EXPECT_EQ(drawn[0].movers[0].lines.size(), 19'000u);  // A small tree leaves its room.
  EXPECT_EQ(drawn[1].movers[0].lines.size(), 1'000u);
  const auto& last = drawn[0].movers[0].lines.back();
  EXPECT_EQ(last.size(), 2u);
  EXPECT_NEAR(last.front().x(), 18.999, 1e-12);
  EXPECT_NEAR(last.back().x(), 19.0, 1e-12);
}

TEST(DrawnTrees, ShareTheRoomWhereBothAreLarge) {
  const std::vector<TreeLook> drawn = drawn_trees(
      plan_of_a_box(),
      {tree_of(SearchTreeKind::from_start, 30'000), tree_of(SearchTreeKind::from_goals, 12'000)});
  EXPECT_EQ(drawn[0].movers[0].lines.size(), 10'000u);
  EXPECT_EQ(drawn[1].movers[0].lines.size(), 10'000u);
}

TEST(DrawnTrees, AreNoneWithoutTrees) { EXPECT_TRUE(drawn_trees(plan_of_a_box(), {}).empty()); }

}  // namespace
}  // namespace firstcontact::app
