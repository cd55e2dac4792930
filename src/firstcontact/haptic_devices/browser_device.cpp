#include <firstcontact/haptic_devices/browser_device.h>

#include <algorithm>
#include <array>
#include <list>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include <firstcontact/haptic_devices/detail/driver_report.h>
#include <firstcontact/haptic_devices/detail/mouse_protocol.h>
#include <firstcontact/haptic_devices/detail/quiet_state.h>
#include <firstcontact/haptic_devices/detail/socket.h>
#include <firstcontact/haptic_devices/detail/websocket.h>
#include <firstcontact/haptic_devices/mail_slot.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

using detail::WebSocketKind;

constexpr std::int64_t kRoundNs = 4'000'000;     // [ns]  Pause between rounds over the connections.
constexpr std::int64_t kPictureNs = 16'000'000;  // [ns]  Pause between messages to the page.
// [ns]  Time after which a side that takes nothing is given up.
constexpr std::int64_t kStillNs = 2'000'000'000;
constexpr std::size_t kMostPoseMessage = 4096;  // [byte]  Greatest length of a pose.
constexpr std::size_t kMostConnections = 16;

std::string http_answer(const char* status, std::string_view text) {
  return std::string("HTTP/1.1 ") + status +
         "\r\nContent-Type: text/html; charset=utf-8\r\nCache-Control: no-store\r\n"
         "X-Frame-Options: DENY\r\nConnection: close\r\nContent-Length: " +
         std::to_string(text.size()) + "\r\n\r\n" + std::string(text);
}

}  // namespace

struct BrowserDevice::Data {
  struct Connection {
    detail::FileDescriptor socket;
    std::string request = {};
    std::optional<detail::WebSocketReader> reader = {};  // Set once it is a WebSocket.
    std::string left = {};                               // Bytes to send.
    std::int64_t moved_ns = steady_now_ns();  // Time at which it last sent or took something.
    bool ends = false;                        // Whether it ends once all is sent.
    bool closed = false;                      // Whether nothing more is read or sent.

    [[nodiscard]] bool is_page() const { return reader && !ends && !closed; }
  };

  explicit Data(const BrowserDeviceOptions& options) {
    std::string problem;
    listener = detail::listen_local_tcp(options.port, port, problem);
    if (!listener.is_open()) {
      throw std::runtime_error("cannot serve a page at 127.0.0.1:" + std::to_string(options.port) +
                               ": " + problem + "; name another port, or none for a free one");
    }
    capabilities.name = "mouse";
    capabilities.id = "127.0.0.1:" + std::to_string(port);
    capabilities.sensed = DegreesOfFreedom::all();
    capabilities.grips = static_cast<int>(kMostGrips);
    report.set_problem("no page is open yet");
  }

  /// Whether a request addresses this machine by its own name, through a tunnel or not. It also has
  /// to come from a page of this device or from a program. Another name may be that of a foreign
  /// page.
  [[nodiscard]] static bool is_own(const detail::HttpHead& head) {
    const std::string name = head.host.substr(0, head.host.rfind(':'));
    const std::string suffix = head.host.substr(name.size());
    return (name == "127.0.0.1" || name == "localhost") &&
           (head.origin.empty() || head.origin == "http://127.0.0.1" + suffix ||
            head.origin == "http://localhost" + suffix);
  }

  [[nodiscard]] bool has_page() const {
    return std::ranges::any_of(connections, &Connection::is_page);
  }

  /// Ends a connection with an answer.
  static void end(Connection& connection, const char* status, std::string_view text) {
    connection.left += http_answer(status, text);
    connection.ends = true;
  }

  void answer(Connection& connection, const detail::HttpHead& head) {
    if (!is_own(head)) {
      end(connection, "403 Forbidden", "this page is for 127.0.0.1 and localhost only");
      return;
    }
    const auto shakes_hands = detail::websocket_answer(head);
    if (!head.first_line.starts_with("GET /live ") || !shakes_hands) {
      const bool is_page = head.first_line.starts_with("GET / ");
      end(connection, is_page ? "200 OK" : "404 Not Found",
          is_page ? page : "there is a page at / only");
      return;
    }
    if (has_page()) {
      end(connection, "403 Forbidden", "another page has the session");
      return;
    }
    connection.reader.emplace(detail::WebSocketSide::server, kMostPoseMessage);
    connection.reader->add(std::string_view(connection.request).substr(head.size));
    connection.left += *shakes_hands;
    ++report.connections;
    report.set_problem("the page has not moved the tool yet");
  }

  // Samples come before counts, and reasons before states: a thread that sees the second finds the
  // first.
  void take(const std::string& text) {
    try {
      detail::take_mouse_message(text, state);
      state.status = DeviceStatus::live;
      state.time_ns = steady_now_ns();
      ++state.sequence;
      report.set_problem({});
      states.put(state);
      ++report.samples;
    } catch (const ParseError& error) {
      report.set_problem(error.what());
      ++report.malformed;
    }
  }

  void read(Connection& connection) {
    std::array<char, 16'384> buffer{};
    const detail::Received received = detail::receive(connection.socket, buffer);
    const std::string_view bytes(buffer.data(), received.count);
    if (connection.ends) {
      return;  // A side that sends no more may still take its answer.
    }
    connection.closed = !received.open;
    connection.moved_ns = received.count > 0 ? steady_now_ns() : connection.moved_ns;
    if (!connection.reader) {
      connection.request.append(bytes);
      if (const auto head = detail::http_head(connection.request)) {
        answer(connection, *head);
      } else if (connection.request.size() > detail::kMostHttpHead) {
        connection.closed = true;
      }
      return;
    }
    connection.reader->add(bytes);
    while (const auto message = connection.reader->next()) {
      if (message->kind == WebSocketKind::text) {
        take(message->payload);
      } else if (message->kind == WebSocketKind::ping) {
        connection.left += detail::websocket_frame(WebSocketKind::pong, message->payload, {});
      } else if (message->kind == WebSocketKind::close) {
        connection.closed = true;
      }
    }
    connection.closed = connection.closed || !connection.reader->failure().empty();
  }

  /// Sends as much as goes at once. Gives up a side that has taken or sent nothing for long; an
  /// open page may be silent.
  static void send(Connection& connection) {
    const std::int64_t now = steady_now_ns();
    if (!connection.left.empty() && !connection.closed) {
      const std::optional<std::size_t> sent = detail::send_some(connection.socket, connection.left);
      connection.closed = !sent;
      connection.left.erase(0, sent.value_or(0));
      connection.moved_ns = sent.value_or(0) > 0 ? now : connection.moved_ns;
    }
    const bool is_done = connection.left.empty();
    const bool waits = !is_done || !connection.reader;
    connection.closed = connection.closed || (connection.ends && is_done) ||
                        (waits && now - connection.moved_ns > kStillNs);
  }

  /// Gives the newest picture to a page that has taken all before it.
  void show_newest() {
    for (Connection& connection : connections) {
      if (!connection.is_page() || !connection.left.empty()) {
        continue;
      }
      std::string text;
      {
        const std::lock_guard lock(mutex);
        text = std::exchange(picture, {});
      }
      if (!text.empty()) {
        connection.left = detail::websocket_frame(WebSocketKind::text, text, {});
        connection.moved_ns = steady_now_ns();
      }
    }
  }

  void run() {
    std::int64_t shown_ns = steady_now_ns();
    while (detail::wait_for(stop, steady_now_ns() + kRoundNs) != detail::WaitEnd::stopped) {
      if (connections.size() < kMostConnections) {  // Others wait.
        detail::FileDescriptor socket = detail::accept_one(listener);
        if (socket.is_open()) {
          connections.push_back({.socket = std::move(socket)});
        }
      }
      const bool had_page = has_page();
      for (Connection& connection : connections) {
        read(connection);
      }
      if (steady_now_ns() - shown_ns >= kPictureNs) {
        shown_ns = steady_now_ns();
        show_newest();
      }
      std::ranges::for_each(connections, send);
      if (had_page && !has_page()) {
        state = detail::quiet(state, DeviceStatus::lost);
        report.set_problem("the page was closed");
        states.put(state);
      }
      connections.remove_if([](const Connection& connection) { return connection.closed; });
    }
  }

  // The states in an order without gaps.
  MailSlot<DeviceState> states;
  DeviceState state;  // For the device's thread only.
  detail::FileDescriptor listener;
  std::list<Connection> connections;
  std::string page;
  std::mutex mutex;
  std::string picture;  // The newest message for the page.
  DeviceCapabilities capabilities;
  detail::DriverReport report;
  detail::StopSignal stop;
  std::thread thread;
  std::uint16_t port = 0;
};

BrowserDevice::BrowserDevice(const BrowserDeviceOptions& options)
    : data_(std::make_unique<Data>(options)) {}

BrowserDevice::~BrowserDevice() {
  data_->stop.set();
  if (data_->thread.joinable()) {
    data_->thread.join();
  }
}

std::uint16_t BrowserDevice::port() const noexcept { return data_->port; }

void BrowserDevice::serve(std::string page) {
  data_->page = std::move(page);
  data_->thread = std::thread([data = data_.get()] { data->run(); });
}

void BrowserDevice::show(std::string_view message) {
  const std::lock_guard lock(data_->mutex);
  data_->picture = message;
}

const DeviceCapabilities& BrowserDevice::capabilities() const noexcept {
  return data_->capabilities;
}

DeviceState BrowserDevice::read(std::int64_t /*now_ns*/) noexcept { return data_->states.newest(); }

void BrowserDevice::command(const ForceCommand& /*command*/, std::int64_t /*now_ns*/) noexcept {}

DeviceCounts BrowserDevice::counts() const { return data_->report.counts(); }

std::string BrowserDevice::problem() const { return data_->report.problem(); }

}  // namespace firstcontact
