#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/geometry/shape.h>

#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

Mesh random_soup(std::size_t triangles, double offset, std::mt19937& rng) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Mesh mesh;
  for (std::size_t i = 0; i < triangles; ++i) {
    const Vector3d corner(offset + uniform(rng), uniform(rng), 0.1 * uniform(rng));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.push_back(corner + 0.1 * Vector3d(uniform(rng), uniform(rng), uniform(rng)));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

double extent(const HierarchyNode& node, int axis, int slot) {
  return node.half_extent(axis, slot);
}

/// Visits every box with the triangles below it.
class Visitor {
 public:
  explicit Visitor(const Hierarchy& hierarchy) : hierarchy_(hierarchy) {}

  /// Returns the triangles below the node and checks its boxes against them.
  std::vector<std::uint32_t> visit(std::uint32_t index) {
    const HierarchyNode& node = hierarchy_.nodes[index];
    std::vector<std::uint32_t> all;
    for (int slot = 0; slot < HierarchyNode::kWidth; ++slot) {
      if ((node.used() >> slot & 1u) == 0) {
        continue;
      }
      const std::vector<std::uint32_t> below =
          node.is_leaf(slot) ? std::vector<std::uint32_t>{node.child_triangle(slot)}
                             : visit(node.child_node(slot));
      check(node, slot, below);
      all.insert(all.end(), below.begin(), below.end());
    }
    return all;
  }

 private:
  void check(const HierarchyNode& node, int slot, const std::vector<std::uint32_t>& triangles) {
    const Eigen::Matrix3d axes = box_axes(node, slot);
    const Vector3d centre(node.centre[0][slot], node.centre[1][slot], node.centre[2][slot]);
    Vector3d reach = Vector3d::Zero();
    for (const std::uint32_t triangle : triangles) {
      for (const std::uint32_t v : hierarchy_.triangles[triangle]) {
        const Vector3d p = hierarchy_.vertices[v] / hierarchy_.unit - centre;
        reach = reach.cwiseMax((axes * p).cwiseAbs());
      }
    }
    for (int k = 0; k < 3; ++k) {
      // Sound to the rounding of this test; tight to the 8 bits of the stored extent.
      ASSERT_LE(reach[k], extent(node, k, slot) + 0x1p-50);
      ASSERT_GE(reach[k] * (1.0 + 0x1p-6) + 0x1p-40, extent(node, k, slot));
    }
  }

  const Hierarchy& hierarchy_;
};

TEST(Hierarchy, BoxesContainTheirTrianglesTightlyAndEachTriangleIsBelowOneBox) {
  std::mt19937 rng(11);
  for (const std::size_t count : {1u, 2u, 3u, 4u, 5u, 7u, 64u, 1000u, 20000u}) {
    const Hierarchy hierarchy = build_hierarchy(random_soup(count, 0.0, rng));
    std::vector<std::uint32_t> all = Visitor(hierarchy).visit(0);
    std::sort(all.begin(), all.end());
    ASSERT_EQ(all.size(), count);
    for (std::uint32_t i = 0; i < count; ++i) {
      ASSERT_EQ(all[i], i);
    }
  }
}

TEST(Hierarchy, IsTheSameOnEveryRunAndKeepsTheMesh) {
  std::mt19937 rng(12);
  const Mesh mesh = random_soup(test::rounds(30'000, 12'000), 1e6, rng);
  const Hierarchy first = build_hierarchy(mesh);
  const Hierarchy second = build_hierarchy(mesh);
  ASSERT_EQ(first.triangle_index, second.triangle_index);
  ASSERT_EQ(first.nodes.size(), second.nodes.size());
  for (std::size_t i = 0; i < first.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = first.triangles[i][k];
      ASSERT_EQ(first.vertex_index[v], mesh.triangles[first.triangle_index[i]][k]);
    }
  }
}

TEST(Shape, NumbersEachEdgeOnce) {
  const Shape quad(Mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                        .triangles = {{0, 1, 2}, {0, 2, 3}, {1, 1, 2}}});
  ASSERT_EQ(quad.edge_count(), 5u);
  for (std::uint32_t e = 0; e < 5; ++e) {
    const auto [a, b] = quad.edge(e);
    EXPECT_LT(a, b);
    EXPECT_EQ(quad.edge_index(a, b), e);
    EXPECT_EQ(quad.edge_index(b, a), e);
  }
  EXPECT_THROW((void)quad.edge_index(1, 3), std::invalid_argument);
}

TEST(Shape, HasEachCornerAndEdgeAsAnOwnFeatureOfOneTriangle) {
  const Shape cylinder = make_cylinder(1.0, 1.0, 1e-3);
  const auto own = cylinder.own_features();
  ASSERT_EQ(own.size(), cylinder.mesh().triangles.size());
  std::vector<int> corners(cylinder.mesh().vertices.size(), 0);
  std::vector<int> edges(cylinder.edge_count(), 0);
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto& t = cylinder.mesh().triangles[cylinder.hierarchy().triangle_index[k]];
    for (std::size_t i = 0; i < 3; ++i) {
      corners[t[i]] += own[k] >> i & 1;
      edges[cylinder.edge_index(t[i], t[(i + 1) % 3])] += own[k] >> (3 + i) & 1;
    }
  }
  EXPECT_EQ(corners, std::vector<int>(corners.size(), 1));
  EXPECT_EQ(edges, std::vector<int>(edges.size(), 1));
}

TEST(Shape, DegenerateTrianglesOwnAllTheirFeatures) {
  const Shape shape(Mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                         .triangles = {{0, 1, 2}, {0, 0, 1}, {2, 2, 2}}});
  const auto own = shape.own_features();
  ASSERT_EQ(own.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_TRUE(shape.hierarchy().triangle_index[k] == 0 || own[k] == 0x3f) << k;
  }
}

TEST(Shape, RefusesWhatIsNoShape) {
  const std::vector<Vector3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THROW(Shape(Mesh{corners, {}}), std::invalid_argument);
  EXPECT_THROW(Shape(Mesh{corners, {{0, 1, 3}}}), std::invalid_argument);
  EXPECT_THROW(Shape(Mesh{corners, {{0, 1, 2}}}, -1.0), std::invalid_argument);
  EXPECT_THROW(Shape(Mesh{corners, {{0, 1, 2}}}, std::nan("")), std::invalid_argument);
  std::vector<Vector3d> broken = corners;
  broken[1].y() = std::nan("");
  EXPECT_THROW(Shape(Mesh{broken, {{0, 1, 2}}}), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
