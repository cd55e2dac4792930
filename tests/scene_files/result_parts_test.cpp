// Parts of results: contacts, counts, joints, and what is read back of them; and scenes inside of
// other files.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/query/verdict_words.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/check_lines.h>
#include <firstcontact/scene_files/detail/contact_json.h>
#include <firstcontact/scene_files/read_result.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/read_simulation_scene.h>
#include <firstcontact/scene_files/write_reports.h>
#include <firstcontact/scene_files/write_result.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/write_json.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "scene/scene_bits.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::message_of;

TEST(ContactArray, WritesWhatIsUndefinedAsNull) {
  detail::ContactArray array(0.5, false);
  array.set_names(detail::parse_json(R"(["a \"b\"", "\u20ac"])", "names"));
  Contact contact;
  contact.feature_A = {.type = FeatureType::edge, .index = 4294967295, .triangle = 2};
  contact.feature_B = {.type = FeatureType::face, .index = 7, .triangle = 7};
  contact.p_WA = {0.1, -0.0, 1e300};
  contact.distance = std::numeric_limits<double>::quiet_NaN();
  contact.normal_velocity = -2.0;
  array.add(contact);
  EXPECT_EQ(detail::write_json(array.take()),
            R"([{"bodies":["a \"b\"",")"
            "\xe2\x82\xac"
            R"("],"features":[{"type":"edge","index":4294967295},{"type":"face","index":7}],)"
            R"("triangles":[2,7],"points":[[0.1,-0,1e+300],[0,0,0]],"normal":null,)"
            R"("distance":null,"normal_velocity":-4}])");
}

TEST(ContactArray, NamesEachPairAndItsGeometries) {
  detail::ContactArray array(1.0, true);
  array.set_names(detail::parse_json(R"(["a", "b"])", "names"));
  Contact contact;
  contact.n_AB_W = Eigen::Vector3d(0, 0, -1);
  contact.geometries = {3, 1};
  array.add(contact);
  array.set_names(detail::parse_json(R"(["c", "d"])", "names"));
  array.add(contact);
  const detail::JsonValue read = detail::parse_json(detail::write_json(array.take()), "contacts");
  const auto& both = std::get<detail::JsonArray>(read.value);
  ASSERT_EQ(both.size(), 2u);
  const auto& first = std::get<detail::JsonObject>(both[0].value);
  EXPECT_EQ(detail::write_json(*detail::find(first, "normal")), "[0,0,-1]");
  EXPECT_EQ(detail::write_json(*detail::find(first, "geometries")), "[3,1]");
  const auto& second = std::get<detail::JsonObject>(both[1].value);
  EXPECT_EQ(detail::write_json(*detail::find(second, "bodies")), R"(["c","d"])");
  EXPECT_EQ(detail::write_json(detail::ContactArray(1.0, true).take()), "[]");
}

// A count of none claims nothing, whether it is exact or not.
TEST(ContactCounts, SayWhetherTheyAreLeast) {
  const auto written = [](std::uint64_t at_least, bool is_exact) {
    detail::JsonObject object;
    detail::append_contact_count({.at_least = at_least, .is_exact = is_exact}, object);
    return detail::write_json({.value = std::move(object)});
  };
  EXPECT_EQ(written(3, true), R"({"contact_count":3})");
  EXPECT_EQ(written(3, false), R"({"contact_count":3,"contact_count_is_least":true})");
  EXPECT_EQ(written(0, false), R"({"contact_count":0})");
}

TEST(WritePairCounts, NamesEveryReason) {
  PairCounts counts{.members = 9, .tested = 3, .untested = {}};
  for (std::size_t k = 0; k < kWhyUntestedWords.size(); ++k) {
    counts.untested.push_back({.why = static_cast<WhyUntested>(k), .count = 10 + k, .first = {}});
  }
  counts.untested[0].first = {{"a \"b\"", "c"}};
  const std::string text = write_pair_counts(counts);
  EXPECT_EQ(text.substr(0, 48), R"({"tested":3,"ignored":60,"left_out":31,"untested)");
  EXPECT_NE(text.find(R"({"why":"joined_links","count":10,"first":[["a \"b\"","c"]]})"),
            std::string::npos)
      << text;
  for (std::size_t k = 1; k < kWhyUntestedWords.size(); ++k) {
    EXPECT_NE(text.find(R"({"why":")" + std::string(kWhyUntestedWords.at(k)) + R"(","count":)" +
                        std::to_string(10 + k) + R"(,"first":[]})"),
              std::string::npos)
        << text;
  }
  EXPECT_EQ(write_file_reports({}), "[]");
}

/// The result of a robot that turns, and the value of one of its keys.
std::string robot_result(const test::ArmFolder& folder, const std::string& keys,
                         std::string_view key) {
  const LoadedScene loaded =
      test::load_text(R"({"firstcontact": 1, "robots": [{"name": "r", "urdf": )" + keys + "}]}",
                      folder.path() / "s.json");
  ManyBodiesWorkspace workspace;
  const std::string text = write_result(loaded, check_scene(loaded, workspace));
  const detail::JsonValue root = detail::parse_json(text, "result");
  const detail::JsonValue* value = detail::find(std::get<detail::JsonObject>(root.value), key);
  return value == nullptr ? "none" : detail::write_json(*value);
}

TEST(WriteResult, SaysWhenARobotLeavesItsLimits) {
  const test::ArmFolder folder;
  folder.write("out.csv", "time,elbow\n0,0\n4,3\n");
  const std::string limits =
      robot_result(folder, R"("arm.urdf", "trajectory": "out.csv")", "limits");
  // Above 1.5 rad from 2 s on, and by 1.5 rad at the end.
  const std::string said = R"({"robot":"r","joint":"elbow","limit":"upper_position","value":1.5,)"
                           R"("excess":1.5,"time":4,"intervals":[[)";
  const std::size_t at = limits.find(said);
  ASSERT_NE(at, std::string::npos) << limits;
  const std::string interval = limits.substr(at + said.size());
  EXPECT_NEAR(std::stod(interval), 2.0, 1e-8);
  EXPECT_NE(interval.find(",4]]}"), std::string::npos) << limits;
  EXPECT_EQ(robot_result(folder, R"("arm.urdf", "state": {"elbow": 1})", "limits"), "[]");
  EXPECT_EQ(robot_result(folder, R"("arm.urdf", "trajectory": "out.csv")", "turns"), "none");
}

TEST(WriteResult, SaysHowContinuousJointsTurn) {
  const test::ArmFolder folder;
  folder.write("spin.urdf", R"(<robot name="s"><link name="a"/>
      <link name="b"><collision><geometry><sphere radius="1"/></geometry></collision></link>
      <joint name="spin" type="continuous"><parent link="a"/><child link="b"/>
      <axis xyz="0 0 1"/></joint></robot>)");
  folder.write("spin.csv", "time,spin\n0,0.5\n1,-0.25\n");
  EXPECT_EQ(robot_result(folder, R"("spin.urdf", "trajectory": "spin.csv")", "turns"),
            R"([{"robot":"r","joint":"spin","from":0.5,"to":-0.25,"turned":-0.75,)"
            R"("turning":"long"}])");
}

TEST(ReadSummary, TakesLinesThatAreLines) {
  const auto line = [](const std::string& number) {
    return read_summary(R"({"line": )" + number + R"(, "verdict": "free"})", "r").line;
  };
  EXPECT_EQ(line("1"), 1u);
  EXPECT_EQ(line("9007199254740991"), (std::size_t{1} << 53) - 1);
  for (const char* none : {"0", "-1", "1e300", "null", "\"3\"", "[3]"}) {
    EXPECT_EQ(line(none), std::nullopt) << none;
  }
  for (std::size_t k = 0; k < kVerdictWords.size(); ++k) {
    EXPECT_EQ(read_summary(R"({"verdict": ")" + std::string(kVerdictWords[k]) + "\"}", "r").verdict,
              static_cast<Verdict>(k));
  }
  // An error stands in place of a verdict.
  EXPECT_EQ(read_summary(R"({"error": "e", "verdict": "free"})", "r").verdict, std::nullopt);
  EXPECT_EQ(message_of<ParseError>([] { (void)read_summary(R"({"error": 7})", "r.jsonl", 5); }),
            "r.jsonl:5: expected a result with a \"verdict\" or an \"error\"");
}

// A value that is missing or not finite is read as the least claim.
TEST(ReadResult, ClaimsTheLeastOfWhatIsNotThere) {
  const std::string scene = test::scene(test::body("a"));
  const StoredResult none = read_result(R"({"verdict": "free", "scene": )" + scene + "}", "r");
  EXPECT_EQ(none.t, 0.0);
  EXPECT_EQ(none.clearance, 0.0);
  const StoredResult free =
      read_result(R"({"verdict": "free", "t": 1, "clearance": null, "scene": )" + scene + "}", "r");
  EXPECT_EQ(free.t, 1.0);
  EXPECT_EQ(free.clearance, 0.0);
}

TEST(EmbeddedScene, IsFoundAmongOtherKeys) {
  const std::string text =
      R"({"what": [{"scene": 7}], "scene": )" + test::scene(test::body("a")) + R"(, "x": null})";
  const Scene scene = parse_embedded_scene(text, "run.json");
  EXPECT_EQ(test::SceneBits(scene),
            test::SceneBits(parse_scene(test::scene(test::body("a")), "s")));
  for (const char* none : {"[]", "{}", "7", R"({"what": {"scene": {}}})"}) {
    EXPECT_EQ(message_of<ParseError>([&] { (void)parse_embedded_scene(none, "run.json", 3); }),
              "run.json:3: expected an object with a \"scene\"")
        << none;
  }
  EXPECT_EQ(message_of<ParseError>(
                [] { (void)parse_embedded_scene("{\n\"a\": 1,\n\"scene\": []}", "run.json"); }),
            "run.json:3: scene: expected a scene, an object with \"firstcontact\": 1 and "
            "\"bodies\", got an array of 0");
}

// A file that the scene names is wrong: the error is of that file.
TEST(EmbeddedScene, NamesTheFileThatIsWrong) {
  const test::ArmFolder folder;
  const Scene scene =
      parse_scene(R"({"firstcontact": 1, "robots": [{"name": "r", "urdf": "arm.urdf"}]})",
                  folder.path() / "s.json");
  const std::string text = R"({"scene": )" + write_scene(scene) + "}";
  folder.write("arm.urdf", "<robot name=\"arm\">\n<lonk/>");
  const auto said = [](const auto& read) { return message_of<ParseError>([&] { (void)read(); }); };
  const std::string place = (folder.path() / "arm.urdf").string() + ":";
  const std::string embedded = said([&] { return parse_embedded_scene(text, "run.json"); });
  EXPECT_EQ(embedded.substr(0, place.size()), place) << embedded;
  EXPECT_EQ(embedded, said([&] { return parse_scene(write_scene(scene), "s"); }));
}

// It was written in a folder above its own, and is read in another one.
TEST(EmbeddedScene, IsReadInAnotherFolder) {
  const test::ArmFolder folder;
  const std::string text =
      R"({"scene": {"firstcontact": 1, "robots": [{"name": "r", "urdf": "arm.urdf",
      "package_roots": ["."]}]}})";
  const std::string file = (folder.path() / "out" / "deep" / "run.jsonl").string();
  const Scene scene = parse_embedded_scene(text, file);
  EXPECT_EQ(scene.robots.at(0).file.urdf, folder.path() / "arm.urdf");
  EXPECT_EQ(
      message_of<ParseError>([&] {
        (void)parse_embedded_scene(
            R"({"scene": {"firstcontact": 1, "robots": [{"name": "r", "urdf": "leg.urdf"}]}})",
            file);
      }),
      file +
          ":1: scene: robots[0].urdf: expected a URDF file, found none at \"leg.urdf\", "
          "nor from a folder above this file");
}

TEST(SimulationScenes, AreReadAsLenientAsAsked) {
  const std::string text = test::scene(test::body("a"));
  EXPECT_FALSE(parse_simulation_scene(text, "s").options.lenient);
  EXPECT_TRUE(parse_simulation_scene(text, "s", {.lenient = true}).options.lenient);
  EXPECT_EQ(parse_simulation_scene(text, "s").text_digest, parse_scene(text, "s").text_digest);
  EXPECT_EQ(message_of<ParseError>([] { (void)read_simulation_scene("none.json"); }),
            "none.json: expected a scene file, found none");
  EXPECT_EQ(message_of<ParseError>([] { (void)parse_simulation_scene("[1]", "s.json"); }),
            "s.json:1: expected a scene, an object with \"firstcontact\": 1 and \"bodies\", got an "
            "array of 1");
}

std::vector<LineAnswer> answers_of(const std::vector<std::string>& lines,
                                   const CheckLinesOptions& options) {
  std::size_t number = 0;
  std::vector<LineAnswer> taken;
  check_lines(
      "dir/s.jsonl",
      [&]() -> std::optional<SceneLine> {
        if (number == lines.size()) {
          return std::nullopt;
        }
        ++number;
        return SceneLine{.number = 10 * number, .text = lines[number - 1]};
      },
      [&](const LineAnswer& answer) { taken.push_back(answer); }, options);
  return taken;
}

TEST(CheckLinesAnswers, NameTheSceneOfAnErrorWhereItIsKnown) {
  const test::ArmFolder folder;
  folder.write("empty.off", "");
  const std::string mesh = (folder.path() / "empty.off").string();
  // The first is no scene, the second is one whose mesh cannot be read.
  const std::vector<LineAnswer> answers = answers_of(
      {R"({"firstcontact": 1, "id": "first"})",
       test::scene(R"({"name": "a", "shape": {"mesh": ")" + mesh + R"("}})", R"("id": "second")")},
      {.threads = 2});
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].error, "dir/s.jsonl:10: expected a key \"bodies\", got none");
  EXPECT_EQ(answers[0].text,
            R"({"id":"","file":"dir/s.jsonl","line":10,"error":"dir/s.jsonl:10: expected a key )"
            R"(\"bodies\", got none"})");
  EXPECT_EQ(answers[1].error.substr(0, mesh.size()), mesh);
  EXPECT_EQ(answers[1].text.substr(0, 55),
            R"({"id":"second","file":"dir/s.jsonl","line":20,"error":")");
  EXPECT_FALSE(answers[1].verdict);
}

TEST(CheckLinesAnswers, HaveWhatIsAskedFor) {
  const std::string fall =
      test::scene(test::body("floor") + "," + test::body("stone", test::falling("1", "-4")));
  const auto has = [&](const CheckLinesOptions& options, const std::string& key) {
    return answers_of({fall}, options).at(0).text.find(key) != std::string::npos;
  };
  for (const char* key : {R"("pairs":[)", R"("closest":{)", R"("intervals":[)"}) {
    EXPECT_FALSE(has({}, key)) << key;
  }
  EXPECT_TRUE(has({.all_pairs = true}, R"("pairs":[)"));
  EXPECT_TRUE(has({.closest = true}, R"("closest":{)"));
  EXPECT_TRUE(has({.all_contacts_in_time = true}, R"("pairs":[)"));
  EXPECT_TRUE(has({.all_contacts_in_time = true}, R"("intervals":[)"));
  EXPECT_TRUE(has({.reading = {.lenient = true}}, R"("lenient":true)"));
}

TEST(CheckLinesAnswers, AreNoneWithoutLinesOrAfterAStop) {
  EXPECT_TRUE(answers_of({}, {.threads = 3}).empty());
  std::stop_source source;
  source.request_stop();
  EXPECT_TRUE(answers_of({test::scene(test::body("a"))}, {.threads = 1, .stop = source.get_token()})
                  .empty());
}

}  // namespace
}  // namespace firstcontact
