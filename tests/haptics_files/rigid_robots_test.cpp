// Robots in one posture as tools and surroundings: one mesh of all links, where the links are.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptics_files/haptic_run.h>
#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/record/read_run.h>
#include <firstcontact/record/write_run.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/verification/verify_run.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "support/random.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

class RigidRobots : public testing::Test {
 protected:
  /// A ball on a table, and the arm with these keys.
  [[nodiscard]] Scene parse(const std::string& arm, const std::string& haptics,
                            const std::string& more = "") const {
    return parse_scene(R"({"firstcontact": 1, "bodies": [
        {"name": "table", "shape": {"box": {"size": [4, 4, 0.2]}}, "pose": {"position": [0, 0, -1]}},
        {"name": "ball", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0, 0, -0.7]}}],
        "robots": [{"name": "arm", "urdf": "arm.urdf")" +
                           arm + R"(}], "haptics": {"tools": [)" + haptics + "]}" + more + "}",
                       folder_.path() / "scene.json");
  }

  [[nodiscard]] std::string refusal(const std::string& arm, const std::string& haptics,
                                    const std::string& more = "") const {
    return test::message_of<std::exception>([&] {
      Scene scene = parse(arm, haptics, more);
      ShapeCache cache;
      prepare_haptics(scene, cache, 1.0);
    });
  }

  test::ArmFolder folder_;
  const std::string posture_ = R"(, "state": {"elbow": 0.7}, "base": {"position": [0.2, 0.1, 0.3],
      "rotation_vector": [0.3, 0.5, -0.2]})";
};

double distance_to(const Shape& shape, const Pose& X_WS, const Vector3d& point) {
  Workspace workspace;
  return distance({shape, Motion::fixed(X_WS)},
                  {make_sphere(1e-12), Motion::fixed({point, Eigen::Quaterniond::Identity()})}, 0.0,
                  workspace)
      .distance;
}

/// The triangles of a sphere stand out by 5e-3 of its radius at most.
TEST_F(RigidRobots, StandWhereTheirLinksAre) {
  Scene scene = parse(posture_, R"({"robot": "arm"})");
  ShapeCache cache;
  const LoadedScene links = load_scene(scene, cache);
  prepare_haptics(scene, cache, 1.0);
  const LoadedScene loaded = load_scene(std::move(scene), cache);
  ASSERT_EQ(loaded.scene.bodies.size(), 3U);
  EXPECT_EQ(loaded.scene.bodies[2].name, "arm");
  const HapticSetup setup = haptic_setup(loaded);
  EXPECT_EQ(setup.scene.tools[0].name, "arm");
  EXPECT_LT((setup.scene.tools[0].X_WB.position - Vector3d(0.2, 0.1, 0.3)).norm(), 1e-15);
  const Shape& arm = loaded.bodies.shape(2);
  EXPECT_TRUE(arm.is_solid());
  test::Random random(1);
  for (int k = 0; k < 400; ++k) {
    const Vector3d point = random.vector(0.0, 1.6);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t m = 2; m < links.robots->size(); ++m) {
      for (std::size_t g = 0; g < links.robots->geometries(m).size(); ++g) {
        least = std::min(least, distance_to(links.robots->geometries(m)[g].shape,
                                            links.robots->geometry_pose(m, g, 0.0), point));
      }
    }
    const double found = distance_to(arm, setup.scene.tools[0].X_WB, point);
    EXPECT_LE(found, least + 1e-12) << k;
    EXPECT_GE(found, least - 5.1e-4) << k;
  }
}

TEST_F(RigidRobots, AreFeltAndProven) {
  for (const bool is_tool : {true, false}) {
    Scene scene = parse(is_tool ? R"(, "state": {"elbow": 0.5}, "base": {"position": [0, 0, -0.5]})"
                                : R"(, "base": {"position": [0, 0, -0.45]})",
                        is_tool ? R"({"robot": "arm"})" : R"({"body": "ball"})");
    ShapeCache cache;
    prepare_haptics(scene, cache, 0.1);
    const LoadedScene loaded = load_scene(std::move(scene), cache);
    const HapticSetup setup = haptic_setup(loaded);
    ContactLoop loop(setup.scene, setup.options.contacts);
    HapticRun run(loaded, setup, loop.contact_distance());
    std::string text = write_run_header(run.header());
    std::size_t contacts = 0;
    for (int k = 0; k < 100; ++k) {
      const double z = setup.scene.tools[0].X_WB.position.z() + (is_tool ? -0.008 : 0.006) * k;
      const HapticCycle cycle = loop.advance(
          std::vector<Pose>{{{0.001 * k, 0.0, z}, Eigen::Quaterniond::Identity()}}, 1e-3, k);
      contacts = std::max(contacts, cycle.touches.size());
      text += write_run_step(run.step(cycle));
    }
    EXPECT_GT(contacts, 0U) << is_tool;
    std::istringstream stream(text);
    RunReader reader(stream, "run.jsonl");
    const RunVerification proof = verify_run(reader.header(), [&] { return reader.next(); });
    EXPECT_EQ(proof.verdict, ProofVerdict::proven) << is_tool << ": " << proof.problem;
  }
}

/// The links are solid, but their mesh with an open one is not.
TEST_F(RigidRobots, AreRefusedWhereAToolStartsInsideALink) {
  folder_.write("open.obj", "v 0 0 2\nv 1 0 2\nv 0 1 2\nf 1 2 3\n");
  folder_.write("mixed.urdf", R"(<robot name="mixed">
      <link name="a"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
      <link name="b"><collision><geometry><mesh filename="open.obj"/></geometry></collision></link>
      <joint name="weld" type="fixed"><parent link="a"/><child link="b"/></joint></robot>)");
  const auto scene_with_ball_at = [&](const std::string& z) {
    return parse_scene(R"({"firstcontact": 1, "bodies": [{"name": "ball",
        "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0, 0, )" +
                           z + R"(]}}], "robots": [{"name": "mixed", "urdf": "mixed.urdf"}],
        "haptics": {"tools": [{"body": "ball"}]}})",
                       folder_.path() / "scene.json");
  };
  ShapeCache cache;
  Scene inside = scene_with_ball_at("0.1");
  EXPECT_EQ(
      test::message_of<std::invalid_argument>([&] { prepare_haptics(inside, cache, 1.0); }),
      "haptics: \"ball\" and \"mixed/a\" meet at the start; expected tools that are free there");
  Scene outside = scene_with_ball_at("0.7");
  EXPECT_NO_THROW(prepare_haptics(outside, cache, 1.0));
}

/// A capsule of no length is a sphere; warnings come once.
TEST_F(RigidRobots, TakeCapsulesOfNoLengthAndWarnOnce) {
  folder_.write("dot.urdf", R"(<robot name="dot"><link name="a"><collision><geometry>
      <capsule radius="0.1" length="0"/></geometry></collision></link>
      <link name="b"/><joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
      </robot>)");
  Scene scene = parse_scene(R"({"firstcontact": 1, "bodies": [{"name": "hill",
      "shape": {"vertices": [[9000, 0, -3], [0, 9000, -3], [-9000, -9000, -3]],
      "triangles": [[0, 1, 2]]}}],
      "robots": [{"name": "dot", "urdf": "dot.urdf"}], "haptics": {"tools": [{"robot": "dot"}]}})",
                            folder_.path() / "scene.json");
  ShapeCache cache;
  prepare_haptics(scene, cache, 1.0);
  const LoadedScene loaded = load_scene(std::move(scene), cache);
  EXPECT_NEAR(loaded.bodies.shape(1).hierarchy().radius, 0.1, 1e-3);
  const auto is_of_hill = [](const std::string& warning) {
    return warning.find("hill") != std::string::npos;
  };
  EXPECT_EQ(std::ranges::count_if(loaded.warnings, is_of_hill), 1);
  EXPECT_EQ(loaded.warnings.size(), 2U);  // And of the joint, which nothing places.
}

TEST_F(RigidRobots, KeepTheRulesOfWholeRobots) {
  Scene scene = parse("", R"({"robot": "arm"})", R"(, "pairs": {"ignore": [["arm", "table"]],
      "groups": {"all": ["arm", "ball"]}})");
  ShapeCache cache;
  prepare_haptics(scene, cache, 1.0);
  ASSERT_EQ(scene.ignored_pairs.size(), 1U);
  EXPECT_EQ(scene.ignored_pairs[0], (BodyPair{0, 2}));
  EXPECT_EQ(scene.groups.at(0).bodies, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(
      refusal("", R"({"robot": "arm"})", R"(, "pairs": {"ignore": [["arm/tip", "table"]]})"),
      "haptics: pairs: expected \"table\" and \"arm\" ignored as a whole, got some links only");
  EXPECT_EQ(refusal("", R"({"robot": "arm"})", R"(, "pairs": {"groups": {"some": ["arm/tip"]}})"),
            "haptics: group \"some\": expected \"arm\" as a whole, got some links only");
}

TEST_F(RigidRobots, RefuseWhatIsNotRigid) {
  const std::string name = "haptics: robot \"arm\": expected ";
  EXPECT_EQ(refusal(R"(, "trajectory": "move.csv")", R"({"robot": "arm"})"),
            name + "one posture: a \"base\" at rest, and \"state\" or a trajectory of one point");
  EXPECT_EQ(refusal(R"(, "attached": [{"body": "ball", "link": "tip"}])", R"({"robot": "arm"})"),
            name + "no \"attached\" bodies; make them links of the robot");
  EXPECT_EQ(refusal(R"(, "padding": 0.1)", R"({"robot": "arm"})"), name + "no \"padding\"");
  EXPECT_EQ(refusal(R"(, "tracking_error": 0.1)", R"({"robot": "arm"})"),
            name + "no \"tracking_error\"");
  EXPECT_EQ(refusal(R"(, "dynamics": {})", R"({"robot": "arm"})"), name + "no \"dynamics\"");
  const auto ends_with = [](const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
  };
  EXPECT_TRUE(ends_with(refusal("", R"({"robot": "hand"})"),
                        "expected a robot of the scene (\"arm\"), got \"hand\""))
      << refusal("", R"({"robot": "hand"})");
  EXPECT_TRUE(ends_with(refusal("", R"({"robot": "arm"}, {"robot": "arm"})"),
                        "expected another robot than that of the other tool"));
  EXPECT_TRUE(ends_with(refusal("", R"({"robot": "arm", "body": "ball"})"),
                        "expected either \"body\" or \"robot\", got both"));
}

}  // namespace
}  // namespace firstcontact
