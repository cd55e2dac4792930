#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/exact_motion.h"
#include "support/first_contact_oracle.h"
#include "support/generated_case.h"
#include "support/rounds.h"

namespace firstcontact::oracle {
namespace {

constexpr double kBracket = 1e-15;  // [-]  Precision of the oracle where bodies meet at some speed.

MovingSoup triangle(const Vector3<double>& a, const Vector3<double>& b, const Vector3<double>& c) {
  MovingSoup soup;
  soup.vertices = {a, b, c};
  soup.triangles = {{0, 1, 2}};
  return soup;
}

/// A triangle in the plane z = 0 that reaches beyond everything here.
MovingSoup ground() { return triangle({-9.0, -9.0, 0.0}, {9.0, -9.0, 0.0}, {0.0, 12.0, 0.0}); }

/// From the origin along x.
MovingSoup needle(double reach) {
  return triangle({0.0, -0.1, 0.0}, {0.0, 0.1, 0.0}, {reach, 0.0, 0.0});
}

MotionInput velocity(const Vector3<double>& start, const Vector3<double>& translation,
                     const Vector3<double>& spin = {}) {
  MotionInput m;
  m.kind = MotionKind::constant_velocity;
  m.poses = {{start, {}}};
  m.translation = translation;
  m.rotation_vector = spin;
  return m;
}

Truth ask(const MovingSoup& A, const MovingSoup& B, double margin = 0.0) {
  return FirstContactOracle(A, B, margin).first_contact();
}

void expect_contact_at(const Truth& truth, const Wide& t, double bracket = kBracket) {
  ASSERT_EQ(truth.kind, TruthKind::contact);
  EXPECT_LE(truth.lo, t.upper());
  EXPECT_GE(truth.hi, t.lower() - bracket);  // 1e-20 of the size is reached a little earlier.
  EXPECT_LE(truth.hi - truth.lo, bracket);
}

TEST(FirstContactOracle, FindsTheFallOfAVertexOnAFace) {
  MovingSoup B = triangle({0.0, 0.0, 0.0}, {0.3, 0.0, 1.0}, {0.0, 0.2, 1.0});
  B.motion = velocity({0.1, 0.2, 1.0}, {0.5, 0.25, -3.0}, {0.0, 0.0, 40.0});
  expect_contact_at(ask(ground(), B), Wide(1.0) / Wide(3.0));
  B.radius = 0.125;
  expect_contact_at(ask(ground(), B, 0.25), Wide(0.625) / Wide(3.0));
}

TEST(FirstContactOracle, FindsTheSwingOfANeedleIntoAWall) {
  MovingSoup B = needle(2.0);
  B.motion = velocity({0.0, 0.0, 1.25}, {}, {0.0, 1.5, 0.0});
  expect_contact_at(ask(ground(), B), asin(Wide(1.25) / Wide(2.0)) / Wide(1.5));
}

TEST(FirstContactOracle, FindsEdgesThatCross) {
  MovingSoup A = triangle({-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.1, -1.0});
  MovingSoup B = triangle({0.0, -1.0, 0.0}, {0.0, 1.0, 0.0}, {0.1, 0.0, 1.0});
  B.motion = velocity({0.0, 0.0, 0.75}, {0.25, 0.25, -1.75});
  expect_contact_at(ask(A, B), Wide(0.75) / Wide(1.75));
}

TEST(FirstContactOracle, FindsAScrewThatReachesAFace) {
  MovingSoup B = triangle({0.5, 0.0, 0.0}, {0.6, 0.1, 0.5}, {0.6, -0.1, 0.5});
  B.motion.kind = MotionKind::screw;
  B.motion.poses = {{{0.25, 0.0, 1.0}, {}}};
  B.motion.axis_point = {0.125, 0.0, 7.0};
  B.motion.axis_direction = {0.0, 0.0, -4.0};
  B.motion.angle = -62.0;
  B.motion.along = 1.75;
  expect_contact_at(ask(ground(), B), Wide(1.0) / Wide(1.75));
}

TEST(FirstContactOracle, FindsTangency) {
  MovingSoup B = needle(1.0);
  B.motion = velocity({0.0, 0.0, 1.0}, {}, {0.0, 3.0, 0.0});
  // The tip is lowest at a right angle; it lies within 1e-20 for about 1e-10 around that.
  expect_contact_at(ask(ground(), B), asin(Wide(1.0)) / Wide(3.0), 1e-9);
}

TEST(FirstContactOracle, TellsTangencyFromNearMiss) {
  for (const double gap : {1e-2, 1e-6, 1e-10, 1e-13}) {
    MovingSoup B = needle(1.0);
    B.motion = velocity({0.0, 0.0, 1.0 + gap}, {}, {0.0, 3.0, 0.0});
    EXPECT_EQ(ask(ground(), B).kind, TruthKind::free) << gap;
    B.motion.poses[0].position.z = 1.0 - gap;
    expect_contact_at(ask(ground(), B), asin(Wide(1.0 - gap)) / Wide(3.0), 1e-12);
  }
}

TEST(FirstContactOracle, FindsAnInstantOfContactBetweenDoubles) {
  MovingSoup A = triangle({0.0, 0.0, 0.0}, {0.0, -1.0, -1.0}, {0.1, -1.0, -1.0});
  MovingSoup B = triangle({0.0, 0.0, 0.0}, {0.0, 1.0, 1.0}, {0.1, 1.0, 1.0});
  B.motion = velocity({-1.0, 0.0, 0.0}, {3.0, 0.0, 0.0});
  expect_contact_at(ask(A, B), Wide(1.0) / Wide(3.0));
}

TEST(FirstContactOracle, KnowsBothEndsOfTheStep) {
  MovingSoup B = triangle({0.0, 0.0, 0.0}, {0.3, 0.0, 1.0}, {0.0, 0.2, 1.0});
  B.motion = velocity({0.0, 0.0, 1.0}, {0.5, 0.0, -1.0});
  expect_contact_at(ask(ground(), B), Wide(1.0));
  B.motion = velocity({0.0, 0.0, 0.0}, {0.5, 0.0, 1.0});
  expect_contact_at(ask(ground(), B), Wide(0.0));
  B.motion = velocity({0.0, 0.0, std::nextafter(1.0, 2.0)}, {0.5, 0.0, -1.0});
  EXPECT_EQ(ask(ground(), B).kind, TruthKind::free);
}

TEST(FirstContactOracle, EnclosesTheDistance) {
  MovingSoup B = needle(2.0);
  B.motion = velocity({0.0, 0.0, 3.0}, {}, {0.0, 1.5, 0.0});
  FirstContactOracle oracle(ground(), B, 0.0);
  for (const double t : {0.0, 0.125, 0.3, 1.0}) {
    const Wide expected = Wide(3.0) - Wide(2.0) * sin(Wide(1.5) * Wide(t));
    const DistanceBounds d = oracle.distance(t);
    EXPECT_LE(d.lower, expected.upper());
    EXPECT_GE(d.upper, expected.lower());
    EXPECT_LE(d.upper - d.lower, 1e-15);
    EXPECT_TRUE(oracle.within(t, expected.upper() * (1.0 + 1e-15)));
    EXPECT_FALSE(oracle.within(t, expected.lower() * (1.0 - 1e-15)));
  }
}

/// Every pose-to-pose motion ends at its last pose, and the screw agrees with its definition.
TEST(ExactMotion, InterpolatesItsPoses) {
  MotionInput m;
  m.poses = {{{1.0, 2.0, 3.0}, {0.5, 0.1, -0.7, 0.3}}, {{-2.0, 0.5, 1.0}, {0.1, 0.9, 0.3, -0.2}}};
  m.times = {0.25, 0.75};
  const Vector3<double> p{0.3, -0.4, 0.9};
  MotionInput last;
  last.poses = {m.poses[1]};
  const MotionPiece expected = motion_pieces(last, p).front();
  for (const MotionKind kind : {MotionKind::constant_velocity_between, MotionKind::screw_between,
                                MotionKind::waypoints, MotionKind::screw_waypoints}) {
    m.kind = kind;
    const std::vector<MotionPiece> pieces = motion_pieces(m, p);
    const MotionPiece& piece = pieces[pieces.size() == 3 ? 1 : 0];
    const Vector3<Wide> along = dot(piece.axis, piece.lever) * piece.axis;
    const Vector3<Wide> end = piece.pivot + piece.travel + along +
                              cos(piece.angle) * (piece.lever - along) +
                              sin(piece.angle) * cross(piece.axis, piece.lever);
    EXPECT_LE(norm(end - expected.pivot - expected.lever).upper(), 1e-60);
    EXPECT_LE(piece.angle.upper(), 3.1415926536);
  }
}

/// Windows, directions and roundings all differ when the bodies change places.
TEST(FirstContactOracle, AgreesWithItselfWhenSwapped) {
  for (int f = 0; f < kFamilyCount; ++f) {
    for (std::uint64_t i = 2'000'000; i < 2'000'000 + test::rounds(3, 1); ++i) {
      const GeneratedCase c = generate(static_cast<Family>(f), i);
      const Truth truth = ask(c.A, c.B, c.margin);
      const Truth swapped = ask(c.B, c.A, c.margin);
      ASSERT_EQ(truth.kind, swapped.kind) << name(static_cast<Family>(f)) << ' ' << i;
      EXPECT_LE(truth.lo, swapped.hi);
      EXPECT_LE(swapped.lo, truth.hi);
    }
  }
}

/// No sample may contradict what the oracle proved.
TEST(FirstContactOracle, AgreesWithSamplesOfGeneratedCases) {
  for (int f = 0; f < kFamilyCount; ++f) {
    for (std::uint64_t i = 1'000'000; i < 1'000'000 + test::rounds(4, 1); ++i) {
      const GeneratedCase c = generate(static_cast<Family>(f), i);
      FirstContactOracle oracle(c.A, c.B, c.margin);
      const Truth truth = oracle.first_contact();
      ASSERT_NE(truth.kind, TruthKind::gave_up) << name(static_cast<Family>(f)) << ' ' << i;
      const double end = truth.kind == TruthKind::free ? 1.0 : truth.lo;
      for (int k = 0; k < 20 && end > 0.0; ++k) {
        const double t = end * (1.0 - std::ldexp(1.0, -k));
        ASSERT_GT(oracle.distance(t).upper, c.margin) << name(static_cast<Family>(f)) << ' ' << i;
      }
      if (truth.kind == TruthKind::contact) {
        // A double beside the exact time is off by its rounding times the speed.
        EXPECT_LE(oracle.distance(truth.hi).lower, c.margin + 1e-9 * oracle.size())
            << name(static_cast<Family>(f)) << ' ' << i;
      }
    }
  }
}

}  // namespace
}  // namespace firstcontact::oracle
