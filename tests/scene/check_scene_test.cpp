#include <firstcontact/scene/check_scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stop_token>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene_files/read_scene.h>

#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::body;
using test::falling;
using test::scene;

constexpr double kTolerance = 1e-6;  // [m]  The scene format's default.

LoadedScene load(const std::string& text) {
  ShapeCache cache;
  return load_scene(parse_scene(text, "s"), cache);
}

SceneResult check(const std::string& text, const CheckOptions& options = {}) {
  ManyBodiesWorkspace workspace;
  return check_scene(load(text), workspace, options);
}

// At 4 m/s downwards: `low` begins 1 m above the floor and reaches it at t = 1/4; `high` 2 m at
// 1/2.
const std::string kThree =
    body("floor") + "," + body("high", falling("2", "-4")) + "," + body("low", falling("1", "-4"));

/// Is never late, and early only by what the tolerance explains at a speed of 4 m per step.
void expect_time(double t, double truth) {
  EXPECT_LE(t, truth);
  EXPECT_GE(t, truth - 1.01 * kTolerance / 4.0);
}

TEST(CheckScene, TheEarliestPairAnswersForAll) {
  const SceneResult result = check(scene(kThree));
  EXPECT_EQ(result.verdict, Verdict::contact);
  expect_time(result.t, 0.25);
  ASSERT_TRUE(result.first);
  ASSERT_EQ(result.pairs.size(), 1u);
  EXPECT_EQ(result.pairs[*result.first].members, (BodyPair{0, 2}));
  EXPECT_EQ(result.t_upper, result.t);
}

TEST(CheckScene, EveryPairAnswersWhereThatIsAsked) {
  const SceneResult result = check(scene(kThree), {.all_pairs = true});
  EXPECT_EQ(result.verdict, Verdict::contact);
  expect_time(result.t, 0.25);
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.pairs[*result.first].members, (BodyPair{0, 2}));
  ASSERT_EQ(result.pairs.size(), 3u);
  expect_time(result.pairs[0].t, 0.5);
  EXPECT_EQ(result.pairs[2].verdict, Verdict::free);  // They fall together.
  EXPECT_EQ(result.t_upper, result.t);
}

// Two corners of a flag are 3 m above the floor at the start and 1 m below it at the end.
TEST(CheckScene, VerticesMoveOnLines) {
  const std::string flag =
      R"({"name": "flag", "shape": {"vertices": [[0, 0, 3], [1, 0, 3], [0, 1, 3]],
          "triangles": [[0, 1, 2]]},
          "motion": {"type": "vertices", "to": [[0, 0, -1], [1, 0, 4], [0, 1, -1]]}})";
  const SceneResult result =
      check(scene(body("floor") + "," + flag), {.all_pairs = true, .closest = true});
  EXPECT_EQ(result.verdict, Verdict::contact);
  expect_time(result.t, 0.75);
  ASSERT_TRUE(result.closest);
  EXPECT_LE(result.pairs[*result.closest].closest->distance, kTolerance);
  const SceneResult before =
      check(scene(body("floor") + "," + flag, R"("options": {"margin": 1})"));
  expect_time(before.t, 0.5);
}

TEST(CheckScene, AnIgnoredPairIsNotAsked) {
  const SceneResult result = check(scene(kThree, R"("pairs": {"ignore": [["low", "floor"]]})"));
  EXPECT_EQ(result.verdict, Verdict::contact);
  expect_time(result.t, 0.5);
  const SceneResult none =
      check(scene(kThree, R"("pairs": {"ignore": [["low", "floor"], ["floor", "high"]]})"));
  EXPECT_EQ(none.verdict, Verdict::free);
  EXPECT_EQ(none.t, 1.0);
  EXPECT_FALSE(none.first);
}

TEST(CheckScene, APairsMarginReplacesTheScenes) {
  const std::string pairs = R"("pairs": {"margin": [["high", "floor", 1.5]]}, )";
  const SceneResult result =
      check(scene(kThree, pairs + R"("options": {"margin": 0.5})"), {.all_pairs = true});
  EXPECT_EQ(result.pairs[*result.first].members, (BodyPair{0, 1}));
  expect_time(result.t, 0.125);                       // 0.5 m at 4 m/s.
  expect_time(result.pairs[1].t, 0.125);              // Also 0.5 m: a tie.
  EXPECT_EQ(result.pairs[2].verdict, Verdict::free);  // 1 m apart all the time.
}

TEST(CheckScene, GroupsStandForTheirPairs) {
  const std::string groups = R"("groups": {"stones": ["high", "low"], "ground": ["floor"]})";
  const auto time = [&](const std::string& rules) {
    return check(scene(kThree, R"("pairs": {)" + groups + ", " + rules + "}")).t;
  };
  expect_time(time(R"("margin": [["stones", "ground", 0.5]])"), 0.125);
  EXPECT_EQ(time(R"("ignore": [["ground", "stones"]])"), 1.0);
  expect_time(time(R"("ignore": [["stones", "stones"]])"), 0.25);
  expect_time(time(R"("ignore": [["floor", "low"]], "margin": [["stones", "ground", 0.5]])"),
              0.375);
  expect_time(time(R"("margin": [["stones", "ground", 0.5], ["low", "ground", 0]])"), 0.25);
}

TEST(CheckScene, ASceneOfOneBodyIsFree) {
  const SceneResult result = check(scene(body("a")));
  EXPECT_EQ(result.verdict, Verdict::free);
  EXPECT_EQ(result.t, 1.0);
  EXPECT_EQ(result.clearance, std::numeric_limits<double>::infinity());
}

TEST(CheckScene, AContactAtTheStartDecides) {
  const SceneResult result = check(scene(kThree + "," + body("rug", R"("pose": {})")));
  EXPECT_EQ(result.verdict, Verdict::contact_at_start);
  EXPECT_EQ(result.t, 0.0);
  EXPECT_EQ(result.pairs[*result.first].members, (BodyPair{0, 3}));
}

TEST(CheckScene, TheClosestPairIsNamed) {
  const std::string bodies = body("floor") + "," + body("high", falling("9", "-4")) + "," +
                             body("low", falling("6", "-4"));
  const SceneResult result = check(scene(bodies), {.closest = true});
  EXPECT_EQ(result.verdict, Verdict::free);
  ASSERT_TRUE(result.closest);
  const PairAnswer& closest = result.pairs[*result.closest];
  EXPECT_EQ(closest.members, (BodyPair{0, 2}));
  EXPECT_NEAR(closest.closest->distance, 2.0, kTolerance);
  EXPECT_LE(closest.closest->lower_bound, 2.0);
  EXPECT_EQ(closest.closest->t, 1.0);
  EXPECT_EQ(closest.clearance, closest.closest->lower_bound);
}

// The same fall told by waypoints of a longer scene, then rest.
TEST(CheckScene, AllContactsInTimeOfBodies) {
  // Past the floor and back: up and down again at 4 m/s.
  const std::string bounces =
      R"("motion": {"type": "waypoints", "times": [0, 0.5, 1], "poses": [{"position": [0.1, 0.1, 1]},
         {"position": [0.1, 0.1, -1]}, {"position": [0.1, 0.1, 1]}]})";
  const SceneResult result =
      check(scene(body("floor") + "," + body("stone", bounces)), {.all_contacts_in_time = true});
  ASSERT_EQ(result.pairs.size(), 1u);
  const std::vector<ContactInterval>& intervals = result.pairs[0].intervals;
  ASSERT_EQ(intervals.size(), 2u);
  EXPECT_EQ(result.t, intervals[0].enter);
  for (std::size_t k = 0; k < 2; ++k) {
    const double passes = 0.25 + 0.5 * static_cast<double>(k);
    EXPECT_LE(intervals[k].enter, passes);
    EXPECT_NEAR(intervals[k].enter, passes, 1e-6);
    EXPECT_GE(intervals[k].leave, passes);
    EXPECT_NEAR(intervals[k].leave, passes, 1e-5);
    EXPECT_EQ(intervals[k].reason, UndecidedReason::none);
  }
}

TEST(CheckScene, NormalisesTimesToTheDuration) {
  const std::string falls =
      R"("motion": {"type": "waypoints", "times": [1, 3, 8], "poses": [
          {"position": [0.1, 0.1, 1]}, {"position": [0.1, 0.1, -1]}, {"position": [0.1, 0.1, -1]}]})";
  const SceneResult result = check(scene(body("floor") + "," + body("stone", falls)));
  EXPECT_EQ(result.verdict, Verdict::contact);
  EXPECT_LE(result.t * 8.0, 2.0);
  EXPECT_NEAR(result.t * 8.0, 2.0, 1e-5);
}

TEST(CheckScene, AStopLeavesEveryPairUndecided) {
  std::stop_source stop;
  stop.request_stop();
  const SceneResult result = check(scene(kThree), {.stop = stop.get_token()});
  EXPECT_EQ(result.verdict, Verdict::undecided);
  EXPECT_EQ(result.reason, UndecidedReason::cancelled);
  EXPECT_LT(result.t, 1.0);  // The part that the first bounds prove may remain.
}

// Forty pairs: more than are asked side by side.
TEST(CheckScene, AStopBetweenPairsKeepsWhatIsKnown) {
  std::string bodies = body("floor");
  for (int k = 0; k < 40; ++k) {
    bodies += "," + body("stone " + std::to_string(k), falling("1", "-4"));
  }
  std::stop_source stop;
  const SceneResult result = check(
      scene(bodies), {.all_pairs = true, .stop = stop.get_token(), .progress = [&](double done) {
                        if (done > 0.0) {
                          stop.request_stop();
                        }
                      }});
  EXPECT_EQ(result.pairs.front().verdict, Verdict::contact);
  EXPECT_EQ(result.pairs.back().verdict, Verdict::undecided);
  ASSERT_TRUE(result.t_upper);  // The first pairs' contact.
  EXPECT_EQ(*result.t_upper, result.pairs.front().t);
}

TEST(CheckScene, ADeadlineLeavesItUndecided) {
  const SceneResult result = check(scene(kThree, R"("options": {"deadline": 1e-9})"));
  EXPECT_EQ(result.verdict, Verdict::undecided);
  EXPECT_EQ(result.reason, UndecidedReason::deadline);
}

// A law: bodies told in another order give the same time.
TEST(CheckScene, DoesNotHeedTheOrderOfBodies) {
  std::vector<std::string> bodies{body("floor"), body("high", falling("2", "-4")),
                                  body("low", falling("1", "-4"))};
  const double t = check(scene(kThree)).t;
  std::sort(bodies.begin(), bodies.end());
  do {
    EXPECT_EQ(check(scene(bodies[0] + "," + bodies[1] + "," + bodies[2])).t, t);
  } while (std::next_permutation(bodies.begin(), bodies.end()));
}

}  // namespace
}  // namespace firstcontact
