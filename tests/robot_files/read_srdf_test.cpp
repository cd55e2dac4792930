// SRDF gives pairs, groups, states and tools; names that the robot lacks are warnings.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/text/parse_error.h>

#include "support/data_dir.h"

namespace firstcontact {
namespace {

/// base -ja- a -jb- b, base -jc- c.
RobotModel forked_robot() {
  const auto turning = [](const char* name, const char* parent, const char* child) {
    return Joint{.name = name, .type = JointType::continuous, .parent = parent, .child = child};
  };
  return RobotModel({.name = "fork",
                     .links = {{"base", {}, {}}, {"a", {}, {}}, {"b", {}, {}}, {"c", {}, {}}},
                     .joints = {turning("ja", "base", "a"), turning("jb", "a", "b"),
                                turning("jc", "base", "c")}});
}

RobotSemantics parse(const std::string& inside) {
  return parse_srdf("<robot name='fork'>\n" + inside + "\n</robot>", "f.srdf", forked_robot());
}

std::string srdf_error(const std::string& inside) {
  try {
    (void)parse(inside);
  } catch (const ParseError& error) {
    return error.what();
  }
  return "no error";
}

using Indices = std::vector<std::size_t>;

TEST(ReadSrdf, DisablesPairsOnceAndSymmetrically) {
  const RobotSemantics semantics = parse(
      "<disable_collisions link1='c' link2='a' reason='Never'/>"
      "<disable_collisions link1='a' link2='c' reason='Again'/>"
      "<disable_collisions link1='base' link2='a'/>");
  ASSERT_EQ(semantics.disabled.size(), 2u);
  EXPECT_EQ(semantics.disabled[1].reason, "Never");
  EXPECT_TRUE(semantics.is_disabled(1, 3));
  EXPECT_TRUE(semantics.is_disabled(3, 1));
  EXPECT_TRUE(semantics.is_disabled(0, 1));
  EXPECT_FALSE(semantics.is_disabled(2, 3));
  EXPECT_FALSE(semantics.is_disabled(0, 3));
  EXPECT_TRUE(semantics.warnings.empty());
}

TEST(ReadSrdf, DisablesALinkByDefault) {
  const RobotSemantics semantics =
      parse("<disable_default_collisions link='c'/><enable_collisions link1='b' link2='c'/>");
  EXPECT_TRUE(semantics.is_disabled(3, 0));
  EXPECT_TRUE(semantics.is_disabled(3, 1));
  EXPECT_FALSE(semantics.is_disabled(3, 2));
  EXPECT_FALSE(semantics.is_disabled(0, 1));
}

TEST(ReadSrdf, CollectsGroups) {
  const RobotSemantics semantics = parse(
      "<group name='all'><group name='arm'/><joint name='jc'/></group>"
      "<group name='arm'><chain base_link='a' tip_link='b'/></group>"
      "<group name='tip'><link name='b'/></group>");
  ASSERT_EQ(semantics.groups.size(), 3u);
  EXPECT_EQ(semantics.groups[1].links, (Indices{1, 2}));
  EXPECT_EQ(semantics.groups[1].joints, (Indices{1}));  // Not the one that moves "a".
  EXPECT_EQ(semantics.groups[0].links, (Indices{1, 2, 3}));
  EXPECT_EQ(semantics.groups[0].joints, (Indices{1, 2}));
  EXPECT_EQ(semantics.groups[2].links, (Indices{2}));
  EXPECT_EQ(semantics.groups[2].joints, (Indices{1}));
}

// From the end of one arm to that of another, up and down, as in MoveIt.
TEST(ReadSrdf, TakesChainsAcrossThePlaceWhereTheyFork) {
  const RobotSemantics semantics = parse(
      "<group name='both'><chain base_link='b' tip_link='c'/></group>"
      "<group name='up'><chain base_link='b' tip_link='a'/></group>");
  ASSERT_EQ(semantics.groups.size(), 2u);
  EXPECT_EQ(semantics.groups[0].links, (Indices{0, 1, 2, 3}));
  EXPECT_EQ(semantics.groups[0].joints, (Indices{0, 1, 2}));
  EXPECT_EQ(semantics.groups[1].links, (Indices{1, 2}));
}

TEST(ReadSrdf, NamesFileElementAndMend) {
  EXPECT_EQ(srdf_error("<group name='g'><group name='g'/></group>"),
            "f.srdf:2: <group name='g'>: the group contains itself");
  EXPECT_EQ(srdf_error("<group name='g'/><group name='g'/>"),
            "f.srdf:2: <group name='g'>: a second group of this name; rename one of them");
  EXPECT_EQ(srdf_error("<group_state name='s' group='g'><joint name='ja' value='1'/>"
                       "<joint name='ja' value='1'/>\n<joint name='ja' value='2'/></group_state>"),
            "f.srdf:3: <joint name='ja'>: the state has another position of this joint; remove one "
            "of the two");
  EXPECT_EQ(srdf_error("<group_state name='s' group='g'/><group_state name='s' group='h'/>\n"
                       "<group_state name='s' group='g'/>"),
            "f.srdf:3: <group_state name='s'>: a second state of this name in group 'g'; rename "
            "one of them");
  EXPECT_EQ(srdf_error("<disable_collisions link1='a' link2='a'/>"),
            "f.srdf:2: <disable_collisions>: expected two different links, got 'a' twice");
  EXPECT_EQ(srdf_error("<group name='g'/><group_state name='s' group='g'>\n"
                       "<joint name='ja' value='1 2'/></group_state>"),
            "f.srdf:3: <joint name='ja'>: expected as many numbers in 'value' as the joint has "
            "coordinates, 1, got 2");
  EXPECT_EQ(srdf_error("<disable_collisions link1='a'/>"),
            "f.srdf:2: <disable_collisions>: expected an attribute 'link2' that is not empty");
}

TEST(ReadSrdf, HasPosesOfFloatingJoints) {
  RobotDescription description{.name = "drone", .links = {{"world"}, {"hull"}}};
  description.joints.push_back(
      {.name = "base", .type = JointType::floating, .parent = "world", .child = "hull"});
  const RobotModel drone(description);
  const auto state = [&](const std::string& value) {
    return parse_srdf(
        "<robot name='drone'><group name='g'><joint name='base'/></group>"
        "<group_state name='s' group='g'><joint name='base' value='" +
            value + "'/></group_state></robot>",
        "f.srdf", drone);
  };
  EXPECT_EQ(state("1 2 3 0.6 0 0 0.8").states.at(0).values.at(0).coordinates,
            (std::vector<double>{1, 2, 3, 0.6, 0, 0, 0.8}));
  for (const std::string wrong : {"1 2 3", "1 2 3 0 0 0 0", "1 2 3 0.6 0 0 0.9"}) {
    EXPECT_THROW((void)state(wrong), ParseError) << wrong;
  }
}

TEST(ReadSrdf, WarnsOfNamesThatTheRobotLacks) {
  const RobotSemantics semantics = parse(
      "<disable_collisions link1='a' link2='hand'/>"
      "<group name='g'><joint name='jx'/><link name='a'/></group>"
      "<end_effector name='e' group='none' parent_link='a'/>");
  EXPECT_EQ(
      semantics.warnings,
      (std::vector<std::string>{"f.srdf:2: <disable_collisions>: 'hand' is not a link of the robot",
                                "f.srdf:2: <joint name='jx'>: 'jx' is not a joint of the robot",
                                "f.srdf:2: <end_effector name='e'>: there is no group 'none'"}));
  EXPECT_TRUE(semantics.disabled.empty());
  EXPECT_EQ(semantics.groups[0].links, (Indices{1}));
}

/// Files shared by variants of a robot name parts that one of them lacks in a hundred lines.
TEST(ReadSrdf, TellsOneCauseOnce) {
  std::string inside;
  for (const char* link : {"x", "y", "x", "z"}) {
    inside += "<disable_collisions link1='a' link2='" + std::string(link) + "'/>\n";
  }
  const RobotSemantics semantics =
      parse(inside + "<group name='g'><joint name='jx'/><joint name='jy'/></group>");
  EXPECT_EQ(semantics.warnings,
            (std::vector<std::string>{
                "f.srdf:2: 4 elements name links that the robot does not have, and are left out "
                "there: x, y, z",
                "f.srdf:6: 2 elements name joints that the robot does not have, and are left out "
                "there: jx, jy"}));
  EXPECT_EQ(semantics.report.warnings, semantics.warnings);
  EXPECT_EQ(semantics.report.format, "SRDF");
}

/// Problem sets give positions to grippers that other URDFs of the robot have fixed.
TEST(ReadSrdf, LeavesOutPositionsOfFixedJoints) {
  const RobotModel robot(
      {.name = "arm",
       .links = {{"base", {}, {}}, {"a", {}, {}}, {"f", {}, {}}, {"g", {}, {}}},
       .joints = {{.name = "ja", .type = JointType::continuous, .parent = "base", .child = "a"},
                  {.name = "jf", .parent = "a", .child = "f"},
                  {.name = "jg", .parent = "a", .child = "g"}}});
  const std::string state =
      "<group name='g'><joint name='jf'/></group>"
      "<group_state name='open' group='g'><joint name='ja' value='2'/>"
      "<joint name='jf' value='0.5'/>";
  const RobotSemantics one =
      parse_srdf("<robot name='arm'>" + state + "</group_state></robot>", "f.srdf", robot);
  ASSERT_EQ(one.states.at(0).values.size(), 1u);
  EXPECT_EQ(one.states[0].values[0].joint, 0u);
  EXPECT_EQ(one.warnings, (std::vector<std::string>{
                              "f.srdf:1: <joint name='jf'>: the joint is fixed: its position in a "
                              "state is left out"}));
  const RobotSemantics two = parse_srdf(
      "<robot name='arm'>" + state + "<joint name='jg' value='1'/></group_state></robot>", "f.srdf",
      robot);
  EXPECT_EQ(two.warnings.at(0),
            "f.srdf:1: 2 elements name joints of a state that are fixed, and are left out there: "
            "jf, jg");
}

TEST(ReadSrdf, LeavesOutWhatOtherToolsSayAndRefusesMisspeltNames) {
  const RobotSemantics semantics = parse(
      "<virtual_joint name='v' type='fixed' parent_frame='w' child_link='base'/>"
      "<passive_joint name='jc'/><drake:x/><colour name='a'/><colour name='b'/>"
      "<disable_collisions link1='a' link2='c' reason='Never' kept='yes'/>");
  EXPECT_EQ(semantics.disabled.size(), 1u);
  EXPECT_EQ(semantics.report.left_out.at(0).name, "<virtual_joint>");
  EXPECT_EQ(semantics.report.left_out.at(2).name, "<drake:x>");
  EXPECT_EQ(semantics.warnings,
            (std::vector<std::string>{
                "f.srdf:2: <colour name='a'>: not known inside <robot> and left out (and 1 more "
                "like it)",
                "f.srdf:2: <disable_collisions>: unknown attribute 'kept' is left out"}));
  EXPECT_EQ(srdf_error("<enable_colisions link1='a' link2='b'/>\n<group nme='g'/>"),
            "f.srdf:2: <enable_colisions>: not known inside <robot name='fork'>; did you mean "
            "<enable_collisions>?; line 3: <group>: unknown attribute 'nme'; did you mean "
            "'name'?; line 3: <group>: expected an attribute 'name' that is not empty");
  EXPECT_NE(srdf_error("<xacro:pairs/>").find("run xacro first"), std::string::npos);
}

TEST(ReadSrdf, BoundsHowDeepGroupsContainGroups) {
  std::string inside;
  for (int k = 0; k < 20'000; ++k) {
    inside += "<group name='g" + std::to_string(k) + "'><group name='g" + std::to_string(k + 1) +
              "'/></group>";
  }
  EXPECT_NE(srdf_error(inside).find("at most 100 deep"), std::string::npos);
}

TEST(ReadSrdfData, ReadsThePanda) {
  const std::filesystem::path data = test::data_dir();
  if (data.empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const std::filesystem::path folder = data / "robots/moveit_resources_panda_description";
  const RobotModel panda =
      read_urdf(folder / "urdf/panda.urdf", {.package_roots = {}, .shapes = LoadShapes::none});
  const RobotSemantics semantics = read_srdf(folder / "srdf/panda.srdf", panda);
  EXPECT_TRUE(semantics.warnings.empty());
  EXPECT_EQ(semantics.disabled.size(), 34u);
  ASSERT_EQ(semantics.groups.size(), 3u);
  EXPECT_EQ(semantics.groups[0].name, "panda_arm");
  EXPECT_EQ(semantics.groups[0].links.size(), 9u);
  EXPECT_EQ(semantics.groups[2].links.size(), 12u);
  ASSERT_EQ(semantics.states.size(), 5u);
  EXPECT_EQ(semantics.states[0].values[1].coordinates, (std::vector<double>{-0.785}));
  ASSERT_EQ(semantics.end_effectors.size(), 1u);
  EXPECT_EQ(panda.links()[semantics.end_effectors[0].parent_link].name, "panda_link8");
}

TEST(ReadSrdfData, ReadsTheOthers) {
  const std::filesystem::path data = test::data_dir();
  if (data.empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const UrdfOptions none{.package_roots = {data / "robots"}, .shapes = LoadShapes::none};
  const std::filesystem::path fanuc = data / "robots/moveit_resources_fanuc_description";
  EXPECT_EQ(read_srdf(fanuc / "srdf/fanuc.srdf", read_urdf(fanuc / "urdf/fanuc.urdf", none))
                .disabled.size(),
            10u);
  const std::filesystem::path humanoid =
      data / "robots/example-robot-data/robots/simple_humanoid_description";
  const RobotSemantics semantics =
      read_srdf(humanoid / "srdf/simple_humanoid.srdf",
                read_urdf(humanoid / "urdf/simple_humanoid.urdf", none));
  // The file is of a variant: of other feet, and of a state whose group is commented out.
  EXPECT_EQ(semantics.warnings.size(), 3u);
}

}  // namespace
}  // namespace firstcontact
