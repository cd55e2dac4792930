#include <firstcontact/geometry/weld.h>

#include <array>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace firstcontact {
namespace {

TEST(Weld, MergesEqualPositionsInOrderOfFirstOccurrence) {
  Mesh mesh{.vertices = {{2, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 0}},
            .triangles = {{2, 4, 3}, {0, 1, 3}}};
  EXPECT_EQ(weld(mesh), 2u);
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[0].x(), 2.0);
  EXPECT_EQ(mesh.vertices[1].x(), 1.0);
  EXPECT_EQ(mesh.vertices[2].x(), 3.0);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(Weld, TakesBothZerosAsEqualAndKeepsTheFirst) {
  Mesh mesh{.vertices = {{-0.0, 0, 0}, {0, -0.0, 0}}, .triangles = {{0, 1, 1}}};
  EXPECT_EQ(weld(mesh), 1u);
  EXPECT_TRUE(std::signbit(mesh.vertices[0].x()));
}

// Tight: the least possible difference keeps two vertices apart.
TEST(Weld, KeepsNeighbouringDoublesApart) {
  Mesh mesh{.vertices = {{1, 0, 0}, {std::nextafter(1.0, 2.0), 0, 0}, {0, 5e-324, 0}, {0, 0, 0}},
            .triangles = {{0, 1, 2}}};
  EXPECT_EQ(weld(mesh), 0u);
  EXPECT_EQ(mesh.vertices.size(), 4u);
}

TEST(Weld, KeepsUnusedVerticesAndTheirNumbers) {
  Mesh mesh{.vertices = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{1, 2, 3}}};
  EXPECT_EQ(weld(mesh), 0u);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{1, 2, 3}));
}

TEST(Weld, FindsTheGridInASoup) {
  Mesh mesh;
  constexpr std::uint32_t kSide = 60;
  for (std::uint32_t i = 0; i < 6 * kSide * kSide; ++i) {
    mesh.vertices.emplace_back(i % kSide, i / kSide % kSide, 0.1);
  }
  for (std::uint32_t i = 0; i + 2 < mesh.vertices.size(); i += 3) {
    mesh.triangles.push_back({i, i + 1, i + 2});
  }
  const Mesh soup = mesh;
  EXPECT_EQ(weld(mesh), 5u * kSide * kSide);
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(soup.vertices[soup.triangles[i][k]], mesh.vertices[mesh.triangles[i][k]]);
    }
  }
}

}  // namespace
}  // namespace firstcontact
