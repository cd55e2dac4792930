#include <firstcontact/haptic_devices/detail/recording_head.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <firstcontact/text/ascii.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_double.h>
#include <firstcontact/text/text_cursor.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// A key whose value is one number >= 0, or infinite.
struct NumberKey {
  const char* name;
  double DeviceCapabilities::*value;
};

constexpr std::array<NumberKey, 14> kNumberKeys{{
    {"max_force", &DeviceCapabilities::max_force},
    {"max_torque", &DeviceCapabilities::max_torque},
    {"max_stiffness", &DeviceCapabilities::max_stiffness},
    {"max_angular_stiffness", &DeviceCapabilities::max_angular_stiffness},
    {"max_damping", &DeviceCapabilities::max_damping},
    {"max_angular_damping", &DeviceCapabilities::max_angular_damping},
    {"workspace_radius", &DeviceCapabilities::workspace_radius},
    {"damping", &DeviceCapabilities::damping},
    {"angular_damping", &DeviceCapabilities::angular_damping},
    {"friction", &DeviceCapabilities::friction},
    {"angular_friction", &DeviceCapabilities::angular_friction},
    {"resolution", &DeviceCapabilities::resolution},
    {"angular_resolution", &DeviceCapabilities::angular_resolution},
    {"sample_rate", &DeviceCapabilities::sample_rate},
}};

constexpr std::array<const char*, 11> kOtherKeys{"device",
                                                 "max_grip_effort",
                                                 "id",
                                                 "kind",
                                                 "sensed",
                                                 "driven",
                                                 "buttons",
                                                 "silent_after_ns",
                                                 "calibration_scale",
                                                 "calibration_position",
                                                 "calibration_quaternion"};

std::vector<std::string_view> all_keys() {
  std::vector<std::string_view> keys(kOtherKeys.begin(), kOtherKeys.end());
  for (const NumberKey& key : kNumberKeys) {
    keys.emplace_back(key.name);
  }
  return keys;
}

bool has_control_character(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

/// Reads the value of one key.
class KeyReader {
 public:
  KeyReader(std::string_view key, std::string_view value, const std::string& source,
            std::size_t line)
      : key_(key), value_(value), source_(source), line_(line) {}

  [[nodiscard]] bool is(std::string_view key) const { return key_ == key; }

  [[noreturn]] void fail_expected(const std::string& what) const {
    throw ParseError(source_, line_,
                     std::string(key_) + ": expected " + what + ", got " + quoted(value_));
  }

  [[nodiscard]] std::string text() const {
    if (value_.size() > 200 || has_control_character(value_)) {
      fail_expected("at most 200 bytes without control characters");
    }
    return std::string(value_);
  }

  [[nodiscard]] double not_negative() const {
    const double number = number_or_nan(value_, true);
    if (!(number >= 0.0)) {
      fail_expected("a number >= 0 or inf");
    }
    return number;
  }

  [[nodiscard]] std::int64_t integer(std::int64_t most) const {
    std::int64_t number = 0;
    const char* end = value_.data() + value_.size();
    const auto [stop, error] = std::from_chars(value_.data(), end, number);
    if (error != std::errc() || stop != end || number < 0 || number > most) {
      fail_expected("a whole number from 0 to " + std::to_string(most));
    }
    return number;
  }

  template <std::size_t n>
  [[nodiscard]] std::array<double, n> numbers() const {
    std::array<double, n> result{};
    std::string_view rest = value_;
    for (double& number : result) {
      rest = trimmed(rest);
      const std::string_view word = rest.substr(0, rest.find(' '));
      number = number_or_nan(word);
      if (!(std::abs(number) <= 1e6)) {
        fail_expected(std::to_string(n) + " numbers of at most 1e6, with blanks between them");
      }
      rest.remove_prefix(word.size());
    }
    if (!trimmed(rest).empty()) {
      fail_expected(std::to_string(n) + " numbers");
    }
    return result;
  }

  [[nodiscard]] DegreesOfFreedom degrees() const {
    DegreesOfFreedom result;
    if (value_.size() != 6 || value_.find_first_not_of("01") != std::string_view::npos) {
      fail_expected("six digits 0 or 1: along x, y, z and about x, y, z");
    }
    for (std::size_t i = 0; i < 3; ++i) {
      result.linear[i] = value_[i] == '1';
      result.angular[i] = value_[i + 3] == '1';
    }
    return result;
  }

  [[nodiscard]] DeviceKind kind() const {
    for (std::size_t i = 0; i < kDeviceKindWords.size(); ++i) {
      if (value_ == kDeviceKindWords[i]) {
        return static_cast<DeviceKind>(i);
      }
    }
    fail_expected("pose or rate");
  }

 private:
  std::string_view key_;
  std::string_view value_;
  const std::string& source_;
  std::size_t line_;
};

void read_calibration(const KeyReader& reader, DeviceCalibration& calibration) {
  if (reader.is("calibration_scale")) {
    calibration.scale = reader.not_negative();
    if (!(calibration.scale >= 1e-6 && calibration.scale <= 1e6)) {
      reader.fail_expected("a number from 1e-6 to 1e6");
    }
  } else if (reader.is("calibration_position")) {
    const auto p = reader.numbers<3>();
    calibration.X_DR.position = {p[0], p[1], p[2]};
  } else {
    const auto q = reader.numbers<4>();
    calibration.X_DR.rotation = {q[0], q[1], q[2], q[3]};
    if (!(std::abs(calibration.X_DR.rotation.norm() - 1.0) < 1e-3)) {
      reader.fail_expected("a quaternion w x y z of length 1");
    }
  }
}

void put(std::string& text, const char* key, const std::string& value) {
  text += std::string("# ") + key + ": " + value + "\n";
}

/// Writes a number of the head. NaN has no text.
std::string written(const char* key, double value) {
  if (std::isnan(value)) {
    throw std::invalid_argument(std::string("DeviceCapabilities::") + key + " is NaN");
  }
  return std::isinf(value) ? "inf" : write_json(value);
}

std::string written(const DegreesOfFreedom& degrees) {
  std::string text;
  for (const auto& flags : {degrees.linear, degrees.angular}) {
    for (const bool flag : flags) {
      text += flag ? '1' : '0';
    }
  }
  return text;
}

std::string written_name(const std::string& name) {
  if (name.size() > 200 || has_control_character(name)) {
    throw std::invalid_argument(
        "the name or id of a device is longer than 200 bytes, or has a "
        "control character: " +
        detail::quoted(name));
  }
  return std::string(trimmed(name));
}

}  // namespace

double number_or_nan(std::string_view text, bool infinite) {
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = read_double(text.data(), end, number);
  const bool read = error == std::errc() && stop == end && (infinite || std::isfinite(number));
  return read ? number : std::numeric_limits<double>::quiet_NaN();
}

void read_recording_key(std::string_view line, const std::string& source, std::size_t number,
                        Recording& recording) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) {
    throw ParseError(
        source, number,
        "expected '# key: value', got " + quoted(line) + "; a comment begins with two signs ##");
  }
  const std::string_view key = trimmed(line.substr(0, colon));
  const KeyReader reader(key, trimmed(line.substr(colon + 1)), source, number);
  DeviceCapabilities& capabilities = recording.capabilities;
  for (const NumberKey& known : kNumberKeys) {
    if (reader.is(known.name)) {
      capabilities.*known.value = reader.not_negative();
      return;
    }
  }
  if (reader.is("device")) {
    capabilities.name = reader.text();
  } else if (reader.is("id")) {
    capabilities.id = reader.text();
  } else if (reader.is("kind")) {
    capabilities.kind = reader.kind();
  } else if (reader.is("sensed")) {
    capabilities.sensed = reader.degrees();
  } else if (reader.is("driven")) {
    capabilities.driven = reader.degrees();
  } else if (reader.is("buttons")) {
    capabilities.buttons = static_cast<int>(reader.integer(32));
  } else if (reader.is("max_grip_effort")) {
    capabilities.max_grip_effort = reader.not_negative();
  } else if (reader.is("silent_after_ns")) {
    capabilities.silent_after_ns = reader.integer(std::numeric_limits<std::int64_t>::max());
  } else if (key.starts_with("calibration_") && nearest_word(key, all_keys()) == key) {
    read_calibration(reader, recording.calibration);
  } else {
    const std::string_view nearest = nearest_word(key, all_keys());
    throw ParseError(source, number,
                     "unknown key " + quoted(key) +
                         (nearest.empty() ? "; the keys are " + listed(all_keys())
                                          : "; is it " + quoted(nearest) + "?"));
  }
}

std::string recording_keys(const DeviceCapabilities& capabilities,
                           const DeviceCalibration& calibration) {
  std::string text;
  put(text, "device", written_name(capabilities.name));
  put(text, "id", written_name(capabilities.id));
  put(text, "kind", kDeviceKindWords[static_cast<std::size_t>(capabilities.kind)]);
  put(text, "sensed", written(capabilities.sensed));
  put(text, "driven", written(capabilities.driven));
  put(text, "buttons", std::to_string(capabilities.buttons));
  for (const NumberKey& key : kNumberKeys) {
    put(text, key.name, written(key.name, capabilities.*key.value));
  }
  if (capabilities.grips > 0) {
    put(text, "max_grip_effort", written("max_grip_effort", capabilities.max_grip_effort));
  }
  put(text, "silent_after_ns", std::to_string(capabilities.silent_after_ns));
  const Eigen::Vector3d& p = calibration.X_DR.position;
  const Eigen::Quaterniond& q = calibration.X_DR.rotation;
  put(text, "calibration_scale", write_json(calibration.scale));
  put(text, "calibration_position",
      write_json(p.x()) + " " + write_json(p.y()) + " " + write_json(p.z()));
  put(text, "calibration_quaternion",
      write_json(q.w()) + " " + write_json(q.x()) + " " + write_json(q.y()) + " " +
          write_json(q.z()));
  return text;
}

}  // namespace firstcontact::detail
