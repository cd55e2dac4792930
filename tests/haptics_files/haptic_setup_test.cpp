// Haptic settings of a scene file, and those that are refused.

#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

std::string scene_text(const std::string& haptics, const std::string& of_tool = "") {
  return R"({"firstcontact": 1, "bodies": [
    {"name": "peg", "shape": {"box": {"size": [1, 1, 1]}})" +
         of_tool + R"(},
    {"name": "plate", "shape": {"box": {"size": [9, 9, 1]}}, "pose": {"position": [0, 0, -5]},
     "surface": {"friction": 0.25}}],
    "haptics": )" +
         haptics + "}";
}

TEST(HapticSetup, TakesWhatTheSceneSays) {
  Scene scene = parse_scene(
      scene_text(R"({"tools": [{"body": "peg", "stiffness": 500, "scale": 2, "clutch_button": 3}],
                     "contact_distance": 1e-5, "friction": 0.5, "max_force": 4,
                     "contact_rate": 500})"),
      "scene.json");
  ShapeCache cache;
  prepare_haptics(scene, cache, 2.0);
  EXPECT_EQ(scene.simulation->step, 0.002);
  const HapticSetup setup = haptic_setup(load_scene(std::move(scene), cache));
  ASSERT_EQ(setup.scene.tools.size(), 1U);
  EXPECT_EQ(setup.scene.tools[0].coupling.stiffness, 500.0);
  EXPECT_EQ(setup.scene.tools[0].friction, 0.5);
  EXPECT_EQ(setup.scene.bodies.at(0).friction, 0.25);
  EXPECT_EQ(setup.scene.contact_distance, 1e-5);
  EXPECT_EQ(setup.options.forces.limits.force, 4.0);
  EXPECT_EQ(setup.options.mappings[0].scale, 2.0);
  EXPECT_EQ(setup.options.mappings[0].clutch_button, 3);
  EXPECT_EQ(setup.options.mappings[0].dead_man_button, -1);
}

/// The centre that a tool has without "centre".
Eigen::Vector3d default_centre(const std::string& shape) {
  Scene scene = parse_scene(R"({"firstcontact": 1, "bodies": [{"name": "peg", "shape": )" + shape +
                                R"(}], "haptics": {"tools": [{"body": "peg"}]}})",
                            "scene.json");
  ShapeCache cache;
  prepare_haptics(scene, cache, 1.0);
  return haptic_setup(load_scene(std::move(scene), cache)).scene.tools[0].p_BC;
}

// The middle along the axes of the mesh: that of the smallest box depends on its triangles.
TEST(HapticSetup, CentresAToolInTheMiddleOfItsBounds) {
  const std::string pyramid =
      R"("vertices": [[0, 0, 0], [4, 0, 0], [4, 3, 1], [0, 3, 1], [1, 2, 9]],
    "triangles": [[0, 1, 2], [0, 2, 3], [0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]])";
  EXPECT_EQ(default_centre("{" + pyramid + "}"), Eigen::Vector3d(2.0, 1.5, 4.5));
  for (const char* cone : {R"({"cone": {"radius": 0.01, "length": 0.02}})",
                           R"({"cone": {"radius": 0.01, "length": 0.05}})"}) {
    EXPECT_LT(default_centre(cone).norm(), 1e-6) << cone;
  }
}

void expect_refused(const std::string& text, const std::string& part) {
  try {
    (void)parse_scene(text, "scene.json");
    FAIL() << "accepted: " << text;
  } catch (const ParseError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(HapticSetup, NamesWhatIsWrong) {
  expect_refused(scene_text("{}"), "\"tools\"");
  expect_refused(scene_text(R"({"tools": []})"), "1 or 2 tools");
  expect_refused(scene_text(R"({"tools": [{"body": "nail"}]})"), "\"peg\", \"plate\"");
  expect_refused(scene_text(R"({"tools": [{"body": "peg"}, {"body": "peg"}]})"), "another body");
  expect_refused(scene_text(R"({"tools": [{"body": "peg", "stiffness": 0}]})"), "stiffness");
  expect_refused(scene_text(R"({"tools": [{"body": "peg", "clutch_button": 32}]})"), "button");
  expect_refused(scene_text(R"({"tools": [{"body": "peg"}], "force_rate": 1e9})"), "1e6");
  expect_refused(scene_text(R"({"tools": [{"body": "peg"}], "contact_rate": 9000})"), "force_rate");
  expect_refused(scene_text(R"({"tools": [{"body": "peg"}], "wobble": 1})"), "wobble");
  expect_refused(scene_text(R"({"tools": [{"body": "peg"}]})", R"(, "dynamics": {})"), "pose");
}

/// Returns the message of the error in a scene that can be read.
std::string refusal(const std::string& text) {
  Scene scene = parse_scene(text, "scene.json");
  ShapeCache cache;
  try {
    prepare_haptics(scene, cache, 1.0);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

// Friction of pairs, gravity and steps would be left out, and nobody would know.
TEST(HapticSetup, RefusesWhatSimulationsAloneHave) {
  const std::string haptics = R"({"tools": [{"body": "peg"}]})";
  EXPECT_EQ(refusal(scene_text(haptics)), "none");
  EXPECT_NE(refusal(scene_text(haptics + R"(, "simulation": {"step": 0.01})"))
                .find("haptics: expected no \"simulation\""),
            std::string::npos);
  EXPECT_NE(refusal(scene_text(haptics, R"(, "surface": {"restitution": 0.5})"))
                .find("haptics: expected no \"restitution\" of \"peg\""),
            std::string::npos);
}

TEST(HapticSetup, RefusesScenesWithoutHaptics) {
  Scene scene = parse_scene(
      R"({"firstcontact": 1, "bodies": [{"name": "a", "shape": {"sphere": {"radius": 1}}}]})",
      "scene.json");
  ShapeCache cache;
  EXPECT_THROW(prepare_haptics(scene, cache, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
