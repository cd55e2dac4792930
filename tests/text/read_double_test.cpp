#include <firstcontact/text/read_double.h>

#include <cmath>
#include <string>
#include <system_error>
#include <variant>

#include <gtest/gtest.h>

#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/parse_yaml.h>

namespace firstcontact::detail {
namespace {

/// All of a text as a number.
double number_of(const std::string& text) {
  double value = 7.0;
  const auto [stop, error] = read_double(text.data(), text.data() + text.size(), value);
  EXPECT_EQ(error, std::errc()) << text;
  EXPECT_EQ(stop, text.data() + text.size()) << text;
  return value;
}

TEST(ReadDouble, TakesWhatIsTooSmallAsZeroWithItsSign) {
  for (const std::string text : {"1e-324", "1e-400", "9.9e-99999", "0.001e-323", "1e-99999999999",
                                 "123456e-400", "0.0000000000000000000001e-310"}) {
    EXPECT_EQ(number_of(text), 0.0) << text;
    EXPECT_FALSE(std::signbit(number_of(text))) << text;
    EXPECT_TRUE(std::signbit(number_of("-" + text))) << text;
  }
}

TEST(ReadDouble, TakesTheLeastNumbersAsTheyAre) {
  EXPECT_EQ(number_of("4.9e-324"), 4.9e-324);
  EXPECT_EQ(number_of("-2.2e-308"), -2.2e-308);
  EXPECT_EQ(number_of("0e-99999"), 0.0);
  EXPECT_EQ(number_of("1.5"), 1.5);
}

TEST(ReadDouble, LeavesWhatIsTooLargeAnError) {
  for (const std::string text : {"1e309", "-1e400", "0.001e9999", "1e99999999999", "123456e305"}) {
    double value = 7.0;
    const auto [stop, error] = read_double(text.data(), text.data() + text.size(), value);
    EXPECT_EQ(error, std::errc::result_out_of_range) << text;
    EXPECT_EQ(stop, text.data() + text.size()) << text;
  }
}

// JSON and YAML have the same numbers.
TEST(ReadDouble, IsTheSameInJsonAndYaml) {
  for (const std::string text : {"1e-400", "-1e-400", "4.9e-324", "-1.5e-5000"}) {
    const double json = std::get<double>(parse_json(text, "t.json").value);
    const JsonValue yaml = parse_yaml(text, "t.yaml");
    ASSERT_TRUE(std::holds_alternative<double>(yaml.value)) << text;
    EXPECT_EQ(std::get<double>(yaml.value), json) << text;
    EXPECT_EQ(std::signbit(std::get<double>(yaml.value)), std::signbit(json)) << text;
  }
  EXPECT_TRUE(std::holds_alternative<std::string>(parse_yaml("1e400", "t.yaml").value));
}

}  // namespace
}  // namespace firstcontact::detail
