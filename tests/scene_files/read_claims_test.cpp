// The claims of a result: all that was written of it, and by name what is no claim.

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene/version.h>
#include <firstcontact/scene_files/read_claims.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_result.h>
#include <firstcontact/text/parse_error.h>

#include "scene/load_text.h"
#include "scene/scene_bits.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::body;
using test::falling;
using test::message_of;

/// A result and its text.
struct Claimed {
  LoadedScene loaded;
  SceneResult result;
  std::string text;
};

Claimed claimed(const std::string& scene, bool all_pairs = true) {
  Claimed claimed{.loaded = test::load_text(scene), .result = {}, .text = {}};
  ManyBodiesWorkspace workspace;
  claimed.result = check_scene(claimed.loaded, workspace, {.all_pairs = all_pairs});
  claimed.text =
      write_result(claimed.loaded, claimed.result, {.all_pairs = all_pairs, .sampling = {}});
  return claimed;
}

const std::string kClaimedFall =
    test::scene(body("floor") + "," + body("st\\u00f6ne \\\"1\\\"", falling("1", "-4")) + "," +
                    body("far", falling("9", "-1")),
                R"("options": {"duration": 3, "tolerance": 1e-5})");

TEST(ReadClaims, TakesAllThatAResultSays) {
  const Claimed fall = claimed(kClaimedFall);
  const ResultClaims claims = read_claims(fall.text, "r.json");
  EXPECT_EQ(test::SceneBits(claims.scene), test::SceneBits(fall.loaded.scene));
  EXPECT_EQ(claims.scene.text_digest, fall.loaded.scene.text_digest);
  EXPECT_EQ(claims.version, version());
  EXPECT_EQ(claims.input_digest, fall.loaded.input_digest);
  EXPECT_EQ(claims.has_own_scene, true);
  EXPECT_EQ(claims.verdict, Verdict::contact);
  EXPECT_EQ(claims.t, fall.result.t);
  EXPECT_EQ(claims.time, fall.result.t * 3.0);
  EXPECT_EQ(claims.clearance, fall.result.clearance);
  EXPECT_EQ(claims.tolerance_used, 1e-5);
  EXPECT_EQ(claims.tested, 3u);
  EXPECT_EQ(claims.pair, (std::array<std::string, 2>{"floor", "st\xc3\xb6ne \"1\""}));
  ASSERT_TRUE(claims.pairs.has_value());
  ASSERT_EQ(claims.pairs->size(), fall.result.pairs.size());
  for (std::size_t k = 0; k < claims.pairs->size(); ++k) {
    const PairClaim& claim = claims.pairs->at(k);
    const PairAnswer& answer = fall.result.pairs[k];
    EXPECT_EQ(claim.pair[0], fall.loaded.scene.bodies[answer.members[0]].name);
    EXPECT_EQ(claim.pair[1], fall.loaded.scene.bodies[answer.members[1]].name);
    EXPECT_EQ(claim.verdict, answer.verdict);
    EXPECT_EQ(claim.t, answer.t);
    EXPECT_EQ(claim.tolerance_used, 1e-5);
    EXPECT_EQ(claim.margin, answer.margin);
    EXPECT_EQ(claim.time, answer.t * 3.0);
    EXPECT_EQ(claim.clearance, answer.clearance);
  }
}

TEST(ReadClaims, OfNoPairAreOfNoContact) {
  const ResultClaims claims = read_claims(claimed(test::scene(body("a")), false).text, "r.json");
  EXPECT_EQ(claims.verdict, Verdict::free);
  EXPECT_EQ(claims.pair, std::nullopt);
  EXPECT_EQ(claims.pairs, std::nullopt);  // They were not asked for.
  EXPECT_EQ(claims.clearance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(claims.tested, 0u);
}

// A scene that is put together in a program has no text, and so no digest of one.
TEST(ReadClaims, AreReadOfASceneWithoutText) {
  Scene scene;
  scene.bodies = {{.name = "ball", .shape = {.source = SphereShape{1.0}}, .motion = {}}};
  ShapeCache cache;
  const LoadedScene loaded = load_scene(scene, cache);
  ManyBodiesWorkspace workspace;
  const std::string text = write_result(loaded, check_scene(loaded, workspace));
  EXPECT_NE(text.find(R"("scene_digest":"")"), std::string::npos);
  const ResultClaims claims = read_claims(text, "r.json");
  EXPECT_EQ(claims.scene.text_digest, "");
  EXPECT_EQ(claims.has_own_scene, true);
}

/// The result of the fall with `from` replaced by `to`.
std::string changed_claims(const std::string& from, const std::string& to) {
  static const std::string kText = claimed(kClaimedFall).text;
  std::string text = kText;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << " in " << text;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(ReadClaims, KnowWhetherTheirSceneIsTheOneThatWasChecked) {
  const auto own = [](const std::string& from, const std::string& to) {
    return read_claims(changed_claims(from, to), "r.json").has_own_scene;
  };
  EXPECT_EQ(own(R"("id":"")", R"("id":"")"), true);
  EXPECT_EQ(own(R"("scene":{"firstcontact":1,"id":"")", R"("scene":{"firstcontact":1,"id":"x")"),
            false);
  EXPECT_EQ(own(R"("resolved_digest":")", R"("resolved_digest":"0)"), false);
  // Results of before state none. Spaces are no part of a scene.
  EXPECT_EQ(own(R"("resolved_digest":)", R"("former_digest":)"), std::nullopt);
  EXPECT_EQ(own(R"("scene":{)", R"("scene": {  )"), true);
}

TEST(ReadClaims, TakeTheTolerancesThatAreStated) {
  const ResultClaims claims = read_claims(
      changed_claims(R"("pair_counts")", R"("tolerance_used":0.5,"pair_counts")"), "r.json");
  EXPECT_EQ(claims.tolerance_used, 0.5);
  EXPECT_EQ(claims.pairs->at(0).tolerance_used, 1e-5);
  const ResultClaims of_pair =
      read_claims(changed_claims(R"("pairs":[{)", R"("pairs":[{"tolerance_used":0.25,)"), "r.json");
  EXPECT_EQ(of_pair.tolerance_used, 1e-5);
  EXPECT_EQ(of_pair.pairs->at(0).tolerance_used, 0.25);
  EXPECT_EQ(of_pair.pairs->at(1).tolerance_used, 1e-5);
}

std::string claims_said(const std::string& text) {
  return message_of<ParseError>([&] { (void)read_claims(text, "r.jsonl", 12); });
}

TEST(ReadClaims, SayWhatIsNoResult) {
  const std::string none =
      "r.jsonl:12: expected one result, as `firstcontact check SCENE -o FILE` writes it";
  for (const std::string& text :
       {std::string("[]"), std::string("{}"), std::string(R"({"verdict": "free"})"),
        std::string(R"({"scene": {}})"), write_error("a", "s.jsonl", 3, "wrong")}) {
    EXPECT_EQ(claims_said(text), none) << text;
  }
  EXPECT_EQ(claims_said(R"({"verdict": "free", "scene": {}})"),
            "scene of the result:1: expected \"firstcontact\": 1, the version of the scene format");
  EXPECT_EQ(claims_said("{"),
            "r.jsonl:12: expected a key in double quotes, got the end of the text");
}

TEST(ReadClaims, NameWhatIsWrong) {
  const std::vector<std::array<std::string, 3>> cases = {
      {R"("verdict":"contact")", R"("verdict":"contct")",
       "verdict: unknown word \"contct\"; did you mean \"contact\"?"},
      {R"("verdict":"contact")", R"("verdict":null)",
       "verdict: expected one of \"free\", \"contact\", \"contact_at_start\", \"undecided\", got "
       "null"},
      {R"("t":)", R"("t":"0","was":)", "t: expected a number, got \"0\""},
      {R"("t":)", R"("was":)", "expected a key \"t\", got none"},
      {R"("time":)", R"("time":null,"was":)", "time: expected a number, got null"},
      {R"("pair":["floor",)", R"("pair":["floor","floor",)",
       "pair: expected two names, got an array of 3"},
      {R"("pair":["floor",)", R"("pair":[7,)", "pair[0]: expected a name, got 7"},
      {R"("clearance":)", R"("clearance":"all","was":)",
       "clearance: expected a number, got \"all\""},
      {R"("pair_counts":{"tested":3)", R"("pair_counts":{"tested":-1)",
       "pair_counts.tested: expected a number of pairs, an integer from 0 to "
       "18446744073709551614, got -1"},
      {R"("pair_counts":{"tested":3)", R"("pair_counts":{"tested":2.5)",
       "pair_counts.tested: expected a number of pairs, an integer from 0 to "
       "18446744073709551614, got 2.5"},
      {R"("pair_counts":{"tested":3)", R"("pair_counts":{"tested":1e300)",
       "pair_counts.tested: expected a number of pairs, an integer from 0 to "
       "18446744073709551614, got 1e+300"},
      {R"("pair_counts":)", R"("pair_counts":3,"were":)",
       "pair_counts: expected an object with \"tested\", got 3"},
      {R"("pairs":[)", R"("pairs":[null,)", "pairs[0]: expected an object with \"pair\", got null"},
      {R"("pairs":[{"pair")", R"("pairs":[{"pears")",
       "pairs[0]: expected a key \"pair\", got none"},
      {R"("pairs":[)", R"("pairs":7,"were":[)", "pairs: expected answers of pairs, got 7"},
      {R"("pairs":[{)", R"("pairs":[{"tolerance_used":0,)",
       "pairs[0].tolerance_used: expected a number > 0, got 0"},
      {R"("version":)", R"("version":1,"was":)", "version: expected a string, got 1"},
      {R"("scene_digest":)", R"("scene_digest":[],"was":)",
       "scene_digest: expected a string, got an array of 0"},
      {R"("resolved_digest":)", R"("resolved_digest":null,"was":)",
       "resolved_digest: expected a digest, got null"}};
  for (const auto& [from, to, message] : cases) {
    EXPECT_EQ(claims_said(changed_claims(from, to)), "r.jsonl:12: " + message) << to;
  }
}

/// The first answer of a result is that of the scene, and the second one that of its first pair.
TEST(ReadClaims, RefuseTimesThatContradictTheVerdict) {
  const std::string text = claimed(kClaimedFall).text;
  const auto number_after = [&](const std::string& key) {
    const std::size_t begin = text.find(key) + key.size();
    return text.substr(begin, text.find(',', begin) - begin);
  };
  const std::string t = number_after(R"("t":)");
  const std::string upper = R"("t_upper":)" + t;
  EXPECT_EQ(claims_said(changed_claims(upper, R"("t_upper":0.9)")),
            "r.jsonl:12: t_upper: expected " + t +
                ", as t, since the verdict is a contact, got 0.9; check the scene again");
  EXPECT_EQ(claims_said(changed_claims(upper, R"("t_upper":null)")),
            "r.jsonl:12: t_upper: expected " + t +
                ", as t, since the verdict is a contact, got null; check the scene again");
  EXPECT_EQ(claims_said(changed_claims(R"("verdict":"contact")", R"("verdict":"free")")),
            "r.jsonl:12: t_upper: expected null, since the verdict is free, got " + t +
                "; check the scene again");
  std::string of_pair = text;
  of_pair.replace(of_pair.find(upper, of_pair.find(R"("pairs":[)")), upper.size(),
                  R"("t_upper":1)");
  EXPECT_EQ(claims_said(of_pair),
            "r.jsonl:12: pairs[0].t_upper: expected " + t +
                ", as t, since the verdict is a contact, got 1; check the scene again");
}

TEST(ReadClaims, RefuseWhatIsUndecidedWithoutAReason) {
  const std::string decided = R"("verdict":"contact","reason":null)";
  EXPECT_EQ(
      claims_said(changed_claims(decided, R"("verdict":"undecided","reason":null)")),
      "r.jsonl:12: reason: expected why the search ended, since the verdict is undecided, got "
      "null; check the scene again");
  EXPECT_EQ(claims_said(changed_claims(decided, R"("verdict":"undecided","reason":"wrk")")),
            "r.jsonl:12: reason: unknown word \"wrk\"; did you mean \"work\"?");
  EXPECT_EQ(
      read_claims(changed_claims(decided, R"("verdict":"undecided","reason":"work")"), "r.json")
          .verdict,
      Verdict::undecided);
}

}  // namespace
}  // namespace firstcontact
