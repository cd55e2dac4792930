#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <firstcontact/separation/detail/convex_parts.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/verification/verify_result.h>

#include "support/from_environment.h"
#include "support/random.h"
#include "support/rounds.h"
#include "verification/checked_scene.h"

namespace firstcontact {
namespace {

using detail::write_json;
using Eigen::Vector3d;
using test::claims_of;

ProofVerdict verdict_of(const ResultClaims& claims) { return verify_result(claims).verdict; }

std::string scene_of(const std::string& shape, const std::string& motion, const std::string& other,
                     const std::string& options = R"({"tolerance": 1e-6})") {
  return R"({"firstcontact": 1, "bodies": [{"name": "a", "shape": )" + shape + R"(, "motion": )" +
         motion + R"(}, {"name": "b", "shape": )" + other + R"(}], "options": )" + options + "}";
}

std::string falls(const std::string& pose, double way) {
  return R"({"type": "constant_velocity", "from": {)" + pose + R"(}, "translation": [0, 0, )" +
         write_json(-way) + "]}";
}

/// A cube with rounded edges; `half` is half the length of its edges without the radius [m].
std::string rounded_box(double half, double radius) {
  std::string vertices;
  for (unsigned k = 0; k < 8; ++k) {
    const auto at = [&](unsigned axis) { return write_json((k >> axis & 1u) != 0 ? half : -half); };
    vertices += (k == 0 ? "[" : ", [") + at(0) + ", " + at(1) + ", " + at(2) + "]";
  }
  return R"({"vertices": [)" + vertices +
         R"(], "triangles": [[0,4,6],[0,6,2],[1,3,7],[1,7,5],[0,1,5],[0,5,4],[2,6,7],[2,7,3],[0,2,3],[0,3,1],[4,5,7],[4,7,6]], "radius": )" +
         write_json(radius) + "}";
}

/// A fall of which the time of the contact is known.
struct Fall {
  std::string shape;
  std::string pose;
  double height = 0.0;  // [m]  The gap at the begin.
  std::string other;
};

std::vector<Fall> falls_of_known_height() {
  const std::string floor = R"({"box": {"size": [10, 10, 0.1]}})";
  const std::string mesh =
      R"({"vertices": [[-5, -5, 0], [5, -5, 0], [0, 9, 0]], "triangles": [[0, 1, 2]]})";
  const std::string cylinder = R"({"cylinder": {"radius": 0.5, "length": 1}})";
  const std::string cone = R"({"cone": {"radius": 0.3, "length": 0.8}})";
  const std::string ellipsoid = R"({"ellipsoid": {"radii": [0.3, 0.4, 0.2]}})";
  const std::string ball = R"({"sphere": {"radius": 0.25}})";
  const std::string capsule = R"({"capsule": {"radius": 0.2, "length": 0.5}})";
  const std::string rounded = rounded_box(0.2, 0.1);
  const std::string side = R"("position": [0.1, 0.2, 1.5], "quaternion_wxyz": [1, 1, 0, 0])";
  const std::string up = R"("position": [0, 0, 2])";
  const std::string tip_down = R"("position": [0.3, 0, 2], "quaternion_wxyz": [0, 1, 0, 0])";
  const std::string lying = R"({"vertices": [[-5, 0, 0], [5, 0, 0]], "triangles": [[0, 1, 1]]})";
  return {
      {cylinder, side, 1.5 - 0.5 - 0.05, floor},
      {cylinder, side, 1.5 - 0.5, mesh},
      {cylinder, up, 2.0 - 0.5 - 0.05, floor},  // Face to face.
      {cone, tip_down, 2.0 - 0.4 - 0.05, floor},
      {cone, up, 2.0 - 0.4, mesh},
      {ellipsoid, up, 2.0 - 0.2 - 0.05, floor},
      {ellipsoid, up, 2.0 - 0.2 - 0.2, ellipsoid},
      {ellipsoid, up, 2.0 - 0.2 - 0.25, ball},
      {ellipsoid, up, 2.0 - 0.2 - 0.35, R"({"box": {"size": [1, 1, 0.7]}})"},
      {cylinder, up, 2.0 - 0.5 - 0.5, cylinder},
      {cylinder, up, 2.0 - 0.5 - 0.4, cone},  // The tip meets the face.
      {cylinder, up, 2.0 - 0.5 - 0.3, rounded},
      {cylinder, up, 2.0 - 0.5 - 0.2 - 0.25, capsule},
      {cylinder, R"("position": [0, 0, 2], "quaternion_wxyz": [1, 0, 1, 0])", 2.0 - 0.5, lying},
      {ball, up, 2.0 - 0.25 - 0.5, cylinder},
      {capsule, up, 2.0 - 0.45 - 0.4, cone},
      {rounded, up, 2.0 - 0.3 - 0.2, ellipsoid},
  };
}

// The time of a contact is proven, and no other time: neither one at which the two overlap by more
// than a micrometre, nor one at which they are farther apart than the tolerance.
TEST(CurvedBodies, HaveTheContactsOfClosedForms) {
  constexpr double kWay = 1.9;
  for (const Fall& fall : falls_of_known_height()) {
    const std::string scene = scene_of(fall.shape, falls(fall.pose, kWay), fall.other);
    SCOPED_TRACE(scene);
    const double t = fall.height / kWay;
    const ResultClaims claims = claims_of(scene);
    ASSERT_EQ(claims.verdict, Verdict::contact);
    ASSERT_NEAR(claims.t, t, 1.1e-6 / kWay);
    const ResultVerification proven = verify_result(claims);
    EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
    EXPECT_LE(proven.contact_distance.value_or(1.0), 1e-6);
    EXPECT_LE(proven.left_open, 0x1p-30);
    const auto at = [&](double when) {
      ResultClaims edited = claims;
      edited.t = edited.time = when;
      return verdict_of(edited);
    };
    EXPECT_EQ(at(t - 1.1e-6 / kWay), ProofVerdict::refuted);  // Farther apart than the tolerance.
    EXPECT_EQ(at(t + 1e-6 / kWay), ProofVerdict::refuted);    // They overlap by a micrometre.
    ResultClaims free = claims;
    free.verdict = Verdict::free;
    free.t = free.time = 1.0;
    free.pair.reset();
    EXPECT_EQ(verdict_of(free), ProofVerdict::refuted);
  }
}

// Margins of 0.1 m and of nearly all of the least distance, 0.3 m, at which the two pass.
TEST(CurvedBodies, KeepMarginsUpToTheirLeastDistance) {
  const std::string pass = R"({"type": "constant_velocity", "from": {"position": [-2, 0, 0.8]},
      "translation": [4, 0, 0], "rotation_vector": [0, 0, 7]})";
  for (const std::string shape : {R"({"cylinder": {"radius": 0.4, "length": 0.5}})",
                                  R"({"ellipsoid": {"radii": [0.4, 0.3, 0.25]}})"}) {
    for (const char* margin : {"0.1", "0.2999"}) {
      const ResultClaims claims =
          claims_of(scene_of(shape, pass, R"({"box": {"size": [0.5, 0.5, 0.5]}})",
                             std::string(R"({"margin": )") + margin + "}"));
      ASSERT_EQ(claims.verdict, Verdict::free);
      const ResultVerification proven = verify_result(claims);
      EXPECT_EQ(proven.verdict, ProofVerdict::proven) << shape << margin << proven.problem;
      ResultClaims raised = claims;
      raised.scene.options.margin = 0.3001;
      EXPECT_EQ(verdict_of(raised), ProofVerdict::refuted) << shape;
    }
    ResultClaims claims = claims_of(scene_of(shape, pass, R"({"box": {"size": [0.5, 0.5, 0.5]}})"));
    EXPECT_EQ(verdict_of(claims), ProofVerdict::proven);
    claims.clearance = 0.3001;
    EXPECT_EQ(verdict_of(claims), ProofVerdict::refuted);
  }
}

// A cylinder inside a hollow or a solid block touches no triangle of it.
TEST(CurvedBodies, BeginInsideOfSolids) {
  const auto scene = [](const std::string& solid) {
    return R"({"firstcontact": 1, "bodies": [
      {"name": "pin", "shape": {"cylinder": {"radius": 0.1, "length": 0.1}}},
      {"name": "block", "shape": {"vertices": [[-1,-1,-1],[1,-1,-1],[1,1,-1],[-1,1,-1],[-1,-1,1],[1,-1,1],[1,1,1],[-1,1,1]],
         "triangles": [[0,2,1],[0,3,2],[4,5,6],[4,6,7],[0,1,5],[0,5,4],[1,2,6],[1,6,5],[2,3,7],[2,7,6],[3,0,4],[3,4,7]],
         "solid": )" +
           solid + "}}]}";
  };
  EXPECT_EQ(verdict_of(claims_of(scene("false"))), ProofVerdict::proven);
  const ResultClaims inside = claims_of(scene("true"));
  ASSERT_EQ(inside.verdict, Verdict::contact_at_start);
  EXPECT_EQ(verdict_of(inside), ProofVerdict::proven);
  ResultClaims free = inside;
  free.verdict = Verdict::free;
  free.t = free.time = 1.0;
  free.pair.reset();
  EXPECT_EQ(verdict_of(free), ProofVerdict::refuted);
}

// A marble inside a drum: both are convex sets, filled, and the one begins inside the other.
TEST(CurvedBodies, RefuteThatOneInsideTheOtherIsFree) {
  ResultClaims claims = claims_of(R"({"firstcontact": 1, "bodies": [
      {"name": "marble", "shape": {"ellipsoid": {"radii": [0.1, 0.1, 0.2]}}},
      {"name": "drum", "shape": {"cylinder": {"radius": 1, "length": 2}}}]})");
  ASSERT_EQ(claims.verdict, Verdict::contact_at_start);
  EXPECT_EQ(verdict_of(claims), ProofVerdict::proven);
  claims.verdict = Verdict::free;
  claims.t = claims.time = 1.0;
  claims.pair.reset();
  EXPECT_EQ(verdict_of(claims), ProofVerdict::refuted);
}

std::string random_curved(test::Random& random) {
  const auto size = [&] { return write_json(random.logarithmic(0.03, 0.4)); };
  const std::string first = size();
  switch (static_cast<int>(random.uniform(0.0, 3.0))) {
    case 0:
      return R"({"cylinder": {"radius": )" + first + R"(, "length": )" + size() + "}}";
    case 1:
      return R"({"cone": {"radius": )" + first + R"(, "length": )" + size() + "}}";
    default: {
      const std::string second = size();
      return R"({"ellipsoid": {"radii": [)" + first + ", " + second + ", " + size() + "]}}";
    }
  }
}

std::string random_leaves(test::Random& random) {
  std::string vertices;
  std::string triangles;
  for (int k = 0; k < 9; ++k) {
    const Vector3d v = random.vector(0.05, 0.4);
    vertices += (k == 0 ? "[" : ", [") + write_json(v.x()) + ", " + write_json(v.y()) + ", " +
                write_json(v.z()) + "]";
    triangles += (k == 0 ? "[" : ", [") + std::to_string(k) + ", " + std::to_string((k + 2) % 9) +
                 ", " + std::to_string((k + 5) % 9) + "]";
  }
  return R"({"vertices": [)" + vertices + R"(], "triangles": [)" + triangles + "]}";
}

std::string random_partner(test::Random& random) {
  const auto size = [&] { return write_json(random.logarithmic(0.03, 0.4)); };
  const std::string first = size();
  switch (static_cast<int>(random.uniform(0.0, 5.0))) {
    case 3:
      return random_leaves(random);
    case 0:
      return R"({"sphere": {"radius": )" + first + "}}";
    case 1:
      return R"({"capsule": {"radius": )" + first + R"(, "length": )" + size() + "}}";
    case 2:
      return rounded_box(0.1, random.logarithmic(0.03, 0.4));
    default:
      return random_curved(random);
  }
}

// What a check finds of random pairs is proven; a later time, or a larger clearance, never is.
TEST(CurvedBodies, AreProvenInRandomMotions) {
  int contacts = 0;
  const auto rounds = test::from_environment("FIRSTCONTACT_CURVED_CASES", test::rounds(60, 10));
  for (std::uint64_t k = 0; k < rounds && !HasFailure(); ++k) {
    test::Random random(300 + k);
    const auto vector = [&](double reach) {
      const Vector3d v = random.vector(0.0, reach);
      return "[" + write_json(v.x()) + ", " + write_json(v.y()) + ", " + write_json(v.z()) + "]";
    };
    const std::string shape = random_curved(random);
    const std::string partner = random_partner(random);
    const std::string from = vector(1.0);
    const std::string turned = vector(3.0);
    const std::string to = vector(0.4);
    const std::string motion = R"({"type": "screw", "from": {"position": )" + from +
                               R"(, "rotation_vector": )" + turned + R"(}, "to": {"position": )" +
                               to + R"(, "rotation_vector": )" + vector(3.0) + "}}";
    const double margin = random.chance(0.5) ? 0.0 : random.logarithmic(1e-6, 0.1);
    const double tolerance = random.logarithmic(1e-9, 1e-3);
    const std::string scene = scene_of(
        shape, motion, partner,
        R"({"margin": )" + write_json(margin) + R"(, "tolerance": )" + write_json(tolerance) + "}");
    SCOPED_TRACE(scene);
    const ResultClaims claims = claims_of(scene);
    const ResultVerification found = verify_result(claims);
    EXPECT_EQ(found.verdict, ProofVerdict::proven) << found.problem;
    if (claims.verdict == Verdict::contact) {
      ++contacts;
      ResultClaims later = claims;
      later.t = later.time = 0.5 * (1.0 + claims.t);
      EXPECT_NE(verdict_of(later), ProofVerdict::proven);
    }
    ResultClaims wider = claims;
    wider.clearance = 1.001 * claims.clearance + 1e-3;
    if (claims.verdict == Verdict::contact) {
      EXPECT_NE(verdict_of(wider), ProofVerdict::proven);
    }
  }
  EXPECT_GE(10 * contacts, static_cast<int>(rounds));
}

detail::BodyInstant random_instant(test::Random& random) {
  detail::BodyInstant now;
  now.R = random.rotation().toRotationMatrix();
  now.pivot = random.vector(0.0, 2.0);
  now.velocity = random.vector(0.0, 3.0);
  now.spin = random.vector(0.0, 4.0);
  // The axis passes through the pivot, which moves along it at no more than the velocity.
  now.velocity = now.spin.normalized() * now.spin.normalized().dot(now.velocity);
  return now;
}

Vector3d place(const detail::BodyInstant& now, double s, const Vector3d& y) {
  const double speed = now.spin.norm();
  const Eigen::AngleAxisd turn(s * speed, now.spin / speed);
  return now.pivot + s * now.velocity + turn * (now.R * y);
}

detail::RoundSet random_round(test::Random& random) {
  constexpr std::array kKinds{ConvexKind::cylinder, ConvexKind::cone, ConvexKind::ellipsoid};
  const auto kind = kKinds.at(static_cast<std::size_t>(random.uniform(0.0, 3.0)));
  return {.kind = kind,
          .size = random.vector(0.05, 1.0).cwiseAbs() + Vector3d::Constant(0.02),
          .centre = random.vector(0.0, 0.5)};
}

bool is_in(const detail::RoundSet& set, const Vector3d& point) {
  const Vector3d x = point - set.centre;
  const double across = std::hypot(x.x(), x.y());
  switch (set.kind) {
    case ConvexKind::cylinder:
      return across <= set.size.x() && std::abs(x.z()) <= set.size.z();
    case ConvexKind::cone:
      return std::abs(x.z()) <= set.size.z() &&
             across <= set.size.x() * (set.size.z() - x.z()) / (2.0 * set.size.z());
    default:
      return x.cwiseQuotient(set.size).squaredNorm() <= 1.0;
  }
}

// No point of a set comes out behind the bound of the gap, at any time of the window; and in a
// short one some point comes close to it.
TEST(ConvexGap, BoundsPointsThatMove) {
  test::Random random(5);
  for (int round = 0; round < 200; ++round) {
    const detail::RoundSet set_a = random_round(random);
    const detail::RoundSet set_b = random_round(random);
    const auto reach = [](const detail::RoundSet& set) {
      return set.centre.norm() + set.size.norm();
    };
    const detail::WindowBody a(random_instant(random), reach(set_a));
    const detail::WindowBody b(random_instant(random), reach(set_b));
    const detail::ConvexPart part_a{a, &set_a, a.reach};
    const detail::ConvexPart part_b{b, &set_b, b.reach};
    const Vector3d n = random.direction();
    const double half = random.logarithmic(1e-4, 1.0);
    const detail::GapBound bound = detail::convex_gap_along(n, part_a, part_b, half);
    double least = std::numeric_limits<double>::infinity();
    for (int k = -8; k <= 8; ++k) {
      const double s = k * half / 8.0;
      // The extreme points along n at that time, from the turned sets.
      const auto extreme = [&](const detail::WindowBody& body, const detail::RoundSet& set,
                               const Vector3d& m) {
        const Eigen::AngleAxisd turn(s * body.now.spin.norm(), body.now.spin.normalized());
        return place(body.now, s, set.farthest(body.now.R.transpose() * (turn.inverse() * m)));
      };
      const double gap = n.dot(extreme(b, set_b, -n) - extreme(a, set_a, n));
      EXPECT_GE(gap, bound.least() - 1e-12);
      least = std::min(least, gap);
    }
    if (half < 1e-3) {
      EXPECT_LE(least, bound.least() + 1e-3);
    }
  }
}

// Points of random places in the sets stay below their supports, farthest points reach them, and
// the ball inside is inside.
TEST(RoundSet, HasTheSupportOfItsPoints) {
  test::Random random(6);
  for (int round = 0; round < 300; ++round) {
    const detail::RoundSet set = random_round(random);
    const Vector3d m = random.vector(0.0, 2.0);
    for (int k = 0; k < 50; ++k) {
      const Vector3d point = set.centre + random.vector(0.0, 1.0).cwiseProduct(
                                              Vector3d(set.size.x(), set.size.x(), set.size.z()));
      if (is_in(set, point)) {
        EXPECT_LE(m.dot(point), set.support(m) + 1e-13);
      }
      const Vector3d in_ball = set.inner_centre() + set.inner_radius() * random.direction();
      EXPECT_TRUE(is_in(set, in_ball));
      const double share = random.uniform(0.01, 0.9);
      const Vector3d grown = set.shrunk(share).farthest(random.direction()) +
                             share * set.inner_radius() * random.direction();
      EXPECT_TRUE(is_in(set, grown));
    }
    const Vector3d farthest = set.farthest(m);
    EXPECT_NEAR(m.dot(farthest), set.support(m), 1e-13);
    EXPECT_TRUE(is_in(set, set.inner_centre() + (1.0 - 1e-12) * (farthest - set.inner_centre())));
  }
}

}  // namespace
}  // namespace firstcontact
