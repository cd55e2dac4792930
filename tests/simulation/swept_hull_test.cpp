// Bodies that a plane proves to be apart are apart.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/narrowphase/triangle_distance.h>
#include <firstcontact/simulation_model/detail/move.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/swept_hull.h>

#include "simulation/random_body.h"
#include "support/rounds.h"

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using test::random_rotation;
using test::random_vector;
using test::tetrahedron;

double distance(const SimBody& a, const Pose& X_WA, const SimBody& b, const Pose& X_WB) {
  const auto place = [](const SimBody& body, const Pose& X, std::size_t triangle) {
    const Mesh& mesh = body.shape.mesh();
    Triangle corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = X.position + X.rotation * mesh.vertices[mesh.triangles[triangle][k]];
    }
    return corners;
  };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      least = std::min(least, triangle_distance(place(a, X_WA, i), place(b, X_WB, j)).distance);
    }
  }
  return least;
}

/// Two bodies and their moves: fast ones, or those of a pair that turns as one.
struct Moving {
  explicit Moving(std::mt19937& rng) : A(tetrahedron(rng)), B(tetrahedron(rng)) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double speed = std::pow(10.0, -3.0 + 3.3 * uniform(rng));
    X_WA = {random_vector(rng, 1.0), random_rotation(rng)};
    X_WB = {random_vector(rng, 1.0), random_rotation(rng)};
    X_WB.position += 3.0 * random_vector(rng, 1.0).normalized();
    move_A = {random_vector(rng, speed), random_vector(rng, speed)};
    move_B = {random_vector(rng, speed), random_vector(rng, speed)};
    if (uniform(rng) < 0.5) {
      move_B.rotation_vector = move_A.rotation_vector;
      const Vector3d between = centre_of_mass(B.inertia, X_WB) - centre_of_mass(A.inertia, X_WA);
      move_B.translation = move_A.translation + move_A.rotation_vector.cross(between) +
                           random_vector(rng, 0.01 * speed);
    }
  }

  [[nodiscard]] double least_distance(int samples) const {
    const Motion a = motion_of(A, X_WA, move_A);
    const Motion b = motion_of(B, X_WB, move_B);
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= samples; ++k) {
      const double t = static_cast<double>(k) / samples;
      least = std::min(least, distance(A, a.pose(t), B, b.pose(t)));
    }
    return least;
  }
  [[nodiscard]] bool stay_apart(double by) const {
    const SweptHull hull_A(A, X_WA, move_A);
    const SweptHull hull_B(B, X_WB, move_B);
    const Vector3d n = (hull_B.p_WC - hull_A.p_WC).normalized();
    return stays_apart(hull_A, hull_B, by, n) || stays_apart(hull_B, hull_A, by, -n);
  }

  SimBody A;
  SimBody B;
  Pose X_WA;
  Pose X_WB;
  Move move_A;
  Move move_B;
};

TEST(SweptHull, NeverTellsMoreThanTheLeastDistance) {
  std::mt19937 rng(1);
  for (int trial = 0; trial < test::rounds(3000, 500); ++trial) {
    const Moving c(rng);
    const double least = c.least_distance(60);
    ASSERT_FALSE(c.stay_apart(least * (1.0 + 1e-9) + 1e-12)) << trial;
  }
}

// With round bodies, far from the origin, and where only one of them turns.
TEST(SweptHull, NeverTellsMoreThanTheLeastDistanceOfRoundBodiesAnywhere) {
  std::mt19937 rng(4);
  for (int trial = 0; trial < test::rounds(1500, 300); ++trial) {
    Moving c(rng);
    const double far = trial % 3 == 0 ? 1e6 : 0.0;
    c.X_WA.position.x() += far;
    c.X_WB.position.x() += far;
    if (trial % 2 == 0) {
      c.move_A = {};
    }
    const double thick = 0.3;
    const double least = c.least_distance(60) - 2.0 * thick;
    c.A.shape = Shape(c.A.shape.mesh(), thick);
    c.B.shape = Shape(c.B.shape.mesh(), thick);
    c.A.reach += thick;
    c.B.reach += thick;
    if (least > 0.0) {
      ASSERT_FALSE(c.stay_apart(least * (1.0 + 1e-9) + 1e-12)) << trial;
    }
  }
}

TEST(SweptHull, TellsMostOfWhatStaysApart) {
  std::mt19937 rng(2);
  int apart = 0;
  int told = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Moving c(rng);
    const double turned = c.move_A.rotation_vector.norm() + c.move_B.rotation_vector.norm();
    const double least = turned < 0.2 ? c.least_distance(20) : 0.0;
    if (least > 0.05) {
      ++apart;
      told += c.stay_apart(0.9 * least) ? 1 : 0;
    }
  }
  ASSERT_GT(apart, 500);
  EXPECT_GT(told, 0.9 * apart);
}

/// Whether planes tell so for both halves of the moves.
bool halves_stay_apart(const Moving& c, double by) {
  const auto is_apart = [&](double from, double to) {
    const SweptHull A(c.A, c.X_WA, c.move_A, from, to);
    const SweptHull B(c.B, c.X_WB, c.move_B, from, to);
    const Vector3d n = (B.p_WC - A.p_WC).normalized();
    return stays_apart(A, B, by, n) || stays_apart(B, A, by, -n);
  };
  return is_apart(0.0, 0.5) && is_apart(0.5, 1.0);
}

TEST(SweptHull, OfHalvesNeverTellsMoreEither) {
  std::mt19937 rng(5);
  for (int trial = 0; trial < test::rounds(2000, 400); ++trial) {
    const Moving c(rng);
    const double least = c.least_distance(60);
    ASSERT_FALSE(halves_stay_apart(c, least * (1.0 + 1e-9) + 1e-12)) << trial;
  }
}

TEST(SweptHull, OfHalvesTellsMoreOfWhatTurns) {
  std::mt19937 rng(6);
  int whole = 0;
  int halves = 0;
  for (int trial = 0; trial < test::rounds(2000, 400); ++trial) {
    const Moving c(rng);
    const double least = c.least_distance(20);
    if (least > 0.05) {
      whole += c.stay_apart(0.9 * least) ? 1 : 0;
      halves += halves_stay_apart(c, 0.9 * least) ? 1 : 0;
    }
  }
  EXPECT_GT(halves, whole);
}

TEST(SweptHull, TellsNothingOfNaN) {
  std::mt19937 rng(3);
  Moving c(rng);
  c.X_WB.position += Vector3d(100.0, 0.0, 0.0);
  ASSERT_TRUE(c.stay_apart(1.0));
  c.move_B.rotation_vector.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(c.stay_apart(1.0));
}

}  // namespace
}  // namespace firstcontact::detail
