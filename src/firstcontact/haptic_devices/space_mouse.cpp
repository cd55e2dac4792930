#include <firstcontact/haptic_devices/space_mouse.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <thread>
#include <utility>

#include <firstcontact/haptic_devices/detail/driver_report.h>
#include <firstcontact/haptic_devices/detail/socket.h>
#include <firstcontact/haptic_devices/detail/space_mouse_rates.h>
#include <firstcontact/haptic_devices/detail/spacenav_protocol.h>
#include <firstcontact/haptic_devices/mail_slot.h>

namespace firstcontact {
namespace {

constexpr const char* kDefaultSocket = "/var/run/spnav.sock";
// [ns]  The time in which daemons of version 1 answer.
constexpr std::int64_t kAnswerNs = 300'000'000;

void require_option(bool holds, const char* what) {
  if (!holds) {
    throw std::invalid_argument(std::string("SpaceMouseOptions: ") + what);
  }
}

SpaceMouseOptions completed(SpaceMouseOptions options) {
  require_option(options.full_scale > 0.0 && std::isfinite(options.full_scale),
                 "full_scale must be > 0");
  require_option(options.dead_zone >= 0.0 && options.dead_zone < options.full_scale,
                 "dead_zone must be >= 0 and less than full_scale");
  require_option(options.max_linear_rate > 0.0 && std::isfinite(options.max_linear_rate) &&
                     options.max_angular_rate > 0.0 && std::isfinite(options.max_angular_rate),
                 "greatest rates must be > 0");
  require_option(options.hold_ns > 0 && options.drift_after_ns > 0 && options.retry_ns > 0,
                 "times must be > 0");
  require_option(options.drift_below >= 0.0 && options.drift_below <= 1.0,
                 "drift_below must be in [0, 1]");
  if (options.socket.empty()) {
    const char* given = std::getenv("SPNAV_SOCKET");
    options.socket = given != nullptr && *given != '\0' ? given : kDefaultSocket;
  }
  return options;
}

DeviceCapabilities space_mouse_capabilities(const SpaceMouseOptions& options) {
  DeviceCapabilities result;
  result.name = "SpaceMouse";
  result.id = options.socket;
  result.kind = DeviceKind::rate;
  result.sensed = DegreesOfFreedom::all();
  result.buttons = 32;
  result.silent_after_ns = options.hold_ns;
  return result;
}

}  // namespace

struct SpaceMouse::Data {
  explicit Data(const SpaceMouseOptions& given)
      : options(completed(given)),
        capabilities(space_mouse_capabilities(options)),
        rates(options) {}

  void put() { slot.put(rates.sample()); }

  /// Connects and requests version 1 of the protocol.
  [[nodiscard]] detail::FileDescriptor connect(std::string& problem) {
    detail::FileDescriptor socket = detail::connect_local(options.socket, problem);
    if (socket.is_open() && !detail::send_all(socket, detail::spacenav_protocol_request(), stop,
                                              steady_now_ns() + kAnswerNs)) {
      problem = "the daemon closed the connection";
      socket = detail::FileDescriptor();
    }
    if (!socket.is_open()) {
      problem = "no connection to spacenavd at " + options.socket + ": " + problem +
                "; start it with 'systemctl start spacenavd', or set SPNAV_SOCKET";
    }
    return socket;
  }

  // Reasons come before states: a thread that sees a state finds its reason.
  void take(const detail::SpacenavEvent& event) {
    const std::uint64_t before = rates.sample().state.sequence;
    const bool is_new = rates.take(event, steady_now_ns());
    if (event.type == detail::SpacenavEventType::device_removed) {
      report.set_problem("spacenavd reports that the device was taken away");
    } else if (rates.sample().state.status == DeviceStatus::live) {
      report.set_problem({});
    }
    if (is_new) {
      put();
      report.samples += rates.sample().state.sequence - before;
    }
  }

  /// Reads one connection until it ends or the driver stops.
  void follow(const detail::FileDescriptor& socket) {
    ++report.connections;
    rates.connected();
    report.set_problem("no event yet: the cap has not been touched");
    put();
    detail::SpacenavDecoder decoder;
    std::array<char, 4096> buffer{};
    bool answered = false;
    std::int64_t until_ns = steady_now_ns() + kAnswerNs;
    while (true) {
      const detail::WaitEnd end =
          detail::wait_for(socket, detail::WaitFor::reading, stop, until_ns);
      if (end == detail::WaitEnd::stopped) {
        return;
      }
      if (end == detail::WaitEnd::timed_out) {
        if (!answered && !detail::send_all(socket, detail::spacenav_sensitivity_one(), stop,
                                           steady_now_ns() + kAnswerNs)) {
          break;
        }
        answered = true;  // A daemon of version 0 does not answer.
        until_ns = std::numeric_limits<std::int64_t>::max();
        continue;
      }
      const detail::Received received = detail::receive(socket, buffer);
      const std::uint64_t malformed = decoder.malformed();
      decoder.add({buffer.data(), received.count});
      while (const auto event = decoder.next()) {
        answered = answered || event->type == detail::SpacenavEventType::protocol;
        take(*event);
      }
      report.malformed += decoder.malformed() - malformed;
      if (!received.open) {
        report.malformed += decoder.inside_record() ? 1 : 0;
        break;
      }
    }
    rates.lost();
    report.set_problem("spacenavd closed the connection");
    put();
  }

  void run(detail::FileDescriptor socket) {
    while (!stop.is_set()) {
      if (socket.is_open()) {
        follow(socket);
        socket = detail::FileDescriptor();
      }
      if (detail::wait_for(stop, steady_now_ns() + options.retry_ns) == detail::WaitEnd::stopped) {
        return;
      }
      std::string problem;
      socket = connect(problem);
      if (!socket.is_open()) {
        report.set_problem(problem);
      }
    }
  }

  MailSlot<detail::SpaceMouseSample> slot;
  SpaceMouseOptions options;
  DeviceCapabilities capabilities;
  detail::SpaceMouseRates rates;
  detail::DriverReport report;
  detail::StopSignal stop;
  std::thread thread;
};

SpaceMouse::SpaceMouse(const SpaceMouseOptions& options) : data_(std::make_unique<Data>(options)) {
  std::string problem;
  detail::FileDescriptor socket = data_->connect(problem);
  if (!socket.is_open()) {
    throw std::runtime_error(problem);
  }
  data_->thread = std::thread(
      [data = data_.get(), socket = std::move(socket)]() mutable { data->run(std::move(socket)); });
}

SpaceMouse::~SpaceMouse() {
  data_->stop.set();
  data_->thread.join();
}

const DeviceCapabilities& SpaceMouse::capabilities() const noexcept { return data_->capabilities; }

DeviceState SpaceMouse::read(std::int64_t now_ns) noexcept {
  return detail::state_at(data_->slot.newest(), now_ns, data_->options);
}

void SpaceMouse::command(const ForceCommand& /*command*/, std::int64_t /*now_ns*/) noexcept {}

DeviceCounts SpaceMouse::counts() const { return data_->report.counts(); }

std::string SpaceMouse::problem() const { return data_->report.problem(); }

}  // namespace firstcontact
