#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/crane.h"

namespace firstcontact {
namespace {

using test::crane;

PlanningScene parse(const std::string& text) {
  return parse_planning_scene(text, "s.yaml", "ground");
}

const Pose& pose_of(const Body& body) { return std::get<FixedMotion>(body.motion).pose; }

TEST(PlanningScene, HasPrimitivesAtTheirPoses) {
  const PlanningScene scene = parse(R"(
world:
  collision_objects:
  - id: can
    primitives: [{type: cylinder, dimensions: [0.12, 0.03]}]
    primitive_poses: [{position: [1, 2, 3], orientation: [0, 0, 0, 1]}]
  - id: 7
    header: {frame_id: /ground}
    pose: {position: {x: 1, y: 0, z: 0}, orientation: {x: 0, y: 0, z: 1, w: 0}}
    primitives: [{type: 1, dimensions: [1, 2, 3]}, {type: 2, dimensions: [4]}, {type: 4, dimensions: [5, 6]}]
    primitive_poses: [{position: [1, 0, 0]}, {position: [0, 1, 0]}, {}]
)");
  ASSERT_EQ(scene.bodies.size(), 4u);
  EXPECT_EQ(scene.bodies[0].name, "can");
  const auto& can = std::get<CylinderShape>(scene.bodies[0].shape.source);
  EXPECT_EQ(can.length, 0.12);
  EXPECT_EQ(can.radius, 0.03);
  EXPECT_EQ(pose_of(scene.bodies[0]).position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scene.bodies[1].name, "7/0");
  EXPECT_EQ(scene.object_ids[1], "7");
  EXPECT_EQ(std::get<BoxShape>(scene.bodies[1].shape.source).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<SphereShape>(scene.bodies[2].shape.source).radius, 4.0);
  EXPECT_EQ(std::get<ConeShape>(scene.bodies[3].shape.source).radius, 6.0);
  // Half a turn about z, then one to the right.
  EXPECT_TRUE(pose_of(scene.bodies[1]).position.isZero(1e-15));
  EXPECT_TRUE(pose_of(scene.bodies[2]).position.isApprox(Eigen::Vector3d(1, -1, 0), 1e-15));
  EXPECT_EQ(pose_of(scene.bodies[3]).position, Eigen::Vector3d(1, 0, 0));
}

TEST(PlanningScene, HasMeshesAndFrames) {
  const PlanningScene scene = parse(R"(
fixed_frame_transforms:
- {child_frame_id: table, transform: {translation: [0, 0, 1], rotation: [0, 0, 0, 1]}}
world:
  collision_objects:
  - id: sheet
    header: {frame_id: table}
    meshes:
    - triangles: [{vertex_indices: [0, 1, 2]}]
      vertices: [{x: 0, y: 0, z: 0}, [1, 0, 0], [0, 1, 0]]
    mesh_poses: [{position: [5, 0, 0]}]
)");
  ASSERT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(std::get<Mesh>(scene.bodies[0].shape.source).triangles.size(), 1u);
  EXPECT_EQ(pose_of(scene.bodies[0]).position, Eigen::Vector3d(5, 0, 1));
}

TEST(PlanningScene, AllowsWhatEntriesSayThenDefaults) {
  const AllowedCollisions allowed = parse(R"(
allowed_collision_matrix:
  entry_names: [a, b, c]
  entry_values: [[false, true, false], {enabled: [1, 0, 0]}, [false, false, false]]
  default_entry_names: [a, c, d]
  default_entry_values: [true, false, true]
world: {}
)")
                                        .allowed;
  EXPECT_TRUE(allowed.allows("b", "a"));
  EXPECT_FALSE(allowed.allows("a", "c"));
  EXPECT_TRUE(allowed.allows("a", "x"));
  EXPECT_TRUE(allowed.allows("a", "d"));
  EXPECT_FALSE(allowed.allows("d", "c"));
  EXPECT_FALSE(allowed.allows("x", "y"));
}

void expect_message(const std::string& text, const std::string& message) {
  try {
    (void)parse(text);
    ADD_FAILURE() << "accepted: " << text;
  } catch (const ParseError& error) {
    EXPECT_EQ(error.what(), message) << text;
  }
}

/// A scene of one object with these members.
std::string object(const std::string& members) {
  return "world:\n  collision_objects:\n  - {id: o, " + members + "}\n";
}

TEST(MalformedPlanningScene, IsNamedByLineAndPlace) {
  const std::string place = "s.yaml:3: world.collision_objects[0]";
  expect_message("world: {collision_object: []}",
                 "s.yaml:1: world.collision_object: unknown key; did you mean "
                 "\"collision_objects\"?");
  expect_message("name: x", "s.yaml:1: expected a planning scene with \"world\", got none");
  expect_message(
      object("planes: [{coef: [0, 0, 1, 0]}]"),
      place + ".planes: expected no planes, which have no end; put a box in their place");
  expect_message(object("subframe_names: []"),
                 place + ": expected \"primitives\" or \"meshes\" of the object, got none");
  expect_message(object("operation: 1"), place + ".operation: expected operation 0, add, got 1");
  expect_message(object("primitives: [{type: box, dimensions: [1, 2]}]"),
                 place + ".primitives[0].dimensions: expected \"x\", \"y\", \"z\", got 2 numbers");
  expect_message(object("primitives: [{type: sphere, dimensions: [.nan]}]"),
                 place + ".primitives[0].dimensions[0]: expected a number, got \".nan\"");
  expect_message(object("primitives: [{type: sphere, dimensions: [0]}]"),
                 place + ".primitives[0].dimensions[0]: expected a number > 0, got 0");
  expect_message(object("primitives: [{type: ball, dimensions: [1]}]"),
                 place +
                     ".primitives[0].type: unknown word \"ball\"; known are \"box\", "
                     "\"sphere\", \"cylinder\", \"cone\"");
  expect_message(object("primitives: [{type: sphere, dimensions: [1]}], primitive_poses: [{}, {}]"),
                 place + ".primitive_poses: expected a pose for each of the 1 primitives, got 2");
  expect_message(object("primitives: [{type: sphere, dimensions: [1]}], pose: {orientation: [0, 0, "
                        "0, 2]}"),
                 place +
                     ".pose.orientation: expected a quaternion x, y, z, w of length 1, got one "
                     "of length 2");
  expect_message(object("header: {frame_id: hook}, primitives: [{type: sphere, dimensions: [1]}]"),
                 place +
                     ".header.frame_id: expected a frame that rests (\"\", \"ground\", "
                     "\"world\"), got \"hook\"");
  expect_message("world: {collision_objects: [7]}",
                 "s.yaml:1: world.collision_objects[0]: expected an object with \"id\", got 7");
  const std::string held =
      "robot_state: {attached_collision_objects: [{link_name: hook, object: {id: o, header: "
      "{frame_id: cart}, primitives: []}}]}\nworld: {}";
  expect_message(held,
                 "s.yaml:1: robot_state.attached_collision_objects[0].object.header.frame_id: "
                 "expected the frame of the link that holds it, \"hook\", got \"cart\"");
  expect_message("link_scale: [{link_name: hook, scale: 1.5}]\nworld: {}",
                 "s.yaml:1: link_scale[0]: expected no scale of links but 1; a padding makes them "
                 "larger");
  expect_message(
      "allowed_collision_matrix: {entry_names: [a, b], entry_values: [[0, 1], [0, 0]]}\n"
      "world: {}",
      "s.yaml:1: allowed_collision_matrix.entry_values[1][0]: expected the same for "
      "\"b\" and \"a\" as for them swapped");
}

// A key that nothing reads would be left out without notice.
TEST(MalformedPlanningScene, HasNoKeysThatMessagesLack) {
  expect_message("robot_state: {joint_sate: {name: [turn], position: [1]}}\nworld: {}",
                 "s.yaml:1: robot_state.joint_sate: unknown key; did you mean \"joint_state\"?");
  expect_message("robot_state: {joint_state: {names: [turn], position: [1]}}\nworld: {}",
                 "s.yaml:1: robot_state.joint_state.names: unknown key; did you mean \"name\"?");
  expect_message(
      "robot_state: {multi_dof_joint_state: {joint_name: [w], transforms: [{}]}}\nworld: {}",
      "s.yaml:1: robot_state.multi_dof_joint_state.joint_name: unknown key; did you mean "
      "\"joint_names\"?");
  expect_message(object("header: {frame: hook}, primitives: [{type: sphere, dimensions: [1]}]"),
                 "s.yaml:3: world.collision_objects[0].header.frame: unknown key; did you mean "
                 "\"frame_id\"?");
}

TEST(PlanningScene, HasTheFrameOfItsRobotAsThePlanningFrame) {
  const auto moved = [](const std::string& frame, const std::string& translation) {
    return "fixed_frame_transforms: [{child_frame_id: " + frame + ", transform: {translation: [" +
           translation + "]}}]\nworld: {}";
  };
  expect_message(moved("/ground", "0, 1, 0"),
                 "s.yaml:1: fixed_frame_transforms[0]: expected the frame of the root link, "
                 "\"/ground\", to be the planning frame, but it is moved");
  EXPECT_FALSE(parse(moved("ground", "0, 0, 0")).moves_world);
  EXPECT_FALSE(parse(moved("table", "0, 1, 0")).moves_world);
  EXPECT_FALSE(parse(moved("world", "0, 0, 0")).moves_world);
  EXPECT_TRUE(parse(moved("world", "0, 1, 0")).moves_world);
}

/// A robot whose base has this pose.
std::string moved_base(const std::string& transform) {
  return "robot_state: {multi_dof_joint_state: {joint_names: [w], twist: [], wrench: [], "
         "transforms: [" +
         transform + "]}}\nworld: {}";
}

// Objects may be placed by the frame of the root link, which has to be the planning frame.
TEST(PlanningScene, HasARobotWhoseBaseIsThePlanningFrame) {
  const std::string error =
      "s.yaml:1: robot_state.multi_dof_joint_state.transforms[0]: expected a robot whose base is "
      "the planning frame, but it is moved; move the objects in its place";
  expect_message(moved_base("{translation: [100, 0, 0], rotation: [0, 0, 0, 1]}"), error);
  expect_message(moved_base("{translation: [0, 0, 0], rotation: [0, 0, 1, 0]}"), error);
  for (const std::string rotation : {"[0, 0, 0, 1]", "[0, 0, 0, -1]", "[0, 0, 0, 0]"}) {
    EXPECT_TRUE(
        parse(moved_base("{translation: [0, 0, 0], rotation: " + rotation + "}")).bodies.empty());
  }
  expect_message(
      "robot_state: {multi_dof_joint_state: {joint_names: [], transforms: [{}]}}\nworld: {}",
      "s.yaml:1: robot_state.multi_dof_joint_state.transforms: expected a transform for each of "
      "the 0 names, got 1");
}

TEST(PlanningScene, HasWhatLinksHoldAndPadding) {
  const PlanningScene scene = parse(R"(
link_padding: [{link_name: hook, padding: 0.01}, {link_name: cart, padding: 0}]
link_scale: [{link_name: hook, scale: 1}]
robot_state:
  attached_collision_objects:
  - link_name: hook
    object:
      id: load
      header: {frame_id: hook}
      pose: {position: [0, 0, -1], orientation: [0, 0, 0, 1]}
      primitives: [{type: sphere, dimensions: [0.5]}, {type: box, dimensions: [1, 1, 1]}]
      primitive_poses: [{position: [0, 0, -2]}, {}]
    touch_links: [mast]
    weight: 3
world: {}
)");
  EXPECT_EQ(scene.padding, (std::map<std::string, double>{{"hook", 0.01}}));
  EXPECT_TRUE(scene.bodies.empty());
  ASSERT_EQ(scene.attached.size(), 1u);
  const AttachedObject& load = scene.attached[0];
  EXPECT_EQ(load.id + load.link + load.touch_links.at(0), "loadhookmast");
  ASSERT_EQ(load.parts.size(), 2u);
  EXPECT_EQ(load.parts[0].name, "load/0");
  EXPECT_EQ(pose_of(load.parts[0]).position, Eigen::Vector3d(0, 0, -3));
}

TEST(PlanningRequest, SaysFromWhereToWhere) {
  const PlanningRequest request = parse_planning_request(R"(
start_state:
  joint_state: {name: [turn, lift], position: [0.5, 0.25]}
  multi_dof_joint_state:
    joint_names: [world_joint]
    transforms: [{translation: [1, 0, 0], rotation: [0, 0, 0, 1]}]
goal_constraints:
- joint_constraints: [{joint_name: turn, position: -1.5}]
)",
                                                         "r.yaml", crane());
  EXPECT_EQ(request.start, (JointPositions{{"turn", 0.5}, {"lift", 0.25}}));
  EXPECT_EQ(request.goals.at(0).positions, (JointPositions{{"turn", -1.5}}));
  EXPECT_EQ(request.base.position, Eigen::Vector3d(1, 0, 0));
  const Trajectory motion = straight_motion(crane(), request.start, request.goals.at(0).positions);
  EXPECT_EQ(motion.joint_names, (std::vector<std::string>{"turn"}));
  EXPECT_EQ(motion.points[0].positions[0], 0.5);
  EXPECT_EQ(motion.points[1].positions[0], -1.5);
  EXPECT_NEAR(motion.points[1].time, 0.5, 1e-9);  // Two radians at four in a second.
  EXPECT_GT(motion.points[1].time, 0.5);
  const Trajectory slow = straight_motion(crane(), request.start, request.goals.at(0).positions,
                                          Turning::shortest, 0.25);
  EXPECT_NEAR(slow.points[1].time, 2.0, 1e-9);
  EXPECT_EQ(slow.points[1].positions, motion.points[1].positions);
}

// Messages whose pose was never set have zeros, which MoveIt takes as the identity.
TEST(PlanningScene, TakesQuaternionsOfZerosAsTheIdentityWithOneWarning) {
  const std::string zeros = "orientation: [0, 0, 0, 0]";
  const PlanningScene scene = parse(R"(
fixed_frame_transforms:
- {child_frame_id: table, transform: {translation: [0, 0, 1], rotation: {x: 0, y: 0, z: 0, w: 0}}}
robot_state:
  attached_collision_objects:
  - link_name: hook
    object: {id: load, header: {frame_id: hook}, pose: {)" +
                                    zeros + R"(}, primitives: [{type: sphere, dimensions: [1]}]}
world:
  collision_objects:
  - {id: a, header: {frame_id: table}, pose: {position: [1, 0, 0], )" +
                                    zeros + R"(}, primitives: [{type: sphere, dimensions: [1]}]}
  - {id: b, primitives: [{type: sphere, dimensions: [1]}, {type: sphere, dimensions: [1]}], primitive_poses: [{)" +
                                    zeros + "}, {" + zeros + R"(}]}
  - {id: c, primitives: [{type: sphere, dimensions: [1]}]}
)");
  EXPECT_EQ(pose_of(scene.bodies[0]).position, Eigen::Vector3d(1, 0, 1));
  EXPECT_TRUE(pose_of(scene.bodies[0]).rotation.vec().isZero(0.0));
  EXPECT_EQ(scene.warnings,
            (std::vector<std::string>{"s.yaml: quaternions of zeros are taken as the identity, as "
                                      "MoveIt does: table, a, b, load"}));
}

TEST(PlanningRequest, LeavesOutFixedJointsAndZeroQuaternionsWithAWarning) {
  const PlanningRequest request = parse_planning_request(R"(
start_state:
  joint_state: {name: [turn, weld], position: [0.5, 0.25]}
  multi_dof_joint_state:
    joint_names: [world_joint]
    transforms: [{translation: [1, 0, 0], rotation: [0, 0, 0, 0]}]
goal_constraints:
- joint_constraints: [{joint_name: turn, position: -1.5}, {joint_name: weld, position: 1}]
)",
                                                         "r.yaml", crane());
  EXPECT_EQ(request.start, (JointPositions{{"turn", 0.5}}));
  EXPECT_EQ(request.goals.at(0).positions, (JointPositions{{"turn", -1.5}}));
  EXPECT_EQ(request.base.position, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(request.warnings,
            (std::vector<std::string>{
                "r.yaml: a quaternion of zeros is taken as the identity, as MoveIt does: the "
                "robot's base",
                "r.yaml: a position is given for a fixed joint, weld; it is where the URDF has "
                "it"}));
}

TEST(PlanningScene, HasTheStateOfTheRobot) {
  EXPECT_EQ(parse("robot_state: {joint_state: {name: [a, b], position: [1, 2]}}\nworld: {}").state,
            (JointPositions{{"a", 1.0}, {"b", 2.0}}));
  expect_message("robot_state: {joint_state: {name: [a, b], position: [1]}}\nworld: {}",
                 "s.yaml:1: robot_state.joint_state.position: expected a number for each of the 2 "
                 "names, got 1");
}

/// A carriage that drives in a plane, with a kite on a floating joint.
RobotModel carriage() {
  RobotDescription robot{.name = "carriage", .links = {{"ground"}, {"cart"}, {"kite"}}};
  robot.joints.push_back(
      {.name = "drive", .type = JointType::planar, .parent = "ground", .child = "cart"});
  robot.joints.back().axis = Eigen::Vector3d::UnitZ();
  robot.joints.push_back(
      {.name = "line", .type = JointType::floating, .parent = "cart", .child = "kite"});
  return RobotModel(robot);
}

std::string carriage_request(const std::string& names, const std::string& transforms) {
  return "start_state: {multi_dof_joint_state: {joint_names: [" + names + "], transforms: [" +
         transforms + R"(]}}
group_name: all
workspace_parameters: {min_corner: [-1, -2, -3], max_corner: [4, 5, 6]}
goal_constraints:
- joint_constraints: [{joint_name: drive/x, position: 1}, {joint_name: line/trans_z, position: 3}]
)";
}

TEST(PlanningRequest, HasPosesOfPlanarAndFloatingJoints) {
  const RobotModel robot = carriage();
  const std::vector<RobotGroup> groups{{.name = "all", .links = {1, 2}, .joints = {0, 1}}};
  const PlanningRequest request = parse_planning_request(
      carriage_request("drive, world_joint, line",
                       "{translation: [1, 2, 0], rotation: [0, 0, -0.6, -0.8]}, "
                       "{translation: [7, 0, 0], rotation: [0, 0, 0, 1]}, "
                       "{translation: [0, 0, 2], rotation: [0.6, 0, 0, 0.8]}"),
      "r.yaml", robot, groups);
  const double theta = request.start.at("drive/theta");
  EXPECT_NEAR(theta, 2.0 * std::atan(0.75), 1e-15);
  EXPECT_EQ(request.start, (JointPositions{{"drive/x", 1.0},
                                           {"drive/y", 2.0},
                                           {"drive/theta", theta},
                                           {"line/trans_x", 0.0},
                                           {"line/trans_y", 0.0},
                                           {"line/trans_z", 2.0},
                                           {"line/rot_w", 0.8},
                                           {"line/rot_x", 0.6},
                                           {"line/rot_y", 0.0},
                                           {"line/rot_z", 0.0}}));
  EXPECT_EQ(request.base.position, Eigen::Vector3d(7, 0, 0));
  EXPECT_EQ(request.joints,
            (std::vector<std::string>{"drive/x", "drive/y", "drive/theta", "line"}));
  EXPECT_EQ(request.bounds,
            (std::map<std::string, std::array<double, 2>>{{"drive/x", {-1.0, 4.0}},
                                                          {"drive/y", {-2.0, 5.0}},
                                                          {"line/trans_x", {-1.0, 4.0}},
                                                          {"line/trans_y", {-2.0, 5.0}},
                                                          {"line/trans_z", {-3.0, 6.0}}}));
}

TEST(PlanningRequest, RefusesPosesThatItsJointsCannotHave) {
  const auto message = [](const std::string& names, const std::string& transforms) {
    try {
      (void)parse_planning_request(carriage_request(names, transforms), "r.yaml", carriage());
    } catch (const ParseError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const std::string at = "r.yaml:1: start_state.multi_dof_joint_state.";
  EXPECT_EQ(message("drive", "{translation: [1, 2, 0.1]}"),
            at + "transforms[0]: expected a pose in the plane x, y of planar joint \"drive\"");
  EXPECT_EQ(message("drive", "{rotation: [0.6, 0, 0, 0.8]}"),
            at + "transforms[0]: expected a pose in the plane x, y of planar joint \"drive\"");
  EXPECT_EQ(message("drive, drive", "{}, {}"),
            at + "joint_names[1]: expected each joint once, got \"drive\" again");
  EXPECT_EQ(message("left, right", "{}, {}"),
            at + "joint_names[1]: expected joints of the robot, and one between the world and the "
                 "robot, got \"left\" and \"right\"");
  EXPECT_EQ(message("drive, line", "{}"),
            at + "transforms: expected a transform for each of the 2 names, got 1");
}

TEST(PlanningRequest, HasAGoalOfALink) {
  const PlanningRequest request = parse_planning_request(R"(
goal_constraints:
- position_constraints:
  - header: {frame_id: world}
    link_name: hook
    target_point_offset: {x: 0, y: 0, z: -0.5}
    constraint_region:
      primitives: [{type: 1, dimensions: [0.02, 0.01, 0.04]}]
      primitive_poses: [{position: {x: 1, y: 2, z: 3}, orientation: {x: 0, y: 0, z: 0, w: 1}}]
    weight: 1
  orientation_constraints:
  - link_name: hook
    orientation: {x: 0, y: 0, z: 1, w: 0}
    absolute_x_axis_tolerance: 0.1
    absolute_y_axis_tolerance: 0.3
    absolute_z_axis_tolerance: 3.14
)",
                                                         "r.yaml", crane());
  EXPECT_TRUE(request.goals.at(0).positions.empty());
  const LinkGoal& goal = request.goals.at(0).link.value();
  EXPECT_EQ(goal.link, "hook");
  EXPECT_EQ(goal.X_LT.position, Eigen::Vector3d(0, 0, -0.5));
  EXPECT_EQ(goal.X_WT.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(goal.X_WT.rotation.z(), 1.0);
  EXPECT_EQ(goal.position_tolerance, 0.005);  // The ball in the box.
  EXPECT_EQ(goal.rotation_tolerance, 0.05);
}

// Half of a tolerance of two pi is any rotation.
TEST(PlanningRequest, MayTurnALinkAsItLikes) {
  const std::string wide = "6.2832";
  const PlanningRequest request = parse_planning_request(
      "goal_constraints: [{position_constraints: [{link_name: hook, constraint_region: "
      "{primitives: "
      "[{type: 2, dimensions: [0.01]}], primitive_poses: [{position: {x: 1, y: 2, z: 3}, "
      "orientation: {x: 0, y: 0, z: 0, w: 1}}]}}], "
      "orientation_constraints: [{link_name: hook, orientation: {x: 0, y: 0, z: 0, w: 1}, "
      "absolute_x_axis_tolerance: " +
          wide + ", absolute_y_axis_tolerance: " + wide + ", absolute_z_axis_tolerance: " + wide +
          "}]}]",
      "r.yaml", crane());
  EXPECT_GE(request.goals.at(0).link.value().rotation_tolerance, std::numbers::pi);
}

TEST(PlanningRequest, NeedsAGoalOfJointsOrOfALink) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      (void)parse_planning_request(text, "r.yaml", crane());
    } catch (const ParseError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message("start_state: {}"), "r.yaml:1: expected a key \"goal_constraints\", got none");
  EXPECT_EQ(message("goal_constraints: [{joint_constraints: [{joint_name: turn, position: 1}], "
                    "position_constraints: [{}]}]"),
            "r.yaml:1: goal_constraints[0]: expected \"joint_constraints\" alone, or "
            "\"position_constraints\" and \"orientation_constraints\" of one link");
  EXPECT_EQ(message("goal_constraints: [{orientation_constraints: [{}]}]"),
            "r.yaml:1: goal_constraints[0]: expected a position beside the orientation, got "
            "\"orientation_constraints\" alone");
  EXPECT_EQ(message("goal_constraints: [{position_constraints: [{link_name: hok}]}]"),
            "r.yaml:1: goal_constraints[0].position_constraints[0].link_name: expected a link of "
            "the robot, got \"hok\"");
  EXPECT_EQ(message("goal_constraints: [{position_constraints: [{link_name: hook, "
                    "header: {frame_id: moon}, constraint_region: {primitives: [{type: 2, "
                    "dimensions: [1]}], primitive_poses: [{}]}}]}]"),
            "r.yaml:1: goal_constraints[0].position_constraints[0].header.frame_id: expected the "
            "frame \"world\" or that of the root link \"ground\", got \"moon\"");
  EXPECT_EQ(message("goal_constraints: [{position_constraints: [{link_name: hook, "
                    "constraint_region: {primitives: [{type: 2, dimensions: [-1]}], "
                    "primitive_poses: [{}]}}]}]"),
            "r.yaml:1: goal_constraints[0].position_constraints[0].constraint_region.primitives[0]"
            ".dimensions[0]: expected a number >= 0, got -1");
  EXPECT_EQ(message("goal_constraints: [{joint_constraints: [{joint_name: trun, position: 1}]}]"),
            "r.yaml:1: goal_constraints[0].joint_constraints[0].joint_name: expected a joint of "
            "the robot, got \"trun\"; did you mean \"turn\"?");
  const std::string goal =
      "goal_constraints: [{joint_constraints: [{joint_name: turn, position: 1}]}]";
  EXPECT_EQ(message("path_constraints: {joint_constraints: [{joint_name: turn}]}\n" + goal),
            "r.yaml:1: path_constraints.joint_constraints: expected no constraints along the path: "
            "they are not supported");
  EXPECT_EQ(message("trajectory_constraints: {constraints: [{}, {joint_constraints: [{joint_name: "
                    "turn}]}]}\n" +
                    goal),
            "r.yaml:1: trajectory_constraints.constraints[1].joint_constraints: expected no "
            "constraints of the trajectory: they are not supported");
  EXPECT_EQ(message("trajectory_constraints: {constraints: [{name: '', joint_constraints: []}]}\n" +
                    goal),
            "accepted");
  EXPECT_EQ(message("path_constraint: {joint_constraints: [{joint_name: turn}]}\n" + goal),
            "r.yaml:1: path_constraint: unknown key; did you mean \"path_constraints\"?");
  EXPECT_EQ(message("start_state: {joint_sate: {name: [turn], position: [1]}}\n" + goal),
            "r.yaml:1: start_state.joint_sate: unknown key; did you mean \"joint_state\"?");
  EXPECT_EQ(message("goal_constraints: [{joint_constraints: [{joint_name: turn, position: 1}], "
                    "position_constraint: [{}]}]"),
            "r.yaml:1: goal_constraints[0].position_constraint: unknown key; did you mean "
            "\"position_constraints\"?");
  EXPECT_EQ(message("start_state: {joint_state: {name: [trun], position: [1]}}"),
            "r.yaml:1: start_state.joint_state.name[0]: expected a joint of the robot, got "
            "\"trun\"; did you mean \"turn\"?");
  EXPECT_EQ(message("start_state: {joint_state: {name: [turn], position: [.nan]}}"),
            "r.yaml:1: start_state.joint_state.position[0]: expected a number, got \".nan\"");
  EXPECT_EQ(message("start_state: {joint_state: {name: [turn, lift], position: [1]}}"),
            "r.yaml:1: start_state.joint_state.position: expected a number for each of the 2 "
            "names, got 1");
}

// Every problem of the data set can be read.
TEST(PlanningScene, ReadsMotionBenchMaker) {
  const char* data = std::getenv("FIRSTCONTACT_DATA_DIR");
  if (data == nullptr) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const std::filesystem::path folder = std::filesystem::path(data) / "planning_mbm/panda";
  const RobotModel panda =
      read_robot_model({.urdf = std::filesystem::path(data) /
                                "robots/moveit_resources_panda_description/urdf/panda.urdf"});
  int scenes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("scene")) {
      EXPECT_FALSE(read_planning_scene(entry.path(), "panda_link0").bodies.empty()) << name;
      ++scenes;
    } else if (name.starts_with("request")) {
      EXPECT_EQ(read_planning_request(entry.path(), panda).goals.at(0).positions.size(), 7u)
          << name;
    }
  }
  EXPECT_EQ(scenes, 400);
}

}  // namespace
}  // namespace firstcontact
