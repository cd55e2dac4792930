// "haptics" of a scene: every key, its default, and what is refused.

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/haptic_question.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/load_text.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

HapticQuestion haptics_of(const std::string& haptics) {
  const std::string moved = R"("motion": {"type": "constant_velocity", "translation": [0, 0, 1]})";
  return parse_scene(test::scene(test::body("plate") + "," + test::body("peg") + "," +
                                     test::body("belt", moved) + "," +
                                     test::body("loose", R"("dynamics": {})"),
                                 "\"haptics\": " + haptics),
                     "s")
      .haptics.value();
}

/// A question of one tool, the peg; `inside` are its other keys.
HapticToolQuestion tool_of(const std::string& inside) {
  return haptics_of(R"({"tools": [{"body": "peg")" + inside + "}]}").tools.at(0);
}

std::string haptics_said(const std::string& haptics) {
  const std::string place = "s:1: haptics";
  const std::string text = test::message_of<ParseError>([&] { (void)haptics_of(haptics); });
  return text.starts_with(place) ? text.substr(place.size()) : text;
}

TEST(HapticsFile, HasTheDefaultsOfItsStruct) {
  const HapticQuestion read = haptics_of(R"({"tools": [{"body": "peg"}]})");
  const HapticQuestion plain;
  EXPECT_EQ(read.tools.at(0).body, 1u);
  EXPECT_FALSE(read.contact_distance);
  EXPECT_EQ(read.friction, plain.friction);
  EXPECT_EQ(read.force_rate, plain.force_rate);
  EXPECT_EQ(read.contact_rate, plain.contact_rate);
  EXPECT_EQ(read.max_force, plain.max_force);
  EXPECT_EQ(read.max_torque, plain.max_torque);
  EXPECT_EQ(read.force_slew, plain.force_slew);
  EXPECT_EQ(read.torque_slew, plain.torque_slew);
  const HapticToolQuestion& tool = read.tools[0];
  EXPECT_EQ(tool.stiffness, HapticToolQuestion().stiffness);
  EXPECT_FALSE(tool.begins_at_handle);
  EXPECT_FALSE(tool.clutch_button);
  EXPECT_FALSE(tool.dead_man_button);
}

TEST(HapticsFile, HasGripsOfRobotsAlone) {
  EXPECT_NE(haptics_said(R"({"tools": [{"body": "peg", "grips": []}]})")
                .find("expected \"grips\" with a \"robot\" alone"),
            std::string::npos);
  EXPECT_EQ(haptics_of(R"({"tools": [{"body": "peg"}], "max_grip_effort": 3})").max_grip_effort,
            3.0);
}

TEST(HapticsFile, TakesEveryKey) {
  const HapticQuestion read = haptics_of(
      R"({"tools": [{"body": "plate", "begins_at_handle": true}, {"body": "peg", "stiffness": 1, "angular_stiffness": 2,
           "damping": 0, "scale": 4, "centre": [5, 6, 7], "device_axes": {"rpy": [0, 0, 0.5]},
           "handle": {"position": [8, 9, 10]}, "begins_at_handle": false, "clutch_button": 0,
           "dead_man_button": 31}],
          "contact_distance": 1e-4, "friction": 0.5, "force_rate": 1000000, "contact_rate": 1,
          "max_force": 0, "max_torque": 11, "force_slew": 12, "torque_slew": 13})");
  ASSERT_EQ(read.tools.size(), 2u);
  EXPECT_EQ(read.tools[0].body, 0u);
  const HapticToolQuestion& tool = read.tools[1];
  EXPECT_EQ(tool.stiffness, 1.0);
  EXPECT_EQ(tool.angular_stiffness, 2.0);
  EXPECT_EQ(tool.damping, 0.0);
  EXPECT_EQ(tool.scale, 4.0);
  EXPECT_EQ(tool.centre, Eigen::Vector3d(5, 6, 7));
  EXPECT_NEAR(tool.device_axes.z(), std::sin(0.25), 1e-15);
  EXPECT_EQ(tool.handle.position, Eigen::Vector3d(8, 9, 10));
  EXPECT_TRUE(read.tools[0].begins_at_handle);
  EXPECT_FALSE(tool.begins_at_handle);
  EXPECT_EQ(tool.clutch_button, 0);
  EXPECT_EQ(tool.dead_man_button, 31);
  EXPECT_EQ(read.contact_distance, 1e-4);
  EXPECT_EQ(read.friction, 0.5);
  EXPECT_EQ(read.force_rate, 1e6);
  EXPECT_EQ(read.contact_rate, 1.0);
  EXPECT_EQ(read.max_force, 0.0);
  EXPECT_EQ(read.max_torque, 11.0);
  EXPECT_EQ(read.force_slew, 12.0);
  EXPECT_EQ(read.torque_slew, 13.0);
}

TEST(HapticsFile, HasNoContactRateAboveItsForceRate) {
  const std::string tools = R"({"tools": [{"body": "peg"}], )";
  EXPECT_EQ(haptics_of(tools + R"("force_rate": 500})").contact_rate, 500.0);
  EXPECT_EQ(haptics_of(tools + R"("force_rate": 8000})").contact_rate, 1000.0);
}

TEST(HapticsFile, SaysWhatIsWrong) {
  const std::string tools = R"({"tools": [{"body": "peg"}], )";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[]",
       ": expected an object with \"tools\", \"contact_distance\", \"friction\", \"force_rate\", "
       "\"contact_rate\", \"max_force\", \"max_torque\", \"force_slew\", \"torque_slew\", "
       "\"max_grip_effort\", got an array of 0"},
      {"{}", ": expected a key \"tools\", got none"},
      {R"({"tools": "peg"})", ".tools: expected an array of tools, got \"peg\""},
      {R"({"tools": []})", ".tools: expected 1 or 2 tools, got 0"},
      {tools + R"("max_forces": 1})", ".max_forces: unknown key; did you mean \"max_force\"?"},
      {tools + R"("contact_distance": 0})", ".contact_distance: expected a number > 0, got 0"},
      {tools + R"("friction": -1})", ".friction: expected a number >= 0, got -1"},
      {tools + R"("max_force": -1})", ".max_force: expected a number >= 0, got -1"},
      {tools + R"("max_torque": "5"})", ".max_torque: expected a number, got \"5\""},
      {tools + R"("force_slew": 0})", ".force_slew: expected a number > 0, got 0"},
      {tools + R"("torque_slew": null})", ".torque_slew: expected a number, got null"},
      {tools + R"("force_rate": 1000001})", ".force_rate: expected 100 Hz to 1e6 Hz, got 1000001"},
      {tools + R"("force_rate": 99})", ".force_rate: expected 100 Hz to 1e6 Hz, got 99"},
      {tools + R"("contact_rate": 0.5})", ".contact_rate: expected 1 Hz or more, got 0.5"},
      {tools + R"("force_rate": 500, "contact_rate": 501})",
       ": expected a \"contact_rate\" that is at most the \"force_rate\""},
      {tools + R"("contact_rate": 4001})",
       ": expected a \"contact_rate\" that is at most the \"force_rate\""}};
  for (const auto& [haptics, message] : cases) {
    EXPECT_EQ(haptics_said(haptics), message) << haptics;
  }
  EXPECT_EQ(haptics_said(R"({"tools": [{"body": "peg"}, {"body": "plate"}, {"body": "peg"}]})"),
            ".tools[2].body: expected another body than that of the other tool");
}

TEST(HapticsFile, SaysWhatIsWrongWithATool) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"("body": "peq")",
       ".body: expected a body of the scene (\"plate\", \"peg\", \"belt\", \"loose\"), got "
       "\"peq\""},
      {R"("body": 1)", ".body: expected the name of a body, got 1"},
      {R"("scale": 1)", ": expected either \"body\" or \"robot\", got neither"},
      {R"("body": "belt")",
       ".body: expected a body with a \"pose\" alone: a device moves \"belt\""},
      {R"("body": "loose")",
       ".body: expected a body with a \"pose\" alone: a device moves \"loose\""},
      {R"("body": "peg", "stiffness": 0)", ".stiffness: expected a number > 0, got 0"},
      {R"("body": "peg", "angular_stiffness": -1)",
       ".angular_stiffness: expected a number > 0, got -1"},
      {R"("body": "peg", "stiffness": 1e20)",
       ".stiffness: expected a number > 0 of at most 1e17, got 1e+20"},
      {R"("body": "peg", "angular_stiffness": 1e18)",
       ".angular_stiffness: expected a number > 0 of at most 1e17, got 1e+18"},
      {R"("body": "peg", "damping": -1)", ".damping: expected a number >= 0, got -1"},
      {R"("body": "peg", "scale": 0)", ".scale: expected a number > 0, got 0"},
      {R"("body": "peg", "scale": 1e7)",
       ".scale: expected a number > 0 of at most 1e6, got 10000000"},
      {R"("body": "peg", "centre": [1, 2])", ".centre: expected three numbers, got an array of 2"},
      {R"("body": "peg", "device_axes": {"position": [0, 0, 5e-324]})",
       ".device_axes: expected a rotation alone, got a position too"},
      {R"("body": "peg", "handle": [])",
       ".handle: expected an object with \"position\", \"quaternion_wxyz\", \"rpy\", "
       "\"rotation_vector\", \"matrix\", got an array of 0"},
      {R"("body": "peg", "handle": {}, "begins_at_handle": true)",
       ".begins_at_handle: expected either a \"handle\" or \"begins_at_handle\": true, got both"},
      {R"("body": "peg", "begins_at_handle": 1)",
       ".begins_at_handle: expected true or false, got 1"},
      {R"("body": "peg", "clutch_button": -1)",
       ".clutch_button: expected a button, an integer from 0 to 31, got -1"},
      {R"("body": "peg", "dead_man_button": 1.5)",
       ".dead_man_button: expected a button, an integer from 0 to 31, got 1.5"},
      {R"("body": "peg", "clutch_button": 2, "dead_man_button": 2)",
       ".dead_man_button: expected another button than that of the clutch: the tool would never be "
       "felt"},
      {R"("body": "peg", "stifness": 1)", ".stifness: unknown key; did you mean \"stiffness\"?"}};
  for (const auto& [tool, message] : cases) {
    EXPECT_EQ(haptics_said(R"({"tools": [{"body": "plate"}, {)" + tool + "}]}"),
              ".tools[1]" + message)
        << tool;
  }
  // A position of zeros is none.
  EXPECT_EQ(tool_of(R"(, "device_axes": {"position": [0, -0.0, 0]})").device_axes.w(), 1.0);
}

}  // namespace
}  // namespace firstcontact
