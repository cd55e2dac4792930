// Results of scenes with tracking errors: the tool's own are proven, falsified ones are not.

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include <firstcontact/text/write_json.h>
#include <firstcontact/verification/verify_result.h>

#include "scene/robot_text.h"
#include "support/random.h"
#include "support/rounds.h"
#include "verification/checked_scene.h"

namespace firstcontact::test {
namespace {

using detail::write_json;

constexpr const char* kErrors[] = {"0.0001", "0.001", "0.01", "0.05", "0.3"};

/// A joint of a chain, in the plane or out of it.
std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& type, const std::string& place, const std::string& axis,
                  const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + place + "'/><axis xyz='" + axis +
         "'/><limit lower='-3' upper='3' velocity='9' effort='1'/>" + more + "</joint>";
}

std::string link(const std::string& name, const std::string& geometry, const std::string& place) {
  return "<link name='" + name + "'><collision><origin xyz='" + place + "'/><geometry>" + geometry +
         "</geometry></collision></link>";
}

/// A scene of a robot whose joints "a" and "c" go from -1.5 and `from` to 1.5 and `to`, past a
/// ball.
std::string past_ball(const std::string& error, double from, double to, const std::string& ball) {
  return R"({"firstcontact": 1, "bodies": [{"name": "ball", "shape": {"sphere": {"radius": 0.1}},
    "pose": {"position": )" +
         ball + R"(}}], "robots": [{"name": "g", "urdf": "two.urdf", "tracking_error": )" + error +
         R"(, "trajectory": {"joint_names": ["a", "c"], "points": [
           {"time": 0, "positions": [-1.5, )" +
         write_json(from) + R"(]}, {"time": 1, "positions": [1.5, )" + write_json(to) + "]}]}}]}";
}

class TrackedResult : public ::testing::Test {
 protected:
  void write_robot(const std::string& joints_and_links) const {
    folder_.write("two.urdf", "<robot name='two'><link name='b'/>" + joints_and_links + "</robot>");
  }
  [[nodiscard]] ResultClaims claims(const std::string& scene, bool all_pairs = false) const {
    CheckOptions options;
    options.all_pairs = all_pairs;
    return claims_of(scene, options, folder_.path() / "scene.json");
  }

  ArmFolder folder_;
};

// A sphere moves as its middle: the error counts with the lever of the middle alone.
TEST_F(TrackedResult, ProvesTheContactOfASphereOnOneJoint) {
  write_robot(link("tip", "<sphere radius='0.05'/>", "0.7 0 0") +
              joint("a", "b", "tip", "revolute", "0 0 0", "0 0 1"));
  const std::string scene = R"({"firstcontact": 1, "bodies": [
    {"name": "ball", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0.55, 0, 0]}}],
    "robots": [{"name": "g", "urdf": "two.urdf", "tracking_error": 0.01, "trajectory":
      {"joint_names": ["a"], "points": [{"time": 0, "positions": [-1.5]},
                                        {"time": 1, "positions": [1.5]}]}}]})";
  const ResultClaims found = claims(scene);
  ASSERT_EQ(found.verdict, Verdict::contact);
  const ResultVerification proof = verify_result(found);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  // The distance of the middles, at the angle of the contact, is that of both radii and the error.
  const double angle = -1.5 + 3.0 * found.t;
  const double distance = std::hypot(0.7 * std::cos(angle) - 0.55, 0.7 * std::sin(angle)) - 0.15;
  EXPECT_NEAR(distance, 2.0 * std::sin(0.005) * 0.7, 1.1e-6);
}

TEST_F(TrackedResult, ProvesResultsOfTwoJoints) {
  struct Robot {
    std::string text;
    std::string ball;
  };
  const std::string upper = "<link name='l1'/>";
  const std::array<Robot, 5> robots{{
      {upper + link("l2", "<sphere radius='0.05'/>", "0.3 0 0") +
           joint("a", "b", "l1", "revolute", "0 0 0", "0 0 1") +
           joint("c", "l1", "l2", "revolute", "0.4 0 0", "0 0 1"),
       "[0.55, 0, 0]"},
      // A box far along its axis: the error counts by the distance from the axis.
      {upper + link("l2", "<box size='0.3 0.05 0.1'/>", "0.3 0 2") +
           joint("a", "b", "l1", "revolute", "0 0 -2", "0 0 1") +
           joint("c", "l1", "l2", "revolute", "0.4 0 0", "0.2 0 1"),
       "[0.5, 0, 0]"},
      {upper + link("l2", "<cylinder radius='0.05' length='0.3'/>", "0.3 0 0") +
           joint("a", "b", "l1", "revolute", "0 0 0", "0 0 1") +
           joint("c", "l1", "l2", "prismatic", "0.3 0 0", "0.3 0.1 0"),
       "[0.5, 0, 0]"},
      // Two links of one robot, of which one mimics.
      {link("l1", "<box size='0.4 0.05 0.05'/>", "0.2 0 0") +
           link("l2", "<sphere radius='0.05'/>", "0.3 0 0") +
           link("l3", "<box size='0.3 0.04 0.02'/>", "0.15 0 0") +
           joint("a", "b", "l1", "revolute", "0 0 0", "0 0 1") +
           joint("c", "l1", "l2", "revolute", "0.4 0 0", "0 0 1") +
           joint("m", "l2", "l3", "revolute", "0.3 0 0", "0 0 1",
                 "<mimic joint='c' multiplier='-1.5'/>"),
       "[0.62, 0.1, 0]"},
      {upper + link("l2", "<sphere radius='0.05'/>", "0.3 0 0") +
           joint("a", "b", "l1", "continuous", "0 0 0", "0.1 0 1") +
           joint("c", "l1", "l2", "continuous", "0.4 0 0.1", "0 1 0"),
       "[0.55, 0, 0]"},
  }};
  Random random(7);
  std::size_t contacts = 0;
  for (const Robot& robot : robots) {
    write_robot(robot.text);
    for (const char* error : kErrors) {
      for (int k = 0; k < rounds(12, 4); ++k) {
        const double from = random.uniform(-2.0, 2.0);
        const double to = random.uniform(-2.0, 2.0);
        const ResultClaims found = claims(past_ball(error, from, to, robot.ball), k % 2 == 0);
        const ResultVerification proof = verify_result(found);
        EXPECT_EQ(proof.verdict, ProofVerdict::proven)
            << robot.text << '\n'
            << error << ' ' << from << ' ' << to << ": " << proof.problem;
        contacts += found.verdict == Verdict::contact ? 1 : 0;
      }
    }
  }
  EXPECT_GT(contacts, 30u);
}

// Errors do not excuse a contact that is far away, or one that comes too late.
TEST_F(TrackedResult, RefutesWhatErrorsDoNotExplain) {
  write_robot("<link name='l1'/>" + link("l2", "<sphere radius='0.05'/>", "0.3 0 0") +
              joint("a", "b", "l1", "revolute", "0 0 0", "0 0 1") +
              joint("c", "l1", "l2", "revolute", "0.4 0 0", "0 0 1"));
  for (const char* error : {"0", "0.0001", "0.001", "0.01", "0.05"}) {
    const ResultClaims found = claims(past_ball(error, 0.1, -0.1, "[0.55, 0, 0]"));
    ASSERT_EQ(found.verdict, Verdict::contact);
    for (const double share : {0.0, 0.5, 0.95}) {
      ResultClaims other = found;
      other.t = share * found.t;
      other.time = share * found.time;
      EXPECT_EQ(verify_result(other).verdict, ProofVerdict::refuted) << error << ' ' << share;
    }
    ResultClaims later = found;  // Within the errors the two may be apart until then.
    later.t = 1.1 * found.t;
    later.time = 1.1 * found.time;
    EXPECT_NE(verify_result(later).verdict, ProofVerdict::proven) << error;
  }
}

// Until the contact the nominal motion may come closer than the errors are at the contact.
TEST_F(TrackedResult, ClaimsNoClearanceOfErrorsAtTheContact) {
  write_robot("<link name='l1'/>" + link("l2", "<sphere radius='0.05'/>", "0 0 0") +
              joint("a", "b", "l1", "revolute", "0 0 0", "0 0 1") +
              joint("c", "l1", "l2", "prismatic", "0 0 0", "1 0 0"));
  const std::string scene = R"({"firstcontact": 1, "bodies": [
    {"name": "near", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0, 0, 0.1501]}},
    {"name": "far", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [2, 0, 0]}}],
    "robots": [{"name": "g", "urdf": "two.urdf", "tracking_error": {"a": 0.005}, "trajectory":
      {"joint_names": ["a", "c"], "points": [{"time": 0, "positions": [0, 0]},
                                             {"time": 1, "positions": [0, 1.9]}]}}]})";
  const ResultClaims found = claims(scene);
  ASSERT_EQ(found.verdict, Verdict::contact);
  ASSERT_GT(found.t, 0.5);
  EXPECT_LE(found.clearance, 0.0001);  // At the start the ball "near" is that close.
  EXPECT_EQ(verify_result(found).verdict, ProofVerdict::proven);
}

}  // namespace
}  // namespace firstcontact::test
