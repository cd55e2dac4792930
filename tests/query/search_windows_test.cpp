// The search in windows of time, which serves bodies that stay close for long: an M16 nut that is
// turned by a sixteenth of a turn on its bolt. Its threads are 0.1 mm apart all the while. The bolt
// turns a little, too: threads that screw_sliding on a body at rest need no windows.

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = -std::numbers::pi / 8.0;                       // [rad]
constexpr double kRightWay = 0.002 * kTurn / (2.0 * std::numbers::pi);  // [m]  The pitch is 2 mm.
constexpr double kWrongWay = 2.4 * kRightWay;
constexpr double kAlong = kTurn / 64.0;        // [rad]  Of the bolt.
constexpr std::uint64_t kPatience = 1u << 17;  // Work after which the search begins a new window.
constexpr int kSamples = 20;

Shape part(const std::string& name) {
  const std::filesystem::path data = std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / "data";
  return Shape(read_mesh(data / "factory" / name));
}

/// @param way  [m]  relative to the bolt, as it turns by kTurn
Motion screwed(double way, double along = kAlong) {
  return Motion::screw({.position = {0.0, 0.0, 0.012}}, Vector3d::Zero(), Vector3d::UnitZ(),
                       kTurn + along, way + kRightWay * along / kTurn);
}

Motion turned_along() {
  return Motion::screw({}, Vector3d::Zero(), Vector3d::UnitZ(), kAlong, kRightWay * kAlong / kTurn);
}

/// The same as waypoints, so near each other that none of the pieces needs a second window.
Motion screwed_by_pieces(double way) {
  constexpr int kPieces = 16;
  const Motion whole = screwed(way);
  std::vector<double> times;
  std::vector<Pose> poses;
  for (int k = 0; k <= kPieces; ++k) {
    times.push_back(static_cast<double>(k) / kPieces);
    poses.push_back(whole.pose(times.back()));
  }
  return Motion::waypoints(times, poses, Between::screw);
}

class SearchWindows : public testing::Test {
 protected:
  FirstContactResult turn(const Motion& motion) {
    return first_contact({nut_, motion}, {bolt_, bolt_motion_}, workspace_, options_);
  }
  double gap(const Motion& motion, double t) {
    return distance({nut_, motion}, {bolt_, bolt_motion_}, t, workspace_).distance;
  }

  Shape nut_ = part("factory_nut_m16_loose_subdiv_3x.obj");
  Shape bolt_ = part("factory_bolt_m16_loose.obj");
  Motion bolt_motion_ = turned_along();
  FirstContactOptions options_;
  Workspace workspace_;
};

TEST_F(SearchWindows, FreeTheRightPitch) {
  const FirstContactResult whole = turn(screwed(kRightWay));
  EXPECT_EQ(whole.verdict, Verdict::free);
  EXPECT_EQ(whole.t, 1.0);
  EXPECT_GT(whole.work.node_groups + whole.work.steps, kPatience);
  EXPECT_EQ(turn(screwed_by_pieces(kRightWay)).verdict, Verdict::free);
}

TEST_F(SearchWindows, FindTheContactOfAWrongPitch) {
  const Motion motion = screwed(kWrongWay);
  const FirstContactResult whole = turn(motion);
  ASSERT_EQ(whole.verdict, Verdict::contact);
  EXPECT_GT(whole.work.node_groups + whole.work.steps, kPatience);
  EXPECT_LE(gap(motion, whole.t), options_.margin + options_.tolerance);
  for (int k = 0; k < kSamples; ++k) {
    ASSERT_GT(gap(motion, whole.t * k / kSamples), options_.margin) << k;
  }
}

// A law: where a step is cut into pieces changes nothing but the tolerance's share. The flanks of
// the thread are 30 degrees from its axis' normal, and close at what the pitch is wrong by.
TEST_F(SearchWindows, AgreeWithASearchByPieces) {
  const FirstContactResult whole = turn(screwed(kWrongWay));
  const FirstContactResult pieces = turn(screwed_by_pieces(kWrongWay));
  ASSERT_EQ(pieces.verdict, Verdict::contact);
  const double closing = std::cos(std::numbers::pi / 6.0) * (kRightWay - kWrongWay);
  EXPECT_NEAR(pieces.t, whole.t, options_.tolerance / closing);
}

// A law: only the motion of one body against the other matters.
TEST_F(SearchWindows, AgreeWithGliding) {
  const FirstContactResult free = turn(screwed(kRightWay));
  const FirstContactResult contact = turn(screwed(kWrongWay));
  bolt_motion_ = Motion::fixed();
  const FirstContactResult screw_sliding = turn(screwed(kRightWay, 0.0));
  EXPECT_EQ(screw_sliding.verdict, free.verdict);
  EXPECT_LT(screw_sliding.work.node_groups + screw_sliding.work.steps, kPatience / 64);
  const FirstContactResult ahead = turn(screwed(kWrongWay, 0.0));
  EXPECT_EQ(ahead.verdict, contact.verdict);
  const double closing = std::cos(std::numbers::pi / 6.0) * (kRightWay - kWrongWay);
  EXPECT_NEAR(ahead.t, contact.t, options_.tolerance / closing);
  EXPECT_LT(ahead.work.node_groups + ahead.work.steps, kPatience / 4);
}

}  // namespace
}  // namespace firstcontact
