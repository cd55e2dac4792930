// Scenes of all that files can say at once: written, read, and written again, they are the same.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/tie.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/write_json.h>

#include "scene/robot_text.h"
#include "scene/scene_bits.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using test::Random;
using test::SceneBits;

/// Names that need care: quotes, backslashes, control characters, slashes, other scripts.
const std::vector<std::string> kOddNames = {"a \"quoted\"",
                                            "back\\slash",
                                            "tab\tbell\x07",
                                            "r/none",
                                            "\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80",
                                            " ",
                                            "*",
                                            "null",
                                            "world",
                                            std::string(300, 'x')};

/// Texts of random scenes. Expressions draw in the order that the compiler takes: another one may
/// make other scenes of a seed.
class SceneText {
 public:
  explicit SceneText(std::uint64_t seed) : random_(seed) {}

  /// A scene with every odd name, and two robots of the files of AnyScene.
  std::string scene() {
    std::string bodies;
    for (std::size_t k = 0; k < kOddNames.size(); ++k) {
      bodies += (k == 0 ? "" : ", ") + body(kOddNames[k], k);
    }
    std::string text = R"({"firstcontact": 1, "id": )" + quoted(kOddNames[any(kOddNames.size())]) +
                       R"(, "bodies": [)" + bodies + R"(], "robots": [)" + robot("r") + ", " +
                       robot("s \"2\"") + "]";
    text += R"(, "pairs": )" + pairs() + R"(, "options": )" + options();
    return text + R"(, "simulation": )" + simulation() + "}";
  }

 private:
  std::size_t any(std::size_t count) {
    return static_cast<std::size_t>(random_.uniform(0.0, static_cast<double>(count)));
  }
  bool chance() { return random_.chance(0.5); }
  static std::string quoted(std::string_view text) { return detail::write_json(text); }
  std::string positive(double low = 1e-9, double high = 1e9) {
    return detail::write_json(random_.logarithmic(low, high));
  }
  std::string number() { return (chance() ? "-" : "") + positive(); }
  std::string three() {
    const std::string x = number();
    const std::string y = number();
    return "[" + x + ", " + y + ", " + number() + "]";
  }
  /// A key with its value in every second object.
  std::string maybe(const std::string& member) { return chance() ? ", " + member : ""; }

  std::string pose() {
    const std::string position = R"({"position": )" + three();
    return position + R"(, "quaternion_wxyz": [1, )" + number() + ", " + number() + ", 0]}";
  }

  std::string shape(std::size_t which) {
    const std::vector<std::string> shapes = {
        R"({"mesh": "plate.off", "scale": )" + positive() + R"(, "radius": )" + positive() + "}",
        R"({"points": "cloud.xyz", "scale": )" + positive() + "}",
        R"({"convex_hull": {"mesh": "plate.off", "scale": )" + positive() + "}}",
        R"({"heightmap": {"cell": [)" + positive() + R"(, 1], "heights": [[0, 1], [)" + number() +
            ", 2]]}}",
        R"({"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "solid": true,
            "triangles": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], "enclosure_error": )" +
            positive() + "}",
        R"({"ellipsoid": {"radii": [1, 2, )" + positive(1e-3, 1e3) + "]}}",
        R"({"capsule": {"radius": )" + positive() + R"(, "length": 0}})"};
    return shapes[which % shapes.size()];
  }

  std::string moves() {
    switch (any(5)) {
      case 0:
        return R"("pose": )" + pose();
      case 1:
        return R"("motion": {"type": "fixed", "pose": )" + pose() + "}";
      case 2:
        return R"("motion": {"type": "constant_velocity", "from": )" + pose() +
               R"(, "rotation_vector": [0, 0, )" + positive(1e-3, 1e3) + "]}";
      case 3:
        return R"("motion": {"type": "screw", "from": )" + pose() + R"(, "to": )" + pose() + "}";
      default:
        return R"("motion": {"type": "waypoints", "times": [0, 0.125, 1], "between": "screw",
                   "poses": [)" +
               pose() + ", " + pose() + ", " + pose() + "]}";
    }
  }

  std::string surface() { return R"("friction": )" + positive() + maybe(R"("restitution": 0.3)"); }

  std::string body(const std::string& name, std::size_t which) {
    const std::string head = R"({"name": )" + quoted(name) + R"(, "shape": )" + shape(which);
    if (which % 3 == 1) {  // It is free.
      return head + R"(, "pose": )" + pose() + R"(, "dynamics": {)" + surface() +
             maybe(R"("mass": )" + positive()) + maybe(R"("linear_velocity": )" + three()) +
             maybe(R"("locked_rotation": [true, false, true])") +
             maybe(R"("forces": [{"from": 0.5, "torque": )" + three() + "}]") + "}}";
    }
    if (which % 3 == 2) {  // A link may hold it.
      return head + R"(, "pose": )" + pose() + "}";
    }
    return head + ", " + moves() + maybe(R"("surface": {"velocity": )" + three() + "}") + "}";
  }

  std::string motors() {
    std::string text = R"("motors": {"elbow": )";
    switch (any(4)) {
      case 0:
        text += R"({"position": )" + number() + maybe(R"("stiffness": )" + positive());
        break;
      case 1:
        text += R"({"position": 1, "stiffness": 2, "damping": )" + positive();
        break;
      case 2:
        text += R"({"velocity": [[0, )" + number() + "], [0.25, " + number() + "]]";
        break;
      default:
        text += R"({"torque": )" + number();
    }
    return text + maybe(R"("effort": )" + positive()) + "}}";
  }

  std::string robot(const std::string& name) {
    const bool is_free = chance();
    std::string text = R"({"name": )" + quoted(name) + R"(, "urdf": "arm.urdf")";
    text += maybe(R"("srdf": "arm.srdf")") + maybe(R"("surface": "visual")");
    text += maybe(R"("base": )" + pose()) + maybe(R"("padding": {"bar": )" + positive() + "}");
    text += maybe(R"("tracking_error": )" + positive()) + R"(, "state": {"elbow": )" +
            positive(1e-9, 1.0) + "}";
    // Each robot holds a different body at rest.
    text += R"(, "attached": [{"body": )" + quoted(kOddNames[name == "r" ? 2 : 5]) +
            R"(, "link": "tip", "touch_links": ["bar", "base"])" + maybe(R"("pose": )" + pose()) +
            maybe(R"("to_time": 0.5)") + "}]";
    text += R"(, "dynamics": {"base": )" + quoted(is_free ? "free" : "fixed") +
            (is_free ? R"(, "angular_velocity": )" + three() : "") +
            maybe(R"("velocities": {"elbow": )" + number() + "}") + maybe(motors()) +
            maybe(R"("density": )" + positive()) + maybe(surface()) + "}";
    return text + "}";
  }

  std::string member() {
    const std::size_t which = any(kOddNames.size() + 2);
    return quoted(which < kOddNames.size()    ? kOddNames[which]
                  : which == kOddNames.size() ? "r/tip"
                                              : "s \"2\"/bar");
  }

  std::string pairs() {
    return R"({"groups": {"g \u20ac": ["r", " "], "empty": []}, "ignore": [["r", "s \"2\""],
               ["g \u20ac", "g \u20ac"], ["*", "r/tip"]],
               "margin": [["world", "r", 0.5], ["r/bar", "world", )" +
           positive() + R"(], ["g \u20ac", "g \u20ac", )" + positive() + "]]}";
  }

  std::string options() {
    return R"({"tolerance": )" + positive() + R"(, "margin": )" + positive() +
           maybe(R"("contacts": "all")") + maybe(R"("start_contacts": "keep_half")") +
           maybe(R"("contact_band": )" + positive()) + maybe(R"("deadline": )" + positive()) +
           maybe(R"("lenient": true)") + "}";
  }

  std::string tie() {
    const std::string type = kTieTypeWords[any(kTieTypeWords.size())];
    std::string other = member();
    std::string text = R"({"type": ")" + type + R"(", "bodies": [)";
    text += chance() ? "null, " + other : other + ", null";
    text += R"(], "points": [)" + three() + ", ";
    text += (type == "pin" || type == "weld" ? "null" : three()) + "]";
    if (type == "spring" || type == "cable") {
      text += R"(, "stiffness": )" + positive() + maybe(R"("damping": )" + positive());
      text += maybe(R"("length": )" + positive());
    }
    return text + (type == "hinge" ? R"(, "axis": )" + three() : "") + "}";
  }

  std::string simulation() {
    std::string ties = tie();
    for (std::size_t k = any(5); k > 0; --k) {
      ties += ", " + tie();
    }
    return R"({"duration": )" + positive(0.5, 1.0) + maybe(R"("impacts": "simultaneous")") +
           maybe(R"("jams": "wait")") + maybe(R"("gravity": )" + three()) +
           maybe(R"("contact_distance": )" + positive()) + maybe(R"("events": 4294967295)") +
           R"(, "pairs": [{"bodies": ["r/tip", "world"], )" + surface() + R"(}], "ties": [)" +
           ties + "]}";
  }

  Random random_;
};

class AnyScene : public testing::Test {
 protected:
  AnyScene() {
    folder_.write("plate.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    folder_.write("cloud.xyz", "0 0 0\n1 2 3\n");
  }

  test::ArmFolder folder_;
};

TEST_F(AnyScene, IsTheSameAfterAFirstAndASecondRound) {
  for (int seed = 1; seed <= test::rounds(300, 30); ++seed) {
    const std::string text = SceneText(static_cast<std::uint64_t>(seed)).scene();
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + text);
    const Scene scene = parse_scene(text, folder_.path() / "s.json");
    const std::string once = write_scene(scene);
    ASSERT_EQ(once.find('\n'), std::string::npos);
    const Scene again = parse_scene(once, "/nowhere/else.json");
    ASSERT_EQ(SceneBits(again), SceneBits(scene)) << once;
    ASSERT_EQ(write_scene(again), once);
    ASSERT_EQ(again.robots[0].model.name(), scene.robots[0].model.name());
  }
}

// Twins of the law above: what SceneBits would not see could be lost without notice.
TEST_F(AnyScene, IsComparedByWhatARoundCouldLose) {
  const Scene scene = parse_scene(SceneText(1).scene(), folder_.path() / "s.json");
  const auto expect_seen = [&](const auto& change) {
    Scene other = scene;
    change(other);
    EXPECT_NE(SceneBits(other), SceneBits(scene));
  };
  expect_seen([](Scene& s) { s.bodies[0].surface.velocity = Eigen::Vector3d(7, 0, 0); });
  expect_seen([](Scene& s) { s.robots[0].dynamics->surface.friction = 1e77; });
  expect_seen([](Scene& s) { s.robots[1].attached[0].touch_links.pop_back(); });
  expect_seen([](Scene& s) { s.simulation->ties[0].damping += 1.0; });
  expect_seen([](Scene& s) { s.simulation->pairs[0].surface.friction = {}; });
  expect_seen([](Scene& s) {
    const bool is_sequential = s.simulation->impacts == ImpactLaw::sequential;
    s.simulation->impacts = is_sequential ? ImpactLaw::simultaneous : ImpactLaw::sequential;
  });
  expect_seen([](Scene& s) {
    const bool waits = s.simulation->jams == JamRule::wait;
    s.simulation->jams = waits ? JamRule::lose_time : JamRule::wait;
  });
  expect_seen([](Scene& s) { s.group_margins[0].margin += 1.0; });
}

// A file names each key once and every name as it is: nothing of them is cut or mended.
TEST_F(AnyScene, KeepsNamesByteForByte) {
  const Scene scene = parse_scene(SceneText(2).scene(), folder_.path() / "s.json");
  ASSERT_EQ(scene.bodies.size(), kOddNames.size());
  for (std::size_t k = 0; k < kOddNames.size(); ++k) {
    EXPECT_EQ(scene.bodies[k].name, kOddNames[k]);
  }
  EXPECT_EQ(scene.robots[1].name, "s \"2\"");
  EXPECT_EQ(scene.groups.at(0).name, "g \xe2\x82\xac");
}

}  // namespace
}  // namespace firstcontact
