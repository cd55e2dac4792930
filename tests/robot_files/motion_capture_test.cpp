// Captured figures: the files are read as their formats say, and what moves between frames is what
// motion_capture.h says.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/robot_files/read_amc.h>
#include <firstcontact/robot_files/read_asf.h>
#include <firstcontact/robot_files/read_bvh.h>
#include <firstcontact/text/parse_error.h>

#include "support/data_dir.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

/// hips - thigh - shin along -y, and an arm aside; two frames.
const std::string kBvh = R"(HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT thigh
  {
    OFFSET 10 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT shin
    {
      OFFSET 0 -40 0
      CHANNELS 1 Xrotation
      End Site { OFFSET 0 -30 0 }
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.01
0 100 0  0 0 0   0 0 0  0
20 100 0  0 0 90  90 0 0  -90
)";

const std::string kAsf = R"(# an arm
:version 1.10
:units
  mass 1.0
  length 0.5
  angle deg
:documentation
   a word of thanks
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name spine
     direction 0 1 0
     length 10
     axis 0 0 0 XYZ
  end
  begin
     id 2
     name upper
     direction 2 0 0
     length 5
     axis 0 0 90 XYZ
     dof rx rz
     limits (-160.0 20.0)
            (-inf inf)
  end
  begin
     id 3
     name fore
     direction 1 0 0
     length 4
     axis 0 0 0 XYZ
     dof ry
  end
:hierarchy
  begin
    root spine
    spine upper
    upper fore
  end
)";

const std::string kAmc = R"(#!OML:ASF
:FULLY-SPECIFIED
:DEGREES
1
root 0 0 0 0 0 0
upper 0 0
fore 0
2
root 1 2 3 0 90 0
upper 0 90
fore 90
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

template <class Read>
std::string capture_error(const Read& read) {
  try {
    read();
  } catch (const ParseError& error) {
    return error.what();
  }
  return "no error";
}

std::string bvh_error(const std::string& text) {
  return capture_error([&] { (void)parse_bvh(text, "f.bvh"); });
}
std::string asf_error(const std::string& text) {
  return capture_error([&] { (void)parse_asf(text, "f.asf"); });
}
std::string amc_error(const std::string& text) {
  const AsfSkeleton skeleton = parse_asf(kAsf, "f.asf");
  return capture_error([&] { (void)parse_amc(text, "f.amc", skeleton); });
}

/// A point of a bone, in the world.
Vector3d place(const RobotMotion& motion, const std::string& bone, double t,
               const Vector3d& p_BP = Vector3d::Zero()) {
  const LinkMotion link = motion.link(motion.model().find_link(bone).value());
  const LinkPose pose = link.at(t).pose(t);
  return pose.p_OL + pose.R_FL * p_BP;
}

void expect_near(const Vector3d& a, const Vector3d& b) {
  EXPECT_LE((a - b).norm(), 1e-12) << a.transpose() << " against " << b.transpose();
}

/// In closed form: units of centimetres, channels multiplied from left to right.
TEST(ReadBvh, PutsBonesWhereTheFileSays) {
  const MotionCapture capture = parse_bvh(kBvh, "f.bvh");
  EXPECT_EQ(capture.frame_time, 0.01);
  ASSERT_EQ(capture.frames.size(), 2u);
  const RobotModel figure = make_figure(capture);
  ASSERT_EQ(figure.links().size(), 3u);
  const RobotMotion motion = capture_motion(figure, capture, 0, 1);
  expect_near(place(motion, "shin", 0.0, {0.0, -0.3, 0.0}), {0.1, 0.3, 0.0});
  // The hips turn by 90 degrees about y: x goes to -z. The thigh turns about z: -y goes to x. The
  // shin turns by -90 degrees about x: its -y goes to z.
  expect_near(place(motion, "thigh", 1.0), {0.2, 1.0, -0.1});
  expect_near(place(motion, "shin", 1.0), {0.2, 1.0, -0.5});
  expect_near(place(motion, "shin", 1.0, {0.0, -0.3, 0.0}), {0.5, 1.0, -0.5});
}

/// The turns of a bone are about the axes of its own frame, which `axis` turns.
TEST(ReadAsfAmc, PutsBonesWhereTheFilesSay) {
  const AsfSkeleton skeleton = parse_asf(kAsf, "f.asf", {.unit_length = 0.01});
  EXPECT_EQ(skeleton.unit_length, 0.02);
  const MotionCapture capture = parse_amc(kAmc, "f.amc", skeleton, 0.02);
  const RobotModel figure = make_figure(capture);
  EXPECT_EQ(figure.joints()[0].type, JointType::fixed);
  EXPECT_EQ(figure.joints()[1].type, JointType::ball);
  const RobotMotion motion = capture_motion(figure, capture, 0, 1);
  expect_near(place(motion, "upper", 0.0), {0.0, 0.2, 0.0});
  expect_near(place(motion, "fore", 0.0), {0.1, 0.2, 0.0});
  expect_near(place(motion, "fore", 0.0, {0.08, 0.0, 0.0}), {0.18, 0.2, 0.0});
  // The root turns x to -z; before that, the upper arm turns about z from x to y, and the forearm
  // about the y that goes with it, which is then -x: from y to -z... of the root, so to -x.
  expect_near(place(motion, "upper", 1.0), {0.02, 0.24, 0.06});
  expect_near(place(motion, "fore", 1.0), {0.02, 0.34, 0.06});
  expect_near(place(motion, "fore", 1.0, {0.08, 0.0, 0.0}), {0.02 - 0.08, 0.34, 0.06});
}

TEST(CaptureMotion, TurnsAtConstantRatesBetweenFrames) {
  const MotionCapture capture = parse_bvh(kBvh, "f.bvh");
  const RobotMotion motion = capture_motion(make_figure(capture), capture, 0, 1);
  // The root's position is linear, and a third of 90 degrees about y takes (0.1, 0, 0) there.
  const double a = std::numbers::pi / 6.0;
  expect_near(place(motion, "thigh", 1.0 / 3.0),
              {0.2 / 3.0 + 0.1 * std::cos(a), 1.0, -0.1 * std::sin(a)});
}

TEST(CaptureMotion, PlacesTheCaptureInTheWorld) {
  const MotionCapture capture = parse_bvh(kBvh, "f.bvh");
  const RobotModel figure = make_figure(capture);
  const Pose X_WC{{1.0, 2.0, 3.0},
                  Eigen::Quaterniond(Eigen::AngleAxisd(1.2, Vector3d(1, 2, 3).normalized()))};
  const RobotMotion plain = capture_motion(figure, capture, 0, 1);
  const RobotMotion placed = capture_motion(figure, capture, 0, 1, X_WC);
  for (const double t : {0.0, 0.4, 1.0}) {
    expect_near(place(placed, "shin", t), X_WC.position + X_WC.rotation * place(plain, "shin", t));
  }
}

TEST(CaptureMotion, RefusesFramesThatAreNotThere) {
  const MotionCapture capture = parse_bvh(kBvh, "f.bvh");
  const RobotModel figure = make_figure(capture);
  EXPECT_THROW((void)capture_motion(figure, capture, 0, 2), std::invalid_argument);
  EXPECT_THROW((void)capture_motion(figure, capture, 1, 1), std::invalid_argument);
  MotionCapture other = capture;
  other.bones.pop_back();
  EXPECT_THROW((void)capture_motion(make_figure(other), capture, 0, 1), std::invalid_argument);
}

TEST(MakeFigure, CoversEveryBone) {
  const MotionCapture capture = parse_bvh(kBvh, "f.bvh");
  const RobotModel figure = make_figure(capture, {.slenderness = 0.5, .greatest_radius = 0.06});
  const LinkGeometry& thigh = figure.links()[1].collision.at(0);
  EXPECT_EQ(std::get<CapsuleGeometry>(thigh.source).radius, 0.06);
  EXPECT_EQ(std::get<CapsuleGeometry>(thigh.source).length, 0.4);
  // Its ends are the joint and the next one.
  for (const double z : {-0.2, 0.2}) {
    const Vector3d end = thigh.X_LG.position + thigh.X_LG.rotation * Vector3d(0.0, 0.0, z);
    EXPECT_LE(std::min(end.norm(), (end - Vector3d(0.0, -0.4, 0.0)).norm()), 1e-15);
  }
  EXPECT_THROW((void)make_figure(capture, {.least_radius = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)make_figure(capture, {.slenderness = NAN}), std::invalid_argument);
  EXPECT_THROW((void)make_figure({}), std::invalid_argument);
}

TEST(ReadBvh, NamesWhatIsWrongAndWhere) {
  EXPECT_EQ(bvh_error(""), "f.bvh:1: expected 'HIERARCHY', got the end");
  EXPECT_EQ(bvh_error(replaced(kBvh, "10 0 0", "10 nan 0")),
            "f.bvh:8: expected an offset, a number within 1e9, got 'nan'");
  EXPECT_EQ(bvh_error(replaced(kBvh, "JOINT shin", "JOINT thigh")),
            "f.bvh:10: joint 'thigh' is there twice");
  EXPECT_EQ(bvh_error(replaced(kBvh, "1 Xrotation", "1 Wrotation")),
            "f.bvh:13: expected a channel, such as Xrotation, got 'Wrotation'");
  EXPECT_EQ(bvh_error(replaced(kBvh, "1 Xrotation", "1 Xposition")),
            "f.bvh:13: joint 'shin' has a position channel; only the root's are known");
  EXPECT_EQ(bvh_error(replaced(kBvh, "6 Xpos", "7 Xpos")),
            "f.bvh:5: expected at most 6 channels, got 7");
  EXPECT_EQ(bvh_error(replaced(kBvh, "Time: 0.01", "Time: 0")),
            "f.bvh:20: expected a frame time greater than 0");
  EXPECT_EQ(bvh_error(replaced(kBvh, "Frames: 2", "Frames: 3")),
            "f.bvh:23: expected a value of joint 'hips' in frame 3, a number within 1e9, got the "
            "end");
  EXPECT_EQ(bvh_error(replaced(kBvh, "Frames: 2", "Frames: 1")),
            "f.bvh:22: expected the end after 1 frames, got '20'");
  EXPECT_EQ(bvh_error(replaced(kBvh, "}\nMOTION", "MOTION")),
            "f.bvh:17: expected CHANNELS, JOINT, End Site or }, got 'MOTION'");
  EXPECT_THROW((void)parse_bvh(kBvh, "f.bvh", {.unit_length = 0.0}), std::invalid_argument);
}

TEST(ReadAsfAmc, NamesWhatIsWrongAndWhere) {
  EXPECT_EQ(asf_error(""), "f.asf:1: expected a section :hierarchy, got the end");
  EXPECT_EQ(asf_error(replaced(kAsf, "axis 0 0 90 XYZ", "axis 0 0 90 ZYX")),
            "f.asf:27: expected 'XYZ', got 'ZYX'");
  EXPECT_EQ(asf_error(replaced(kAsf, "dof ry", "dof tx")),
            "f.asf:38: expected rx, ry or rz: bones turn only, got 'tx'");
  EXPECT_EQ(asf_error(replaced(kAsf, "name fore", "name upper")),
            "f.asf:38: expected a bone of a name of its own, got 'upper'");
  EXPECT_EQ(asf_error(replaced(kAsf, "    upper fore\n", "")),
            "f.asf:44: only 2 of 3 bones are in the hierarchy");
  EXPECT_EQ(asf_error(replaced(kAsf, "upper fore", "upper hand")),
            "f.asf:44: the hierarchy names an unknown bone 'hand'");
  EXPECT_EQ(asf_error(replaced(kAsf, "upper fore", "upper fore upper")),
            "f.asf:44: bone 'upper' is in the hierarchy twice");
  EXPECT_EQ(asf_error(replaced(kAsf, "length 5", "lenght 5")),
            "f.asf:26: expected a line of a bone, such as direction, got 'lenght'");
  EXPECT_EQ(asf_error(replaced(kAsf, "TX TY TZ", "TX TY TY")),
            "f.asf:10: expected each of TX TY TZ RX RY RZ once, got 'TY'");
  EXPECT_EQ(amc_error(replaced(kAmc, "upper 0 90\n", "")),
            "f.amc:10: bone 'upper' is missing in frame 2");
  EXPECT_EQ(amc_error(replaced(kAmc, "upper 0 90", "uper 0 90")),
            "f.amc:10: expected a bone of the skeleton, got 'uper'");
  EXPECT_EQ(amc_error(replaced(kAmc, "fore 90", "fore 90 3")),
            "f.amc:11: bone 'root' is missing in frame 3");
  EXPECT_EQ(amc_error(replaced(kAmc, "\n2\n", "\n3\n")), "f.amc:8: expected frame 2, got 3");
  EXPECT_EQ(amc_error(replaced(kAmc, "fore 90", "fore inf")),
            "f.amc:11: expected a value of bone 'fore', a number within 1e9, got 'inf'");
  const AsfSkeleton skeleton = parse_asf(kAsf, "f.asf");
  EXPECT_THROW((void)parse_amc(kAmc, "f.amc", skeleton, 0.0), std::invalid_argument);
  EXPECT_THROW((void)read_asf("no/such.asf"), ParseError);
}

/// A walk as it was captured: a person's size, feet on one floor, no jumps between frames.
TEST(ReadAsfAmc, ReadsAWalk) {
  if (data_dir().empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const AsfSkeleton skeleton = read_asf(data_dir() / "mocap/cmu/02.asf");
  const MotionCapture walk = read_amc(data_dir() / "mocap/cmu/02_01.amc", skeleton);
  const RobotModel figure = make_figure(walk);
  ASSERT_EQ(figure.links().size(), 31u);
  ASSERT_GT(walk.frames.size(), 300u);
  double lowest = 1e9;
  double highest_foot = -1e9;
  for (std::size_t k = 0; k + 1 < walk.frames.size(); k += 10) {
    const RobotMotion motion = capture_motion(figure, walk, k, k + 1);
    const double foot = std::min(place(motion, "ltoes", 0.0).y(), place(motion, "rtoes", 0.0).y());
    lowest = std::min(lowest, foot);
    highest_foot = std::max(highest_foot, foot);
    const double head = place(motion, "head", 0.0).y() - foot;
    EXPECT_GT(head, 1.3) << k;
    EXPECT_LT(head, 1.9) << k;
    for (const char* bone : {"head", "lhand", "rhand", "lfoot", "rfoot"}) {
      EXPECT_LT((place(motion, bone, 1.0) - place(motion, bone, 0.0)).norm(), 0.06) << bone << k;
    }
  }
  EXPECT_LT(highest_foot - lowest, 0.08);
}

}  // namespace
}  // namespace firstcontact::test
