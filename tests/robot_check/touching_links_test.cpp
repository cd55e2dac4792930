// Which links touch at rest: in closed form, and the pairs that the Panda's makers disabled.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot_check/touching_links.h>
#include <firstcontact/robot_files/link_shape.h>
#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/robot_files/read_urdf.h>

#include "support/data_dir.h"

namespace firstcontact {
namespace {

/// Cubes of 1 m that slide along x; cube k is at x = offset[k] of its limits' nearest to 0.
RobotModel cubes(double gap, LoadShapes shapes = LoadShapes::collision) {
  RobotDescription robot{.name = "cubes", .links = {}, .joints = {}};
  for (const char* name : {"a", "b", "c"}) {
    LinkGeometry cube{.name = "", .X_LG = {}, .source = BoxGeometry{{1, 1, 1}}, .shape = {}};
    if (shapes != LoadShapes::none) {
      cube.shape = make_shape(cube.source);
    }
    robot.links.push_back({name, {}, {cube}});
  }
  Joint ab{.name = "ab", .type = JointType::prismatic, .parent = "a", .child = "b"};
  ab.limits.lower = 1.0 + gap;
  ab.limits.upper = 5.0;
  Joint bc{.name = "bc", .type = JointType::prismatic, .parent = "b", .child = "c"};
  bc.limits.lower = -5.0;
  bc.limits.upper = 5.0;
  robot.joints = {ab, bc};
  return RobotModel(robot);
}

using Pairs = std::vector<LinkPairIndex>;

TEST(TouchingLinks, StandAtTheLimitsNextToZero) {
  // b and c coincide; a is apart from both by the gap.
  EXPECT_EQ(touching_links(at_rest(cubes(0.1))), (Pairs{{1, 2}}));
  EXPECT_EQ(touching_links(at_rest(cubes(0.1)), 0.11), (Pairs{{0, 1}, {0, 2}, {1, 2}}));
  EXPECT_EQ(touching_links(at_rest(cubes(-0.1))), (Pairs{{0, 1}, {0, 2}, {1, 2}}));
}

TEST(TouchingLinks, NeedShapesAndAMargin) {
  EXPECT_THROW((void)touching_links(at_rest(cubes(0.1, LoadShapes::none))), std::invalid_argument);
  EXPECT_THROW((void)touching_links(at_rest(cubes(0.1)), -1.0), std::invalid_argument);
}

/// In its state "ready" the Panda touches itself only where its makers say that it may. With all
/// coordinates 0 its hand is folded into its forearm, which they do not.
TEST(TouchingLinks, OfThePandaAreDisabledByItsMakers) {
  const std::filesystem::path data = test::data_dir();
  if (data.empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const std::filesystem::path folder = data / "robots/moveit_resources_panda_description";
  const RobotModel panda = read_urdf(folder / "urdf/panda.urdf");
  const RobotSemantics semantics = read_srdf(folder / "srdf/panda.srdf", panda);
  std::map<std::string, JointMotion> joints;
  joints.emplace("panda_finger_joint1", CoordinatePath::constant(0.035));
  for (const GroupState::JointValue& value : semantics.states.at(0).values) {
    joints.emplace(panda.joints()[value.joint].name,
                   CoordinatePath::constant(value.coordinates.at(0)));
  }
  ASSERT_EQ(semantics.states[0].name, "ready");
  const Pairs ready = touching_links(RobotMotion(panda, joints));
  EXPECT_GE(ready.size(), 5u);
  for (const LinkPairIndex& pair : ready) {
    EXPECT_TRUE(semantics.is_disabled(pair.link, pair.other))
        << panda.links()[pair.link].name << " " << panda.links()[pair.other].name;
  }
  const Pairs folded = touching_links(at_rest(panda));
  const LinkPairIndex hand_in_forearm{*panda.find_link("panda_link5"),
                                      *panda.find_link("panda_hand")};
  EXPECT_FALSE(semantics.is_disabled(hand_in_forearm.link, hand_in_forearm.other));
  EXPECT_EQ(std::count(folded.begin(), folded.end(), hand_in_forearm), 1);
}

}  // namespace
}  // namespace firstcontact
