#include <firstcontact/haptic_devices/haply.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include <firstcontact/haptic_devices/detail/driver_report.h>
#include <firstcontact/haptic_devices/detail/haply_protocol.h>
#include <firstcontact/haptic_devices/detail/quiet_state.h>
#include <firstcontact/haptic_devices/detail/socket.h>
#include <firstcontact/haptic_devices/detail/websocket.h>
#include <firstcontact/haptic_devices/mail_slot.h>
#include <firstcontact/text/base64.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

using detail::WaitEnd;
using detail::WebSocketKind;

constexpr std::size_t kMostMessage = 1 << 20;  // [byte]  Messages have some thousands.
constexpr int kMostOnTheWay = 2;               // Messages without an answer.
// [ns]  Time after which a message counts as lost.
constexpr std::int64_t kAnswerLostNs = 20'000'000;
constexpr std::int64_t kKeepAliveNs = 50'000'000;  // [ns]  Pause between empty messages.
constexpr std::int64_t kSendNs = 100'000'000;      // [ns]  Limit for one message.
constexpr std::string_view kEmptyMessage = "{}";   // Keeps a connection.
constexpr const char* kProfile = "firstcontact:haptics";

void require_haply(bool holds, const char* what) {
  if (!holds) {
    throw std::invalid_argument(std::string("HaplyOptions: ") + what);
  }
}

const HaplyOptions& checked_haply(const HaplyOptions& options) {
  require_haply(!options.host.empty() && options.port > 0, "host and port are needed");
  require_haply(options.max_force >= 0.0 && std::isfinite(options.max_force),
                "max_force must be >= 0");
  require_haply(options.centre.allFinite(), "centre must be finite");
  require_haply(options.workspace_radius > 0.0, "workspace_radius must be > 0");
  require_haply(options.rate > 0.0 && options.rate <= 1e5, "rate must be from 0 to 1e5");
  require_haply(options.silent_after_ns > 0 && options.lost_after_ns > 0 &&
                    options.connect_ns > 0 && options.retry_ns > 0,
                "times must be > 0");
  return options;
}

}  // namespace

struct Haply::Data {
  /// A command, with the time at which it was given.
  struct TimedForce {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    std::int64_t given_ns = std::numeric_limits<std::int64_t>::min();
  };

  /// One connection to the service.
  struct Link {
    detail::FileDescriptor socket;
    detail::WebSocketReader reader{detail::WebSocketSide::client, kMostMessage};
    std::int64_t since_ns = 0;
    bool closed = false;  // Whether the other side closed it.
  };

  explicit Data(const HaplyOptions& given) : options(checked_haply(given)) {
    choice = {options.device_id, options.grip_id};
  }

  [[nodiscard]] std::string place() const {
    return options.host + ":" + std::to_string(options.port);
  }

  // --- Frames.

  bool send(Link& link, WebSocketKind kind, std::string_view payload) {
    // The mask only has to differ; nothing here is secret.
    mask = mask * 1'664'525 + 1'013'904'223;
    return detail::send_all(link.socket, detail::websocket_frame(kind, payload, mask), stop,
                            steady_now_ns() + kSendNs);
  }

  /// Reads all bytes that are there. Texts go to `take`; pings are answered.
  template <class Take>
  void read_messages(Link& link, Take take) {
    std::array<char, 16'384> buffer{};
    const detail::Received received = detail::receive(link.socket, buffer);
    link.reader.add({buffer.data(), received.count});
    link.closed = link.closed || !received.open;
    while (const auto message = link.reader.next()) {
      if (message->kind == WebSocketKind::text) {
        take(message->payload);
      } else if (message->kind == WebSocketKind::ping) {
        (void)send(link, WebSocketKind::pong, message->payload);
      } else if (message->kind == WebSocketKind::close) {
        (void)send(link, WebSocketKind::close, message->payload.substr(0, 2));
        link.closed = true;
      }
    }
    link.closed = link.closed || !link.reader.failure().empty();
  }

  // --- Connections.

  /// Connects, with the handshake.
  [[nodiscard]] std::optional<Link> open(std::int64_t until_ns, std::string& problem) {
    Link link;
    link.socket = detail::connect_tcp(options.host, options.port, stop, until_ns, problem);
    std::string reason = problem;
    if (link.socket.is_open()) {
      reason = shake_hands(link, until_ns);
    }
    if (!reason.empty()) {
      problem = "no connection to the Haply Inverse Service at " + place() + ": " + reason +
                "; start Haply Hub or the service";
      return std::nullopt;
    }
    link.since_ns = steady_now_ns();
    return link;
  }

  /// Makes the handshake. Returns why the other side is not the service; empty if it is.
  [[nodiscard]] std::string shake_hands(Link& link, std::int64_t until_ns) {
    std::random_device random;
    std::array<std::uint8_t, 16> bytes{};
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(random());
    }
    mask = random();
    const std::string key = detail::base64(bytes);
    if (!detail::send_all(link.socket,
                          detail::websocket_request(options.host, options.port, "/", key), stop,
                          until_ns)) {
      return "it takes no request";
    }
    std::string answer;
    std::array<char, 4096> buffer{};
    while (answer.size() < detail::kMostHttpHead) {
      if (detail::wait_for(link.socket, detail::WaitFor::reading, stop, until_ns) !=
          WaitEnd::ready) {
        return "no answer in time";
      }
      const detail::Received received = detail::receive(link.socket, buffer);
      answer.append(buffer.data(), received.count);
      if (const auto head = detail::http_head(answer)) {
        link.reader.add(std::string_view(answer).substr(head->size));
        return detail::refused_because(*head, key);
      }
      if (!received.open) {
        return "it closed the connection";
      }
    }
    return "its answer is too long for one of a WebSocket";
  }

  /// Waits for the first state of a device, and keeps the connection until then.
  [[nodiscard]] std::optional<detail::HaplyMessage> await_device(Link& link, std::int64_t until_ns,
                                                                 std::string& problem) {
    problem = "the service at " + place() + " lists no " +
              (options.device_id.empty() ? "Inverse3" : "device " + options.device_id) +
              "; plug it in, and see that Haply Hub shows it";
    std::optional<detail::HaplyMessage> found;
    const auto take = [&](const std::string& text) {
      try {
        detail::HaplyMessage message = detail::parse_haply_message(text, choice);
        note_generation(message);
        if (!message.device_id.empty() && message.position) {
          found = std::move(message);
        }
      } catch (const ParseError& error) {
        ++report.malformed;
        problem = error.what();
      }
    };
    read_messages(link, take);
    while (!found && !link.closed && steady_now_ns() < until_ns) {
      const std::int64_t next_ns = std::min(until_ns, steady_now_ns() + kKeepAliveNs);
      if (detail::wait_for(link.socket, detail::WaitFor::reading, stop, next_ns) ==
          WaitEnd::ready) {
        read_messages(link, take);
      } else {
        (void)send(link, WebSocketKind::text, kEmptyMessage);
      }
    }
    if (link.closed) {
      problem = "the service at " + place() + " closed the connection";
    }
    return found;
  }

  void note_generation(const detail::HaplyMessage& message) {
    since_3_5 =
        options.generation == HaplyGeneration::since_3_5 ||
        (options.generation == HaplyGeneration::automatic && (since_3_5 || message.has_session));
  }

  void describe(const detail::HaplyMessage& first) {
    capabilities.name = first.model.empty() ? "inverse3" : first.model;
    capabilities.id = first.device_id;
    capabilities.sensed = DegreesOfFreedom::translation();
    if (first.orientation) {
      capabilities.sensed = DegreesOfFreedom::all();
    }
    capabilities.driven = DegreesOfFreedom::translation();
    capabilities.buttons = first.orientation ? 32 : 0;
    capabilities.max_force = options.max_force;
    capabilities.max_stiffness = std::numeric_limits<double>::infinity();
    capabilities.max_damping = std::numeric_limits<double>::infinity();
    capabilities.workspace_radius = options.workspace_radius;
    capabilities.sample_rate = options.rate;
    capabilities.silent_after_ns = options.silent_after_ns;
    choice.device_id = first.device_id;
  }

  // --- The exchange of states and forces.

  /// Sets the problem, from the driver's thread. The lock of the report is taken only where the
  /// problem changes.
  void set_problem(const std::string& problem) {
    if (problem != reported) {
      reported = problem;
      report.set_problem(problem);
    }
  }

  // Samples come before counts, and reasons before states: a thread that sees the second finds the
  // first.
  void take_state(const detail::HaplyMessage& message) {
    note_generation(message);
    if (message.device_id.empty() || !message.ready) {
      state = detail::quiet(state, DeviceStatus::lost);
      set_problem(message.device_id.empty()
                      ? "the service no longer lists the device " + choice.device_id
                      : "the service reports that the device is not ready");
      states.put(state);
    } else if (message.position) {
      state.X_DH.position = *message.position - options.centre;
      if (message.orientation && capabilities.sensed.angular[0]) {
        state.X_DH.rotation = *message.orientation;
      }
      state.linear_rate = message.velocity;
      state.buttons = capabilities.buttons > 0 ? message.buttons : 0;
      state.time_ns = steady_now_ns();
      ++state.sequence;
      state.status = DeviceStatus::live;
      set_problem(message.grip_problem);
      states.put(state);
      ++report.samples;
      report.malformed += message.grip_problem.empty() ? 0 : 1;
    } else {
      ++report.malformed;
    }
  }

  /// The newest command, if it belongs to this connection and is not too old; else zero.
  [[nodiscard]] Eigen::Vector3d force_now(const Link& link) {
    const TimedForce& newest = commands.newest();
    const bool valid =
        newest.given_ns >= link.since_ns && steady_now_ns() - newest.given_ns <= kCommandLifetimeNs;
    return valid ? newest.force : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }

  [[nodiscard]] std::string force_message(const Eigen::Vector3d& force, bool first) const {
    return detail::haply_force(choice.device_id, force, since_3_5 ? "vector" : "values",
                               first && since_3_5 ? kProfile : "");
  }

  /// Sends the force.
  ///
  /// @param is_named  whether the service knows the name of this program
  bool send_force(Link& link, bool& is_named) {
    if (state.status == DeviceStatus::lost) {
      return send(link, WebSocketKind::text, kEmptyMessage);
    }
    const std::string message = force_message(force_now(link), !is_named);
    is_named = is_named || since_3_5;
    return send(link, WebSocketKind::text, message);
  }

  /// Exchanges messages until the connection ends or the driver stops. Returns why it ended.
  [[nodiscard]] std::string exchange(Link& link) {
    const auto period_ns = static_cast<std::int64_t>(1e9 / options.rate);
    std::int64_t sent_ns = link.since_ns - period_ns;
    std::int64_t received_ns = link.since_ns;
    int on_the_way = 0;
    bool is_named = false;
    while (!link.closed) {
      const std::int64_t wait_ns = on_the_way < kMostOnTheWay ? period_ns : kAnswerLostNs;
      const std::int64_t due_ns = sent_ns + wait_ns;
      const WaitEnd end = detail::wait_for(link.socket, detail::WaitFor::reading, stop,
                                           std::min(due_ns, received_ns + options.lost_after_ns));
      if (end == WaitEnd::stopped) {
        return {};
      }
      if (end == WaitEnd::ready) {
        read_messages(link, [&](const std::string& text) {
          on_the_way = std::max(0, on_the_way - 1);
          received_ns = take_text(text) ? steady_now_ns() : received_ns;
        });
      }
      const std::int64_t now_ns = steady_now_ns();
      if (now_ns - received_ns > options.lost_after_ns) {
        return "no state came for " + std::to_string(options.lost_after_ns / 1'000'000) + " ms";
      }
      if (now_ns >= due_ns) {
        if (on_the_way == kMostOnTheWay) {  // Their answers are lost.
          ++report.missed;
          on_the_way = 0;
        }
        ++on_the_way;
        sent_ns = now_ns;
        if (!send_force(link, is_named)) {
          return "the service takes no messages";
        }
      }
    }
    return link.reader.failure().empty() ? "the service closed the connection"
                                         : link.reader.failure();
  }

  /// Takes a text. Returns whether it is a state of the service.
  bool take_text(const std::string& text) {
    try {
      take_state(detail::parse_haply_message(text, choice));
      return true;
    } catch (const ParseError& error) {
      set_problem(error.what());
      ++report.malformed;
      return false;
    }
  }

  void run(Link first) {
    std::optional<Link> link = std::move(first);
    while (true) {
      if (link) {
        ++report.connections;
        const std::string reason = exchange(*link);
        if (reason.empty()) {
          // A stop must not wait: bytes that the socket does not take at once are dropped.
          (void)send(*link, WebSocketKind::text, force_message(Eigen::Vector3d::Zero(), false));
          (void)send(*link, WebSocketKind::close, {});
          return;
        }
        link.reset();
        state = detail::quiet(state, DeviceStatus::lost);
        set_problem("the Haply Inverse Service at " + place() + ": " + reason);
        states.put(state);
      }
      if (detail::wait_for(stop, steady_now_ns() + options.retry_ns) == WaitEnd::stopped) {
        return;
      }
      std::string problem;
      since_3_5 = false;
      link = open(steady_now_ns() + options.connect_ns, problem);
      if (!link) {
        set_problem(problem);
      }
    }
  }

  // The states in an order without gaps.
  MailSlot<DeviceState> states;
  MailSlot<TimedForce> commands;
  DeviceState state;     // For the driver's thread only.
  std::string reported;  // For the driver's thread only: the problem of the report.
  HaplyOptions options;
  detail::HaplyChoice choice;
  DeviceCapabilities capabilities;
  detail::DriverReport report;
  detail::StopSignal stop;
  std::thread thread;
  std::uint32_t mask = 0;
  bool since_3_5 = false;
};

Haply::Haply(const HaplyOptions& options) : data_(std::make_unique<Data>(options)) {
  const std::int64_t until_ns = steady_now_ns() + options.connect_ns;
  std::string problem;
  std::optional<Data::Link> link = data_->open(until_ns, problem);
  if (!link) {
    throw std::runtime_error(problem);
  }
  const std::optional<detail::HaplyMessage> first = data_->await_device(*link, until_ns, problem);
  if (!first) {
    throw std::runtime_error(problem);
  }
  data_->describe(*first);
  data_->take_state(*first);
  link->since_ns = steady_now_ns();
  data_->thread = std::thread(
      [data = data_.get(), link = std::move(*link)]() mutable { data->run(std::move(link)); });
}

Haply::~Haply() {
  data_->stop.set();
  data_->thread.join();
}

const DeviceCapabilities& Haply::capabilities() const noexcept { return data_->capabilities; }

DeviceState Haply::read(std::int64_t now_ns) noexcept {
  const DeviceState& state = data_->states.newest();
  const bool silent =
      state.status == DeviceStatus::live && now_ns - state.time_ns > data_->options.silent_after_ns;
  return silent ? detail::quiet(state, DeviceStatus::silent) : state;
}

void Haply::command(const ForceCommand& command, std::int64_t now_ns) noexcept {
  data_->commands.put({limited(command, data_->capabilities).force_D, now_ns});
}

DeviceCounts Haply::counts() const { return data_->report.counts(); }

std::string Haply::problem() const { return data_->report.problem(); }

}  // namespace firstcontact
