#include <firstcontact/haptic_devices/detail/haply_protocol.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr double kMostLength = 10.0;   // [m]    The device reaches 0.3 m.
constexpr double kMostSpeed = 1000.0;  // [m/s]

const std::string& source_name() {
  static const std::string name = "Haply Inverse Service";
  return name;
}

/// Reads values from one message.
class HaplyReader {
 public:
  explicit HaplyReader(const JsonValue& root) : root_(root), reader_(root, source_name()) {}

  [[nodiscard]] HaplyMessage message(const HaplyChoice& choice) const {
    const JsonObject& all = object(root_);
    HaplyMessage message;
    message.has_session = find(all, "session_id") != nullptr;
    if (const JsonValue* list = find(all, "inverse3")) {
      if (const JsonObject* device = chosen(*list, choice.device_id)) {
        read_device(*device, message);
      }
    }
    take_grip(all, choice, message);
    return message;
  }

 private:
  /// Reads the grip. An invalid grip does not make the position of the device invalid.
  void take_grip(const JsonObject& all, const HaplyChoice& choice, HaplyMessage& message) const {
    try {
      if (const JsonObject* grip = first_grip(all, choice.grip_id)) {
        read_grip(*grip, message);
      }
    } catch (const ParseError& error) {
      message.orientation.reset();
      message.buttons = 0;
      message.grip_problem = error.what();
    }
  }

  /// Whether the service reports that a grip is present: the buttons of an absent one do not count.
  [[nodiscard]] bool is_there(const JsonObject& grip) const {
    const JsonObject* status = part(grip, "status");
    for (const char* key : {"connected", "ready"}) {
      const JsonValue* is = status == nullptr ? nullptr : find(*status, key);
      if (is != nullptr && !reader_.boolean(*is)) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] const JsonObject& object(const JsonValue& value) const {
    if (const auto* members = std::get_if<JsonObject>(&value.value)) {
      return *members;
    }
    reader_.fail_expected("an object", value);
  }

  /// Finds the member of a key if it is an object.
  [[nodiscard]] const JsonObject* part(const JsonObject& object, std::string_view key) const {
    const JsonValue* value = find(object, key);
    return value == nullptr ? nullptr : &this->object(*value);
  }

  [[nodiscard]] std::string id_of(const JsonObject& device) const {
    const JsonValue* id = find(device, "device_id");
    return id == nullptr ? std::string() : reader_.string(*id, "a device id");
  }

  /// Finds the device with this id, or the first one.
  [[nodiscard]] const JsonObject* chosen(const JsonValue& list, const std::string& id) const {
    for (const JsonValue& value : reader_.array(list, "a list of devices")) {
      const JsonObject& device = object(value);
      const std::string own = id_of(device);
      if (!own.empty() && (id.empty() || own == id)) {
        return &device;
      }
    }
    return nullptr;
  }

  [[nodiscard]] const JsonObject* first_grip(const JsonObject& all, const std::string& id) const {
    const JsonValue* wired = find(all, "verse_grip");
    const JsonObject* grip = wired == nullptr ? nullptr : chosen(*wired, id);
    for (const JsonMember& member : all) {
      if (grip == nullptr && member.key.ends_with("verse_grip")) {
        grip = chosen(member.value, id);
      }
    }
    return grip;
  }

  template <std::size_t n>
  [[nodiscard]] std::array<double, n> numbers(const JsonValue& value,
                                              const std::array<const char*, n>& keys,
                                              double most) const {
    std::array<double, n> result{};
    for (std::size_t i = 0; i < n; ++i) {
      const JsonValue& member = reader_.member(value, keys[i]);
      result[i] = reader_.number(member);
      if (!(std::abs(result[i]) <= most)) {
        reader_.fail_expected("a number of at most " + write_json(most), member);
      }
    }
    return result;
  }

  [[nodiscard]] Eigen::Vector3d vector(const JsonValue& value, double most) const {
    const auto v = numbers<3>(value, {"x", "y", "z"}, most);
    return {v[0], v[1], v[2]};
  }

  void read_device(const JsonObject& device, HaplyMessage& message) const {
    message.device_id = id_of(device);
    if (const JsonObject* config = part(device, "config")) {
      if (const JsonValue* type = find(*config, "type")) {
        message.model = reader_.string(*type, "a type");
      }
    }
    if (const JsonObject* status = part(device, "status")) {
      if (const JsonValue* ready = find(*status, "ready")) {
        message.ready = reader_.boolean(*ready);
      }
    }
    if (const JsonObject* state = part(device, "state")) {
      if (const JsonValue* position = find(*state, "cursor_position")) {
        message.position = vector(*position, kMostLength);
      }
      if (const JsonValue* velocity = find(*state, "cursor_velocity")) {
        message.velocity = vector(*velocity, kMostSpeed);
      }
    }
  }

  void read_grip(const JsonObject& grip, HaplyMessage& message) const {
    const JsonObject* state = part(grip, "state");
    if (state == nullptr || !is_there(grip)) {
      return;
    }
    if (const JsonValue* orientation = find(*state, "orientation")) {
      const auto q = numbers<4>(*orientation, {"w", "x", "y", "z"}, 2.0);
      const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
      const double length = rotation.norm();
      if (!(length > 0.9 && length < 1.1)) {  // Hardware rounds it to some digits.
        reader_.fail_expected("a quaternion of length 1", *orientation);
      }
      message.orientation = rotation.normalized();
    }
    if (const JsonValue* button = find(*state, "button")) {
      message.buttons = reader_.boolean(*button) ? 1 : 0;
    }
    if (const JsonObject* buttons = part(*state, "buttons")) {
      message.buttons = pressed(*buttons);
    }
  }

  /// Reads the pressed buttons. Bit i is that of the button whose name is the i-th in alphabetical
  /// order: a, b, c, or button_0, button_1 and so on.
  [[nodiscard]] std::uint32_t pressed(const JsonObject& buttons) const {
    std::vector<std::pair<std::string_view, bool>> named;
    for (const JsonMember& member : buttons) {
      named.emplace_back(member.key, reader_.boolean(member.value));
    }
    std::sort(named.begin(), named.end());
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(named.size(), 32); ++i) {
      bits |= named[i].second ? std::uint32_t{1} << i : 0;
    }
    return bits;
  }

  const JsonValue& root_;
  JsonReader reader_;
};

}  // namespace

HaplyMessage parse_haply_message(std::string_view text, const HaplyChoice& choice) {
  const JsonValue root = parse_json(text, source_name());
  return HaplyReader(root).message(choice);
}

std::string haply_force(const std::string& device_id, const Eigen::Vector3d& force,
                        const char* vector_key, const std::string& profile) {
  std::string text = "{";
  if (!profile.empty()) {
    text += R"("session":{"configure":{"profile":{"name":)" + write_json(profile) + "}}},";
  }
  return text + R"("inverse3":[{"device_id":)" + write_json(device_id) +
         R"(,"commands":{"set_cursor_force":{")" + vector_key + R"(":{"x":)" +
         write_json(force.x()) + R"(,"y":)" + write_json(force.y()) + R"(,"z":)" +
         write_json(force.z()) + "}}}}]}";
}

}  // namespace firstcontact::detail
