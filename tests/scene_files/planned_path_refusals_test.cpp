// Path files: what is no path is named with its place and its mend.

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/write_json.h>

#include "scene/load_text.h"
#include "scene_files/planned_path_case.h"

namespace firstcontact {
namespace {

using test::message_of;
using test::PlannedPathFile;

std::string path_said_of(const std::string& text) {
  std::string message =
      message_of<ParseError>([&] { (void)parse_planned_path(text, "path.json"); });
  const std::string place = "path.json:1: ";
  return message.starts_with(place) ? message.substr(place.size()) : message;
}

/// Returns the message about the path's file with `from` replaced by `to`.
std::string path_said(const PlannedPath& path, const std::string& from, const std::string& to) {
  std::string text = write_planned_path(path);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << " in " << text;
  return path_said_of(at == std::string::npos ? text : text.replace(at, from.size(), to));
}

/// Each replacement of the path's file, and the message of it.
struct BrokenPath {
  std::string from;
  std::string to;
  std::string message;
};

void expect_path_messages(const PlannedPath& path, const std::vector<BrokenPath>& cases) {
  for (const auto& [from, to, message] : cases) {
    EXPECT_EQ(path_said(path, from, to), message) << from << " -> " << to;
  }
}

TEST_F(PlannedPathFile, SaysWhatIsNoPath) {
  const std::string none = "expected a path, an object with \"firstcontact_path\": 1";
  for (const char* text : {"[]", "7", "{}", R"({"firstcontact_path": 2})",
                           R"({"firstcontact_path": "1"})", R"({"firstcontact": 1})"}) {
    EXPECT_EQ(path_said_of(text), none) << text;
  }
  EXPECT_EQ(path_said_of(R"({"firstcontact_path": 1})"), "expected an object with a \"scene\"");
  EXPECT_EQ(path_said_of(R"({"firstcontact_path": 1, "scene": {}})"),
            "scene: expected \"firstcontact\": 1, the version of the scene format");
  EXPECT_EQ(
      path_said_of("{\"firstcontact_path\": 1,\n\"scene\": {\"firstcontact\": 1, \"bodies\": []}}"),
      "path.json:2: scene: bodies: expected at least one body, got none");
  EXPECT_EQ(path_said_of(""),
            "expected a value (object, array, string, number, true, false or null), got the end of "
            "the text");
}

TEST_F(PlannedPathFile, NamesEveryKeyThatIsNotThere) {
  const detail::JsonValue whole = detail::parse_json(write_planned_path(of_body()), "whole");
  const auto said_without = [&](const std::string& object, std::size_t which) {
    detail::JsonValue root = whole;
    auto& members = std::get<detail::JsonObject>(root.value);
    detail::JsonObject* from = &members;
    for (detail::JsonMember& member : members) {
      if (member.key == object) {
        from = &std::get<detail::JsonObject>(member.value.value);
      }
    }
    from->erase(from->begin() + static_cast<std::ptrdiff_t>(which));
    return path_said_of(detail::write_json(root));
  };
  std::size_t named = 0;
  const auto& members = std::get<detail::JsonObject>(whole.value);
  for (std::size_t k = 0; k < members.size(); ++k) {
    const std::string& key = members[k].key;
    if (key != "firstcontact_path" && key != "scene") {
      EXPECT_EQ(said_without("", k), "expected a key \"" + key + "\", got none");
      ++named;
    }
  }
  for (const std::string object : {"planner", "statistics"}) {
    const auto& inside = std::get<detail::JsonObject>(detail::find(members, object)->value);
    for (std::size_t k = 0; k < inside.size(); ++k) {
      const std::string& key = inside[k].key;
      EXPECT_EQ(said_without(object, k),
                key == "contacts" ? "accepted"  // Files of before have none.
                                  : object + ": expected a key \"" + key + "\", got none");
      ++named;
    }
  }
  EXPECT_EQ(named, 18u + 4u + 9u);
}

TEST_F(PlannedPathFile, SaysWhatIsWrongWithNumbersAndWords) {
  expect_path_messages(
      of_body(),
      {{R"("firstcontact_path":1,)", R"("firstcontact_path":1,"extra":1,)",
        "extra: unknown key; did you mean \"extra_clearance\"?"},
       {R"("cost":)", R"("cots":)", "cots: unknown key; did you mean \"cost\"?"},
       {R"("cost":3)", R"("cost":-3)", "cost: expected a number >= 0, got -3"},
       {R"("cost":3)", R"("cost":3,"cost":3)",
        "expected each key once, got \"cost\" again (first on line 1)"},
       {R"("cost":3)", R"("cost":1e400)",
        "expected a number that fits a double (at most 1.8e308 in size), got \"1e400\""},
       {R"("cost":3)", R"("cost":NaN)",
        "expected a finite number, got \"NaN\"; JSON has no NaN and no infinity"},
       {R"("verdict":"proven")", R"("verdict":"prooven")",
        "verdict: unknown word \"prooven\"; did you mean \"proven\"?"},
       {R"("verdict":"proven")", R"("verdict":true)",
        "verdict: expected one of \"proven\", \"approximate\", got true"},
       {R"("margin":0.01)", R"("margin":null)", "margin: expected a number, got null"},
       {R"("tolerance":1e-06)", R"("tolerance":0)", "tolerance: expected a number > 0, got 0"},
       {R"("extra_clearance":0)", R"("extra_clearance":"0")",
        "extra_clearance: expected a number, got \"0\""},
       {R"("clearance":0.25,"goals")", R"("clearance":-1e-300,"goals")",
        "clearance: expected a number >= 0, got -1e-300"},
       {R"("distance_to_goal":0)", R"("distance_to_goal":[])",
        "distance_to_goal: expected a number, got an array of 0"},
       {R"("name":"rrt_connect")", R"("name":"rrt")",
        "planner.name: unknown word \"rrt\"; known are \"rrt_connect\", \"lazy_prm_star\""},
       {R"("contacts":"none")", R"("contacts":"glide")",
        "planner.contacts: unknown word \"glide\"; did you mean \"slide\"?"},
       {R"("seed":1)", R"("seed":0.5)",
        "planner.seed: expected a whole number, an integer from 0 to 9007199254740991, got 0.5"},
       {R"("seed":1)", R"("seed":9007199254740992)",
        "planner.seed: expected a whole number, an integer from 0 to 9007199254740991, got "
        "9007199254740992"},
       {R"("seed":1,"time":1)", R"("seed":1,"time":0)",
        "planner.time: expected a number > 0, got 0"},
       {R"("nodes":0)", R"("nodes":-1)",
        "statistics.nodes: expected a whole number, an integer from 0 to 9007199254740991, got -1"},
       {R"("seconds":0)", R"("seconds":-1)", "statistics.seconds: expected a number >= 0, got -1"},
       {R"("blocked":[{"pair":["wall","peg"])", R"("blocked":[{"pair":["wall"])",
        "statistics.blocked[0].pair: expected a pair of names, got an array of 1"},
       {R"("blocked":[{"pair":["wall","peg"])", R"("blocked":[{"pair":["wall",""])",
        "statistics.blocked[0].pair[1]: expected a name, got \"\""},
       {R"("version":"1.2.3")", R"("version":1.2)", "version: expected a string, got 1.2"},
       {R"("input_digest":"aa)", R"("input_digest":"a)",
        "input_digest: expected a SHA-256 in hexadecimal, got \"" + std::string(60, 'a') +
            "...\""}});
}

TEST_F(PlannedPathFile, SaysWhatDoesNotBelongTogether) {
  const std::string goal = R"("goal":1)";
  expect_path_messages(
      of_body(),
      {{R"("waypoints":[[0,0,0,0,0,0,0])", R"("waypoints":[[0,0,0,0,0,0])",
        "waypoints[0]: expected 7 numbers, got 6"},
       {R"("waypoints":[[0,)", R"("waypoints":[[null,)",
        "waypoints[0][0]: expected a number, got null"},
       {R"("waypoints":[)", R"("waypoints":[7,)", "waypoints[0]: expected a waypoint, got 7"},
       {R"("waypoints":[[0,0,0,0,0,0,0],)", R"("waypoints":[)",
        "edges: expected an edge for each two neighbouring waypoints, 1, got 2"},
       {R"("edges":[{"verdict":"proven","clearance":0.25},)", R"("edges":[)",
        "edges: expected an edge for each two neighbouring waypoints, 2, got 1"},
       {R"("edges":[{"verdict":"proven")", R"("edges":[{"verdict":"approximate")",
        "edges[0].verdict: unknown word \"approximate\"; known are \"proven\""},
       {R"("clearance":0.25})", R"("clearance":0.25,"t":0})",
        "edges[0].t: unknown key; known are \"verdict\", \"clearance\""},
       {R"("goals":[[2,2,2,2,2,2,2],[1,1,1,1,1,1,1]])", R"("goals":[])",
        "goals: expected at least one waypoint, got an array of 0"},
       {goal, R"("goal":2)", "goal: expected the number of a goal, an integer from 0 to 1, got 2"},
       {goal, R"("goal":0)", "goal: expected the goal that the last waypoint is, got another one"},
       {goal, R"("goal":null)",
        "goal: expected a goal in a proven path, and null in an approximate one"},
       {R"("verdict":"proven","moves")", R"("verdict":"approximate","moves")",
        "goal: expected a goal in a proven path, and null in an approximate one"},
       {R"({"body":"peg"})", R"({"body":"pog"})",
        "moves.body: expected a name that the scene has, got \"pog\""},
       {R"({"body":"peg"})", R"({"body":""})", "moves.body: expected the name of a body, got \"\""},
       {R"({"body":"peg"})", R"({"body":"peg","robot":"arm"})",
        "moves.robot: expected a name that the scene has, got \"arm\""},
       {R"({"body":"peg"})", "{}", "moves: expected a key \"robot\", got none"},
       {R"({"body":"peg"})", "[]",
        "moves: expected an object with \"robot\", \"robots\", \"joints\", \"turning\", \"body\", "
        "got an array of 0"},
       {R"("resolved_digest":")", R"("resolved_digest":"0)",
        "resolved_digest: the scene in the path is not the one that it was planned in; plan it "
        "again"},
       {R"("radius":0)", R"("radius":1e-300)",
        "resolved_digest: the scene in the path is not the one that it was planned in; plan it "
        "again"}});
}

TEST_F(PlannedPathFile, SaysWhatIsWrongWithTimes) {
  const std::string times = R"("times":[0,0.25,1])";
  const std::string ends = "times: expected times from 0 to the duration of the scene";
  const std::string all = "times: expected a time for each of the 3 waypoints, at least two";
  expect_path_messages(
      in_time(),
      {{times, R"("times":[0,0.25,0.25])", "times[2]: expected times that increase strictly"},
       {times, R"("times":[0,0.5,0.25])", "times[2]: expected times that increase strictly"},
       {times, R"("times":[-1,0.25,1])", "times[0]: expected a number >= 0, got -1"},
       {times, R"("times":[0.125,0.25,1])", ends},
       {times, R"("times":[0,0.25,0.75])", ends},
       {times, R"("times":[0,0.25,1.5])", ends},
       {times, R"("times":[0,1])", all},
       {times, R"("times":[])", all},
       {times, R"("times":null)", "times: expected an array of times, got null"}});
}

TEST_F(PlannedPathFile, SaysWhatIsWrongWithPairsInContact) {
  PlannedPath path = of_body();
  path.contact_pairs = {{.pair = {"peg", "wall"},
                         .policy = ContactPolicy::must_open,
                         .at = PathEnd::goal,
                         .distance = 0.5}};
  const std::string pair = "contact_pairs[0]";
  expect_path_messages(
      path,
      {{R"("distance":0.5)", R"("distance":0)", pair + ".distance: expected a number > 0, got 0"},
       {R"("at":"goal")", R"("at":"end")",
        pair + ".at: unknown word \"end\"; known are \"start\", \"goal\""},
       {R"("policy":"must_open")", R"("policy":"must_opn")",
        pair + ".policy: unknown word \"must_opn\"; did you mean \"must_open\"?"},
       {R"("at":"goal",)", "", pair + ": expected a key \"at\", got none"},
       {R"("pair":["peg","wall"],"policy")", R"("pair":["peg","wall","peg"],"policy")",
        pair + ".pair: expected a pair of names, got an array of 3"},
       {R"("contact_pairs":[)", R"("contact_pairs":[7,)",
        pair + ": expected an object with \"pair\", \"policy\", \"at\", \"distance\", got 7"}});
}

TEST_F(PlannedPathFile, SaysWhatIsWrongWithJoints) {
  const std::string moves = R"({"robot":"right","joints":["elbow"],"turning":["short"]})";
  const std::string count = "moves: expected at least one joint, and a turning for each";
  expect_path_messages(
      of_robots({"right"}),
      {{moves, R"({"robot":"rihgt","joints":["elbow"],"turning":["short"]})",
        "moves.robot: expected a name that the scene has, got \"rihgt\""},
       {moves, R"({"robot":"right","robots":["left","right"],"joints":[],"turning":[]})",
        "moves: expected either \"robot\" or \"robots\", got both"},
       {moves, R"({"robot":"right","joints":[],"turning":[]})", count},
       {moves, R"({"robot":"right","joints":["elbow"],"turning":[]})", count},
       {moves, R"({"robot":"right","joints":["elbow"],"turning":["shortest"]})",
        "moves.turning[0]: unknown word \"shortest\"; did you mean \"short\"?"},
       {moves, R"({"robot":"right","joints":["elbow","elbow"],"turning":[]})",
        "moves.joints[1]: expected each joint once, got one twice"},
       // A fixed joint has nothing that could be planned.
       {moves, R"({"robot":"right","joints":["weld"],"turning":["short"]})",
        "moves.joints[0]: expected the name of a joint of the robot, got \"weld\""},
       {moves, R"({"robot":"right","joints":"elbow","turning":["short"]})",
        "moves.joints: expected names of joints, got \"elbow\""},
       {moves, R"({"robot":"right","turning":["short"]})",
        "moves: expected a key \"joints\", got none"}});
}

}  // namespace
}  // namespace firstcontact
