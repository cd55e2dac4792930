// Names and rules of "pairs".

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::body;
using test::scene;

const std::string kThreeBodies = body("a") + "," + body("b") + "," + body("c");

Scene with_pairs(const std::string& pairs) {
  return parse_scene(scene(kThreeBodies, "\n\"pairs\": {" + pairs + "}"), "s");
}

std::string refusal_of(const std::string& pairs) {
  return test::message_of<ParseError>([&] { (void)with_pairs(pairs); });
}

TEST(PairRulesFile, PutsBodiesInOrderAndEachPairOnce) {
  const Scene read = with_pairs(R"("groups": {"g": ["c", "a"], "h": ["b", "c"]},
      "ignore": [["c", "a"], ["g", "b"]], "margin": [["c", "h", 0.5], ["b", "a", 0]])");
  EXPECT_EQ(read.ignored_pairs, (std::vector<BodyPair>{{0, 2}, {1, 2}, {0, 1}}));
  ASSERT_EQ(read.pair_margins.size(), 2u);  // c is in h: it has no margin to itself.
  EXPECT_EQ(read.pair_margins[0].bodies, (BodyPair{1, 2}));
  EXPECT_EQ(read.pair_margins[0].margin, 0.5);
  EXPECT_EQ(read.pair_margins[1].bodies, (BodyPair{0, 1}));
  EXPECT_TRUE(read.ignored_groups.empty());
}

TEST(PairRulesFile, KeepsGroupsAsGroups) {
  const Scene read = with_pairs(R"("groups": {"g": ["a", "a"], "h": ["b", "c"]},
      "ignore": [["h", "h"]], "margin": [["h", "g", 0.5], ["g", "h", 0.25]])");
  ASSERT_EQ(read.groups.size(), 2u);
  EXPECT_EQ(read.groups[1].name, "h");
  EXPECT_EQ(read.groups[1].bodies, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(read.ignored_groups, (std::vector<GroupPair>{{1, 1}}));
  ASSERT_EQ(read.group_margins.size(), 2u);  // The greatest holds.
  EXPECT_EQ(read.group_margins[0].groups, (GroupPair{1, 0}));
}

TEST(PairRulesFile, SaysWhereWhatIsWrongAndWhatToWrite) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"("ignore": [["a", "bb"]])", R"(expected the name of a body, got "bb")"},
      {R"("ignore": [["a", "nothing"]])", R"(expected the name of a body, got "nothing")"},
      {R"("ignore": [["a", "a"]])", "expected two bodies, got one twice"},
      {R"("margin": [["b", "b", 1]])", "expected two bodies, got one twice"},
      {R"("ignore": [["a"]])", R"(expected a pair of names, such as ["a", "b"], got)"},
      {R"("ignore": [["a", "b", "c"]])", R"(expected a pair of names, such as ["a", "b"], got)"},
      {R"("ignore": ["a"])", R"(expected a pair of names, such as ["a", "b"], got)"},
      {R"("ignore": {})", "expected an array of pairs of names, got"},
      {R"("margin": [["a", "b"]])", R"(expected two names and a margin, such as ["a", "b", 0.01])"},
      {R"("margin": [["a", "b", -1]])", "expected a number >= 0, got -1"},
      {R"("margin": [["a", "b", 1], ["b", "a", 1]])",
       "expected one margin for each pair, got a second one"},
      {R"("groups": [])", R"(expected an object of groups, such as {"fixtures": ["a", "b"]}, got)"},
      {R"("groups": {"g": ["d"]})", R"(expected the name of a body, got "d")"},
      {R"("groups": {"a": []})", "expected for the group a name that no body has"},
      {R"("groups": {"": []})", "expected for the group a name that no body has"},
      {R"("groups": {"g": []}, "ignore": [["g", "x"]])",
       R"(expected the name of a body or group, got "x")"},
      {R"("ignored": [])", R"(did you mean "ignore"?)"},
  };
  for (const auto& [pairs, message] : cases) {
    const std::string said = refusal_of(pairs);
    EXPECT_EQ(said.substr(0, 5), "s:2: ") << pairs;  // The line of the rule.
    EXPECT_NE(said.find(message), std::string::npos) << pairs << "\n" << said;
  }
  EXPECT_EQ(refusal_of(R"("margin": [["a", "b", 0]])"), "accepted");
}

TEST(PairRulesFile, NamesRobotsAndLinksWhereThereAreSome) {
  const test::ArmFolder folder;
  const auto read = [&](const std::string& pairs) {
    return parse_scene(R"({"firstcontact": 1, "bodies": [)" + body("a") + R"(],
        "robots": [{"name": "r", "urdf": "arm.urdf"}], "pairs": {)" +
                           pairs + "}}",
                       folder.path() / "s.json");
  };
  const auto said = [&](const std::string& pairs) {
    const std::string text = test::message_of<ParseError>([&] { (void)read(pairs); });
    return text.substr(text.find("expected"));
  };
  EXPECT_EQ(said(R"("ignore": [["a", "r/tipp"]])"),
            R"(expected the name of a body or robot, or robot/link, got "r/tipp"; did you mean )"
            R"("r/tip"?)");
  EXPECT_EQ(said(R"("groups": {"g": []}, "ignore": [["a", "no such name"]])"),
            R"(expected the name of a body, robot or group, or robot/link, got "no such name")");
  EXPECT_EQ(said(R"("groups": {"g": ["r/tipp"]})"),
            R"(expected the name of a body or robot, or robot/link, got "r/tipp"; did you mean )"
            R"("r/tip"?)");
  EXPECT_EQ(said(R"("groups": {"r/tip": ["a"]})"),
            "expected for the group a name that no body, robot or link has");
  // A robot with itself: all pairs of its links.
  EXPECT_EQ(read(R"("ignore": [["r", "r"]])").ignored_pairs,
            (std::vector<BodyPair>{{1, 2}, {1, 3}, {2, 3}}));
}

TEST(PairRulesFile, RefusesABodyThatIsCalledAsALink) {
  const test::ArmFolder folder;
  const auto read = [&](const std::string& name) {
    return parse_scene(R"({"firstcontact": 1, "bodies": [)" + body(name) +
                           R"(], "robots": [{"name": "r", "urdf": "arm.urdf"}]})",
                       folder.path() / "s.json");
  };
  const std::string said = test::message_of<ParseError>([&] { (void)read("r/tip"); });
  EXPECT_NE(said.find(R"(robots[0].name: expected a name by which no link is called as a body or )"
                      R"(another robot, but "r/tip" is there already; rename one of them)"),
            std::string::npos)
      << said;
  EXPECT_EQ(read("r/top").bodies.size(), 1u);
}

}  // namespace
}  // namespace firstcontact
