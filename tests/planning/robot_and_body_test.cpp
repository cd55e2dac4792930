// A robot and a body that move at once: a gate opens before a part, and closes behind it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::test {
namespace {

// A wall of 10 um with a window of 0.4 m, which a gate of 0.5 m covers 5 cm behind it.
constexpr const char* kGatedWall = R"("bodies": [
  {"name": "left", "shape": {"box": {"size": [0.00001, 1.8, 4]}}, "pose": {"position": [0, -1.1, 0]}},
  {"name": "right", "shape": {"box": {"size": [0.00001, 1.8, 4]}}, "pose": {"position": [0, 1.1, 0]}},
  {"name": "below", "shape": {"box": {"size": [0.00001, 0.41, 1.8]}}, "pose": {"position": [0, 0, -1.1]}},
  {"name": "above", "shape": {"box": {"size": [0.00001, 0.41, 1.8]}}, "pose": {"position": [0, 0, 1.1]}},
  {"name": "part", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [-0.5, 0, 0]}}],
  "robots": [{"name": "gate", "urdf": "gate.urdf"}])";

constexpr const char* kPlanOfGate = R"("robot": "gate", "body": "part",
  "goal": {"gate/slide": 0, "part": {"position": [0.5, 0.05, 0]}},
  "box": [[-0.8, -0.8, -0.8], [0.8, 0.8, 0.8]], "time": 30)";

class GateFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("robot_and_body_test_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "gate.urdf") << R"(<robot name="gate"><link name="rail"/>
      <link name="gate"><collision><geometry><box size="0.1 0.5 0.5"/></geometry></collision></link>
      <joint name="slide" type="prismatic"><parent link="rail"/><child link="gate"/>
        <origin xyz="0.1 0 0"/><axis xyz="0 1 0"/>
        <limit lower="0" upper="1" velocity="1" effort="1"/></joint></robot>)";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] ScenePlan plan_with(const std::string& plan) const {
    const Scene scene = parse_scene(
        std::string(R"({"firstcontact": 1, )") + kGatedWall + R"(, "plan": {)" + plan + "}}",
        folder_ / "scene.json", 1, {});
    ShapeCache cache;
    return make_scene_plan(scene, *scene.plan, cache);
  }

  [[nodiscard]] std::string refusal(const std::string& plan) const {
    try {
      const ScenePlan made = plan_with(plan);
      (void)plan_path(made.plan, made.start, made.goals, made.options);
    } catch (const ParseError& error) {
      return error.what();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

TEST_F(GateFile, MovesBothAtOnce) {
  const ScenePlan plan = plan_with(kPlanOfGate);
  const ConfigurationSpace& space = plan.plan.space;
  ASSERT_EQ(space.size(), 8u);
  EXPECT_EQ(space.mover_count(), 2u);
  EXPECT_FALSE(space.is_body());
  EXPECT_TRUE(space.is_body(1));
  EXPECT_EQ(space.number_name(0), "gate/slide");
  EXPECT_EQ(space.number_name(1), "part/trans_x");
  EXPECT_EQ(plan.start, (Configuration{0, -0.5, 0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(plan.goals.at(0), (Configuration{0, 0.5, 0.05, 0, 1, 0, 0, 0}));
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  // The closed form: where the part passes the gate's depth, the gate is out of its way.
  for (std::size_t k = 0; k + 1 < result.path.size(); ++k) {
    for (double share = 0.0; share <= 1.0; share += 1e-3) {
      const Configuration q = space.interpolate(result.path[k], result.path[k + 1], share);
      const double dx = std::max(std::abs(q[1] - 0.1) - 0.05, 0.0);
      const double dy = std::max(std::abs(q[2] - q[0]) - 0.25, 0.0);
      const double dz = std::max(std::abs(q[3]) - 0.25, 0.0);
      EXPECT_GT(std::hypot(dx, dy, dz), 0.1) << k << " " << share;
    }
  }
  const PlannedPath path = planned_path(plan, plan.options, result);
  EXPECT_EQ(path.robots, (std::vector<std::string>{"gate"}));
  EXPECT_EQ(path.body, "part");
  const std::string text = write_planned_path(path);
  const PlannedPath read = parse_planned_path(text, "path.json");
  EXPECT_EQ(read.waypoints, result.path);
  EXPECT_EQ(read.body, "part");
  EXPECT_EQ(read.joints, path.joints);
  EXPECT_EQ(write_planned_path(read), text);
}

TEST_F(GateFile, SlidesAlongContacts) {
  const ScenePlan plan = plan_with(std::string(kPlanOfGate) + R"(, "contacts": "both")");
  EXPECT_EQ(plan_path(plan.plan, plan.start, plan.goals, plan.options).verdict,
            PlanVerdict::proven);
}

TEST_F(GateFile, StartsWhereTheQuestionHasThem) {
  const ScenePlan plan = plan_with(std::string(kPlanOfGate) +
                                   R"(, "start": {"gate/slide": 0.5, "part/trans_x": -0.4})");
  EXPECT_EQ(plan.start, (Configuration{0.5, -0.4, 0, 0, 1, 0, 0, 0}));
}

TEST_F(GateFile, RefusesNamesOfNoMover) {
  const auto with_goal = [](const std::string& goal) {
    return R"("robot": "gate", "body": "part", "goal": )" + goal;
  };
  EXPECT_NE(refusal(with_goal(R"({"slide": 0.5})")).find("expected ROBOT/NAME"), std::string::npos);
  EXPECT_NE(refusal(with_goal(R"({"gate/slide": 0.5, "part/x": 1})")).find("a number of the pose"),
            std::string::npos);
  EXPECT_NE(refusal(with_goal(R"({"part/trans_x": 0.5})")).find("no goal names a joint"),
            std::string::npos);
  EXPECT_NE(refusal(with_goal(R"({"gate/slide": 0, "part/rot_x": 1})")).find("length 1"),
            std::string::npos);
  // It starts in the gate.
  EXPECT_NE(refusal(std::string(kPlanOfGate) + R"(, "start": {"part/trans_x": 0.1})")
                .find("\"part\" and \"gate/gate\" touch"),
            std::string::npos);
}

}  // namespace
}  // namespace firstcontact::test
