#include <firstcontact/polygons/detail/mesh_builder.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/text/reading_log.h>

namespace firstcontact::detail {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Rings = std::vector<std::vector<std::uint32_t>>;

void add_polygon(MeshBuilder& mesh, std::size_t place, const Rings& rings) {
  mesh.begin_polygon(place);
  for (std::size_t ring = 0; ring < rings.size(); ++ring) {
    if (ring > 0) {
      mesh.begin_hole();
    }
    for (const std::uint32_t corner : rings[ring]) {
      ASSERT_TRUE(mesh.add_corner(corner));
    }
  }
  mesh.end_polygon();
}

/// A grid of 9 x 9 points in the plane; point (x, y) has number 9 y + x.
void add_grid(MeshBuilder& mesh) {
  for (int i = 0; i < 81; ++i) {
    ASSERT_TRUE(mesh.add_vertex(Eigen::Vector3d(i % 9, i / 9, 0.0)));
  }
}

constexpr std::uint32_t at(std::uint32_t x, std::uint32_t y) { return 9 * y + x; }

double signed_area(const Mesh& mesh, std::size_t begin, std::size_t end) {
  double area = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const Triangle& t = mesh.triangles[i];
    const Eigen::Vector3d u = mesh.vertices[t[1]] - mesh.vertices[t[0]];
    const Eigen::Vector3d v = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    area += 0.5 * (u.x() * v.y() - u.y() * v.x());
  }
  return area;
}

const Rings kTriangle = {{at(0, 0), at(1, 0), at(0, 1)}};
const Rings kSquare = {{at(0, 0), at(2, 0), at(2, 2), at(0, 2)}};
const Rings kDart = {{at(8, 0), at(1, 1), at(0, 8), at(0, 0)}};
/// With a hole of either orientation, which ends before the outer ring does.
const Rings kFrame = {{at(0, 0), at(4, 0), at(4, 4), at(0, 4)}, {at(1, 1), at(2, 1), at(1, 2)}};
const Rings kFrameOfTwo = {{at(0, 0), at(8, 0), at(8, 4), at(0, 4)},
                           {at(1, 1), at(1, 2), at(2, 1)},
                           {at(5, 1), at(6, 1), at(6, 2), at(5, 2)}};
/// A bridge leads to the hole: two corners twice, and so two triangles less.
const Rings kKeyhole = {{at(0, 0), at(4, 0), at(4, 4), at(0, 4), at(0, 0), at(1, 1), at(1, 3),
                         at(3, 3), at(3, 1), at(1, 1)}};
const Rings kCrossing = {{at(0, 0), at(5, 4), at(4, 0), at(0, 4)}};

// Each polygon has its triangles, in the order of polygons, whatever stands before it.
TEST(MeshBuilder, KeepsTheOrderOfPolygons) {
  struct Part {
    const Rings& rings;
    std::size_t triangles;
    double area;
  };
  const std::vector<Part> parts = {{kSquare, 2, 4.0},       {kSquare, 2, 4.0}, {kTriangle, 1, 0.5},
                                   {kDart, 2, 8.0},         {kFrame, 7, 15.5}, {kKeyhole, 8, 12.0},
                                   {kFrameOfTwo, 13, 30.5}, {kDart, 2, 8.0},   {kTriangle, 1, 0.5},
                                   {kKeyhole, 8, 12.0},     {kSquare, 2, 4.0}};
  MeshBuilder builder;
  add_grid(builder);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    add_polygon(builder, i + 1, parts[i].rings);
  }
  ReadingLog log("m", "");
  const Mesh mesh = builder.finish(log);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t end = begin + parts[i].triangles;
    ASSERT_LE(end, mesh.triangles.size());
    EXPECT_DOUBLE_EQ(signed_area(mesh, begin, end), parts[i].area) << i;
    begin = end;
  }
  EXPECT_EQ(mesh.triangles.size(), begin);
  const FileReport report = log.finish();
  ASSERT_EQ(report.contents.size(), 3u);
  EXPECT_EQ(report.contents[0].count, 9u);  // Polygons of more than three corners.
  EXPECT_EQ(report.contents[1].count, 4u);  // Concave ones.
  EXPECT_EQ(report.contents[2].count, 3u);  // Holes.
  EXPECT_TRUE(report.warnings.empty());
}

TEST(MeshBuilder, AcceptsPolygonsBeforeTheirVertices) {
  MeshBuilder builder;
  add_polygon(builder, 1, kDart);
  EXPECT_TRUE(builder.has_range_error());
  add_grid(builder);
  EXPECT_FALSE(builder.has_range_error());
  EXPECT_DOUBLE_EQ(signed_area(builder.finish(), 0, 2), 8.0);
}

// Nothing of a polygon that crosses itself is lost: fans touch each corner and edge.
TEST(MeshBuilder, NamesTheFirstPolygonThatCrosses) {
  const Rings out_of_bounds = {kSquare[0], {at(1, 1), at(3, 1), at(1, 3)}};
  MeshBuilder builder;
  add_grid(builder);
  for (const std::size_t place : {4u, 6u, 8u}) {
    add_polygon(builder, place, kSquare);
  }
  add_polygon(builder, 10, kCrossing);
  add_polygon(builder, 12, out_of_bounds);
  ReadingLog log("m", "");
  const Mesh mesh = builder.finish(log);
  EXPECT_EQ(mesh.triangles.size(), 6u + 2u + 3u);
  const FileReport report = log.finish();
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.warnings[0].find("m:10: a polygon crosses itself"), 0u);
  EXPECT_NE(report.warnings[0].find("2 such polygons in all"), std::string::npos);
}

TEST(MeshBuilder, NamesTheMostBentPolygonOfARun) {
  MeshBuilder builder;
  for (const double height : {0.0, 0.0, 0.5, 1.0, 0.25}) {
    for (const auto& [x, y] : std::initializer_list<std::pair<int, int>>{{0, 0}, {1, 0}, {1, 1}}) {
      ASSERT_TRUE(builder.add_vertex(Eigen::Vector3d(x, y, 0.0)));
    }
    ASSERT_TRUE(builder.add_vertex(Eigen::Vector3d(0.0, 1.0, height)));
  }
  for (std::uint32_t i = 0; i < 5; ++i) {
    add_polygon(builder, 100 + 3 * i, {{4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3}});
  }
  ReadingLog log("m", "");
  EXPECT_EQ(builder.finish(log).triangles.size(), 10u);
  const FileReport report = log.finish();
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.warnings[0].find("m:109: 3 of 5 polygons"), 0u) << report.warnings[0];
}

TEST(MeshBuilder, PassesOverHolesOfWhatIsNoPolygon) {
  MeshBuilder builder;
  add_grid(builder);
  add_polygon(builder, 1, {{1}, {2, 3}});
  add_polygon(builder, 2, {{}, {1, 2, 3}});
  add_polygon(builder, 3, kFrame);
  add_polygon(builder, 4, {{5, 6, 15}, {7}});
  ReadingLog log("m", "");
  EXPECT_GE(builder.finish(log).triangles.size(), 9u);
}

}  // namespace
}  // namespace firstcontact::detail
