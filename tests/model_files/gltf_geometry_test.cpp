// Positions and indices of glTF in every form: what arrives is what the format holds, to the bit.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "model_files/gltf_body.h"
#include "model_files/gltf_reading.h"
#include "support/gltf_writer.h"

namespace firstcontact {
namespace {

using test::float_corners;
using test::float_positions;
using test::GltfTest;
using test::GltfWriter;
using test::has_corners;
using test::indices_of_triangles;
using test::mesh_text;
using test::plain_gltf;
using test::primitive_text;

class GltfGeometry : public GltfTest {};

/// A body whose positions are accessor 0 of the writer.
GltfWriter with_indices(GltfWriter gltf) {
  gltf.add_numbers(indices_of_triangles(), "SCALAR");
  gltf.meshes = {mesh_text({primitive_text(0, 1)})};
  gltf.nodes = {R"({"mesh":0})"};
  return gltf;
}

template <class T>
std::vector<T> indices_as() {
  const auto bytes = indices_of_triangles();
  return {bytes.begin(), bytes.end()};
}

TEST_F(GltfGeometry, ArrivesInEachContainerToTheLastBit) {
  const GltfWriter gltf = plain_gltf();
  write("body.bin", gltf.buffer);
  EXPECT_TRUE(has_corners(read("a.glb", gltf.glb()).mesh, float_corners()));
  EXPECT_TRUE(has_corners(read("b.gltf", gltf.with_data_uri()).mesh, float_corners()));
  EXPECT_TRUE(has_corners(read("c.gltf", gltf.json(R"("uri":"body.bin",)")).mesh, float_corners()));
  const Mesh mesh = read("d.glb", gltf.glb()).mesh;
  EXPECT_EQ(mesh.vertices, test::points_of(float_positions()));  // In the file's order.
}

TEST_F(GltfGeometry, TakesIndicesOfEachType) {
  for (int type = 0; type < 3; ++type) {
    GltfWriter gltf = plain_gltf();
    const std::size_t indices = type == 0 ? gltf.add_numbers(indices_as<std::uint8_t>(), "SCALAR")
                                : type == 1
                                    ? gltf.add_numbers(indices_as<std::uint16_t>(), "SCALAR")
                                    : gltf.add_numbers(indices_as<std::uint32_t>(), "SCALAR");
    gltf.meshes = {mesh_text({primitive_text(0, indices)})};
    EXPECT_TRUE(has_corners(read_glb(gltf), float_corners())) << type;
  }
}

TEST_F(GltfGeometry, NeedsNoIndices) {
  GltfWriter gltf;
  std::vector<float> soup;
  for (const Eigen::Vector3d& corner : float_corners()) {
    for (const double c : corner) {
      soup.push_back(static_cast<float>(c));
    }
  }
  gltf.add_numbers(soup, "VEC3");
  gltf.meshes = {R"({"primitives":[{"attributes":{"POSITION":0}}]})"};
  gltf.nodes = {R"({"mesh":0})"};
  const Mesh mesh = read_glb(gltf);
  EXPECT_TRUE(has_corners(mesh, float_corners()));
  EXPECT_EQ(mesh.vertices.size(), 8u);  // Welded.
}

TEST_F(GltfGeometry, TakesStripsAndFansOfOneWinding) {
  for (const int mode : {5, 6}) {
    GltfWriter gltf;
    gltf.add_numbers(float_positions(), "VEC3");
    std::vector<std::string> primitives;
    for (const auto& [a, b, c, d] : test::kQuads) {
      const std::vector<std::uint8_t> indices =
          mode == 5 ? std::vector<std::uint8_t>{b, c, a, d} : std::vector<std::uint8_t>{a, b, c, d};
      primitives.push_back(primitive_text(0, gltf.add_numbers(indices, "SCALAR"), "",
                                          ",\"mode\":" + std::to_string(mode)));
    }
    gltf.meshes = {mesh_text(primitives)};
    gltf.nodes = {R"({"mesh":0})"};
    EXPECT_TRUE(has_corners(read_glb(gltf), float_corners())) << mode;
  }
}

TEST_F(GltfGeometry, TurnsEverySecondTriangleOfAStrip) {
  GltfWriter gltf = plain_gltf();
  gltf.meshes = {R"({"primitives":[{"attributes":{"POSITION":0},"mode":5}]})"};
  const auto p = test::points_of(float_positions());
  test::Corners corners;
  for (std::size_t i = 0; i < 6; ++i) {
    corners.push_back(p[i]);
    corners.push_back(p[i % 2 == 0 ? i + 1 : i + 2]);
    corners.push_back(p[i % 2 == 0 ? i + 2 : i + 1]);
  }
  EXPECT_TRUE(has_corners(read_glb(gltf), corners));
}

TEST_F(GltfGeometry, HeedsStridesAndOffsets) {
  GltfWriter gltf;
  std::string bytes(20, '\x7f');
  const auto positions = float_positions();
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    bytes += std::string(8, '\x7f');
    for (std::size_t k = 0; k < 3; ++k) {
      bytes += test::little_endian(positions[i + k]);
    }
    bytes += std::string(4, '\x7f');
  }
  bytes.resize(bytes.size() - 4);  // The last row needs no room after it.
  const std::size_t view = gltf.add_view(bytes, 24);
  gltf.add_accessor("\"bufferView\":" + std::to_string(view) + ",\"byteOffset\":28,", 5126, 8,
                    "VEC3");
  EXPECT_TRUE(has_corners(read_glb(with_indices(gltf)), float_corners()));
}

template <class T>
class GltfIntegers : public GltfTest {};
using IntegerTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t>;
TYPED_TEST_SUITE(GltfIntegers, IntegerTypes);

TYPED_TEST(GltfIntegers, AreExactPositions) {
  GltfWriter gltf;
  const auto positions = test::grid_positions<TypeParam>();
  gltf.add_numbers(positions, "VEC3");
  gltf.more = R"("extensionsUsed":["KHR_mesh_quantization"],)"
              R"("extensionsRequired":["KHR_mesh_quantization"],)";
  const auto reading = this->read("body.glb", with_indices(gltf).glb());
  EXPECT_TRUE(has_corners(reading.mesh, test::corners_of_triangles(test::points_of(positions))));
  EXPECT_TRUE(reading.report.warnings.empty());
}

TYPED_TEST(GltfIntegers, AreTheNearestDoublesToTheirSharesOfTheGreatest) {
  GltfWriter gltf;
  const auto positions = test::grid_positions<TypeParam>();
  gltf.add_numbers(positions, "VEC3", "\"normalized\":true,");
  EXPECT_TRUE(
      has_corners(this->read_glb(with_indices(gltf)),
                  test::corners_of_triangles(test::points_of(
                      positions, static_cast<double>(std::numeric_limits<TypeParam>::max())))));
}

TYPED_TEST(GltfIntegers, WarnWhereTheFileDoesNotNameTheirExtension) {
  GltfWriter gltf;
  gltf.add_numbers(test::grid_positions<TypeParam>(), "VEC3");
  const auto reading = this->read("body.glb", with_indices(gltf).glb());
  ASSERT_EQ(reading.report.warnings.size(), 1u);
  EXPECT_NE(reading.report.warnings[0].find("KHR_mesh_quantization"), std::string::npos);
}

TEST_F(GltfGeometry, KeepsTheLeastNormalisedNumberAtMinusOne) {
  GltfWriter gltf;
  gltf.add_numbers(std::vector<std::int8_t>{-128, -127, 0, 127, 0, 0, 0, 127, 0}, "VEC3",
                   "\"normalized\":true,");
  gltf.meshes = {R"({"primitives":[{"attributes":{"POSITION":0}}]})"};
  gltf.nodes = {R"({"mesh":0})"};
  EXPECT_TRUE(has_corners(read_glb(gltf), {{-1, -1, 0}, {1, 0, 0}, {0, 1, 0}}));
}

/// The members of a sparse accessor that replaces some positions.
std::string sparse_members(GltfWriter& gltf, const std::vector<std::uint8_t>& rows,
                           const std::vector<float>& values) {
  std::string bytes;
  for (const float value : values) {
    bytes += test::little_endian(value);
  }
  const std::size_t indices = gltf.add_view(std::string(rows.begin(), rows.end()));
  const std::size_t view = gltf.add_view(bytes);
  return R"("sparse":{"count":)" + std::to_string(rows.size()) + R"(,"indices":{"bufferView":)" +
         std::to_string(indices) + R"(,"componentType":5121},"values":{"bufferView":)" +
         std::to_string(view) + "}},";
}

TEST_F(GltfGeometry, ReplacesSparseRows) {
  for (const bool has_base : {true, false}) {
    GltfWriter gltf;
    const auto positions = float_positions();
    std::vector<float> base = positions;
    std::fill(base.begin() + 3, base.begin() + 6, 77.0f);
    std::fill(base.begin() + 21, base.end(), 77.0f);
    std::vector<std::uint8_t> rows = {1, 7};
    std::vector<float> values(positions.begin() + 3, positions.begin() + 6);
    values.insert(values.end(), positions.begin() + 21, positions.end());
    std::vector<float> expected = positions;
    std::string head;
    if (has_base) {
      std::string bytes;
      for (const float value : base) {
        bytes += test::little_endian(value);
      }
      head = "\"bufferView\":" + std::to_string(gltf.add_view(bytes)) + ",";
    } else {
      std::fill(expected.begin(), expected.begin() + 3, 0.0f);
      std::fill(expected.begin() + 6, expected.begin() + 21, 0.0f);
    }
    head += sparse_members(gltf, rows, values);
    gltf.add_accessor(head, 5126, 8, "VEC3");
    EXPECT_TRUE(has_corners(read_glb(with_indices(gltf)),
                            test::corners_of_triangles(test::points_of(expected))))
        << has_base;
  }
}

TEST_F(GltfGeometry, DropsVerticesThatNoTriangleUses) {
  GltfWriter gltf = plain_gltf();
  const std::size_t few = gltf.add_numbers(std::vector<std::uint8_t>{7, 2, 5}, "SCALAR");
  gltf.meshes = {mesh_text({primitive_text(0, few), primitive_text(0, few)})};
  const Mesh mesh = read_glb(gltf);
  const auto p = test::points_of(float_positions());
  EXPECT_EQ(mesh.vertices, (std::vector<Eigen::Vector3d>{p[2], p[5], p[7]}));
  EXPECT_TRUE(has_corners(mesh, {p[7], p[2], p[5], p[7], p[2], p[5]}));
}

TEST_F(GltfGeometry, KeepsDegenerateTriangles) {
  GltfWriter gltf = plain_gltf();
  const std::size_t few = gltf.add_numbers(std::vector<std::uint8_t>{7, 7, 5, 1, 1, 1}, "SCALAR");
  gltf.meshes = {mesh_text({primitive_text(0, few)})};
  EXPECT_EQ(read_glb(gltf).triangles.size(), 2u);
}

TEST_F(GltfGeometry, LeavesOutPointsAndLinesByName) {
  GltfWriter gltf = plain_gltf();
  gltf.meshes = {mesh_text({primitive_text(0, 1, "", ",\"mode\":0"), primitive_text(0, 1),
                            primitive_text(0, 1, "", ",\"mode\":1"),
                            primitive_text(0, 1, "", ",\"mode\":3")})};
  const auto reading = read("body.glb", gltf.glb());
  EXPECT_TRUE(has_corners(reading.mesh, float_corners()));
  ASSERT_EQ(reading.report.left_out.size(), 2u);
  EXPECT_EQ(reading.report.left_out[0].name, "points");
  EXPECT_EQ(reading.report.left_out[1].name, "lines");
  EXPECT_EQ(reading.report.left_out[1].count, 2u);
  gltf.meshes = {mesh_text({primitive_text(0, 1, "", ",\"mode\":2")})};
  EXPECT_TRUE(is_refused(gltf, "at least one triangle"));
}

}  // namespace
}  // namespace firstcontact
