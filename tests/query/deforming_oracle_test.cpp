// Meshes whose vertices move on lines against the oracle: each other and every rigid motion, in
// families that are degenerate each in a way of its own.
//
// FIRSTCONTACT_ORACLE_CASES (default 1200) and FIRSTCONTACT_ORACLE_SEED (default: the clock) choose
// the sample.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <utility>

#include "query/shape_cases.h"
#include "support/from_environment.h"
#include "support/library_case.h"

namespace firstcontact::oracle {
namespace {

using Rng = std::mt19937_64;
using Vec = Vector3<double>;

/// Kinds of questions; all of them also vary positions, radius, margin and tolerance.
enum class Kind {
  general,      ///< Both deform.
  rigid,        ///< One moves rigidly: at rest, straight and turning, on a screw, by waypoints.
  coplanar,     ///< All of it stays in one plane.
  parallel,     ///< Faces stay in parallel planes, which meet or slide.
  collinear,    ///< All of it stays on one line.
  points,       ///< Triangles that are edges and points, also of no length only at one end.
  translation,  ///< All vertices of a body have one velocity.
  inside_out,   ///< Every triangle folds over and turns its other side.
  swinging,     ///< Corners end where a rotation takes them: faces sweep and shear.
  sliding,      ///< A corner goes along a face that turns, at a small height.
  far,          ///< A million times their size from the origin.
  travelling,   ///< Carried as far as that within the step, together.
};

constexpr int kKinds = static_cast<int>(Kind::travelling) + 1;

const char* name(Kind kind) {
  constexpr const char* kNames[] = {"general",   "rigid",   "coplanar",    "parallel",
                                    "collinear", "points",  "translation", "inside_out",
                                    "swinging",  "sliding", "far",         "travelling"};
  return kNames[static_cast<int>(kind)];
}

double uniform_in(Rng& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

/// Draws a vector of a size of about 1, with so few bits that many coordinates coincide exactly.
Vec random_vector(Rng& rng, Kind kind) {
  const auto coordinate = [&] {
    const double x = uniform_in(rng, -1.0, 1.0);
    return rng() % 2 == 0 ? x : std::round(8.0 * x) / 8.0;
  };
  Vec v{coordinate(), coordinate(), coordinate()};
  if (kind == Kind::coplanar || kind == Kind::parallel) {
    v.z = 0.0;
  }
  if (kind == Kind::collinear) {
    v.y = v.z = 0.0;
  }
  return v;
}

void add_triangle(MovingSoup& soup, const Vec& a, const Vec& b, const Vec& c) {
  const std::size_t n = soup.vertices.size();
  soup.vertices.insert(soup.vertices.end(), {a, b, c});
  soup.triangles.push_back({n, n + 1, n + 2});
}

/// Where the vertices of one body go; `travel` is what they have in common.
Vec place_at_end(Rng& rng, Kind kind, const Vec& from, const Vec& travel, const Vec& middle) {
  switch (kind) {
    case Kind::translation:
      return from + travel;
    case Kind::inside_out:
      return middle + travel - (from - middle) + 0.1 * random_vector(rng, kind);
    case Kind::swinging:
      return travel + Vec{-from.y, from.x, from.z};
    default:
      return from + travel + uniform_in(rng, 0.0, 1.0) * random_vector(rng, kind);
  }
}

MovingSoup deforming_soup(Rng& rng, Kind kind, const Vec& start, const Vec& travel) {
  MovingSoup soup;
  const std::uint64_t count = 1 + rng() % 4;
  for (std::uint64_t k = 0; k < count; ++k) {
    const Vec at = start + 0.5 * random_vector(rng, kind);
    const Vec a = at + 0.5 * random_vector(rng, kind);
    const Vec b = kind == Kind::points && rng() % 2 == 0 ? a : at + 0.5 * random_vector(rng, kind);
    const Vec c = kind == Kind::points && rng() % 2 == 0 ? b : at + 0.5 * random_vector(rng, kind);
    add_triangle(soup, a, b, c);
  }
  for (const Vec& v : soup.vertices) {
    soup.to.push_back(place_at_end(rng, kind, v, travel, start));
  }
  if (kind == Kind::points && rng() % 2 == 0) {
    soup.to[1] = soup.to[0];  // The edge of a triangle that loses its length.
  }
  return soup;
}

/// A corner above a face that tilts; it keeps its height over it at both ends, or sinks into it.
GeneratedCase sliding(Rng& rng) {
  GeneratedCase c;
  const double tilt = uniform_in(rng, -1.0, 1.0);
  const double height = std::pow(10.0, -static_cast<double>(1 + rng() % 4));
  add_triangle(c.A, {-1.0, -1.0, 0.0}, {2.0, -1.0, 0.0}, {-1.0, 2.0, 0.0});
  const auto tilted = [&](const Vec& v) { return Vec{v.x, v.y, v.z + tilt * v.x}; };
  for (const Vec& v : c.A.vertices) {
    c.A.to.push_back(tilted(v));
  }
  const Vec from{uniform_in(rng, -0.5, 0.5), uniform_in(rng, -0.5, 0.5), height};
  const Vec end{from.x + uniform_in(rng, -0.2, 0.2), from.y, height};
  add_triangle(c.B, from, from + Vec{0.1, 0.0, 1.0}, from + Vec{0.0, 0.1, 1.0});
  const double sinking = rng() % 2 == 0 ? 0.0 : uniform_in(rng, 0.0, 3.0) * height;
  const Vec to = tilted(end) - Vec{0.0, 0.0, sinking};
  c.B.to = {to, to + Vec{0.1, 0.0, 1.0}, to + Vec{0.0, 0.1, 1.0}};
  return c;
}

void shift(MovingSoup& soup, const Vec& by, const Vec& by_at_end) {
  for (Vec& v : soup.vertices) {
    v = v + by;
  }
  for (Vec& v : soup.to) {
    v = v + by_at_end;
  }
}

GeneratedCase random_case(Rng& rng, Kind kind) {
  GeneratedCase c;
  const Kind shape =
      kind == Kind::rigid || kind == Kind::far || kind == Kind::travelling ? Kind::general : kind;
  Vec start = 1.5 * random_vector(rng, shape);
  Vec travel = -1.2 * start + 0.5 * random_vector(rng, shape);
  if (kind == Kind::collinear) {
    travel = uniform_in(rng, -1.2, 0.5) * start;  // On a line nothing passes by.
  }
  if (kind == Kind::parallel) {
    start.z = rng() % 2 == 0 ? 1.0 : 0.0078125;
    travel.z = rng() % 3 == 0 ? 0.0 : -2.0 * start.z;
  }
  c = kind == Kind::sliding ? sliding(rng)
                            : GeneratedCase{deforming_soup(rng, shape, {}, {}),
                                            deforming_soup(rng, shape, start, travel), 0.0, 0.0};
  if (kind == Kind::rigid) {
    c.B.to.clear();
    for (Vec& v : c.B.vertices) {
      v = v - start;
    }
    c.B.motion = random_course(rng, start, start + travel);
  }
  if (kind == Kind::far || kind == Kind::travelling) {
    const Vec away{0x1p20, -0x1p20, 0x1p19};
    shift(c.A, kind == Kind::far ? away : Vec{}, away);
    shift(c.B, kind == Kind::far ? away : Vec{}, away);
  }
  c.tolerance = std::pow(10.0, -3.0 - static_cast<double>(rng() % 6));
  c.margin = rng() % 3 == 0 ? uniform_in(rng, 0.0, 0.2) : 0.0;
  c.A.radius = rng() % 4 == 0 ? uniform_in(rng, 0.0, 0.1) : 0.0;
  c.B.radius = rng() % 4 == 0 ? uniform_in(rng, 0.0, 0.1) : 0.0;
  if (rng() % 2 == 0) {
    std::swap(c.A, c.B);
  }
  return c;
}

std::uint64_t seed() {
  static const std::uint64_t seed = test::from_environment(
      "FIRSTCONTACT_ORACLE_SEED",
      static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count()));
  return seed;
}

class DeformingTest : public testing::TestWithParam<int> {};

TEST_P(DeformingTest, MeetsTheOracle) {
  const auto kind = static_cast<Kind>(GetParam());
  const std::uint64_t count = test::from_environment("FIRSTCONTACT_ORACLE_CASES", 1'200) / kKinds;
  std::printf("FIRSTCONTACT_ORACLE_SEED=%llu\n", static_cast<unsigned long long>(seed()));
  Workspace workspace;
  std::uint64_t gave_up = 0;
  std::uint64_t free = 0;
  std::uint64_t contacts = 0;
  std::uint64_t steps = 0;
  std::uint64_t most_steps = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(seed() + i);
    const GeneratedCase c = random_case(rng, kind);
    const Truth truth = FirstContactOracle(c.A, c.B, c.margin).first_contact();
    const FirstContactResult answer = ask_library(c, workspace);
    EXPECT_EQ(complaint_either_way(c, answer, truth, workspace), "")
        << name(kind) << " seed " << seed() + i;
    gave_up += truth.kind == TruthKind::gave_up ? 1 : 0;
    free += answer.verdict == Verdict::free ? 1 : 0;
    contacts += answer.verdict == Verdict::contact ? 1 : 0;
    steps += answer.work.steps;
    most_steps = std::max(most_steps, answer.work.steps);
  }
  std::printf("%llu free, %llu contacts after the start, %llu steps a case, at most %llu\n",
              static_cast<unsigned long long>(free), static_cast<unsigned long long>(contacts),
              static_cast<unsigned long long>(steps / count),
              static_cast<unsigned long long>(most_steps));
  EXPECT_LE(gave_up, count / 10 + 1) << "the oracle gave up";
  // The rarest kind had 2 to 13 free ones in 13 runs, 7 in the mean. A seed with none is rarer than
  // one in a thousand.
  EXPECT_GT(free, 0);
  EXPECT_GT(contacts, count / 50);
  EXPECT_LT(steps, 2'000 * count);
}

INSTANTIATE_TEST_SUITE_P(Kinds, DeformingTest, testing::Range(0, kKinds),
                         [](const testing::TestParamInfo<int>& parameter) {
                           return name(static_cast<Kind>(parameter.param));
                         });

// A judge that lets everything pass would pass the tests above.
TEST(Deforming, JudgeNoticesWhatIsWrong) {
  Workspace workspace;
  int contacts = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    Rng rng(i);
    const GeneratedCase c = random_case(rng, Kind::general);
    FirstContactResult answer = ask_library(c, workspace);
    if (answer.verdict != Verdict::contact || answer.t < 0.01 || answer.t > 0.99) {
      continue;
    }
    ++contacts;
    const Truth truth = FirstContactOracle(c.A, c.B, c.margin).first_contact();
    const double t = answer.t;
    answer.t = std::nextafter(truth.hi, 1.0);
    EXPECT_NE(complaint(c, answer, truth), "") << i;
    answer.t = 0.9 * t;
    EXPECT_NE(complaint(c, answer, truth), "") << i;
    answer.verdict = Verdict::free;
    EXPECT_NE(complaint(c, answer, truth), "") << i;
  }
  EXPECT_GT(contacts, 5);
}

}  // namespace
}  // namespace firstcontact::oracle
