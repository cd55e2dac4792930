// The boxes and pairs from which the simulator chooses what to search: nothing may be left out.

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/dynamics/detail/sweep_pairs.h>
#include <firstcontact/dynamics/detail/world.h>

namespace firstcontact::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

Vector3d random_vector(std::mt19937& rng, double size) {
  std::normal_distribution<double> normal(0.0, size);
  return {normal(rng), normal(rng), normal(rng)};
}

Eigen::Quaterniond random_rotation(std::mt19937& rng) {
  std::normal_distribution<double> n;
  return Eigen::Quaterniond(n(rng), n(rng), n(rng), n(rng)).normalized();
}

SimBody tetrahedron(std::mt19937& rng) {
  Mesh mesh;
  for (int k = 0; k < 4; ++k) {
    mesh.vertices.push_back(random_vector(rng, 1.0));
  }
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  SimBody body{.shape = Shape(mesh)};
  body.inertia.p_BC = random_vector(rng, 0.5);
  for (const Vector3d& v : mesh.vertices) {
    body.box_B.extend(v);
    body.reach = std::max(body.reach, (v - body.inertia.p_BC).norm());
  }
  return body;
}

TEST(SweptBox, HoldsEveryCornerAtEveryTime) {
  std::mt19937 rng(1);
  for (int i = 0; i < 200; ++i) {
    const SimBody body = tetrahedron(rng);
    const Pose X_WB{random_vector(rng, 3.0), random_rotation(rng)};
    const Move move{random_vector(rng, 1.0), random_vector(rng, 0.1 * (i % 30))};
    const AlignedBox3d box = swept_box(body, X_WB, move);
    const Motion motion = motion_of(body, X_WB, move);
    for (int k = 0; k <= 50; ++k) {
      const Pose at = motion.pose(k / 50.0);
      for (const Vector3d& v : body.shape.mesh().vertices) {
        ASSERT_LE(box.exteriorDistance(at.position + at.rotation * v), 1e-13) << i << " " << k;
      }
    }
  }
}

TEST(SweptBox, IsTheBoxOfWhatRestsOrIsShifted) {
  std::mt19937 rng(2);
  const SimBody body = tetrahedron(rng);
  const Vector3d shift(1.0, -2.0, 0.5);
  const AlignedBox3d box = swept_box(body, {}, {.translation = shift});
  AlignedBox3d exact = body.box_B;
  exact.extend(AlignedBox3d(exact.min() + shift, exact.max() + shift));
  EXPECT_LE((box.min() - exact.min()).norm() + (box.max() - exact.max()).norm(), 1e-9);
}

TEST(OverlappingPairs, AreAllThatOverlap) {
  std::mt19937 rng(3);
  for (int i = 0; i < 50; ++i) {
    std::vector<AlignedBox3d> boxes;
    for (int k = 0; k < 40; ++k) {
      const Vector3d centre = random_vector(rng, 3.0);
      const Vector3d half = random_vector(rng, 1.0).cwiseAbs();
      boxes.emplace_back(centre - half, centre + half);
    }
    std::vector<std::array<std::size_t, 2>> expected;
    for (std::size_t a = 0; a < boxes.size(); ++a) {
      for (std::size_t b = a + 1; b < boxes.size(); ++b) {
        if (boxes[a].intersects(boxes[b])) {
          expected.push_back({a, b});
        }
      }
    }
    ASSERT_EQ(overlapping_pairs(boxes), expected) << i;
  }
}

}  // namespace
}  // namespace firstcontact::detail
