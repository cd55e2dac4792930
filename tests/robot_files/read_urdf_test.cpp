// URDF gives the robot that it describes, or an error that names file, element and mend.

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <filesystem>
#include <string>
#include <variant>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/text/parse_error.h>

#include "support/data_dir.h"

namespace firstcontact {
namespace {

constexpr UrdfOptions kNoShapes{.package_roots = {}, .shapes = LoadShapes::none};

/// Two links and what stands between them.
std::string robot_text(const std::string& joint, const std::string& arm = "<link name='arm'/>") {
  return "<?xml version='1.0'?>\n<robot name='r'>\n<link name='base'/>\n" + arm + "\n" + joint +
         "\n</robot>\n";
}

std::string joint_text(const std::string& inside, const std::string& type = "revolute") {
  return "<joint name='j' type='" + type + "'><parent link='base'/><child link='arm'/>" + inside +
         "</joint>";
}

std::string urdf_error(const std::string& text) {
  try {
    (void)parse_urdf(text, "r.urdf", kNoShapes);
  } catch (const ParseError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ReadUrdf, ReadsAJoint) {
  const RobotModel robot = parse_urdf(
      robot_text(joint_text("<origin xyz='1 -2.5 +3e-1' rpy='0 0 1.5707963267948966'/>"
                            "<axis xyz='0 0 1'/><limit lower='-0.1' upper='2' velocity='3' "
                            "effort='4'/><dynamics damping='1'/>")),
      "r.urdf", kNoShapes);
  const Joint& joint = robot.joints()[0];
  EXPECT_EQ(joint.type, JointType::revolute);
  EXPECT_EQ(joint.X_PJ.position, Eigen::Vector3d(1.0, -2.5, 0.3));
  EXPECT_LE((joint.X_PJ.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(),
            1e-15);
  EXPECT_EQ(joint.axis, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(joint.limits.lower, -0.1);
  EXPECT_EQ(joint.limits.upper, 2.0);
  EXPECT_EQ(joint.limits.velocity, 3.0);
  EXPECT_EQ(joint.limits.effort, 4.0);
}

TEST(ReadUrdf, TurnsAboutFixedXThenYThenZ) {
  const RobotModel robot = parse_urdf(
      robot_text(joint_text("<origin rpy='0.3 -0.4 0.5'/>", "fixed")), "r.urdf", kNoShapes);
  // Row by row, from the definition Rz Ry Rx.
  const double cx = std::cos(0.3), sx = std::sin(0.3), cy = std::cos(-0.4), sy = std::sin(-0.4),
               cz = std::cos(0.5), sz = std::sin(0.5);
  Eigen::Matrix3d expected;
  expected << cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx,  //
      sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx,          //
      -sy, cy * sx, cy * cx;
  EXPECT_LE((robot.joints()[0].X_PJ.rotation.toRotationMatrix() - expected).norm(), 1e-15);
}

TEST(ReadUrdf, KnowsEveryTypeOfJoint) {
  const auto type = [](const std::string& word, const std::string& inside) {
    return parse_urdf(robot_text(joint_text(inside, word)), "r.urdf", kNoShapes).joints()[0].type;
  };
  const std::string limit = "<limit effort='1' velocity='1'/>";
  EXPECT_EQ(type("fixed", ""), JointType::fixed);
  EXPECT_EQ(type("revolute", limit), JointType::revolute);
  EXPECT_EQ(type("continuous", limit), JointType::continuous);
  EXPECT_EQ(type("prismatic", limit), JointType::prismatic);
  EXPECT_EQ(type("planar", ""), JointType::planar);
  EXPECT_EQ(type("floating", "<axis xyz='0 0 0'/>"), JointType::floating);
  EXPECT_EQ(type("spherical", ""), JointType::ball);
  EXPECT_EQ(parse_urdf(robot_text("<joint name='j' type='screw' pitch='0.01'><parent link='base'/>"
                                  "<child link='arm'/></joint>"),
                       "r.urdf", kNoShapes)
                .joints()[0]
                .pitch,
            0.01);
}

TEST(ReadUrdf, MimicHasDefaults) {
  const RobotModel robot = parse_urdf(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
      "<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>"
      "<joint name='k' type='continuous'><parent link='b'/><child link='c'/>"
      "<mimic joint='j' offset='0.5'/></joint></robot>",
      "r.urdf", kNoShapes);
  ASSERT_TRUE(robot.joints()[1].mimic.has_value());
  EXPECT_EQ(robot.joints()[1].mimic->joint, "j");
  EXPECT_EQ(robot.joints()[1].mimic->multiplier, 1.0);
  EXPECT_EQ(robot.joints()[1].mimic->offset, 0.5);
}

TEST(ReadUrdf, MakesPrimitives) {
  const RobotModel robot = parse_urdf(
      "<robot name='r'><link name='a'>"
      "<collision name='c'><origin xyz='0 0 1'/><geometry><box size='1 2 "
      "3'/></geometry></collision>"
      "<collision><geometry><sphere radius='0.5'/></geometry></collision>"
      "<collision><geometry><cylinder radius='0.5' length='2'/></geometry></collision>"
      "<collision><geometry><capsule radius='0.5' length='2'/></geometry></collision>"
      "<visual><geometry><sphere radius='7'/></geometry></visual></link></robot>",
      "r.urdf");
  const Link& link = robot.links()[0];
  ASSERT_EQ(link.collision.size(), 4u);
  EXPECT_EQ(link.collision[0].name, "c");
  EXPECT_EQ(link.collision[0].X_LG.position, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(std::get<BoxGeometry>(link.collision[0].source).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(link.collision[1].shape.value().radius(), 0.5);
  EXPECT_TRUE(link.collision[2].shape.value().is_solid());
  EXPECT_EQ(link.collision[3].shape.value().radius(), 0.5);
  EXPECT_FALSE(link.visual.at(0).shape.has_value());  // Was not asked for.
}

TEST(ReadUrdf, NamesFileElementAndMend) {
  EXPECT_EQ(urdf_error("<robot name='r'>\n<link name='a'>\n</robot>"),
            "r.urdf:2: expected XML, got XML_ERROR_MISMATCHED_ELEMENT");
  EXPECT_EQ(urdf_error("<sdf/>"),
            "r.urdf:1: <sdf>: expected <robot> as the outermost element, got SDF, which is not "
            "read; convert it to URDF");
  EXPECT_EQ(urdf_error("<robot/>"),
            "r.urdf:1: <robot>: expected an attribute 'name' that is not empty; line 1: <robot>: "
            "the robot has no link");
  EXPECT_EQ(urdf_error(robot_text(joint_text("", "hinge"))),
            "r.urdf:5: <joint name='j'>: unknown joint type 'hinge'; known are: fixed, revolute, "
            "continuous, prismatic, planar, floating, screw, ball, spherical");
  EXPECT_EQ(urdf_error(robot_text(joint_text("<axis xyz='0 0'/>", "continuous"))),
            "r.urdf:5: <axis>: expected three numbers in 'xyz', got 2");
  EXPECT_EQ(
      urdf_error(robot_text(joint_text("<axis xyz='0 0 nan'/>", "continuous"))),
      "r.urdf:5: <axis>: expected finite numbers of at most 1e60 in size in 'xyz', got 'nan'");
  EXPECT_EQ(
      urdf_error(robot_text(joint_text("<axis xyz='0 0 1,5'/>", "continuous"))),
      "r.urdf:5: <axis>: expected finite numbers of at most 1e60 in size in 'xyz', got '1,5'");
  EXPECT_EQ(urdf_error(robot_text(joint_text("<axis xyz='0 0 0'/>", "continuous"))),
            "r.urdf:5: <joint name='j'>: joint 'j': its axis must be finite and not zero");
  EXPECT_EQ(
      urdf_error(robot_text(joint_text(""))),
      "r.urdf:5: <joint name='j'>: expected an element <limit> inside: the joint is revolute");
  EXPECT_EQ(urdf_error(robot_text("<joint name='j' type='fixed'><parent link='base'/></joint>")),
            "r.urdf:5: <joint name='j'>: expected an element <child> inside");
  EXPECT_EQ(urdf_error(robot_text("")),
            "r.urdf:4: <link name='arm'>: links 'base' and 'arm' both have no parent; connect them "
            "by a joint");
  EXPECT_EQ(urdf_error("<robot name='r'><link name='a'/></robot><robot name='s'/>"),
            "r.urdf:1: expected one outermost element, <robot>, and nothing else");
}

/// A misspelt name must not mean "cannot collide".
TEST(ReadUrdf, RefusesWhatItDoesNotKnowInsideOfALink) {
  EXPECT_EQ(urdf_error(robot_text(joint_text("", "fixed"), "<link name='arm'><colision/></link>")),
            "r.urdf:4: <colision>: not known inside <link name='arm'>; did you mean <collision>?");
  EXPECT_EQ(
      urdf_error(robot_text(joint_text("", "fixed"),
                            "<link name='arm'><collision><geometry><ball radius='1'/>"
                            "</geometry></collision></link>")),
      "r.urdf:4: <ball>: not known inside <geometry>; known are: mesh, box, sphere, cylinder, "
      "capsule, drake:capsule");
  EXPECT_EQ(urdf_error(robot_text(joint_text("<origin xzy='1 0 0'/>", "fixed"))),
            "r.urdf:5: <origin>: unknown attribute 'xzy'; did you mean 'xyz'?");
  EXPECT_EQ(urdf_error(robot_text(joint_text("<origin xyz='1 0 0' xyz='2 0 0'/>", "fixed"))),
            "r.urdf:5: expected XML, got XML_ERROR_PARSING_ATTRIBUTE");
}

TEST(ReadUrdf, SaysWhichMeshIsMissing) {
  const auto with_mesh = [](const std::string& attributes) {
    return "<robot name='r'><link name='a'><collision><geometry><mesh " + attributes +
           "/></geometry></collision></link></robot>";
  };
  const auto error = [&](const std::string& attributes) -> std::string {
    try {
      (void)parse_urdf(with_mesh(attributes), "dir/r.urdf",
                       {.package_roots = {"no/such/root"}, .shapes = LoadShapes::collision});
    } catch (const ParseError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_EQ(error("filename='a.stl'"), "dir/r.urdf:1: <mesh>: mesh file dir/a.stl does not exist");
  EXPECT_EQ(error("filename='package://no_such_package/a.stl'"),
            "dir/r.urdf:1: <mesh>: no package root holds a folder 'no_such_package' (roots: "
            "no/such/root); name the folder that holds it: --package-root, or "
            "\"package_roots\" in a scene");
  EXPECT_EQ(error("filename='http://a.stl'"),
            "dir/r.urdf:1: <mesh>: expected package://, file:// or a path, got 'http://a.stl'");
  EXPECT_EQ(error("filename='a.stl' scale='1 0 1'"),
            "dir/r.urdf:1: <mesh>: expected no 0 in 'scale': it flattens the mesh");
}

/// Decimal commas would turn 0.6718 into 0.
TEST(ReadUrdf, DoesNotMindTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "C.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) {
      break;
    }
  }
  const RobotModel robot = parse_urdf(robot_text(joint_text("<origin xyz='0.6718 0 0'/>", "fixed")),
                                      "r.urdf", kNoShapes);
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_EQ(robot.joints()[0].X_PJ.position.x(), 0.6718);
}

TEST(ReadUrdf, ReadsThePumaWithItsMeshes) {
  const RobotModel puma = read_urdf(std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) /
                                    "data/robots/puma560_description/urdf/puma560_robot.urdf");
  EXPECT_EQ(puma.links().size(), 7u);
  EXPECT_EQ(puma.joints().size(), 6u);
  std::size_t triangles = 0;
  for (const Link& link : puma.links()) {
    for (const LinkGeometry& geometry : link.collision) {
      triangles += geometry.shape.value().mesh().triangles.size();
    }
  }
  EXPECT_EQ(triangles, 8116u);
  // In inches in the file: a link of some 0.7 m.
  EXPECT_LE(puma.links()[0].collision[0].shape->hierarchy().radius, 1.0);
  EXPECT_GE(puma.links()[0].collision[0].shape->hierarchy().radius, 0.2);
}

struct KnownRobot {
  const char* path;
  std::size_t links;
  std::size_t moving;
  std::size_t triangles;  ///< Number of triangles of collision meshes.
};

class ReadUrdfData : public testing::TestWithParam<KnownRobot> {};

/// Against the counts of the data set's own table, made by other tools.
TEST_P(ReadUrdfData, GivesTheKnownCounts) {
  const std::filesystem::path data = test::data_dir();
  if (data.empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const RobotModel robot =
      read_urdf(data / "robots" / GetParam().path,
                {.package_roots = {data / "robots"}, .shapes = LoadShapes::collision});
  EXPECT_EQ(robot.links().size(), GetParam().links);
  std::size_t moving = 0;
  for (const Joint& joint : robot.joints()) {
    moving += joint.type != JointType::fixed ? 1 : 0;
  }
  EXPECT_EQ(moving, GetParam().moving);
  std::size_t triangles = 0;
  for (const Link& link : robot.links()) {
    for (const LinkGeometry& geometry : link.collision) {
      const bool is_mesh = std::holds_alternative<MeshGeometry>(geometry.source);
      triangles += is_mesh ? geometry.shape.value().mesh().triangles.size() : 0;
    }
  }
  EXPECT_EQ(triangles, GetParam().triangles);
}

INSTANTIATE_TEST_SUITE_P(
    AllRobots, ReadUrdfData,
    testing::Values(
        KnownRobot{"puma560_description/urdf/puma560_robot.urdf", 7, 6, 0},
        KnownRobot{"puma560_description/urdf/puma560_robot_with_collision.urdf", 7, 6, 8116},
        KnownRobot{"moveit_resources_panda_description/urdf/panda.urdf", 12, 9, 2364},
        KnownRobot{"moveit_resources_fanuc_description/urdf/fanuc.urdf", 9, 6, 6934},
        KnownRobot{"kuka_iiwa/model.urdf", 8, 7, 14758},  //
        KnownRobot{"nao/nao.urdf", 79, 42, 18238},
        KnownRobot{
            "example-robot-data/robots/allegro_hand_description/urdf/allegro_right_hand.urdf", 21,
            16, 0},
        KnownRobot{"example-robot-data/robots/allegro_hand_description/urdf/allegro_left_hand.urdf",
                   21, 16, 0},
        KnownRobot{
            "example-robot-data/robots/double_pendulum_description/urdf/double_pendulum.urdf", 3, 2,
            13254},
        KnownRobot{"example-robot-data/robots/double_pendulum_description/urdf/"
                   "double_pendulum_continuous.urdf",
                   3, 2, 13254},
        KnownRobot{"example-robot-data/robots/double_pendulum_description/urdf/"
                   "double_pendulum_simple.urdf",
                   4, 2, 0},
        KnownRobot{
            "example-robot-data/robots/simple_humanoid_description/urdf/simple_humanoid.urdf", 31,
            29, 12},
        KnownRobot{"example-robot-data/robots/simple_humanoid_description/urdf/"
                   "simple_humanoid_classical.urdf",
                   31, 29, 0}));

TEST(ReadUrdfData, ReadsTheCupboardAndTheFigure) {
  const std::filesystem::path data = test::data_dir();
  if (data.empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const RobotModel figure = read_urdf(data / "mocap/deepmimic/humanoid/humanoid.urdf", kNoShapes);
  EXPECT_EQ(figure.joints()[*figure.find_joint("chest")].type, JointType::ball);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data / "planning_mbm")) {
    if (entry.path().extension() == ".urdf") {
      const RobotModel robot = read_urdf(entry.path(), {.package_roots = {data / "planning_mbm"},
                                                        .shapes = LoadShapes::collision});
      EXPECT_GE(robot.links().size(), 1u) << entry.path();
    }
  }
}

}  // namespace
}  // namespace firstcontact
