// URDF as it is in the world: what changes nothing opens, what could is refused by name.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

/// Places in a robot of three links where a sibling holds something more.
using Insertions = std::map<std::string, std::string>;

std::string odd_robot(const Insertions& insertions) {
  std::string text =
      "<?xml version='1.0'?>\n"
      "<robot name='odd' @robot_attribute xmlns:drake='http://drake.mit.edu'>\n"
      "@robot\n"
      "<link name='base' @link_attribute>@link\n"
      "<inertial @inertial_attribute>@inertial<mass value='1'/>"
      "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>\n"
      "<visual @visual_attribute>@visual<geometry><box size='1 1 1'/></geometry></visual>\n"
      "<collision @collision_attribute>@collision<origin xyz='1 0 0' @origin_attribute/>\n"
      "<geometry @geometry_attribute>@geometry<box size='0.2 0.2 0.2' @box_attribute/></geometry>"
      "</collision></link>\n"
      "<link name='arm'/><link name='hand'/>\n"
      "<joint name='turn' type='revolute' @joint_attribute>@joint<parent link='base'/>"
      "<child link='arm'/><origin xyz='0 0 0.2'/><axis xyz='0 0 1' @axis_attribute/>"
      "<limit lower='-3' upper='3' effort='1' velocity='1' @limit_attribute/></joint>\n"
      "<joint name='weld' type='fixed'><parent link='arm'/><child link='hand'/>@fixed</joint>\n"
      "</robot>\n";
  for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', at)) {
    std::size_t end = at + 1;
    while (std::isalpha(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_') {
      ++end;
    }
    const auto found = insertions.find(text.substr(at + 1, end - at - 1));
    const std::string put = found == insertions.end() ? "" : found->second;
    text.replace(at, end - at, put);
    at += put.size();
  }
  return text;
}

RobotReading read_odd(const Insertions& insertions, const UrdfOptions& options = {}) {
  return parse_robot(odd_robot(insertions), "odd.urdf", options);
}

std::string error_of(const std::string& text, const UrdfOptions& options = {}) {
  try {
    (void)parse_robot(text, "odd.urdf", options);
  } catch (const ParseError& error) {
    return error.what();
  }
  return "no error";
}

std::string odd_error(const Insertions& insertions) { return error_of(odd_robot(insertions)); }

/// That the robot is the one without oddities.
void expect_plain(const RobotReading& reading, const std::string& what) {
  ASSERT_EQ(reading.model.links().size(), 3u) << what;
  ASSERT_EQ(reading.model.joints().size(), 2u) << what;
  const Link& base = reading.model.links()[0];
  ASSERT_EQ(base.collision.size(), 1u) << what;
  EXPECT_EQ(base.collision[0].X_LG.position, Eigen::Vector3d(1, 0, 0)) << what;
  EXPECT_EQ(std::get<BoxGeometry>(base.collision[0].source).size, Eigen::Vector3d(0.2, 0.2, 0.2));
  const Joint& turn = reading.model.joints()[0];
  EXPECT_EQ(turn.axis, Eigen::Vector3d::UnitZ()) << what;
  EXPECT_EQ(turn.X_PJ.position, Eigen::Vector3d(0, 0, 0.2)) << what;
  EXPECT_EQ(turn.limits.upper, 3.0) << what;
  EXPECT_FALSE(turn.mimic) << what;
}

bool holds_text(const std::vector<std::string>& lines, const std::string& text) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

struct Oddity {
  const char* place;
  const char* text;
  const char* told;  ///< The name in what was left out, or a part of the warning or error.
};

/// ABB, ANYmal and Baxter robots look in <collision>; IsaacGym's parts have grids; Minitaur and
/// Unitree robots, Drake's models and newer writers have names of their own.
TEST(UrdfOddities, LeavesOutByNameWhatSaysNothingOfContacts) {
  const std::vector<Oddity> oddities{
      {"robot", "<material name='m'><color rgba='1 1 1 1'/></material>", "<material>"},
      {"robot", "<gazebo reference='arm'><selfCollide>true</selfCollide></gazebo>", "<gazebo>"},
      {"robot", "<gazebo><plugin><joint>turn</joint></plugin></gazebo>", "<gazebo>"},
      {"robot", "<transmission name='t'><joint name='turn'/></transmission>", "<transmission>"},
      {"robot", "<ros2_control><joint name='turn'><param/></joint></ros2_control>",
       "<ros2_control>"},
      {"robot", "<sensor name='s'><parent link='arm'/><origin xyz='1 0 0'/></sensor>", "<sensor>"},
      {"robot", "<frame name='f' link='arm' xyz='1 0 0'/>", "<frame>"},
      {"robot", "<mujoco><compiler discardvisual='false'/></mujoco>", "<mujoco>"},
      {"robot",
       "<drake:collision_filter_group name='g'><drake:member link='arm'/>"
       "</drake:collision_filter_group>",
       "<drake:collision_filter_group>"},
      {"robot_attribute", "version='1.2'", "'version' of <robot>"},
      {"link", "<self_filter scale='1' padding='0'/>", "<self_filter>"},
      {"link", "<contact><lateral_friction value='1'/></contact>", "<contact>"},
      {"link", "<verbose value='1'/>", "<verbose>"},
      {"link_attribute", "drake:x='1'", "'drake:x' of <link>"},
      {"collision", "<material name='m'/>", "<material>"},
      {"collision", "<sdf resolution='256'/>", "<sdf>"},
      {"collision",
       "<drake:proximity_properties><drake:compliant_hydroelastic/>"
       "</drake:proximity_properties>",
       "<drake:proximity_properties>"},
      {"collision_attribute", "concave='yes'", "'concave' of <collision>"},
      {"visual", "<material name='m'><texture filename='t.png'/></material>", "<material>"},
      {"geometry", "<drake:declare_convex/>", "<drake:declare_convex>"},
      {"origin_attribute", "name='here'", "'name' of <origin>"},
      {"joint", "<joint_properties damping='0' friction='0'/>", "<joint_properties>"},
      {"joint", "<safety_controller k_velocity='1'/>", "<safety_controller>"},
      {"joint", "<calibration rising='0'/>", "<calibration>"},
      {"joint", "<drake:controller_gains p='1' d='1'/>", "<drake:controller_gains>"},
      {"limit_attribute", "acceleration='3' deceleration='3' jerk='9'",
       "'acceleration' of <limit>"},
      {"limit_attribute", "drake:acceleration='3'", "'drake:acceleration' of <limit>"},
      {"limit_attribute", "xacro:speed='3'", "'xacro:speed' of <limit>"},
      {"inertial", "<drake:rotor_inertia value='1'/>", "<drake:rotor_inertia>"}};
  for (const Oddity& oddity : oddities) {
    const RobotReading reading = read_odd({{oddity.place, oddity.text}});
    expect_plain(reading, oddity.text);
    const FileReport& report = reading.files.front();
    EXPECT_TRUE(std::any_of(report.left_out.begin(), report.left_out.end(),
                            [&](const LeftOut& entry) {
                              return entry.name.find(oddity.told) != std::string::npos &&
                                     !entry.reason.empty();
                            }))
        << oddity.text;
    EXPECT_TRUE(report.warnings.empty()) << oddity.text << ": " << report.warnings.front();
  }
}

TEST(UrdfOddities, WarnsOfWhatAnAuthorMayHaveMeant) {
  const std::vector<Oddity> oddities{
      {"robot", "<mass_budget value='3'/>", "<mass_budget>: not known inside <robot>"},
      {"robot", "left over", "the text 'left over' is left out"},
      {"link", "<origin xyz='0 0 0' rpy='0 0 0'/>", "<origin> right inside of a <link>"},
      {"link", "<paint/>", "<paint>: not known inside <link>"},
      {"joint_attribute", "dont_collapse='true'", "unknown attribute 'dont_collapse'"},
      {"axis_attribute", "rpy='0 0 0'", "'rpy' of an <axis>"},
      {"fixed", "<mimic joint='turn'/>", "a fixed joint mimics nothing"}};
  for (const Oddity& oddity : oddities) {
    const RobotReading reading = read_odd({{oddity.place, oddity.text}});
    expect_plain(reading, oddity.text);
    EXPECT_TRUE(holds_text(reading.files.front().warnings, oddity.told)) << oddity.text;
    EXPECT_EQ(reading.files.front().warnings.size(), 1u) << oddity.text;
  }
}

TEST(UrdfOddities, TakesNamesThatAreOnlyLabelsAndRepeats) {
  expect_plain(read_odd({{"geometry_attribute", "name='g'"}}), "name of <geometry>");
  expect_plain(read_odd({{"collision_attribute", "name='c'"}}), "name of <collision>");
  expect_plain(read_odd({{"joint", "<axis xyz='0 0 1'/>"}}), "the same <axis> twice");
  EXPECT_EQ(parse_robot("<robot name=''><link name='a'/></robot>", "odd.urdf").model.name(), "");
}

/// Refused by name, with file and line.
TEST(UrdfOddities, RefusesWhatCouldHoldOrMoveGeometry) {
  const std::string box = "<geometry><box size='1 1 1'/></geometry>";
  const std::vector<Oddity> oddities{
      {"robot", "<group name='g'><link name='x'/></group>", "<group name='g'>"},
      {"robot", "<Link name='x'/>", "<Link name='x'>"},
      {"robot", "<lnk name='x'/>", "did you mean <link>?"},
      {"robot", "<loop_joint name='l'><link1 link='a'/></loop_joint>", "<loop_joint name='l'>"},
      {"robot", "<drake:joint name='x' type='ball'><drake:parent link='arm'/></drake:joint>",
       "<drake:joint name='x'>"},
      {"robot", "<xacro:arm parent='base'/>", "run xacro first"},
      {"robot", "<macro name='arm'/>", "<macro name='arm'>"},
      {"robot", "<assembly><part><joint name='j'><parent link='a'/></joint></part></assembly>",
       "it holds <joint name='j'>"},
      {"robot", "<reduced_deformable><visual filename='c.vtk'/></reduced_deformable>",
       "it holds <visual>"},
      {"robot", "<gazebo><joint name='close' type='revolute'/></gazebo>", "only Gazebo knows"},
      {"robot", "<collision/>", "<collision>: not known inside <robot"},
      {"robot", "&arm;", "expected no entities"},
      {"robot_attribute", "nmae='r'", "did you mean 'name'?"},
      {"link", "<collison/>", "did you mean <collision>?"},
      {"link", "<colision/>", "did you mean <collision>?"},
      {"link", "<Collision/>", "<Collision>: not known"},
      {"link", "<drake:collision/>", "<drake:collision>: not known"},
      {"link", "<origin xyz='0 0 1'/>", "<origin> right inside of a <link>"},
      {"link", "<shape><box size='1 1 1'/></shape>", "it holds <box>"},
      {"collision", "<geometery/>", "did you mean <geometry>?"},
      {"collision", "<orign xyz='0 0 1'/>", "did you mean <origin>?"},
      {"collision", "<pose xyz='0 0 1'/>", "<pose>: not known"},
      {"collision", "<origin xyz='0 0 1'/>", "a second <origin>"},
      {"geometry", "<box size='1 1 1'/>", "a second geometry"},
      {"geometry", "<drake:ellipsoid a='1' b='1' c='1'/>", "<drake:ellipsoid>: not known"},
      {"geometry", "<plane normal='0 0 1'/>", "<plane>: not known"},
      {"geometry", "<anything/>", "<anything>: not known"},
      {"origin_attribute", "xzy='1 0 0'", "did you mean 'xyz'?"},
      {"origin_attribute", "quat_wxyz='1 0 0 0'", "unknown attribute 'quat_wxyz'"},
      {"box_attribute", "centre='1 0 0'", "unknown attribute 'centre'"},
      {"joint", "<orign xyz='0 0 1'/>", "did you mean <origin>?"},
      {"joint", "<mimc joint='turn'/>", "did you mean <mimic>?"},
      {"joint", "<drake:mimic joint='none'/>", "it mimics 'none'"},
      {"axis_attribute", "rpy='0 1 0'", "'rpy' of an <axis>"},
      {"limit_attribute", "uper='1'", "did you mean 'upper'?"}};
  for (const Oddity& oddity : oddities) {
    const std::string error = odd_error({{oddity.place, oddity.text}});
    EXPECT_NE(error.find(oddity.told), std::string::npos) << oddity.text << "\n" << error;
    EXPECT_EQ(error.rfind("odd.urdf:", 0), 0u) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST(UrdfOddities, LenientReadersWarnInPlaceOfRefusing) {
  const UrdfOptions lenient{.reading = {.lenient = true}};
  for (const Oddity& oddity : {Oddity{"robot", "<group name='g'/>", "<group name='g'>"},
                               Oddity{"link", "<collison/>", "did you mean"},
                               Oddity{"link", "<origin xyz='0 0 1'/>", "<origin> right inside"},
                               Oddity{"robot", "<xacro:arm/>", "run xacro first"}}) {
    const RobotReading reading = read_odd({{oddity.place, oddity.text}}, lenient);
    expect_plain(reading, oddity.text);
    EXPECT_TRUE(holds_text(reading.files.front().warnings, oddity.told)) << oddity.text;
  }
}

TEST(UrdfOddities, TellsAllErrorsAtOnce) {
  EXPECT_EQ(
      odd_error(
          {{"link", "<collison/>"}, {"axis_attribute", "rpy='0 1 0'"}, {"joint", "<orign/>"}}),
      "odd.urdf:4: <collison>: not known inside <link name='base'>; did you mean "
      "<collision>?; line 10: <orign>: not known inside <joint name='turn'>; did you mean "
      "<origin>?; line 10: <axis>: 'rpy' of an <axis> is not of URDF, and other readers pass "
      "over it; put it where it is meant, or remove it");
  std::string many = "<robot name='r'>";
  for (int k = 0; k < 30; ++k) {
    many += "<lnk/>";
  }
  EXPECT_NE(error_of(many + "<link name='a'/></robot>").find("and 10 more errors"),
            std::string::npos);
  EXPECT_NE(error_of("<robot name='r'><link name='a'/><link name='b'/><link name='b'/>"
                     "<joint name='j' type='fixed'><parent link='a'/><child link='c'/></joint>"
                     "</robot>")
                .find("two links are named 'b'; rename one of them; line 1: <joint name='j'>: "
                      "joint 'j': its child link 'c' is not a link of the robot"),
            std::string::npos);
}

/// Grippers that turn about dummies, feet of points: they can touch.
TEST(UrdfOddities, TakesSizesOfZero) {
  const auto shape = [](const std::string& geometry) {
    const RobotReading reading =
        parse_robot("<robot name='r'><link name='a'><collision><geometry>" + geometry +
                        "</geometry></collision></link></robot>",
                    "odd.urdf");
    EXPECT_TRUE(holds_text(reading.files.front().warnings, "a size of 0")) << geometry;
    return reading.model.links()[0].collision.at(0).shape.value();
  };
  const auto extent = [&](const std::string& geometry) {
    Eigen::AlignedBox3d box;
    const Shape thin = shape(geometry);
    EXPECT_EQ(thin.radius(), 0.0);
    EXPECT_FALSE(thin.is_solid());
    for (const Eigen::Vector3d& vertex : thin.mesh().vertices) {
      box.extend(vertex);
    }
    return Eigen::Vector3d(box.sizes());
  };
  EXPECT_EQ(extent("<sphere radius='0'/>"), Eigen::Vector3d::Zero());
  EXPECT_EQ(extent("<box size='0 0 0'/>"), Eigen::Vector3d::Zero());
  EXPECT_EQ(extent("<box size='2 0 3'/>"), Eigen::Vector3d(2, 0, 3));
  EXPECT_EQ(extent("<cylinder radius='0' length='2'/>"), Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(extent("<cylinder radius='0' length='0'/>"), Eigen::Vector3d::Zero());
  EXPECT_EQ(extent("<capsule radius='0' length='2'/>"), Eigen::Vector3d(0, 0, 2));
  const Eigen::Vector3d disc = extent("<cylinder radius='0.5' length='0'/>");
  EXPECT_EQ(disc.z(), 0.0);
  EXPECT_GE(disc.x(), 1.0);
  EXPECT_LE(disc.x(), 1.001);
}

TEST(UrdfOddities, RefusesWrongNumbers) {
  const auto error = [](const std::string& geometry) {
    return error_of("<robot name='r'><link name='a'><collision>" + geometry +
                    "</collision></link></robot>");
  };
  const auto with = [](const std::string& source) { return "<geometry>" + source + "</geometry>"; };
  EXPECT_NE(error(with("<sphere radius='-1'/>")).find("to be >= 0"), std::string::npos);
  EXPECT_NE(error(with("<box size='1 -1 1'/>")).find("three numbers >= 0"), std::string::npos);
  EXPECT_NE(error(with("<box size='1 1'/>")).find("three numbers"), std::string::npos);
  EXPECT_NE(error(with("<box size='1,1,1'/>")).find("got '1,1,1'"), std::string::npos);
  EXPECT_NE(error(with("<sphere radius='1m'/>")).find("got '1m'"), std::string::npos);
  EXPECT_NE(error(with("<sphere radius='${r}'/>")).find("run xacro first"), std::string::npos);
  EXPECT_NE(error(with("<mesh filename='a.stl' scale='0.001'/>")).find("<mesh>"),
            std::string::npos);
  EXPECT_NE(error("<origin xyz='0 0'/>" + with("<sphere radius='1'/>")).find("got 2"),
            std::string::npos);
}

TEST(UrdfOddities, ReadsQuaternionsCapsulesAndMimicsOfNewerWriters) {
  const RobotReading reading = parse_robot(
      "<robot name='r' xmlns:drake='x'><link name='a'><collision>"
      "<origin xyz='0 0 1' quat_xyzw='0 0 2 0'/>"
      "<geometry><drake:capsule radius='1' length='2'/></geometry></collision></link>"
      "<link name='b'/><link name='c'/>"
      "<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>"
      "<joint name='k' type='continuous'><parent link='b'/><child link='c'/>"
      "<drake:mimic joint='j' multiplier='2'/></joint></robot>",
      "odd.urdf");
  const LinkGeometry& geometry = reading.model.links()[0].collision.at(0);
  EXPECT_EQ(std::get<CapsuleGeometry>(geometry.source).length, 2.0);
  EXPECT_EQ(geometry.X_LG.rotation.coeffs(), Eigen::Vector4d(0, 0, 1, 0));
  ASSERT_TRUE(reading.model.joints()[1].mimic);
  EXPECT_EQ(reading.model.joints()[1].mimic->multiplier, 2.0);
  EXPECT_NE(odd_error({{"origin_attribute", "rpy='0 0 0' quat_xyzw='0 0 0 1'"}}).find("got both"),
            std::string::npos);
  EXPECT_NE(odd_error({{"origin_attribute", "quat_xyzw='0 0 0 0'"}}).find("not to be zero"),
            std::string::npos);
}

TEST(UrdfOddities, LimitsThatNoJointCanObeyAreNotLookedAt) {
  const RobotReading reading = parse_robot(
      "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='revolute'>"
      "<parent link='a'/><child link='b'/>"
      "<limit lower='1' upper='-1' velocity='-2' effort='-3'/></joint></robot>",
      "odd.urdf");
  const JointLimits& limits = reading.model.joints()[0].limits;
  EXPECT_FALSE(limits.lower || limits.upper || limits.velocity || limits.effort);
  EXPECT_TRUE(holds_text(reading.files.front().warnings, "lower limit is above"));
  EXPECT_TRUE(holds_text(reading.files.front().warnings, "'velocity' is negative"));
}

TEST(UrdfOddities, LimitsOfInfinityAreNone) {
  const auto limits = [](const std::string& attributes) {
    return parse_robot(
               "<robot name='r'><link name='a'/><link name='b'/>"
               "<joint name='j' type='revolute'><parent link='a'/><child link='b'/><limit " +
                   attributes + "/></joint></robot>",
               "odd.urdf")
        .model.joints()[0]
        .limits;
  };
  const JointLimits endless =
      limits("lower='-inf' upper='1.7976931348623157e+308' velocity='inf' effort='1e400'");
  EXPECT_FALSE(endless.lower || endless.upper || endless.velocity || endless.effort);
  EXPECT_EQ(limits("effort='1' velocity='2'").lower, 0.0);
  EXPECT_EQ(limits("upper='+3'").upper, 3.0);
  EXPECT_EQ(limits("lower='-1e-400' upper='1'").lower, 0.0);  // It is small, not without end.
}

/// Only what forces move needs the mass.
TEST(UrdfOddities, KeepsADefectOfInertiaForSimulations) {
  const auto inertia = [](const Insertions& insertions) {
    const RobotReading reading = read_odd(insertions);
    expect_plain(reading, "inertia");
    return reading.model.links()[0].inertia.value();
  };
  EXPECT_EQ(inertia({}).defect, "");
  EXPECT_EQ(inertia({}).mass, 1.0);
  EXPECT_EQ(inertia({{"link", "<inertial><mass value='2'/></inertial>"}}).defect,
            "odd.urdf:5: <inertial>: a second one inside <link name='base'>; keep one");
  EXPECT_EQ(inertia({{"link", "<inertial><mass value='2'/></inertial>"}}).mass, 2.0);
  EXPECT_NE(inertia({{"inertial", "<mass value='heavy'/>"}}).defect.find("a second <mass>"),
            std::string::npos);
  EXPECT_EQ(parse_robot("<robot name='r'><link name='a'><inertial><mass value='1'/>"
                        "<inertia ixx='1' ixy='x'/></inertial></link></robot>",
                        "odd.urdf")
                .model.links()[0]
                .inertia.value()
                .defect,
            "odd.urdf:1: <inertia>: expected finite numbers of at most 1e60 in size in 'ixy', got "
            "'x'");
  EXPECT_NE(inertia({{"inertial", "<inerta/>"}}).defect.find("did you mean <inertia>?"),
            std::string::npos);
  EXPECT_NE(inertia({{"inertial", "<density value='1'/>"}}).defect.find("<density>"),
            std::string::npos);
}

RobotReading half_dressed(RobotSurface surface) {
  return parse_robot(
      "<robot name='r'><link name='a'><collision><geometry><sphere radius='1'/></geometry>"
      "</collision><visual><geometry><sphere radius='9'/></geometry></visual></link>"
      "<link name='b'><visual><geometry><sphere radius='2'/></geometry></visual></link>"
      "<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>",
      "odd.urdf", {.surface = surface});
}

TEST(UrdfOddities, NamesLinksThatCannotTouch) {
  const RobotReading collision = half_dressed(RobotSurface::collision);
  EXPECT_TRUE(holds_text(collision.files.front().warnings,
                         "link b has <visual> and no <collision>: nothing can touch it"));
  EXPECT_TRUE(collision.model.links()[1].collision.empty());

  const RobotReading either = half_dressed(RobotSurface::collision_or_visual);
  EXPECT_TRUE(either.files.front().warnings.empty());
  EXPECT_EQ(either.model.links()[0].collision.at(0).shape.value().radius(), 1.0);
  EXPECT_EQ(either.model.links()[1].collision.at(0).shape.value().radius(), 2.0);

  const RobotReading visual = half_dressed(RobotSurface::visual);
  EXPECT_EQ(visual.model.links()[0].collision.at(0).shape.value().radius(), 9.0);
}

TEST(UrdfOddities, LooksOfAnotherKindMatterOnlyWhereTheyTouch) {
  const std::string text =
      "<robot name='r'><link name='a'><visual><geometry><ellipsoid radii='1 2 3'/></geometry>"
      "</visual><collision><geometry><sphere radius='1'/></geometry></collision></link></robot>";
  const RobotReading reading = parse_robot(text, "odd.urdf");
  EXPECT_EQ(reading.model.links()[0].collision.size(), 1u);
  EXPECT_EQ(reading.files.front().left_out.at(0).name, "<ellipsoid> in <visual>");
  EXPECT_NE(error_of(text, {.surface = RobotSurface::visual}).find("<ellipsoid>: not known"),
            std::string::npos);
}

TEST(UrdfOddities, LooksThatAreNotFoundMatterOnlyWhereTheyTouch) {
  const std::string text =
      "<robot name='r'><link name='a'><visual><geometry>"
      "<mesh filename='package://no_such_package/a.stl'/></geometry></visual></link></robot>";
  const RobotReading reading = parse_robot(text, "odd.urdf");
  EXPECT_TRUE(reading.model.links()[0].visual.empty());
  EXPECT_NE(reading.files.front().left_out.at(0).reason.find("no_such_package"), std::string::npos);
  EXPECT_NE(error_of(text, {.surface = RobotSurface::collision_or_visual}).find("no_such_package"),
            std::string::npos);
}

/// Hostile files end in a line.
TEST(UrdfOddities, ReadsNamesByTheEncodingThatTheFileStates) {
  const std::string robot = "<robot name='r'><link name='bras_d\xe9'/></robot>";
  const auto name_of = [](const std::string& text) {
    return parse_robot(text, "odd.urdf").model.links()[0].name;
  };
  EXPECT_EQ(name_of("<?xml version='1.0' encoding='ISO-8859-1'?>\n" + robot), "bras_d\xc3\xa9");
  EXPECT_EQ(name_of("<?xml version=\"1.0\" encoding=\"latin1\"?>" + robot), "bras_d\xc3\xa9");
  EXPECT_EQ(name_of("<robot name='r'><!-- 90\xb0 --><link name='d\xc3\xa9'/></robot>"),
            "d\xc3\xa9");
  EXPECT_EQ(error_of("<?xml version='1.0' encoding='windows-1252'?>\n\n" + robot),
            "odd.urdf:3: expected UTF-8, got other bytes; save the file as UTF-8, or state its "
            "encoding: <?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>");
  EXPECT_EQ(error_of(robot).substr(0, 33), "odd.urdf:1: expected UTF-8, got o");
}

TEST(UrdfOddities, NamesFormatsThatAreNone) {
  EXPECT_EQ(error_of("<mujoco model='m'/>"),
            "odd.urdf:1: <mujoco>: expected <robot> as the outermost element, got MJCF, which is "
            "not read; convert it to URDF");
}

TEST(UrdfOddities, SurvivesDepthAndBombs) {
  std::string deep = "<robot name='r'>";
  for (int k = 0; k < 100'000; ++k) {
    deep += "<a>";
  }
  EXPECT_NE(error_of(deep).find("inside of each other"), std::string::npos);
  const std::string bomb =
      "<!DOCTYPE r [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;'>]>"
      "<robot name='r'>&b;</robot>";
  EXPECT_NE(error_of(bomb).find("expected"), std::string::npos);
  EXPECT_NE(error_of("<robot name='r'><link name='a'/>&b;</robot>").find("expected no entities"),
            std::string::npos);
  // A chain and a loop of 20,000 links, each walked once.
  std::string chain = "<robot name='r'>";
  std::string loop;
  for (int k = 0; k < 20'000; ++k) {
    const std::string name = std::to_string(k);
    chain += "<link name='" + name + "'/>";
    loop += "<joint name='" + name + "' type='fixed'><parent link='" + name + "'/><child link='" +
            std::to_string((k + 1) % 20'000) + "'/></joint>";
  }
  EXPECT_NE(error_of(chain + loop + "</robot>").find("is part of a loop"), std::string::npos);
}

}  // namespace
}  // namespace firstcontact
