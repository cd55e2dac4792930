// DAE, whose parser is the assimp library's: good files, and every way to cut them off.

#include <unistd.h>

#include <clocale>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <locale>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/text/parse_error.h>

#include "mesh_files/mesh_text.h"

/// Assimp leaks what it has read of a file that it then refuses.
/// Visible, so that a sanitizer in a library of its own finds it.
extern "C" [[gnu::visibility("default")]] const char* __lsan_default_suppressions();  // NOLINT
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }     // NOLINT

namespace firstcontact {
namespace {

std::string dae(const std::string& positions = "0 0 0 1 0 0 0 1 0",
                const std::string& indices = "0 1 2") {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">)" +
         positions + R"(</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>)" +
         indices + R"(</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>0.5 0 0</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
}

/// A file of the test's own; ctest runs each test in a process of its own.
class AssimpMesh : public testing::TestWithParam<const char*> {
 protected:
  ~AssimpMesh() override { std::filesystem::remove(path_); }

  Mesh read(const std::string& extension, const std::string& bytes) {
    std::filesystem::remove(path_);
    path_ = std::filesystem::path(testing::TempDir()) /
            ("assimp_" + std::to_string(::getpid()) + extension);
    std::ofstream(path_, std::ios::binary) << bytes;
    return read_mesh(path_);
  }

  /// A mesh or one clear line.
  bool is_read(const std::string& extension, const std::string& bytes) {
    try {
      EXPECT_FALSE(read(extension, bytes).triangles.empty());
      return true;
    } catch (const ParseError& error) {
      const std::string line = error.what();
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
      EXPECT_EQ(line.find(path_.string()), 0u) << line;
      EXPECT_GT(line.size(), path_.string().size() + 10) << line;
      return false;
    }
  }

  std::filesystem::path path_;
};

void expect_triangle(const Mesh& mesh) {
  ASSERT_EQ(mesh.triangles.size(), 1u);
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[mesh.triangles[0][1]], Eigen::Vector3d(1.5, 0.0, 0.0));
}

TEST_P(AssimpMesh, IsReadWithItsTransform) { expect_triangle(read(GetParam(), dae())); }

TEST_P(AssimpMesh, DoesNotHeedTheLocale) {
  struct CommaDecimal : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaDecimal));
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // Where it is installed.
  const Mesh mesh = read(GetParam(), dae());
  std::setlocale(LC_ALL, "C");
  std::locale::global(before);
  expect_triangle(mesh);
}

TEST_P(AssimpMesh, IsAMeshOrOneLineHoweverCutOff) {
  const std::string whole = dae();
  int read_anyhow = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    SCOPED_TRACE(size);
    read_anyhow += is_read(GetParam(), whole.substr(0, size)) ? 1 : 0;
  }
  EXPECT_LE(read_anyhow, 16);  // Without its last spaces a file is whole.
}

TEST_P(AssimpMesh, IsAMeshOrOneLineWithAnyByteChanged) {
  const std::string whole = dae();
  std::mt19937 random(1);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    SCOPED_TRACE(i);
    std::string bytes = whole;
    bytes[i] = static_cast<char>(random());
    is_read(GetParam(), bytes);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, AssimpMesh, testing::Values(".dae"),
                         [](const auto& parameter) { return std::string(parameter.param + 1); });

class Dae : public AssimpMesh {};

TEST_F(Dae, ThatNamesWhatIsNotThereIsRefused) {
  EXPECT_FALSE(is_read(".dae", ""));
  EXPECT_FALSE(is_read(".dae", "<COLLADA/>"));
  EXPECT_FALSE(is_read(".dae", dae("0 0 0 1 0 0 0 1 0", "0 1 9")));
  EXPECT_FALSE(is_read(".dae", dae("0 0 0 1 0 0")));
  EXPECT_FALSE(is_read(".dae", dae("0 0 0 1 0 0 0 1 nan")));
  EXPECT_FALSE(is_read(".dae", dae("0 0 0 1 0 0 0 1 0", "1e308 1 2")));
  EXPECT_FALSE(is_read(".dae", dae("0 0 0 1 0 0 0 1 0", "0 1 -2")));
  // An accessor that goes past its array.
  for (const char* const wrong :
       {"count=\"3\" stride=\"999999999\"", "count=\"4\" stride=\"3\"", "count=\"3\" stride=\"4\"",
        "count=\"3\" stride=\"3\" offset=\"1\"", "count=\"9\" stride=\"1\"", "stride=\"3\"",
        "count=\"3\" stride=\"-3\"", "count=\"18446744073709551615\" stride=\"3\""}) {
    std::string text = dae();
    constexpr std::string_view kRight = "count=\"3\" stride=\"3\"";
    text.replace(text.find(kRight), kRight.size(), wrong);
    EXPECT_FALSE(is_read(".dae", text)) << wrong;
  }
}

}  // namespace
}  // namespace firstcontact
