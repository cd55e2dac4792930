// The certified advance and first contact of two convex sets: where the time is known in closed
// form, and against the distances of an independent search along random motions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/motion/constant_rate_pair.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/narrowphase/convex_closest.h>
#include <firstcontact/narrowphase/convex_pair.h>

#include "support/convex_distance.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// [m]  Of the distances that answers are compared with, which are rounded.
constexpr double kOracleRounding = 1e-10;

ConvexSet random_set(test::Random& random) {
  const double a = random.logarithmic(0.05, 0.8);
  const double b = random.logarithmic(0.05, 0.8);
  const double c = random.logarithmic(0.05, 0.8);
  switch (static_cast<int>(random.uniform(0.0, 6.999))) {
    case 0:
      return ConvexSet::sphere(a);
    case 1:
      return ConvexSet::capsule(a, b);
    case 2:
      return ConvexSet::box({a, b, c});
    case 3:
      return ConvexSet::cylinder(a, b);
    case 4:
      return ConvexSet::cone(a, b);
    case 5:
      return ConvexSet::ellipsoid({a, b, c});
    default:
      break;
  }
  std::vector<Vector3d> points;
  for (int k = 0; k < 8; ++k) {
    points.push_back(random.vector(0.0, 0.6));
  }
  return ConvexSet::hull(points);
}

/// The set's own description, written anew.
oracle::Support support_of(const ConvexSet& set, const Matrix3d& R, const Vector3d& p) {
  const ConvexCore core = set.core();
  return [core, R, p](const Vector3d& n_W) {
    const Vector3d n = R.transpose() * n_W;
    const Vector3d& s = core.size;
    const auto sign = [](double x) { return x < 0.0 ? -1.0 : 1.0; };
    const double across = std::hypot(n.x(), n.y());
    const Vector3d rim = across > 0.0
                             ? Vector3d(s.x() * n.x() / across, s.x() * n.y() / across, 0.0)
                             : Vector3d(s.x(), 0.0, 0.0);
    Vector3d own = Vector3d::Zero();
    switch (core.kind) {
      case ConvexKind::point:
        break;
      case ConvexKind::segment:
        own = {0.0, 0.0, sign(n.z()) * s.z()};
        break;
      case ConvexKind::box:
        own = {sign(n.x()) * s.x(), sign(n.y()) * s.y(), sign(n.z()) * s.z()};
        break;
      case ConvexKind::cylinder:
        own = rim + Vector3d(0.0, 0.0, sign(n.z()) * s.z());
        break;
      case ConvexKind::cone: {
        const Vector3d low = rim - Vector3d(0.0, 0.0, s.z());
        const Vector3d tip(0.0, 0.0, s.z());
        own = n.dot(low) > n.dot(tip) ? low : tip;
        break;
      }
      case ConvexKind::ellipsoid:
        own = s.cwiseProduct(s.cwiseProduct(n).normalized());
        break;
      case ConvexKind::hull:
        own = *std::max_element(
            core.points.begin(), core.points.end(),
            [&](const Vector3d& x, const Vector3d& y) { return n.dot(x) < n.dot(y); });
        break;
    }
    return Vector3d(p + R * own);
  };
}

struct Bodies {
  ConvexSet A;
  ConvexSet B;
  Motion X_WA;
  Motion X_WB;

  /// [m]  Of the cores at t: two numbers that its exact distance lies between, but for rounding.
  [[nodiscard]] oracle::ConvexDistance distance(double t) const {
    const Pose a = X_WA.pose(t);
    const Pose b = X_WB.pose(t);
    return oracle::convex_distance(
        support_of(A, a.rotation.normalized().toRotationMatrix(), a.position),
        support_of(B, b.rotation.normalized().toRotationMatrix(), b.position));
  }

  [[nodiscard]] ConvexContact first_contact(double margin, double tolerance,
                                            std::uint64_t most_steps = 1'000'000) const {
    ConstantRatePair motion(X_WA, X_WB, Vector3d::Zero(), Vector3d::Zero(), tolerance);
    ConvexContactOptions options{.threshold = margin + A.rounding() + B.rounding(),
                                 .tolerance = tolerance,
                                 .most_steps = most_steps};
    ConvexContact found;
    std::uint64_t steps = 0;
    for (double begin = 0.0; begin < 1.0; begin = options.t_end) {
      options.t_begin = begin;
      options.t_end = motion.enter(begin);
      ConvexGuess guess;
      found = convex_first_contact({A.core(), B.core(), motion}, options, guess);
      steps += found.steps;
      if (found.verdict != ConvexVerdict::free) {
        break;
      }
    }
    found.steps = steps;
    return found;
  }
};

Pose at(const Vector3d& position,
        const Eigen::Quaterniond& rotation = Eigen::Quaterniond::Identity()) {
  return {.position = position, .rotation = rotation};
}

TEST(ConvexClosest, FindsTheDistanceOfRandomSets) {
  test::Random random(1);
  for (int round = 0; round < test::rounds(300, 40); ++round) {
    const ConvexSet A = random_set(random);
    const ConvexSet B = random_set(random);
    const Matrix3d R_A = random.rotation().toRotationMatrix();
    const Matrix3d R_B = random.rotation().toRotationMatrix();
    const Vector3d p = random.vector(0.0, 2.0);
    const oracle::ConvexDistance exact =
        oracle::convex_distance(support_of(A, R_A, Vector3d::Zero()), support_of(B, R_B, p));
    ConvexGuess guess;
    const ConvexClosest found = closest_points(
        {.core = A.core(), .R = R_A}, {.core = B.core(), .R = R_B, .centre = p}, {}, guess);
    ASSERT_GE(found.distance, exact.lower - kOracleRounding) << round;
    ASSERT_LE(found.distance, exact.upper + 1e-7) << round;
    if (exact.lower > 1e-3) {
      ASSERT_NEAR(found.gap, found.distance, 1e-7) << round;
      ASSERT_NEAR(found.n.norm(), 1.0, 1e-14);
    }
    ASSERT_NEAR((found.p_B - found.p_A).norm(), found.distance, 1e-14);
  }
}

TEST(ConvexClosest, BeginsWhereTheLastSearchEnded) {
  const ConvexSet A = ConvexSet::ellipsoid({1.0, 0.5, 0.25});
  const ConvexSet B = ConvexSet::cylinder(0.5, 1.0);
  ConvexGuess guess;
  const PlacedConvex a{.core = A.core()};
  const Matrix3d R = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const ConvexClosest cold =
      closest_points(a, {.core = B.core(), .R = R, .centre = {2.0, 1.0, 0.5}}, {}, guess);
  const ConvexClosest warm =
      closest_points(a, {.core = B.core(), .R = R, .centre = {2.0, 1.0, 0.5}}, {}, guess);
  EXPECT_LE(warm.rounds, 3);
  EXPECT_GT(cold.rounds, warm.rounds);
  EXPECT_NEAR(warm.distance, cold.distance, 1e-12);
}

RelativeState convex_state(test::Random& random) {
  RelativeState state;
  state.R_WA = random.rotation().toRotationMatrix();
  state.R_WB = random.rotation().toRotationMatrix();
  state.p_AB = random.vector(0.8, 2.5);
  state.p_AQa = random.chance(0.3) ? Vector3d(Vector3d::Zero()) : random.vector(0.0, 0.7);
  state.p_AQb =
      state.p_AB + (random.chance(0.3) ? Vector3d(Vector3d::Zero()) : random.vector(0.0, 0.7));
  state.axis_A = random.chance(0.3) ? Vector3d(state.R_WA.col(2)) : random.direction();
  state.axis_B = random.chance(0.3) ? Vector3d(state.R_WB.col(2)) : random.direction();
  state.rate_A = random.chance(0.25) ? 0.0 : random.logarithmic(0.01, 100.0);
  state.rate_B = random.chance(0.25) ? 0.0 : random.logarithmic(0.01, 100.0);
  state.pivot_velocity = random.chance(0.2) ? Vector3d(Vector3d::Zero()) : random.vector(0.0, 3.0);
  return state;
}

/// The same bodies after tau, by the model motion.
RelativeState after_time(const RelativeState& state, double tau) {
  RelativeState later = state;
  const auto turn = [tau](double rate, const Vector3d& axis) {
    return Eigen::AngleAxisd(rate * tau, axis).toRotationMatrix();
  };
  const Matrix3d turn_A = turn(state.rate_A, state.axis_A);
  const Matrix3d turn_B = turn(state.rate_B, state.axis_B);
  later.R_WA = turn_A * state.R_WA;
  later.R_WB = turn_B * state.R_WB;
  const Vector3d p_A = state.p_AQa - turn_A * state.p_AQa;
  later.p_AB = state.p_AQb + tau * state.pivot_velocity + turn_B * (state.p_AB - state.p_AQb) - p_A;
  return later;
}

// Sound along every direction: not the best ones alone.
TEST(AdvanceConvex, IsNeverTooLong) {
  test::Random random(2);
  int steps = 0;
  for (int round = 0; round < test::rounds(500, 40); ++round) {
    const ConvexSet A = random_set(random);
    const ConvexSet B = random_set(random);
    const RelativeState state = convex_state(random);
    const PlacedConvex a{.core = A.core(), .R = state.R_WA};
    const PlacedConvex b{.core = B.core(), .R = state.R_WB, .centre = state.p_AB};
    const Vector3d n = (state.p_AB.normalized() + random.vector(0.0, 0.7)).normalized();
    const double threshold = random.chance(0.5) ? 0.0 : 0.05;
    const double t_end = random.chance(0.5) ? 1.0 : random.logarithmic(1e-4, 1.0);
    const double error = convex_gap_error(state, A.core().reach, B.core().reach);
    const double tau = std::min(advance_convex(state, a, b, n, threshold, error, t_end), t_end);
    if (!(tau > 0.0)) {
      continue;
    }
    ++steps;
    for (int k = 0; k <= 12; ++k) {
      const RelativeState later = after_time(state, tau * k / 12.0);
      const double distance = oracle::convex_distance(support_of(A, later.R_WA, Vector3d::Zero()),
                                                      support_of(B, later.R_WB, later.p_AB))
                                  .upper;
      ASSERT_GT(distance, threshold - kOracleRounding)
          << "round " << round << " kinds " << static_cast<int>(A.core().kind) << ' '
          << static_cast<int>(B.core().kind) << " tau " << tau << " part " << k;
    }
  }
  EXPECT_GT(steps, test::rounds(150, 10));
}

// Tight: the gap along n closes to second order.
TEST(AdvanceConvex, ReachesTheTouchOfWhatTurns) {
  const ConvexSet A = ConvexSet::box({1.0, 1.0, 1.0});
  const ConvexSet B = ConvexSet::cylinder(0.5, 0.2);
  RelativeState state;
  state.p_AB = {0.0, 0.0, 0.6 + 1e-3};  // A gap of 1 mm under the disc.
  state.p_AQb = state.p_AB;
  state.axis_B = Vector3d::UnitX();
  state.rate_B = 1.0;  // Its rim comes down at 0.5.
  const double tau =
      advance_convex(state, {.core = A.core()}, {.core = B.core(), .centre = state.p_AB},
                     Vector3d::UnitZ(), 0.0, 0.0, 1.0);
  const double touch = 1e-3 / 0.5;
  EXPECT_LE(tau, touch * 1.01);
  EXPECT_GE(tau, touch * 0.98);
}

TEST(AdvanceConvex, BodiesOfRevolutionMayTurnForEver) {
  const ConvexSet A = ConvexSet::box({10.0, 10.0, 1.0});
  const ConvexSet B = ConvexSet::cylinder(0.5, 2.0);
  RelativeState state;
  state.p_AB = {0.0, 0.0, 1.0 + 1e-9};  // It lies on the box, nearly.
  state.R_WB = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
  state.p_AQb = state.p_AB;
  state.axis_B = Vector3d::UnitY();
  state.rate_B = 6283.0;
  state.pivot_velocity = {3.0, 1.0, 0.0};  // And rolls, or slips, along it.
  const double tau = advance_convex(state, {.core = A.core()},
                                    {.core = B.core(), .R = state.R_WB, .centre = state.p_AB},
                                    Vector3d::UnitZ(), 0.0, 1e-12, 1.0);
  EXPECT_GT(tau, 1.0);
}

TEST(AdvanceConvex, TakesWhatTheMotionMayDepart) {
  const ConvexSet A = ConvexSet::sphere(0.1);
  RelativeState state;
  state.p_AB = {1.0, 0.0, 0.0};
  state.p_AQb = state.p_AB;
  const auto tau = [&] {
    return advance_convex(state, {.core = A.core()}, {.core = A.core(), .centre = state.p_AB},
                          Vector3d::UnitX(), 0.2, 0.0, 100.0);
  };
  EXPECT_GT(tau(), 100.0);
  state.drift = 0.5;
  EXPECT_NEAR(tau(), 1.6, 1e-9);
  state.drift = 0.0;
  state.bend = 0.4;
  EXPECT_NEAR(tau(), 2.0, 1e-9);
  state.bend = std::nan("");
  EXPECT_FALSE(tau() > 0.0);
}

TEST(ConvexFirstContact, OfSpheresIsTheRootOfTheirDistance) {
  test::Random random(3);
  int contacts = 0;
  for (int round = 0; round < 500; ++round) {
    const Vector3d start = random.vector(1.0, 3.0);
    const Vector3d way = -start + random.vector(0.0, 1.5) - 0.5 * start;
    const double a = random.uniform(0.05, 0.4);
    const double b = random.uniform(0.05, 0.4);
    const double margin = random.chance(0.5) ? 0.0 : 0.01;
    const Bodies bodies{ConvexSet::sphere(a), ConvexSet::sphere(b),
                        Motion::constant_velocity(at(Vector3d::Zero()), Vector3d::Zero()),
                        Motion::constant_velocity(at(start), way)};
    const ConvexContact found = bodies.first_contact(margin, 1e-9);
    const long double r = static_cast<long double>(a) + b + margin;
    const auto from = start.cast<long double>().eval();
    const auto along = way.cast<long double>().eval();
    const long double half_b = from.dot(along);
    const long double square = along.squaredNorm();
    const long double rest = half_b * half_b - square * (from.squaredNorm() - r * r);
    const long double root = (-half_b - std::sqrt(std::max(rest, 0.0L))) / square;
    if (rest > 1e-6L && root < 1.0L) {
      ++contacts;
      ASSERT_EQ(found.verdict, ConvexVerdict::contact) << round;
      // The root itself is ill-conditioned where they graze.
      ASSERT_LE(found.t, static_cast<double>(root) + 1e-15 / std::sqrt(static_cast<double>(rest)));
      ASSERT_LE((start + found.t * way).norm(), static_cast<double>(r) + 1e-9);
      ASSERT_LE(found.steps, 25u);
    } else if (rest < -1e-6L) {
      ASSERT_EQ(found.verdict, ConvexVerdict::free) << round;
    }
  }
  EXPECT_GT(contacts, 100);
}

/// The bound of a body's height over a plane z = 0.5 is exact.
TEST(ConvexFirstContact, OfAnEllipsoidThatFallsOnABoxIsExact) {
  test::Random random(4);
  for (int round = 0; round < 200; ++round) {
    const Vector3d radii(random.uniform(0.1, 1.0), random.uniform(0.1, 1.0),
                         random.uniform(0.1, 1.0));
    const Eigen::Quaterniond turn = random.rotation();
    const Bodies bodies{ConvexSet::box({8.0, 8.0, 1.0}), ConvexSet::ellipsoid(radii),
                        Motion::fixed(),
                        Motion::constant_velocity(at({0.1, 0.2, 3.0}, turn), {0.5, 0.0, -3.0})};
    const Matrix3d R = turn.toRotationMatrix();
    const double height = R.row(2).transpose().cwiseProduct(radii).norm();
    const double touch = (3.0 - 0.5 - height) / 3.0;
    const ConvexContact found = bodies.first_contact(0.0, 1e-10);
    ASSERT_EQ(found.verdict, ConvexVerdict::contact);
    ASSERT_LE(found.t, touch + 1e-14);
    ASSERT_GE(found.t, touch - 1e-10 / 3.0 - 1e-14) << round;
    ASSERT_LE(found.steps, 12u);
  }
}

/// Cylinders that tip onto an edge, turn and fall: the lowest point of the rim.
TEST(ConvexFirstContact, OfATumblingCylinderOnABoxMeetsItsHeight) {
  const double r = 0.3;
  const double half = 0.5;
  const double rate = 20.0;
  const Bodies bodies{
      ConvexSet::box({8.0, 8.0, 1.0}), ConvexSet::cylinder(r, 2.0 * half), Motion::fixed(),
      Motion::constant_velocity(at({0.0, 0.0, 2.0}), {0.0, 0.0, -1.5}, {rate, 0.0, 0.0})};
  const ConvexContact found = bodies.first_contact(0.0, 1e-9);
  ASSERT_EQ(found.verdict, ConvexVerdict::contact);
  const auto clearance = [&](double t) {
    const double angle = rate * t;
    return 1.5 - 1.5 * t - half * std::abs(std::cos(angle)) - r * std::abs(std::sin(angle));
  };
  for (int k = 0; k < 20'000; ++k) {
    ASSERT_GT(clearance(found.t * k / 20'000.0), 0.0);
  }
  EXPECT_GE(clearance(found.t), 0.0);
  EXPECT_LE(clearance(found.t), 1e-9);
  EXPECT_LE(found.steps, 60u);
}

/// Two spheres that pass at a distance just beyond the margin, and just within.
TEST(ConvexFirstContact, DecidesGrazes) {
  for (const double beyond : {1e-7, 1e-9, 1e-11}) {
    const auto pass = [&](double aside) {
      const Bodies bodies{ConvexSet::sphere(0.25), ConvexSet::sphere(0.25), Motion::fixed(),
                          Motion::constant_velocity(at({-2.0, 0.5 + aside, 0.0}), {4.0, 0.0, 0.0})};
      return bodies.first_contact(0.0, 0.25 * beyond).verdict;
    };
    EXPECT_EQ(pass(beyond), ConvexVerdict::free) << beyond;
    EXPECT_EQ(pass(-beyond), ConvexVerdict::contact) << beyond;
  }
}

struct Judged {
  std::string complaint;
  ConvexContact answer;
};

/// Returns the error of an answer, by distances at many times before it that come closer and
/// closer.
Judged judge(const Bodies& bodies, double margin, double tolerance) {
  const ConvexContact found = bodies.first_contact(margin, tolerance);
  const double threshold = margin + bodies.A.rounding() + bodies.B.rounding();
  const auto complain = [&](const std::string& what, double t) {
    return Judged{what + " at t = " + std::to_string(t) + ", answer " + std::to_string(found.t),
                  found};
  };
  if (found.verdict != ConvexVerdict::contact && found.verdict != ConvexVerdict::free) {
    return complain("not decided", found.t);
  }
  std::vector<double> times;
  for (int k = 0; k < 60 && found.t > 0.0; ++k) {
    times.push_back(found.t * k / 60.0);
  }
  for (int k = 8; k < 40 && found.t > 0.0; ++k) {
    times.push_back(found.t * (1.0 - std::ldexp(1.0, -k)));
  }
  for (const double t : times) {
    if (bodies.distance(t).upper < threshold - kOracleRounding) {
      return complain("late or missed", t);
    }
  }
  const double distance = bodies.distance(found.t).lower;
  if (found.verdict == ConvexVerdict::contact &&
      distance > threshold + tolerance + kOracleRounding) {
    return complain("false: apart by " + std::to_string(distance - threshold), found.t);
  }
  return {"", found};
}

Bodies random_bodies(test::Random& random, double most_turn) {
  const auto motion = [&](const Vector3d& from, const Vector3d& to) {
    const Pose start = at(from, random.rotation());
    if (random.chance(0.2)) {
      return Motion::fixed(start);
    }
    const Vector3d rotation = random.direction() * random.logarithmic(0.01, most_turn);
    if (random.chance(0.3)) {
      return Motion::screw(start, random.vector(0.0, 1.0), random.direction(), rotation.norm(),
                           random.uniform(-1.0, 1.0));
    }
    return Motion::constant_velocity(start, to - from, rotation);
  };
  const ConvexSet A = random_set(random);
  const ConvexSet B = random_set(random);
  const Vector3d start = random.vector(0.3, 2.5);
  const Motion X_WA = motion(Vector3d::Zero(), random.vector(0.0, 0.5));
  return {A, B, X_WA, motion(start, random.vector(0.0, 1.3))};
}

TEST(ConvexFirstContact, OfRandomMotionsIsNeverLateAndNeverFalse) {
  test::Random random(5);
  int contacts = 0;
  int frees = 0;
  for (int round = 0; round < test::rounds(120, 10); ++round) {
    const Bodies bodies = random_bodies(random, 6.0);
    const double tolerance = random.logarithmic(1e-9, 1e-3);
    const Judged judged = judge(bodies, random.chance(0.5) ? 0.0 : 0.02, tolerance);
    ASSERT_EQ(judged.complaint, "")
        << "round " << round << " kinds " << static_cast<int>(bodies.A.core().kind) << ' '
        << static_cast<int>(bodies.B.core().kind);
    contacts += judged.answer.verdict == ConvexVerdict::contact && judged.answer.t > 0.0 ? 1 : 0;
    frees += judged.answer.verdict == ConvexVerdict::free ? 1 : 0;
  }
  EXPECT_GT(contacts, test::rounds(25, 1));
  EXPECT_GT(frees, test::rounds(15, 1));
}

TEST(ConvexFirstContact, OfAThousandTurnsIsNeverLateAndNeverFalse) {
  test::Random random(6);
  std::uint64_t most = 0;
  for (int round = 0; round < test::rounds(25, 3); ++round) {
    const Bodies bodies = random_bodies(random, 6283.0);
    const Judged judged = judge(bodies, 0.0, 1e-6);
    ASSERT_EQ(judged.complaint, "") << "round " << round;
    most = std::max(most, judged.answer.steps);
  }
  EXPECT_LT(most, 100'000u);
}

TEST(ConvexFirstContact, StopsWhereItsStepsAreSpent) {
  const Bodies bodies{
      ConvexSet::box({1.0, 1.0, 1.0}), ConvexSet::box({1.0, 1.0, 1.0}), Motion::fixed(),
      Motion::constant_velocity(at({3.0, 0.1, 0.2}), {-3.0, 0.0, 0.0}, {3.0, 5.0, 1.0})};
  const ConvexContact whole = bodies.first_contact(0.0, 1e-9);
  ASSERT_EQ(whole.verdict, ConvexVerdict::contact);
  ASSERT_GT(whole.steps, 2u);
  const ConvexContact part = bodies.first_contact(0.0, 1e-9, 2);
  EXPECT_EQ(part.verdict, ConvexVerdict::unfinished);
  EXPECT_GT(part.t, 0.0);
  EXPECT_LT(part.t, whole.t);
}

}  // namespace
}  // namespace firstcontact
