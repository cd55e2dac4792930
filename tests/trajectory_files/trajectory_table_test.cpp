#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/trajectory_files/read_trajectory.h>

#include "scene/crane.h"

namespace firstcontact {
namespace {

Trajectory parse_table(const std::string& text) {
  return parse_trajectory(text, "t.csv", test::crane());
}

std::string table_error(const std::string& text) {
  try {
    (void)parse_table(text);
  } catch (const ParseError& error) {
    return error.what();
  }
  return "accepted";
}

/// Expects the motion that every table below contains, in any notation.
void expect_the_motion(const Trajectory& trajectory, const std::string& text) {
  EXPECT_EQ(trajectory.joint_names, (std::vector<std::string>{"turn", "lift"})) << text;
  ASSERT_EQ(trajectory.points.size(), 2u) << text;
  EXPECT_EQ(trajectory.points[0].time, 0.0) << text;
  EXPECT_EQ(trajectory.points[0].positions, (std::vector<double>{0.1, -2e-3})) << text;
  EXPECT_EQ(trajectory.points[1].time, 1.5) << text;
  EXPECT_EQ(trajectory.points[1].positions, (std::vector<double>{1.0, 0.5})) << text;
}

/// How a program writes tables.
struct Habit {
  std::string separator;
  bool decimal_comma = false;
  bool quotes_header = false;
  bool quotes_numbers = false;
  bool ends_with_separator = false;
  std::string before = {};          ///< The header.
  std::string header_comment = {};  ///< On the line of the header.
  std::string end = "\n";
  bool last_line_ends = true;
};

std::string written(const Habit& habit) {
  const std::vector<std::vector<std::string>> rows = {
      {"Time", "turn", "lift"}, {"0", "0.1", "-2e-3"}, {"1.5", "1", "0.5"}};
  std::string text = habit.before;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    text += row == 0 ? habit.header_comment : "";
    for (std::size_t k = 0; k < rows[row].size(); ++k) {
      std::string field = rows[row][k];
      for (char& c : field) {
        c = c == '.' && habit.decimal_comma ? ',' : c;
      }
      const bool quoted = row == 0 ? habit.quotes_header : habit.quotes_numbers;
      text += (k == 0 ? "" : habit.separator) + (quoted ? "\"" + field + "\"" : field);
    }
    text += habit.ends_with_separator ? habit.separator : "";
    text += row + 1 < rows.size() || habit.last_line_ends ? habit.end : "";
  }
  return text;
}

// Every separator with every habit beside it gives the same numbers, to the last bit.
TEST(TrajectoryTable, IsReadHoweverItIsWritten) {
  std::vector<Habit> habits;
  for (const std::string separator : {",", ";", "\t", " ", "   ", " , ", " ;\t"}) {
    for (const bool decimal_comma : {false, true}) {
      if (decimal_comma && separator.find(',') != std::string::npos) {
        continue;
      }
      const Habit plain{.separator = separator, .decimal_comma = decimal_comma};
      habits.insert(habits.end(), 9, plain);
      Habit* last = habits.data() + habits.size() - 8;
      last[0].quotes_header = true;
      last[1].quotes_numbers = true;
      last[2].ends_with_separator = true;
      last[3].before = "\xef\xbb\xbf";
      last[4].before = "# recorded by a program, at some time\n\n% and with a comment\n";
      last[5].header_comment = "# ";
      last[6].end = "\r\n";
      last[7].end = "\n\n# between\n";
      last[7].last_line_ends = false;
    }
  }
  EXPECT_EQ(habits.size(), 9u * 12u);
  for (const Habit& habit : habits) {
    const std::string text = written(habit);
    try {
      expect_the_motion(parse_table(text), text);
    } catch (const ParseError& error) {
      ADD_FAILURE() << error.what() << " of\n" << text;
    }
  }
}

TEST(TrajectoryTable, KnowsNamesThatProgramsWrite) {
  const std::string rows = "\n0,0.1,-2e-3\n1.5,1,0.5\n";
  for (const std::string header :
       {"TIME,turn,lift", "time [s],turn [rad],lift [m]", "__time,turn,lift",
        "time_from_start,turn.position,lift.position",
        "__time,/joint_states/turn/position,/joint_states/lift/position"}) {
    expect_the_motion(parse_table(header + rows), header);
  }
}

TEST(TrajectoryTable, HasUnitsOfJointsThatTurnAndThatSlide) {
  const Trajectory trajectory = parse_table(
      "time,rail/x [m],rail/y (m),rail/theta [rad],turn [rad],lift [m],weld "
      "[rad]\n0,1,2,3,1,0,0\n");
  EXPECT_EQ(trajectory.points.at(0).positions, (std::vector<double>{1, 2, 3, 1, 0}));
}

TEST(TrajectoryTable, IsReadAsDataFramesAndNumericArraysAreWritten) {
  expect_the_motion(parse_table(",time,turn,lift\n0,0.0,0.1,-0.002\n1,1.5,1.0,0.5\n"), "an index");
  expect_the_motion(
      parse_table(
          "# time turn lift\n0.000000e+00 1.000000e-01 -2.000000e-03\n1.5e+00 1e+00 5e-01\n"),
      "a header in a comment");
  expect_the_motion(parse_table("sep=;\ntime;turn;lift\n0;0,1;-0,002\n1,5;1;0,5\n"), "sep=");
  expect_the_motion(parse_table("time,turn,lift\r0,0.1,-2e-3\r1.5,1,0.5\r"),
                    "lines that end as of old");
}

TEST(TrajectoryTable, LeavesOutEffortsWithAWarning) {
  const Trajectory trajectory = parse_table(
      "time,turn,turn.effort,lift,/arm/lift/effort\n0,0.1,7,-2e-3,none\n1.5,1,8,0.5,\n");
  expect_the_motion(trajectory, "efforts");
  EXPECT_EQ(
      trajectory.warnings,
      (std::vector<std::string>{"t.csv: efforts are left out: turn.effort, /arm/lift/effort"}));
}

// Numbers are read as in JSON. A number that is too large for a double stays an error.
TEST(TrajectoryTable, TakesNumbersTooSmallForADoubleAsZeros) {
  for (const std::string small : {"1e-400", "-1e-400", "+1,5e-5000", "0,0001e-330"}) {
    expect_the_motion(parse_table("time;turn;lift\n" + small + ";0,1;-2e-3\n1,5;1;0,5\n"), small);
  }
  const Trajectory trajectory = parse_table("time,turn,lift\n0,-1e-400,4.9e-324\n");
  EXPECT_EQ(trajectory.points[0].positions, (std::vector<double>{0.0, 4.9e-324}));
  EXPECT_NE(table_error("time,turn\n0,1e400\n").find("expected a number"), std::string::npos);
}

TEST(TrajectoryTable, HasVelocitiesByBothEndings) {
  for (const std::string header : {"time,turn,turn.velocity", "time,turn,/states/turn/velocity"}) {
    const Trajectory trajectory = parse_table(header + "\n0,0,1\n1,2,3\n");
    EXPECT_EQ(trajectory.points.at(1).velocities, (std::vector<double>{3.0})) << header;
  }
}

TEST(TrajectoryTable, TakesPointsThatStandTwiceOnce) {
  const Trajectory trajectory =
      parse_table("time,turn,lift\n0,0.1,-2e-3\n0,0.1,-2e-3\n1.5,1,0.5\n1.50,1.0,0.5\n1.5,1,0.5\n");
  expect_the_motion(trajectory, "twice");
  EXPECT_EQ(
      trajectory.warnings,
      (std::vector<std::string>{"t.csv: 3 points stand twice, the first at 0 s; taken once"}));
}

TEST(TrajectoryTable, LeavesOutFixedJointsThatRest) {
  const Trajectory trajectory =
      parse_table("time,weld,turn,lift\n0,0.3,0.1,-2e-3\n1.5,0.3,1,0.5\n");
  expect_the_motion(trajectory, "a fixed joint");
  EXPECT_EQ(
      trajectory.warnings,
      (std::vector<std::string>{
          "t.csv: a position is given for a fixed joint, weld; it is where the URDF has it"}));
}

TEST(Table, TakesUnitsOfVelocitiesAndAccelerations) {
  const Trajectory trajectory = parse_table(
      "time [seconds],turn [rad],turn.velocity [rad/s],turn.acceleration [rad/s^2]\n"
      "0,0,1,2\n1,3,4,5\n");
  EXPECT_EQ(trajectory.joint_names, std::vector<std::string>{"turn"});
  EXPECT_EQ(trajectory.points[1].positions, std::vector<double>{3.0});
  EXPECT_EQ(trajectory.points[1].velocities, std::vector<double>{4.0});
  EXPECT_EQ(trajectory.points[1].accelerations, std::vector<double>{5.0});
}

TEST(MalformedTable, SaysTheMend) {
  const std::vector<std::array<std::string, 2>> cases = {
      {"turn;lift\n0;1\n",
       "t.csv:1: expected a column \"time\" [s] in the header, and columns separated by commas, "
       "semicolons, tabs or blanks; got \"turn;lift\""},
      {"0,0.1,0.2\n1,0.3,0.4\n",
       "t.csv:1: expected a column \"time\" [s] in the header, and columns separated by commas, "
       "semicolons, tabs or blanks; got \"0,0.1,0.2\""},
      {"time,turn\n0,0,0,1\n",
       "t.csv:2: expected 2 numbers, as the header has columns, got 4; beside decimal commas, "
       "separate columns by ;"},
      {"time;turn\n0;0,5\n1;1.5\n",
       "t.csv:3: column \"turn\": expected a number with the decimal mark , of those before it, "
       "got "
       "\"1.5\""},
      {"time;turn\n0;1.234,5\n",
       "t.csv:2: column \"turn\": expected a number of at most 1e8 in size, got \"1.234,5\""},
      {"time [ms],turn\n0,0\n",
       "t.csv:1: column \"time [ms]\": expected seconds, got the unit \"ms\"; convert the numbers, "
       "and the name"},
      {"time,turn,turn.velocity [deg/s]\n0,0,0\n",
       "t.csv:1: column \"turn.velocity [deg/s]\": expected velocities in rad/s, as the joint "
       "turns; got the unit \"deg/s\"; convert the numbers, and the name"},
      {"time,lift,lift.acceleration [m/s]\n0,0,0\n",
       "t.csv:1: column \"lift.acceleration [m/s]\": expected accelerations in m/s^2, as it "
       "slides; got the unit \"m/s\"; convert the numbers, and the name"},
      {"time,turn [deg]\n0,0\n",
       "t.csv:1: column \"turn [deg]\": expected positions in rad, as the joint turns; got the "
       "unit \"deg\"; convert the numbers, and the name"},
      {"time,turn [rad/s]\n0,0\n",
       "t.csv:1: column \"turn [rad/s]\": expected positions in rad, as the joint turns; got the "
       "unit \"rad/s\"; name velocities turn.velocity"},
      {"time,lift (m/s)\n0,0\n",
       "t.csv:1: column \"lift (m/s)\": expected positions in m, as it slides; got the unit "
       "\"m/s\"; name velocities lift.velocity"},
      {"time,turn [m]\n0,0\n",
       "t.csv:1: column \"turn [m]\": expected positions in rad, as the joint turns; got the unit "
       "\"m\"; convert the numbers, and the name"},
      {"time,lift [rad]\n0,0\n",
       "t.csv:1: column \"lift [rad]\": expected positions in m, as it slides; got the unit "
       "\"rad\"; convert the numbers, and the name"},
      {"time,rail/theta [m]\n0,0\n",
       "t.csv:1: column \"rail/theta [m]\": expected positions in rad, as the joint turns; got the "
       "unit \"m\"; convert the numbers, and the name"},
      {"time,rail/y [rad]\n0,0\n",
       "t.csv:1: column \"rail/y [rad]\": expected positions in m, as it slides; got the unit "
       "\"rad\"; convert the numbers, and the name"},
      {"%time,field.header.seq,field.name0,field.position0\n1,2,turn,4\n",
       "t.csv:1: expected times in seconds and columns named after joints, got what rostopic echo "
       "-p writes; write a header of \"time\" and the joints, and divide the times by 1e9"},
      {",time,turn\n1,0,0\n",
       "t.csv:2: column \"\": expected 0, as a column without a name counts the rows, got \"1\""},
      {"time,turn,turn.position\n0,0,0\n",
       "t.csv:1: column \"turn.position\": expected each joint once, got it again"},
      {"time,turn,Time\n0,0,0\n",
       "t.csv:1: column \"Time\": expected each column once, got it again"},
      {"time,turn\n0,0\n0,1\n",
       "t.csv:3: column \"time\": expected one point at 0 s, got a second one with position 1 of "
       "\"turn\" in place of 0"},
      {"time,turn\n1,0\n0,1\n",
       "t.csv:3: column \"time\": expected a time later than the one before, 1 s, got 0 s"},
      {"time,weld,turn\n0,0,0\n1,1,1\n",
       "t.csv:3: expected joint \"weld\" at rest, as it is fixed in the URDF, got 0, then 1"},
      {"time,weld\n0,0\n", "t.csv:2: expected a joint that moves, got fixed ones alone"},
  };
  for (const auto& [text, message] : cases) {
    EXPECT_EQ(table_error(text), message) << text;
  }
}

TEST(MalformedTable, ShowsWholeCharactersOfALongLine) {
  std::string line = "x";
  while (line.size() < 100) {
    line += "\xc3\xa4";
  }
  const std::string message = table_error(line + "\n");
  EXPECT_EQ(message.substr(message.find("got ")), "got \"" + line.substr(0, 59) + "\"");
}

// A name that is no joint stays an error, whatever separates the columns.
TEST(MalformedTable, NamesColumnsThatTheRobotDoesNotHave) {
  for (const std::string separator : {",", ";", "\t", " "}) {
    EXPECT_EQ(table_error("time" + separator + "trun\n0" + separator + "0\n"),
              "t.csv:1: column \"trun\": expected a joint of the robot, got \"trun\"; did you "
              "mean \"turn\"?");
  }
}

}  // namespace
}  // namespace firstcontact
