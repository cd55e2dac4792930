// Trajectory files: read back to the bit, refused where a controller refuses them.

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/retiming/stop_motion.h>
#include <firstcontact/retiming/write_trajectory.h>
#include <firstcontact/text/parse_error.h>

#include "retiming_cases.h"

namespace firstcontact::test {
namespace {

TEST(WriteTrajectory, ReadsBackToTheBitInEveryFormat) {
  std::mt19937 rng(5);
  for (const bool has_jerk : {false, true}) {
    const TimedMotion motion =
        stop_motion(random_path(rng, 3, 6, 1.0), random_limits(rng, 3, has_jerk));
    for (const auto format :
         {TrajectoryFormat::yaml, TrajectoryFormat::json, TrajectoryFormat::csv}) {
      const std::string name =
          std::string("motion") + kTrajectoryEndings[static_cast<std::size_t>(format)];
      EXPECT_EQ(trajectory_format_of(name), format);
      const TimedMotion back =
          parse_timed_motion(write_trajectory(motion, format), name, planar_arm(3));
      EXPECT_EQ(back.joint_names, motion.joint_names);
      ASSERT_EQ(back.points.size(), motion.points.size());
      for (std::size_t k = 0; k < back.points.size(); ++k) {
        EXPECT_EQ(back.points[k].time, motion.points[k].time);
        EXPECT_EQ(back.points[k].positions, motion.points[k].positions);
        EXPECT_EQ(back.points[k].velocities, motion.points[k].velocities);
        EXPECT_EQ(back.points[k].accelerations, motion.points[k].accelerations);
      }
    }
  }
}

// YAML 1.1 takes 1e-07 for a word: numbers have a point, and exponents a sign.
TEST(WriteTrajectory, WritesNumbersThatOldReadersOfYamlKnow) {
  const TimedMotion motion{{"j0"}, {{0, {1e-7}, {0.0}}, {1'000'000'001, {1e22}, {-2.5e-9}}}};
  const std::string text = write_trajectory(motion, TrajectoryFormat::yaml);
  EXPECT_EQ(text,
            "joint_names: [\"j0\"]\n"
            "points:\n"
            "- positions: [1.0e-07]\n"
            "  velocities: [0.0]\n"
            "  time_from_start: {sec: 0, nanosec: 0}\n"
            "- positions: [1.0e+22]\n"
            "  velocities: [-2.5e-09]\n"
            "  time_from_start: {sec: 1, nanosec: 1}\n");
}

/// A robot with hinges of these names, one after the other.
RobotModel chain_of(const std::vector<std::string>& names) {
  RobotDescription robot{.name = "chain", .links = {{"l0"}}, .joints = {}};
  for (const std::string& name : names) {
    const std::string parent = robot.links.back().name;
    robot.links.push_back({.name = "l" + std::to_string(robot.links.size())});
    robot.joints.push_back({.name = name,
                            .type = JointType::continuous,
                            .parent = parent,
                            .child = robot.links.back().name});
  }
  return RobotModel(robot);
}

TEST(WriteTrajectory, ReadsOddNamesBack) {
  const std::vector<std::string> names{"a\"b", "\"", "\"\"", "c,d", "e;f \"g\", h", "#i"};
  const TimedMotion motion{names,
                           {{0, {1, 2, 3, 4, 5, 6}, {0, 0, 0, 0, 0, 0}},
                            {1'000'000'000, {2, 3, 4, 5, 6, 7}, {0, 0, 0, 0, 0, 0}}}};
  for (const auto format :
       {TrajectoryFormat::yaml, TrajectoryFormat::json, TrajectoryFormat::csv}) {
    const std::string ending = kTrajectoryEndings[static_cast<std::size_t>(format)];
    EXPECT_EQ(parse_timed_motion(write_trajectory(motion, format), "t" + ending, chain_of(names)),
              motion);
    require_names(names, format, chain_of(names));
  }
}

TEST(WriteTrajectory, RefusesNamesThatATableTakesForColumnsOfItsOwn) {
  for (const std::string name : {"time", " b"}) {
    const std::vector<std::string> names{"a", name};
    require_names(names, TrajectoryFormat::yaml, chain_of(names));
    require_names(names, TrajectoryFormat::json, chain_of(names));
    try {
      require_names(names, TrajectoryFormat::csv, chain_of(names));
      ADD_FAILURE() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("joint \"" + name + "\""), std::string::npos)
          << error.what();
    }
  }
}

std::string error_of_text(const std::string& text, const std::string& name) {
  try {
    (void)parse_timed_motion(text, name, planar_arm(1));
  } catch (const ParseError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ParseTimedMotion, RefusesTimesThatDoNotIncrease) {
  EXPECT_EQ(error_of_text("time,j0\n0,0\n1,1\n2,2\n", "a.csv"), "no error");
  // Backward; equal and different; equal and the same.
  EXPECT_NE(error_of_text("time,j0\n0,0\n2,1\n1,2\n", "a.csv"), "no error");
  EXPECT_NE(error_of_text("time,j0\n0,0\n1,1\n1,2\n", "a.csv"), "no error");
  EXPECT_NE(error_of_text("time,j0\n0,0\n1,1\n1,1\n", "a.csv").find("increase strictly"),
            std::string::npos);
  // Two doubles of one nanosecond.
  EXPECT_NE(error_of_text("time,j0\n0,0\n1,1\n1.0000000000000002,2\n", "a.csv"), "no error");
  EXPECT_NE(error_of_text("time,j0\n0,0\n1.0000000001,2\n", "a.csv").find("whole nanoseconds"),
            std::string::npos);
  EXPECT_NE(error_of_text("time,j0\n1,0\n2,2\n", "a.csv"), "no error");
  const std::string message =
      R"({"joint_names": ["j0"], "points": [
        {"positions": [0], "time_from_start": {"sec": 0, "nanosec": 0}},
        {"positions": [1], "time_from_start": {"sec": 1, "nanosec": 5}},
        {"positions": [2], "time_from_start": {"sec": 1, "nanosec": NS}}]})";
  const auto with = [&](const std::string& ns) {
    std::string text = message;
    return text.replace(text.find("NS"), 2, ns);
  };
  EXPECT_EQ(error_of_text(with("6"), "a.json"), "no error");
  EXPECT_NE(error_of_text(with("5"), "a.json"), "no error");
  EXPECT_NE(error_of_text(with("4"), "a.json"), "no error");
}

}  // namespace
}  // namespace firstcontact::test
