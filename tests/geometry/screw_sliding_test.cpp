// The screws along which surfaces screw_sliding, and bounds of surfaces in their coordinates.

#include <firstcontact/geometry/screw_sliding.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/geometry/screw_sliding_bounds.h>
#include <firstcontact/geometry/screw_sliding_order.h>

#include "support/rounds.h"
#include "support/thread_mesh.h"

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Shape moved(const Shape& shape, const Matrix3d& R, const Vector3d& p) {
  Mesh mesh = shape.mesh();
  for (Vector3d& v : mesh.vertices) {
    v = R * v + p;
  }
  return Shape(std::move(mesh));
}

TEST(ScrewSliding, IsTheScrewOfAThreadWhereverItIs) {
  const Matrix3d R = Eigen::AngleAxisd(1.1, Vector3d(1.0, 2.0, -0.5).normalized()).matrix();
  const Vector3d p(3.0, -1.0, 0.5);
  const Shape thread = moved(test::make_thread({.segments = 48, .turns = 6}), R, p);
  const auto screw_sliding = find_screw_sliding(thread.hierarchy());
  ASSERT_TRUE(screw_sliding);
  const Vector3d axis = screw_sliding->R_SB.row(2).transpose();
  EXPECT_NEAR(std::abs(axis.dot(R.col(2))), 1.0, 1e-4);
  EXPECT_NEAR(screw_sliding->pitch, 0.5 / (2.0 * std::numbers::pi), 1e-3);
  // The axis passes the thread's.
  const Vector3d apart = thread.hierarchy().centre + screw_sliding->p_BS - p;
  EXPECT_LT(apart.cross(R.col(2)).norm(), 1e-2);
}

TEST(ScrewSliding, IsNoneWhereNothingOrEverythingScrewSlidings) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Mesh soup;
  for (std::uint32_t k = 0; k < 900; ++k) {
    soup.vertices.emplace_back(uniform(rng), uniform(rng), uniform(rng));
    soup.triangles.push_back({k, (k + 1) % 900, (k + 2) % 900});
  }
  EXPECT_FALSE(find_screw_sliding(Shape(soup).hierarchy()));
  Mesh flat;
  for (std::uint32_t i = 0; i <= 20; ++i) {
    for (std::uint32_t j = 0; j <= 20; ++j) {
      flat.vertices.emplace_back(i, j, 0.0);
      if (i < 20 && j < 20) {
        flat.triangles.push_back({21 * i + j, 21 * i + j + 21, 21 * i + j + 1});
        flat.triangles.push_back({21 * i + j + 21, 21 * i + j + 22, 21 * i + j + 1});
      }
    }
  }
  EXPECT_FALSE(find_screw_sliding(Shape(flat).hierarchy()));
}

TEST(ScrewSliding, OrdersEachTriangleOnce) {
  const Shape thread = test::make_thread({});
  const auto screw_sliding = find_screw_sliding(thread.hierarchy());
  ASSERT_TRUE(screw_sliding);
  std::vector<int> seen(thread.hierarchy().triangles.size(), 0);
  for (const std::uint32_t k : order_along(*screw_sliding, thread.hierarchy())) {
    if (k != kNoTriangle) {
      ++seen[k];
    }
  }
  for (const int count : seen) {
    EXPECT_EQ(count, 1);
  }
}

/// A thread and a disc whose triangles meet on the axis or lie beside and around it.
Shape thread_and_disc() {
  Mesh mesh = test::make_thread({.shift = 0.3}).mesh();
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(
      mesh.vertices.end(),
      {{0.0, 0.0, -0.1}, {1.0, 0.2, -0.1}, {-0.9, 0.8, -0.2}, {0.1, -1.2, 0.0}, {1.5, 1.0, 0.1}});
  for (std::uint32_t k = 1; k < 5; ++k) {
    mesh.triangles.push_back({first, first + k, first + 1 + k % 4});
    mesh.triangles.push_back({first + 1, first + 2 + k % 3, first + 4});
  }
  mesh.triangles.push_back({first + 1, first + 2, first + 3});
  return Shape(std::move(mesh));
}

struct Sample {
  long double radius;
  long double angle;
  long double height;
};

/// A random point of a triangle between two poses, seen from the screw; by other arithmetic.
Sample sample(const Hierarchy& hierarchy, std::uint32_t triangle, const ScrewSlidingPath& path,
              std::mt19937& rng) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double a = std::sqrt(uniform(rng));
  const double b = uniform(rng);
  const std::array<double, 3> weight{1.0 - a, a * (1.0 - b), a * b};
  const double late = uniform(rng);
  std::array<long double, 3> p{};
  for (int k = 0; k < 3; ++k) {
    const Vector3d& v = hierarchy.vertices[hierarchy.triangles[triangle][k]];
    for (std::size_t pose = 0; pose < 2; ++pose) {
      const double part = weight[k] * (pose == 0 ? 1.0 - late : late);
      for (int i = 0; i < 3; ++i) {
        long double sum = path.p_SB[pose][i];
        for (int j = 0; j < 3; ++j) {
          sum += static_cast<long double>(path.R_SB[pose](i, j)) * v[j];
        }
        p[i] += part * sum;
      }
    }
  }
  return {std::sqrt(p[0] * p[0] + p[1] * p[1]), std::atan2(p[1], p[0]), p[2]};
}

/// Whether a part of a node that is not mirrored holds the point, with its angle so many turns on.
bool holds(const ScrewSliding& screw_sliding, const float* most, const Sample& point, int turns) {
  constexpr std::size_t kAngle = ScrewSliding::kDirections;
  constexpr std::size_t kHalf = kAngle + 1;
  const long double angle = point.angle + 2.0L * std::numbers::pi_v<long double> * turns;
  bool inside = -most[kAngle] <= angle && angle <= most[kHalf + kAngle];
  for (std::size_t k = 0; k < kAngle; ++k) {
    const long double pitch = k == ScrewSliding::kHeight ? 0.0L : screw_sliding.pitch;
    const Eigen::Vector2d& n = screw_sliding.directions[k];
    const long double f = n.x() * point.radius + n.y() * (point.height - pitch * angle);
    inside = inside && -most[k] <= f && f <= most[kHalf + k];
  }
  return inside;
}

TEST(ScrewSlidingBounds, HoldAllPointsOfTrianglesBetweenTwoPoses) {
  const Shape shape = thread_and_disc();
  const Hierarchy& hierarchy = shape.hierarchy();
  const auto screw_sliding = find_screw_sliding(hierarchy);
  ASSERT_TRUE(screw_sliding);
  const std::vector<std::uint32_t> order = order_along(*screw_sliding, hierarchy);
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Vector3d(uniform(rng), uniform(rng), uniform(rng)); };
  ScrewSlidingBounds bounds;
  for (int round = 0; round < test::rounds(20, 5); ++round) {
    ScrewSlidingPath path;
    const Vector3d p_SB = -(screw_sliding->R_SB * screw_sliding->p_BS);
    for (std::size_t pose = 0; pose < 2; ++pose) {
      const Vector3d turn = 0.02 * vector();
      path.R_SB[pose] = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() *
                        Eigen::AngleAxisd(round, Vector3d::UnitZ()).toRotationMatrix() *
                        screw_sliding->R_SB;
      path.p_SB[pose] = p_SB + 0.02 * vector();
    }
    bound_screw_sliding(*screw_sliding, hierarchy, order, path, false, bounds);
    for (std::size_t k = 0; k < order.size(); ++k) {
      for (int point = 0; order[k] != kNoTriangle && point < 20; ++point) {
        const Sample at = sample(hierarchy, order[k], path, rng);
        for (std::size_t level = 0, n = k; level < 3; ++level, n /= 4) {
          const float* most = bounds.levels[level][n / 4].most[n % 4];
          ASSERT_TRUE(holds(*screw_sliding, most, at, 0) || holds(*screw_sliding, most, at, 1) ||
                      holds(*screw_sliding, most, at, -1))
              << round << ' ' << k << ' ' << level;
        }
      }
    }
  }
}

TEST(ScrewSlidingBounds, AreHardlyWiderThanFacetsAreBent) {
  const Shape shape = test::make_thread({.segments = 48, .turns = 4});
  const auto screw_sliding = find_screw_sliding(shape.hierarchy());
  ASSERT_TRUE(screw_sliding);
  const std::vector<std::uint32_t> order = order_along(*screw_sliding, shape.hierarchy());
  const Vector3d p_SB = -(screw_sliding->R_SB * screw_sliding->p_BS);
  ScrewSlidingBounds bounds;
  bound_screw_sliding(*screw_sliding, shape.hierarchy(), order,
                      {{screw_sliding->R_SB, screw_sliding->R_SB}, {p_SB, p_SB}}, false, bounds);
  const double sagitta = 1.2 * (1.0 - std::cos(std::numbers::pi / 48.0));
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (order[k] == kNoTriangle) {
      continue;
    }
    // Some direction is across each triangle.
    const float* most = bounds.levels[0][k / 4].most[k % 4];
    double thinnest = 1.0;
    for (std::size_t d = 0; d < ScrewSliding::kDirections; ++d) {
      thinnest = std::min(thinnest,
                          static_cast<double>(most[d]) + most[ScrewSliding::kDirections + 1 + d]);
    }
    EXPECT_LT(thinnest, 3.0 * sagitta) << k;
  }
}

}  // namespace
}  // namespace firstcontact
