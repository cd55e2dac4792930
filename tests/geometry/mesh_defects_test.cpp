#include <firstcontact/geometry/mesh_defects.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/mesh_files/read_mesh.h>

#include "support/data_dir.h"

namespace firstcontact {
namespace {

Mesh tetrahedron() {
  return {.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

TEST(Inspect, FindsNothingWrongWithATetrahedron) {
  const MeshDefects defects = inspect(tetrahedron());
  EXPECT_EQ(defects.edges, 6u);
  EXPECT_EQ(defects.open_edges + defects.nonmanifold_edges + defects.degenerate_triangles +
                defects.doubled_triangles + defects.nonfinite_vertices + defects.unused_vertices,
            0u);
  EXPECT_EQ(defects.components, 1u);
  EXPECT_TRUE(defects.closed);
  EXPECT_TRUE(defects.consistently_oriented);
  ASSERT_TRUE(defects.signed_volume.has_value());
  EXPECT_NEAR(*defects.signed_volume, 1.0 / 6.0, 1e-15);
  EXPECT_EQ(defects.bounds.max(), Eigen::Vector3d(1, 1, 1));
}

TEST(Inspect, FindsAnOpenEdge) {
  Mesh mesh = tetrahedron();
  mesh.triangles.pop_back();
  const MeshDefects defects = inspect(mesh);
  EXPECT_EQ(defects.open_edges, 3u);
  EXPECT_FALSE(defects.closed);
  EXPECT_FALSE(defects.signed_volume.has_value());
}

TEST(Inspect, FindsAFlippedTriangle) {
  Mesh mesh = tetrahedron();
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  const MeshDefects defects = inspect(mesh);
  EXPECT_TRUE(defects.closed);
  EXPECT_FALSE(defects.consistently_oriented);
}

TEST(Inspect, FindsDoubledTrianglesAndTheirEdges) {
  Mesh mesh = tetrahedron();
  mesh.triangles.push_back({2, 0, 1});
  const MeshDefects defects = inspect(mesh);
  EXPECT_EQ(defects.doubled_triangles, 1u);
  EXPECT_EQ(defects.nonmanifold_edges, 3u);
}

TEST(Inspect, FindsDegenerateTriangles) {
  const Mesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1e-12, 0}, {1, 1e-10, 0}},
                  .triangles = {{0, 0, 1}, {0, 1, 2}, {0, 2, 3}, {0, 2, 4}}};
  EXPECT_EQ(inspect(mesh).degenerate_triangles, 3u);  // The last is thin, but a triangle.
}

TEST(Inspect, CountsVerticesAndComponents) {
  Mesh mesh = tetrahedron();
  mesh.vertices.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  mesh.vertices.emplace_back(5, 5, 5);
  mesh.triangles.push_back({5, 5, 5});
  const MeshDefects defects = inspect(mesh);
  EXPECT_EQ(defects.nonfinite_vertices, 1u);
  EXPECT_EQ(defects.unused_vertices, 1u);
  EXPECT_EQ(defects.components, 2u);
}

TEST(Inspect, RefusesAnIndexOutOfRange) {
  Mesh mesh = tetrahedron();
  mesh.triangles[2][1] = 4;
  EXPECT_THROW((void)inspect(mesh), std::invalid_argument);
}

TEST(Inspect, KnowsThePartsOfTheDemo) {
  const std::filesystem::path data = std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / "data";
  const Mesh bunny = read_mesh(data / "stanford/stanford-bunny.obj");
  EXPECT_EQ(bunny.triangles.size(), 69451u);
  EXPECT_EQ(inspect(bunny).open_edges, 223u);
  const MeshDefects nut = inspect(read_mesh(data / "factory/factory_nut_m16_loose_subdiv_3x.obj"));
  EXPECT_EQ(nut.open_edges, 108u);
  EXPECT_EQ(nut.degenerate_triangles, 32u);
  const MeshDefects bolt = inspect(read_mesh(data / "factory/factory_bolt_m16_loose.obj"));
  EXPECT_TRUE(bolt.closed);
  ASSERT_TRUE(bolt.signed_volume.has_value());
  EXPECT_NEAR(*bolt.signed_volume, 1.136e-5, 1e-8);
}

std::vector<std::string> columns(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream stream(line);
  for (std::string column; std::getline(stream, column, ',');) {
    result.push_back(column);
  }
  return result;
}

TEST(Inspect, AgreesWithIndependentCountsOnRealMeshes) {
  const std::filesystem::path data = test::data_dir();
  std::ifstream table(data / "mesh_stats.csv");
  if (data.empty() || !table) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  std::string line;
  std::getline(table, line);
  int meshes = 0;
  while (std::getline(table, line)) {
    const std::vector<std::string> row = columns(line);
    if (row.size() < 14 || row[1] == "0" || !std::filesystem::exists(data / row[0])) {
      continue;
    }
    SCOPED_TRACE(row[0]);
    const auto [mesh, report] = read_mesh_file(data / row[0]);
    const bool has_concave =
        std::any_of(report.contents.begin(), report.contents.end(),
                    [](const FileContent& content) { return content.what == "concave polygons"; });
    const MeshDefects defects = inspect(mesh);
    EXPECT_EQ(mesh.triangles.size(), std::stoul(row[1]));
    EXPECT_EQ(mesh.vertices.size() - defects.unused_vertices, std::stoul(row[2]));
    EXPECT_EQ(defects.components, std::stoul(row[4]));
    EXPECT_EQ(defects.closed, row[5] == "yes");
    EXPECT_EQ(defects.consistently_oriented, row[6] == "yes");
    EXPECT_EQ(defects.open_edges, std::stoul(row[7]));
    EXPECT_EQ(defects.nonmanifold_edges, std::stoul(row[8]));
    if (!has_concave) {  // The table counts fans, which cover what is outside of such polygons.
      EXPECT_EQ(defects.degenerate_triangles, std::stoul(row[9]));
    }
    EXPECT_EQ(defects.doubled_triangles, std::stoul(row[10]));
    if (defects.signed_volume) {
      EXPECT_NEAR(*defects.signed_volume, std::stod(row[12]), 1e-3 * std::abs(std::stod(row[12])));
    }
    ++meshes;
  }
  EXPECT_GT(meshes, 100);
}

}  // namespace
}  // namespace firstcontact
