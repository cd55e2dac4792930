#include <firstcontact/scene/links_as_bodies.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/pair_counts.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// base (a plate) -elbow- bar (two beams) -weld- tip (a ball), -slide- hand (no geometry).
const std::string kBeams = R"(<robot name="beams">
  <link name="base"><collision><geometry><box size="0.4 0.4 0.1"/></geometry></collision></link>
  <link name="bar">
    <collision><origin xyz="0.5 0 0" rpy="0 0 0.3"/><geometry><box size="1 0.1 0.1"/></geometry></collision>
    <collision><origin xyz="0 0.2 0.1" rpy="0.5 0 0"/><geometry><box size="0.2 0.3 0.4"/></geometry></collision>
  </link>
  <link name="tip"><inertial><mass value="2"/><origin xyz="0 0 0.01"/>
      <inertia ixx="0.03" iyy="0.04" izz="0.05" ixy="0.001" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0.1 0 0" rpy="0 0.4 0"/><geometry><sphere radius="0.1"/></geometry></collision>
    <collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="hand"/>
  <joint name="elbow" type="revolute"><parent link="base"/><child link="bar"/><axis xyz="0 0 1"/>
    <origin xyz="0 0 0.2" rpy="0.1 0.2 0.3"/><limit lower="-3" upper="3" velocity="9" effort="1"/></joint>
  <joint name="weld" type="fixed"><parent link="bar"/><child link="tip"/><origin xyz="1 0 0"/></joint>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1" velocity="1" effort="1"/></joint>
</robot>)";

class LinksOfRobots : public testing::Test {
 protected:
  LinksOfRobots() {
    folder_.write("beams.urdf", kBeams);
    folder_.write("beams.srdf", R"(<robot name="beams">
      <disable_collisions link1="base" link2="tip" reason="never"/></robot>)");
  }

  [[nodiscard]] LoadedScene load(const std::string& robots, const std::string& more = "") const {
    return test::load_text(R"({"firstcontact": 1, "bodies": [)" + test::body("floor") + "," +
                               test::body("wall", R"("pose": {"position": [0, 0, -3]})") + "," +
                               test::body("free", R"("dynamics": {"mass": 1})") +
                               R"(], "robots": [)" + robots + "]" + more + "}",
                           folder_.path() / "s.json");
  }

  /// Two robots: one has dynamics, the other is scripted; with rules and paddings of all kinds.
  [[nodiscard]] LoadedScene two() const {
    return load(
        R"({"name": "one", "urdf": "beams.urdf", "srdf": "beams.srdf", "state": {"elbow": 0.7},
            "dynamics": {"density": 1000}, "padding": {"bar": 0.01, "base": 0.02}},
           {"name": "two", "urdf": "beams.urdf", "padding": 0.005,
            "base_motion": {"type": "constant_velocity", "from": {"position": [5, 0, 0]},
                            "translation": [-1, 0, 0], "rotation_vector": [0, 2, 0]},
            "trajectory": {"joint_names": ["elbow"], "points": [
              {"time": 0, "positions": [0]}, {"time": 1.5, "positions": [2]}]}})",
        R"(, "pairs": {"ignore": [["one/bar", "floor"], ["one/tip", "two/base"]],
             "margin": [["one/bar", "two/tip", 0.3], ["one", "wall", 0.2], ["g", "two", 0.15]],
             "groups": {"g": ["free", "one/tip"]}},
           "options": {"margin": 0.1}, "simulation": {"step": 0.4, "pairs": [
             {"bodies": ["one/bar", "floor"], "friction": 0.25}]})");
  }

  /// The body that is a geometry, by its name.
  static std::size_t numbered(const LinksAsBodies& links, const std::string& name) {
    const std::vector<Body>& bodies = links.loaded.scene.bodies;
    const auto found = std::find_if(bodies.begin(), bodies.end(),
                                    [&](const Body& body) { return body.name == name; });
    EXPECT_NE(found, bodies.end()) << name;
    return static_cast<std::size_t>(found - bodies.begin());
  }

  /// The member of the given scene that a body of the new one comes from.
  static std::size_t member_of(const LoadedScene& given, const LinksAsBodies& links,
                               std::size_t body) {
    const std::size_t bodies = given.scene.bodies.size();
    if (body < bodies) {
      return body;
    }
    const LinkGeometryPose& from = links.geometries.at(body - bodies);
    return first_member(given.scene, from.robot) + from.link;
  }

  test::ArmFolder folder_;
};

TEST_F(LinksOfRobots, StandBehindTheBodiesByTheirNames) {
  const LoadedScene given = two();
  const LinksAsBodies links = links_as_bodies(given);
  std::vector<std::string> names;
  for (const Body& body : links.loaded.scene.bodies) {
    names.push_back(body.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"floor", "wall", "free", "one/base", "one/bar",
                                             "one/bar#2", "one/tip", "one/tip#2", "two/base",
                                             "two/bar", "two/bar#2", "two/tip", "two/tip#2"}));
  EXPECT_EQ(names_with_links(given.scene), names);
  EXPECT_EQ(links.geometries.size() + 3, names.size());
  EXPECT_EQ(links.models.size(), 2u);
  EXPECT_TRUE(links.loaded.scene.robots.empty());
  EXPECT_FALSE(links.loaded.robots);
  EXPECT_EQ(links.loaded.bodies.size(), names.size());
  EXPECT_EQ(links.loaded.input_digest, given.input_digest);
  EXPECT_EQ(links.loaded.warnings, given.warnings);
}

// The law: every geometry is where the robot has it, at each step of the simulation.
TEST_F(LinksOfRobots, AreWhereTheRobotHasThem) {
  const LoadedScene given = two();
  const LinksAsBodies links = links_as_bodies(given);
  const double duration = given.scene.duration;
  ASSERT_EQ(duration, 1.5);
  for (std::size_t k = 0; k < links.geometries.size(); ++k) {
    const LinkGeometryPose& geometry = links.geometries[k];
    const std::size_t body = given.scene.bodies.size() + k;
    const std::size_t member = member_of(given, links, body);
    const bool has_dynamics = geometry.robot == 0;
    EXPECT_EQ(links.loaded.scene.bodies[body].free.has_value(), has_dynamics);
    for (const double seconds : {0.0, 0.4, 0.8, 1.2, 1.5}) {
      const double t = has_dynamics ? 0.0 : seconds / duration;
      const Pose X_WL = given.robots->pose(member, t);
      const Pose X_WG = links.loaded.bodies.motion(body).pose(seconds / duration);
      const Vector3d expected = X_WL.position + X_WL.rotation.normalized() * geometry.X_LG.position;
      EXPECT_LT((X_WG.position - expected).norm(), 1e-12) << k << " at " << seconds;
      EXPECT_LT(X_WG.rotation.normalized().angularDistance(X_WL.rotation.normalized() *
                                                           geometry.X_LG.rotation.normalized()),
                1e-7);
    }
  }
}

// The law: each two geometries have the margin of their links, with paddings and rules; none within
// a link. Two resting bodies have one only here, as a check does not look at them.
TEST_F(LinksOfRobots, KeepTheRulesOfTheirLinks) {
  const LoadedScene given = two();
  const LinksAsBodies links = links_as_bodies(given);
  const std::size_t count = links.loaded.scene.bodies.size();
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      const BodyPair members{member_of(given, links, a), member_of(given, links, b)};
      const std::optional<double> margin = links.loaded.bodies.rules().margin({a, b});
      SCOPED_TRACE(std::to_string(a) + " and " + std::to_string(b));
      if (members[0] == members[1]) {
        EXPECT_FALSE(margin);
      } else if (members[1] >= given.scene.bodies.size()) {
        EXPECT_EQ(margin, given.robots->margin(members));
      } else {
        EXPECT_EQ(margin, 0.1);
      }
    }
  }
}

TEST_F(LinksOfRobots, KeepTheSurfacesOfTheirPairs) {
  const LinksAsBodies links = links_as_bodies(two());
  const std::vector<PairSurface>& pairs = links.loaded.scene.simulation->pairs;
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].bodies, (BodyPair{0, numbered(links, "one/bar")}));
  EXPECT_EQ(pairs[1].bodies, (BodyPair{0, numbered(links, "one/bar#2")}));
  EXPECT_EQ(pairs[1].surface.friction, 0.25);
}

TEST_F(LinksOfRobots, AreCountedByLinks) {
  const LoadedScene given = two();
  const PairCounts counts = count_simulated_pairs(given);
  const PairCounts taken = links_as_bodies(given).loaded.pair_counts;
  EXPECT_EQ(taken.tested, counts.tested);
  EXPECT_EQ(taken.members, counts.members);
  EXPECT_EQ(taken.members, 9u);  // Three bodies and three links of each robot.
}

/// [kg m^2]  About the link's origin.
Matrix3d about_origin(const Matrix3d& about_C, double mass, const Vector3d& p_LC) {
  return about_C + mass * (p_LC.squaredNorm() * Matrix3d::Identity() - p_LC * p_LC.transpose());
}

/// [kg m^2]  Of a box about its centre.
Matrix3d inertia_of_box(double mass, const Vector3d& size) {
  const Vector3d squares = size.cwiseAbs2();
  return (mass / 12.0 * (Vector3d::Constant(squares.sum()) - squares)).asDiagonal();
}

// A closed form: two beams of 1000 kg/m^3, each by its mass, and the theorem of Steiner.
TEST_F(LinksOfRobots, HaveTheMassOfTheirDensity) {
  const LinksAsBodies links = links_as_bodies(two());
  const LinkInertia bar = links.models[0].links()[1].inertia.value();
  const Vector3d p_1{0.5, 0, 0};
  const Vector3d p_2{0, 0.2, 0.1};
  const Matrix3d R_1 = Eigen::AngleAxisd(0.3, Vector3d::UnitZ()).toRotationMatrix();
  const Matrix3d R_2 = Eigen::AngleAxisd(0.5, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_NEAR(bar.mass, 34.0, 1e-12);
  EXPECT_LT((bar.p_LC - (10.0 * p_1 + 24.0 * p_2) / 34.0).norm(), 1e-15);
  const Matrix3d expected =
      about_origin(R_1 * inertia_of_box(10.0, {1, 0.1, 0.1}) * R_1.transpose(), 10.0, p_1) +
      about_origin(R_2 * inertia_of_box(24.0, {0.2, 0.3, 0.4}) * R_2.transpose(), 24.0, p_2);
  EXPECT_LT((about_origin(bar.about_C_L, bar.mass, bar.p_LC) - expected).norm(), 1e-12);
  EXPECT_EQ(links.models[0].links()[2].inertia->mass, 2.0);  // The file gives one.
  EXPECT_FALSE(links.models[1].links()[1].inertia);          // Without dynamics.
}

// The law: the shares of a link make up the link.
TEST_F(LinksOfRobots, ShareTheMassOfTheirLink) {
  const LinksAsBodies links = links_as_bodies(two());
  for (std::size_t link = 0; link < 3; ++link) {
    const LinkInertia whole = links.models[0].links()[link].inertia.value();
    double mass = 0.0;
    Matrix3d about_C = Matrix3d::Zero();
    for (std::size_t k = 0; k < links.geometries.size(); ++k) {
      const LinkGeometryPose& geometry = links.geometries[k];
      if (geometry.robot != 0 || geometry.link != link) {
        continue;
      }
      const FreeBody& free = links.loaded.scene.bodies[k + 3].free.value();
      const Matrix3d R_LG = geometry.X_LG.rotation.normalized().toRotationMatrix();
      mass += free.mass.value();
      about_C += R_LG * free.inertia.value() * R_LG.transpose();
      const Vector3d p_LC = geometry.X_LG.position + R_LG * free.centre_of_mass.value();
      EXPECT_LT((p_LC - whole.p_LC).norm(), 1e-14) << link;
    }
    EXPECT_NEAR(mass, whole.mass, 1e-12) << link;
    EXPECT_LT((about_C - whole.about_C_L).norm(), 1e-12) << link;
  }
}

TEST_F(LinksOfRobots, RefuseWhatASimulationDoesNotHave) {
  const auto refusal = [&](const std::string& robot) {
    const LoadedScene given = load(robot, R"(, "simulation": {})");
    return test::message_of<std::invalid_argument>([&] { (void)links_as_bodies(given); });
  };
  const std::string arm = R"({"name": "arm", "urdf": "beams.urdf", )";
  EXPECT_EQ(refusal(arm + R"("attached": [{"body": "floor", "link": "tip"}]})"),
            "robot \"arm\": attached bodies are not simulated; make the body a link of the robot, "
            "or a body with \"dynamics\"");
  EXPECT_EQ(refusal(arm + R"("tracking_error": 0.01})"),
            "robot \"arm\": a simulation knows where the robot is; leave out \"tracking_error\"");
  folder_.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder_.write("sheet.urdf", R"(<robot name="s"><link name="a"><collision><geometry>
      <mesh filename="sheet.obj"/></geometry></collision></link></robot>)");
  const std::string said =
      refusal(R"({"name": "s", "urdf": "sheet.urdf", "dynamics": {"density": 1}})");
  EXPECT_EQ(said.substr(0, 12), "link \"s/a\": ") << said;
}

TEST_F(LinksOfRobots, AreNoneWithoutRobots) {
  const LoadedScene given = test::load_text(
      test::scene(test::body("a") + "," + test::body("b", R"("dynamics": {"mass": 1})")));
  const LinksAsBodies links = links_as_bodies(given);
  EXPECT_TRUE(links.geometries.empty());
  EXPECT_TRUE(links.models.empty());
  EXPECT_EQ(links.loaded.bodies.size(), 2u);
  EXPECT_EQ(names_with_links(given.scene), (std::vector<std::string>{"a", "b"}));
}

}  // namespace
}  // namespace firstcontact
