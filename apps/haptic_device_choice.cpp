#include "haptic_device_choice.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <firstcontact/haptic_devices/load_device_plugin.h>
#include <firstcontact/haptic_devices/recorded_device.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::app {
namespace {

constexpr std::string_view kSimulated = "simulated";
constexpr std::string_view kMouse = "mouse";
constexpr std::string_view kSpaceMouse = "spacemouse";
constexpr std::string_view kHaply = "haply";
constexpr std::string_view kPlugin = "plugin";
constexpr std::string_view kScheme = "ws://";

/// A word of `--device`, cut at its first "=".
struct DeviceWord {
  std::string_view name;
  std::optional<std::string_view> place;
};

DeviceWord cut(std::string_view word) {
  const std::size_t sign = word.find('=');
  const std::string_view name = word.substr(0, sign);
  if (name != kMouse && name != kSpaceMouse && name != kHaply && name != kPlugin) {
    return {word, std::nullopt};  // Paths may contain the sign.
  }
  return sign == std::string_view::npos ? DeviceWord{name, std::nullopt}
                                        : DeviceWord{name, word.substr(sign + 1)};
}

[[noreturn]] void refuse(const std::string& word, const char* expected) {
  throw ParseError("--device " + word, expected);
}

/// The options of an address "ws://HOST:PORT", whose scheme may be left out.
HaplyOptions haply_at(const std::string& word, std::string_view place) {
  if (place.starts_with(kScheme)) {
    place.remove_prefix(kScheme.size());
  }
  if (place.ends_with('/')) {
    place.remove_suffix(1);
  }
  const std::size_t colon = place.find(':');
  HaplyOptions options;
  options.host = place.substr(0, colon);
  const auto port =
      port_of(colon == std::string_view::npos ? std::string_view() : place.substr(colon + 1));
  if (options.host.empty() || !port) {
    refuse(word, "expected haply=ws://HOST:PORT, as in haply=ws://localhost:10001");
  }
  options.port = *port;
  return options;
}

PluginChoice plugin_of(const std::string& word, std::string_view place) {
  const std::size_t comma = place.find(',');
  PluginChoice plugin{.path = std::string(place.substr(0, comma)), .settings = {}};
  if (comma != std::string_view::npos) {
    plugin.settings = place.substr(comma + 1);
  }
  if (plugin.path.empty()) {
    refuse(word, "expected plugin=FILE or plugin=FILE,SETTINGS, with a shared library as FILE");
  }
  return plugin;
}

Recording recording_of(const std::string& word) {
  std::error_code error;
  if (!std::filesystem::exists(word, error)) {
    refuse(word,
           "found no such recording; other devices are simulated, mouse, spacemouse, haply and "
           "plugin=FILE");
  }
  return read_recording(word);
}

}  // namespace

std::optional<std::uint16_t> port_of(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  const bool is_port = error == std::errc() && end == text.data() + text.size() && port > 0;
  return is_port ? std::optional(port) : std::nullopt;
}

DeviceChoice read_device_choice(const std::string& word) {
  const DeviceWord device = cut(word);
  if (device.name == kSimulated) {
    return SimulatedChoice{};
  }
  if (device.name == kMouse) {
    const auto port = port_of(device.place.value_or("0"));
    if (device.place && !port) {
      refuse(word,
             "expected mouse=PORT with a port from 1 to 65535, or mouse alone for a free one");
    }
    return BrowserDeviceOptions{.port = port.value_or(0)};
  }
  if (device.name == kSpaceMouse) {
    if (device.place && device.place->empty()) {
      refuse(word, "expected spacemouse=SOCKET, or spacemouse alone for the usual socket");
    }
    SpaceMouseOptions options;
    options.socket = device.place.value_or(std::string_view());
    return options;
  }
  if (device.name == kHaply) {
    return device.place ? haply_at(word, *device.place) : HaplyOptions{};
  }
  if (device.name == kPlugin) {
    return plugin_of(word, device.place.value_or(std::string_view()));
  }
  return recording_of(word);
}

bool is_live(const DeviceChoice& choice) {
  return !std::holds_alternative<SimulatedChoice>(choice) &&
         !std::holds_alternative<Recording>(choice);
}

std::optional<std::filesystem::path> file_of_device(const std::string& word) {
  const DeviceWord device = cut(word);
  if (device.name == kPlugin && device.place) {
    return device.place->substr(0, device.place->find(','));
  }
  if (device.name == kSimulated || device.name == kMouse || device.name == kSpaceMouse ||
      device.name == kHaply || device.name == kPlugin) {
    return std::nullopt;
  }
  return word;
}

double duration_of_recording(const std::string& word, const Recording& recording) {
  constexpr double kLongest = 1e9;  // [s]  As prepare_haptics() has it.
  const RecordedDeviceOptions options;
  const double span = 1e-9 * static_cast<double>(RecordedDevice(recording, options).duration_ns());
  if (span > kLongest) {
    throw ParseError(word, fmt::format("time_ns: the times span {:.6g} s, expected at most 1e9 s; "
                                       "mend the first or the last, or give --duration",
                                       span));
  }
  return std::min(span + 1e-9 * static_cast<double>(options.hold_last_ns), kLongest);
}

int grips_of_device(const DeviceMapping& mapping) {
  int count = 0;
  for (std::size_t k = 0; k < mapping.grips.size(); ++k) {
    count = mapping.grips[k].button < 0 ? static_cast<int>(k) + 1 : count;
  }
  return count;
}

double radius_of_hand(double radius, double scale) {
  constexpr double kFarthest = 1e6;  // [m]  Of a device's poses.
  if (!(radius / scale <= kFarthest)) {
    throw std::invalid_argument(
        fmt::format("--radius: expected at most {:.6g} m, got {:.6g}; the handle goes to 1e6 m",
                    kFarthest * scale, radius));
  }
  return radius / scale;
}

std::unique_ptr<Device> open_device(const DeviceChoice& choice,
                                    const SimulatedOperatorOptions& hand) {
  struct Open {
    std::unique_ptr<Device> operator()(const SimulatedChoice& /*choice*/) const {
      return std::make_unique<SimulatedOperator>(hand);
    }
    std::unique_ptr<Device> operator()(const Recording& recording) const {
      return std::make_unique<RecordedDevice>(recording);
    }
    std::unique_ptr<Device> operator()(const BrowserDeviceOptions& options) const {
      return std::make_unique<BrowserDevice>(options);
    }
    std::unique_ptr<Device> operator()(const SpaceMouseOptions& options) const {
      return std::make_unique<SpaceMouse>(options);
    }
    std::unique_ptr<Device> operator()(const HaplyOptions& options) const {
      return std::make_unique<Haply>(options);
    }
    std::unique_ptr<Device> operator()(const PluginChoice& plugin) const {
      return load_device_plugin(plugin.path, plugin.settings);
    }
    const SimulatedOperatorOptions& hand;
  };
  return std::visit(Open{hand}, choice);
}

}  // namespace firstcontact::app
