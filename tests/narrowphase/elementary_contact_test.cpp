// The elementary tests against closed forms, and against their own equations in 256 bits.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include <firstcontact/motion/motion.h>
#include <firstcontact/narrowphase/edge_edge_contact.h>
#include <firstcontact/narrowphase/vertex_face_contact.h>

#include "support/exact_motion.h"
#include "support/library_case.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using oracle::MotionInput;
using oracle::MotionPiece;
using oracle::Wide;

constexpr double kPi = 3.14159265358979323846;
constexpr int kCases = 4'000;

const Triangle kFace = {Vector3d(-1.0, -1.0, 0.0), Vector3d(1.0, -1.0, 0.0),
                        Vector3d(0.0, 1.0, 0.0)};
const Edge kEdge = {Vector3d(-1.0, 0.0, 0.0), Vector3d(1.0, 0.0, 0.0)};

ElementaryMotion elementary(const Motion& A, const Motion& B) {
  return ElementaryMotion(
      RelativeMotion(A.path(0, Vector3d::Zero()), B.path(0, Vector3d::Zero()), 0.0));
}

/// B starts at `from` and goes to `to`; A rests.
ElementaryMotion straight(const Vector3d& from, const Vector3d& to) {
  return elementary(Motion::fixed(), Motion::constant_velocity(Pose{from}, Vector3d(to - from)));
}

void expect_proven_at(const ElementaryContact& answer, double t) {
  EXPECT_EQ(answer.verdict, ElementaryVerdict::contact);
  EXPECT_TRUE(answer.existence_proven);
  EXPECT_LE(answer.t_lower, t + 1e-15);
  EXPECT_GE(answer.t_upper, t - 1e-15);
  EXPECT_LE(answer.t_upper - answer.t_lower, 1e-9);
}

TEST(VertexFaceContact, FindsAFallInClosedForm) {
  const ElementaryMotion motion = straight({0.1, 0.0, 1.0}, {0.1, 0.0, -3.0});
  expect_proven_at(vertex_face_contact(motion, kFace, Vector3d::Zero()), 0.25);
}

TEST(VertexFaceContact, FindsTheFirstOfAThousandTurns) {
  // The tip starts at (0, 1) and passes x = 0.5 after 7/12 of its first turn.
  const Motion wheel =
      Motion::constant_velocity(Pose{}, Vector3d::Zero(), Vector3d(0.0, 0.0, 2000.0 * kPi));
  const Triangle wall = {Vector3d(0.5, -4.0, -4.0), Vector3d(0.5, 4.0, -4.0),
                         Vector3d(0.5, 0.0, 4.0)};
  const ElementaryMotion motion = elementary(Motion::fixed(), wheel);
  const ElementaryContact answer = vertex_face_contact(motion, wall, {0.0, 1.0, 0.0});
  expect_proven_at(answer, 7.0 / 12.0 / 1000.0);
  EXPECT_LE(answer.steps, 100);
}

TEST(VertexFaceContact, FreesAThousandTurnsBesideAWall) {
  const Motion wheel =
      Motion::constant_velocity(Pose{}, Vector3d::Zero(), Vector3d(0.0, 0.0, 2000.0 * kPi));
  const Triangle wall = {Vector3d(1.001, -4.0, -4.0), Vector3d(1.001, 4.0, -4.0),
                         Vector3d(1.001, 0.0, 4.0)};
  const ElementaryMotion motion = elementary(Motion::fixed(), wheel);
  ElementaryOptions options;
  options.maximum_steps = 100'000;
  EXPECT_EQ(vertex_face_contact(motion, wall, {0.0, 1.0, 0.0}, options).verdict,
            ElementaryVerdict::free);
}

TEST(VertexFaceContact, TakesTheEndsOfTheWindowAsPartOfIt) {
  const ElementaryMotion lands = straight({0.1, 0.0, 1.0}, {0.1, 0.0, 0.0});
  const ElementaryContact at_end = vertex_face_contact(lands, kFace, Vector3d::Zero());
  EXPECT_NE(at_end.verdict, ElementaryVerdict::free);
  EXPECT_NEAR(at_end.t_lower, 1.0, 1e-12);
  const ElementaryMotion leaves = straight({0.1, 0.0, 0.0}, {0.1, 0.0, 1.0});
  const ElementaryContact at_start = vertex_face_contact(leaves, kFace, Vector3d::Zero());
  EXPECT_NE(at_start.verdict, ElementaryVerdict::free);
  EXPECT_EQ(at_start.t_lower, 0.0);
}

TEST(VertexFaceContact, SearchesItsWindowOnly) {
  const ElementaryMotion motion = straight({0.1, 0.0, 1.0}, {0.1, 0.0, -3.0});
  EXPECT_EQ(vertex_face_contact(motion, kFace, Vector3d::Zero(), {.t_end = 0.2}).verdict,
            ElementaryVerdict::free);
  EXPECT_EQ(vertex_face_contact(motion, kFace, Vector3d::Zero(), {.t_begin = 0.3}).verdict,
            ElementaryVerdict::free);
  expect_proven_at(
      vertex_face_contact(motion, kFace, Vector3d::Zero(), {.t_begin = 0.2, .t_end = 0.3}), 0.25);
}

TEST(VertexFaceContact, SaysDegenerateForASlideWithinThePlane) {
  // Over the corner (1, -1) at t = 0.25, into the face.
  const ElementaryMotion motion = straight({2.0, -1.0, 0.0}, {-2.0, -1.0, 0.0});
  const ElementaryContact answer = vertex_face_contact(motion, kFace, Vector3d::Zero());
  EXPECT_EQ(answer.verdict, ElementaryVerdict::degenerate);
  EXPECT_NEAR(answer.t_lower, 0.25, 1e-12);
  EXPECT_LE(answer.t_lower, 0.25);
}

TEST(VertexFaceContact, FreesASlideWithinThePlaneThatPasses) {
  const ElementaryMotion motion = straight({2.0, -1.001, 0.0}, {-2.0, -1.001, 0.0});
  EXPECT_EQ(vertex_face_contact(motion, kFace, Vector3d::Zero()).verdict, ElementaryVerdict::free);
}

TEST(VertexFaceContact, ClaimsNothingBeyondItsSteps) {
  const ElementaryMotion motion = straight({0.1, 0.0, 1.0}, {0.1, 0.0, -3.0});
  const ElementaryContact answer =
      vertex_face_contact(motion, kFace, Vector3d::Zero(), {.maximum_steps = 1});
  EXPECT_EQ(answer.verdict, ElementaryVerdict::degenerate);
  EXPECT_LE(answer.t_lower, 0.25);
}

TEST(VertexFaceContact, ServesNeedlesAndPoints) {
  const Triangle needle = {kEdge[0], kEdge[1], Vector3d(0.0, 1e-12, 0.0)};
  const Triangle point = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  const ElementaryMotion hits = straight({0.1, 0.0, 1.0}, {0.1, 0.0, -3.0});
  const ElementaryMotion misses = straight({0.1, 0.1, 1.0}, {0.1, 0.1, -3.0});
  EXPECT_NEAR(vertex_face_contact(hits, needle, Vector3d::Zero()).t_lower, 0.25, 1e-9);
  for (const Triangle& face : {needle, point}) {
    EXPECT_EQ(vertex_face_contact(misses, face, Vector3d::Zero()).verdict, ElementaryVerdict::free);
  }
}

TEST(EdgeEdgeContact, FindsACrossingInClosedForm) {
  const Edge across = {Vector3d(0.0, -1.0, 0.0), Vector3d(0.0, 1.0, 0.0)};
  const ElementaryMotion motion = straight({0.1, 0.2, 1.0}, {0.1, 0.2, -3.0});
  expect_proven_at(edge_edge_contact(motion, kEdge, across), 0.25);
}

TEST(EdgeEdgeContact, SaysDegenerateForParallelEdgesThatMeet) {
  const ElementaryMotion motion = straight({0.1, 0.0, 1.0}, {0.1, 0.0, -3.0});
  const ElementaryContact answer = edge_edge_contact(motion, kEdge, kEdge);
  EXPECT_NE(answer.verdict, ElementaryVerdict::free);
  EXPECT_FALSE(answer.existence_proven);
  EXPECT_NEAR(answer.t_lower, 0.25, 1e-12);
}

TEST(EdgeEdgeContact, FreesParallelEdgesThatPass) {
  const ElementaryMotion motion = straight({0.1, 1e-6, 1.0}, {0.1, 1e-6, -3.0});
  EXPECT_EQ(edge_edge_contact(motion, kEdge, kEdge).verdict, ElementaryVerdict::free);
}

// ---- Random motions, both bodies turning by up to pi, half of the pairs aimed to meet ----

struct RandomCase {
  MotionInput A;
  MotionInput B;
  Triangle face;
  Vector3d vertex;
  Edge edge_A;
  Edge edge_B;
};

class RandomCases {
  // No expression below draws twice: the cases are the same with every compiler.

 public:
  explicit RandomCases(std::uint64_t seed) : random_(seed) {}

  RandomCase next(bool aimed) {
    for (;;) {
      RandomCase c = draw();
      if (!aimed) {
        return c;
      }
      aim(c);
      if (c.vertex.norm() < 1.5 && c.edge_B[0].norm() < 2.0 && c.edge_B[1].norm() < 2.0) {
        return c;
      }
    }
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vector3d direction() {
    for (;;) {
      Vector3d v;
      for (const Eigen::Index axis : {2, 1, 0}) {
        v[axis] = uniform(-1.0, 1.0);
      }
      if (v.norm() > 0.1 && v.norm() <= 1.0) {
        return v.normalized();
      }
    }
  }
  Vector3d vector(double longest, double shortest = 0.0) {
    const Vector3d along = direction();
    return uniform(shortest, longest) * along;
  }

  static oracle::Vector3<double> plain(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

  RandomCase draw() {
    RandomCase c;
    const Vector3d start = vector(2.5, 0.5);
    c.A.kind = c.B.kind = oracle::MotionKind::constant_velocity;
    c.B.poses[0].position = plain(start);
    c.A.translation = plain(vector(0.5));
    c.B.translation = plain(vector(1.0) - 1.5 * start);
    c.A.rotation_vector = plain(vector(kPi));
    c.B.rotation_vector = plain(vector(kPi));
    const Vector3d middle = vector(0.5);
    for (Vector3d& corner : c.face) {
      corner = middle + 0.577 * direction();
    }
    c.vertex = vector(1.0);
    for (Edge* edge : {&c.edge_A, &c.edge_B}) {
      const Vector3d center = vector(0.7);
      const Vector3d half = 0.5 * direction();
      *edge = {center - half, center + half};
    }
    return c;
  }

  /// Moves B's features so that they meet A's at some time.
  void aim(RandomCase& c) {
    const double t = uniform(0.0, 1.0);
    const Pose A = oracle::to_motion(c.A).pose(t);
    const Pose B = oracle::to_motion(c.B).pose(t);
    const auto to_B = [&](const Vector3d& p_A) -> Vector3d {
      return B.rotation.conjugate() * (A.position + A.rotation * p_A - B.position);
    };
    const double a = uniform(0.0, 1.0);
    const double b = uniform(0.0, 1.0 - a);
    c.vertex = to_B(c.face[0] + a * (c.face[1] - c.face[0]) + b * (c.face[2] - c.face[0]));
    const Vector3d along = c.edge_B[1] - c.edge_B[0];
    const Vector3d p = to_B(c.edge_A[0] + uniform(0.0, 1.0) * (c.edge_A[1] - c.edge_A[0]));
    const double s = uniform(0.0, 1.0);
    c.edge_B = {p - s * along, p + (1.0 - s) * along};
  }

  std::mt19937_64 random_;
};

/// Body points at a time, in 256 bits.
class ExactPoints {
 public:
  explicit ExactPoints(const MotionInput& motion)
      : piece_(oracle::motion_pieces(motion, {0.0, 0.0, 0.0})[0]) {}

  [[nodiscard]] oracle::Vector3<Wide> at(double t, const Vector3d& p) const {
    const oracle::Vector3<double> body{p.x(), p.y(), p.z()};
    const oracle::Vector3<Wide> lever = piece_.lever + piece_.R * oracle::exact(body);
    const Wide angle = Wide(t) * piece_.angle;
    const oracle::Vector3<Wide> along = dot(piece_.axis, lever) * piece_.axis;
    return piece_.pivot + Wide(t) * piece_.travel + along + cos(angle) * (lever - along) +
           sin(angle) * cross(piece_.axis, lever);
  }

 private:
  MotionPiece piece_;
};

/// The distance of two body points as the elementary motion states it.
double computed_distance(const ElementaryMotion& motion, double t, const Vector3d& p_A,
                         const Vector3d& p_B) {
  const double tau = t - motion.t_begin;
  const auto turned = [](const Vector3d& axis, double angle, const Vector3d& v) {
    const Vector3d along = axis.dot(v) * axis;
    return Vector3d(along + std::cos(angle) * (v - along) + std::sin(angle) * axis.cross(v));
  };
  const Vector3d a =
      turned(Vector3d::UnitZ(), motion.A.rate * tau, motion.A.lever + motion.A.rotation * p_A);
  const Vector3d b =
      turned(motion.axis_B, motion.B.rate * tau, motion.B.lever + motion.B.rotation * p_B);
  return (motion.offset + tau * motion.drift + b - a).norm();
}

TEST(ElementaryMotion, PlacesPointsWithinItsRounding) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&](double scale) {
    return oracle::Vector3<double>{scale * uniform(random), scale * uniform(random),
                                   scale * uniform(random)};
  };
  double worst = 0.0;
  for (int i = 0; i < kCases; ++i) {
    SCOPED_TRACE(i);
    MotionInput A;
    MotionInput B;
    for (MotionInput* m : {&A, &B}) {
      m->kind = oracle::MotionKind::screw;
      m->poses[0] = {vector(3.0), {1.0, uniform(random), uniform(random), uniform(random)}};
      m->axis_point = vector(3.0);
      m->axis_direction = vector(1.0);
      m->angle = (i % 3 == 0 ? 100.0 : 3.0) * uniform(random);
      m->along = uniform(random);
    }
    const ElementaryMotion motion = elementary(oracle::to_motion(A), oracle::to_motion(B));
    const Vector3d p_A(uniform(random), uniform(random), uniform(random));
    const Vector3d p_B(uniform(random), uniform(random), uniform(random));
    const double t = std::abs(uniform(random));
    const double computed = computed_distance(motion, t, p_A, p_B);
    const Wide exact = norm(ExactPoints(B).at(t, p_B) - ExactPoints(A).at(t, p_A));
    const Wide difference = exact - Wide(computed);
    const double error = std::max(std::abs(difference.lower()), std::abs(difference.upper()));
    const double size = motion.A.lever_length + p_A.norm() + motion.B.lever_length + p_B.norm() +
                        motion.offset_bound;
    const double allowed = motion.rounding * size + motion.position_error;
    ASSERT_LE(error, allowed);
    worst = std::max(worst, error / allowed);
  }
  EXPECT_GE(worst, 0.01);  // Else the bound is idle.
}

/// (b - a) . (c - a) x (d - a), whose sign changes where four points become coplanar.
Wide volume(const oracle::Vector3<Wide>& a, const oracle::Vector3<Wide>& b,
            const oracle::Vector3<Wide>& c, const oracle::Vector3<Wide>& d) {
  return dot(b - a, cross(c - a, d - a));
}

bool opposite(const Wide& a, const Wide& b) {
  return (a.is_positive() && b.is_negative()) || (a.is_negative() && b.is_positive());
}

/// Where three volumes of p and two corners have one sign, p's projection is inside the face.
bool inside(const oracle::Vector3<Wide>& p, const std::array<oracle::Vector3<Wide>, 3>& face) {
  const oracle::Vector3<Wide> n = cross(face[1] - face[0], face[2] - face[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!dot(n, cross(face[(k + 1) % 3] - face[k], p - face[k])).is_positive()) {
      return false;
    }
  }
  return true;
}

struct Tally {
  int answers = 0;
  int steps = 0;

  void add(const ElementaryContact& answer) {
    ++answers;
    steps += answer.steps;
  }
};

/// Mean number of steps for each verdict.
struct MeanSteps {
  double free = 0.0;
  double contact = 0.0;
};

/// Tests random pairs, half of them aimed.
///
/// Where the answer is contact, the volume of its four corners has opposite signs at the answer's
/// ends: a root lies between.
///
/// @param volume_at  volume of a case, given A and B in 256 bits and a time; it also expects that
///                   the features meet there, and not only the plane or the lines of these features
template <class Ask, class VolumeAt>
void expect_brackets(std::uint64_t seed, const MeanSteps& allowed, const Ask& ask,
                     const VolumeAt& volume_at) {
  RandomCases cases(seed);
  Tally free;
  Tally contact;
  for (int i = 0; i < kCases; ++i) {
    SCOPED_TRACE(i);
    const RandomCase c = cases.next(i % 2 == 0);
    const ElementaryContact answer =
        ask(elementary(oracle::to_motion(c.A), oracle::to_motion(c.B)), c);
    ASSERT_NE(answer.verdict, ElementaryVerdict::degenerate);
    const bool found = answer.verdict == ElementaryVerdict::contact;
    ASSERT_TRUE(i % 2 != 0 || found);
    (found ? contact : free).add(answer);
    if (found) {
      ASSERT_TRUE(answer.existence_proven);
      ASSERT_LE(answer.t_upper - answer.t_lower, 1e-8);
      const ExactPoints A(c.A);
      const ExactPoints B(c.B);
      ASSERT_TRUE(opposite(volume_at(c, A, B, answer.t_lower), volume_at(c, A, B, answer.t_upper)));
    }
    ASSERT_FALSE(testing::Test::HasFailure());
  }
  EXPECT_LE(free.steps, allowed.free * free.answers);
  EXPECT_LE(contact.steps, allowed.contact * contact.answers);
}

TEST(VertexFaceContact, BracketsARootInsideTheFaceInFewSteps) {
  expect_brackets(
      1, {.free = 2.6, .contact = 8.0},
      [](const ElementaryMotion& motion, const RandomCase& c) {
        return vertex_face_contact(motion, c.face, c.vertex);
      },
      [](const RandomCase& c, const ExactPoints& A, const ExactPoints& B, double t) {
        const auto p = B.at(t, c.vertex);
        const std::array face = {A.at(t, c.face[0]), A.at(t, c.face[1]), A.at(t, c.face[2])};
        EXPECT_TRUE(inside(p, face));
        return volume(face[0], face[1], face[2], p);
      });
}

TEST(EdgeEdgeContact, BracketsARootWithinBothEdgesInFewSteps) {
  expect_brackets(
      2, {.free = 3.3, .contact = 9.0},
      [](const ElementaryMotion& motion, const RandomCase& c) {
        return edge_edge_contact(motion, c.edge_A, c.edge_B);
      },
      [](const RandomCase& c, const ExactPoints& A, const ExactPoints& B, double t) {
        const auto a = A.at(t, c.edge_A[0]);
        const auto b = A.at(t, c.edge_A[1]);
        const auto p = B.at(t, c.edge_B[0]);
        const auto q = B.at(t, c.edge_B[1]);
        // The end points of each edge are on either side of the plane through the other and N.
        const auto n = cross(b - a, q - p);
        EXPECT_TRUE(opposite(volume(p, q, p + n, a), volume(p, q, p + n, b)));
        EXPECT_TRUE(opposite(volume(a, b, a + n, p), volume(a, b, a + n, q)));
        return volume(a, b, p, q);
      });
}

TEST(EdgeEdgeContact, AgreesWithItselfWhenTheBodiesAreSwapped) {
  RandomCases cases(3);
  for (int i = 0; i < kCases; ++i) {
    SCOPED_TRACE(i);
    const RandomCase c = cases.next(i % 2 == 0);
    const Motion A = oracle::to_motion(c.A);
    const Motion B = oracle::to_motion(c.B);
    const ElementaryContact one = edge_edge_contact(elementary(A, B), c.edge_A, c.edge_B);
    const ElementaryContact other = edge_edge_contact(elementary(B, A), c.edge_B, c.edge_A);
    ASSERT_EQ(one.verdict, other.verdict);
    ASSERT_LE(one.t_lower, other.t_upper);
    ASSERT_LE(other.t_lower, one.t_upper);
  }
}

}  // namespace
}  // namespace firstcontact
