// A pair that is in contact at an end of a path is held to what its policy says: by the planner,
// and once more by the proof of its file. What a policy does not allow is refuted.

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/verification/verify_path.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"

namespace firstcontact {
namespace {

constexpr double kGap = 0.001;  // [m]  Of a box above a table; the margin is ten times as wide.

/// A box above a table, and a post that stands in the way.
///
/// @param more  keys of the plan
std::string table_scene(const std::string& height, const std::string& more) {
  return R"({"firstcontact": 1, "options": {"margin": 0.01}, "bodies": [
    {"name": "table", "shape": {"box": {"size": [4, 4, 1]}}, "pose": {"position": [0, 0, -0.5]}},
    {"name": "post", "shape": {"box": {"size": [0.2, 0.2, 0.4]}}, "pose": {"position": [0, 0, 0.2]}},
    {"name": "box", "shape": {"box": {"size": [0.2, 0.2, 0.2]}}, "pose": {"position": [-0.6, 0, )" +
         height + R"(]}}],
    "plan": {"body": "box", "time": 20, "margin": 0.01, )" +
         more + "}}";
}

struct Planned {
  PlanResult result;
  PlannedPath path;
};

Planned plan(const std::string& text, const std::filesystem::path& source = "scene.json",
             bool approximate = false) {
  const Scene scene = parse_scene(text, source);
  ShapeCache cache;
  ScenePlan made = make_scene_plan(scene, scene.plan.value(), cache);
  made.options.approximate = approximate;
  Planned planned{plan_path(made.plan, made.start, made.goals, made.options), {}};
  if (planned.result.verdict != PlanVerdict::none) {
    planned.path = parse_planned_path(
        write_planned_path(planned_path(made, made.options, planned.result)), "path.json");
  }
  return planned;
}

PlannedPath proven_path(const std::string& text,
                        const std::filesystem::path& source = "scene.json") {
  Planned planned = plan(text, source);
  EXPECT_EQ(planned.result.verdict, PlanVerdict::proven);
  if (planned.result.verdict != PlanVerdict::none) {
    const PathVerification found = verify_path(planned.path);
    EXPECT_EQ(found.verdict, ProofVerdict::proven) << found.problem;
    EXPECT_TRUE(found.reaches_goal);
  }
  return planned.path;
}

std::string refusal_of(const std::string& text, bool approximate = false) {
  try {
    (void)plan(text, "scene.json", approximate);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

const std::string kGoalOnTable = R"("goal": {"position": [0.6, 0, 0.101]}, )";
const std::string kGoalAbove = R"("goal": {"position": [0.6, 0, 0.4]}, )";

std::string pair_with(const std::string& policy, const std::string& more = "") {
  return R"("contact_pairs": [{"pair": ["box", "table"], "policy": ")" + policy + '"' + more + "}]";
}

TEST(ContactPairs, SlideAcrossATable) {
  for (const std::string policy : {"may_stay", "not_deeper"}) {
    const PlannedPath path = proven_path(table_scene("0.101", kGoalOnTable + pair_with(policy)));
    ASSERT_EQ(path.contact_pairs.size(), 1u);
    const double share = policy == "may_stay" ? 0.5 : 15.0 / 16.0;
    EXPECT_NEAR(path.contact_pairs.front().distance, share * kGap, 2e-3 * kGap);
    EXPECT_GE(path.waypoints.size(), 3u);     // The post keeps its margin:
    EXPECT_GE(path.clearance.value(), 0.01);  // clearances are those of pairs that are not held.
  }
}

TEST(ContactPairs, SlideOnATableThatIsNearerThanTheTolerance) {
  proven_path(table_scene(
      "0.1000001", R"("goal": {"position": [0.6, 0, 0.1000001]}, )" + pair_with("may_stay")));
}

TEST(ContactPairs, OpenOnTheFirstEdge) {
  const PlannedPath path = proven_path(table_scene("0.101", kGoalAbove + pair_with("must_open")));
  EXPECT_GE(path.waypoints.size(), 3u);
  EXPECT_GT(path.waypoints[1][2], 0.11);
  EXPECT_GE(path.statistics.first_cost.value(), path.cost);  // It has the edge that opens, too.
}

// The place where the pair has opened may be the goal itself.
TEST(ContactPairs, OpenOnTheWayToTheGoal) {
  const PlannedPath far = proven_path(table_scene("0.101", kGoalAbove + pair_with("must_open")));
  const Scene scene = parse_scene(
      table_scene("0.101", R"("goal": {"position": [-0.6, 0, 0.4]}, )" + pair_with("must_open")),
      "s");
  ShapeCache cache;
  ScenePlan made = make_scene_plan(scene, scene.plan.value(), cache);
  made.goals = {far.waypoints[1]};
  const PlanResult result = plan_path(made.plan, made.start, made.goals, made.options);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  EXPECT_EQ(result.path.size(), 3u);
  EXPECT_EQ(verify_path(planned_path(made, made.options, result)).verdict, ProofVerdict::proven);
}

TEST(ContactPairs, AreHeldByEveryPlannerAndForEverySeed) {
  for (const std::string seed : {"1", "2", "3"}) {
    const std::string options = R"("planner": "lazy_prm_star", "time": 3, "seed": )" + seed + ", ";
    std::string text = table_scene("0.101", options + kGoalAbove + pair_with("must_open"));
    text.erase(text.find(R"("time": 20, )"), std::string(R"("time": 20, )").size());
    proven_path(text);
    const std::string both = table_scene("0.101", R"("contacts": "both", "seed": )" + seed + ", " +
                                                      kGoalOnTable + pair_with("not_deeper"));
    proven_path(both);
    EXPECT_EQ(proven_path(both).waypoints, proven_path(both).waypoints);
  }
}

TEST(ContactPairs, CloseOnTheLastEdge) {
  const std::string goal = R"("start": {"position": [-0.6, 0, 0.4]}, )" + kGoalOnTable;
  const PlannedPath path =
      proven_path(table_scene("0.3", goal + pair_with("must_open", R"(, "at": "goal")")));
  EXPECT_GT(path.waypoints[path.waypoints.size() - 2][2], 0.11);
  proven_path(table_scene("0.3", goal + pair_with("may_stay", R"(, "at": "goal")")));
}

// Lifted off a table, and put down on the same table.
TEST(ContactPairs, OpenAtBothEnds) {
  const std::string both = R"("contact_pairs": [
      {"pair": ["box", "table"], "policy": "must_open"},
      {"pair": ["table", "box"], "policy": "must_open", "at": "goal"}])";
  const PlannedPath path = proven_path(table_scene("0.101", kGoalOnTable + both));
  ASSERT_EQ(path.contact_pairs.size(), 2u);
  ASSERT_GE(path.waypoints.size(), 4u);
  EXPECT_GT(path.waypoints[1][2], 0.11);
  EXPECT_GT(path.waypoints[path.waypoints.size() - 2][2], 0.11);
  // In between it has to keep its margin.
  PlannedPath low = path;
  low.waypoints[1][2] = 0.105;
  EXPECT_NE(verify_path(low).verdict, ProofVerdict::proven);
}

// Each goal has a distance of its own, so that the hold of one would be none for another.
TEST(ContactPairs, AtTheGoalNeedOneGoal) {
  const std::string goals =
      R"("start": {"position": [-0.6, 0, 0.4]}, "goals": [{"position": [0.6, 0, 0.101]},
         {"position": [0.6, 0.5, 0.4]}], )";
  EXPECT_NE(refusal_of(table_scene("0.3", goals + pair_with("may_stay", R"(, "at": "goal")")))
                .find("expected one goal"),
            std::string::npos);
}

TEST(ContactPairs, KeepTheirMarginWhereTheyAreNotInContact) {
  const Planned planned = plan(table_scene("0.3", kGoalAbove + pair_with("may_stay")));
  EXPECT_EQ(planned.result.verdict, PlanVerdict::proven);
  EXPECT_TRUE(planned.path.contact_pairs.empty());
  ASSERT_EQ(planned.result.warnings.size(), 1u);
  EXPECT_NE(planned.result.warnings.front().find("they keep their margin"), std::string::npos);
  // So the goal on the table is refused.
  EXPECT_NE(refusal_of(table_scene("0.3", kGoalOnTable + pair_with("may_stay"))).find("the goal"),
            std::string::npos);
}

TEST(ContactPairs, SayWhatIsNotFreeAndWhereItWouldBe) {
  const std::string touching =
      refusal_of(table_scene("0.0995", kGoalAbove + pair_with("may_stay")));
  for (const char* part : {"the start is not free", "\"table\" and \"box\" touch", "0.0005 m",
                           "nearest free configuration", "a distance of 0 leaves nothing to hold",
                           "by 1e-06 m in the configuration that was found"}) {
    EXPECT_NE(touching.find(part), std::string::npos) << touching;
  }
  const std::string exactly = refusal_of(table_scene("0.1", kGoalAbove + pair_with("must_open")));
  EXPECT_NE(exactly.find("nothing to hold"), std::string::npos) << exactly;
  // A policy of one pair does not hide the contact of another one.
  const std::string other =
      refusal_of(table_scene("0.101", R"("start": {"position": [-0.205, 0, 0.101]}, )" +
                                          kGoalAbove + pair_with("may_stay")));
  EXPECT_NE(other.find("\"post\" and \"box\""), std::string::npos) << other;
  // A goal that is deeper than the start is none.
  const std::string deeper = refusal_of(table_scene(
      "0.101", R"("goal": {"position": [0.6, 0, 0.1008]}, )" + pair_with("not_deeper")));
  EXPECT_NE(
      deeper.find("the goal is not free: \"table\" and \"box\" are no farther apart than 0.0009"),
      std::string::npos)
      << deeper;
  // must_open is about the end that it names.
  const std::string both = refusal_of(table_scene("0.101", kGoalOnTable + pair_with("must_open")));
  EXPECT_NE(both.find("the goal is not free"), std::string::npos) << both;
}

// The place that is named for a pair that touches can be the start: it lifts the box by no more
// than it takes.
TEST(ContactPairs, TellTheNearestPlaceThatIsApart) {
  const std::string touching = refusal_of(table_scene("0.1", kGoalAbove + pair_with("must_open")));
  const std::string before = "is at ";
  const std::size_t at = touching.find(before);
  ASSERT_NE(at, std::string::npos) << touching;
  std::istringstream numbers(touching.substr(at + before.size()));
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  numbers >> x >> y >> z;
  EXPECT_NEAR(x, -0.6, 1e-5);
  EXPECT_NEAR(y, 0.0, 1e-5);
  EXPECT_GT(z, 0.1 + 1e-6);
  EXPECT_LT(z, 0.1 + 4e-6);
  proven_path(table_scene(std::to_string(z + 1e-6), kGoalAbove + pair_with("must_open")));
}

TEST(ContactPairs, AreRefusedWhereNothingCanBeProven) {
  const std::string untested = refusal_of(table_scene(
      "0.101",
      kGoalAbove + R"("contact_pairs": [{"pair": ["post", "table"], "policy": "may_stay"}])"));
  EXPECT_NE(untested.find("\"table\" and \"post\""), std::string::npos) << untested;
  const std::string approximate =
      refusal_of(table_scene("0.3", R"("start": {"position": [-0.6, 0, 0.4]}, )" + kGoalOnTable +
                                        pair_with("may_stay", R"(, "at": "goal")")),
                 true);
  EXPECT_NE(approximate.find("approximate"), std::string::npos) << approximate;
}

TEST(ContactPairs, AreReadStrictly) {
  const auto problem = [](const std::string& pairs) {
    try {
      (void)parse_scene(table_scene("0.101", kGoalAbove + R"("contact_pairs": )" + pairs), "s");
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(problem(R"([{"pair": ["box", "tabel"], "policy": "may_stay"}])").find("\"table\""),
            std::string::npos);
  EXPECT_NE(problem(R"([{"pair": ["box", "box"], "policy": "may_stay"}])").find("twice"),
            std::string::npos);
  EXPECT_NE(problem(R"([{"pair": ["box", "table"], "policy": "stay"}])").find("may_stay"),
            std::string::npos);
  EXPECT_NE(problem(R"([{"pair": ["box", "table"]}])").find("policy"), std::string::npos);
  EXPECT_NE(problem(R"([{"pair": ["box", "table"], "policy": "may_stay"},
                        {"pair": ["table", "box"], "policy": "may_stay", "at": "goal"}])")
                .find("each pair once"),
            std::string::npos);
  EXPECT_NE(problem(R"([{"pair": ["box"], "policy": "may_stay"}])").find("pair of names"),
            std::string::npos);
}

// Any box on the table, turned about the vertical and tilted by less than its gap allows.
TEST(ContactPairs, AreProvenForRandomStarts) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int k = 0; k < 12; ++k) {
    Scene scene = parse_scene(
        table_scene("0.101", kGoalOnTable + pair_with(k % 2 == 0 ? "may_stay" : "not_deeper")),
        "s");
    PlanQuestion question = scene.plan.value();
    const auto place = [&](double x, double height) {
      const Eigen::AngleAxisd turn(3.0 * unit(random), Eigen::Vector3d::UnitZ());
      const Eigen::AngleAxisd tilt(0.001 * unit(random), Eigen::Vector3d::UnitX());
      return Pose{{x, 0.5 * unit(random), height}, Eigen::Quaterniond(turn * tilt)};
    };
    question.start_pose = place(-0.6, 0.1005);
    question.goal_poses = {place(0.6, 0.101)};
    question.seed = 1 + k;
    ShapeCache cache;
    const ScenePlan made = make_scene_plan(scene, question, cache);
    const PlanResult result = plan_path(made.plan, made.start, made.goals, made.options);
    ASSERT_EQ(result.verdict, PlanVerdict::proven) << k;
    const PathVerification proof = verify_path(planned_path(made, made.options, result));
    EXPECT_EQ(proof.verdict, ProofVerdict::proven) << k << ": " << proof.problem;
  }
}

/// A path of the box, as a file would have it.
PlannedPath path_of_box(const std::vector<std::vector<double>>& places, ContactPolicy policy,
                        double distance) {
  PlannedPath path;
  path.scene = parse_scene(table_scene("0.101", kGoalAbove + pair_with("may_stay")), "s");
  ShapeCache cache;
  path.input_digest = load_scene(path.scene, cache).input_digest;
  path.is_proven = true;
  path.body = "box";
  path.margin = 0.01;
  path.extra_clearance = 1e-9;
  for (const std::vector<double>& p : places) {
    path.waypoints.push_back({p[0], p[1], p[2], 1, 0, 0, 0});
  }
  path.clearances.assign(places.size() - 1, 0.0);
  path.clearance = 0.0;
  path.goals = {path.waypoints.back()};
  path.goal = 0;
  path.contact_pairs = {{{"table", "box"}, policy, PathEnd::start, distance}};
  return path;
}

using Places = std::vector<std::vector<double>>;
const Places kAway = {{-0.6, 0, 0.101}, {-0.6, 0.3, 0.4}, {0.6, 0.3, 0.4}};
/// Leaves the table, comes back to it elsewhere, and leaves it for good.
const Places kTouchesAgain = {
    {-0.6, 0, 0.101}, {-0.6, 0, 0.2}, {-0.6, 0.6, 0.101}, {-0.6, 0.6, 0.4}, {0.6, 0.6, 0.4}};
/// Dives to 0.7 of the gap on the way.
const Places kDives = {{-0.6, 0, 0.101}, {-0.6, 0.3, 0.1007}, {-0.6, 0.6, 0.101}};

ProofVerdict verdict_of(const PlannedPath& path) { return verify_path(path).verdict; }

// A hold takes the place of a margin only for a pair that is in contact at that end.
TEST(ContactPairsProof, RefutesAHoldOfAPairThatKeepsItsMargin) {
  // 19 mm above the table, whose margin is 10 mm; then 9.6 mm.
  const Places sinks = {{-0.6, 0, 0.119}, {-0.6, 0.3, 0.1096}, {-0.6, 0.6, 0.3}};
  PlannedPath path = path_of_box(sinks, ContactPolicy::may_stay, 0.0095);
  path.scene.bodies[2].motion = FixedMotion{{{-0.6, 0, 0.119}, Eigen::Quaterniond::Identity()}};
  EXPECT_EQ(verdict_of(path), ProofVerdict::refuted);
}

TEST(ContactPairsProof, KnowsTheToleranceOfTheScene) {
  PlannedPath path = path_of_box(kAway, ContactPolicy::may_stay, 0.0005);
  path.tolerance = 1.0;
  EXPECT_EQ(verify_path(path).problem, "The tolerance of the path is not that of its scene.");
}

TEST(ContactPairsProof, AllowsWhatThePolicyAllows) {
  const double half = 0.5 * kGap;
  const double most = 0.9375 * kGap;
  EXPECT_EQ(verdict_of(path_of_box(kAway, ContactPolicy::may_stay, half)), ProofVerdict::proven);
  EXPECT_EQ(verdict_of(path_of_box(kAway, ContactPolicy::not_deeper, most)), ProofVerdict::proven);
  EXPECT_EQ(verdict_of(path_of_box(kAway, ContactPolicy::must_open, most)), ProofVerdict::proven);
  EXPECT_EQ(verdict_of(path_of_box(kTouchesAgain, ContactPolicy::may_stay, half)),
            ProofVerdict::proven);
  EXPECT_EQ(verdict_of(path_of_box(kDives, ContactPolicy::may_stay, half)), ProofVerdict::proven);
}

TEST(ContactPairsProof, RefutesWhatItDoesNotAllow) {
  const double most = 0.9375 * kGap;
  EXPECT_EQ(verdict_of(path_of_box(kDives, ContactPolicy::not_deeper, most)),
            ProofVerdict::refuted);
  const PathVerification again =
      verify_path(path_of_box(kTouchesAgain, ContactPolicy::must_open, most));
  EXPECT_EQ(again.verdict, ProofVerdict::refuted);
  EXPECT_EQ(again.problem_edge, 1u);
  // Without the policy the start alone refutes the path.
  PlannedPath bare = path_of_box(kAway, ContactPolicy::may_stay, 0.5 * kGap);
  bare.contact_pairs.clear();
  EXPECT_EQ(verdict_of(bare), ProofVerdict::refuted);
}

// Both ends of an edge are as far from the table as the start. Half way an edge of the box points
// down, unless it turns about the vertical.
TEST(ContactPairsProof, RefutesADiveBetweenTheEndsOfAnEdge) {
  const double c = std::sqrt(0.5);
  const auto turned = [&](const std::vector<double>& quarter) {
    PlannedPath path =
        path_of_box({{-0.6, 0, 0.101}, {-0.6, 0.6, 0.101}}, ContactPolicy::may_stay, 0.5 * kGap);
    path.waypoints[1].resize(3);
    path.waypoints[1].insert(path.waypoints[1].end(), quarter.begin(), quarter.end());
    path.goals = {path.waypoints[1]};
    return verify_path(path);
  };
  EXPECT_EQ(turned({c, 0, 0, c}).verdict, ProofVerdict::proven);
  const PathVerification dives = turned({c, c, 0, 0});
  EXPECT_EQ(dives.verdict, ProofVerdict::refuted);
  EXPECT_GT(dives.problem_at.value().from, 0.0);
  EXPECT_LT(dives.problem_at.value().to, 1.0);
}

TEST(ContactPairsProof, DoesNotHideOtherPairs) {
  const Places through_post = {{-0.6, 0, 0.101}, {0.6, 0, 0.101}};
  const PathVerification found =
      verify_path(path_of_box(through_post, ContactPolicy::may_stay, 0.5 * kGap));
  EXPECT_EQ(found.verdict, ProofVerdict::refuted);
  EXPECT_EQ(found.problem_at.value().pair[0], "post");
  const Places beside_post = {{-0.6, 0, 0.101}, {-0.6, 0.209, 0.101}, {0.6, 0.209, 0.101}};
  EXPECT_EQ(verdict_of(path_of_box(beside_post, ContactPolicy::may_stay, 0.5 * kGap)),
            ProofVerdict::refuted);
}

// A file that claims to hold less than its policy allows would hide a dive.
TEST(ContactPairsProof, RefutesADistanceThatIsTooSmall) {
  for (const auto& [policy, share] :
       {std::pair(ContactPolicy::may_stay, 0.5), std::pair(ContactPolicy::not_deeper, 0.9375),
        std::pair(ContactPolicy::must_open, 0.9375)}) {
    EXPECT_EQ(verdict_of(path_of_box(kAway, policy, 0.98 * share * kGap)), ProofVerdict::refuted);
    EXPECT_EQ(verdict_of(path_of_box(kAway, policy, 1.07 * kGap)), ProofVerdict::refuted);
  }
  // Nor may a pair be held that is not in contact at that end.
  PlannedPath far = path_of_box(kAway, ContactPolicy::may_stay, 0.5 * kGap);
  far.contact_pairs.front().at = PathEnd::goal;
  EXPECT_EQ(verdict_of(far), ProofVerdict::refuted);
}

TEST(ContactPairsProof, NamesWhatContradictsItself) {
  const auto problem_of = [](const auto& change) {
    PlannedPath path = path_of_box(kAway, ContactPolicy::must_open, 0.9375 * kGap);
    change(path);
    const PathVerification found = verify_path(path);
    EXPECT_EQ(found.verdict, ProofVerdict::broken);
    return found.problem;
  };
  EXPECT_EQ(problem_of([](PlannedPath& path) { path.contact_pairs[0].pair[0] = "tabel"; }),
            "The scene has no body or link \"tabel\".");
  EXPECT_EQ(problem_of([](PlannedPath& path) { path.contact_pairs[0].pair[1] = "post"; }),
            "The contact pair \"table\" and \"post\" is not tested.");
  EXPECT_EQ(
      problem_of([](PlannedPath& path) { path.contact_pairs.push_back(path.contact_pairs[0]); }),
      "The contact pair \"table\" and \"box\" is named twice.");
  EXPECT_EQ(problem_of([](PlannedPath& path) { path.contact_pairs[0].distance = 0.0; }),
            "The distance of the contact pair \"table\" and \"box\" is not above 0.");
  EXPECT_EQ(problem_of([](PlannedPath& path) {
              path.waypoints.erase(path.waypoints.begin() + 1);
              path.clearances.pop_back();
            }),
            "The path has too few edges for its pairs to open.");
  EXPECT_EQ(problem_of([](PlannedPath& path) {
              path.is_proven = false;
              path.goal.reset();
              path.contact_pairs[0].at = PathEnd::goal;
            }),
            "The contact pair \"table\" and \"box\" is at a goal that is not reached.");
}

void write_gantry(const test::ArmFolder& folder) {
  folder.write("gantry.urdf", R"(<robot name="gantry"><link name="base"/><link name="slide"/>
    <link name="tool"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
    <joint name="x" type="prismatic"><parent link="base"/><child link="slide"/><axis xyz="1 0 0"/>
      <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
    <joint name="z" type="prismatic"><parent link="slide"/><child link="tool"/><axis xyz="0 0 1"/>
      <limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)");
}

// A robot whose tool is 0.5 mm from a part that it begins at; the other links keep their margins.
TEST(ContactPairs, OpenForALinkOfARobot) {
  const test::ArmFolder folder;
  write_gantry(folder);
  const auto scene = [](const std::string& policy) {
    return R"({"firstcontact": 1, "options": {"margin": 0.005}, "bodies": [
      {"name": "part", "shape": {"box": {"size": [0.2, 0.2, 0.2]}}, "pose": {"position": [0, 0, -0.2]}}],
      "robots": [{"name": "g", "urdf": "gantry.urdf", "state": {"x": 0, "z": 0.0005}}],
      "plan": {"goal": {"x": 1, "z": -0.2}, "time": 20,
               "contact_pairs": [{"pair": ["part", "g/tool"], "policy": ")" +
           policy + "\"}]}}";
  };
  for (const std::string policy : {"may_stay", "not_deeper", "must_open"}) {
    const PlannedPath path = proven_path(scene(policy), folder.path() / "scene.json");
    ASSERT_EQ(path.contact_pairs.size(), 1u);
    EXPECT_EQ(path.contact_pairs.front().pair[1], "g/tool");
  }
}

// A held body is 0.2 mm above a table; the link that holds it is not tested against the table.
TEST(ContactPairs, LiftWhatARobotHolds) {
  const test::ArmFolder folder;
  write_gantry(folder);
  const auto scene = [](const std::string& pair) {
    return R"({"firstcontact": 1, "options": {"margin": 0.002}, "bodies": [
      {"name": "table", "shape": {"box": {"size": [4, 4, 1]}}, "pose": {"position": [0, 0, -0.7502]}},
      {"name": "post", "shape": {"box": {"size": [0.2, 0.2, 0.6]}}, "pose": {"position": [0.5, 0, 0]}},
      {"name": "object", "shape": {"cylinder": {"radius": 0.04, "length": 0.1}}}],
      "robots": [{"name": "g", "urdf": "gantry.urdf",
        "attached": [{"body": "object", "link": "tool", "pose": {"position": [0, 0, -0.2]}}]}],
      "plan": {"goal": {"x": 1, "z": 0.3}, "time": 20,
               "contact_pairs": [{"pair": [)" +
           pair + R"(], "policy": "must_open"}]}})";
  };
  const PlannedPath path = proven_path(scene(R"("object", "table")"), folder.path() / "scene.json");
  ASSERT_EQ(path.contact_pairs.size(), 1u);
  EXPECT_NEAR(path.contact_pairs.front().distance, 1.875e-4, 1e-6);
  try {
    (void)plan(scene(R"("object", "g/tool")"), folder.path() / "scene.json");
    ADD_FAILURE() << "expected an error";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("not tested against each other"), std::string::npos);
  }
}

}  // namespace
}  // namespace firstcontact
