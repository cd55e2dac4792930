// Messages of the mouse's page: a pose of a device, or a reason and an untouched state.

#include <firstcontact/haptic_devices/detail/mouse_protocol.h>

#include <string>

#include <gtest/gtest.h>

#include <firstcontact/haptic_devices/detail/quiet_state.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

/// The reason why a message is refused; empty where it is not.
std::string reason(const std::string& text) {
  DeviceState state;
  state.grips.fill(0.25);
  try {
    detail::take_mouse_message(text, state);
  } catch (const ParseError& error) {
    EXPECT_EQ(state.grips.front(), 0.25) << text;
    EXPECT_TRUE(state.X_DH.position.isZero(0.0)) << text;
    return error.what();
  }
  EXPECT_TRUE(detail::makes_sense(state)) << text;
  return "";
}

std::string message(const std::string& position, const std::string& rotation,
                    const std::string& grip = "0") {
  return R"({"position": )" + position + R"(, "rotation": )" + rotation + R"(, "grip": )" + grip +
         "}";
}

TEST(MouseProtocol, ReadsAPoseAndGrips) {
  DeviceState state;
  detail::take_mouse_message(message("[1, -2, 3e-3]", "[0.6, 0, 0.8, 0]", "0.5"), state);
  EXPECT_EQ(state.X_DH.position, Eigen::Vector3d(1.0, -2.0, 3e-3));
  EXPECT_LT((state.X_DH.rotation.coeffs() - Eigen::Vector4d(0.0, 0.8, 0.0, 0.6)).norm(), 1e-15);
  EXPECT_EQ(state.grips.back(), 0.5);
  detail::take_mouse_message(R"({"position": [0, 0, 0], "rotation": [1, 0, 0, 0]})", state);
  EXPECT_EQ(state.grips.back(), 0.0);
}

TEST(MouseProtocol, RefusesWhatIsNoPoseOfADevice) {
  const std::string still = "[1, 0, 0, 0]";
  EXPECT_EQ(reason(message("[1e6, 0, 0]", still)), "");
  EXPECT_NE(reason(message("[1e6, 1e6, 0]", still)), "");  // Each is in range, their length is not.
  EXPECT_NE(reason(message("[1.1e6, 0, 0]", still)), "");
  EXPECT_NE(reason(message("[0, 0]", still)), "");
  EXPECT_NE(reason(message("[0, 0, null]", still)), "");
  EXPECT_NE(reason(message("[0, 0, 0]", "[0, 0, 0, 0]")), "");
  EXPECT_NE(reason(message("[0, 0, 0]", "[2, 0, 0, 0]")), "");
  EXPECT_NE(reason(message("[0, 0, 0]", still, "1e7")), "");
  EXPECT_NE(reason(message("[0, 0, 0]", still, "\"shut\"")), "");
  EXPECT_NE(reason("[]"), "");
  EXPECT_NE(reason("{"), "");
  EXPECT_NE(reason(R"({"position": [0, 0, 0]})"), "");
}

}  // namespace
}  // namespace firstcontact
