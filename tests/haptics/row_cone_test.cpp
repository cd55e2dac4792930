// Whether a row is near a cone of others, by an oracle that finds the distance.

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/haptics/detail/cone_projection.h>
#include <firstcontact/haptics/detail/row_cone.h>

namespace firstcontact::detail {
namespace {

Coordinates random_unit_row(std::mt19937_64& rng, std::size_t n, double forward) {
  std::normal_distribution<double> normal;
  Coordinates row{};
  double square = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    row[k] = normal(rng) + (k == 0 ? forward : 0.0);
    square += row[k] * row[k];
  }
  for (double& part : row) {
    part /= std::sqrt(square);
  }
  return row;
}

/// The distance by the projection of the force loop: what the polar cone leaves of the row.
double distance_to_cone(const std::vector<Coordinates>& rows, const Coordinates& row,
                        std::size_t n) {
  ConeProjection cone(n, rows.size());
  for (const Coordinates& each : rows) {
    cone.add({.rows = {each, {}, {}}});
  }
  Coordinates against{};
  for (std::size_t k = 0; k < n; ++k) {
    against[k] = -row[k];
  }
  const ConeProjectionResult rest = cone.project(against, 1e-13, 1000);
  EXPECT_TRUE(rest.is_solved);
  double square = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    square += rest.x[k] * rest.x[k];
  }
  return std::sqrt(square);
}

TEST(RowCone, FindsTheDistanceOfTheOracle) {
  std::mt19937_64 rng(5);
  for (const std::size_t n : {std::size_t{3}, std::size_t{6}, std::size_t{12}}) {
    for (int k = 0; k < 400; ++k) {
      std::vector<Coordinates> rows;
      RowCone cone(n);
      for (int r = 0; r < 1 + k % 30; ++r) {
        rows.push_back(random_unit_row(rng, n, k % 3));
        cone.add(rows.back());
      }
      const Coordinates row = random_unit_row(rng, n, k % 3);
      const double distance = distance_to_cone(rows, row, n);
      EXPECT_TRUE(cone.is_near(row, distance + 1e-7)) << n << ", " << k;
      if (distance > 1e-6) {
        EXPECT_FALSE(cone.is_near(row, distance - 1e-7)) << n << ", " << k;
      }
    }
  }
}

TEST(RowCone, IsNowhereWithoutRows) {
  RowCone cone(6);
  const Coordinates row{1.0};
  EXPECT_FALSE(cone.is_near(row, 0.99));
  EXPECT_TRUE(cone.is_near(row, 1.0));
}

TEST(RowCone, TakesRowsThatDependOnEachOther) {
  RowCone cone(6);
  for (int k = 0; k < 50; ++k) {
    cone.add({1.0, 1e-9 * k});
  }
  EXPECT_TRUE(cone.is_near({1.0, 0.001}, 0.0011));
  EXPECT_FALSE(cone.is_near({0.0, 1.0}, 0.9));
}

}  // namespace
}  // namespace firstcontact::detail
