#include <firstcontact/haptic_devices/recording.h>

#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr const char* kPoseColumns = "time_ns,sequence,x,y,z,qw,qx,qy,qz\n";

std::string pose_text(const std::string& lines) {
  return std::string("# firstcontact recording: 1\n") + kPoseColumns + lines;
}

/// The message of the error that a text gives.
std::string refusal(const std::string& text) {
  try {
    (void)parse_recording(text, "hand.csv");
  } catch (const ParseError& error) {
    return error.what();
  }
  return "no error";
}

Recording random_recording(DeviceKind kind, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.capabilities.name = "Inverse3, Ω";
  recording.capabilities.id = "049D";
  recording.capabilities.kind = kind;
  recording.capabilities.sensed = DegreesOfFreedom::all();
  recording.capabilities.driven = DegreesOfFreedom::translation();
  recording.capabilities.buttons = 3;
  recording.capabilities.max_force = 0.1 + 0.2;
  recording.capabilities.friction = 1e-300;
  recording.calibration.scale = 1.0 / 3.0;
  recording.calibration.X_DR.position = {normal(random), normal(random), normal(random)};
  recording.calibration.X_DR.rotation =
      Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
          .normalized();
  for (int i = 0; i < 50; ++i) {
    DeviceState sample;
    if (kind == DeviceKind::pose) {
      sample.X_DH.position = {normal(random), normal(random), normal(random)};
      sample.X_DH.rotation =
          Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
              .normalized();
    }
    sample.linear_rate = {normal(random), normal(random), normal(random)};
    sample.angular_rate = {normal(random), normal(random), normal(random)};
    sample.time_ns = 1'700'000'000'000'000'000 + 250'000 * i;
    sample.sequence = std::numeric_limits<std::uint64_t>::max() - 50 + i;
    sample.buttons = static_cast<std::uint32_t>(random());
    sample.status = static_cast<DeviceStatus>(i % 5);
    recording.samples.push_back(sample);
  }
  return recording;
}

void expect_same(const DeviceState& a, const DeviceState& b) {
  EXPECT_EQ(a.X_DH.position, b.X_DH.position);
  EXPECT_EQ(a.X_DH.rotation.coeffs(), b.X_DH.rotation.coeffs());
  EXPECT_EQ(a.linear_rate, b.linear_rate);
  EXPECT_EQ(a.angular_rate, b.angular_rate);
  EXPECT_EQ(a.time_ns, b.time_ns);
  EXPECT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.buttons, b.buttons);
  EXPECT_EQ(a.status, b.status);
}

TEST(Recording, HasAsManyButtonsAsItsColumnCanPress) {
  const auto buttons_of = [](const std::string& key, const std::string& column) {
    const std::string cell = column.empty() ? "" : ",5";
    return parse_recording("# firstcontact recording: 1\n" + key +
                               "time_ns,sequence,x,y,z,qw,qx,qy,qz" + column +
                               "\n0,1,0,0,0,1,0,0,0" + cell + "\n",
                           "hand.csv")
        .capabilities.buttons;
  };
  EXPECT_EQ(buttons_of("", ""), 0);
  EXPECT_EQ(buttons_of("", ",buttons"), 32);
  EXPECT_EQ(buttons_of("# buttons: 3\n", ",buttons"), 3);
  EXPECT_EQ(buttons_of("# buttons: 3\n", ""), 0);
}

TEST(Recording, HasNoLimitsThatItsHeadDoesNotState) {
  const auto head_of = [](const std::string& keys) {
    return parse_recording("# firstcontact recording: 1\n" + keys +
                               "time_ns,sequence,x,y,z,qw,qx,qy,qz\n0,1,0,0,0,1,0,0,0\n",
                           "hand.csv")
        .capabilities;
  };
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(head_of("# driven: 111000\n").max_force, kInfinite);
  EXPECT_EQ(head_of("# driven: 111000\n").max_stiffness, kInfinite);
  EXPECT_EQ(head_of("# driven: 111000\n").max_torque, 0.0);
  EXPECT_EQ(head_of("# driven: 000001\n").max_torque, kInfinite);
  EXPECT_EQ(head_of("# max_force: 2\n# driven: 111000\n").max_force, 2.0);
  EXPECT_EQ(head_of("").max_force, 0.0);
}

TEST(Recording, ReadsBackToTheSameNumbers) {
  for (const DeviceKind kind : {DeviceKind::pose, DeviceKind::rate}) {
    const Recording written = random_recording(kind, 3);
    const Recording read = parse_recording(write_recording(written), "hand.csv");
    ASSERT_EQ(read.samples.size(), written.samples.size());
    for (std::size_t i = 0; i < read.samples.size(); ++i) {
      expect_same(read.samples[i], written.samples[i]);
    }
    const DeviceCapabilities& a = read.capabilities;
    const DeviceCapabilities& b = written.capabilities;
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.sensed, b.sensed);
    EXPECT_EQ(a.driven, b.driven);
    EXPECT_EQ(a.buttons, b.buttons);
    EXPECT_EQ(a.max_force, b.max_force);
    EXPECT_EQ(a.friction, b.friction);
    EXPECT_EQ(a.workspace_radius, b.workspace_radius);
    EXPECT_EQ(a.silent_after_ns, b.silent_after_ns);
    EXPECT_EQ(read.calibration.scale, written.calibration.scale);
    EXPECT_EQ(read.calibration.X_DR.position, written.calibration.X_DR.position);
    EXPECT_EQ(read.calibration.X_DR.rotation.coeffs(), written.calibration.X_DR.rotation.coeffs());
    EXPECT_EQ(write_recording(read), write_recording(written));
  }
}

TEST(Recording, TakesTheFormsOfOtherPrograms) {
  const Recording recording = parse_recording(
      "\xef\xbb\xbf# firstcontact recording: 1\r\n## by hand\r\n# device:  knob \r\n\r\n"
      "sequence, time_ns, god.x, qz,qy,qx,qw, z,y,x\r\n"
      "7, -5, no number, 0,0,0,1, 3,2,1\r\n## a pause\r\n7,-5,,0,0,0,1,3,2,1\r\n"
      "9,100,,0,0,0,-1,3,2,1",
      "hand.csv");
  EXPECT_EQ(recording.capabilities.name, "knob");
  ASSERT_EQ(recording.samples.size(), 3U);
  EXPECT_EQ(recording.samples[0].X_DH.position, Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(recording.samples[0].time_ns, -5);
  EXPECT_EQ(recording.samples[1].sequence, 7U);  // A repeat.
  EXPECT_EQ(recording.samples[2].sequence, 9U);  // Behind a gap.
  EXPECT_EQ(recording.samples[2].status, DeviceStatus::live);
}

TEST(Recording, NamesLineColumnAndMend) {
  EXPECT_EQ(refusal(""), "hand.csv:1: expected '# firstcontact recording: 1' on the first line");
  EXPECT_EQ(refusal("# firstcontact recording: 2\n"),
            "hand.csv:1: expected version 1 of the format, got '2'");
  EXPECT_EQ(refusal("# firstcontact recording: 1\n# device: a\n"),
            "hand.csv: expected a line of column names, as 'time_ns,sequence,x,...'");
  EXPECT_EQ(refusal(pose_text("")),
            "hand.csv: expected at least one sample below the column names");
  EXPECT_EQ(refusal(pose_text("0,0,a,0,0,1,0,0,0\n")),
            "hand.csv:3: column 3 (x): expected a number of at most 1e6, got 'a'");
  EXPECT_EQ(refusal(pose_text("0,0,nan,0,0,1,0,0,0\n")),
            "hand.csv:3: column 3 (x): expected a number of at most 1e6, got 'nan'");
  EXPECT_EQ(refusal(pose_text("0.5,0,0,0,0,1,0,0,0\n")),
            "hand.csv:3: column 1 (time_ns): expected a whole number of nanoseconds, got '0.5'");
  EXPECT_EQ(refusal(pose_text("0,-1,0,0,0,1,0,0,0\n")),
            "hand.csv:3: column 2 (sequence): expected a whole number >= 0, got '-1'");
  EXPECT_EQ(refusal(pose_text("0,0,0,0,0,1,0,0\n")),
            "hand.csv:3: expected 9 cells as in the line of names, got 8");
  EXPECT_EQ(refusal(pose_text("0,0,0,0,0,2,0,0,0\n")),
            "hand.csv:3: expected a quaternion qw, qx, qy, qz of length 1, got one of length 2; "
            "divide it by its length");
  EXPECT_EQ(refusal(pose_text("0,0,1e6,0,1e6,1,0,0,0\n")),
            "hand.csv:3: expected a position x, y, z of at most 1e6 m in length, got "
            "1414213.562373095; give it in SI units");
  EXPECT_EQ(
      refusal("# firstcontact recording: 1\n# kind: rate\ntime_ns,sequence,vx,vy,vz,wx,wy,wz\n"
              "0,0,0,0,0,1e6,1e6,0\n"),
      "hand.csv:4: expected a rate wx, wy, wz of at most 1e6 rad/s in length, got "
      "1414213.562373095; give it in SI units");
  EXPECT_EQ(refusal(pose_text("5,0,0,0,0,1,0,0,0\n4,1,0,0,0,1,0,0,0\n")),
            "hand.csv:4: time_ns 4 is before that of the line above, 5; sort the lines by time");
  EXPECT_EQ(refusal(pose_text("5,3,0,0,0,1,0,0,0\n6,2,0,0,0,1,0,0,0\n")),
            "hand.csv:4: sequence 2 is less than that of the line above, 3; "
            "give each connection numbers that go on");
  EXPECT_EQ(refusal("# firstcontact recording: 1\ntime_ns,sequence,x,y,z,qw,qx,qy\n"),
            "hand.csv:2: column 'qz' is missing, which recordings of kind pose have");
  EXPECT_EQ(refusal("# firstcontact recording: 1\ntime_ns,sequence,x,y,z,qw,qx,qy,qz,x\n"),
            "hand.csv:2: column 10 (x): stands twice");
  EXPECT_EQ(refusal("# firstcontact recording: 1\ntime_ns,sequense,x,y,z,qw,qx,qy,qz\n"),
            "hand.csv:2: column 2 (sequense): unknown column; is it 'sequence'?");
  const std::string semicolons =
      "columns are separated by commas, but this line has semicolons; numbers have a point";
  EXPECT_EQ(refusal("# firstcontact recording: 1\ntime_ns;sequence;x;y;z;qw;qx;qy;qz\n"),
            "hand.csv:2: " + semicolons);
  EXPECT_EQ(refusal(pose_text("5;0;0;0;0;1;0;0;0\n")), "hand.csv:3: " + semicolons);
}

TEST(Recording, NamesKeysThatItDoesNotTake) {
  const auto with = [](const std::string& key) {
    return refusal("# firstcontact recording: 1\n# " + key + "\n" + kPoseColumns +
                   "0,0,0,0,0,1,0,0,0\n");
  };
  EXPECT_EQ(with("device: a"), "no error");
  EXPECT_EQ(with("max_force: inf"), "no error");
  EXPECT_EQ(with("max_force: -1"),
            "hand.csv:2: max_force: expected a number >= 0 or inf, got '-1'");
  EXPECT_EQ(with("max_forse: 1"), "hand.csv:2: unknown key 'max_forse'; is it 'max_force'?");
  EXPECT_EQ(with("kind: both"), "hand.csv:2: kind: expected pose or rate, got 'both'");
  EXPECT_EQ(with("sensed: 11111"),
            "hand.csv:2: sensed: expected six digits 0 or 1: along x, y, z and about x, y, z, got "
            "'11111'");
  EXPECT_EQ(with("buttons: 33"),
            "hand.csv:2: buttons: expected a whole number from 0 to 32, got '33'");
  EXPECT_EQ(with("calibration_position: 0 0"),
            "hand.csv:2: calibration_position: expected 3 numbers of at most 1e6, with blanks "
            "between them, got '0 0'");
  EXPECT_EQ(with("calibration_quaternion: 1 1 0 0"),
            "hand.csv:2: calibration_quaternion: expected a quaternion w x y z of length 1, got "
            "'1 1 0 0'");
  EXPECT_EQ(with("calibration_scale: 0"),
            "hand.csv:2: calibration_scale: expected a number from 1e-6 to 1e6, got '0'");
  EXPECT_EQ(with("kind: rate\n# kind: pose"), "hand.csv:3: the key 'kind' stands twice");
  EXPECT_EQ(with("a remark"),
            "hand.csv:2: expected '# key: value', got 'a remark'; a comment begins with two signs "
            "##");
}

TEST(Recording, HasColumnsForGrips) {
  Recording recording = random_recording(DeviceKind::pose, 3);
  recording.capabilities.grips = 3;
  recording.capabilities.max_grip_effort = 0.25;
  for (DeviceState& sample : recording.samples) {
    sample.grips[1] = 1e-3 * static_cast<double>(sample.sequence % 1000);
    sample.grips[2] = -0.1;
  }
  const Recording read = parse_recording(write_recording(recording), "hand.csv");
  EXPECT_EQ(read.capabilities.grips, 3);
  EXPECT_EQ(read.capabilities.max_grip_effort, 0.25);
  for (std::size_t k = 0; k < read.samples.size(); ++k) {
    EXPECT_EQ(read.samples[k].grips, recording.samples[k].grips);
  }
  const auto with = [](const std::string& columns, const std::string& cells) {
    return refusal("# firstcontact recording: 1\ntime_ns,sequence,x,y,z,qw,qx,qy,qz," + columns +
                   "\n0,0,0,0,0,1,0,0,0," + cells + "\n");
  };
  EXPECT_EQ(with("grip0", "0.5"), "no error");
  EXPECT_EQ(with("grip0", "nan"),
            "hand.csv:3: column 10 (grip0): expected a number of at most 1e6, got 'nan'");
  EXPECT_EQ(with("grip1", "0"), "hand.csv:2: column 'grip0' is missing: grips count from grip0 on");
  EXPECT_EQ(with("grip0,grip0", "0,0"), "hand.csv:2: column 11 (grip0): stands twice");
  EXPECT_EQ(with("grip16", "0"),
            "hand.csv:2: column 10 (grip16): unknown column; grips have the names grip0 to grip15");
}

TEST(Recording, WritesNoNamesThatCouldNotBeRead) {
  DeviceCapabilities capabilities;
  capabilities.name = "two\nlines";
  EXPECT_THROW((void)recording_head(capabilities), std::invalid_argument);
  capabilities.name = "one line";
  capabilities.max_force = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)recording_head(capabilities), std::invalid_argument);
}

// A quarter turn about z, twice the size, and an offset: by hand.
TEST(Calibration, MapsPosesAndRatesToTheDeviceFrame) {
  DeviceCalibration calibration;
  calibration.scale = 2.0;
  calibration.X_DR.position = {0.0, 0.0, 1.0};
  calibration.X_DR.rotation = Eigen::AngleAxisd(1.5707963267948966, Vector3d::UnitZ());
  DeviceState sample;
  sample.X_DH.position = {1.0, 0.0, 0.0};
  sample.linear_rate = {0.0, 1.0, 0.0};
  sample.angular_rate = {0.0, 0.0, 3.0};
  const DeviceState result = calibrated(sample, calibration);
  EXPECT_TRUE(result.X_DH.position.isApprox(Vector3d(0.0, 2.0, 1.0), 1e-15));
  EXPECT_TRUE(result.linear_rate.isApprox(Vector3d(-2.0, 0.0, 0.0), 1e-15));
  EXPECT_TRUE(result.angular_rate.isApprox(Vector3d(0.0, 0.0, 3.0), 1e-15));
  EXPECT_NEAR(result.X_DH.rotation.angularDistance(calibration.X_DR.rotation), 0.0, 1e-15);
}

}  // namespace
}  // namespace firstcontact
