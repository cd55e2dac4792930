#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/verification/provable_file.h>
#include <firstcontact/verification/verify_result.h>
#include <firstcontact/verification/write_verification.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "verification/checked_scene.h"

namespace firstcontact {
namespace {

using test::checked;
using test::claims_of;

/// A box that falls by 3 m onto a floor while it turns.
std::string falling_box(const std::string& options = R"({"tolerance": 1e-6})") {
  return R"({"firstcontact": 1, "bodies": [
    {"name": "box", "shape": {"box": {"size": [1, 1, 1]}},
     "motion": {"type": "constant_velocity", "from": {"position": [0, 0, 3]},
                "translation": [0, 0, -3], "rotation_vector": [0.3, 0.2, 0.1]}},
    {"name": "floor", "shape": {"box": {"size": [10, 10, 0.1]}}}], "options": )" +
         options + "}";
}

/// Two balls that pass each other at a distance of 0.1 m.
std::string fly_by(const std::string& margin) {
  return R"({"firstcontact": 1, "bodies": [
    {"name": "mover", "shape": {"sphere": {"radius": 0.1}},
     "motion": {"type": "constant_velocity", "from": {"position": [-1, 0, 0.3]},
                "translation": [2, 0, 0]}},
    {"name": "other", "shape": {"sphere": {"radius": 0.1}}}], "options": {"margin": )" +
         margin + "}}";
}

ProofVerdict verdict_of(const ResultClaims& claims) { return verify_result(claims).verdict; }

TEST(VerifyResult, ProvesAContactAndTheTimeBefore) {
  const ResultClaims claims = claims_of(falling_box());
  ASSERT_EQ(claims.verdict, Verdict::contact);
  const ResultVerification proven = verify_result(claims);
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  EXPECT_TRUE(proven.problem.empty());
  EXPECT_EQ(proven.t, claims.t);
  ASSERT_TRUE(proven.contact_distance);
  EXPECT_GT(*proven.contact_distance, 0.0);
  EXPECT_LE(*proven.contact_distance, 1e-6);
  EXPECT_EQ(proven.contacts, 1u);
}

TEST(VerifyResult, ProvesThatBodiesStayFree) {
  const ResultVerification proven = verify_result(claims_of(fly_by("0.0999")));
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  EXPECT_FALSE(proven.contact_distance);
  EXPECT_EQ(proven.pair_counts.tested, 1u);
}

// The margin of the claim is raised after the fact.
TEST(VerifyResult, RefutesAMarginThatWasNotKept) {
  ResultClaims claims = claims_of(fly_by("0.0999"));
  claims.scene.options.margin = 0.1001;
  const ResultVerification refuted = verify_result(claims);
  EXPECT_EQ(refuted.verdict, ProofVerdict::refuted);
  ASSERT_TRUE(refuted.problem_at);
  EXPECT_NEAR(refuted.problem_at->from, 0.5, 0.02);
  EXPECT_LE(refuted.problem_at->distance.value(), 0.1001);
  EXPECT_NE(refuted.problem.find("\"mover\" and \"other\""), std::string::npos);
}

TEST(VerifyResult, RefutesAContactThatIsTurnedIntoFree) {
  ResultClaims claims = claims_of(falling_box());
  claims.verdict = Verdict::free;
  claims.t = claims.time = 1.0;
  claims.pair.reset();
  const ResultVerification refuted = verify_result(claims);
  EXPECT_EQ(refuted.verdict, ProofVerdict::refuted) << refuted.problem;
  EXPECT_GT(refuted.problem_at.value().from, 0.76);
}

// The box falls at 3 m a step: a billionth of the step is 3 nm, which a tolerance of 1 nm shows.
TEST(VerifyResult, NeverProvesALaterTime) {
  for (const auto& [tolerance, later] :
       {std::pair{"1e-6", 1e-6}, {"1e-6", 4e-7}, {"1e-9", 1e-9}, {"1e-10", 1e-9}}) {
    const ResultClaims claims =
        claims_of(falling_box(std::string(R"({"tolerance": )") + tolerance + "}"));
    ASSERT_EQ(verdict_of(claims), ProofVerdict::proven) << tolerance;
    ResultClaims edited = claims;
    edited.t = edited.time = claims.t + later;
    EXPECT_NE(verdict_of(edited), ProofVerdict::proven) << tolerance << ", later by " << later;
    // The part left open is far shorter than the added time.
    EXPECT_LE(verify_result(claims).left_open, 1e-11);
  }
}

TEST(VerifyResult, RefutesAContactBeforeItsTime) {
  ResultClaims claims = claims_of(falling_box());
  claims.t = claims.time = claims.t - 1e-5;
  const ResultVerification refuted = verify_result(claims);
  EXPECT_EQ(refuted.verdict, ProofVerdict::refuted);
  EXPECT_NE(refuted.problem.find("farther apart than it allows"), std::string::npos);
}

TEST(VerifyResult, RefutesAWallThatIsPutInAfterTheFact) {
  ResultClaims claims = claims_of(falling_box());
  const std::string wall =
      R"({"firstcontact": 1, "bodies": [{"name": "wall", "shape": {"box": {"size": [9, 9, 1e-5]}},
          "pose": {"position": [0, 0, 1.234]}}]})";
  add_body(claims.scene, parse_scene(wall, "s").bodies.front());
  EXPECT_EQ(verdict_of(claims), ProofVerdict::broken);  // It is about fewer pairs.
  claims.tested = 3;
  const ResultVerification refuted = verify_result(claims);
  EXPECT_EQ(refuted.verdict, ProofVerdict::refuted);
  EXPECT_NE(refuted.problem.find("\"wall\""), std::string::npos);
}

TEST(VerifyResult, FindsAThinWallInTheWay) {
  const std::string scene = R"({"firstcontact": 1, "bodies": [
    {"name": "chip", "shape": {"box": {"size": [1e-3, 1e-3, 1e-5]}},
     "motion": {"type": "constant_velocity", "from": {"position": [0, 0, 3]}, "translation": [0, 0, -6]}},
    {"name": "wall", "shape": {"box": {"size": [9, 9, 1e-5]}}, "pose": {"position": [0, 0, 1.234]}}]})";
  ResultClaims claims = claims_of(scene);
  ASSERT_EQ(claims.verdict, Verdict::contact);
  EXPECT_EQ(verdict_of(claims), ProofVerdict::proven);
  claims.verdict = Verdict::free;
  claims.t = claims.time = 1.0;
  claims.pair.reset();
  EXPECT_EQ(verdict_of(claims), ProofVerdict::refuted);
}

TEST(VerifyResult, RefusesAnEditedScene) {
  std::string text = checked(falling_box());
  const std::size_t at = text.find("[10,10,0.1]");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 11, "[10,10,0.2]");
  const ResultClaims claims = read_claims(text, "result.json");
  EXPECT_EQ(claims.has_own_scene, false);
  EXPECT_NE(test::message_of<std::invalid_argument>([&] {
              (void)verify_result(claims);
            }).find("edited in the result"),
            std::string::npos);
}

TEST(VerifyResult, VerifiesResultsWithoutDigests) {
  ResultClaims claims = claims_of(falling_box());
  claims.has_own_scene.reset();
  claims.scene.text_digest.clear();
  const ResultVerification proven = verify_result(claims);
  EXPECT_EQ(proven.verdict, ProofVerdict::proven);
  EXPECT_FALSE(proven.has_digests);
}

TEST(VerifyResult, ProvesEachPair) {
  const std::string scene = R"({"firstcontact": 1, "bodies": [
    {"name": "a", "shape": {"sphere": {"radius": 0.1}},
     "motion": {"type": "constant_velocity", "from": {"position": [-1, 0, 0]}, "translation": [2, 0, 0]}},
    {"name": "b", "shape": {"sphere": {"radius": 0.1}}},
    {"name": "c", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0.5, 0, 0]}}]})";
  const ResultClaims claims = claims_of(scene, {.all_pairs = true});
  ASSERT_EQ(claims.pairs.value().size(), 3u);
  const ResultVerification proven = verify_result(claims);
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  ResultClaims fewer = claims;
  fewer.pairs->pop_back();
  EXPECT_EQ(verdict_of(fewer), ProofVerdict::broken);
  ResultClaims later = claims;
  for (PairClaim& pair : *later.pairs) {
    if (pair.pair[1] == "c" && pair.pair[0] == "a") {
      pair.t += 1e-3;
      pair.time = pair.t * claims.scene.duration;
    }
  }
  EXPECT_EQ(verdict_of(later), ProofVerdict::refuted);
}

/// Two balls that pass each other, and one far away.
std::string fly_by_of_three() {
  return R"({"firstcontact": 1, "bodies": [
    {"name": "mover", "shape": {"sphere": {"radius": 0.1}},
     "motion": {"type": "constant_velocity", "from": {"position": [-1, 0, 0.3]},
                "translation": [2, 0, 0]}},
    {"name": "other", "shape": {"sphere": {"radius": 0.1}}},
    {"name": "far", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0, 5, 0]}}]})";
}

PairClaim& claim_of(ResultClaims& claims, const std::string& a, const std::string& b) {
  return *std::ranges::find(*claims.pairs, std::array<std::string, 2>{a, b}, &PairClaim::pair);
}

// The numbers beside the verdict of a pair are proven, too, or the file is called broken.
TEST(VerifyResult, LooksAtTheNumbersOfPairs) {
  const ResultClaims claims = claims_of(fly_by_of_three(), {.all_pairs = true, .closest = true});
  ASSERT_EQ(verify_result(claims).verdict, ProofVerdict::proven) << verify_result(claims).problem;
  const auto found_with = [&](const auto& edit) {
    ResultClaims edited = claims;
    edit(claim_of(edited, "mover", "other"));
    return verify_result(edited);
  };
  const auto problem_of = [&](const auto& edit) {
    const ResultVerification found = found_with(edit);
    EXPECT_EQ(found.verdict, ProofVerdict::broken) << found.problem;
    return found.problem;
  };
  const std::string pair = "Pair of \"mover\" and \"other\": ";
  EXPECT_EQ(problem_of([](PairClaim& claim) { claim.margin = 40.0; }),
            pair + "its margin is not that of the scene.");
  EXPECT_EQ(problem_of([](PairClaim& claim) { claim.time = 0.7; }),
            pair + "its time is not t times the duration of the scene.");
  EXPECT_EQ(problem_of([](PairClaim& claim) { claim.clearance = -1.0; }),
            pair + "its clearance is not a distance.");
  EXPECT_EQ(problem_of([](PairClaim& claim) {
              claim.clearance = std::numeric_limits<double>::infinity();
            }),
            pair + "its clearance is null, but it is tested.");
  const ResultVerification closer = found_with([](PairClaim& claim) { claim.clearance = 0.1001; });
  EXPECT_EQ(closer.verdict, ProofVerdict::refuted) << closer.problem;
  EXPECT_EQ(closer.problem.find("The clearance of the pair does not hold. "), 0u);
  EXPECT_EQ(found_with([](PairClaim& claim) { claim.clearance = 0.0999; }).verdict,
            ProofVerdict::proven);
}

TEST(VerifyResult, TakesNoClearanceOnlyWhereNoPairIsTested) {
  ResultClaims claims = claims_of(fly_by("0"));
  claims.clearance = std::numeric_limits<double>::infinity();
  const ResultVerification found = verify_result(claims);
  EXPECT_EQ(found.verdict, ProofVerdict::broken);
  EXPECT_EQ(found.problem, "The clearance is null, but pairs are tested.");
}

// With a tolerance that is large enough, bodies are in contact at any time.
TEST(VerifyResult, TakesNoToleranceThatRoundingDoesNotExplain) {
  ResultClaims early = claims_of(falling_box());
  early.t = early.time = 0.1;
  early.tolerance_used = 5.0;
  const ResultVerification found = verify_result(early);
  EXPECT_EQ(found.verdict, ProofVerdict::not_proven);
  EXPECT_EQ(found.problem.find("The tolerance_used is 5 m; rounding explains no more than"), 0u)
      << found.problem;
  ResultClaims pairs = claims_of(falling_box(), {.all_pairs = true});
  pairs.pairs->front().tolerance_used = 2e-6;
  EXPECT_EQ(verify_result(pairs).verdict, ProofVerdict::not_proven);
  EXPECT_NE(verify_result(pairs).problem.find("\"box\" and \"floor\": the tolerance_used"),
            std::string::npos);
  ResultClaims free = claims_of(fly_by("0"));
  free.tolerance_used = 0.01;
  EXPECT_EQ(verify_result(free).verdict, ProofVerdict::not_proven);
}

/// A cube that turns while it flies into a wall 5 m away, with a tolerance that doubles do not
/// resolve.
///
/// @param place, way  [m]  where it begins, and its way in the step
std::string turning_into_a_wall(double place, double way) {
  return R"({"firstcontact": 1, "bodies": [
    {"name": "cube", "shape": {"box": {"size": [1, 1, 1]}},
     "motion": {"type": "constant_velocity", "from": {"position": [)" +
         std::to_string(place) + R"(, 0, 0]}, "translation": [)" + std::to_string(way) +
         R"(, 0, 0], "rotation_vector": [0.1, 0.2, 0.3]}},
    {"name": "wall", "shape": {"box": {"size": [1, 9, 9]}}, "pose": {"position": [)" +
         std::to_string(place + 5.0) + R"(, 0, 0]}}], "options": {"tolerance": 1e-15}})";
}

// Where doubles need a larger tolerance than was asked, the check's own is one that they explain.
TEST(VerifyResult, TakesTheToleranceThatACheckNeeds) {
  for (const auto& [place, way] : {std::pair{1.0, 6.0}, {1e6, 6.0}, {1.0, 20.0}}) {
    const ResultClaims claims = claims_of(turning_into_a_wall(place, way), {.all_pairs = true});
    ASSERT_EQ(claims.verdict, Verdict::contact);
    EXPECT_GT(claims.tolerance_used, 1e-15);
    EXPECT_GT(claims.pairs->front().tolerance_used, 1e-15);
    const ResultVerification found = verify_result(claims);
    EXPECT_EQ(found.verdict, ProofVerdict::proven) << found.problem;
  }
  // So it is of a body so fast that it moves 0.1 um from one double of time to the next.
  std::string fast = turning_into_a_wall(-8.1e8, 9e8);
  const std::string wall = "[-809999995.000000, 0, 0]";
  fast.replace(fast.find(wall), wall.size(), "[5, 0, 0]");
  const ResultClaims claims = claims_of(fast, {.all_pairs = true});
  ASSERT_EQ(claims.verdict, Verdict::contact);
  EXPECT_GT(claims.tolerance_used, 1e-7);
  EXPECT_EQ(verify_result(claims).problem.find("tolerance_used"), std::string::npos);
}

TEST(VerifyResult, NamesWhatContradictsItself) {
  const ResultClaims claims = claims_of(falling_box());
  const auto problem = [&](const auto& edit) {
    ResultClaims edited = claims;
    edit(edited);
    const ResultVerification found = verify_result(edited);
    EXPECT_EQ(found.verdict, ProofVerdict::broken) << found.problem;
    return found.problem;
  };
  EXPECT_EQ(problem([](ResultClaims& c) { c.t = std::nan(""); }), "t is not within 0 and 1.");
  EXPECT_EQ(problem([](ResultClaims& c) { c.time = 0.5; }),
            "The time is not t times the duration of the scene.");
  EXPECT_EQ(problem([](ResultClaims& c) { c.verdict = Verdict::free; }),
            "The verdict is free, but t is not 1.");
  EXPECT_EQ(problem([](ResultClaims& c) { c.tested = 2; }),
            "The scene has 1 tested pairs, the result is about 2.");
  EXPECT_EQ(problem([](ResultClaims& c) { c.pair.reset(); }),
            "The verdict is a contact, but there is no pair.");
  EXPECT_EQ(problem([](ResultClaims& c) { (*c.pair)[0] = "bax"; }), "The scene has no \"bax\".");
  EXPECT_EQ(problem([](ResultClaims& c) { c.clearance = std::nan(""); }),
            "The clearance is not a distance.");
}

TEST(VerifyResult, RefutesAClearanceThatIsTooLarge) {
  ResultClaims claims = claims_of(fly_by("0"));
  ASSERT_EQ(claims.verdict, Verdict::free);
  EXPECT_EQ(verdict_of(claims), ProofVerdict::proven) << claims.clearance;
  claims.clearance = 0.1001;
  const ResultVerification refuted = verify_result(claims);
  EXPECT_EQ(refuted.verdict, ProofVerdict::refuted);
  EXPECT_EQ(refuted.problem.find("The clearance of the result does not hold."), 0u);
}

TEST(VerifyResult, ProvesABodyThatBeginsInsideOfASolid) {
  const std::string scene = R"({"firstcontact": 1, "bodies": [
    {"name": "seed", "shape": {"sphere": {"radius": 0.1}},
     "motion": {"type": "constant_velocity", "translation": [0.2, 0, 0]}},
    {"name": "rock", "shape": {"box": {"size": [2, 2, 2]}}}]})";
  ResultClaims claims = claims_of(scene);
  ASSERT_EQ(claims.verdict, Verdict::contact_at_start);
  EXPECT_EQ(verdict_of(claims), ProofVerdict::proven);
  claims.verdict = Verdict::free;
  claims.t = claims.time = 1.0;
  claims.pair.reset();
  claims.clearance = 0.0;
  const ResultVerification refuted = verify_result(claims);
  EXPECT_EQ(refuted.verdict, ProofVerdict::refuted);
  EXPECT_NE(refuted.problem.find("inside"), std::string::npos);
}

TEST(VerifyResult, ProvesNothingOfATimeThatWasNotReached) {
  ResultClaims claims = claims_of(falling_box());
  claims.verdict = Verdict::undecided;
  claims.t = claims.time = 0.5;
  EXPECT_EQ(verdict_of(claims), ProofVerdict::proven);
  claims.t = claims.time = 0.9;
  EXPECT_EQ(verdict_of(claims), ProofVerdict::refuted);
}

TEST(VerifyResult, TellsWhenItsWorkIsSpent) {
  const ResultVerification found = verify_result(claims_of(falling_box()), {.work = 3});
  EXPECT_EQ(found.verdict, ProofVerdict::not_proven);
  EXPECT_NE(found.problem.find("took more work"), std::string::npos);
}

TEST(VerifyResult, RefusesWhatItDoesNotCover) {
  const std::string flag = R"({"firstcontact": 1, "bodies": [
    {"name": "flag", "shape": {"vertices": [[0,0,3],[1,0,3],[0,1,3]], "triangles": [[0,1,2]]},
     "motion": {"type": "vertices", "to": [[0,0,4],[1,0,4],[0,1,5]]}},
    {"name": "ball", "shape": {"sphere": {"radius": 0.1}}}]})";
  const ResultClaims deforming = claims_of(flag);
  EXPECT_EQ(test::message_of<std::invalid_argument>([&] { (void)verify_result(deforming); }),
            "expected rigid bodies: the vertices of \"flag\" move");
}

/// The arm of ArmFolder turns against a post that it reaches, or does not reach.
std::string arm_scene(const std::string& post, const std::string& robot = "") {
  return R"({"firstcontact": 1, "bodies": [{"name": "post", "shape": {"box": {"size": [0.1, 0.1, 2]}},
      "pose": {"position": )" +
         post + R"(}}], "robots": [{"name": "arm", "urdf": "arm.urdf", "srdf": "arm.srdf",
      "trajectory": "move.csv")" +
         robot + "}]}";
}

TEST(VerifyResult, ProvesRobots) {
  const test::ArmFolder folder;
  const auto claims = [&](const std::string& scene) {
    return claims_of(scene, {}, folder.path() / "scene.json");
  };
  ResultClaims hit = claims(arm_scene("[0, 1, 0]"));
  ASSERT_EQ(hit.verdict, Verdict::contact);
  const ResultVerification proven = verify_result(hit);
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  EXPECT_LE(proven.contact_distance.value(), 1e-6);
  const ResultClaims free = claims(arm_scene("[0, 1.22, 0]"));
  ASSERT_EQ(free.verdict, Verdict::free);
  EXPECT_EQ(verdict_of(free), ProofVerdict::proven);
  hit.t += 1e-5;
  hit.time = hit.t * hit.scene.duration;
  EXPECT_EQ(verdict_of(hit), ProofVerdict::refuted);
}

TEST(VerifyResult, ProvesWhatIsCarried) {
  const test::ArmFolder folder;
  const std::string scene = R"({"firstcontact": 1, "bodies": [
    {"name": "ball", "shape": {"sphere": {"radius": 0.2}}, "pose": {"position": [1.4, 0, 0]}},
    {"name": "post", "shape": {"box": {"size": [0.1, 0.1, 2]}}, "pose": {"position": [0, 1.35, 0]}}],
    "robots": [{"name": "arm", "urdf": "arm.urdf", "trajectory": "move.csv",
      "attached": [{"body": "ball", "link": "tip", "touch_links": ["bar"]TO}]}]})";
  const auto claims = [&](const std::string& to) {
    std::string text = scene;
    text.replace(text.find("TO"), 2, to);
    return claims_of(text, {}, folder.path() / "scene.json");
  };
  ResultClaims hit = claims("");
  ASSERT_EQ(hit.verdict, Verdict::contact);
  ASSERT_EQ(hit.pair.value()[0], "ball");
  const ResultVerification proven = verify_result(hit);
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  // Put down before: the arm alone would pass, but for the ball that it leaves.
  const ResultClaims put_down = claims(R"(, "from_time": 0.5, "to_time": 2)");
  const ResultVerification rests = verify_result(put_down);
  EXPECT_EQ(rests.verdict, ProofVerdict::proven) << rests.problem;
  hit.verdict = Verdict::free;
  hit.t = 1.0;
  hit.time = hit.scene.duration;
  hit.pair.reset();
  EXPECT_EQ(verdict_of(hit), ProofVerdict::refuted);
}

TEST(VerifyResult, RefusesARobotThatHasChanged) {
  const test::ArmFolder folder;
  const std::string text = checked(arm_scene("[0, 1, 0]"), {}, folder.path() / "scene.json");
  folder.write("arm.srdf",
               R"(<robot name="arm"><disable_collisions link1="base" link2="tip"/></robot>)");
  const ResultClaims claims = read_claims(text, "result.json");
  EXPECT_NE(test::message_of<std::invalid_argument>([&] {
              (void)verify_result(claims);
            }).find("is not what it was"),
            std::string::npos);
}

TEST(ProvableFile, TellsResultsFromRuns) {
  EXPECT_EQ(provable_file(checked(falling_box())), ProvableFile::result);
  EXPECT_EQ(provable_file(R"({"firstcontact_run": 1})"), ProvableFile::run);
  EXPECT_EQ(provable_file(R"({"firstcontact_path": 1})"), ProvableFile::path);
  EXPECT_EQ(provable_file(R"({"firstcontact": 1})"), ProvableFile::unknown);
  EXPECT_EQ(provable_file("{"), ProvableFile::unknown);
  EXPECT_EQ(provable_file(""), ProvableFile::unknown);
}

TEST(ProvableFile, GuessesWhatADamagedFileWas) {
  EXPECT_EQ(damaged_file("{\n \"firstcontact_path\": 1, \"verdict\": "), ProvableFile::path);
  EXPECT_EQ(damaged_file(R"({"firstcontact_run": 1, "a": 1, "a": 2})"), ProvableFile::run);
  const std::string result = checked(falling_box());
  EXPECT_EQ(damaged_file(result.substr(0, result.size() / 2)), ProvableFile::result);
  EXPECT_EQ(damaged_file(R"({"firstcontact": 1, "bodies")"), ProvableFile::unknown);
  EXPECT_EQ(damaged_file("solid mesh"), ProvableFile::unknown);
  // Nothing is damaged in these.
  EXPECT_EQ(damaged_file(R"({"id": "a", "firstcontact": 1})"), ProvableFile::unknown);
}

}  // namespace
}  // namespace firstcontact
