// Names and numbers of what a scene has.

#include <firstcontact/scene/scene.h>

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/detail/scene_names.h>
#include <firstcontact/scene_files/read_scene.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using Members = std::vector<std::size_t>;

class NamesOfAScene : public testing::Test {
 protected:
  /// Bodies 0 and 1; links 2 to 4 of the first arm, 5 to 7 of the second one.
  [[nodiscard]] Scene arms() const {
    return parse_scene(R"({"firstcontact": 1, "bodies": [)" + test::body("post") + "," +
                           test::body("plate") +
                           R"(], "robots": [{"name": "left", "urdf": "arm.urdf"},
                             {"name": "right", "urdf": "arm.urdf"}],
            "pairs": {"groups": {"tips": ["left/tip", "right/tip", "post"]},
                      "ignore": [["left/bar", "right/bar"], ["tips", "plate"]],
                      "margin": [["plate", "right/tip", 0.5]]}})",
                       folder_.path() / "s.json");
  }

  test::ArmFolder folder_;
};

TEST_F(NamesOfAScene, MeanBodiesLinksRobotsAndGroups) {
  const Scene scene = arms();
  EXPECT_EQ(members_named(scene, "plate"), (Members{1}));
  EXPECT_EQ(members_named(scene, "left/tip"), (Members{4}));
  EXPECT_EQ(members_named(scene, "right"), (Members{5, 6, 7}));
  EXPECT_EQ(members_named(scene, "tips"), (Members{4, 7, 0}));
}

// The law: a member's name means that member.
TEST_F(NamesOfAScene, AreThoseOfTheirMembers) {
  const Scene scene = arms();
  for (std::size_t member = 0; member < 8; ++member) {
    EXPECT_EQ(members_named(scene, member_name(scene, member)), (Members{member}));
  }
  EXPECT_EQ(first_member(scene, 0), 2u);
  EXPECT_EQ(first_member(scene, 1), 5u);
  EXPECT_EQ(member_name(scene, first_member(scene, 1)), "right/base");
  EXPECT_THROW((void)member_name(scene, 8), std::out_of_range);
}

TEST_F(NamesOfAScene, AreOfferedWhereOneIsMisspelled) {
  const Scene scene = arms();
  const auto said = [&](const std::string& name) {
    return test::message_of<std::invalid_argument>([&] { (void)members_named(scene, name); });
  };
  const std::string expected =
      "expected the name of a body, a robot or a group, or robot/link, got ";
  EXPECT_EQ(said("pots"), expected + R"("pots"; did you mean "post"?)");
  EXPECT_EQ(said("right/tipp"), expected + R"("right/tipp"; did you mean "right/tip"?)");
  EXPECT_EQ(said("nothing like it"), expected + R"("nothing like it")");
}

// A body more gives links greater numbers, and names mean what they meant.
TEST_F(NamesOfAScene, StayWithTheirMembersWhenABodyIsAdded) {
  const Scene before = arms();
  Scene after = before;
  add_body(after, {.name = "new", .shape = {.source = SphereShape{1.0}}, .motion = {}});
  EXPECT_EQ(members_named(after, "new"), (Members{2}));
  const auto names = [](const Scene& scene, const auto& members) {
    std::vector<std::string> result;
    for (const std::size_t member : members) {
      result.push_back(member_name(scene, member));
    }
    return result;
  };
  for (const std::string name : {"post", "plate", "left", "right", "left/tip", "tips"}) {
    EXPECT_EQ(names(after, members_named(after, name)), names(before, members_named(before, name)));
  }
  ASSERT_EQ(after.ignored_pairs.size(), before.ignored_pairs.size());
  for (std::size_t k = 0; k < after.ignored_pairs.size(); ++k) {
    EXPECT_EQ(names(after, after.ignored_pairs[k]), names(before, before.ignored_pairs[k]));
  }
  EXPECT_EQ(names(after, after.pair_margins.at(0).bodies),
            names(before, before.pair_margins.at(0).bodies));
}

TEST_F(NamesOfAScene, EndWithTheLastTime) {
  Scene scene = arms();
  EXPECT_EQ(last_time(scene), 0.0);
  scene.robots[1].trajectory.joint_names = {"elbow"};
  scene.robots[1].trajectory.points = {{.time = 0.0, .positions = {0.0}},
                                       {.time = 2.0, .positions = {1.0}}};
  EXPECT_EQ(last_time(scene), 2.0);
  scene.bodies[0].motion = WaypointMotion{{0.0, 3.0}, {{}, {}}};
  EXPECT_EQ(last_time(scene), 3.0);
  scene.robots[0].base = WaypointMotion{{0.0, 4.0}, {{}, {}}};
  EXPECT_EQ(last_time(scene), 4.0);
  scene.bodies[1].motion = ConstantVelocityMotion{};  // As long as the scene.
  EXPECT_EQ(last_time(scene), 4.0);
}

}  // namespace
}  // namespace firstcontact
