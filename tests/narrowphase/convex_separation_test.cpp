// Directions that separate convex polytopes: their gap is what the points say, and nearly the
// distance.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include <firstcontact/narrowphase/convex_separation.h>

#include "support/convex_distance.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

/// Points of a ball, a plane, a line, or one point.
struct Polytope {
  PointRows corners;
  Eigen::Matrix3d R;
  Vector3d centre;

  Polytope(Random& random, const Vector3d& at) : R(random.rotation()), centre(at) {
    const int count = random.chance(0.1) ? 1 : 2 + static_cast<int>(random.uniform(0.0, 100.0));
    const int flat = static_cast<int>(random.uniform(0.0, 5.0));
    corners.resize(count, 3);
    for (int i = 0; i < count; ++i) {
      Vector3d p = random.vector(0.0, 1.0);
      for (int k = 0; k < std::min(flat, 2); ++k) {
        p[k] = 0.0;
      }
      corners.row(i) = p;
    }
  }

  [[nodiscard]] PlacedPolytope placed() const { return {corners, R, centre}; }

  [[nodiscard]] Vector3d support(const Vector3d& n) const {
    Vector3d best = Vector3d::Zero();
    double most = -std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < corners.rows(); ++i) {
      const Vector3d p = centre + R * corners.row(i).transpose();
      if (n.dot(p) > most) {
        most = n.dot(p);
        best = p;
      }
    }
    return best;
  }
};

TEST(ConvexSeparation, GapIsThatOfThePointsAndNearlyTheDistance) {
  int apart = 0;
  for (std::uint64_t seed = 0; seed < test::rounds(2000, 400); ++seed) {
    Random random(seed);
    const Polytope A(random, Vector3d::Zero());
    const Polytope B(random, random.vector(0.0, seed % 2 == 0 ? 2.0 : 5.0));
    const Separation found = separate(A.placed(), B.placed(), random.direction());
    ASSERT_NEAR(found.n.norm(), 1.0, 1e-14);
    const double gap = found.n.dot(B.support(-found.n)) - found.n.dot(A.support(found.n));
    ASSERT_NEAR(found.gap, gap, 1e-14) << seed;
    const auto distance = oracle::convex_distance([&](const Vector3d& n) { return A.support(n); },
                                                  [&](const Vector3d& n) { return B.support(n); });
    ASSERT_LE(found.gap, distance.upper + 1e-13) << seed;
    if (distance.lower > 1e-3) {
      ++apart;
      ASSERT_GE(found.gap, 0.85 * distance.lower) << seed;
      const Separation nearer = separate(A.placed(), B.placed(), found.n, {.near = 0.99});
      ASSERT_GE(nearer.gap, 0.98 * distance.lower) << seed;
      const Separation rough = separate(A.placed(), B.placed(), random.direction(), {.near = 0.5});
      ASSERT_GE(rough.gap, 0.49 * distance.lower) << seed;
    }
  }
  EXPECT_GT(apart, test::rounds(500, 100));
}

TEST(ConvexSeparation, EndsWhereTheGapIsEnough) {
  Random random(3);
  const Polytope A(random, Vector3d::Zero());
  const Polytope B(random, {10.0, 0.0, 0.0});
  const Vector3d n = Vector3d(1.0, 1.0, 0.0).normalized();
  EXPECT_EQ(separate(A.placed(), B.placed(), n, {0.0, 1.0}).n, n);
}

}  // namespace
}  // namespace firstcontact::test
