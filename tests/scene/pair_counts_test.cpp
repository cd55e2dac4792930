#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/pair_counts.h>

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/read_scene.h>

#include "scene/robot_text.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::body;
using test::falling;
using test::scene;

LoadedScene loaded_of(const std::string& text, const std::filesystem::path& source = "s") {
  ShapeCache cache;
  return load_scene(parse_scene(text, source), cache);
}

std::size_t count_of(const PairCounts& counts, WhyUntested why) {
  for (const UntestedPairs& pairs : counts.untested) {
    if (pairs.why == why) {
      return pairs.count;
    }
  }
  return 0;
}

/// Each pair is there once.
void expect_complete(const PairCounts& counts) {
  EXPECT_EQ(counts.tested + counts.ignored() + counts.left_out(),
            counts.members * (counts.members - 1) / 2);
}

std::string names_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "\"" : ", \"") + name + '"';
  }
  return "[" + text + "]";
}

/// A scene whose bodies may rest, be scripted or free, with rules by pairs and groups that overlap.
std::string random_scene(std::mt19937& rng) {
  const auto any = [&rng](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(rng);
  };
  const std::size_t n = 1 + any(14);
  std::vector<std::string> names;
  std::string bodies;
  for (std::size_t k = 0; k < n; ++k) {
    names.push_back("b" + std::to_string(k));
    const std::string kinds[] = {"", falling("1", "-4"), R"("dynamics": {"mass": 1})"};
    bodies += (k == 0 ? "" : ",") + body(names.back(), kinds[any(3)]);
  }
  std::string groups;
  for (std::size_t g = 0; g < 4; ++g) {
    std::vector<std::string> members;
    for (std::size_t k = any(n + 1); k > 0; --k) {
      members.push_back(names[any(n)]);
    }
    groups += (g == 0 ? "\"g" : ", \"g") + std::to_string(g) + "\": " + names_of(members);
  }
  std::string ignored;
  for (std::size_t k = any(12); k > 0; --k) {
    const std::size_t a = any(n);
    const std::size_t b = any(n);
    const bool by_group = any(3) == 0;
    if (by_group || a != b) {
      ignored += (ignored.empty() ? "" : ", ") +
                 (by_group ? names_of({"g" + std::to_string(any(4)), "g" + std::to_string(any(4))})
                           : names_of({names[a], names[b]}));
    }
  }
  return scene(bodies, R"("pairs": {"groups": {)" + groups + R"(}, "ignore": [)" + ignored + "]}");
}

// The rules themselves are the oracle: each pair is asked.
TEST(PairCounts, AgreeWithTheRulesOfEveryPair) {
  std::mt19937 rng(5);
  for (int round = 0; round < 300; ++round) {
    const std::string text = random_scene(rng);
    const LoadedScene loaded = loaded_of(text);
    const std::vector<Body>& bodies = loaded.scene.bodies;
    std::size_t tested = 0;
    std::size_t simulated = 0;
    for (std::size_t a = 0; a < bodies.size(); ++a) {
      for (std::size_t b = a + 1; b < bodies.size(); ++b) {
        const bool is_asked = loaded.bodies.rules().margin({a, b}).has_value();
        tested += is_asked ? 1 : 0;
        simulated += is_asked && (bodies[a].free || bodies[b].free) ? 1 : 0;
      }
    }
    ASSERT_EQ(loaded.pair_counts.tested, tested) << text;
    expect_complete(loaded.pair_counts);
    const PairCounts counts = count_simulated_pairs(loaded);
    ASSERT_EQ(counts.tested, simulated) << text;
    EXPECT_EQ(counts.ignored(), loaded.pair_counts.ignored());
    expect_complete(counts);
    for (const UntestedPairs& pairs : counts.untested) {
      EXPECT_EQ(pairs.first.size(), std::min<std::size_t>(pairs.count, 3)) << text;
    }
  }
}

TEST(PairCounts, NameTheFirstPairsAndTheirReason) {
  const LoadedScene loaded = loaded_of(scene(body("a") + "," + body("b") + "," + body("c"),
                                             R"("pairs": {"ignore": [["c", "a"], ["a", "b"]]})"));
  EXPECT_EQ(loaded.pair_counts.tested, 1u);
  ASSERT_EQ(loaded.pair_counts.untested.size(), 1u);
  EXPECT_EQ(describe(loaded.pair_counts.untested[0]), "2 by the scene's rules: a and c, a and b");
  EXPECT_EQ(no_pair_warning(loaded.pair_counts), "");
}

TEST(PairCounts, WarnWhereNoPairIsTested) {
  EXPECT_EQ(no_pair_warning(loaded_of(scene(body("a"))).pair_counts),
            "no pair is tested: this answer says nothing about contact; there is only one body");
  const LoadedScene ignored =
      loaded_of(scene(body("a") + "," + body("b"), R"("pairs": {"ignore": [["a", "b"]]})"));
  EXPECT_EQ(no_pair_warning(ignored.pair_counts),
            "no pair is tested: this answer says nothing about contact; 1 by the scene's rules: a "
            "and b");
}

// A scripted ball that passes through a resting plate beside a free one.
TEST(PairCounts, OfASimulationLeaveOutWhatIsNotFree) {
  const PairCounts counts = count_simulated_pairs(
      loaded_of(scene(body("scripted", falling("1", "-2")) + "," + body("plate") + "," +
                      body("wall") + "," + body("free", R"("dynamics": {"mass": 1})"))));
  EXPECT_EQ(counts.tested, 3u);
  EXPECT_EQ(count_of(counts, WhyUntested::both_scripted), 2u);
  EXPECT_EQ(count_of(counts, WhyUntested::both_rest), 1u);
  for (const UntestedPairs& pairs : counts.untested) {
    if (pairs.why == WhyUntested::both_scripted) {
      EXPECT_EQ(describe(pairs),
                "2 of which neither is free (they may pass through each other): scripted and "
                "plate, scripted and wall");
    }
  }
}

/// A scene with one arm and two bodies; `arm` and `more` are other keys.
LoadedScene loaded_arm(const test::ArmFolder& folder, const std::string& arm,
                       const std::string& more = "") {
  return loaded_of(
      R"({"firstcontact": 1, "bodies": [)" + body("a") + "," + body("b", falling("9", "-1")) +
          R"(], "robots": [{"name": "arm", "urdf": "arm.urdf", "trajectory": "move.csv")" + arm +
          "}]" + more + "}",
      folder.path() / "s.json");
}

// Only over the whole step: a pair that is tested for a part of it is tested.
TEST(PairCounts, IgnoreWhatALinkHoldsAllTheTime) {
  const test::ArmFolder folder;
  const std::string held = R"(, "attached": [{"body": "b", "link": "tip", "touch_links": ["bar"])";
  const PairCounts always = loaded_arm(folder, held + "}]").pair_counts;
  EXPECT_EQ(count_of(always, WhyUntested::held), 2u);
  EXPECT_EQ(count_of(always, WhyUntested::joined_links), 1u);
  EXPECT_EQ(always.tested, 3u);  // a with b, bar and tip.
  expect_complete(always);
  for (const char* times : {R"(, "from_time": 1}])", R"(, "to_time": 3}])"}) {
    const PairCounts for_a_while = loaded_arm(folder, held + times).pair_counts;
    EXPECT_EQ(count_of(for_a_while, WhyUntested::held), 0u) << times;
    EXPECT_EQ(for_a_while.tested, 5u) << times;
    expect_complete(for_a_while);
  }
}

// Each pair counts once, for the first of its reasons.
TEST(PairCounts, CountAPairForItsFirstReason) {
  const test::ArmFolder folder;
  folder.write("arm2.srdf",
               R"(<robot name="arm"><disable_collisions link1="bar" link2="tip"/></robot>)");
  const std::string rules =
      R"(, "pairs": {"ignore": [["arm/bar", "arm/tip"], ["b", "arm/tip"], ["a", "b"]]})";
  LoadedScene loaded = loaded_arm(
      folder, R"(, "srdf": "arm2.srdf", "attached": [{"body": "b", "link": "tip"}])", rules);
  const PairCounts counts = loaded.pair_counts;
  EXPECT_EQ(count_of(counts, WhyUntested::joined_links), 1u);
  EXPECT_EQ(count_of(counts, WhyUntested::srdf), 0u);
  EXPECT_EQ(count_of(counts, WhyUntested::held), 1u);
  EXPECT_EQ(count_of(counts, WhyUntested::rule), 1u);
  expect_complete(counts);
  loaded.scene.allowed_pairs = {{0, 1}};  // As a planning scene has them.
  const PairCounts allowed = count_checked_pairs(loaded);
  EXPECT_EQ(count_of(allowed, WhyUntested::allowed_collisions), 1u);
  EXPECT_EQ(count_of(allowed, WhyUntested::rule), 0u);
  EXPECT_EQ(allowed.tested, counts.tested);
  expect_complete(allowed);
}

TEST(PairCounts, AreInWords) {
  EXPECT_EQ(pairs_text(0), "no pair");
  EXPECT_EQ(pairs_text(1), "1 pair");
  EXPECT_EQ(pairs_text(12), "12 pairs");
  EXPECT_EQ(describe({.why = WhyUntested::srdf, .count = 5, .first = {{"a", "b"}}}),
            "5 by the SRDF: a and b, and 4 more");
  EXPECT_EQ(describe({.why = WhyUntested::joined_links, .count = 2}),
            "2 of links that joints connect");
  EXPECT_EQ(std::string(word(WhyUntested::both_scripted)), "both_scripted");
  EXPECT_TRUE(is_ignored(WhyUntested::held));
  EXPECT_FALSE(is_ignored(WhyUntested::both_rest));
}

TEST(PairCounts, OfRobotsAgreeWithTheSceneOfMembers) {
  const test::ArmFolder folder;
  folder.write("arm2.srdf",
               R"(<robot name="arm"><disable_collisions link1="base" link2="tip"/></robot>)");
  const LoadedScene loaded = loaded_of(R"({"firstcontact": 1, "bodies": [)" + body("a") + "," +
                                           body("b") + "," + body("c", falling("9", "-1")) + R"(],
      "robots": [{"name": "one", "urdf": "arm.urdf", "srdf": "arm2.srdf"},
                 {"name": "two", "urdf": "arm.urdf", "base": {"position": [5, 5, 5]}}],
      "pairs": {"ignore": [["one", "a"]]}})",
                                       folder.path() / "s.json");
  const RobotScene& members = *loaded.robots;
  std::size_t tested = 0;
  for (std::size_t a = 0; a < members.size(); ++a) {
    for (std::size_t b = a + 1; b < members.size(); ++b) {
      tested +=
          !members.geometries(a).empty() && !members.geometries(b).empty() && members.margin({a, b})
              ? 1
              : 0;
    }
  }
  const PairCounts& counts = loaded.pair_counts;
  EXPECT_EQ(counts.tested, tested);
  EXPECT_EQ(counts.members, 7u);  // The two bases have nothing that can touch.
  EXPECT_EQ(count_of(counts, WhyUntested::joined_links), 2u);
  EXPECT_EQ(count_of(counts, WhyUntested::both_rest), 1u);
  EXPECT_EQ(count_of(counts, WhyUntested::rule), 2u);
  expect_complete(counts);
}

}  // namespace
}  // namespace firstcontact
