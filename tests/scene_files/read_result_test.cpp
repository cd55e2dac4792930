#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_result.h>

#include <string>

#include <gtest/gtest.h>

#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_result.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::body;
using test::falling;
using test::scene;

TEST(ReadVerdict, ReadsBackWhatWasWritten) {
  for (const std::string height : {"1", "5", "0"}) {
    ShapeCache cache;
    ManyBodiesWorkspace workspace;
    const std::string text = scene(body("floor") + "," + body("stone", falling(height, "-4")));
    const LoadedScene loaded = load_scene(parse_scene(text, "s"), cache);
    const SceneResult result = check_scene(loaded, workspace);
    EXPECT_EQ(read_summary(write_result(loaded, result), "r").verdict, result.verdict);
  }
  EXPECT_EQ(read_summary(write_error("a", "s.jsonl", 3, "wrong"), "r").verdict, std::nullopt);
}

TEST(ReadVerdict, RefusesWhatIsNoResult) {
  for (const std::string text : {"", "{", "[]", "{}", R"({"verdict": "maybe"})"}) {
    try {
      (void)read_summary(text, "r.jsonl", 7);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const ParseError& error) {
      EXPECT_EQ(error.line(), 7) << text;
    }
  }
}

TEST(ReadResult, ReadsBackTheSceneAndWhatIsProven) {
  ShapeCache cache;
  ManyBodiesWorkspace workspace;
  const std::string text = scene(body("floor") + "," + body("stone", falling("1", "-4")));
  const LoadedScene loaded = load_scene(parse_scene(text, "s"), cache);
  const SceneResult result = check_scene(loaded, workspace);
  const StoredResult stored = read_result(write_result(loaded, result), "r");
  EXPECT_EQ(stored.t, result.t);
  EXPECT_EQ(stored.clearance, result.clearance);
  EXPECT_EQ(write_scene(stored.scene), write_scene(loaded.scene));
}

TEST(ReadResult, RefusesWhatIsNoResultOfAScene) {
  for (const std::string& text :
       {std::string("[]"), std::string(R"({"verdict": "free"})"),
        std::string(R"({"verdict": "free", "scene": {}})"), write_error("a", "s", 3, "wrong")}) {
    EXPECT_THROW((void)read_result(text, "r"), ParseError) << text;
  }
}

}  // namespace
}  // namespace firstcontact
