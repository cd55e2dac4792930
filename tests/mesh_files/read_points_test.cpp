#include <firstcontact/mesh_files/read_points.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/point_cloud.h>
#include <firstcontact/text/parse_error.h>

#include "mesh_files/mesh_text.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::bytes_of;
using Points = std::vector<Vector3d>;

const Points kPoints = {{0.1, -2.5, 3.0}, {1e-3, 0.0, 7.25}};

std::string header(const std::string& fields, const std::string& sizes, const std::string& types,
                   const std::string& counts, const std::string& points, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types +
         "\nCOUNT " + counts + "\nWIDTH " + points +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
}

std::string message_of(const std::string& text,
                       Points (*parse)(std::string_view, const std::string&)) {
  try {
    (void)parse(text, "f");
  } catch (const ParseError& error) {
    return error.what();
  }
  return "";
}

TEST(Xyz, ReadsPointsAndPassesOverTheRest) {
  EXPECT_EQ(parse_xyz("# cloud\n0.1 -2.5 3 255 0 0\n\n 1e-3\t0 7.25 # last\n", "f"), kPoints);
}

TEST(Xyz, NamesTheLine) {
  EXPECT_EQ(message_of("0 0 0\n0 0\n", parse_xyz),
            "f:2: expected a finite coordinate, got the end of the line");
  EXPECT_EQ(message_of("0 0 nan\n", parse_xyz), "f:1: expected a finite coordinate, got 'nan'");
  EXPECT_EQ(message_of("# none\n", parse_xyz), "f: expected at least one point, found none");
}

// As scanners, spreadsheets and viewers of clouds write them.
TEST(Xyz, TakesSeparatorsAndHeaders) {
  for (const char* text :
       {"0.1,-2.5,3\n1e-3,0,7.25\n", "0.1, -2.5, 3, 255\n1e-3 ,0 , 7.25\n",
        "0.1;-2.5;3;9\r\n1e-3; 0 ; 7.25\r\n", "0.1\t-2.5\t3\n1e-3\t0\t7.25\t1\n",
        "//X Y Z R G B\n0.1 -2.5 3 1 2 3\n1e-3 0 7.25 1 2 3",
        "X Y Z Intensity\n0.1 -2.5 3 9\n1e-3 0 7.25 9\n",
        "\n\"x\",\"y\",\"z\"\n0.1,-2.5,3\n1e-3,0,7.25\n", "2\n0.1 -2.5 3\n1e-3 0 7.25\n",
        "\xef\xbb\xbf# a comment\n// a comment\nx y z\n2\n+0.1 -2.5 3 # one\n1e-3 0 7.25"}) {
    EXPECT_EQ(parse_xyz(text, "f"), kPoints) << text;
  }
}

TEST(Xyz, RefusesWhatWouldBeMisread) {
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {"0,1 2,5 3,0\n",
            "f:1: expected decimal points and one kind of separator, got '0,1 2,5 3,0'"},
           {"0,1;2,5;3,0\n",
            "f:1: expected decimal points and one kind of separator, got '0,1;2,5;3,0'"},
           {"1,,2,3\n", "f:1: expected a finite coordinate, got the end of the file"},
           {"intensity x y z\n1 2 3 4\n",
            "f:1: expected coordinates, or names of columns that begin with x y z, got 'intensity "
            "x y z'"},
           {"//R G B X Y Z\n1 2 3 4 5 6\n",
            "f:1: expected coordinates, or names of columns that begin with x y z, got '//R G B X "
            "Y Z'"},
           {"3\nwater\nO 0 0 0\nH 0 0 1\nH 0 1 0\n",
            "f:2: expected coordinates after the number of points, got 'water': files of atoms are "
            "not supported"},
           {"3\n\nO 0 0 0\nH 0 0 1\nH 0 1 0\n",
            "f:3: expected coordinates after the number of points, got 'O': files of atoms are not "
            "supported"},
           {"3\n0 0 0\n1 1 1\n", "f:1: count says 3, 2 points follow"},
           {"x y z\n", "f: expected at least one point, found none"},
           {"0 0 0\nx y z\n", "f:2: expected a finite coordinate, got 'x'"}}) {
    EXPECT_EQ(message_of(text, parse_xyz), message);
  }
}

TEST(Pcd, ReadsAscii) {
  const std::string text =
      header("rgb x y z n", "4 4 4 4 4", "U F F F F", "1 1 1 1 2", "2", "ascii") +
      "7 0.1 -2.5 3 0 0\n8 1e-3 0 7.25 0 0\n";
  EXPECT_EQ(parse_pcd(text, "f"), kPoints);
}

std::string binary_points() {
  std::string data;
  for (const Vector3d& p : kPoints) {
    data += bytes_of(static_cast<float>(p.z())) + bytes_of(p.x()) + bytes_of(std::uint16_t{7}) +
            bytes_of(p.y());
  }
  return data;
}

const std::string kBinaryHeader[] = {"z x r y", "4 8 2 8", "F F U F", "1 1 1 1", "2"};

std::string binary_header(const std::string& data) {
  const auto& h = kBinaryHeader;
  return header(h[0], h[1], h[2], h[3], h[4], data);
}

TEST(Pcd, ReadsBinary) {
  EXPECT_EQ(parse_pcd(binary_header("binary") + binary_points(), "f"), kPoints);
}

/// The points field by field, as LZF: literals of up to 32 bytes; or with copies.
std::string compressed_points(std::string fields) {
  std::string lzf;
  for (std::size_t k = 0; k < fields.size(); k += 32) {
    const std::string part = fields.substr(k, 32);
    lzf += static_cast<char>(part.size() - 1) + part;
  }
  return bytes_of(static_cast<std::uint32_t>(lzf.size())) +
         bytes_of(static_cast<std::uint32_t>(fields.size())) + lzf;
}

TEST(Pcd, ReadsCompressed) {
  std::string fields;
  for (const Vector3d& p : kPoints) fields += bytes_of(static_cast<float>(p.z()));
  for (const Vector3d& p : kPoints) fields += bytes_of(p.x());
  fields += "abcd";
  for (const Vector3d& p : kPoints) fields += bytes_of(p.y());
  EXPECT_EQ(parse_pcd(binary_header("binary_compressed") + compressed_points(fields), "f"),
            kPoints);
}

// 2 zero bytes, then copies of them: 3 to 8 at once, and more with a length byte.
TEST(Pcd, ReadsCopiesOfLzf) {
  const std::string lzf = std::string("\x01\0\0", 3) + std::string("\xe0\x19\x01", 3);
  const std::string text = header("x y z", "4 4 4", "F F F", "1 1 1", "3", "binary_compressed") +
                           bytes_of(std::uint32_t{6}) + bytes_of(std::uint32_t{36}) + lzf;
  EXPECT_EQ(parse_pcd(text, "f"), Points(3, Vector3d::Zero()));
}

TEST(Pcd, LeavesOutMissingPoints) {
  const std::string text = header("x y z", "4 4 4", "F F F", "1 1 1", "3", "ascii") +
                           "nan nan nan\n0.1 -2.5 3\n1e-3 0 7.25\n";
  EXPECT_EQ(parse_pcd(text, "f"), kPoints);
}

TEST(Pcd, TakesIntegers) {
  const std::string text = header("x y z", "1 2 4", "I I U", "1 1 1", "1", "binary") +
                           bytes_of(std::int8_t{-3}) + bytes_of(std::int16_t{-300}) +
                           bytes_of(std::uint32_t{4'000'000'000});
  EXPECT_EQ(parse_pcd(text, "f"), (Points{{-3, -300, 4e9}}));
}

TEST(Pcd, SaysWhatIsWrong) {
  const auto ascii = [](const std::string& rest) {
    return header("x y z", "4 4 4", "F F F", "1 1 1", "2", "ascii") + rest;
  };
  EXPECT_EQ(message_of("", parse_pcd),
            "f:1: expected a line DATA in the header, got the end of the file");
  EXPECT_EQ(message_of("SIZE 4\n", parse_pcd), "f:1: expected FIELDS before this line");
  EXPECT_EQ(message_of("FIELDS x y z\nSIZE 4 4 3\n", parse_pcd),
            "f:2: expected a size of 1, 2, 4 or 8 bytes, got 3");
  EXPECT_EQ(message_of("FIELDS x y\nSIZE 4 4\nPOINTS 1\nDATA ascii\n", parse_pcd),
            "f:4: expected one field z of count 1");
  EXPECT_EQ(message_of("FIELDS x y z\nDATA ascii\n", parse_pcd),
            "f:2: expected POINTS, or WIDTH and HEIGHT, of at least one point and below 2^32");
  EXPECT_EQ(message_of("FIELDS x y z\nWIDTH 2\nHEIGHT 2\nPOINTS 3\nDATA ascii\n", parse_pcd),
            "f:5: expected POINTS to be WIDTH times HEIGHT, 4, got 3");
  EXPECT_EQ(message_of(ascii("0 0 0\n"), parse_pcd),
            "f:13: expected point 2 of 2, got the end of the file");
  EXPECT_EQ(message_of(ascii("0 0 0\n0 0 x\n"), parse_pcd),
            "f:13: expected a finite coordinate, got 'x'");
  EXPECT_EQ(message_of(ascii("0 0 0\n0 0 0 0\n"), parse_pcd),
            "f:13: expected the end of the line, got '0'");
  EXPECT_EQ(message_of(ascii("nan 0 0\nnan 0 0\n"), parse_pcd),
            "f: expected at least one point, found none that is not NaN");
  const std::string binary = binary_header("binary");
  EXPECT_EQ(message_of(binary + "abc", parse_pcd),
            "f: byte " + std::to_string(binary.size()) +
                ": expected 44 bytes of points from here on, got 3");
}

// Whatever is cut off or changed: points or one line of error.
TEST(Pcd, SurvivesEveryChange) {
  std::string fields(44, '\0');
  for (const std::string& good : {binary_header("binary") + binary_points(),
                                  binary_header("binary_compressed") + compressed_points(fields)}) {
    for (std::size_t k = 0; k < good.size(); ++k) {
      (void)message_of(good.substr(0, k), parse_pcd);
      for (const char c : {'\0', '\xff', '9', ' '}) {
        std::string changed = good;
        changed[k] = c;
        (void)message_of(changed, parse_pcd);
      }
    }
  }
}

TEST(PlyPoints, NeedNoFaces) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty uchar red\nend_header\n0.1 -2.5 3 9\n1e-3 0 7.25 9\n";
  EXPECT_EQ(parse_ply_points(text, "f"), kPoints);
  const Mesh mesh{.vertices = kPoints, .triangles = {{0, 1, 1}}};
  EXPECT_EQ(parse_ply_points(test::to_binary_ply(mesh, true), "f"), kPoints);
  EXPECT_EQ(message_of("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float "
                       "y\nproperty float z\nend_header\n",
                       parse_ply_points),
            "f: expected at least one vertex, found none");
}

TEST(ReadPoints, ChoosesByTheEnding) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "cloud.XYZ";
  std::ofstream(path) << "0.1 -2.5 3\n1e-3 0 7.25\n";
  EXPECT_EQ(read_points(path), kPoints);
  const std::filesystem::path other = std::filesystem::path(testing::TempDir()) / "cloud.las";
  std::ofstream(other) << "";
  EXPECT_THROW((void)read_points(other), ParseError);
}

TEST(Heights, AreRowsOfNumbers) {
  const HeightMap map = parse_heights("0 1 2\n3 4 5\n", "f", {0.5, 0.25});
  EXPECT_EQ(map.columns, 3u);
  const Shape terrain = make_height_map(map);
  EXPECT_EQ(terrain.mesh().triangles.size(), 4u);
  EXPECT_EQ(terrain.mesh().vertices[5], Vector3d(1.0, 0.25, 5.0));
}

TEST(Heights, SayWhatIsWrong) {
  const auto parse = [](std::string_view text, const std::string& source) {
    (void)parse_heights(text, source, {1.0, 1.0});
    return Points();
  };
  EXPECT_EQ(message_of("0 1\n0 1 2\n", parse),
            "f:2: expected 2 heights as in the rows before, got 3");
  EXPECT_EQ(message_of("0 1\n", parse), "f: expected at least two rows of two heights");
  EXPECT_EQ(message_of("0 1\n0 inf\n", parse), "f:2: expected a finite height, got 'inf'");
}

TEST(PointCloud, NumbersItsPoints) {
  const Shape cloud = make_point_cloud(kPoints, 0.5);
  EXPECT_EQ(cloud.mesh().triangles[1], (std::array<std::uint32_t, 3>{1, 1, 1}));
  EXPECT_EQ(cloud.component_vertices().size(), 2u);
  EXPECT_EQ(cloud.radius(), 0.5);
}

}  // namespace
}  // namespace firstcontact
