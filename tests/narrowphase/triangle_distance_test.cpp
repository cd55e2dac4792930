// Distance and closest features of two triangles, for every instruction set that this processor
// has, against brute force in exact rational numbers.

#include <firstcontact/narrowphase/triangle_distance.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/closest_points.h"
#include "support/instruction_sets.h"
#include "support/rational.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using oracle::Rational;
using Type = TriangleFeature::Type;

oracle::Vector3<Rational> exact(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

oracle::Triangle<Rational> exact(const Triangle& T) {
  return {exact(T[0]), exact(T[1]), exact(T[2])};
}

oracle::ClosestPoints<Rational> exact_closest(const Triangle& A, const Triangle& B) {
  return oracle::closest_points<Rational>(exact(A), exact(B));
}

double exact_distance(const Triangle& A, const Triangle& B) {
  return std::sqrt(exact_closest(A, B).distance2.nearest());
}

Triangle point(const Vector3d& p) { return {p, p, p}; }

double size(const Triangle& A, const Triangle& B) {
  double largest = 0.0;
  for (const Triangle* T : {&A, &B}) {
    for (const Vector3d& corner : *T) {
      largest = std::max(largest, corner.norm());
    }
  }
  return largest;
}

/// The feature in whose interior a point of such weights lies.
TriangleFeature feature(const std::array<Rational, 3>& weights) {
  std::vector<int> positive;
  for (int k = 0; k < 3; ++k) {
    if (weights[static_cast<std::size_t>(k)] > Rational()) {
      positive.push_back(k);
    }
  }
  if (positive.size() == 3) {
    return {Type::face, 0};
  }
  if (positive.size() == 1) {
    return {Type::vertex, positive[0]};
  }
  return {Type::edge, positive[1] == positive[0] + 1 ? positive[0] : 2};
}

class Random {
 public:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double whole() { return static_cast<double>(std::uniform_int_distribution<int>(-2, 2)(random_)); }
  Vector3d vector() { return {uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0)}; }
  Triangle triangle() { return {vector(), vector(), vector()}; }
  Triangle grid_triangle() {
    const auto corner = [this] { return Vector3d(whole(), whole(), whole()); };
    return {corner(), corner(), corner()};
  }

 private:
  std::mt19937_64 random_{1};
};

using Pair = std::pair<Triangle, Triangle>;

struct Kind {
  const char* name;
  std::function<Pair(Random&)> draw;
  double tolerance;  ///< [-]  Tolerance of the distance, relative to the size.
};

Triangle moved(Triangle T, const Vector3d& by) {
  for (Vector3d& corner : T) {
    corner += by;
  }
  return T;
}

Triangle needle(Random& random) {
  const double thin = std::pow(10.0, random.uniform(-16.0, -3.0));
  const Vector3d a = random.vector();
  const Vector3d b = random.vector();
  return {a, b, a + random.uniform(-0.5, 1.5) * (b - a) + thin * random.vector()};
}

Triangle flat(Triangle T, double height) {
  for (Vector3d& corner : T) {
    corner.z() = height;
  }
  return T;
}

std::vector<Kind> kinds() {
  return {
      {"apart", [](Random& r) { return Pair(r.triangle(), moved(r.triangle(), 2.0 * r.vector())); },
       2e-15},
      {"near",
       [](Random& r) {
         const Triangle A = r.triangle();
         const Triangle B = r.triangle();
         return Pair(A, moved(B, A[0] - B[0] + 1e-6 * r.vector()));
       },
       2e-15},
      {"on a grid", [](Random& r) { return Pair(r.grid_triangle(), r.grid_triangle()); }, 2e-15},
      {"parallel",
       [](Random& r) {
         return Pair(flat(r.triangle(), 0.0), flat(r.triangle(), r.uniform(0.0, 1.0)));
       },
       2e-15},
      {"coplanar",
       [](Random& r) {
         return Pair(flat(r.triangle(), 0.25), flat(moved(r.triangle(), 2.0 * r.vector()), 0.25));
       },
       2e-15},
      {"the same, moved",
       [](Random& r) {
         const Triangle T = r.triangle();
         return Pair(T, moved(T, r.uniform(0.0, 1e-3) * r.vector()));
       },
       2e-15},
      {"needles", [](Random& r) { return Pair(needle(r), moved(needle(r), r.vector())); }, 1e-12},
      {"a needle and a triangle",
       [](Random& r) { return Pair(needle(r), moved(r.triangle(), r.vector())); }, 1e-12},
      {"points and edges",
       [](Random& r) {
         const Vector3d p = r.vector();
         return Pair(point(r.vector()), Triangle{p, r.vector(), p});
       },
       2e-15},
      {"far from the origin",
       [](Random& r) {
         const Vector3d far = 1e6 * r.vector();
         return Pair(moved(r.triangle(), far), moved(r.triangle(), far + r.vector()));
       },
       2e-15},
      {"tiny",
       [](Random& r) {
         Pair pair(r.triangle(), moved(r.triangle(), r.vector()));
         for (Triangle* T : {&pair.first, &pair.second}) {
           for (Vector3d& corner : *T) {
             corner *= 1e-9;
           }
         }
         return pair;
       },
       2e-15},
  };
}

template <class Judge>
void for_each_pair(int count, const Judge& judge) {
  for (const Kind& kind : kinds()) {
    Random random;
    for (int i = 0; i < count; ++i) {
      SCOPED_TRACE(std::string(kind.name) + " " + std::to_string(i));
      const auto [A, B] = kind.draw(random);
      judge(kind, A, B);
    }
  }
}

constexpr int kPairs = test::rounds(300, 60);

using TriangleDistanceOn = test::OnInstructionSet;
using FeaturePairsWithinOn = test::OnInstructionSet;

TEST_P(TriangleDistanceOn, IsExactUpToRounding) {
  for_each_pair(kPairs, [](const Kind& kind, const Triangle& A, const Triangle& B) {
    const double truth = exact_distance(A, B);
    const double error = std::abs(triangle_distance(A, B).distance - truth);
    EXPECT_LE(error, kind.tolerance * size(A, B)) << truth;
  });
}

TEST_P(TriangleDistanceOn, IsThatOfItsPointsWhichLieOnTheTriangles) {
  for_each_pair(kPairs / 2, [](const Kind&, const Triangle& A, const Triangle& B) {
    const ClosestFeatures c = triangle_distance(A, B);
    const double rounding = 1e-15 * size(A, B);
    EXPECT_NEAR(c.distance, (c.p_B - c.p_A).norm(), 4.0 * rounding);
    EXPECT_LE(exact_distance(A, point(c.p_A)), 4.0 * rounding);
    EXPECT_LE(exact_distance(B, point(c.p_B)), 4.0 * rounding);
  });
}

/// Where the closest points are unique: none of the tie-ridden kinds.
TEST_P(TriangleDistanceOn, NamesTheFeaturesThatHoldTheClosestPoints) {
  Random random;
  std::array<int, 6> met{};  // Number of cases of each pair of types.
  for (int i = 0; i < 8 * kPairs; ++i) {
    SCOPED_TRACE(i);
    const Triangle A = random.triangle();
    const Triangle B = moved(random.triangle(), random.uniform(0.5, 2.0) * random.vector());
    const oracle::ClosestPoints<Rational> truth = exact_closest(A, B);
    if (!(truth.distance2 > Rational())) {
      EXPECT_EQ(triangle_distance(A, B).distance, 0.0);
      continue;
    }
    const ClosestFeatures c = triangle_distance(A, B);
    EXPECT_EQ(c.feature_A, feature(truth.weights_A));
    EXPECT_EQ(c.feature_B, feature(truth.weights_B));
    const int least = static_cast<int>(std::min(c.feature_A.type, c.feature_B.type));
    const int most = static_cast<int>(std::max(c.feature_A.type, c.feature_B.type));
    met[static_cast<std::size_t>(least * 3 + most - least * (least + 1) / 2)] += 1;
  }
  // Vertex and vertex, edge, face; edge and edge. A face meets nothing else without piercing.
  for (const std::size_t pair : {0u, 1u, 2u, 3u}) {
    EXPECT_GE(met[pair], kPairs / 6) << pair;
  }
}

TEST_P(TriangleDistanceOn, IsZeroWhereTheTrianglesPierce) {
  Random random;
  int pierced = 0;
  for (int i = 0; i < 4 * kPairs; ++i) {
    SCOPED_TRACE(i);
    const Triangle A = random.triangle();
    const Triangle B = random.triangle();
    if (!(exact_closest(A, B).distance2 > Rational())) {
      ++pierced;
      EXPECT_EQ(triangle_distance(A, B).distance, 0.0);
    } else {
      EXPECT_GT(triangle_distance(A, B).distance, 0.0);
    }
  }
  EXPECT_GE(pierced, kPairs / 2);
}

TEST_P(TriangleDistanceOn, IsTheSameForSwappedTriangles) {
  for_each_pair(kPairs, [](const Kind&, const Triangle& A, const Triangle& B) {
    const double rounding = 1e-15 * size(A, B);
    EXPECT_NEAR(triangle_distance(A, B).distance, triangle_distance(B, A).distance,
                100.0 * rounding);
  });
}

TEST_P(FeaturePairsWithinOn, HoldsTheClosestAndNothingBeyondTheBand) {
  for_each_pair(kPairs / 2, [](const Kind& kind, const Triangle& A, const Triangle& B) {
    const double truth = exact_distance(A, B);
    const double band = 1.5 * truth + 1e-12 * size(A, B);
    const FeaturePairs found = feature_pairs_within(A, B, band);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < found.count; ++k) {
      EXPECT_LE(found.pairs[k].distance, band);
      least = std::min(least, found.pairs[k].distance);
    }
    EXPECT_NEAR(least, truth, kind.tolerance * size(A, B));
  });
}

// Asked one feature of each triangle at a time, they say together what they say at once.
TEST_P(FeaturePairsWithinOn, AskedFeatureByFeatureHoldsTheSame) {
  for_each_pair(200, [](const Kind&, const Triangle& A, const Triangle& B) {
    const double band = 2.0 * triangle_distance(A, B).distance + 1e-3 * size(A, B);
    const FeaturePairs all = feature_pairs_within(A, B, band);
    const auto least = [](const FeaturePairs& pairs, const ClosestFeatures& of) {
      double distance = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < pairs.count; ++k) {
        if (pairs.pairs[k].feature_A == of.feature_A && pairs.pairs[k].feature_B == of.feature_B) {
          distance = std::min(distance, pairs.pairs[k].distance);
        }
      }
      return distance;
    };
    std::vector<double> found(all.count, std::numeric_limits<double>::infinity());
    for (unsigned i = 0; i < 6; ++i) {
      for (unsigned j = 0; j < 6; ++j) {
        const FeaturePairs part = feature_pairs_within(A, B, band, 1u << i, 1u << j);
        for (std::size_t k = 0; k < part.count; ++k) {
          EXPECT_LE(least(all, part.pairs[k]), part.pairs[k].distance);
        }
        for (std::size_t k = 0; k < all.count; ++k) {
          found[k] = std::min(found[k], least(part, all.pairs[k]));
        }
      }
    }
    for (std::size_t k = 0; k < all.count; ++k) {
      EXPECT_EQ(found[k], all.pairs[k].distance);
    }
  });
  const Triangle A{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const Triangle B{Vector3d(0, 0, 1), Vector3d(1, 0, 1), Vector3d(0, 1, 1)};
  EXPECT_EQ(feature_pairs_within(A, B, 2.0, 0, 0).count, 0u);
}

/// The three corners on one line, whichever of them is repeated or between the others.
std::vector<Triangle> needles(const Vector3d& a, const Vector3d& b) {
  const Vector3d between = 0.75 * a + 0.25 * b;
  return {{a, a, b}, {a, b, b}, {a, b, a}, {between, a, b}, {a, between, b}, {a, b, between}};
}

// Of two long edges side by side both ends are near, whichever end a tilt brings nearest.
TEST_P(FeaturePairsWithinOn, HoldsBothEndsOfNeedles) {
  const Vector3d x = Vector3d::UnitX();
  const Triangle face{Vector3d(-3, 1, 0), Vector3d(3, 1, 0), Vector3d(0, 4, 0)};
  std::vector<Triangle> others = needles(-3.0 * x, 3.0 * x);
  others.push_back(moved(face, Vector3d(0, -1, 0)));  // Beside its first edge.
  for (const double tilt : {-1e-6, -1e-15, 0.0, 1e-15, 1e-6}) {
    const std::array ends{Vector3d(-1, 0, 1.0 - tilt), Vector3d(1, 0, 1.0 + tilt)};
    for (const Triangle& S : needles(ends[0], ends[1])) {
      for (const Triangle& T : others) {
        const FeaturePairs of_A = feature_pairs_within(S, T, 1.01);
        const FeaturePairs of_B = feature_pairs_within(T, S, 1.01);
        for (const Vector3d& end : ends) {
          const auto is_end_of = [&](const Vector3d& p, const TriangleFeature& feature) {
            return p == end && feature.type == Type::vertex;
          };
          EXPECT_TRUE(std::any_of(of_A.pairs.begin(), of_A.pairs.begin() + of_A.count,
                                  [&](const auto& c) { return is_end_of(c.p_A, c.feature_A); }))
              << tilt << " " << end.x();
          EXPECT_TRUE(std::any_of(of_B.pairs.begin(), of_B.pairs.begin() + of_B.count,
                                  [&](const auto& c) { return is_end_of(c.p_B, c.feature_B); }))
              << tilt << " " << end.x();
        }
      }
    }
  }
}

// Two triangles with a common corner: nine pairs of edges and corners meet there, at distance 0.
TEST_P(FeaturePairsWithinOn, HoldsEachPairOfFeaturesOnce) {
  const Triangle A{Vector3d(0.0, 0.0, 0.0), Vector3d(1.0, 0.0, 0.0), Vector3d(0.0, 1.0, 0.0)};
  const Triangle B{Vector3d(0.0, 0.0, 0.0), Vector3d(-1.0, 0.0, 1.0), Vector3d(0.0, -1.0, 1.0)};
  const FeaturePairs found = feature_pairs_within(A, B, 10.0);
  std::size_t meeting = 0;
  for (std::size_t k = 0; k < found.count; ++k) {
    meeting += found.pairs[k].distance == 0.0 ? 1 : 0;
    for (std::size_t j = 0; j < k; ++j) {
      EXPECT_FALSE(found.pairs[j].feature_A == found.pairs[k].feature_A &&
                   found.pairs[j].feature_B == found.pairs[k].feature_B)
          << j << " " << k;
    }
  }
  EXPECT_EQ(meeting, 1u);
  EXPECT_GE(found.count, 4u);
}

// A corner lies on a face to the last bit, and none of its edges pierces the face: the corner
// touches.
TEST_P(TriangleDistanceOn, NamesTheCornerThatTouchesAFace) {
  const Triangle face{Vector3d(-1, -1, 0), Vector3d(2, -1, 0), Vector3d(-1, 2, 0)};
  const Triangle upright{Vector3d(0.125, 0.125, 0), Vector3d(1, 0, 1), Vector3d(0, 1, 1)};
  for (int k = 0; k < 3; ++k) {
    for (const double side : {1.0, -1.0}) {
      Triangle T;
      for (int i = 0; i < 3; ++i) {
        T[(i + k) % 3] = upright[i].cwiseProduct(Vector3d(1, 1, side));
      }
      const ClosestFeatures c = triangle_distance(T, face);
      EXPECT_EQ(c.distance, 0.0);
      EXPECT_EQ(c.feature_A, (TriangleFeature{Type::vertex, k}));
      EXPECT_EQ(c.feature_B.type, Type::face);
      EXPECT_EQ(triangle_distance(face, T).feature_B, (TriangleFeature{Type::vertex, k}));
    }
  }
}

// Beside a triangle a thousand times their size, rounding moves the points of thin needles along
// them.
TEST_P(TriangleDistanceOn, ClaimsNoPiercingOfNeedlesThatAreApart) {
  Random random;
  int claimed = 0;
  for (int i = 0; i < test::rounds(200'000, 20'000); ++i) {
    const double thin = std::pow(10.0, random.uniform(-12.0, -9.0));
    const Vector3d a = random.vector();
    const Vector3d b = random.vector();
    const Triangle T{a, b, a + random.uniform(-0.5, 1.0) * (b - a) + thin * random.vector()};
    const Vector3d beyond = b + std::pow(10.0, random.uniform(-12.0, -3.0)) * (b - a);
    const Vector3d across = 1000.0 * random.vector();
    const Triangle S{beyond - across, beyond + across, beyond + across + random.vector()};
    if (triangle_distance(S, T).distance == 0.0) {
      ++claimed;
      EXPECT_LE(exact_distance(S, T), 4e-12 * size(S, T)) << i;
    }
  }
  EXPECT_GT(claimed, 0);
}

TEST_P(FeaturePairsWithinOn, HoldsOnlyPointsOnTheTrianglesWhateverTheBand) {
  for (const double band : {1e200, std::numeric_limits<double>::infinity()}) {
    for_each_pair(test::rounds(20, 4), [&](const Kind&, const Triangle& A, const Triangle& B) {
      const FeaturePairs all = feature_pairs_within(A, B, band);
      EXPECT_GE(all.count, 1u);
      for (std::size_t k = 0; k < all.count; ++k) {
        EXPECT_LE(exact_distance(A, point(all.pairs[k].p_A)), 4e-15 * size(A, B));
        EXPECT_LE(exact_distance(B, point(all.pairs[k].p_B)), 4e-15 * size(A, B));
      }
    });
  }
}

INSTANTIATE_TEST_SUITE_P(, TriangleDistanceOn, testing::ValuesIn(test::instruction_sets()),
                         test::instruction_set_name);
INSTANTIATE_TEST_SUITE_P(, FeaturePairsWithinOn, testing::ValuesIn(test::instruction_sets()),
                         test::instruction_set_name);

}  // namespace
}  // namespace firstcontact
