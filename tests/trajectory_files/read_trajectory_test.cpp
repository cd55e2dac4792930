#include <array>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/trajectory_files/read_trajectory.h>

#include "scene/crane.h"

namespace firstcontact {
namespace {

using test::crane;

Trajectory parse(const std::string& text, const std::string& file) {
  return parse_trajectory(text, file, crane());
}

void expect_points(const Trajectory& trajectory) {
  EXPECT_EQ(trajectory.joint_names, (std::vector<std::string>{"turn", "lift"}));
  ASSERT_EQ(trajectory.points.size(), 2u);
  EXPECT_EQ(trajectory.points[0].time, 0.0);
  EXPECT_EQ(trajectory.points[0].positions, (std::vector<double>{0.1, -2e-3}));
  EXPECT_EQ(trajectory.points[1].time, 1.5);
  EXPECT_EQ(trajectory.points[1].positions, (std::vector<double>{1.0, 0.5}));
}

void expect_velocities(const Trajectory& trajectory) {
  expect_points(trajectory);
  EXPECT_EQ(trajectory.points[0].velocities, (std::vector<double>{0.0, 0.25}));
  EXPECT_EQ(trajectory.points[1].velocities, (std::vector<double>{3.0, 0.0}));
}

constexpr const char* kOwn = R"({"joint_names": ["turn", "lift"], "points": [
  {"time": 0, "positions": [0.1, -2e-3], "velocities": [0, 0.25]},
  {"time": 1.5, "positions": [1, 0.5], "velocities": [3, 0]}]})";

TEST(ReadTrajectory, TakesOurJson) { expect_velocities(parse(kOwn, "t.json")); }

TEST(ReadTrajectory, TakesOurFormAsYaml) { expect_velocities(parse(kOwn, "t.yaml")); }

TEST(ReadTrajectory, TakesTables) {
  expect_velocities(
      parse("time,turn,lift,turn.velocity,lift.velocity\n"
            "0,0.1,-2e-3,0,.25\n"
            "1.5,1,5e-1,+3,0\n",
            "t.csv"));
}

TEST(ReadTrajectory, TakesTablesAsOtherProgramsWriteThem) {
  expect_points(
      parse("\xef\xbb\xbf# \"turn\" , \"time\",lift\r\n\r\n 0.1,0, -2e-3\r\n1,1.5,0.5", "T.CSV"));
}

// As `rostopic echo` prints it, with quotes, an empty document at the end, and what we do not need.
TEST(ReadTrajectory, TakesYamlOfTheFirstRos) {
  expect_velocities(parse(R"(header:
  seq: 1
  stamp: {secs: 0, nsecs: 0}
  frame_id: "base"
joint_names:
  - turn
  - 'lift'
points:
  -
    positions: [0.1, -0.002]
    velocities: [0.0, 0.25]
    accelerations: []
    effort: []
    time_from_start:
      secs: 0
      nsecs:         0
  -
    positions: [1.0, 0.5]
    velocities: [3.0, 0.0]
    accelerations: []
    effort: []
    time_from_start:
      secs: 1
      nsecs: 500000000
---
)",
                          "t.yaml"));
}

TEST(ReadTrajectory, TakesYamlOfTheSecondRosInsideOfMoveItMessages) {
  const std::string message = R"(
joint_names: [turn, lift]
points:
- positions: &start [0.1, -0.002]
  time_from_start: {sec: 0, nanosec: 0}
- positions: [1, 0.5]
  time_from_start: {sec: 1, nanosec: 500000000}
)";
  std::string indented = message;
  for (std::size_t at = 0; (at = indented.find('\n', at)) != std::string::npos; at += 5) {
    indented.replace(at, 1, "\n    ");
  }
  expect_points(parse(message, "t.yml"));
  expect_points(parse("joint_trajectory:" + indented, "t.yaml"));
  expect_points(parse("trajectory:\n  joint_trajectory:" + indented +
                          "\n  multi_dof_joint_trajectory: {points: []}\n",
                      "t.yaml"));
  expect_points(parse("model_id: crane\ntrajectory:\n- joint_trajectory:" + indented, "t.yaml"));
}

TEST(ReadTrajectory, RoundsNanosecondsOnce) {
  const Trajectory trajectory = parse(R"({"joint_names": ["turn"], "points": [
    {"time_from_start": {"secs": 3, "nsecs": 100000001}, "positions": [1]},
    {"time_from_start": 4.25, "positions": [2]}]})",
                                      "t.json");
  EXPECT_EQ(trajectory.points[0].time, 3.100000001);
  EXPECT_EQ(trajectory.points[1].time, 4.25);
}

TEST(ReadTrajectory, KnowsThreeCoordinatesOfAPlanarJoint) {
  const Trajectory trajectory = parse("time,rail/x,rail/y,rail/theta\n0,1,2,3\n", "t.csv");
  const TrajectoryMotion motion = joint_motions(crane(), trajectory, {}, 1.0);
  const auto& path = std::get<PlanarPath>(motion.joints.at("rail"));
  EXPECT_EQ(path[0].segments()[0].a[0].hi, 1.0);
  EXPECT_EQ(path[1].segments()[0].a[0].hi, 2.0);
  EXPECT_EQ(path[2].segments()[0].a[0].hi, 3.0);
}

struct MalformedText {
  std::string file;
  std::string text;
  std::string message;
};

void expect_trajectory_messages(const std::vector<MalformedText>& cases) {
  for (const auto& [file, text, message] : cases) {
    try {
      (void)parse(text, file);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const ParseError& error) {
      EXPECT_EQ(error.what(), message) << text;
    }
  }
}

/// Returns a trajectory of the joint "turn" with these points.
MalformedText points(const std::string& points, const std::string& message) {
  return {"t", R"({"joint_names": ["turn"], "points": [)" + points + "]}", "t.json:1: " + message};
}

TEST(MalformedTrajectory, NamesWhatIsWrongWithNames) {
  const std::string joints =
      "\"turn\", \"lift\", \"rail/x\", \"rail/y\", \"rail/theta\", \"follow\"";
  expect_trajectory_messages({
      {"t.json", R"({"joint_names": ["trun"], "points": []})",
       "t.json:1: joint_names[0]: expected a joint of the robot, got \"trun\"; did you mean "
       "\"turn\"?"},
      {"t.json", R"({"joint_names": ["knee"], "points": []})",
       "t.json:1: joint_names[0]: expected a joint of the robot, got \"knee\"; it has " + joints},
      {"t.yaml", "joint_names:\n- turn\n- turn\npoints: []\n",
       "t.yaml:3: joint_names[1]: expected each joint once, got \"turn\" again"},
      {"t.json", R"({"joint_names": ["weld"], "points": [{"time": 0, "positions": [0]}]})",
       "t.json:1: joint_names: expected a joint that moves, got fixed ones alone"},
      {"t.json", R"({"joint_names": ["turn", "weld"], "points": [{"time": 0, "positions": [0, 0]},
        {"time": 1, "positions": [0, 1]}]})",
       "t.json:1: joint_names: expected joint \"weld\" at rest, as it is fixed in the URDF, got 0, "
       "then 1"},
      {"t.json", R"({"joint_names": ["turn", "weld", "weld"], "points": []})",
       "t.json:1: joint_names[2]: expected each joint once, got \"weld\" again"},
      {"t.json", R"({"joint_names": ["rail"], "points": []})",
       "t.json:1: joint_names[0]: joint \"rail\": expected one coordinate of this planar joint: "
       "NAME/x, NAME/y or NAME/theta"},
      {"t.json", R"({"joint_names": [], "points": []})",
       "t.json:1: joint_names: expected at least one joint name, got none"},
      {"t.json", R"({"joint_names": ["turn"], "point": []})",
       "t.json:1: point: unknown key; did you mean \"points\"?"},
      {"t.json", "{}", "t.json:1: expected a key \"joint_names\", got none"},
      {"t.json", "[]", "t.json:1: expected one trajectory, got 0; give each a file of its own"},
      {"t.json", "7",
       "t.json:1: expected a trajectory, an object with \"joint_names\" and \"points\", got 7"},
      {"t.yaml", "trajectory:\n- {}\n- {}\n",
       "t.yaml:2: trajectory: expected one trajectory, got 2; give each a file of its own"},
      {"t.txt", "", "t.txt: expected a trajectory, a .json, .yaml or .csv file"},
  });
}

TEST(MalformedTrajectory, NamesWhatIsWrongWithPoints) {
  std::vector<MalformedText> cases = {
      points("", "points: expected at least one point, got none"),
      points(R"({"time": -1, "positions": [0]})", "points[0].time: expected a number >= 0, got -1"),
      points(R"({"time": 1, "positions": [0]}, {"time": 1, "positions": [0.5]})",
             "points[1]: expected one point at 1 s, got a second one with position 0.5 of \"turn\" "
             "in place of 0"),
      points(
          R"({"time": 1, "positions": [0], "velocities": [1]}, {"time": 1, "positions": [0], "velocities": [2]})",
          "points[1]: expected one point at 1 s, got a second one with velocity 2 of \"turn\" in "
          "place of 1"),
      points(R"({"time": 1, "positions": [0]}, {"time": 0.5, "positions": [0]})",
             "points[1]: expected a time later than the one before, 1 s, got 0.5 s"),
      points(R"({"positions": [0]})",
             "points[0]: expected \"time\" [s] or \"time_from_start\", got neither"),
      points(R"({"time": 0, "time_from_start": 0, "positions": [0]})",
             "points[0]: expected \"time\" [s] or \"time_from_start\", got both"),
      points(R"({"time_from_start": {"secs": 0.5}, "positions": [0]})",
             "points[0].time_from_start.secs: expected an integer from 0 to 2147483647, got 0.5"),
      points(R"({"time_from_start": {"sec": 0, "nanosec": 1000000000}, "positions": [0]})",
             "points[0].time_from_start.nanosec: expected an integer from 0 to 999999999, got "
             "1000000000"),
      points(R"({"time_from_start": {}, "positions": [0]})",
             "points[0].time_from_start: expected \"secs\" and \"nsecs\", or \"sec\" and "
             "\"nanosec\", got neither"),
      points(R"({"time": 0, "positions": [0, 1]})",
             "points[0].positions: expected a number for each of the 1 joint names, got 2"),
      points(R"({"time": 0})",
             "points[0]: expected \"positions\", a number for each of the 1 joint names, got none"),
      points(R"({"time": 0, "positions": [1e9]})",
             "points[0].positions[0]: expected a number of at most 1e8 in size, got 1000000000"),
      points(R"({"time": 0, "positions": [0], "velocity": [0]})",
             "points[0].velocity: unknown key; did you mean \"velocities\"?"),
      points(R"({"time": 0, "positions": [0], "accelerations": [0]})",
             "points[0].accelerations: expected \"velocities\" beside \"accelerations\", got none"),
      points(R"({"time": 0, "positions": [0]}, {"time": 1, "positions": [0], "velocities": [0]})",
             "points[1]: expected \"velocities\" in all points or in none, got them here and not "
             "in the first"),
  };
  for (MalformedText& malformed : cases) {
    malformed.file = "t.json";
  }
  expect_trajectory_messages(cases);
}

TEST(MalformedTrajectory, NamesWhatIsWrongWithYaml) {
  const std::string names = "joint_names: [turn]\npoints:\n";
  expect_trajectory_messages({
      {"t.yaml", "", "t.yaml:1: expected a YAML document, got none"},
      {"t.yaml", "a: 1\n---\nb: 1\n", "t.yaml:3: expected one YAML document, got a second one"},
      {"t.yaml", "a: 1\na: 2\n", "t.yaml:2: expected each key once, got \"a\" again"},
      {"t.yaml", "a: *b\n", "t.yaml:1: expected YAML: the referenced anchor is not defined"},
      {"t.yaml", "&a [*a]\n",
       "t.yaml:1: expected an alias of something before it, got one of what is around it"},
      {"t.yaml", "a: [1\n", "t.yaml:2: expected YAML: end of sequence flow not found"},
      {"t.yaml", "\xff", "t.yaml:1: expected UTF-8, got other bytes"},
      {"t.yaml", "a: 1\n---\n---\n",
       "t.yaml:1: a: unknown key; known are \"joint_names\", "
       "\"points\", \"header\""},
      // The parser would never come back from this.
      {"t.yaml", std::string(",os\x01\0\0\x02:\f\n+", 11),
       "t.yaml:1: expected text, got a control character"},
      {"t.yaml", "? [a]\n: 1\n", "t.yaml:1: expected a word as key, got a list or map"},
      {"t.yaml", std::string(100, '[') + std::string(100, ']'),
       "t.yaml:1: expected at most 64 lists and maps inside each other, got more"},
      {"t.yaml", names + "- {time: 0, positions: [.nan]}\n",
       "t.yaml:3: points[0].positions[0]: expected a number, got \".nan\""},
      {"t.yaml", names + "- {time: .inf, positions: [0]}\n",
       "t.yaml:3: points[0].time: expected a number, got \".inf\""},
      {"t.yaml", names + "- {time: 0, positions: [nan]}\n",
       "t.yaml:3: points[0].positions[0]: expected a number, got \"nan\""},
      {"t.yaml", names + "- {time: 0, positions: ['1']}\n",
       "t.yaml:3: points[0].positions[0]: expected a number, got \"1\""},
      {"t.yaml", names + "- {time: 0, positions: [1e999]}\n",
       "t.yaml:3: points[0].positions[0]: expected a number, got \"1e999\""},
      {"t.yaml",
       "trajectory:\n  joint_trajectory: {}\n  multi_dof_joint_trajectory: {points: [1]}\n",
       "t.yaml:3: trajectory.multi_dof_joint_trajectory.points: expected no points: joints of "
       "several degrees of freedom do not follow trajectories here; move the robot's \"base\""},
  });
}

TEST(MalformedTrajectory, NamesWhatIsWrongWithTables) {
  expect_trajectory_messages({
      {"t.csv", "", "t.csv:1: expected a header such as time,joint1,joint2, got none"},
      {"t.csv", "turn\n1\n",
       "t.csv:1: expected a column \"time\" [s] in the header, and columns separated by commas, "
       "semicolons, tabs or blanks; got \"turn\""},
      {"t.csv", "time\n1\n", "t.csv:1: expected a column for at least one joint, got none"},
      {"t.csv", "time,turn\n",
       "t.csv:1: expected at least one line of numbers after the header, got none"},
      {"t.csv", "time,trun\n",
       "t.csv:1: column \"trun\": expected a joint of the robot, got \"trun\"; did you mean "
       "\"turn\"?"},
      {"t.csv", "time,turn,turn\n",
       "t.csv:1: column \"turn\": expected each joint once, got it again"},
      {"t.csv", "time,turn,time\n",
       "t.csv:1: column \"time\": expected each column once, got it again"},
      {"t.csv", "time,turn,turn.velocity,turn.velocity\n",
       "t.csv:1: column \"turn.velocity\": expected each column once, got it again"},
      {"t.csv", "time,turn,lift.velocity\n",
       "t.csv:1: column \"lift.velocity\": expected a column \"lift\" of positions, too, got none"},
      {"t.csv", "time,turn,lift,lift.velocity\n",
       "t.csv:1: expected a column \"turn.velocity\", as other joints have one, got none"},
      {"t.csv", "time,turn,turn.acceleration\n",
       "t.csv:1: expected columns NAME.velocity beside NAME.acceleration, got none"},
      {"t.csv", "time,turn\n0,1,2\n",
       "t.csv:2: expected 2 numbers, as the header has columns, got 3; beside decimal commas, "
       "separate columns by ;"},
      {"t.csv", "time,turn\n0,\n",
       "t.csv:2: column \"turn\": expected a number of at most 1e8 in size, got \"\""},
      {"t.csv", "time,turn\n0,nan\n",
       "t.csv:2: column \"turn\": expected a number of at most 1e8 in size, got \"nan\""},
      {"t.csv", "time,turn\n0,1;2\n",
       "t.csv:2: column \"turn\": expected a number of at most 1e8 in size, got \"1;2\""},
      {"t.csv", "time,turn\n-1,0\n",
       "t.csv:2: column \"time\": expected a number >= 0, got \"-1\""},
      {"t.csv", "time,turn\ninf,0\n",
       "t.csv:2: column \"time\": expected a number >= 0, got \"inf\""},
      {"t.csv", "time,turn\n0,0\n\n0,1\n",
       "t.csv:4: column \"time\": expected one point at 0 s, got a second one with position 1 of "
       "\"turn\" in place of 0"},
      {"t.csv", "time,turn\n\n\xff,1\n", "t.csv:3: expected UTF-8, got other bytes"},
  });
}

TEST(ReadTrajectory, TakesMessagesBetweenEmptyDocuments) {
  expect_velocities(parse("---\n" + std::string(kOwn) + "\n---\n---\n", "t.yaml"));
}

TEST(ReadTrajectory, TakesPointsThatStandTwiceOnce) {
  const std::string first = R"({"time": 0, "positions": [0.1, -2e-3]})";
  const std::string last = R"({"time": 1.5, "positions": [1, 0.5]})";
  const Trajectory trajectory = parse(R"({"joint_names": ["turn", "lift"], "points": [)" + first +
                                          "," + first + "," + last + "," + last + "]}",
                                      "t.yaml");
  expect_points(trajectory);
  EXPECT_EQ(
      trajectory.warnings,
      (std::vector<std::string>{"t.yaml: 2 points stand twice, the first at 0 s; taken once"}));
}

TEST(ReadTrajectory, LeavesOutFixedJointsThatRest) {
  const Trajectory trajectory = parse(R"({"joint_names": ["turn", "weld", "lift"], "points": [
    {"time": 0, "positions": [0.1, 7, -2e-3], "velocities": [0, 0, 0.25]},
    {"time": 1.5, "positions": [1, 7, 0.5], "velocities": [3, 0, 0]}]})",
                                      "t.json");
  expect_velocities(trajectory);
  EXPECT_EQ(trajectory.warnings.size(), 1u);
}

TEST(ReadTrajectory, NeedsTheFile) {
  try {
    (void)read_trajectory("no/such.csv", crane());
    ADD_FAILURE() << "accepted";
  } catch (const ParseError& error) {
    EXPECT_STREQ(error.what(), "no/such.csv: expected a trajectory file, found none");
  }
}

}  // namespace
}  // namespace firstcontact
