// What looks wrong where a scene begins: bodies inside of surfaces, and units.

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/read_scene.h>

namespace firstcontact {
namespace {

/// A folder with OFF files of boxes.
class StartWarnings : public testing::Test {
 protected:
  StartWarnings() { std::filesystem::create_directories(folder_); }
  ~StartWarnings() override { std::filesystem::remove_all(folder_); }

  void write_box(const std::string& name, const Eigen::Vector3d& size) const {
    const Mesh mesh = make_box(size).mesh();
    std::ofstream file(folder_ / name);
    file << "OFF\n" << mesh.vertices.size() << ' ' << mesh.triangles.size() << " 0\n";
    for (const Eigen::Vector3d& v : mesh.vertices) {
      file << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    }
    for (const auto& t : mesh.triangles) {
      file << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    }
  }

  static std::string ball(const std::string& name, const std::string& radius = "0.03") {
    return R"({"name": ")" + name + R"(", "shape": {"sphere": {"radius": )" + radius +
           R"(}}, "motion": {"type": "constant_velocity", "from": {}, "translation": [0.1, 0, 0]}})";
  }

  static std::string mesh(const std::string& name, const std::string& more = "") {
    return R"({"name": ")" + name + R"(", "shape": {"mesh": ")" + name + R"(.off")" + more + "}}";
  }

  /// All warnings, a line each.
  std::string warnings(const std::string& bodies, const std::string& more = "") const {
    ShapeCache cache;
    const LoadedScene loaded =
        load_scene(parse_scene(R"({"firstcontact": 1, "bodies": [)" + bodies + "]" + more + "}",
                               folder_ / "s.json"),
                   cache);
    std::string text;
    for (const std::string& warning : loaded.warnings) {
      text += warning + "\n";
    }
    return text;
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("start." + std::to_string(getpid()));
};

// A can in the middle of a closed table: free by the letter, and not what anyone means.
TEST_F(StartWarnings, NameWhatBeginsInsideOfAClosedMesh) {
  write_box("table.off", {2.0, 2.0, 1.0});
  EXPECT_EQ(warnings(ball("can") + "," + mesh("table")),
            "\"can\" begins inside the closed mesh of \"table\", a surface that only its triangles "
            "touch; \"solid\": true in its shape fills it\n");
  EXPECT_EQ(warnings(ball("a") + "," + ball("b") + "," + mesh("table"),
                     R"(, "pairs": {"ignore": [["a", "b"]]})"),
            "\"a\", \"b\" begin inside the closed mesh of \"table\", a surface that only its "
            "triangles touch; \"solid\": true in its shape fills it\n");
}

TEST_F(StartWarnings, SayNothingOfSolidsIgnoredPairsAndOpenMeshes) {
  write_box("table.off", {2.0, 2.0, 1.0});
  EXPECT_EQ(warnings(ball("can") + "," + mesh("table", R"(, "solid": true)")), "");
  EXPECT_EQ(
      warnings(ball("can") + "," + mesh("table"), R"(, "pairs": {"ignore": [["can", "table"]]})"),
      "");
  std::ofstream(folder_ / "table.off") << "OFF\n4 3 0\n-3 -3 -1\n3 -3 -1\n0 3 -1\n0 0 2\n"
                                          "3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  EXPECT_EQ(warnings(ball("can") + "," + mesh("table")), "");
}

// Most STL files are written in millimetres; read as metres a post is 50 m thick.
TEST_F(StartWarnings, JudgeUnitsBesideTheOthers) {
  write_box("post.off", {50.0, 50.0, 600.0});
  const std::string said = warnings(ball("ball") + "," + mesh("post", R"(, "solid": true)"));
  EXPECT_NE(said.find("body \"post\" is 604.1"), std::string::npos) << said;
  EXPECT_NE(said.find("times as much as body \"ball\": is its unit right?"), std::string::npos);
  EXPECT_NE(said.find("\"scale\": 0.001 reads it so (--environment-scale 0.001 on the command "
                      "line, scale=0.001 in Python)"),
            std::string::npos);
  EXPECT_EQ(warnings(ball("ball") + "," + mesh("post", R"(, "solid": true, "scale": 0.001)")), "");
}

TEST_F(StartWarnings, AskOfAHallOnlyWhatIsLikely) {
  write_box("hall.off", {60.0, 40.0, 9.0});  // Beside an arm of 1 m.
  EXPECT_EQ(warnings(ball("arm", "0.5") + "," + mesh("hall", R"(, "solid": true)")), "");
  const std::string box = R"({"name": "ground", "shape": {"box": {"size": [900, 900, 1]}}})";
  EXPECT_EQ(warnings(ball("arm", "0.5") + "," + box), "");  // Its size stands in the scene.
}

TEST_F(StartWarnings, AskWhereNothingIsAsLargeAsTheTolerance) {
  const std::string said = warnings(ball("a", "1e-8") + "," + ball("b", "2e-8"));
  EXPECT_NE(said.find("nothing is as large as the tolerance of 1e-06 m; the largest, body \"b\", "
                      "is 4e-08 m across"),
            std::string::npos)
      << said;
  EXPECT_EQ(warnings(ball("a", "1e-8") + "," + ball("b", "2e-6")), "");
}

}  // namespace
}  // namespace firstcontact
