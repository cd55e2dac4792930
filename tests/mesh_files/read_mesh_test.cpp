#include <firstcontact/mesh_files/read_mesh.h>

#include <algorithm>
#include <array>
#include <bit>
#include <clocale>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <locale>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/text/parse_error.h>

#include "mesh_files/mesh_text.h"

namespace firstcontact {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Triangles = std::vector<Triangle>;

/// Finite doubles of every size and sign, denormal ones too.
double any_double(std::mt19937_64& rng) {
  for (;;) {
    const auto value = std::bit_cast<double>(rng());
    if (std::isfinite(value)) {
      return value;
    }
  }
}

Mesh random_mesh(std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  Mesh mesh;
  for (int i = 0; i < 50; ++i) {
    mesh.vertices.emplace_back(any_double(rng), any_double(rng), any_double(rng));
  }
  for (int i = 0; i < 80; ++i) {
    Triangle t{};
    for (auto& v : t) {
      v = static_cast<std::uint32_t>(rng() % mesh.vertices.size());
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

bool same_bits(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  for (int k = 0; k < 3; ++k) {
    if (std::bit_cast<std::uint64_t>(a[k]) != std::bit_cast<std::uint64_t>(b[k])) {
      return false;
    }
  }
  return true;
}

void expect_identical(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    EXPECT_TRUE(same_bits(a.vertices[i], b.vertices[i])) << "vertex " << i;
  }
}

/// As expect_identical, corner by corner.
void expect_same_soup(const Mesh& a, const Mesh& b) {
  ASSERT_EQ(a.triangles.size(), b.triangles.size());
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_TRUE(same_bits(a.vertices[a.triangles[i][k]], b.vertices[b.triangles[i][k]])) << i;
    }
  }
}

Mesh square() {
  return {.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}},
          .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

TEST(Readers, BringDoublesBackToTheLastBit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const Mesh mesh = random_mesh(seed);
    expect_identical(parse_obj(test::to_obj(mesh), "obj"), mesh);
    expect_identical(parse_off(test::to_off(mesh), "off"), mesh);
    expect_identical(parse_ply(test::to_ascii_ply(mesh), "ply"), mesh);
    expect_identical(parse_ply(test::to_binary_ply(mesh, false), "ply"), mesh);
    expect_identical(parse_ply(test::to_binary_ply(mesh, true), "ply"), mesh);
    expect_same_soup(parse_stl(test::to_ascii_stl(mesh), "stl"), mesh);
  }
}

TEST(Readers, BringFloatsOfBinaryStlBackToTheLastBit) {
  Mesh mesh = square();
  mesh.vertices[1].x() = 0.1f;
  mesh.vertices[2].y() = -1e-40f;
  expect_same_soup(parse_stl(test::to_binary_stl(mesh), "stl"), mesh);
}

TEST(Readers, DoNotHeedTheLocale) {
  struct CommaDecimal : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const Mesh mesh = square();
  const std::string obj = test::to_obj(mesh);
  const std::string off = test::to_off(mesh);
  const std::string ply = test::to_ascii_ply(mesh);
  const std::string stl = test::to_ascii_stl(mesh);
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaDecimal));
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // Where it is installed.
  expect_identical(parse_obj(obj, "obj"), mesh);
  expect_identical(parse_off(off, "off"), mesh);
  expect_identical(parse_ply(ply, "ply"), mesh);
  expect_same_soup(parse_stl(stl, "stl"), mesh);
  EXPECT_THROW((void)parse_obj("v 0,5 0 0\nf 1 1 1\n", "obj"), std::runtime_error);
  std::setlocale(LC_ALL, "C");
  std::locale::global(before);
}

// Any blank may stand between two words of STL, also one for a line break.
TEST(ReadStl, DoesNotNeedLines) {
  const Mesh mesh = square();
  std::string stl = test::to_ascii_stl(mesh);
  stl.replace(0, stl.find('\n'), "solid my facet");
  for (const char blank : {' ', '\t', '\r', '\f'}) {
    std::string one_line = stl;
    std::ranges::replace(one_line, '\n', blank);
    expect_same_soup(parse_stl(one_line, "stl"), mesh);
  }
  std::string words =
      stl.substr(stl.find('\n'), stl.find("endsolid") - stl.find('\n')) + "endsolid";
  std::ranges::replace(words, ' ', '\n');
  expect_same_soup(parse_stl("solid\n" + words, "stl"), mesh);
}

TEST(Readers, TakeCarriageReturnsForLineEnds) {
  const Mesh mesh = square();
  const auto old = [](std::string text) {
    std::ranges::replace(text, '\n', '\r');
    return text;
  };
  expect_identical(parse_obj(old(test::to_obj(mesh)), "obj"), mesh);
  expect_identical(parse_off(old(test::to_off(mesh)), "off"), mesh);
  expect_identical(parse_ply(old(test::to_ascii_ply(mesh)), "ply"), mesh);
}

TEST(ReadObj, AcceptsEveryFormOfACorner) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* face : {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//1 3//1", "f 1/1/1 2/2/1 3/3/1",
                           "f -3 -2 -1", "f -3/-1 2/1 3/1", "f 1 2 \\\n3", "f 1 2\\\r\n 3",
                           "f 1 2 3 # comment", "  f\t1 2 3  ", "f 1 2 3\r"}) {
    EXPECT_EQ(parse_obj(vertices + face, "obj").triangles, (Triangles{{0, 1, 2}})) << face;
  }
}

TEST(ReadObj, TakesNumbersInAnyNotation) {
  const Mesh mesh = parse_obj(
      "v +1.5e+0 -2E-1 .5\nv 1. 1e-400 -0\nv 1 2 3 0.5 0.5 0.5\n"
      "v 1 2 3 1.0\nf 1 2 3 4",
      "obj");
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3d(1.5, -0.2, 0.5));
  EXPECT_EQ(mesh.vertices[1], Eigen::Vector3d(1.0, 0.0, 0.0));
  EXPECT_TRUE(std::signbit(mesh.vertices[1].z()));
}

TEST(ReadObj, FansPolygonsAndKeepsEdgesAndPoints) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n";
  EXPECT_EQ(parse_obj(vertices + "f 1 2 3 4 5", "obj").triangles,
            (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
  EXPECT_EQ(parse_obj(vertices + "l 1 2 3", "obj").triangles, (Triangles{{0, 1, 1}, {1, 2, 2}}));
  EXPECT_EQ(parse_obj(vertices + "p 1 5", "obj").triangles, (Triangles{{0, 0, 0}, {4, 4, 4}}));
}

TEST(ReadObj, PassesOverALineOfCounts) {
  EXPECT_EQ(parse_obj("3 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "obj").triangles.size(), 1u);
  EXPECT_THROW((void)parse_obj("3 1 x\nv 0 0 0\nf 1 1 1\n", "obj"), ParseError);
}

TEST(ReadObj, AcceptsFacesBeforeVertices) {
  EXPECT_EQ(parse_obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", "obj").triangles,
            (Triangles{{0, 1, 2}}));
}

TEST(ReadStl, TellsBinaryFromText) {
  const Mesh mesh = square();
  for (const char* header : {"solid but binary", "solid facet normal", "x"}) {
    expect_same_soup(parse_stl(test::to_binary_stl(mesh, header), "stl"), mesh);
  }
  expect_same_soup(parse_stl("\n  SOLID\n" + test::to_ascii_stl(mesh).substr(11), "stl"), mesh);
}

TEST(ReadPly, TakesAnyOrderTypeAndExtraElements) {
  const std::string header =
      "ply\r\nformat binary_big_endian 1.0\r\nelement material 1\r\nproperty list short float q\r\n"
      "element face 1\r\nproperty uchar flags\r\nproperty list uint ushort vertex_index\r\n"
      "property list uchar double weights\r\nelement vertex 3\r\nproperty float nx\r\n"
      "property short z\r\nproperty double y\r\nproperty float x\r\nend_header\r\n";
  std::string body = test::bytes_of(std::int16_t{1}, true) + test::bytes_of(9.0f, true);
  body += "\7" + test::bytes_of(std::uint32_t{3}, true);
  for (const std::uint16_t v : std::array<std::uint16_t, 3>{0, 1, 2}) {
    body += test::bytes_of(v, true);
  }
  body += "\1" + test::bytes_of(0.5, true);
  for (int i = 0; i < 3; ++i) {
    body += test::bytes_of(7.0f, true) + test::bytes_of(static_cast<std::int16_t>(-i), true) +
            test::bytes_of(0.1 * i, true) + test::bytes_of(0.5f * static_cast<float>(i), true);
  }
  const Mesh mesh = parse_ply(header + body, "ply");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3d(1.0, 0.2, -2.0));
}

TEST(ReadOff, AcceptsItsVariants) {
  const std::string body = "\n0 0 0 9 9 9\n\n1 0 0 9 9 9 # comment\n0 1 0 9 9 9\n3 0 1 2 255 0 0\n";
  for (const char* header : {"OFF\n3 1 0", "OFF 3 1 3", "# first\nOFF\n# counts\n3 1",
                             "COFF\n3 1 0", "NOFF 3 1 0", "STCNOFF\r\n3 1 0\r"}) {
    EXPECT_EQ(parse_off(header + body, "off").triangles, (Triangles{{0, 1, 2}})) << header;
  }
}

/// A file in the test's own folder, removed at the end.
class File {
 public:
  File(const std::string& name, const std::string& content)
      : path_(std::filesystem::path(testing::TempDir()) / ("firstcontact_" + name)) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~File() { std::filesystem::remove(path_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

TEST(ReadMesh, ChoosesTheReaderByTheEndingAndWelds) {
  const Mesh mesh = square();
  expect_identical(read_mesh(File("a.OBJ", test::to_obj(mesh)).path()), mesh);
  expect_identical(read_mesh(File("a.Stl", test::to_binary_stl(mesh)).path()), mesh);
  expect_identical(read_mesh(File("a.ply", test::to_binary_ply(mesh, true)).path()), mesh);
  expect_identical(read_mesh(File("a.off", test::to_off(mesh)).path()), mesh);
}

std::string collada(const std::string& matrix) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.5"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="s"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="w"><node id="n"><matrix>)" +
         matrix +
         R"(</matrix><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>)";
}

TEST(ReadMesh, AppliesNodeTransformAndUnitOfDae) {
  const File file("a.dae", collada("1 0 0 2 0 1 0 0 0 0 1 4 0 0 0 1"));
  const Mesh mesh = read_mesh(file.path());
  ASSERT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3d(1.0, 0.0, 2.0));
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3d(1.0, 0.5, 2.0));
}

std::string glb() {
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[1,2,3]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,)"
      R"("count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
      R"("buffers":[{"byteLength":36}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string binary;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) {
    binary += test::bytes_of(x);
  }
  const auto size = [](std::size_t n) { return test::bytes_of(static_cast<std::uint32_t>(n)); };
  return "glTF" + size(2) + size(28 + json.size() + binary.size()) + size(json.size()) + "JSON" +
         json + size(binary.size()) + std::string("BIN\0", 4) + binary;
}

TEST(ReadMesh, AppliesNodeTransformOfGlb) {
  const Mesh mesh = read_mesh(File("a.glb", glb()).path());
  ASSERT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(mesh.vertices[1], Eigen::Vector3d(2.0, 2.0, 3.0));
}

TEST(ReadMesh, RefusesFilesThatAreCutOff) {
  const std::string whole_glb = glb();
  const std::string whole_dae = collada("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  for (std::size_t n = 0; n < whole_glb.size(); n += 31) {
    EXPECT_THROW((void)read_mesh(File("cut.glb", whole_glb.substr(0, n)).path()), ParseError) << n;
  }
  for (std::size_t n = 0; n < whole_dae.size(); n += 97) {
    EXPECT_THROW((void)read_mesh(File("cut.dae", whole_dae.substr(0, n)).path()), ParseError) << n;
  }
  for (const auto& [name, whole] :
       {std::pair<std::string, std::string>{"cut.stl", test::to_binary_stl(square())},
        {"cut.ply", test::to_binary_ply(square(), false)}}) {
    for (std::size_t n = 0; n < whole.size(); ++n) {
      EXPECT_THROW((void)read_mesh(File(name, whole.substr(0, n)).path()), ParseError) << n;
    }
  }
}

}  // namespace
}  // namespace firstcontact
