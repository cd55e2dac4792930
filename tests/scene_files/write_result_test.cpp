#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/write_result.h>

#include <string>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/scene/version.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/write_json.h>

#include "scene/scene_bits.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using detail::find;
using detail::JsonArray;
using detail::JsonObject;
using detail::JsonValue;
using test::body;
using test::falling;
using test::scene;

/// A result and what was written of it.
struct Written {
  LoadedScene loaded;
  SceneResult result;
  JsonObject json;

  [[nodiscard]] const JsonValue& at(std::string_view key) const {
    const JsonValue* value = find(json, key);
    return value != nullptr ? *value : throw std::out_of_range(std::string(key));
  }
  [[nodiscard]] double number(std::string_view key) const {
    return std::get<double>(at(key).value);
  }
  [[nodiscard]] std::string text(std::string_view key) const {
    return std::get<std::string>(at(key).value);
  }
  [[nodiscard]] bool is_null(std::string_view key) const {
    return std::holds_alternative<detail::JsonNull>(at(key).value);
  }
};

Written write(const std::string& text, const CheckOptions& check = {},
              const WriteResultOptions& options = {}) {
  ShapeCache cache;
  ManyBodiesWorkspace workspace;
  Written written{.loaded = load_scene(parse_scene(text, "s"), cache), .result = {}, .json = {}};
  written.result = check_scene(written.loaded, workspace, check);
  const std::string line = write_result(written.loaded, written.result, options);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  written.json = std::get<JsonObject>(detail::parse_json(line, "result").value);
  return written;
}

const std::string kFall = scene(body("floor") + "," + body("stone", falling("1", "-4")),
                                R"("id": "fall", "options": {"duration": 0.5})");

TEST(WriteResult, SaysWhenWhoAndWhere) {
  const Written fall = write(kFall);
  EXPECT_EQ(fall.text("id"), "fall");
  EXPECT_EQ(fall.text("verdict"), "contact");
  EXPECT_TRUE(fall.is_null("reason"));
  EXPECT_EQ(fall.number("t"), fall.result.t);
  EXPECT_EQ(fall.number("t_upper"), fall.result.t);
  EXPECT_EQ(fall.number("time"), fall.result.t * 0.5);
  EXPECT_EQ(detail::write_json(fall.at("pair")), R"(["floor","stone"])");
  EXPECT_EQ(fall.text("version"), version());
  EXPECT_EQ(fall.text("input_digest"), fall.loaded.input_digest);
  const auto& contacts = std::get<JsonArray>(fall.at("contacts").value);
  ASSERT_EQ(contacts.size(), fall.result.pairs[0].contacts.size());
  const auto& contact = std::get<JsonObject>(contacts[0].value);
  EXPECT_EQ(detail::write_json(*find(contact, "normal")), "[0,0,1]");
  // 4 m in half a second, closing.
  EXPECT_EQ(std::get<double>(find(contact, "normal_velocity")->value), -8.0);
}

TEST(WriteResult, EmbedsTheResolvedScene) {
  const Written fall = write(kFall);
  const Scene embedded = parse_scene(detail::write_json(fall.at("scene")), "s");
  EXPECT_EQ(test::SceneBits(embedded), test::SceneBits(fall.loaded.scene));
}

TEST(WriteResult, OfAFreeSceneHasNoPair) {
  const Written free = write(scene(body("a")));
  EXPECT_EQ(free.text("verdict"), "free");
  EXPECT_EQ(free.number("t"), 1.0);
  EXPECT_TRUE(free.is_null("t_upper"));
  EXPECT_TRUE(free.is_null("pair"));
  EXPECT_TRUE(free.is_null("clearance"));  // Infinite: there is no pair.
  EXPECT_TRUE(std::get<JsonArray>(free.at("contacts").value).empty());
}

TEST(WriteResult, SaysMoreWhereMoreIsAsked) {
  const Written plain = write(kFall);
  for (const char* key : {"closest", "pairs", "sampling", "tolerance_used"}) {
    EXPECT_EQ(find(plain.json, key), nullptr) << key;
  }
  const SamplingReport sampling{.rate = 240, .samples = 2, .in_contact = 1, .least = GapSample{}};
  const Written full = write(kFall, {.closest = true}, {.all_pairs = true, .sampling = sampling});
  EXPECT_EQ(std::get<JsonArray>(full.at("pairs").value).size(), 1u);
  EXPECT_LE(
      std::get<double>(find(std::get<JsonObject>(full.at("closest").value), "distance")->value),
      1e-6);
  EXPECT_EQ(detail::write_json(full.at("sampling")),
            R"({"rate":240,"samples":2,"in_contact":1,"least_distance":0,"time":0})");
}

// Normalised times, and beside them seconds: the scene lasts 3 s.
TEST(WriteResult, ListsEveryIntervalInSeconds) {
  const std::string bounces =
      R"("motion": {"type": "waypoints", "times": [0, 1.5, 3], "poses": [{"position": [0.1, 0.1, 1]},
         {"position": [0.1, 0.1, -1]}, {"position": [0.1, 0.1, 1]}]})";
  const Written written =
      write(scene(body("floor") + "," + body("stone", bounces)), {.all_contacts_in_time = true},
            {.all_pairs = true, .sampling = {}});
  const auto& pair = std::get<JsonObject>(std::get<JsonArray>(written.at("pairs").value)[0].value);
  const auto& intervals = std::get<JsonArray>(find(pair, "intervals")->value);
  ASSERT_EQ(intervals.size(), 2u);
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    const auto& interval = std::get<JsonObject>(intervals[k].value);
    const auto number = [&](const char* key) {
      return std::get<double>(find(interval, key)->value);
    };
    const ContactInterval& found = written.result.pairs[0].intervals[k];
    EXPECT_EQ(number("enter"), found.enter);
    EXPECT_EQ(number("leave"), found.leave);
    EXPECT_EQ(number("enter_time"), found.enter * 3.0);
    EXPECT_EQ(number("leave_time"), found.leave * 3.0);
    EXPECT_EQ(detail::write_json(*find(interval, "reason")), "null");
  }
}

TEST(WriteResult, CountsThePairsThatItIsAbout) {
  const Written written =
      write(scene(body("a") + "," + body("b") + "," + body("c", falling("5", "-1")),
                  R"("pairs": {"ignore": [["a", "b"]]})"));
  EXPECT_EQ(detail::write_json(written.at("pair_counts")),
            R"({"tested":2,"ignored":1,"left_out":0,"untested":[{"why":"rule","count":1,)"
            R"("first":[["a","b"]]}]})");
  EXPECT_EQ(find(written.json, "warnings"), nullptr);
  const Written alone = write(scene(body("a")));
  EXPECT_EQ(detail::write_json(alone.at("warnings")),
            R"(["no pair is tested: this answer says nothing about contact; there is only one )"
            R"(body"])");
}

TEST(WriteResult, NamesTheLineThatItAnswers) {
  const Written written = write(kFall, {}, {.line = 12, .sampling = {}});
  EXPECT_EQ(written.number("line"), 12.0);
  EXPECT_EQ(written.json.at(1).key, "line");  // Behind the id.
}

TEST(ReportSampling, TakesTheFirstOfTheLeastSamples) {
  const std::vector<GapSample> samples = {{.t = 0.0, .distance = 2.0},
                                          {.t = 0.25, .distance = 1.0, .contact = true},
                                          {.t = 0.5, .distance = 1.0, .contact = true}};
  const SamplingReport report = report_sampling(4.0, samples);
  EXPECT_EQ(report.samples, 3u);
  EXPECT_EQ(report.in_contact, 2u);
  EXPECT_EQ(report.least->t, 0.25);
  EXPECT_FALSE(report_sampling(4.0, {}).least);
}

TEST(WriteResult, IsTheSameOnEveryRun) {
  ShapeCache cache;
  const LoadedScene loaded = load_scene(parse_scene(kFall, "s"), cache);
  ManyBodiesWorkspace first;
  ManyBodiesWorkspace second;
  EXPECT_EQ(write_result(loaded, check_scene(loaded, first)),
            write_result(loaded, check_scene(loaded, second)));
}

TEST(WriteError, NamesThePlace) {
  EXPECT_EQ(write_error("x", "scenes.jsonl", 3, "scenes.jsonl:3: no \"bodies\""),
            R"({"id":"x","file":"scenes.jsonl","line":3,"error":"scenes.jsonl:3: no \"bodies\""})");
  EXPECT_EQ(write_error("", "a.json", {}, "m"), R"({"id":"","file":"a.json","error":"m"})");
}

TEST(LoadScene, NamesAllThatWasReadByOneDigest) {
  ShapeCache cache;
  const auto digest = [&](const std::string& text) {
    return load_scene(parse_scene(text, "s"), cache).input_digest;
  };
  EXPECT_EQ(digest(kFall), digest(kFall));
  EXPECT_NE(digest(kFall), digest(kFall + " "));
}

TEST(WriteResult, StatesTheEnclosureErrorOfTrianglesAroundCurvedBodies) {
  const std::string cylinder =
      R"({"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]],
          "enclosure_error": 0.125})";
  const auto named = [&](const std::string& name) {
    return R"({"name": ")" + name + R"(", "shape": )" + cylinder + "}";
  };
  const Written pair =
      write(scene(named("a") + "," + named("b")), {}, {.all_pairs = true, .sampling = {}});
  const double both = 0.25;
  EXPECT_EQ(pair.number("enclosure_error"), both);
  const auto& of_pair = std::get<JsonObject>(std::get<JsonArray>(pair.at("pairs").value)[0].value);
  EXPECT_EQ(std::get<double>(find(of_pair, "enclosure_error")->value), both);
  EXPECT_EQ(write(scene(named("a") + "," + body("b"))).number("enclosure_error"), 0.5 * both);
  EXPECT_EQ(find(write(kFall).json, "enclosure_error"), nullptr);
  const std::string exact = R"({"name": "c", "shape": {"cylinder": {"radius": 1, "length": 1}}})";
  EXPECT_EQ(find(write(scene(exact + "," + body("b"))).json, "enclosure_error"), nullptr);
}

}  // namespace
}  // namespace firstcontact
