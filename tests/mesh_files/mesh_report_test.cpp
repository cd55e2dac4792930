#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/mesh_files/detail/parse_mesh.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/reading_log.h>

#include "mesh_files/mesh_text.h"

namespace firstcontact {
namespace {

using detail::ReadingLog;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct Reading {
  Mesh mesh;
  FileReport report;
};

template <class Parse>
Reading read(Parse parse, const std::string& text, bool lenient = false) {
  ReadingLog log("m", "", {.lenient = lenient});
  Mesh mesh = parse(text, log);
  return {std::move(mesh), log.finish()};
}

std::size_t content(const FileReport& report, std::string_view what) {
  for (const FileContent& entry : report.contents) {
    if (entry.what == what) {
      return entry.count;
    }
  }
  return 0;
}

std::size_t left_out(const FileReport& report, std::string_view name) {
  for (const LeftOut& entry : report.left_out) {
    if (entry.name == name) {
      return entry.count;
    }
  }
  return 0;
}

const Mesh kTriangle{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};

TEST(ObjReport, CountsPolygonsAndNamesWhatIsLeftOut) {
  const auto [mesh, report] =
      read(detail::parse_obj,
           "mtllib a.mtl\nv 0 0 0\nv 2 1 0\nv 0 4 0\nv 1 1 0\nv 9 9 9\nvn 0 0 1\n"
           "vn 0 0 1\nusemtl red\n5 3 0\nf 1//1 2//1 3//1 4//1\nf 1 2 5\nf 1 2 5 3\n");
  EXPECT_EQ(mesh.triangles, (Triangles{{1, 3, 0}, {1, 2, 3}, {0, 1, 4}, {0, 1, 4}, {0, 4, 2}}));
  EXPECT_EQ(content(report, "polygons of more than three corners"), 2u);
  EXPECT_EQ(content(report, "concave polygons"), 1u);
  EXPECT_EQ(left_out(report, "vn"), 2u);
  EXPECT_EQ(left_out(report, "usemtl"), 1u);
  EXPECT_EQ(left_out(report, "mtllib"), 1u);
  EXPECT_EQ(left_out(report, "lines of whole numbers"), 1u);
}

TEST(ObjReport, NamesTheGreatestDeviationOfPolygonsThatAreNotPlanar) {
  const std::string vertices =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 1 0.25\nv 0 1 0.5\nv 0 1 1e-7\n";
  const auto flat = read(detail::parse_obj, vertices + "f 1 2 3 4\nf 1 2 3 7\n");
  EXPECT_TRUE(flat.report.warnings.empty());
  const auto bent =
      read(detail::parse_obj, vertices + "f 1 2 3 4\nf 1 2 3 5\nf 1 2 3 6\nf 2 3 5 1\n");
  ASSERT_EQ(bent.report.warnings.size(), 1u);
  EXPECT_EQ(bent.report.warnings[0],
            "m:10: 3 of 4 polygons of more than three corners not planar within 1.5e-05 m: the "
            "surface depends on how they are "
            "cut; the greatest deviation, 0.236 m, is here");
}

TEST(ObjReport, NamesPolygonsThatCrossThemselves) {
  const auto [mesh, report] =
      read(detail::parse_obj, "v 0 0 0\nv 4 4 0\nv 4 0 0\nv 0 5 0\nf 1 2 3\nf 1 2 3 4\n");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}}));
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("m:6: a polygon crosses itself"), std::string::npos);
}

TEST(PlyReport, NamesPolygonsByTheirByte) {
  std::string data =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
  for (const float x : {0.f, 0.f, 0.f, 4.f, 4.f, 0.f, 4.f, 0.f, 0.f, 0.f, 5.f, 0.f}) {
    data += test::bytes_of(x);
  }
  const std::string place = std::to_string(data.size() + 1);
  const auto [mesh, report] = read(detail::parse_ply, data + std::string("\4\0\1\2\3", 5));
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.warnings[0].find("m: byte " + place + ": a polygon crosses itself"), 0u);
}

// Simplifiers leave faces whose corners are all gone.
TEST(PlyReport, CountsFacesWithoutCorners) {
  for (const char* faces : {"0\n3 0 1 2\n0\n", "3 0 1 2\n0\n0\n"}) {
    Mesh three = kTriangle;
    three.triangles.resize(3);
    const auto [mesh, report] =
        read(detail::parse_ply, test::ply_header(three, "ascii") + "0 0 0\n1 0 0\n0 1 0\n" + faces);
    EXPECT_EQ(mesh.triangles, kTriangle.triangles);
    EXPECT_EQ(left_out(report, "faces without corners"), 2u);
  }
  const auto off = read(detail::parse_off, "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n0\n");
  EXPECT_EQ(left_out(off.report, "faces without corners"), 1u);
  EXPECT_EQ(left_out(off.report, "columns after the corners"), 1u);
}

TEST(PlyReport, NamesPropertiesAndElements) {
  const auto [mesh, report] = read(
      detail::parse_ply,
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\n"
      "property uchar red\nelement face 1\nproperty list uchar int vertex_index\nelement edge 1\n"
      "property int vertex1\nproperty int vertex2\nend_header\n0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 "
      "2\n0 1\n");
  EXPECT_EQ(left_out(report, "property 'red' of 'vertex'"), 3u);
  EXPECT_EQ(left_out(report, "element 'edge'"), 1u);
  ASSERT_EQ(report.warnings.size(), 1u);
}

TEST(StlReport, WarnsOfPaddingAtTheEnd) {
  const std::string data = test::to_binary_stl(kTriangle);
  for (const std::string& padding :
       {std::string("\r\n"), std::string(70, '\0'), std::string("\x1a")}) {
    const auto [mesh, report] = read(detail::parse_stl, data + padding);
    EXPECT_EQ(mesh.triangles.size(), 1u);
    ASSERT_EQ(report.warnings.size(), 1u);
    EXPECT_EQ(report.warnings[0], "m: byte 134: " + std::to_string(padding.size()) +
                                      (padding.size() == 1 ? " byte is" : " bytes are") +
                                      " left over after 1 triangle");
  }
}

// As exporters write it: several solids, names of several words, capitals, normals of no number,
// and no last line.
TEST(StlReport, TakesAsciiAsItIsWritten) {
  const std::string facet =
      "  FACET NORMAL nan NaN -nan\n OUTER LOOP\n Vertex 0 0 0\nVERTEX 1 0 0\nvertex 0 1 "
      "0\nENDLOOP\nEndFacet\n";
  const auto two =
      read(detail::parse_stl, "SOLID left half\r\n" + facet + "ENDSOLID left half\nsolid\n" +
                                  facet + facet + "endsolid");
  EXPECT_EQ(two.mesh.triangles.size(), 3u);
  EXPECT_EQ(content(two.report, "solids"), 2u);
  EXPECT_TRUE(two.report.warnings.empty());
  const std::string without_end = "solid a\n" + facet + "solid b\n" + facet;
  EXPECT_EQ(read(detail::parse_stl, without_end + "endsolid\n").report.warnings,
            std::vector<std::string>{"m:9: 'endsolid' is missing before this solid"});
  EXPECT_THROW((void)read(detail::parse_stl, without_end), ParseError);
  EXPECT_EQ(read(detail::parse_stl, without_end, /*lenient=*/true).mesh.triangles.size(), 2u);
}

TEST(XyzReport, NamesHeadersAndColumns) {
  ReadingLog log("m", "XYZ");
  const auto points = detail::parse_xyz("// one\nx y z i\n0 0 0 1\n1 1 1 2\n", log);
  const FileReport report = log.finish();
  EXPECT_EQ(points.size(), 2u);
  EXPECT_EQ(left_out(report, "//"), 1u);
  EXPECT_EQ(left_out(report, "names of columns"), 1u);
  EXPECT_EQ(left_out(report, "columns after x, y and z"), 2u);
}

}  // namespace
}  // namespace firstcontact
