#include <firstcontact/haptic_devices/detail/mouse_protocol.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <variant>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/haptic_devices/detail/quiet_state.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

const std::string& page_name() {
  static const std::string name = "page of the mouse";
  return name;
}

template <std::size_t n>
std::array<double, n> numbers_of(const JsonReader& reader, const JsonValue& value, double most) {
  const JsonArray& given = reader.array(value, "a list of numbers");
  if (given.size() != n) {
    reader.fail_expected(std::to_string(n) + " numbers", value);
  }
  std::array<double, n> numbers{};
  for (std::size_t k = 0; k < n; ++k) {
    numbers[k] = reader.number(given[k]);
    if (!(std::abs(numbers[k]) <= most)) {
      reader.fail_expected("a number of at most " + write_json(most), given[k]);
    }
  }
  return numbers;
}

Eigen::Vector3d position_of(const JsonReader& reader, const JsonValue& value) {
  const auto p = numbers_of<3>(reader, value, kMostOfSample);
  const Eigen::Vector3d position(p[0], p[1], p[2]);
  if (!(position.norm() <= kMostOfSample)) {
    reader.fail_expected("a position within 1e6 m", value);
  }
  return position;
}

Eigen::Quaterniond rotation_of(const JsonReader& reader, const JsonValue& value) {
  const auto q = numbers_of<4>(reader, value, 2.0);
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  if (!(std::abs(rotation.norm() - 1.0) < 1e-3)) {
    reader.fail_expected("a quaternion of length 1", value);
  }
  return rotation.normalized();
}

double grip_of(const JsonReader& reader, const JsonValue& root) {
  const JsonValue* value = find(std::get<JsonObject>(root.value), "grip");
  if (value == nullptr) {
    return 0.0;
  }
  const double grip = reader.number(*value);
  if (!(std::abs(grip) <= kMostOfSample)) {
    reader.fail_expected("a number of at most 1e6", *value);
  }
  return grip;
}

}  // namespace

void take_mouse_message(std::string_view text, DeviceState& state) {
  const JsonValue root = parse_json(text, page_name());
  const JsonReader reader(root, page_name());
  const Eigen::Vector3d position = position_of(reader, reader.member(root, "position"));
  const Eigen::Quaterniond rotation = rotation_of(reader, reader.member(root, "rotation"));
  const double grip = grip_of(reader, root);
  state.X_DH = {position, rotation};
  state.grips.fill(grip);
}

}  // namespace firstcontact::detail
