// Every kind of shape against an independent description of the same body: those made of simplices
// against the oracle, all of them, with what is inside, by the distance of convex pieces.
//
// FIRSTCONTACT_ORACLE_CASES (default 600) and FIRSTCONTACT_ORACLE_SEED (default: the clock) choose
// the sample.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "query/shape_cases.h"
#include "support/exact_state.h"
#include "support/from_environment.h"
#include "support/library_case.h"

namespace firstcontact::oracle {
namespace {

using Eigen::Vector3d;
using Rng = std::mt19937_64;

struct Question {
  ShapeCase A;
  ShapeCase B;
  MotionInput motion_A;
  MotionInput motion_B;
  FirstContactOptions options;
};

Vector3<double> random_place(Rng& rng, double distance) {
  std::normal_distribution<double> normal;
  const Vector3d v = distance * Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
  return {v.x(), v.y(), v.z()};
}

/// Towards each other, or past; one in six begins near or inside.
Question random_question(Rng& rng, int kinds) {
  const auto kind = [&] { return static_cast<ShapeKind>(rng() % static_cast<unsigned>(kinds)); };
  const ShapeKind kind_A = kind();
  const ShapeKind kind_B = kind();
  Question q{random_shape(kind_A, rng), random_shape(kind_B, rng), {}, {}, {}};
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double far = rng() % 6 == 0 ? 0.3 * uniform(rng) : 1.0 + 1.5 * uniform(rng);
  const auto start = random_place(rng, far);
  q.motion_A = random_course(rng, {0, 0, 0}, random_place(rng, 0.5 * uniform(rng)));
  q.motion_B = random_course(rng, start, random_place(rng, 1.2 * uniform(rng)));
  q.options.contacts = ContactState::none;
  q.options.tolerance = std::pow(10.0, -3.0 - static_cast<double>(rng() % 6));
  q.options.margin = rng() % 2 == 0 ? 0.0 : 0.1 * uniform(rng);
  return q;
}

FirstContactResult ask(const Question& q, Workspace& workspace) {
  const Motion X_WA = to_motion(q.motion_A);
  const Motion X_WB = to_motion(q.motion_B);
  const FirstContactResult result =
      first_contact({q.A.shape, X_WA}, {q.B.shape, X_WB}, workspace, q.options);
  const FirstContactResult swapped =
      first_contact({q.B.shape, X_WB}, {q.A.shape, X_WA}, workspace, q.options);
  EXPECT_EQ(result.verdict, swapped.verdict);
  EXPECT_EQ(result.t, swapped.t);
  return result;
}

/// A body's pose at one time, by the oracle's motion.
struct PlacedBody {
  PlacedBody(const MotionInput& motion, double t) {
    const std::vector<MotionPiece> pieces = motion_pieces(motion, {});
    const auto piece = std::find_if(pieces.begin(), pieces.end(),
                                    [&](const MotionPiece& one) { return t <= one.t_end; });
    const ExactState state(*piece, t);
    const auto eigen = [](const Vector3<Wide>& v) {
      return Vector3d(v.x.nearest(), v.y.nearest(), v.z.nearest());
    };
    for (std::size_t j = 0; j < 3; ++j) {
      R.col(static_cast<Eigen::Index>(j)) = eigen(state.column(j));
    }
    p = eigen(state.center());
  }

  [[nodiscard]] Support place(const Support& body) const {
    return [this, &body](const Vector3d& n) { return Vector3d(p + R * body(R.transpose() * n)); };
  }

  Eigen::Matrix3d R;
  Vector3d p;
};

/// [m]  Of the exact bodies at t, up to 1e-10; 0 where they meet, inside too.
double exact_distance(const Question& q, double t) {
  const PlacedBody X_WA(q.motion_A, t);
  const PlacedBody X_WB(q.motion_B, t);
  double least = std::numeric_limits<double>::infinity();
  for (const Support& a : q.A.pieces) {
    for (const Support& b : q.B.pieces) {
      least = std::min(least, convex_distance(X_WA.place(a), X_WB.place(b)).upper);
    }
  }
  return std::max(0.0, least - q.A.shape.radius() - q.B.shape.radius());
}

/// Times over the step before t, and ever closer to it.
std::vector<double> times_before(double t) {
  std::vector<double> times;
  if (t == 0.0) {
    return times;
  }
  for (int k = 0; k < 40; ++k) {
    times.push_back(t * k / 40.0);
  }
  for (int k = 6; k < 30; ++k) {
    times.push_back(t * (1.0 - std::ldexp(1.0, -k)));
  }
  return times;
}

constexpr double kRounding = 1e-9;  ///< [m]  Of exact_distance.

/// Returns the error of an answer, by the distance of the exact bodies; empty where it is correct.
std::string complaint(const Question& q, const FirstContactResult& answer) {
  if (answer.verdict == Verdict::undecided) {
    return "undecided";
  }
  const double t = answer.t;
  for (const double before : times_before(t)) {
    if (exact_distance(q, before) < q.options.margin - kRounding) {
      return "late or missed: in contact at t = " + std::to_string(before) + " before " +
             std::to_string(t);
    }
  }
  const double distance = exact_distance(q, t);
  if (answer.verdict == Verdict::free) {
    return distance < q.options.margin - kRounding ? "missed at the end" : "";
  }
  const double most = q.options.margin + answer.tolerance_used + answer.enclosure_error + kRounding;
  return distance > most ? "false: " + std::to_string(distance) + " apart" : "";
}

/// Whether a vertex of one soup is proven in the hull of a solid's corners, at t = 0.
bool is_inside(const ShapeCase& solid, const MotionInput& solid_motion, const MovingSoup& body,
               const MotionInput& body_motion) {
  const auto place = [](const MotionInput& motion, const Vector3<double>& v) {
    const ExactState state(motion_pieces(motion, {}).front(), 0.0);
    return state.center() + Wide(v.x) * state.column(0) + Wide(v.y) * state.column(1) +
           Wide(v.z) * state.column(2);
  };
  std::vector<Vector3<Wide>> corners;
  for (const auto& corner : solid.solid_corners) {
    corners.push_back(place(solid_motion, corner));
  }
  // In the hull if no plane through three corners, with all others on one side, separates it.
  const auto in_hull = [&](const Vector3<Wide>& p) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t j = i + 1; j < corners.size(); ++j) {
        for (std::size_t k = j + 1; k < corners.size(); ++k) {
          const Vector3<Wide> normal = cross(corners[j] - corners[i], corners[k] - corners[i]);
          bool above = false;
          bool below = false;
          for (std::size_t l = 0; l < corners.size(); ++l) {
            const Wide height = dot(normal, corners[l] - corners[i]);
            above = above || (height.lower() > 1e-30);
            below = below || (height.upper() < -1e-30);
          }
          const Wide height = dot(normal, p - corners[i]);
          if ((!above && !height.is_negative()) || (!below && !height.is_positive())) {
            return false;
          }
        }
      }
    }
    return !corners.empty();
  };
  return std::any_of(body.triangles.begin(), body.triangles.end(), [&](const auto& t) {
    return in_hull(place(body_motion, body.vertices[t[0]]));
  });
}

bool contains_other(const Question& q) {
  return is_inside(q.A, q.motion_A, q.B.soup, q.motion_B) ||
         is_inside(q.B, q.motion_B, q.A.soup, q.motion_A);
}

/// Returns the error of an answer by the oracle, for bodies made of simplices.
std::string oracle_complaint(const Question& q, const FirstContactResult& answer) {
  GeneratedCase c{q.A.soup, q.B.soup, q.options.margin, q.options.tolerance};
  c.A.motion = q.motion_A;
  c.B.motion = q.motion_B;
  if (contains_other(q)) {
    return answer.verdict == Verdict::contact_at_start ? "" : "not in contact though inside";
  }
  return complaint(c, answer, FirstContactOracle(c.A, c.B, c.margin).first_contact());
}

/// Counts of answers: a sample of one verdict alone would test little.
struct Tally {
  int free = 0;
  int contact = 0;
  int at_start = 0;

  void add(Verdict verdict) {
    free += verdict == Verdict::free ? 1 : 0;
    contact += verdict == Verdict::contact ? 1 : 0;
    at_start += verdict == Verdict::contact_at_start ? 1 : 0;
  }
};

template <class Complain>
void run(int kinds, std::uint64_t count, const Complain& complain) {
  const std::uint64_t seed = test::from_environment(
      "FIRSTCONTACT_ORACLE_SEED",
      static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count()));
  std::printf("FIRSTCONTACT_ORACLE_SEED=%llu\n", static_cast<unsigned long long>(seed));
  Workspace workspace;
  Tally tally;
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(seed + i);
    const Question q = random_question(rng, kinds);
    const FirstContactResult answer = ask(q, workspace);
    tally.add(answer.verdict);
    EXPECT_EQ(complain(q, answer), "") << "seed " << seed + i;
  }
  std::printf("%d free, %d contacts, %d at the start\n", tally.free, tally.contact, tally.at_start);
  const int least = static_cast<int>(count / 20);
  EXPECT_GT(std::min({tally.free, tally.contact, tally.at_start}), least);
}

TEST(Shapes, OfSimplicesMeetTheOracle) {
  run(kExactKinds, test::from_environment("FIRSTCONTACT_ORACLE_CASES", 600) / 2, oracle_complaint);
}

TEST(Shapes, MeetTheDistanceOfExactBodies) {
  run(kAllKinds, test::from_environment("FIRSTCONTACT_ORACLE_CASES", 600) / 2,
      [](const Question& q, const FirstContactResult& answer) { return complaint(q, answer); });
}

// A judge that lets everything pass would pass the tests above.
TEST(Shapes, JudgeNoticesWhatIsWrong) {
  Workspace workspace;
  int contacts = 0;
  for (std::uint64_t i = 0; i < 40; ++i) {
    Rng rng(i);
    Question q = random_question(rng, kAllKinds);
    q.options.margin = 0.0;
    FirstContactResult answer = ask(q, workspace);
    if (answer.verdict != Verdict::contact || answer.t < 0.01) {
      continue;
    }
    ++contacts;
    const double t = answer.t;
    answer.t = 0.9 * t;  // Far too early.
    EXPECT_NE(complaint(q, answer), "") << i;
    answer.t = t;
    answer.verdict = Verdict::undecided;
    EXPECT_NE(complaint(q, answer), "") << i;
    // With a margin the same answer is late.
    answer.verdict = Verdict::contact;
    q.options.margin = 0.01;
    EXPECT_NE(complaint(q, answer), "") << i;
  }
  EXPECT_GT(contacts, 5);
}

}  // namespace
}  // namespace firstcontact::oracle
