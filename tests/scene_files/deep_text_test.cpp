#include <chrono>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/parse_yaml.h>
#include <firstcontact/trajectory_files/read_trajectory.h>

#include "scene/crane.h"

namespace firstcontact {
namespace {

std::string repeated(const std::string& text, std::size_t count) {
  std::string result;
  for (std::size_t k = 0; k < count; ++k) {
    result += text;
  }
  return result;
}

/// The error of a reader; one line, or the test fails.
template <class Read>
std::string deep_text_error(Read read, const std::string& name) {
  try {
    (void)read();
  } catch (const ParseError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << name;
    return error.what();
  }
  return "accepted";
}

/// Lists and maps inside each other, as deep as hostile files have them; closed or not.
std::vector<std::string> deep_yaml() {
  constexpr std::size_t kDeep = 10'000;
  std::string block;
  for (std::size_t k = 0; k < 2000; ++k) {  // Indentation makes it quadratic.
    block += std::string(k, ' ') + "a:\n";
  }
  return {repeated("[", kDeep),
          repeated("[", kDeep) + repeated("]", kDeep),
          repeated("{a: ", kDeep) + "1" + repeated("}", kDeep),
          repeated("- ", kDeep) + "1",
          repeated("? ", kDeep) + "1",
          repeated("[{a: ", kDeep),
          repeated("&a [", kDeep),
          repeated("!!seq [", kDeep),
          repeated("{? ", kDeep),
          block};
}

TEST(DeepText, IsAnErrorOfOneLineInYaml) {
  for (const std::string& text : deep_yaml()) {
    const std::string shown = text.substr(0, 12);
    EXPECT_NE(deep_text_error([&] { return detail::parse_yaml(text, "t.yaml"); }, shown),
              "accepted");
    EXPECT_NE(
        deep_text_error([&] { return parse_trajectory(text, "t.yaml", test::crane()); }, shown),
        "accepted");
    EXPECT_NE(
        deep_text_error([&] { return parse_planning_scene(text, "t.yaml", "ground"); }, shown),
        "accepted");
    EXPECT_NE(deep_text_error([&] { return parse_planning_request(text, "t.yaml", test::crane()); },
                              shown),
              "accepted");
  }
}

TEST(DeepText, IsAnErrorOfOneLineInJson) {
  constexpr std::size_t kDeep = 10'000;
  for (const std::string& text :
       {repeated("[", kDeep), repeated("[", kDeep) + repeated("]", kDeep),
        repeated("{\"a\":", kDeep), repeated("{\"a\":", kDeep) + "1" + repeated("}", kDeep)}) {
    EXPECT_NE(
        deep_text_error([&] { return detail::parse_json(text, "t.json"); }, text.substr(0, 6)),
        "accepted");
    EXPECT_NE(deep_text_error([&] { return parse_scene(text, "t.json"); }, text.substr(0, 6)),
              "accepted");
  }
}

/// Each line repeats the one before it ten times.
std::string laughs(int lines, const std::string& open, const std::string& close) {
  std::string text = "a0: &a0 " + open + repeated("1, ", 9) + "1" + close + "\n";
  for (int k = 1; k < lines; ++k) {
    const std::string before = "*a" + std::to_string(k - 1);
    text += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " " + open +
            repeated(before + ", ", 9) + before + close + "\n";
  }
  return text;
}

TEST(DeepText, IsNotGrownByAliases) {
  const std::string message = deep_text_error(
      [] { return parse_trajectory(laughs(12, "[", "]"), "t.yaml", test::crane()); }, "lists");
  EXPECT_NE(message.find("expected aliases that repeat at most 1000000 values, got more"),
            std::string::npos)
      << message;
  // One level more each time: the depth ends it, too.
  std::string deep = "a0: &a0 [1]\n";
  for (int k = 1; k < 200; ++k) {
    deep += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [*a" + std::to_string(k - 1) +
            "]\n";
  }
  EXPECT_NE(deep_text_error([&] { return detail::parse_yaml(deep, "t.yaml"); }, "deep"),
            "accepted");
}

TEST(DeepText, AllowsWhatAliasesAreFor) {
  const detail::JsonValue root = detail::parse_yaml(laughs(5, "[", "]"), "t.yaml");
  EXPECT_EQ(std::get<detail::JsonObject>(root.value).size(), 5u);
}

TEST(YamlDocuments, AreOneWithEmptyOnesAround) {
  for (const std::string text :
       {"a: 1\n", "---\na: 1\n", "---\n---\na: 1\n", "a: 1\n---\n---\n---\n", "---\na: 1\n...\n",
        "--- # nothing\n...\n---\na: 1\n---\n# nothing\n---\n", "%YAML 1.2\n---\na: 1\n",
        "\n\n---\n\n---\na: 1\n\n---\n\n"}) {
    try {
      const detail::JsonValue root = detail::parse_yaml(text, "t.yaml");
      EXPECT_EQ(std::get<detail::JsonObject>(root.value).size(), 1u) << text;
    } catch (const ParseError& error) {
      ADD_FAILURE() << error.what() << " of\n" << text;
    }
  }
}

TEST(YamlDocuments, AreNotTwo) {
  EXPECT_EQ(deep_text_error(
                [] { return detail::parse_yaml("---\na: 1\n---\n---\nb: 1\n", "t.yaml"); }, ""),
            "t.yaml:5: expected one YAML document, got a second one");
  EXPECT_EQ(deep_text_error([] { return detail::parse_yaml("---\n---\n", "t.yaml"); }, ""),
            "t.yaml:1: expected a YAML document, got none");
}

}  // namespace
}  // namespace firstcontact
