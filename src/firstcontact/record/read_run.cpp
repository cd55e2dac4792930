#include <firstcontact/record/read_run.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/record/detail/json_place.h>
#include <firstcontact/record/detail/scene_digest.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_result.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

using nlohmann::json;

/// Takes values out of one line, or reports the place of an unexpected value.
class Line {
 public:
  Line(const std::string& text, const std::string& path, std::size_t number)
      : path_(path), number_(number), root_(parsed(text)) {}

  [[nodiscard]] const json& root() const { return root_; }

  [[noreturn]] void fail(const json& where, const std::string& expected) const {
    std::string place = detail::place_of(where, root_).value_or("");
    place = place.empty() ? "" : place.substr(1) + ": ";
    throw ParseError(path_, number_, place + "expected " + expected);
  }

  /// Requires all of the keys, and no others but the optional ones.
  void require_keys(const json& object, std::initializer_list<std::string_view> keys,
                    std::initializer_list<std::string_view> may_be = {}) const {
    if (!object.is_object()) {
      fail(object, "an object");
    }
    for (const std::string_view key : keys) {
      if (!object.contains(key)) {
        fail(object, "the key \"" + std::string(key) + "\"");
      }
    }
    for (const auto& [key, member] : object.items()) {
      if (std::ranges::find(keys, key) == keys.end() &&
          std::ranges::find(may_be, key) == may_be.end()) {
        fail(member, "no such key here");
      }
    }
  }

  [[nodiscard]] const json& array(const json& value) const {
    if (!value.is_array()) {
      fail(value, "an array");
    }
    return value;
  }

  [[nodiscard]] const json& array(const json& value, std::size_t size) const {
    if (!value.is_array() || value.size() != size) {
      fail(value, "an array of " + std::to_string(size));
    }
    return value;
  }

  [[nodiscard]] double number(const json& value) const {
    if (!value.is_number()) {
      fail(value, "a number");
    }
    return value.get<double>();
  }

  [[nodiscard]] double not_negative(const json& value) const {
    const double x = number(value);
    if (!(x >= 0.0)) {
      fail(value, "a number that is not negative");
    }
    return x;
  }

  /// An index in [0, count).
  [[nodiscard]] std::size_t index(const json& value, std::size_t count) const {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= count) {
      fail(value, "an integer from 0 to " + std::to_string(count - 1));
    }
    return value.get<std::size_t>();
  }

  [[nodiscard]] std::string string(const json& value) const {
    if (!value.is_string()) {
      fail(value, "a string");
    }
    return value.get<std::string>();
  }

  /// The vector of the elements `first` and following of a row of numbers.
  [[nodiscard]] Eigen::Vector3d vector3(const json& row, std::size_t first) const {
    return {number(row[first]), number(row[first + 1]), number(row[first + 2])};
  }
  [[nodiscard]] Eigen::Vector3d vector3(const json& value) const {
    return vector3(array(value, 3), 0);
  }

  [[nodiscard]] Eigen::Quaterniond quaternion(const json& row, std::size_t first) const {
    const Eigen::Vector3d v = vector3(row, first + 1);
    Eigen::Quaterniond q(number(row[first]), v.x(), v.y(), v.z());
    if (!(q.coeffs().cwiseAbs().maxCoeff() > 0.0)) {
      fail(row, "a quaternion that is not zero");
    }
    return q;
  }

 private:
  [[nodiscard]] json parsed(const std::string& text) const {
    try {
      json root = json::parse(text);
      if (root.is_object()) {
        return root;
      }
    } catch (const json::parse_error& error) {
      throw ParseError(
          path_, number_,
          "expected one JSON object, got something else at its byte " + std::to_string(error.byte));
    } catch (const json::exception&) {
      throw ParseError(path_, number_, "expected numbers that fit a double");
    }
    throw ParseError(path_, number_, "expected one JSON object");
  }

  const std::string& path_;
  std::size_t number_;
  json root_;
};

constexpr std::size_t kAnyCount = std::numeric_limits<std::size_t>::max();

RunHeader read_header(const std::string& text, const std::string& path,
                      const ReadingOptions& options) {
  const Line line(text, path, 1);
  const json& root = line.root();
  const auto version = root.find("firstcontact_run");
  if (version == root.end() || *version != 1) {
    line.fail(root, "the header of a run, an object with \"firstcontact_run\": 1");
  }
  line.require_keys(root,
                    {"firstcontact_run", "scene", "version", "scene_digest", "input_digest",
                     "masses", "centres_of_mass"},
                    {"kind", "resolved_digest"});
  RunHeader header;
  if (const auto kind = root.find("kind"); kind != root.end()) {
    if (*kind != "haptics") {
      line.fail(*kind, "\"haptics\"; a simulation has no \"kind\"");
    }
    header.kind = RunKind::haptics;
  }
  header.scene = parse_embedded_scene(text, path, 1, options);
  if (const auto digest = root.find("resolved_digest");
      digest != root.end() && line.string(*digest) != detail::digest_of_scene_in(text)) {
    line.fail(*digest, "the digest of \"scene\", which was edited; make the run again");
  }
  header.version = line.string(root["version"]);
  header.scene.text_digest = line.string(root["scene_digest"]);
  header.input_digest = line.string(root["input_digest"]);
  const std::size_t count = names_with_links(header.scene).size();
  for (const json& mass : line.array(root["masses"], count)) {
    header.masses.push_back(line.not_negative(mass));
  }
  for (const json& centre : line.array(root["centres_of_mass"], count)) {
    header.centres_of_mass.push_back(line.vector3(centre));
  }
  return header;
}

RunPiece read_piece(const json& row, const Line& line) {
  (void)line.array(row, 14);
  RunPiece piece;
  piece.to = line.number(row[0]);
  piece.X_WB = {line.vector3(row, 1), line.quaternion(row, 4)};
  piece.translation = line.vector3(row, 8);
  piece.rotation_vector = line.vector3(row, 11);
  return piece;
}

RunBody read_body(const json& value, std::size_t bodies, double lasted, const Line& line) {
  line.require_keys(
      value,
      {"body", "pieces", "position", "quaternion_wxyz", "linear_velocity", "angular_velocity"},
      {"rests", "behind"});
  RunBody body;
  body.body = line.index(value["body"], bodies);
  double from = 0.0;
  for (const json& row : line.array(value["pieces"])) {
    body.pieces.push_back(read_piece(row, line));
    const double to = body.pieces.back().to;
    if (!(to > from || (to == 0.0 && lasted == 0.0))) {
      line.fail(row, "a piece that ends after the one before it");
    }
    from = to;
  }
  if (from != lasted) {
    line.fail(value["pieces"], "a last piece that ends with the step");
  }
  body.X_WB = {line.vector3(value["position"]),
               line.quaternion(line.array(value["quaternion_wxyz"], 4), 0)};
  body.linear_velocity = line.vector3(value["linear_velocity"]);
  body.angular_velocity = line.vector3(value["angular_velocity"]);
  if (const auto rests = value.find("rests"); rests != value.end()) {
    if (*rests != true || body.linear_velocity.any() || body.angular_velocity.any()) {
      line.fail(*rests, "true, of a body without velocity");
    }
    body.rests = true;
  }
  if (const auto behind = value.find("behind"); behind != value.end()) {
    body.behind = line.not_negative(*behind);
  }
  return body;
}

Feature read_feature(const json& value, const json& triangle, const Line& line) {
  constexpr std::size_t kCount = std::size_t{1} << 32;
  line.require_keys(value, {"type", "index"});
  const std::string type = line.string(value["type"]);
  const auto known = std::ranges::find(kFeatureTypeWords, type);
  if (known != kFeatureTypeWords.end()) {
    return {static_cast<FeatureType>(known - kFeatureTypeWords.begin()),
            static_cast<std::uint32_t>(line.index(value["index"], kCount)),
            static_cast<std::uint32_t>(line.index(triangle, kCount))};
  }
  line.fail(value["type"], "vertex, edge or face");
}

RunContact read_contact(const json& value, std::size_t bodies, const Line& line) {
  line.require_keys(value,
                    {"bodies", "features", "triangles", "point", "normal", "distance", "impulse"});
  RunContact contact;
  const json& pair = line.array(value["bodies"], 2);
  contact.bodies = {line.index(pair[0], bodies), line.index(pair[1], bodies)};
  const json& features = line.array(value["features"], 2);
  const json& triangles = line.array(value["triangles"], 2);
  contact.feature_A = read_feature(features[0], triangles[0], line);
  contact.feature_B = read_feature(features[1], triangles[1], line);
  contact.point = line.vector3(value["point"]);
  contact.normal = line.vector3(value["normal"]);
  contact.distance = line.number(value["distance"]);
  contact.impulse = line.vector3(value["impulse"]);
  return contact;
}

RunImpact read_impact(const json& value, std::size_t bodies, const Line& line) {
  line.require_keys(value, {"at", "bodies", "point", "impulse"});
  const json& pair = line.array(value["bodies"], 2);
  return {.at = line.not_negative(value["at"]),
          .bodies = {line.index(pair[0], bodies), line.index(pair[1], bodies)},
          .point = line.vector3(value["point"]),
          .impulse = line.vector3(value["impulse"])};
}

RunTie read_tie(const json& value, const Line& line) {
  line.require_keys(value, {"force"}, {"torque"});
  RunTie tie{.force = line.vector3(value["force"])};
  if (value.contains("torque")) {
    tie.torque = line.vector3(value["torque"]);
  }
  return tie;
}

std::vector<RunTie> read_ties(const json& root, std::size_t count, const Line& line) {
  std::vector<RunTie> ties;
  if (root.contains("ties")) {
    for (const json& tie : line.array(root["ties"])) {
      ties.push_back(read_tie(tie, line));
    }
  }
  if (ties.size() != count) {
    line.fail(root, std::to_string(count) + " \"ties\", as many as the scene's");
  }
  return ties;
}

/// Reads the number of a body with a mass; `last` has the number before it in the list.
std::size_t read_moved_body(const json& value, const std::string& what,
                            std::optional<std::size_t>& last, const RunHeader& run,
                            const Line& line) {
  const std::size_t body = line.index(value["body"], run.masses.size());
  if (!(run.masses[body] > 0.0)) {
    line.fail(value["body"], "the number of a " + what + ", a body with a mass");
  }
  if (last && body <= *last) {
    line.fail(value["body"], what + "s in the order of their numbers, each once");
  }
  last = body;
  return body;
}

Pose read_pose(const json& value, const Line& line) {
  return {line.vector3(value["position"]),
          line.quaternion(line.array(value["quaternion_wxyz"], 4), 0)};
}

std::vector<RunDeviceLink> read_device_links(const json& device, const RunHeader& header,
                                             const Line& line) {
  std::vector<RunDeviceLink> links;
  std::optional<std::size_t> last;
  if (!device.contains("links")) {
    return links;
  }
  for (const json& link : line.array(device["links"])) {
    line.require_keys(link, {"body", "position", "quaternion_wxyz"});
    links.push_back(
        {.body = read_moved_body(link, "link", last, header, line), .X_WB = read_pose(link, line)});
  }
  return links;
}

std::vector<RunDevice> read_devices(const json& root, const RunHeader& header, const Line& line) {
  std::vector<RunDevice> devices;
  const auto array = root.find("devices");
  if (array == root.end()) {
    return devices;
  }
  if (header.kind != RunKind::haptics) {
    line.fail(*array, "no such key here: only runs of haptics have devices");
  }
  std::optional<std::size_t> last;
  for (const json& device : line.array(*array)) {
    line.require_keys(device, {"body", "position", "quaternion_wxyz", "force", "torque"},
                      {"links"});
    devices.push_back({.body = read_moved_body(device, "tool", last, header, line),
                       .X_WB = read_pose(device, line),
                       .force = line.vector3(device["force"]),
                       .torque = line.vector3(device["torque"]),
                       .links = read_device_links(device, header, line)});
  }
  return devices;
}

std::vector<RunBody> read_bodies(const json& array, std::size_t bodies, double lasted,
                                 const Line& line) {
  std::vector<RunBody> result;
  for (const json& element : line.array(array)) {
    result.push_back(read_body(element, bodies, lasted, line));
    if (result.size() > 1 && result.back().body <= result[result.size() - 2].body) {
      line.fail(element["body"], "bodies in the order of their numbers, each once");
    }
  }
  return result;
}

std::vector<double> numbers(const json& array, const Line& line) {
  std::vector<double> result;
  for (const json& number : line.array(array)) {
    result.push_back(line.number(number));
  }
  return result;
}

std::vector<RunRobot> read_robots(const json& array, std::size_t robots, const Line& line) {
  std::vector<RunRobot> result;
  for (const json& element : line.array(array)) {
    line.require_keys(element, {"robot", "positions", "velocities", "efforts"});
    result.push_back({.robot = line.index(element["robot"], robots),
                      .positions = numbers(element["positions"], line),
                      .velocities = numbers(element["velocities"], line),
                      .efforts = numbers(element["efforts"], line)});
    if (result.back().efforts.size() != result.back().velocities.size()) {
      line.fail(element["efforts"], "as many as velocities");
    }
    if (result.size() > 1 && result.back().robot <= result[result.size() - 2].robot) {
      line.fail(element["robot"], "robots in the order of their numbers, each once");
    }
  }
  return result;
}

RunStep read_step(const Line& line, const RunHeader& header) {
  const json& root = line.root();
  const std::size_t bodies = header.masses.size();
  line.require_keys(
      root,
      {"step", "time", "lasted", "time_lost", "bodies", "contacts", "clearance", "kinetic_energy",
       "potential_energy", "linear_momentum", "angular_momentum", "residual", "events"},
      {"robots", "impacts", "ties", "devices"});
  RunStep step;
  step.index = line.index(root["step"], kAnyCount);
  step.time = line.not_negative(root["time"]);
  step.lasted = line.not_negative(root["lasted"]);
  step.time_lost = line.not_negative(root["time_lost"]);
  step.bodies = read_bodies(root["bodies"], bodies, step.lasted, line);
  if (root.contains("robots")) {
    step.robots = read_robots(root["robots"], header.scene.robots.size(), line);
  }
  for (const json& contact : line.array(root["contacts"])) {
    step.contacts.push_back(read_contact(contact, bodies, line));
  }
  if (root.contains("impacts")) {
    for (const json& impact : line.array(root["impacts"])) {
      step.impacts.push_back(read_impact(impact, bodies, line));
    }
  }
  step.ties =
      read_ties(root, header.scene.simulation ? header.scene.simulation->ties.size() : 0, line);
  step.devices = read_devices(root, header, line);
  step.clearance = root["clearance"].is_null() ? std::numeric_limits<double>::infinity()
                                               : line.not_negative(root["clearance"]);
  step.kinetic_energy = line.number(root["kinetic_energy"]);
  step.potential_energy = line.number(root["potential_energy"]);
  step.linear_momentum = line.vector3(root["linear_momentum"]);
  step.angular_momentum = line.vector3(root["angular_momentum"]);
  step.residual = line.not_negative(root["residual"]);
  step.events = line.index(root["events"], kAnyCount);
  return step;
}

}  // namespace

RunReader::RunReader(std::istream& run, std::string path, const ReadingOptions& options)
    : stream_(run), path_(std::move(path)) {
  header_ = read_header(header_line(), path_, options);
}

RunReader::RunReader(std::istream& run, std::string path, RunHeader header)
    : stream_(run), path_(std::move(path)), header_(std::move(header)) {
  (void)header_line();
}

std::string RunReader::header_line() {
  std::optional<std::string> line = next_line();
  if (!line) {
    throw ParseError(path_, 1, "expected the header of a run, got no whole line");
  }
  return std::move(*line);
}

std::optional<RunStep> RunReader::next() {
  const std::optional<std::string> text = next_line();
  if (!text) {
    return std::nullopt;
  }
  const Line line(*text, path_, line_);
  RunStep step = read_step(line, header_);
  if (step.index != steps_ + 1) {
    line.fail(line.root()["step"], std::to_string(steps_ + 1) + ", the steps in order");
  }
  ++steps_;
  return step;
}

/// Reads a line; none at the end, or where the last line has no line feed.
std::optional<std::string> RunReader::next_line() {
  std::string text;
  std::getline(stream_, text);
  if (stream_.bad() || (stream_.fail() && !stream_.eof())) {
    throw ParseError(path_, line_ + 1, "expected a readable file");
  }
  if (stream_.eof()) {
    cut_off_ = !text.empty();
    return std::nullopt;
  }
  ++line_;
  size_ += text.size() + 1;
  return text;
}

}  // namespace firstcontact
