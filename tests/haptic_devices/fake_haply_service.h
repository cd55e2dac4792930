/// @file
/// A Haply Inverse Service of the tests, on a real socket.

#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include <firstcontact/haptic_devices/detail/websocket.h>

#include "haptic_devices/haply_messages.h"
#include "haptic_devices/local_server.h"

namespace firstcontact::test {

/// Service that answers each message with one state; members set its errors.
class FakeHaplyService {
 public:
  explicit FakeHaplyService(std::string inventory) : inventory_(std::move(inventory)) {
    std::tie(listener_, port_) = listen_tcp();
    thread_ = std::thread([this] { run(); });
  }

  ~FakeHaplyService() {
    stopped = true;
    thread_.join();
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }

  [[nodiscard]] std::vector<std::string> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }

  [[nodiscard]] std::string last_message() const {
    const std::lock_guard lock(mutex_);
    return messages_.empty() ? std::string() : messages_.back();
  }

  void set_answer(std::string answer) {
    const std::lock_guard lock(mutex_);
    answer_ = std::move(answer);
  }

  std::atomic<bool> stopped{false};
  std::atomic<bool> hang_up{false};  ///< Ends the connection once.
  std::atomic<bool> mute{false};     ///< Sends no answer.
  std::atomic<int> drop_every{0};    ///< Leaves out each n-th answer; 0 for none.
  std::atomic<int> delay_us{0};      ///< [us]  Delay before each answer.
  std::atomic<bool> ping{false};     ///< Sends a ping once.
  std::atomic<bool> split{false};    ///< Sends answers as two frames.
  std::atomic<int> pongs{0};         ///< Number of pongs that were received.
  std::atomic<int> connections{0};

 private:
  void run() {
    while (!stopped) {
      if (!readable(listener_.number(), 1)) {
        continue;
      }
      const detail::FileDescriptor socket(::accept(listener_.number(), nullptr, nullptr));
      if (shake_hands(socket)) {
        ++connections;
        send_bytes(socket, frame(inventory_));
        serve(socket);
      }
    }
  }

  static std::string frame(const std::string& text) {
    return detail::websocket_frame(detail::WebSocketKind::text, text, std::nullopt);
  }

  static bool shake_hands(const detail::FileDescriptor& socket) {
    std::string request;
    while (true) {
      const std::string more = receive_bytes(socket, 20'000);
      request += more;
      const auto head = detail::http_head(request);
      if (head) {
        const auto answer = detail::websocket_answer(*head);
        send_bytes(socket, answer ? *answer : "HTTP/1.1 400 Bad Request\r\n\r\n");
        return answer.has_value();
      }
      if (more.empty()) {
        return false;
      }
    }
  }

  void serve(const detail::FileDescriptor& socket) {
    detail::WebSocketReader reader(detail::WebSocketSide::server, 1 << 20);
    while (!stopped && !hang_up.exchange(false)) {
      if (ping.exchange(false)) {
        send_bytes(socket, detail::websocket_frame(detail::WebSocketKind::ping, "?", std::nullopt));
      }
      if (!readable(socket.number(), 1)) {
        continue;
      }
      const std::string bytes = receive_bytes(socket, 0);
      if (bytes.empty()) {
        return;
      }
      reader.add(bytes);
      while (const auto message = reader.next()) {
        if (message->kind == detail::WebSocketKind::text) {
          take(socket, message->payload);
        } else if (message->kind == detail::WebSocketKind::pong) {
          ++pongs;
        } else if (message->kind == detail::WebSocketKind::close) {
          return;
        }
      }
      if (!reader.failure().empty()) {
        const std::lock_guard lock(mutex_);
        messages_.push_back("failure: " + reader.failure());
        return;
      }
    }
  }

  void take(const detail::FileDescriptor& socket, const std::string& text) {
    std::string answer;
    {
      const std::lock_guard lock(mutex_);
      messages_.push_back(text);
      answer = answer_;
    }
    ++count_;
    if (mute || (drop_every > 0 && count_ % drop_every == 0)) {
      return;
    }
    if (delay_us > 0) {
      std::this_thread::sleep_for(std::chrono::microseconds(delay_us));
    }
    if (split) {
      std::string first = frame(answer.substr(0, answer.size() / 2));
      first[0] = 0x01;
      std::string second = frame(answer.substr(answer.size() / 2));
      second[0] = static_cast<char>(0x80);
      send_bytes(socket, first);
      send_bytes(socket, second);
    } else {
      send_bytes(socket, frame(answer));
    }
  }

  std::string inventory_;
  detail::FileDescriptor listener_;
  std::uint16_t port_ = 0;
  mutable std::mutex mutex_;
  std::string answer_;
  std::vector<std::string> messages_;
  int count_ = 0;
  std::thread thread_;
};

}  // namespace firstcontact::test
