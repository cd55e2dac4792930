#include <firstcontact/haptic_devices/detail/haply_protocol.h>

#include <string>

#include <gtest/gtest.h>

#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>

#include "haptic_devices/haply_messages.h"

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

std::string refusal(const std::string& text) {
  try {
    (void)parse_haply_message(text, {});
  } catch (const ParseError& error) {
    return error.what();
  }
  return "no error";
}

TEST(HaplyMessage, IsReadAsTheServiceBefore35WritesIt) {
  const HaplyMessage message = parse_haply_message(test::kInventoryBefore35, {});
  EXPECT_FALSE(message.has_session);
  EXPECT_EQ(message.device_id, "04BA");
  EXPECT_EQ(message.model, "inverse3");
  EXPECT_TRUE(message.ready);
  ASSERT_TRUE(message.position);
  EXPECT_EQ(*message.position, Vector3d(0.07842738, -0.14836666, 0.14297646));
  EXPECT_EQ(message.velocity, Vector3d(-0.011969013, 0.0012009288, -0.043197));
  ASSERT_TRUE(message.orientation);
  EXPECT_NEAR(message.orientation->norm(), 1.0, 1e-15);
  EXPECT_NEAR(message.orientation->y(), 0.8632202, 1e-3);
  EXPECT_EQ(message.buttons, 1U);
}

TEST(HaplyMessage, IsReadAsTheServiceSince35WritesIt) {
  const HaplyMessage message = parse_haply_message(test::kInventorySince35, {});
  EXPECT_TRUE(message.has_session);
  EXPECT_EQ(message.device_id, "049D");
  EXPECT_EQ(*message.position, Vector3d(0.0, -0.12, 0.15));
  ASSERT_TRUE(message.orientation);
  EXPECT_EQ(message.orientation->x(), 1.0);
  EXPECT_EQ(message.buttons, 6U);  // b and c.
}

TEST(HaplyMessage, MayHaveNoDevice) {
  EXPECT_EQ(parse_haply_message("{}", {}).device_id, "");
  EXPECT_EQ(parse_haply_message(R"({"inverse3":[],"verse_grip":[]})", {}).device_id, "");
  const HaplyMessage message = parse_haply_message(R"({"inverse3":[{"device_id":"A"}]})", {});
  EXPECT_EQ(message.device_id, "A");
  EXPECT_FALSE(message.position);
  EXPECT_FALSE(message.orientation);
}

TEST(HaplyMessage, GivesTheChosenDevices) {
  const std::string two =
      R"({"inverse3":[{"device_id":"A"},{"device_id":"B","state":{"cursor_position":{"x":1,"y":2,"z":3}}}],)"
      R"("custom_verse_grip":[{"device_id":"G","state":{"orientation":{"w":1,"x":0,"y":0,"z":0}}},)"
      R"({"device_id":"H","state":{"buttons":{"button_1":true,"button_0":false}}}]})";
  EXPECT_EQ(parse_haply_message(two, {}).device_id, "A");
  const HaplyMessage message = parse_haply_message(two, {"B", "H"});
  EXPECT_EQ(*message.position, Vector3d(1.0, 2.0, 3.0));
  EXPECT_FALSE(message.orientation);
  EXPECT_EQ(message.buttons, 2U);
  EXPECT_EQ(parse_haply_message(two, {"C", ""}).device_id, "");
}

TEST(HaplyMessage, NamesThePlaceOfWhatMakesNoSense) {
  EXPECT_NE(refusal("[]").find("expected an object"), std::string::npos);
  EXPECT_NE(refusal(R"({"inverse3":{}})").find("inverse3: expected a list of devices"),
            std::string::npos);
  const auto position = [](const std::string& value) {
    return refusal(R"({"inverse3":[{"device_id":"A","state":{"cursor_position":)" + value + "}}]}");
  };
  EXPECT_EQ(position(R"({"x":0,"y":0,"z":0})"), "no error");
  EXPECT_NE(position(R"({"x":0,"y":0})").find("inverse3[0].state.cursor_position"),
            std::string::npos)
      << position(R"({"x":0,"y":0})");
  EXPECT_NE(position(R"({"x":"0","y":0,"z":0})").find("cursor_position.x"), std::string::npos);
  EXPECT_NE(position(R"({"x":11,"y":0,"z":0})").find("a number of at most 10"), std::string::npos);
  EXPECT_NE(position("null").find("cursor_position"), std::string::npos);
}

/// A message with the position of an Inverse3, and a grip.
HaplyMessage with_grip(const std::string& grip) {
  return parse_haply_message(
      R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":0,"y":0,"z":1}}}],)"
      R"("wireless_verse_grip":[)" +
          grip + "]}",
      {});
}

// The position counts all the same: a grip that sleeps must not stop the device.
TEST(HaplyMessage, LeavesOutAGripThatMakesNoSense) {
  for (
      const char* grip :
      {R"({"device_id":"G","state":{"orientation":{"w":0,"x":0,"y":0,"z":0},"buttons":{"a":true}}})",
       R"({"device_id":"G","state":{"buttons":{"a":1}}})", R"({"device_id":null})", "7"}) {
    const HaplyMessage message = with_grip(grip);
    EXPECT_EQ(message.position.value().z(), 1.0) << grip;
    EXPECT_FALSE(message.orientation) << grip;
    EXPECT_EQ(message.buttons, 0U) << grip;
    EXPECT_NE(message.grip_problem, "") << grip;
  }
  EXPECT_NE(with_grip(R"({"device_id":"G","state":{"orientation":{"w":0,"x":0,"y":0,"z":0}}})")
                .grip_problem.find("a quaternion of length 1"),
            std::string::npos);
}

TEST(HaplyMessage, ReleasesTheButtonsOfAGripThatIsGone) {
  const auto grip = [](const std::string& status) {
    return with_grip(R"({"device_id":"G","state":{"orientation":{"w":1,"x":0,"y":0,"z":0},)"
                     R"("buttons":{"a":true}},"status":)" +
                     status + "}");
  };
  EXPECT_EQ(grip(R"({"connected":true,"ready":true})").buttons, 1U);
  EXPECT_EQ(grip("{}").buttons, 1U);
  for (const char* status : {R"({"connected":false})", R"({"connected":true,"ready":false})"}) {
    EXPECT_EQ(grip(status).buttons, 0U);
    EXPECT_FALSE(grip(status).orientation);
    EXPECT_EQ(grip(status).grip_problem, "");
  }
}

TEST(HaplyForce, HasTheKeyOfItsGeneration) {
  const Vector3d force(1.5, -0.25, 1e-30);
  const JsonValue newer = parse_json(haply_force("049D", force, "vector", "a \"b\""), "newer");
  EXPECT_EQ(haply_force("049D", force, "values", ""),
            R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"values":)"
            R"({"x":1.5,"y":-0.25,"z":1e-30}}}}]})");
  const auto& members = std::get<JsonObject>(newer.value);
  ASSERT_NE(find(members, "session"), nullptr);
  ASSERT_NE(find(members, "inverse3"), nullptr);
}

}  // namespace
}  // namespace firstcontact::detail
