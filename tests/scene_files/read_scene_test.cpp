#include <firstcontact/scene_files/read_scene.h>

#include <clocale>
#include <cmath>
#include <filesystem>
#include <locale>
#include <numbers>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/scene_bits.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::body;
using test::scene;

const std::filesystem::path kCorpus =
    std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / "tests/fuzz/corpus/fuzz_scene";

Pose read_pose(const std::string& pose) {
  const Scene read = parse_scene(scene(body("a", "\"pose\": " + pose)), "s");
  return std::get<FixedMotion>(read.bodies[0].motion).pose;
}

template <class T>
T read_motion(const std::string& motion) {
  const Scene read = parse_scene(scene(body("a", "\"motion\": " + motion)), "s");
  return std::get<T>(read.bodies[0].motion);
}

TEST(ReadScene, LeavesOutIsTheDefault) {
  const Scene read = parse_scene(scene(body("a")), "s");
  EXPECT_EQ(read.id, "");
  ASSERT_EQ(read.bodies.size(), 1u);
  EXPECT_EQ(read.bodies[0].name, "a");
  EXPECT_EQ(read.bodies[0].shape.radius, 0.0);
  EXPECT_EQ(std::get<Mesh>(read.bodies[0].shape.source).triangles.size(), 1u);
  const Pose& pose = std::get<FixedMotion>(read.bodies[0].motion).pose;
  EXPECT_TRUE(pose.position.isZero(0.0));
  EXPECT_EQ(pose.rotation.w(), 1.0);
  EXPECT_EQ(read.duration, 1.0);
  EXPECT_EQ(read.options.tolerance, 1e-6);
  EXPECT_EQ(read.options.margin, 0.0);
  EXPECT_EQ(read.options.contacts, ContactState::nearest());
  EXPECT_FALSE(read.options.deadline);
}

TEST(ReadScene, TakesEveryOption) {
  const Scene read = parse_scene(
      scene(body("a") + "," + body("b") + "," + body("c"),
            R"("id": "x", "pairs": {"ignore": [["c", "a"]], "margin": [["b", "a", 0.5]]},
               "options": {"tolerance": 1e-9, "margin": 0.25, "contacts": "first",
                           "start_contacts": "keep_half", "contact_band": 1e-3, "deadline": 10,
                           "duration": 0.004})"),
      "s");
  EXPECT_EQ(read.id, "x");
  EXPECT_EQ(read.ignored_pairs, (std::vector<BodyPair>{{0, 2}}));
  ASSERT_EQ(read.pair_margins.size(), 1u);
  EXPECT_EQ(read.pair_margins[0].bodies, (BodyPair{0, 1}));
  EXPECT_EQ(read.pair_margins[0].margin, 0.5);
  EXPECT_EQ(read.options.tolerance, 1e-9);
  EXPECT_EQ(read.options.margin, 0.25);
  EXPECT_EQ(read.options.contacts, ContactState::first);
  EXPECT_EQ(read.options.start_contacts, StartContacts::keep_half);
  EXPECT_EQ(read.options.contact_band, 1e-3);
  EXPECT_EQ(read.options.deadline, 10.0);
  EXPECT_EQ(read.duration, 0.004);
}

TEST(ReadScene, TakesWordsAndNumbersForContacts) {
  const auto contacts = [](const std::string& value) {
    return parse_scene(scene(body("a"), R"("options": {"contacts": )" + value + "}"), "s")
        .options.contacts;
  };
  EXPECT_EQ(contacts(R"("none")"), ContactState::none);
  EXPECT_EQ(contacts(R"("all")"), ContactState::all);
  EXPECT_EQ(contacts("1"), ContactState::nearest(1));
  EXPECT_EQ(contacts("123456"), ContactState::nearest(123456));
  for (const char* wrong : {"0", "-1", "2.5", "1e300", R"("some")", "[]"}) {
    EXPECT_THROW((void)contacts(wrong), ParseError) << wrong;
  }
}

// Roll, then pitch, then yaw, each about a fixed axis: x goes to y by yaw, z to x by pitch.
TEST(ReadScene, TurnsRpyAboutFixedAxes) {
  const double quarter = std::numbers::pi / 2.0;
  const std::string angle = "1.5707963267948966";
  const Pose pose = read_pose(R"({"rpy": [)" + angle + ", " + angle + ", 0]}");
  // y to z by roll, z to x by pitch.
  EXPECT_TRUE((pose.rotation * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitX(), 1e-15));
  const Pose yaw = read_pose(R"({"rpy": [0, 0, )" + angle + "]}");
  EXPECT_NEAR(yaw.rotation.z(), std::sin(quarter / 2.0), 1e-15);
}

TEST(ReadScene, TakesEveryFormOfARotation) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  for (const char* form : {R"({"rpy": [0, 0, 0.5]})", R"({"rotation_vector": [0, 0, 0.5]})",
                           R"({"matrix": [[0.87758256189037276, -0.47942553860420301, 0, 0],
                       [0.47942553860420301, 0.87758256189037276, 0, 0],
                       [0, 0, 1, 0], [0, 0, 0, 1]]})"}) {
    EXPECT_LT(read_pose(form).rotation.angularDistance(turn), 1e-15) << form;
  }
  // A quaternion is taken as it is: normalising is the motion's business, and exact there.
  EXPECT_EQ(read_pose(R"({"quaternion_wxyz": [3, 0, 0, 4]})").rotation.coeffs(),
            Eigen::Vector4d(0, 0, 4, 3));
}

TEST(ReadScene, TakesEveryFormOfAMotion) {
  const auto spin = read_motion<ConstantVelocityMotion>(
      R"({"type": "constant_velocity", "from": {"position": [0, 5, 0]},
          "translation": [0, 0, 0.1], "rotation_vector": [0, 0, 62.8]})");
  EXPECT_EQ(spin.from.position.y(), 5.0);
  EXPECT_EQ(spin.translation.z(), 0.1);
  EXPECT_EQ(spin.rotation_vector.z(), 62.8);

  const auto thrown =
      read_motion<TwoPoseMotion>(R"({"type": "constant_velocity", "to": {"position": [1, 0, 0]}})");
  EXPECT_EQ(thrown.to.position.x(), 1.0);
  EXPECT_EQ(thrown.between, Between::constant_velocity);
  EXPECT_EQ(read_motion<TwoPoseMotion>(R"({"type": "screw", "to": {}})").between, Between::screw);

  const auto screw = read_motion<ScrewMotion>(
      R"({"type": "screw", "axis_point": [1, 2, 3], "axis_direction": [0, 0, 2],
          "angle": -31.4, "translation": -0.01})");
  EXPECT_EQ(screw.axis_point, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(screw.axis_direction, Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(screw.angle, -31.4);
  EXPECT_EQ(screw.translation, -0.01);

  const auto cart = read_motion<WaypointMotion>(
      R"({"type": "waypoints", "times": [0, 1, 2.5], "poses": [{}, {}, {"position": [9, 2, 0]}],
          "between": "screw"})");
  EXPECT_EQ(cart.times, (std::vector{0.0, 1.0, 2.5}));
  EXPECT_EQ(cart.poses[2].position.x(), 9.0);

  const auto flag =
      read_motion<VertexMotion>(R"({"type": "vertices", "to": [[0, 0, 4], [1, 0, 4], [0, 1, 5]]})");
  EXPECT_EQ(flag.to.size(), 3u);
  EXPECT_EQ(flag.to.at(2), Eigen::Vector3d(0, 1, 5));
  EXPECT_EQ(cart.between, Between::screw);
}

TEST(ReadScene, LastsUntilTheLastWaypoint) {
  const std::string short_one =
      R"("motion": {"type": "waypoints", "times": [0, 2], "poses": [{}, {}]})";
  const std::string long_one =
      R"("motion": {"type": "waypoints", "times": [1, 2.5], "poses": [{}, {}]})";
  const std::string bodies = body("a", short_one) + "," + body("b", long_one);
  EXPECT_EQ(parse_scene(scene(bodies), "s").duration, 2.5);
  EXPECT_EQ(parse_scene(scene(bodies, R"("options": {"duration": 2.5})"), "s").duration, 2.5);
}

TEST(ReadScene, FindsFilesBesideTheSceneAndInPackages) {
  const Scene read = read_scene(kCorpus / "good/all.json");
  const auto& in_package = std::get<MeshFile>(read.bodies[0].shape.source);
  EXPECT_TRUE(std::filesystem::equivalent(in_package.path, kCorpus / "triangle.obj"));
  EXPECT_EQ(in_package.scale, 1e-3);
  EXPECT_EQ(read.bodies[0].shape.radius, 0.5);
  const auto& beside = std::get<MeshFile>(read.bodies[1].shape.source);
  EXPECT_TRUE(std::filesystem::equivalent(beside.path, kCorpus / "triangle.obj"));
}

TEST(ReadScene, AnswersEveryGoodSceneOfTheCorpus) {
  ShapeCache cache;
  for (const auto& entry : std::filesystem::directory_iterator(kCorpus / "good")) {
    EXPECT_NO_THROW((void)load_scene(read_scene(entry.path()), cache)) << entry.path();
  }
}

// Only the file knows how many vertices it has.
TEST(ReadScene, MovesAllVerticesOfAFile) {
  ShapeCache cache;
  Scene read = read_scene(kCorpus / "good/deforming.json");
  std::get<VertexMotion>(read.bodies[0].motion).to.pop_back();
  try {
    (void)load_scene(read, cache);
    ADD_FAILURE() << "accepted";
  } catch (const ParseError& error) {
    EXPECT_EQ(std::string(error.what()),
              (kCorpus / "good/../triangle.obj").string() +
                  ": expected a mesh of the 2 vertices that \"a\" moves, got one of 3");
  }
}

TEST(ReadScene, RefusesEveryBadSceneOfTheCorpus) {
  for (const char* folder : {"bad", "inconsistent"}) {
    for (const auto& entry : std::filesystem::directory_iterator(kCorpus / folder)) {
      EXPECT_THROW((void)read_scene(entry.path()), std::runtime_error) << entry.path();
    }
  }
}

TEST(ReadScene, DoesNotHeedTheLocaleNorDoesWriteScene) {
  struct CommaDecimal : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const Scene plain = read_scene(kCorpus / "good/all.json");
  const std::string written = write_scene(plain);
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaDecimal));
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // Where it is installed.
  const Scene with_comma = read_scene(kCorpus / "good/all.json");
  const std::string written_with_comma = write_scene(plain);
  std::setlocale(LC_ALL, "C");
  std::locale::global(before);
  EXPECT_EQ(test::SceneBits(plain), test::SceneBits(with_comma));
  EXPECT_EQ(written, written_with_comma);
}

TEST(ReadScene, NamesItsTextByADigest) {
  const std::string text = scene(body("a"));
  EXPECT_EQ(parse_scene(text, "s").text_digest, parse_scene(text, "other").text_digest);
  EXPECT_NE(parse_scene(text, "s").text_digest, parse_scene(text + " ", "s").text_digest);
}

}  // namespace
}  // namespace firstcontact
