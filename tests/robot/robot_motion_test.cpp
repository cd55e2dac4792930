// A robot's motion needs a motion of the right kind for each joint that moves, and follows it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <firstcontact/robot/robot_motion.h>
#include <firstcontact/robot_files/read_urdf.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr std::array<double, 2> kTimes = {0.0, 1.0};

CoordinatePath ramp(double from, double to, Turning turning = Turning::as_given) {
  const std::array<double, 2> q = {from, to};
  return CoordinatePath::linear(kTimes, q, turning);
}

/// base - upper - fore: two hinges about z, each link 1 m along x; a fixed hand 0.5 m on.
RobotModel arm(JointType first = JointType::revolute) {
  const auto joint = [](const char* name, JointType type, const char* parent, const char* child,
                        double x) {
    Joint result{.name = name, .type = type, .parent = parent, .child = child};
    result.X_PJ.position.x() = x;
    result.axis = Vector3d::UnitZ();
    return result;
  };
  return RobotModel(
      {.name = "arm",
       .links = {{"base", {}, {}}, {"upper", {}, {}}, {"fore", {}, {}}, {"hand", {}, {}}},
       .joints = {joint("shoulder", first, "base", "upper", 0.0),
                  joint("elbow", JointType::revolute, "upper", "fore", 1.0),
                  joint("wrist", JointType::fixed, "fore", "hand", 0.5)}});
}

std::string error_of(const RobotModel& model, const std::map<std::string, JointMotion>& joints) {
  try {
    const RobotMotion motion(model, joints);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

/// Closed form: the elbow's angle counts from the upper arm.
TEST(RobotMotion, MovesAPlanarArm) {
  const RobotMotion motion(arm(), {{"shoulder", ramp(0.0, 1.0)}, {"elbow", ramp(0.5, -1.5)}});
  const LinkMotion hand = motion.link(3);
  for (const double t : {0.0, 0.25, 1.0}) {
    const double a = t;
    const double b = a + 0.5 - 2.0 * t;
    const Vector3d expected(std::cos(a) + 0.5 * std::cos(b), std::sin(a) + 0.5 * std::sin(b), 0.0);
    EXPECT_LE((hand.at(t).pose(t).p_OL - expected).norm(), 1e-15);
  }
}

/// [s]  To make the motion of an arm along so many points, and all its coordinates.
double seconds_for(std::size_t points) {
  std::vector<double> times(points);
  std::vector<double> positions(points);
  for (std::size_t k = 0; k < points; ++k) {
    times[k] = static_cast<double>(k) / static_cast<double>(points - 1);
    positions[k] = std::sin(1e-3 * static_cast<double>(k));
  }
  const CoordinatePath path = CoordinatePath::linear(times, positions);
  const auto start = std::chrono::steady_clock::now();
  const RobotMotion motion(arm(), {{"shoulder", path}, {"elbow", ramp(0.0, 1.0)}});
  EXPECT_EQ(motion.coordinate(0).size(), points - 1);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Sixteen times the points would take 256 times as long if each piece were looked for among all.
TEST(RobotMotion, TakesTimeInProportionToThePoints) {
  const double few = seconds_for(4'000);
  EXPECT_LT(seconds_for(64'000), 100.0 * few + 0.5);
}

// A joint that mimics another follows its new motion; others keep theirs.
TEST(RobotMotion, ChangesTheMotionOfSomeJoints) {
  RobotDescription description{
      .name = "arm",
      .links = {{"base", {}, {}}, {"a", {}, {}}, {"b", {}, {}}, {"c", {}, {}}},
      .joints = {}};
  const char* names[] = {"first", "second", "third"};
  const char* links[] = {"base", "a", "b", "c"};
  for (int k = 0; k < 3; ++k) {
    Joint joint{
        .name = names[k], .type = JointType::revolute, .parent = links[k], .child = links[k + 1]};
    joint.X_PJ.position.x() = 1.0;
    joint.axis = Vector3d::Unit(k);
    description.joints.push_back(joint);
  }
  description.joints[2].mimic = Mimic{.joint = "first", .multiplier = -0.5, .offset = 0.25};
  const RobotModel model(description);
  const RobotMotion before(model, {{"first", ramp(0.0, 1.0)}, {"second", ramp(0.5, -1.5)}});
  const std::array<double, 3> times = {0.0, 0.25, 1.0};
  const std::array<double, 3> places = {0.0, 2.0, 1.0};
  const CoordinatePath bent = CoordinatePath::linear(times, places);
  const RobotMotion anew(model, {{"first", bent}, {"second", ramp(0.5, -1.5)}});
  const RobotMotion changed = before.with({{0, bent}});
  EXPECT_TRUE(std::ranges::equal(changed.breaks(), anew.breaks()));
  for (const double t : {0.0, 0.2, 0.25, 0.7, 1.0}) {
    const auto place = [&](const RobotMotion& motion) { return motion.path(3, t).pose(t).p_OL; };
    EXPECT_EQ(place(changed), place(anew));
  }
  EXPECT_EQ(before.breaks().size(), 2u);
  EXPECT_THROW((void)before.with({{2, bent}}), std::invalid_argument);
  EXPECT_THROW((void)before.with({{0, Motion::fixed()}}), std::invalid_argument);
  EXPECT_THROW((void)before.with({{0, ramp(0.0, 1e9)}}), std::invalid_argument);
}

/// Twists and their bounds, in closed form: a point at radius r of one turning joint.
TEST(RobotMotion, BoundsOfOneHingeAreExact) {
  const RobotMotion motion(
      arm(), {{"shoulder", ramp(0.0, 2.0)}, {"elbow", CoordinatePath::constant(0.0)}});
  const LinkMotion hand = motion.link(3);
  LinkScratch scratch;
  const LinkWindow window = hand.at(0.0).window(0.0, 0.0, 0.01, {}, scratch);
  EXPECT_NEAR(window.bounds().rate, 2.0 * 1.5, 1e-11);
  EXPECT_NEAR(window.bounds().acceleration, 4.0 * 1.5, 1e-10);
  EXPECT_NEAR(window.bounds().jerk, 8.0 * 1.5, 1e-10);
  const DirectedBound across = window.displacement({}, Vector3d::UnitY());
  EXPECT_NEAR(across.speed, 3.0, 1e-11);
  const DirectedBound outwards = window.displacement({}, Vector3d::UnitX());
  EXPECT_NEAR(outwards.speed, 0.0, 1e-11);
  // The acceleration points inwards, and a jerk of 12 for 0.01 adds 0.04.
  EXPECT_NEAR(outwards.acceleration, -6.0 + 0.04, 1e-9);
  // Nothing moves along the axis.
  EXPECT_NEAR(window.displacement({}, Vector3d::UnitZ()).speed, 0.0, 1e-12);
}

TEST(RobotMotion, OneJointMovesNeighboursAgainstEachOtherOnly) {
  const RobotMotion motion(
      arm(), {{"shoulder", ramp(0.0, 100.0)}, {"elbow", CoordinatePath::constant(0.3)}},
      Motion::constant_velocity({}, {1e3, 0, 0}, {0, 50, 0}));
  const RelativeLinkMotion relative = motion.relative(1, 3);
  LinkScratch scratch;
  const RoundedBox ball{.radius = 1.0};
  EXPECT_EQ(relative.A.at(0.5).window(0.5, 0.0, 1.0, ball, scratch).bounds().rate, 0.0);
  EXPECT_EQ(relative.B.at(0.5).window(0.5, 0.0, 1.0, ball, scratch).bounds().rate, 0.0);
  EXPECT_GE(motion.link(3).at(0.5).window(0.5, 0.0, 1.0, ball, scratch).bounds().rate, 1e3);
}

TEST(RobotMotion, TellsWhatItWasGiven) {
  const RobotMotion motion(arm(), {{"shoulder", ramp(0.0, 1.0)}, {"elbow", ramp(0.5, -1.5)}});
  const std::optional<JointMotion> elbow = motion.given(1);
  ASSERT_TRUE(elbow && std::holds_alternative<CoordinatePath>(*elbow));
  EXPECT_EQ(std::get<CoordinatePath>(*elbow).segments()[0].a[1].hi, -2.0);
  EXPECT_FALSE(motion.given(2)) << "a fixed joint";
}

TEST(RobotMotion, NamesTheJointThatDoesNotMatch) {
  const CoordinatePath still = CoordinatePath::constant(0.0);
  EXPECT_EQ(error_of(arm(), {{"shoulder", still}}),
            "RobotMotion: joint 'elbow' has no motion; hold it still by a constant one");
  EXPECT_EQ(error_of(arm(), {{"shoulder", still}, {"elbow", still}, {"knee", still}}),
            "RobotMotion: joint 'knee' is not a joint of the robot 'arm'");
  EXPECT_EQ(error_of(arm(), {{"shoulder", still}, {"elbow", still}, {"wrist", still}}),
            "RobotMotion: joint 'wrist' is fixed; leave out its motion");
  EXPECT_EQ(error_of(arm(), {{"shoulder", Motion::fixed()}, {"elbow", still}}),
            "RobotMotion: joint 'shoulder' is revolute; give it one coordinate");
  EXPECT_EQ(
      error_of(arm(), {{"shoulder", ramp(0.0, 6.0, Turning::shortest)}, {"elbow", still}}),
      "RobotMotion: joint 'shoulder' is not continuous; it cannot take the shortest way round");
  EXPECT_EQ(error_of(arm(JointType::planar), {{"shoulder", still}, {"elbow", still}}),
            "RobotMotion: joint 'shoulder' is planar; give it three coordinates");
  EXPECT_EQ(error_of(arm(JointType::planar),
                     {{"shoulder", PlanarPath{ramp(0.0, 6.0, Turning::shortest), still, still}},
                      {"elbow", still}}),
            "RobotMotion: joint 'shoulder' slides along x and y; only its angle can take the "
            "shortest way round");
  EXPECT_EQ(error_of(arm(JointType::planar),
                     {{"shoulder", PlanarPath{still, still, ramp(0.0, 6.0, Turning::shortest)}},
                      {"elbow", still}}),
            "no error");
  EXPECT_EQ(error_of(arm(JointType::ball),
                     {{"shoulder", Motion::constant_velocity({}, {1, 0, 0})}, {"elbow", still}}),
            "RobotMotion: joint 'shoulder' is a ball; its motion must not move the origin");
  EXPECT_EQ(error_of(arm(JointType::ball),
                     {{"shoulder", Motion::constant_velocity({}, {0, 0, 0}, {1, 2, 3})},
                      {"elbow", still}}),
            "no error");
}

/// Beyond 1e8 rad sines have no error bound.
TEST(RobotMotion, RefusesAnglesWithoutBounds) {
  const CoordinatePath still = CoordinatePath::constant(0.0);
  const std::array<double, 2> q = {0.0, 0.0};
  const std::array<double, 2> v = {9e7, -9e7};
  const std::string far =
      error_of(arm(), {{"shoulder", CoordinatePath::cubic(kTimes, q, v)}, {"elbow", still}});
  EXPECT_NE(far.find("joint 'shoulder' may run beyond 1e8"), std::string::npos) << far;
  RobotDescription geared{
      .name = "geared",
      .links = {{"a", {}, {}}, {"b", {}, {}}, {"c", {}, {}}},
      .joints = {{.name = "wheel", .type = JointType::continuous, .parent = "a", .child = "b"},
                 {.name = "worm", .type = JointType::continuous, .parent = "b", .child = "c"}}};
  geared.joints[1].mimic = Mimic{.joint = "wheel", .multiplier = 1e7, .offset = 0.0};
  const std::string geared_error = error_of(RobotModel(geared), {{"wheel", ramp(0.0, 100.0)}});
  EXPECT_NE(geared_error.find("joint 'worm' may run beyond 1e8"), std::string::npos);
  EXPECT_EQ(error_of(RobotModel(geared), {{"wheel", ramp(0.0, 1.0)}}), "no error");
}

/// The Puma's own geometry: at zero its wrist is 0.4318 m before, 0.4331 m above the shoulder.
TEST(RobotMotion, MovesThePuma) {
  const RobotModel puma = read_urdf(std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) /
                                        "data/robots/puma560_description/urdf/puma560_robot.urdf",
                                    {.package_roots = {}, .shapes = LoadShapes::none});
  std::map<std::string, JointMotion> joints;
  for (const Joint& joint : puma.joints()) {
    joints.emplace(joint.name, ramp(0.0, joint.name == "j1" ? std::numbers::pi : 0.0));
  }
  const RobotMotion motion(puma, joints);
  const std::size_t hand = puma.links().size() - 1;
  const Vector3d start = motion.link(hand).at(0.0).pose(0.0).p_OL;
  const Vector3d end = motion.link(hand).at(1.0).pose(1.0).p_OL;
  // Half a turn about the vertical.
  EXPECT_NEAR(end.x(), -start.x(), 1e-8);
  EXPECT_NEAR(end.y(), -start.y(), 1e-8);
  EXPECT_NEAR(end.z(), start.z(), 1e-8);
  EXPECT_GE(start.head<2>().norm(), 0.1);
}

}  // namespace
}  // namespace firstcontact
