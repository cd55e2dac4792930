// The features of small meshes: each once, numbered in the order of the mesh.

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/feature_table.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/geometry/shape.h>

namespace firstcontact {
namespace {

TEST(FeatureTable, HasEachFeatureOfABoxOnce) {
  const Shape box = make_box({1.0, 2.0, 3.0});
  const FeatureTable& table = box.feature_table();
  std::set<std::uint8_t> numbers;
  for (const FeatureTable::Corner& corner : table.corners) {
    EXPECT_LT(corner.number, table.first_edge);
    EXPECT_EQ(table.index[corner.number], box.hierarchy().vertex_index[corner.vertex]);
    numbers.insert(corner.number);
  }
  for (const FeatureTable::Edge& edge : table.edges) {
    EXPECT_EQ(table.index[edge.number],
              box.edge_index(table.index[edge.ends[0]], table.index[edge.ends[1]]));
    EXPECT_EQ(box.hierarchy().triangles[edge.triangle][edge.k], edge.vertices[0]);
    numbers.insert(edge.number);
  }
  for (std::size_t t = 0; t < table.faces.size(); ++t) {
    EXPECT_EQ(table.index[table.faces[t].number], box.hierarchy().triangle_index[t]);
    numbers.insert(table.faces[t].number);
  }
  EXPECT_EQ(table.corners.size(), 8u);
  EXPECT_EQ(table.edges.size(), 18u);
  EXPECT_EQ(table.faces.size(), 12u);
  EXPECT_EQ(numbers.size(), 8u + 18u + 12u);
  EXPECT_EQ(table.index.size(), numbers.size());
}

TEST(FeatureTable, CountsVerticesInTheOrderOfTheMeshWhateverLiesBetween) {
  Mesh mesh;
  mesh.vertices.assign(1000, Eigen::Vector3d::Zero());
  mesh.vertices[999] = Eigen::Vector3d::UnitX();
  mesh.vertices[500] = Eigen::Vector3d::UnitY();
  mesh.triangles = {{999, 500, 3}};
  const Shape shape(mesh);
  const FeatureTable& table = shape.feature_table();
  EXPECT_EQ(table.first_edge, 3u);
  EXPECT_EQ(table.index, (std::vector<std::uint32_t>{3, 500, 999, 0, 1, 2, 0}));
}

// Edges of no length belong to their vertex; as many as there may be have a place.
TEST(FeatureTable, HoldsDegenerateTriangles) {
  Mesh mesh;
  for (std::uint32_t k = 0; k < FeatureTable::kMost; ++k) {
    mesh.vertices.emplace_back(k, 0.0, 0.0);
  }
  for (std::uint32_t k = 0; k < FeatureTable::kMostTriangles; ++k) {
    mesh.triangles.push_back({3 * k, 3 * k + 1, k % 2 == 0 ? 3 * k + 1 : 3 * k + 2});
  }
  const Shape shape(mesh);
  const FeatureTable& table = shape.feature_table();
  EXPECT_EQ(table.edges.size(), FeatureTable::kMost);
  for (const FeatureTable::Edge& edge : table.edges) {
    EXPECT_EQ(edge.ends[0] == edge.ends[1], edge.number == edge.ends[0]);
  }
}

}  // namespace
}  // namespace firstcontact
