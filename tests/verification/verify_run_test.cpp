#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/query/distance.h>
#include <firstcontact/scene/body_motion.h>
#include <firstcontact/verification/verify_run.h>

#include "record/recorded_run.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::Leg;
using test::RecordedRun;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Two bodies; the first one moves.
std::string scene(const std::string& first, const std::string& second,
                  const std::string& more = "") {
  return R"({"firstcontact": 1, "bodies": [{"name": "mover", )" + first +
         R"(}, {"name": "other", )" + second + "}]" + more + "}";
}

std::string sphere(double radius, const std::string& position) {
  return R"("shape": {"sphere": {"radius": )" + std::to_string(radius) +
         R"(}}, "pose": {"position": )" + position + "}";
}

std::string box(const std::string& size, const std::string& position) {
  return R"("shape": {"box": {"size": )" + size + R"(}}, "pose": {"position": )" + position + "}";
}

/// A ball flies past another one at a distance of 0.1 m.
RecordedRun fly_by(double clearance) {
  RecordedRun run(scene(sphere(0.1, "[-1, 0, 0.3]"), sphere(0.1, "[0, 0, 0]")));
  run.add({{0, {{.lasts = 0.5, .velocity = {1.0, 0.0, 0.0}}}}}, clearance);
  run.add({{0, {{.lasts = 1.0, .velocity = {1.0, 0.0, 0.0}}}}}, clearance);
  return run;
}

TEST(VerifyRun, ProvesWhatWasPromised) {
  const RunVerification proven = fly_by(0.1).verify();
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  EXPECT_EQ(proven.steps, 2u);
  EXPECT_EQ(proven.time, 1.5);
  EXPECT_TRUE(proven.problem.empty());
}

TEST(VerifyRun, FindsTheLeastDistance) {
  const RunVerification proven = fly_by(0.0).verify();
  EXPECT_EQ(proven.verdict, ProofVerdict::proven);
  EXPECT_LE(proven.least_distance, 0.1);
  EXPECT_GE(proven.least_distance, 0.0949);
  ASSERT_TRUE(proven.closest);
  EXPECT_EQ(proven.closest->step, 2u);
  EXPECT_NEAR(proven.closest->time, 1.0, 0.1);
  EXPECT_EQ(proven.closest->bodies, (BodyPair{0, 1}));
  EXPECT_GE(proven.closest->distance, 0.1 - 1e-12);
  EXPECT_LE(proven.closest->distance, 0.1055);
}

// Masses say which bodies forces moved.
TEST(VerifyRun, BreaksWhereAMassContradictsItsScene) {
  RecordedRun free_without_mass = fly_by(0.1);
  free_without_mass.header.masses[0] = 0.0;
  RecordedRun fixed_with_mass = fly_by(0.1);
  fixed_with_mass.header.masses[1] = 5.0;
  RecordedRun other_mass = fly_by(0.1);
  other_mass.header.scene.bodies[0].free->mass = 2.0;
  const std::vector<std::pair<RecordedRun, std::string>> runs{
      {free_without_mass, "The mass of \"mover\" is 0 kg, but the body is free."},
      {fixed_with_mass, "The mass of \"other\" is 5 kg, but the body is not free."},
      {other_mass, "The mass of \"mover\" is 1 kg, but its scene gives 2 kg."}};
  for (const auto& [run, problem] : runs) {
    const RunVerification broken = run.verify();
    EXPECT_EQ(broken.verdict, ProofVerdict::broken);
    EXPECT_EQ(broken.problem, problem);
  }
  other_mass.header.masses[0] = 2.0;
  EXPECT_EQ(other_mass.verify().verdict, ProofVerdict::proven);
}

TEST(VerifyRun, RefutesWhatWasNotKept) {
  const RunVerification refuted = fly_by(0.10001).verify();
  EXPECT_EQ(refuted.verdict, ProofVerdict::refuted);
  ASSERT_TRUE(refuted.problem_at);
  EXPECT_EQ(refuted.problem_at->step, 2u);
  EXPECT_NEAR(refuted.problem_at->time, 1.0, 0.01);
  EXPECT_EQ(refuted.problem, "\"mover\" and \"other\" come closer than promised.");
}

// Between two frames, and whatever was promised.
TEST(VerifyRun, FindsWhatTunnels) {
  for (const double speed : {20.0, 200.0, 2000.0}) {
    for (const double spin : {0.0, 1000.0}) {
      RecordedRun run(
          scene(box("[0.01, 0.01, 0.01]", "[0, 0, 0.1]"), box("[1, 1, 0.0001]", "[0, 0, 0]")));
      run.add({{0,
                {{.lasts = 1.0 / 60.0,
                  .velocity = {0.0, 0.0, -speed},
                  .angular_velocity = {spin, 0.5 * spin, 0.0}}}}});
      EXPECT_EQ(run.verify().verdict == ProofVerdict::proven, false) << speed << " " << spin;
      run.steps[0].clearance = 1e-6;
      const RunVerification refuted = run.verify();
      EXPECT_EQ(refuted.verdict, ProofVerdict::refuted) << speed << " " << spin;
    }
  }
}

// At the same speed, but beside the plate.
TEST(VerifyRun, ProvesFastMotions) {
  RecordedRun run(
      scene(box("[0.01, 0.01, 0.01]", "[0.52, 0, 0.1]"), box("[1, 1, 0.0001]", "[0, 0, 0]")));
  run.add({{0,
            {{.lasts = 1.0 / 60.0,
              .velocity = {0.0, 0.0, -2000.0},
              .angular_velocity = {1000.0, 500.0, 0.0}}}}},
          0.01);
  const RunVerification proven = run.verify();
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  // The corner's reach is 0.00866 m, which the spin may or may not bring to the edge.
  EXPECT_GE(proven.least_distance, 0.0107);
  EXPECT_LE(proven.least_distance, 0.015);
}

// Contacts that last: what moves along the contact is not to be taken for an approach.
TEST(VerifyRun, ProvesBodiesThatRestSlideSpinAndRoll) {
  const std::string floor = box("[20, 20, 0.1]", "[0, 0, -0.05]");
  const std::vector<Leg> motions{
      {.lasts = 0.01},
      {.lasts = 0.01, .velocity = {3.0, 1.0, 0.0}},
      {.lasts = 0.01, .angular_velocity = {0.0, 0.0, 30.0}},
      {.lasts = 0.01, .velocity = {3.0, 1.0, 0.0}, .angular_velocity = {0.0, 0.0, 30.0}}};
  for (const Leg& motion : motions) {
    RecordedRun run(scene(box("[1, 1, 1]", "[0, 0, 0.5001]"), floor));
    for (int k = 0; k < 5; ++k) {
      run.add({{0, {motion}}}, 0.99999e-4);
    }
    const RunVerification proven = run.verify();
    EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
    EXPECT_NEAR(proven.least_distance, 1e-4, 5.1e-6);
    EXPECT_GT(proven.least_distance, 0.0);
  }
  RecordedRun rolling(scene(sphere(0.5, "[0, 0, 0.5001]"), floor));
  rolling.add({{0, {{.lasts = 0.1, .velocity = {1.0, 0.0, 0.0}, .angular_velocity = {0, 2, 0}}}}},
              0.99999e-4);
  EXPECT_EQ(rolling.verify().verdict, ProofVerdict::proven);
}

// A body that falls to 10 micrometres and leaves again, in one step of two pieces.
TEST(VerifyRun, ProvesImpacts) {
  RecordedRun run(scene(box("[1, 1, 1]", "[0, 0, 0.6]"), box("[20, 20, 0.1]", "[0, 0, -0.05]")));
  const double fall = 0.09999;
  run.add({{0,
            {{.lasts = fall, .velocity = {0.3, 0.0, -1.0}},
             {.lasts = 0.1 - fall, .velocity = {0.3, 0.0, 0.5}}}}},
          0.99999e-5);
  const RunVerification proven = run.verify();
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  EXPECT_NEAR(proven.least_distance, 1e-5, 5.1e-7);
}

TEST(VerifyRun, KeepsItsPrecisionFarFromTheOrigin) {
  RecordedRun run(scene(box("[1, 1, 1]", "[65536, 65536, 0.5001]"),
                        box("[20, 20, 0.1]", "[65536, 65536, -0.05]")));
  run.add({{0, {{.lasts = 0.25, .velocity = {1.0, 0.0, 0.0}}}}}, 0.99999e-4);
  EXPECT_EQ(run.verify().verdict, ProofVerdict::proven);
}

// Edges pass each other in a gap far shorter than their displacement.
TEST(VerifyRun, ProvesEdgesThatPassClosely) {
  RecordedRun run(R"({"firstcontact": 1, "bodies": [
    {"name": "mover", "shape": {"box": {"size": [1, 1, 1]}},
     "pose": {"position": [-1, 0, 1.4143135623730951], "rotation_vector": [0.78539816339744831, 0, 0]}},
    {"name": "other", "shape": {"box": {"size": [1, 1, 1]}},
     "pose": {"position": [0, 0, 0], "rotation_vector": [0, 0.78539816339744831, 0]}}]})");
  run.add({{0, {{.lasts = 1.0, .velocity = {2.0, 0.1, 0.0}}}}}, 0.99e-4);
  const RunVerification proven = run.verify();
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  EXPECT_NEAR(proven.least_distance, 1e-4, 6e-6);
}

/// A handful of triangles within 0.3 m of each other, as the text of a shape.
std::string random_soup(test::Random& random) {
  std::string vertices;
  std::string triangles;
  for (int k = 0; k < 24; ++k) {
    const Vector3d v = random.vector(0.05, 0.3);
    vertices += (k == 0 ? "[" : ", [") + std::to_string(v.x()) + ", " + std::to_string(v.y()) +
                ", " + std::to_string(v.z()) + "]";
  }
  for (int k = 0; k < 12; ++k) {
    const int first = k % 8 * 3;
    triangles += (k == 0 ? "[" : ", [") + std::to_string(first) + ", " + std::to_string(first + 1) +
                 ", " + std::to_string((first + 2 + k) % 24) + "]";
  }
  return R"("shape": {"vertices": [)" + vertices + R"(], "triangles": [)" + triangles + "]}";
}

/// The motion of a body in a step, t = time / what the step lasted.
Motion motion_of(const RunStep& step, const RunBody& body, const Vector3d& p_BC) {
  std::vector<ConstantRatePiece> pieces;
  for (const RunPiece& piece : body.pieces) {
    pieces.push_back(
        {piece.to / step.lasted, piece.X_WB, piece.translation, piece.rotation_vector});
  }
  pieces.back().t_end = 1.0;
  return Motion::constant_rates(pieces, p_BC);
}

/// [m]  The least distance of the first two bodies at many instants of a step.
double sampled_distance(const RecordedRun& run) {
  const RunStep& step = run.steps.at(0);
  std::vector<Shape> shapes;
  std::vector<Motion> motions;
  for (std::size_t b = 0; b < 2; ++b) {
    shapes.emplace_back(std::get<Mesh>(run.header.scene.bodies[b].shape.source));
    motions.push_back(motion_of(step, step.bodies[b], run.header.centres_of_mass[b]));
  }
  Workspace workspace;
  double least = std::numeric_limits<double>::infinity();
  constexpr int kSamples = 500;
  for (int k = 0; k <= kSamples; ++k) {
    const DistanceResult found = distance({shapes[0], motions[0]}, {shapes[1], motions[1]},
                                          static_cast<double>(k) / kSamples, workspace);
    least = std::min(least, found.distance);
  }
  return least;
}

// The library's own distance at many instants is the oracle: no instant is closer than what is
// proven, and something is nearly as close.
TEST(VerifyRun, AgreesWithManySamples) {
  test::Random random(5);
  int apart = 0;
  int met = 0;
  for (int n = 0; n < test::rounds(100, 25); ++n) {
    const std::string first = random_soup(random);
    RecordedRun run(scene(first, random_soup(random)), {0, 1});
    const auto leg = [&](double lasts) {
      return Leg{lasts, random.vector(0.0, 3.0), random.vector(0.0, 10.0)};
    };
    for (std::size_t b = 0; b < 2; ++b) {
      run.header.centres_of_mass[b] = random.vector(0.0, 0.1);
    }
    // Begins apart, most often.
    const Vector3d away = random.vector(0.4, 0.9);
    run.place(1, {away, random.rotation()});
    const double early = random.uniform(0.05, 0.15);
    run.add({{0, {leg(0.1), leg(0.1)}}, {1, {leg(early), leg(0.2 - early)}}});
    run.steps[0].lasted = run.steps[0].bodies[0].pieces.back().to;
    run.steps[0].bodies[1].pieces.back().to = run.steps[0].lasted;
    run.steps[0].time = run.steps[0].lasted;
    const double sampled = sampled_distance(run);
    if (sampled == 0.0) {
      ++met;
      EXPECT_NE(run.verify().verdict, ProofVerdict::proven) << n;
      run.steps[0].clearance = 1e-6;
      EXPECT_EQ(run.verify().verdict, ProofVerdict::refuted) << n;
      continue;
    }
    if (sampled < 0.01) {
      continue;  // Perhaps they meet between samples.
    }
    ++apart;
    const RunVerification proven = run.verify();
    ASSERT_EQ(proven.verdict, ProofVerdict::proven) << n << proven.problem;
    EXPECT_LE(proven.least_distance, sampled) << n;
    EXPECT_LE(proven.closest->distance, 1.06 * sampled) << n;
    EXPECT_GE(proven.least_distance, 0.94 * proven.closest->distance) << n;
    run.steps[0].clearance = 0.9999 * proven.least_distance;
    EXPECT_EQ(run.verify().verdict, ProofVerdict::proven) << n;
    run.steps[0].clearance = 1.0001 * sampled;
    EXPECT_EQ(run.verify().verdict, ProofVerdict::refuted) << n;
  }
  EXPECT_GT(apart, test::rounds(15, 4));
  EXPECT_GT(met, test::rounds(10, 2));
}

TEST(VerifyRun, SeesTheThicknessOfShapes) {
  const std::string thick = R"("shape": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
    "triangles": [[0, 1, 2]], "radius": 0.2}, "pose": {"position": [0, 0, )";
  RecordedRun run(scene(thick + "1]}", thick + "0]}"));
  run.add({{0, {{.lasts = 1.0, .velocity = {0.0, 0.0, -0.5}}}}}, 0.09999);
  const RunVerification proven = run.verify();
  EXPECT_EQ(proven.verdict, ProofVerdict::proven);
  EXPECT_NEAR(proven.least_distance, 0.1, 5.1e-3);
  run.add({{0, {{.lasts = 1.0, .velocity = {0.0, 0.0, -0.11}}}}}, 1e-6);
  EXPECT_EQ(run.verify().verdict, ProofVerdict::refuted);
}

TEST(VerifyRun, RefusesBodiesInsideOfSolidsAtTheStart) {
  const std::string small = box("[0.1, 0.1, 0.1]", "[0.2, 0.1, 0]");
  RecordedRun inside(scene(small, box("[1, 1, 1]", "[0, 0, 0]")));
  inside.add({{0, {{.lasts = 0.1}}}}, 0.1);
  const RunVerification refuted = inside.verify();
  EXPECT_EQ(refuted.verdict, ProofVerdict::refuted);
  EXPECT_EQ(refuted.problem, "\"mover\" and \"other\" are inside each other at the start.");

  // A surface has no inside.
  const std::string shell = R"("shape": {"vertices": [[-3, -3, -3], [9, -3, -3], [-3, 9, -3],
    [-3, -3, 9]], "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])";
  RecordedRun in_shell(scene(small, shell + "}"));
  in_shell.add({{0, {{.lasts = 0.1}}}}, 0.1);
  EXPECT_EQ(in_shell.verify().verdict, ProofVerdict::proven);
  RecordedRun in_solid(scene(small, shell + R"(, "solid": true})"));
  in_solid.add({{0, {{.lasts = 0.1}}}}, 0.1);
  EXPECT_EQ(in_solid.verify().verdict, ProofVerdict::refuted);
}

TEST(VerifyRun, LeavesIgnoredPairsAlone) {
  RecordedRun run(scene(box("[1, 1, 1]", "[0, 0, 0]"), box("[1, 1, 1]", "[0.5, 0, 0]"),
                        R"(, "pairs": {"ignore": [["mover", "other"]]})"));
  run.add({{0, {{.lasts = 0.1, .velocity = {1.0, 0.0, 0.0}}}}}, 0.1);
  const RunVerification proven = run.verify();
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  EXPECT_EQ(proven.least_distance, std::numeric_limits<double>::infinity());
}

// Nothing can stop a script. The same motion of a free body is refuted.
TEST(VerifyRun, LeavesPairsWithoutAFreeBodyAlone) {
  const std::string scripted = R"("shape": {"sphere": {"radius": 0.1}}, "motion":
    {"type": "constant_velocity", "from": {"position": [0, 0, 1]}, "translation": [0, 0, -1]})";
  RecordedRun run(scene(scripted, box("[1, 1, 1]", "[0, 0, 0]")), {});
  run.add({{0, {{.lasts = 1.0, .velocity = {0.0, 0.0, -1.0}}}}}, 1e-6);
  EXPECT_EQ(run.verify().verdict, ProofVerdict::proven);
  run.header.scene.bodies[1].free.emplace();
  run.header.masses[1] = 1.0;
  EXPECT_EQ(run.verify().verdict, ProofVerdict::refuted);
}

TEST(VerifyRun, ComparesScriptedBodiesWithTheScene) {
  const std::string scripted = R"("shape": {"sphere": {"radius": 0.1}}, "motion":
    {"type": "constant_velocity", "from": {"position": [0, 0, 1]}, "translation": [1, 0, 0]})";
  for (const double speed : {1.0, 1.0 + 1e-9, 1.001}) {
    RecordedRun run(scene(scripted, box("[1, 1, 1]", "[0, 0, 0]")), {});
    run.add({{0, {{.lasts = 0.5, .velocity = {speed, 0.0, 0.0}}}}}, 0.39);
    const RunVerification found = run.verify();
    if (speed < 1.0001) {
      EXPECT_EQ(found.verdict, ProofVerdict::proven) << found.problem;
      EXPECT_NEAR(found.scripted_deviation, 0.5 * (speed - 1.0), 1e-14);
    } else {
      EXPECT_EQ(found.verdict, ProofVerdict::broken);
      EXPECT_NE(found.problem.find("from where its motion in the scene puts it"),
                std::string::npos);
      // Nor may a step that ended early.
      run.steps[0].time_lost = 0.1;
      EXPECT_EQ(run.verify().verdict, ProofVerdict::broken);
    }
  }
}

// It goes on its way for 0.5 s, waits for 0.25 s, and goes on that much later.
TEST(VerifyRun, ComparesScriptedBodiesThatWaitedWithTheirScript) {
  const std::string scripted = R"("shape": {"sphere": {"radius": 0.1}}, "motion":
    {"type": "constant_velocity", "from": {"position": [0, 0, 1]}, "translation": [1, 0, 0]})";
  const auto verify = [&](const std::vector<double>& behind, double last_speed) {
    RecordedRun run(scene(scripted, box("[1, 1, 1]", "[0, 0, 0]")), {});
    run.add({{0, {{.lasts = 0.5, .velocity = {1.0, 0.0, 0.0}}}}}, 0.39);
    run.add({{0, {{.lasts = 0.25, .velocity = {0.0, 0.0, 0.0}}}}}, 0.39);
    run.add({{0, {{.lasts = 0.25, .velocity = {last_speed, 0.0, 0.0}}}}}, 0.39);
    for (std::size_t k = 0; k < behind.size(); ++k) {
      run.steps[k].bodies[0].behind = behind[k];
    }
    return run.verify();
  };
  const RunVerification found = verify({0.0, 0.25, 0.25}, 1.0);
  EXPECT_EQ(found.verdict, ProofVerdict::proven) << found.problem;
  EXPECT_EQ(found.greatest_behind, 0.25);
  EXPECT_LE(found.scripted_deviation, 1e-12);
  // A script that came back to it, or on which it hurried.
  EXPECT_EQ(verify({0.0, 0.25, 0.125}, 1.5).verdict, ProofVerdict::proven);
  // It is elsewhere, or cannot be.
  EXPECT_EQ(verify({0.0, 0.25, 0.25}, 1.1).verdict, ProofVerdict::broken);
  EXPECT_EQ(verify({0.0, 0.2, 0.2}, 1.0).verdict, ProofVerdict::broken);
  EXPECT_EQ(verify({0.0, 0.25, 0.0}, 1.0).verdict, ProofVerdict::broken);
  EXPECT_EQ(verify({0.0, 0.0, 0.0}, 1.0).verdict, ProofVerdict::broken);
  EXPECT_EQ(verify({0.0, 1.0, 1.0}, 1.0).verdict, ProofVerdict::broken);
  EXPECT_EQ(verify({0.0, -0.25, -0.25}, 1.0).verdict, ProofVerdict::broken);
  EXPECT_EQ(verify({0.0, kNaN, kNaN}, 1.0).verdict, ProofVerdict::broken);
}

TEST(VerifyRun, KnowsNoScriptOfFreeBodies) {
  RecordedRun run = fly_by(0.1);
  run.steps[0].bodies[0].behind = 0.1;
  EXPECT_EQ(run.verify().verdict, ProofVerdict::broken);
}

// The piece rests while the script goes 0.3 m away and comes back.
TEST(VerifyRun, ComparesScriptedBodiesWithTheSceneWithinSteps) {
  const std::string scripted = R"("shape": {"sphere": {"radius": 0.1}}, "motion":
    {"type": "waypoints", "times": [0, 0.2, 0.4], "poses": [{"position": [0, 0, 1]},
     {"position": [0.3, 0, 1]}, {"position": [0, 0, 1]}]})";
  RecordedRun run(scene(scripted, box("[1, 1, 1]", "[0, 0, 0]")), {});
  run.add({{0, {{.lasts = 0.5, .velocity = {0.0, 0.0, 0.0}}}}}, 0.39);
  const RunVerification found = run.verify();
  EXPECT_EQ(found.verdict, ProofVerdict::broken);
  EXPECT_NE(found.problem.find("is up to 0.3 m from where its motion"), std::string::npos)
      << found.problem;
}

// The chord of an arc of 0.1 rad and 1 m is 1 - cos(0.05) m inside of it.
TEST(VerifyRun, TellsHowFarAnArcIsFromItsChord) {
  const std::string scripted = R"("shape": {"sphere": {"radius": 0.1}}, "motion":
    {"type": "screw", "from": {"position": [1, 0, 2]}, "axis_point": [0, 0, 0],
     "axis_direction": [0, 0, 1], "angle": 0.1, "translation": 0})";
  RecordedRun run(scene(scripted, box("[1, 1, 1]", "[0, 0, 0]")), {});
  run.add({{0,
            {{.lasts = 1.0,
              .velocity = {std::cos(0.1) - 1.0, std::sin(0.1), 0.0},
              .angular_velocity = {0.0, 0.0, 0.1}}}}},
          1.3);
  EXPECT_EQ(run.verify().verdict, ProofVerdict::broken);
  const RunVerification found = run.verify({.scripted_tolerance = 2e-3});
  EXPECT_EQ(found.verdict, ProofVerdict::proven) << found.problem;
  EXPECT_GE(found.scripted_deviation, 1.0 - std::cos(0.05));
  EXPECT_LE(found.scripted_deviation, 1.01 * (1.0 - std::cos(0.05)));
}

// The sine of a large angle is as far from that of the exact one as the angle is rounded.
TEST(VerifyRun, ProvesBodiesThatSpinHundredsOfTimesInAStep) {
  RecordedRun run(R"({"firstcontact": 1, "bodies": [
    {"name": "rod", "shape": {"box": {"size": [1, 0.1, 0.01]}}},
    {"name": "wall", "shape": {"box": {"size": [1, 9, 9]}}, "pose": {"position": [3, 0, 0]}}]})");
  for (int k = 0; k < test::rounds(5, 1); ++k) {
    run.add({{0, {{.lasts = 1.0, .angular_velocity = {400.0, 3000.0, -900.0}}}}}, 1e-6);
  }
  const RunVerification found = run.verify();
  EXPECT_EQ(found.verdict, ProofVerdict::proven) << found.problem;
}

TEST(VerifyRun, KnowsStepsThatLastNoTime) {
  RecordedRun run = fly_by(0.0999);
  RunStep stuck = run.steps[0];
  stuck.index = 2;
  stuck.lasted = 0.0;
  stuck.bodies[0].pieces = {{0.0, stuck.bodies[0].X_WB}};
  run.steps[1].index = 3;
  run.steps.insert(run.steps.begin() + 1, stuck);
  EXPECT_EQ(run.verify().verdict, ProofVerdict::proven) << run.verify().problem;
  run.steps[1].bodies[0].X_WB.position.z() += 1e-6;
  EXPECT_EQ(run.verify().verdict, ProofVerdict::broken);
}

/// A crate that slides over a floor at 0.1 mm, among others that do, for some steps of two pieces.
RecordedRun crates() {
  RecordedRun run(R"({"firstcontact": 1, "bodies": [
    {"name": "floor", "shape": {"box": {"size": [20, 20, 0.1]}}, "pose": {"position": [0, 0, -0.05]}},
    {"name": "red", "shape": {"box": {"size": [1, 1, 1]}}, "pose": {"position": [0, 0, 0.5001]}},
    {"name": "blue", "shape": {"box": {"size": [1, 1, 1]}}, "pose": {"position": [0, 2, 0.5001]}}]})",
                  {1, 2});
  run.header.centres_of_mass[2] = {0.0, 0.1, 0.2};
  for (int k = 0; k < 20; ++k) {
    const Leg on{.lasts = 0.006, .velocity = {1.0, 0.0, 0.0}, .angular_velocity = {0, 0, 2}};
    const Leg off{.lasts = 0.004, .velocity = {-0.5, 0.5, 0.0}, .angular_velocity = {0, 0, -1}};
    run.add({{1, {on, off}}, {2, {off, on}}}, 0.99e-4);
  }
  return run;
}

TEST(VerifyRun, GivesTheSameAnswerOnEveryNumberOfThreads) {
  const RunVerification one = crates().verify({.threads = 1});
  const RunVerification two = crates().verify({.threads = 2});
  EXPECT_EQ(one.verdict, ProofVerdict::proven) << one.problem;
  EXPECT_EQ(one.steps, 20u);
  EXPECT_EQ(one.least_distance, two.least_distance);
  EXPECT_EQ(one.closest->time, two.closest->time);
  EXPECT_LT(one.greatest_jump, 1e-14);
}

/// Returns the message about the crates after a change of their record.
template <class Change>
RunVerification after(const Change& change) {
  RecordedRun run = crates();
  change(run);
  return run.verify();
}

TEST(VerifyRun, FindsAShiftedPiece) {
  for (const double by : {1e-4, -1e-4, 1e-11}) {
    const RunVerification found =
        after([&](RecordedRun& run) { run.steps[7].bodies[0].pieces[1].X_WB.position.z() += by; });
    EXPECT_EQ(found.verdict, ProofVerdict::broken);
    EXPECT_EQ(found.steps, 7u);
    EXPECT_EQ(found.problem.rfind("Step 8: \"red\" jumps by ", 0), 0u) << found.problem;
  }
}

// Shifted as a whole, it does not begin where the scene says.
TEST(VerifyRun, FindsAShiftedBody) {
  const RunVerification found = after([](RecordedRun& run) {
    for (RunStep& step : run.steps) {
      for (RunPiece& piece : step.bodies[1].pieces) {
        piece.X_WB.position.z() -= 1e-4;
      }
      step.bodies[1].X_WB.position.z() -= 1e-4;
    }
  });
  EXPECT_EQ(found.verdict, ProofVerdict::broken);
  EXPECT_EQ(found.steps, 0u);
}

// Shifted together with its scene, it comes closer than promised.
TEST(VerifyRun, FindsAShiftedBodyWithItsScene) {
  const RunVerification found = after([](RecordedRun& run) {
    std::get<FixedMotion>(run.header.scene.bodies[2].motion).pose.position.z() -= 1e-4;
    for (RunStep& step : run.steps) {
      for (RunPiece& piece : step.bodies[1].pieces) {
        piece.X_WB.position.z() -= 1e-4;
      }
      step.bodies[1].X_WB.position.z() -= 1e-4;
    }
  });
  EXPECT_EQ(found.verdict, ProofVerdict::refuted);
  EXPECT_EQ(found.problem_at->step, 1u);
  EXPECT_EQ(found.problem_at->bodies, (BodyPair{0, 2}));
  EXPECT_LE(found.problem_at->distance, 1e-12);
}

TEST(VerifyRun, FindsATurnedPiece) {
  const RunVerification found =
      after([](RecordedRun& run) { run.steps[7].bodies[1].pieces[1].X_WB.rotation.x() += 1e-10; });
  EXPECT_EQ(found.verdict, ProofVerdict::broken);
}

TEST(VerifyRun, FindsAPieceThatIsCutOut) {
  EXPECT_EQ(after([](RecordedRun& run) {
              auto& pieces = run.steps[7].bodies[1].pieces;
              pieces.erase(pieces.begin());
            }).verdict,
            ProofVerdict::broken);
  EXPECT_EQ(after([](RecordedRun& run) { run.steps[7].bodies[1].pieces.pop_back(); }).verdict,
            ProofVerdict::broken);
  EXPECT_EQ(after([](RecordedRun& run) { run.steps[7].bodies.pop_back(); }).verdict,
            ProofVerdict::broken);
}

TEST(VerifyRun, FindsAStepThatIsCutOut) {
  EXPECT_EQ(after([](RecordedRun& run) { run.steps.erase(run.steps.begin() + 7); }).problem,
            "Step 9: step 8 is missing.");
  const RunVerification renumbered = after([](RecordedRun& run) {
    run.steps.erase(run.steps.begin() + 7);
    for (std::size_t k = 7; k < run.steps.size(); ++k) {
      run.steps[k].index = k + 1;
    }
  });
  EXPECT_EQ(renumbered.verdict, ProofVerdict::broken);
}

TEST(VerifyRun, FindsSwappedBodies) {
  const RunVerification found = after([](RecordedRun& run) {
    std::swap(run.steps[7].bodies[0].pieces, run.steps[7].bodies[1].pieces);
    std::swap(run.steps[7].bodies[0].X_WB, run.steps[7].bodies[1].X_WB);
  });
  EXPECT_EQ(found.verdict, ProofVerdict::broken);
}

TEST(VerifyRun, FindsTimeThatGoesBack) {
  EXPECT_EQ(after([](RecordedRun& run) {
              std::swap(run.steps[7].bodies[0].pieces[0].to, run.steps[7].bodies[0].pieces[1].to);
            }).verdict,
            ProofVerdict::broken);
  EXPECT_EQ(after([](RecordedRun& run) { run.steps[7].time -= 0.01; }).verdict,
            ProofVerdict::broken);
  EXPECT_EQ(after([](RecordedRun& run) { run.steps[7].lasted = -0.01; }).verdict,
            ProofVerdict::broken);
}

TEST(VerifyRun, FindsWhatIsNotANumber) {
  const auto verdict = [](auto change) {
    return after([&](RecordedRun& run) { change(run.steps[7]); }).verdict;
  };
  EXPECT_EQ(verdict([](RunStep& s) { s.bodies[0].pieces[1].X_WB.position.x() = kNaN; }),
            ProofVerdict::broken);
  EXPECT_EQ(verdict([](RunStep& s) { s.bodies[0].pieces[1].translation.x() = kNaN; }),
            ProofVerdict::broken);
  EXPECT_EQ(verdict([](RunStep& s) { s.bodies[0].pieces[1].rotation_vector.x() = kNaN; }),
            ProofVerdict::broken);
  EXPECT_EQ(verdict([](RunStep& s) { s.bodies[0].X_WB.rotation.coeffs().setZero(); }),
            ProofVerdict::broken);
  EXPECT_EQ(verdict([](RunStep& s) { s.bodies[0].pieces[1].to = kNaN; }), ProofVerdict::broken);
  EXPECT_EQ(verdict([](RunStep& s) { s.time = kNaN; }), ProofVerdict::broken);
  EXPECT_EQ(verdict([](RunStep& s) { s.clearance = kNaN; }), ProofVerdict::broken);
}

// Between frames it dips into the floor and comes back: only the pieces know.
TEST(VerifyRun, FindsADipBetweenFrames) {
  for (const double depth : {1e-4, 1.1e-4, 0.5, 2.0}) {
    RecordedRun run = crates();
    run.add({{1,
              {{.lasts = 0.005, .velocity = {0.0, 0.0, -200.0 * depth}},
               {.lasts = 0.005, .velocity = {0.0, 0.0, 200.0 * depth}}}}},
            1e-6);
    const RunVerification found = run.verify();
    EXPECT_EQ(found.verdict, ProofVerdict::refuted) << depth;
    EXPECT_EQ(found.problem_at->step, 21u);
  }
}

TEST(VerifyRun, SaysWhatItCannotProve) {
  const RunVerification found = crates().verify({.work = 3});
  EXPECT_EQ(found.verdict, ProofVerdict::not_proven);
  EXPECT_EQ(found.least_distance, 0.0);
  EXPECT_EQ(found.problem,
            "It could not be proven that \"floor\" and \"red\" stay apart as promised.");
  EXPECT_EQ(RecordedRun(scene(sphere(0.1, "[0, 0, 1]"), sphere(0.1, "[0, 0, 0]"))).verify().verdict,
            ProofVerdict::not_proven);
}

TEST(VerifyRun, RefusesBadOptions) {
  EXPECT_THROW((void)crates().verify({.scripted_tolerance = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)crates().verify({.scripted_tolerance = kNaN}), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
