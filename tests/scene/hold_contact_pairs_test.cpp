// Contact pairs get their distances, whatever paddings there are; all other pairs stay what they
// were.

#include <firstcontact/scene/hold_contact_pairs.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>

#include "scene/robot_text.h"

namespace firstcontact::test {
namespace {

/// Two arms, one of which has paddings, beside a post 0.5 mm off the side of the first one's bar.
Scene padded_scene(const ArmFolder& folder, const std::string& pairs = "{}") {
  return parse_scene(R"({"firstcontact": 1, "bodies": [
      {"name": "post", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}, "pose": {"position": [0.5, 0.1005, 0]}},
      {"name": "wall", "shape": {"box": {"size": [0.1, 5, 5]}}, "pose": {"position": [2, 0, 0]}}],
      "robots": [{"name": "arm", "urdf": "arm.urdf", "padding": {"bar": 0.02, "tip": 0.003}},
                 {"name": "far", "urdf": "arm.urdf", "padding": 0.05, "base": {"position": [0, -9, 0]}}],
      "options": {"margin": 0.01}, "pairs": )" +
                         pairs + "}",
                     folder.path() / "scene.json");
}

NamedContactPair held(const std::string& a, const std::string& b, double distance) {
  return {{a, b}, ContactPolicy::may_stay, PathEnd::start, distance};
}

/// The margins of all tested pairs by name.
std::map<std::string, double> margins_of(const LoadedScene& loaded) {
  std::map<std::string, double> margins;
  for (std::size_t b = 0; b < loaded.robots->size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (const std::optional<double> margin = margin_of_pair(loaded, {a, b})) {
        margins[loaded.robots->name(a) + " " + loaded.robots->name(b)] = *margin;
      }
    }
  }
  return margins;
}

TEST(HoldContactPairs, TakesTheDistanceInPlaceOfMarginAndPaddings) {
  const ArmFolder folder;
  const std::string rules = R"({"margin": [["wall", "arm/bar", 0.2]],
      "ignore": [["wall", "arm/tip"]]})";
  ShapeCache cache;
  const auto before = margins_of(load_scene(padded_scene(folder, rules), cache));
  EXPECT_DOUBLE_EQ(before.at("wall arm/bar"), 0.22);
  EXPECT_DOUBLE_EQ(before.at("post arm/bar"), 0.03);
  EXPECT_DOUBLE_EQ(before.at("arm/tip far/bar"), 0.063);
  Scene scene = padded_scene(folder, rules);
  hold_contact_pairs(std::vector{held("arm/bar", "post", 4e-4), held("far/bar", "arm/tip", 1e-3)},
                     scene);
  EXPECT_DOUBLE_EQ(scene.options.tolerance, 1e-6);
  const auto after = margins_of(load_scene(scene, cache));
  ASSERT_EQ(after.size(), before.size());
  for (const auto& [pair, margin] : before) {
    if (pair == "post arm/bar") {
      EXPECT_EQ(after.at(pair), 4e-4);
    } else if (pair == "arm/tip far/bar") {
      EXPECT_EQ(after.at(pair), 1e-3);
    } else {
      EXPECT_NEAR(after.at(pair), margin, 1e-15) << pair;
    }
  }
}

TEST(HoldContactPairs, ShowsThePairFree) {
  const ArmFolder folder;
  Scene scene = padded_scene(folder);
  ShapeCache cache;
  ManyBodiesWorkspace workspace;
  const auto result_of = [&](const Scene& asked) {
    return check_scene(load_scene(asked, cache), workspace, {.closest = true});
  };
  EXPECT_EQ(result_of(scene).verdict, Verdict::contact_at_start);
  hold_contact_pairs(std::vector{held("arm/bar", "post", 2.5e-4)}, scene);
  const SceneResult result = result_of(scene);
  EXPECT_EQ(result.verdict, Verdict::free);
  EXPECT_NEAR(result.pairs.at(result.closest.value()).closest->distance, 5e-4, 1e-6);
  // A pair that is nearer than its distance is not hidden.
  hold_contact_pairs(std::vector{held("arm/bar", "post", 6e-4)}, scene);
  EXPECT_EQ(result_of(scene).verdict, Verdict::contact_at_start);
}

TEST(HoldContactPairs, KeepsTheToleranceSmallBesideTheDistance) {
  const ArmFolder folder;
  Scene scene = padded_scene(folder);
  hold_contact_pairs(std::vector{held("arm/bar", "post", 1e-6)}, scene);
  EXPECT_DOUBLE_EQ(scene.options.tolerance, 1e-8);
  Scene same = padded_scene(folder);
  hold_contact_pairs({}, same);
  EXPECT_EQ(same.robots[0].padding, padded_scene(folder).robots[0].padding);
  EXPECT_THROW(hold_contact_pairs(std::vector{held("arm/bar", "pole", 1e-6)}, same),
               std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact::test
