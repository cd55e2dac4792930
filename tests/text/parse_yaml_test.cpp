#include <firstcontact/text/parse_yaml.h>

#include <numbers>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {
namespace {

/// The value of the key `a` of a document.
JsonVariant value_of_a(const std::string& text) {
  const JsonValue root = parse_yaml(text, "limits.yaml");
  return find(std::get<JsonObject>(root.value), "a")->value;
}

std::string refusal(const std::string& text) {
  try {
    (void)parse_yaml(text, "limits.yaml");
  } catch (const ParseError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ParseYaml, TakesDegreesAndRadiansByTheirTag) {
  EXPECT_EQ(std::get<double>(value_of_a("a: !degrees 180.0")), std::numbers::pi);
  EXPECT_DOUBLE_EQ(std::get<double>(value_of_a("a: !degrees -30")), -std::numbers::pi / 6.0);
  EXPECT_EQ(std::get<double>(value_of_a("a: !radians 1.5")), 1.5);
  EXPECT_EQ(std::get<double>(value_of_a("a: !!float 2")), 2.0);
  EXPECT_EQ(std::get<std::string>(value_of_a("a: !!str 2")), "2");
  EXPECT_EQ(std::get<std::string>(value_of_a("a: '2'")), "2");
  EXPECT_EQ(std::get<bool>(value_of_a("a: !!bool true")), true);
  EXPECT_EQ(std::get<JsonArray>(value_of_a("a: !!seq [1, !degrees 90]")).size(), 2u);
}

// What a tag does to a number is not known, so no other tag is passed over.
TEST(ParseYaml, RefusesOtherTagsByTheirLine) {
  EXPECT_EQ(refusal("b: 1\na: !percent 30\n"),
            "limits.yaml:2: expected no tag but !degrees and !radians, got \"!percent\"");
  EXPECT_EQ(refusal("a: !degrees fast\n"),
            "limits.yaml:1: expected a number after !degrees, got \"fast\"");
  for (const char* text : {"a: !degrees [30, 40]", "a: !!python/tuple [1, 2]", "a: !set {b: 1}",
                           "a: !!int fast", "a: !!bool 1", "a: !degrees"}) {
    EXPECT_NE(refusal(text), "accepted") << text;
  }
}

}  // namespace
}  // namespace firstcontact::detail
