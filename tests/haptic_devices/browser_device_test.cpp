#include <firstcontact/haptic_devices/browser_device.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/haptic_devices/detail/websocket.h>

#include "haptic_devices/local_server.h"

namespace firstcontact {
namespace {

using test::eventually;
using test::send_bytes;

/// A page without a browser.
class FakePage {
 public:
  explicit FakePage(std::uint16_t port, const std::string& origin = {},
                    const std::string& host = "127.0.0.1") {
    std::string problem;
    socket_ =
        detail::connect_tcp("127.0.0.1", port, stop_, steady_now_ns() + 20'000'000'000, problem);
    std::string request =
        detail::websocket_request(host, port, "/live", "dGhlIHNhbXBsZSBub25jZQ==");
    if (!origin.empty()) {
      request.insert(request.size() - 2, "Origin: " + origin + "\r\n");
    }
    send_bytes(socket_, request);
    while (!detail::http_head(answer)) {
      const std::string more = test::receive_bytes(socket_, 20'000);
      if (more.empty()) {
        return;
      }
      answer += more;
    }
  }

  void send(const std::string& text) {
    send_bytes(socket_, detail::websocket_frame(detail::WebSocketKind::text, text, 7));
  }

  std::string receive() { return test::receive_bytes(socket_, 20'000); }

  std::string answer;

 private:
  detail::StopSignal stop_;
  detail::FileDescriptor socket_;
};

DeviceState state_of_browser(BrowserDevice& device) { return device.read(steady_now_ns()); }

TEST(BrowserDevice, FollowsItsPageAndIsLostWithIt) {
  BrowserDevice device;
  device.serve("a page");
  EXPECT_EQ(state_of_browser(device).status, DeviceStatus::waiting);
  EXPECT_EQ(device.problem(), "no page is open yet");
  {
    FakePage page(device.port());
    ASSERT_TRUE(page.answer.starts_with("HTTP/1.1 101")) << page.answer;
    page.send(R"({"position": [1, 2, 3], "rotation": [0, 1, 0, 0]})");
    ASSERT_TRUE(eventually([&] { return device.counts().samples == 1; }));
    EXPECT_EQ(state_of_browser(device).status, DeviceStatus::live);
    EXPECT_EQ(state_of_browser(device).X_DH.position, Eigen::Vector3d(1.0, 2.0, 3.0));
    EXPECT_EQ(state_of_browser(device).X_DH.rotation.x(), 1.0);
    EXPECT_EQ(state_of_browser(device).grips[0], 0.0);
    page.send(R"({"position": [1, 2, 3], "rotation": [0, 1, 0, 0], "grip": 0.25})");
    ASSERT_TRUE(eventually([&] { return device.counts().samples == 2; }));
    EXPECT_EQ(state_of_browser(device).grips[0], 0.25);
    EXPECT_EQ(state_of_browser(device).grips[kMostGrips - 1], 0.25);
    device.show("a picture");
    EXPECT_NE(page.receive().find("a picture"), std::string::npos);
  }
  ASSERT_TRUE(eventually([&] { return state_of_browser(device).status == DeviceStatus::lost; }));
  EXPECT_EQ(state_of_browser(device).X_DH.position, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_TRUE(eventually([&] { return device.problem() == "the page was closed"; }));
  const FakePage again(device.port());
  EXPECT_TRUE(again.answer.starts_with("HTTP/1.1 101")) << again.answer;
}

TEST(BrowserDevice, DropsPosesThatMakeNoSense) {
  BrowserDevice device;
  device.serve("a page");
  FakePage page(device.port());
  for (const char* text : {"", "{}", R"({"position": [0, 0], "rotation": [1, 0, 0, 0]})",
                           R"({"position": [0, 0, 1e9], "rotation": [1, 0, 0, 0]})",
                           R"({"position": [0, 0, 0], "rotation": [0, 0, 0, 0]})",
                           R"({"position": [0, 0, "x"], "rotation": [1, 0, 0, 0]})",
                           R"({"position": [0, 0, 0], "rotation": [1, 0, 0, 0], "grip": 1e9})"}) {
    page.send(text);
  }
  ASSERT_TRUE(eventually([&] { return device.counts().malformed == 7; }));
  EXPECT_EQ(state_of_browser(device).status, DeviceStatus::waiting);
  page.send(std::string(5000, ' '));  // Longer than any pose: the connection ends.
  EXPECT_TRUE(eventually([&] { return state_of_browser(device).status == DeviceStatus::lost; }));
}

TEST(BrowserDevice, RefusesPagesOfOtherSitesAndASecondOne) {
  BrowserDevice device;
  device.serve("a page");
  EXPECT_TRUE(FakePage(device.port(), "http://example.com").answer.starts_with("HTTP/1.1 403"));
  EXPECT_TRUE(FakePage(device.port(), "http://localhost:80").answer.starts_with("HTTP/1.1 403"));
  const FakePage own(device.port(), "http://localhost:" + std::to_string(device.port()));
  EXPECT_TRUE(own.answer.starts_with("HTTP/1.1 101"));
  EXPECT_TRUE(FakePage(device.port()).answer.starts_with("HTTP/1.1 403"));
}

/// The answer to a plain request.
std::string answer_to(std::uint16_t port, const std::string& request) {
  detail::StopSignal stop;
  std::string problem;
  const detail::FileDescriptor socket =
      detail::connect_tcp("127.0.0.1", port, stop, steady_now_ns() + 20'000'000'000, problem);
  send_bytes(socket, request);
  return test::receive_bytes(socket, 20'000);
}

// A name of another site may be made to lead here: its pages must not read the geometry.
TEST(BrowserDevice, AnswersToItsOwnNameOnly) {
  BrowserDevice device;
  device.serve("a page");
  const std::string port = ":" + std::to_string(device.port());
  const auto get = [&](const std::string& host) {
    return answer_to(device.port(), "GET / HTTP/1.1\r\n" + host + "\r\n");
  };
  const std::string own = get("Host: 127.0.0.1" + port + "\r\n");
  EXPECT_TRUE(own.starts_with("HTTP/1.1 200")) << own;
  EXPECT_NE(own.find("X-Frame-Options: DENY"), std::string::npos);
  EXPECT_TRUE(get("Host: localhost:8080\r\n").starts_with("HTTP/1.1 200"));  // A tunnel.
  EXPECT_TRUE(get("Host: localhost\r\n").starts_with("HTTP/1.1 200"));
  EXPECT_TRUE(get("Host: evil.example" + port + "\r\n").starts_with("HTTP/1.1 403"));
  EXPECT_TRUE(get("Host: localhost.evil.example\r\n").starts_with("HTTP/1.1 403"));
  EXPECT_TRUE(get("").starts_with("HTTP/1.1 403"));
  EXPECT_TRUE(FakePage(device.port(), "http://evil.example" + port, "evil.example")
                  .answer.starts_with("HTTP/1.1 403"));
}

// Pictures that the page does not take must not hold back its poses.
TEST(BrowserDevice, FollowsAPageThatTakesNoPictures) {
  BrowserDevice device;
  device.serve("a page");
  FakePage page(device.port());
  const std::string large(1'000'000, ' ');
  for (std::uint64_t k = 1; k <= 50; ++k) {
    device.show(large);
    page.send(R"({"position": [1, 2, 3], "rotation": [1, 0, 0, 0]})");
    ASSERT_TRUE(eventually([&] { return device.counts().samples == k; })) << k;
  }
  device.show("the last picture");
  std::string seen;
  while (seen.find("the last picture") == std::string::npos) {
    seen = seen.substr(seen.size() - std::min<std::size_t>(seen.size(), 100));
    const std::string more = page.receive();
    ASSERT_FALSE(more.empty());
    seen += more;
  }
}

TEST(BrowserDevice, LeavesSidesThatSayNothing) {
  BrowserDevice device;
  device.serve("a page");
  detail::StopSignal stop;
  std::string problem;
  std::vector<detail::FileDescriptor> silent;
  for (int k = 0; k < 16; ++k) {
    silent.push_back(detail::connect_tcp("localhost", device.port(), stop,
                                         steady_now_ns() + 20'000'000'000, problem));
    ASSERT_TRUE(silent.back().is_open()) << problem;
  }
  const FakePage page(device.port());
  EXPECT_TRUE(page.answer.starts_with("HTTP/1.1 101")) << page.answer;
}

TEST(Sockets, EndALookUpOfAName) {
  std::string problem;
  detail::StopSignal stop;
  EXPECT_FALSE(detail::connect_tcp("no-such-host.invalid", 1, stop,
                                   steady_now_ns() + 20'000'000'000, problem)
                   .is_open());
  EXPECT_FALSE(problem.empty());
  stop.set();
  EXPECT_FALSE(detail::connect_tcp("127.0.0.1", 1, stop, steady_now_ns() + 20'000'000'000, problem)
                   .is_open());
  EXPECT_EQ(problem, "no answer about its name in time");
}

TEST(BrowserDevice, NamesAPortThatIsTaken) {
  const BrowserDevice device;
  try {
    const BrowserDevice other({.port = device.port()});
    FAIL();
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(":" + std::to_string(device.port()) + ": "), std::string::npos);
    EXPECT_NE(message.find("another port"), std::string::npos);
  }
}

}  // namespace
}  // namespace firstcontact
