#include <firstcontact/geometry/detail/spatial_hash.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr double kReach = 0.2;  // [m]

/// Places in a cube of 2 m.
std::vector<Vector3d> some_places(std::mt19937& rng, std::size_t count, double far) {
  std::uniform_real_distribution<double> uniform(far - 1.0, far + 1.0);
  std::vector<Vector3d> places;
  for (std::size_t k = 0; k < count; ++k) {
    places.emplace_back(uniform(rng), uniform(rng), uniform(rng));
  }
  return places;
}

TEST(SpatialHash, FindsAllThatAreNear) {
  std::mt19937 rng(1);
  for (const double far : {0.0, 1e6}) {
    for (const std::size_t count : {10U, 300U}) {
      const std::vector<Vector3d> places = some_places(rng, count, far);
      SpatialHash grid(kReach);
      for (std::size_t k = 0; k < count; ++k) {
        grid.add(places[k], k);
      }
      for (const Vector3d& place : places) {
        std::vector<bool> found(count, false);
        grid.for_each_near(place, [&](std::size_t k) { found[k] = true; });
        for (std::size_t k = 0; k < count; ++k) {
          ASSERT_TRUE(found[k] || (places[k] - place).norm() > kReach);
        }
      }
    }
  }
}

TEST(SpatialHash, LeavesOutWhatIsFarOfMany) {
  std::mt19937 rng(2);
  const std::vector<Vector3d> places = some_places(rng, 1000, 3.0);
  SpatialHash grid(kReach);
  for (std::size_t k = 0; k < places.size(); ++k) {
    grid.add(places[k], k);
  }
  for (const Vector3d& place : places) {
    grid.for_each_near(place, [&](std::size_t k) {
      ASSERT_LE((places[k] - place).norm(), 2.0 * std::sqrt(3.0) * 1.001 * kReach);
    });
  }
}

}  // namespace
}  // namespace firstcontact::detail
