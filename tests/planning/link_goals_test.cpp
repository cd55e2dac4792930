// Goals that are poses of links share the time of the question, and its interruption.

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <stop_token>
#include <string>

#include <gtest/gtest.h>

#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>

namespace firstcontact::test {
namespace {

constexpr const char* kInBlock = R"({"link": "hand", "pose": {"position": [3, 0, 0]}})";
constexpr const char* kFree = R"({"link": "hand", "pose": {"position": [0, 3, 0]}})";
constexpr const char* kInGate = R"({"link": "hand", "pose": {"position": [0, -3, 0]}})";

/// A chain of twelve hinges in a plane, whose hand alone has geometry, before a block.
class ChainFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("link_goals_test_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    std::ofstream urdf(folder_ / "chain.urdf");
    urdf << R"(<robot name="chain"><link name="l0"/>)";
    for (int k = 1; k <= kHinges; ++k) {
      const std::string link = k == kHinges ? "hand" : "l" + std::to_string(k);
      urdf << "<link name=\"" << link << "\">";
      if (k == kHinges) {
        urdf << R"(<collision><geometry><sphere radius="0.1"/></geometry></collision>)";
      }
      urdf << "</link><joint name=\"j" << k << R"(" type="revolute"><parent link="l)" << k - 1
           << "\"/><child link=\"" << link << R"("/><origin xyz="0.4 0 0"/><axis xyz="0 0 1"/>
        <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>)";
    }
    urdf << "</robot>";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// @param plan  the keys of the question but for its start
  [[nodiscard]] Scene scene(const std::string& plan, const std::string& start = R"("j1": 1.5)",
                            const std::string& more = "") const {
    return parse_scene(R"({"firstcontact": 1,
      "bodies": [)" + more +
                           R"({"name": "block", "shape": {"box": {"size": [1, 1, 1]}},
                  "pose": {"position": [3, 0, 0]}}],
      "robots": [{"name": "c", "urdf": "chain.urdf"}],
      "plan": {"start": {)" +
                           start + "}, " + plan + "}}",
                       folder_ / "scene.json", 1, {});
  }

  [[nodiscard]] static std::string refusal_of(const Scene& asked) {
    ShapeCache cache;
    try {
      (void)make_scene_plan(asked, *asked.plan, cache);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }

  static constexpr int kHinges = 12;
  std::filesystem::path folder_;
};

std::string goals(const std::string& first, const std::string& second) {
  return "\"goals\": [" + first + ", " + second + "]";
}

// 300 tries for the pose in the block alone take longer than the time, which sanitizers stretch.
TEST_F(ChainFile, DropsABlockedPoseWhereAnotherOneIsFree) {
  constexpr double kTime = FIRSTCONTACT_SANITIZED ? 4.0 : 0.4;  // [s]
  ShapeCache cache;
  for (const std::string& both : {goals(kInBlock, kFree), goals(kFree, kInBlock)}) {
    const Scene asked = scene(both + ", \"time\": " + std::to_string(kTime));
    const ScenePlan plan = make_scene_plan(asked, *asked.plan, cache);
    EXPECT_FALSE(plan.goals.empty());
    EXPECT_LE(plan.goals.size(), 8u);
    EXPECT_GT(plan.options.spent, 0.0);
    EXPECT_LT(plan.options.spent, kTime);
    EXPECT_NE(
        plan.loaded.warnings.back().find("is not free: \"block\" and \"c/hand\" are in the way"),
        std::string::npos)
        << plan.loaded.warnings.back();
    EXPECT_EQ(plan_path(plan.plan, plan.start, plan.goals, plan.options).verdict,
              PlanVerdict::proven);
  }
}

TEST_F(ChainFile, DropsAPoseThatIsBlockedAtTheEndOfTheTime) {
  const std::string gate = R"({"name": "gate", "shape": {"box": {"size": [0.1, 1, 1]}},
    "motion": {"type": "waypoints", "times": [0, 20],
               "poses": [{"position": [9, 9, 0]}, {"position": [0, -3, 0]}]}}, )";
  const Scene asked = scene(goals(kInGate, kFree), R"("j1": 1.5)", gate);
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(asked, *asked.plan, cache);
  ASSERT_TRUE(plan.plan.times.has_value());
  EXPECT_FALSE(plan.goals.empty());
  EXPECT_NE(plan.loaded.warnings.back().find("at the end of the time, is not free: \"gate\""),
            std::string::npos)
      << plan.loaded.warnings.back();
  const std::string message = refusal_of(scene(
      goals(kInGate, kInGate) + (FIRSTCONTACT_SANITIZED ? R"(, "time": 5)" : R"(, "time": 1)"),
      R"("j1": 1.5)", gate));
  EXPECT_NE(message.find("touch, up to 0.15"), std::string::npos) << message;
}

TEST_F(ChainFile, NamesABlockedStartBeforeItLooksForGoals) {
  // The hand is at (3.14, -0.31, 0).
  const std::string inside = R"("j1": 0.9, "j6": -1.8)";
  const std::string message = refusal_of(scene("\"goal\": " + std::string(kInBlock), inside));
  EXPECT_EQ(message.rfind("the start is not free: ", 0), 0u) << message;
}

TEST_F(ChainFile, EndsTheSearchForPlacesWhereItIsStopped) {
  const Scene asked = scene("\"goal\": " + std::string(kInBlock) + R"(, "time": 100)");
  std::stop_source stop;
  stop.request_stop();
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(asked, *asked.plan, cache, stop.get_token());
  EXPECT_TRUE(plan.goals.empty());
  PlanOptions options = plan.options;
  options.stop = stop.get_token();
  EXPECT_EQ(plan_path(plan.plan, plan.start, plan.goals, options).verdict, PlanVerdict::none);
}

// The chain is 4.4 m long, from (0.4, 0, 0) on. Where any rotation will do, an angle is no part of
// the answer.
TEST_F(ChainFile, TellsHowNearAPoseOfAnyRotationMayCome) {
  const auto message_for = [&](const std::string& more) {
    return refusal_of(scene(R"("goal": {"link": "hand", "pose": {"position": [0, 6.8, 0],
        "rpy": [0, 0, 3]})" +
                            more + R"(}, "time": 0.5)"));
  };
  const std::string any = message_for(R"(, "rotation_tolerance": 4)");
  const std::size_t number = any.find("the nearest is ") + std::string("the nearest is ").size();
  EXPECT_NEAR(std::stod(any.substr(number)), std::hypot(0.4, 6.8) - 4.4, 1e-3) << any;
  EXPECT_EQ(any.find(" rad"), std::string::npos) << any;
  EXPECT_TRUE(any.ends_with(" m off")) << any;
  EXPECT_TRUE(message_for("").ends_with(" rad off"));
}

// The planner has no more than what inverse kinematics left.
TEST_F(ChainFile, CountsTheTimeThatGoalsTook) {
  const Scene asked = scene("\"goal\": " + std::string(kFree) + R"(, "time": 30)");
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(asked, *asked.plan, cache);
  PlanOptions options = plan.options;
  options.spent = 30.0;
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, options);
  EXPECT_GE(result.statistics.seconds, 30.0);
  EXPECT_LT(result.statistics.seconds, 40.0);
  options.spent = -1.0;
  EXPECT_THROW((void)plan_path(plan.plan, plan.start, plan.goals, options), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact::test
