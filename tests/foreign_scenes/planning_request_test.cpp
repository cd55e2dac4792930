// What a request tells beside its start and goal: the group that moves, factors, and its time.

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/text/parse_error.h>

#include "scene/crane.h"

namespace firstcontact {
namespace {

using test::crane;

/// A request for the pose of the hook.
std::string hook_request(const std::string& more) {
  return more + R"(
goal_constraints:
- position_constraints:
  - link_name: hook
    constraint_region: {primitives: [{type: 2, dimensions: [0.01]}], primitive_poses: [{}]}
)";
}

RobotSemantics crane_groups() {
  return parse_srdf(R"(<robot name="crane"><group name="lifts"><joint name="lift"/></group>
      <group name="arm"><chain base_link="cart" tip_link="hook"/></group>
      <group name="all"><group name="arm"/><joint name="rail"/></group>
      <group name="other"><link name="weight"/></group></robot>)",
                    "crane.srdf", crane());
}

TEST(PlanningRequest, MovesTheJointsOfItsGroup) {
  const std::vector<RobotGroup> groups = crane_groups().groups;
  const auto joints_of = [&](const std::string& group) {
    return parse_planning_request(hook_request("group_name: " + group), "r.yaml", crane(), groups)
        .joints;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(joints_of("lifts"), Names{"lift"});
  EXPECT_EQ(joints_of("arm"), (Names{"turn", "lift"}));  // Not the rail, which moves the cart.
  EXPECT_EQ(joints_of("all"), (Names{"rail/x", "rail/y", "rail/theta", "turn", "lift"}));
  EXPECT_TRUE(joints_of("''").empty());
}

TEST(PlanningRequest, NamesAGroupThatDoesNotFit) {
  const std::vector<RobotGroup> groups = crane_groups().groups;
  const auto message = [&](const std::string& text, bool has_groups = true) -> std::string {
    try {
      (void)parse_planning_request(text, "r.yaml", crane(),
                                   has_groups ? groups : std::vector<RobotGroup>());
    } catch (const ParseError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(hook_request("group_name: arms")),
            "r.yaml:1: group_name: expected a group of the SRDF (lifts, arm, all, other), got "
            "\"arms\"");
  EXPECT_EQ(message(hook_request("group_name: arm"), false),
            "r.yaml:1: group_name: expected an SRDF with groups, which tells what joints move; "
            "got none");
  EXPECT_EQ(message(hook_request("group_name: 3")).find("r.yaml:1: group_name: expected "), 0u);
  const std::string turn =
      "\ngoal_constraints: [{joint_constraints: [{joint_name: turn, position: 1}]}]";
  EXPECT_EQ(message("group_name: arm" + turn), "accepted");
  EXPECT_EQ(message("group_name: arm" + turn, false), "accepted");
  EXPECT_EQ(message("group_name: lifts" + turn),
            "r.yaml:2: goal_constraints[0].joint_constraints[0].joint_name: expected a joint of "
            "group \"lifts\", got \"turn\"");
}

TEST(PlanningRequest, HasScalingFactors) {
  const auto read = [](const std::string& keys) {
    return parse_planning_request(hook_request(keys), "r.yaml", crane());
  };
  const PlanningRequest scaled = read(
      "max_velocity_scaling_factor: 0.1\nmax_acceleration_scaling_factor: 0.5\n"
      "max_cartesian_speed: 0.25");
  EXPECT_EQ(scaled.velocity_scaling, 0.1);
  EXPECT_EQ(scaled.acceleration_scaling, 0.5);
  EXPECT_EQ(scaled.cartesian_speed, 0.25);
  EXPECT_EQ(read("max_velocity_scaling_factor: 0").velocity_scaling, 1.0);
  EXPECT_EQ(read("").acceleration_scaling, 1.0);
  for (const char* wrong : {"-0.1", "1.5", ".nan", "fast"}) {
    EXPECT_THROW((void)read("max_acceleration_scaling_factor: " + std::string(wrong)), ParseError)
        << wrong;
  }
}

TEST(PlanningRequest, HasTheTimeOfAPlanner) {
  const auto time_with = [](const std::string& time) {
    return parse_planning_request(
               time + "goal_constraints: [{joint_constraints: [{joint_name: turn, position: 1}]}]",
               "r.yaml", crane())
        .planning_time;
  };
  EXPECT_EQ(time_with(""), std::nullopt);
  EXPECT_EQ(time_with("allowed_planning_time: 0.0\n"), std::nullopt);  // A message's default.
  EXPECT_EQ(time_with("allowed_planning_time: 2.5\n"), 2.5);
  for (const char* wrong : {"-1", ".nan", ".inf", "soon", "[1]"}) {
    try {
      (void)time_with(std::string("allowed_planning_time: ") + wrong + "\n");
      ADD_FAILURE() << wrong;
    } catch (const ParseError& error) {
      EXPECT_NE(std::string(error.what()).find("r.yaml"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("allowed_planning_time"), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace firstcontact
