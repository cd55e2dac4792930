#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/text/parse_error.h>

#include "mesh_files/mesh_text.h"

namespace firstcontact {
namespace {

using Parse = Mesh (*)(std::string_view, const std::string&);

struct Malformed {
  std::string text;
  std::string message;
};

void expect_messages(Parse parse, const std::vector<Malformed>& cases) {
  for (const auto& [text, message] : cases) {
    try {
      (void)parse(text, "m");
      ADD_FAILURE() << "accepted: " << text;
    } catch (const ParseError& error) {
      EXPECT_EQ(error.what(), message) << text;
    }
  }
}

TEST(MalformedObj, IsNamedByLine) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_messages(
      parse_obj,
      {{"", "m: expected at least one face, line or point, found none"},
       {vertices, "m: expected at least one face, line or point, found none"},
       {"v 0 0\n", "m:1: expected a finite coordinate, got the end of the line"},
       {"v 0 0 nan\n", "m:1: expected a finite coordinate, got 'nan'"},
       {"\nv 0 inf 0\n", "m:2: expected a finite coordinate, got 'inf'"},
       {"v 1e999 0 0\n", "m:1: expected a finite coordinate, got '1e999'"},
       {"v 0,5 0 0\n", "m:1: expected a finite coordinate, got '0,5'"},
       {"v 0 0 +-1\n", "m:1: expected a finite coordinate, got '+-1'"},
       {"v 0 0 0x10\n", "m:1: expected a finite coordinate, got '0x10'"},
       {"v 0 0 0 2\n", "m:1: expected a vertex weight of 1"},
       {"v 0 0 0 1 1\n", "m:1: expected x y z, x y z w or x y z r g b, got 5 numbers"},
       {vertices + "f 1 2 4\nv 0 0\n",
        "m:5: expected a finite coordinate, got the end of the line"},
       {vertices + "f 1 2 4\n", "m:4: vertex index 4 is out of range: the file has 3 vertices"},
       {vertices + "f 1 2 0\n", "m:4: vertex index 0 is out of range: 3 vertices so far"},
       {vertices + "f 1 2 -4\n", "m:4: vertex index -4 is out of range: 3 vertices so far"},
       {vertices + "f 1 2 99999999999\n", "m:4: vertex index 99999999999 is out of range"},
       {vertices + "f 1 2 99999999999999999999\n",
        "m:4: expected a vertex index (v, v/vt, v//vn or v/vt/vn), got '99999999999999999999'"},
       {vertices + "f 1 2 x\n",
        "m:4: expected a vertex index (v, v/vt, v//vn or v/vt/vn), got 'x'"},
       {vertices + "f\n",
        "m:4: expected a vertex index (v, v/vt, v//vn or v/vt/vn), got the end of the line"},
       {vertices + "l 1\n",
        "m:4: expected a vertex index (v, v/vt, v//vn or v/vt/vn), got the end of the line"},
       {vertices + "surf 0 1 0 1 1 2 3\n",
        "m:4: expected an OBJ statement (v, vn, vt, f, l, p, g, o, s, usemtl ...), got 'surf'"}});
}

TEST(MalformedStl, IsNamedByLineOrByte) {
  Mesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
  const std::string binary = test::to_binary_stl(mesh);
  const std::string ascii = test::to_ascii_stl(mesh);
  std::string many = binary;
  many.replace(80, 4, "\xff\xff\xff\xff");
  std::string uncounted = binary;  // Some writers never fill the count in.
  uncounted.replace(80, 4, std::string(4, '\0'));
  mesh.vertices[1].y() = std::numeric_limits<double>::quiet_NaN();
  expect_messages(
      parse_stl,
      {{"", "m: byte 0: expected STL: 'solid', or a header of 84 bytes"},
       {binary.substr(0, 100),
        "m: byte 100: expected 134 bytes for 1 triangles, got the end of the file"},
       {binary + "x",
        "m: byte 134: 1 byte is left over after 1 triangle: expected the end of the file"},
       {uncounted,
        "m: byte 80: count says 0, bytes of 1 triangles follow: expected the number of triangles"},
       {many,
        "m: byte 134: expected 214748364834 bytes for 4294967295 triangles, got the end of the "
        "file"},
       {test::to_binary_stl({}), "m: expected at least one triangle, found none"},
       {test::to_binary_stl(mesh), "m: byte 108: expected finite coordinates of triangle 0"},
       {"solid\nendsolid\n", "m: expected at least one triangle, found none"},
       {"solid a\nfacets\n", "m:2: expected 'facet' or 'endsolid', got 'facets'"},
       {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n",
        "m:4: expected a finite coordinate, got 'nan'"},
       {ascii.substr(0, ascii.find("endfacet")),
        "m:8: expected 'endfacet', got the end of the file"},
       {ascii.substr(0, ascii.find("endsolid")),
        "m:9: expected 'facet' or 'endsolid', got the end of the file"}});
}

TEST(MalformedPly, IsNamedByLineOrByte) {
  const Mesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
  Mesh beyond = mesh;
  beyond.triangles = {{0, 1, 7}};
  const std::string ascii = test::ply_header(mesh, "ascii");
  const std::string binary = test::to_binary_ply(mesh, false);
  const std::string size = std::to_string(binary.size());
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  expect_messages(
      parse_ply,
      {{"", "m:1: expected the header 'ply'"},
       {"ply\nformat ascii 1.0\n",
        "m:3: expected format, element, property, comment or end_header, got ''"},
       {"ply\nformat text 1.0\n",
        "m:2: expected ascii, binary_little_endian or binary_big_endian, got 'text'"},
       {"ply\nelement vertex -1\n", "m:2: expected a number of elements, got -1"},
       {"ply\nelement vertex 1\nproperty half x\n",
        "m:3: expected a type (char, uchar, short, ushort, int, uint, float, double), got 'half'"},
       {"ply\nelement face 1\nproperty list float int vertex_indices\n",
        "m:3: expected an integer type"},
       {"ply\nelement tristrips 1\n",
        "m:2: triangle strips are not supported: expected the element 'face'"},
       {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n",
        "m:5: expected an element 'vertex' with properties x, y and z"},
       {ascii + "0 0 0\n1 0\n", "m:12: expected a finite coordinate, got the end of the line"},
       {ascii + "0 0 0\n1 0 inf\n", "m:12: expected a finite coordinate, got 'inf'"},
       {ascii + "0 0 0\n", "m:12: expected vertex 2 of 3, got the end of the file"},
       {ascii + vertices + "3 0 1 3\n",
        "m:14: vertex index 3 is out of range: the file has 3 vertices"},
       {ascii + vertices + "3 0 1 -1\n", "m:14: vertex index -1 is out of range"},
       {ascii + vertices + "3 0 1\n", "m:14: expected a vertex index, got the end of the line"},
       {ascii + vertices + "0\n", "m: expected at least one face, found none"},
       {ascii + vertices + "3 0 1 2\n3 0 1 2\n",
        "m:15: expected the end of the file after the last element, got '3'"},
       {binary.substr(0, binary.size() - 1),
        "m: byte " + std::to_string(binary.size() - 1) +
            ": expected a vertex index, got the end of the file"},
       {binary + "x", "m: byte " + size + ": expected the end of the file after the last element"},
       {test::to_binary_ply(beyond, false),
        "m: byte " + std::to_string(binary.size() - 12) +
            ": vertex index 7 is out of range: the file has 3 vertices"}});
}

TEST(MalformedOff, IsNamedByLine) {
  const std::string head = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  expect_messages(
      parse_off,
      {{"", "m:1: expected the header OFF (or COFF, NOFF, STOFF), got ''"},
       {"4OFF\n", "m:1: expected the header OFF (or COFF, NOFF, STOFF), got '4OFF'"},
       {"OFF BINARY\n", "m:1: expected a number of vertices, got 'BINARY'"},
       {"OFF\n-3 1 0\n", "m:2: expected a number of vertices, got -3"},
       {"OFF\n3 1 0\n0 0 0\n", "m:4: expected vertex 2 of 3, got the end of the file"},
       {"OFF\n999999999999 1 0\n0 0 0\n",
        "m:4: expected vertex 2 of 999999999999, got the end of the file"},
       {"OFF\n1 1 0\n0 0 nan\n", "m:3: expected a finite coordinate, got 'nan'"},
       {head, "m:6: expected face 1 of 1, got the end of the file"},
       {head + "3 0 1\n", "m:6: expected a vertex index, got the end of the line"},
       {head + "3 0 1 3\n", "m:6: vertex index 3 is out of range: the file has 3 vertices"},
       {head + "0\n", "m: expected at least one face, found none"},
       {head + "-1\n", "m:6: expected a number of corners, got -1"},
       {head + "3 0 1 2\n3 0 1 2\n", "m:7: expected the end of the file after 1 faces, got '3'"},
       {"OFF\n1 0 0\n0 0 0\n", "m: expected at least one face, found none"}});
}

TEST(ReadMesh, SaysWhichFileCannotBeOpened) {
  const std::filesystem::path folder = testing::TempDir();
  try {
    (void)read_mesh(folder / "no_such_file.obj");
    FAIL();
  } catch (const ParseError& error) {
    EXPECT_EQ(error.what(), (folder / "no_such_file.obj").string() +
                                ": cannot open the file: No such file or directory");
  }
  EXPECT_THROW((void)read_mesh(folder), ParseError);
}

TEST(ReadMesh, NamesTheFormatsItKnows) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "mesh.xyz";
  std::ofstream(path) << "0 0 0\n";
  try {
    (void)read_mesh(path);
    FAIL();
  } catch (const ParseError& error) {
    EXPECT_EQ(error.message(),
              "expected a mesh file named .obj, .stl, .ply, .off, .dae, .glb or .gltf, got '.xyz'");
  }
  std::filesystem::remove(path);
}

TEST(ParseErrorText, IsOneLine) {
  const ParseError error("a\nb", 3, "first\nsecond");
  EXPECT_STREQ(error.what(), "a b:3: first second");
  EXPECT_EQ(error.line(), 3u);
  EXPECT_FALSE(error.offset().has_value());
}

}  // namespace
}  // namespace firstcontact
