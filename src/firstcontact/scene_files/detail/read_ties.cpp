#include <firstcontact/scene_files/detail/read_ties.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <variant>

#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// The keys of a tie, besides its type and its bodies.
const KnownKeys& keys_of(TieType type) {
  static const KnownKeys spring{{"type", "bodies", "points", "length", "stiffness", "damping"}};
  static const KnownKeys joint{{"type", "bodies", "points"}};
  static const KnownKeys hinge{{"type", "bodies", "points", "axis"}};
  return type == TieType::spring || type == TieType::cable ? spring
         : type == TieType::hinge                          ? hinge
                                                           : joint;
}

void read_tied_bodies(const JsonValue& value, const SceneNames& names, const JsonReader& read,
                      Tie& tie) {
  const std::string expected =
      "a pair of names, such as [\"a\", \"robot/link\"]; null is the world";
  const JsonArray& sides = read.array(value, expected);
  if (sides.size() != 2) {
    read.fail_expected(expected, value);
  }
  for (std::size_t s = 0; s < 2; ++s) {
    if (!std::holds_alternative<JsonNull>(sides[s].value)) {
      tie.bodies[s] = read_member(sides[s], names, read);
    }
  }
  if (tie.bodies[0] == tie.bodies[1]) {
    read.fail(value, tie.bodies[0] ? "expected two bodies, got one twice"
                                   : "expected at least one body, got the world twice");
  }
}

void read_points(const JsonValue& value, const JsonReader& read, Tie& tie) {
  const std::string expected = "a pair of points, such as [[0, 0, 0.1], [0, 0, 0]]";
  const JsonArray& points = read.array(value, expected);
  if (points.size() != 2) {
    read.fail_expected(expected, value);
  }
  for (std::size_t s = 0; s < 2; ++s) {
    if (!std::holds_alternative<JsonNull>(points[s].value)) {
      tie.points[s] = read.vector3(points[s]);
    }
  }
}

void require_points(const JsonValue& value, const JsonReader& read, const Tie& tie) {
  const bool has_line = tie.type == TieType::spring || tie.type == TieType::cable;
  if (has_line && !(tie.points[0] && tie.points[1])) {
    read.fail(value, std::string("expected \"points\": a point of each body of the ") +
                         kTieTypeWords[static_cast<std::size_t>(tie.type)]);
  }
  if (!has_line && tie.type != TieType::weld && !tie.points[0] && !tie.points[1]) {
    read.fail(value,
              "expected \"points\": a point of at least one of the bodies; null is where the "
              "other one is at the start");
  }
}

Tie read_tie(const JsonValue& value, const SceneNames& names, const JsonReader& read) {
  Tie tie;
  tie.type = read.enumerator<TieType>(read.member(value, "type"), kTieTypeWords);
  const JsonObject& object = read.object(value, keys_of(tie.type));
  read_tied_bodies(read.member(value, "bodies"), names, read, tie);
  if (const JsonValue* points = find(object, "points")) {
    read_points(*points, read, tie);
  }
  require_points(value, read, tie);
  if (const JsonValue* length = find(object, "length")) {
    tie.length = tie.type == TieType::cable ? read.positive(*length) : read.not_negative(*length);
  }
  if (const JsonValue* stiffness = find(object, "stiffness")) {
    tie.stiffness = read.positive(*stiffness);
  }
  if (const JsonValue* damping = find(object, "damping")) {
    tie.damping = read.not_negative(*damping);
    if (tie.type == TieType::cable && !tie.stiffness) {
      read.fail(*damping,
                "\"damping\" of a cable needs a \"stiffness\"; without one it does not "
                "stretch");
    }
  }
  if (tie.type == TieType::spring && !tie.stiffness && !(tie.damping > 0.0)) {
    read.fail(value, "expected \"stiffness\" or \"damping\" of the spring, got neither");
  }
  if (const JsonValue* axis = find(object, "axis")) {
    tie.axis = read.vector3(*axis);
    if (!(tie.axis.norm() > 0.0) || !std::isfinite(tie.axis.norm())) {
      read.fail(*axis, "expected an axis that is not zero");
    }
  }
  return tie;
}

}  // namespace

std::size_t read_member(const JsonValue& value, const SceneNames& names, const JsonReader& read) {
  const std::string expected = "the name of a body, or robot/link";
  const std::string& name = read.string(value, expected);
  const auto found = names.find(name);
  if (found == names.end()) {
    read.fail(value, "expected " + expected + ", got " + in_quotes(name) + hint(names, name));
  }
  if (found->second.kind != Named::Kind::member) {
    read.fail(value, "expected " + expected + ", got the robot or group " + in_quotes(name));
  }
  return found->second.index;
}

std::vector<Tie> read_ties(const JsonValue& value, const SceneNames& names,
                           const JsonReader& read) {
  std::vector<Tie> ties;
  for (const JsonValue& element : read.array(value, "an array of springs, cables and joints")) {
    ties.push_back(read_tie(element, names, read));
  }
  return ties;
}

}  // namespace firstcontact::detail
