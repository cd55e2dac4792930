// Warnings about the start of a scene: bodies inside surfaces, and units.

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

// Both geometries of the link have the can inside: it is one body inside of one link.
TEST_F(StartWarnings, NameEachBodyOnceInsideOfALink) {
  write_box("inner.off", {1.0, 1.0, 0.9});
  write_box("outer.off", {2.0, 2.0, 1.0});
  std::ofstream(folder_ / "bot.urdf") << R"(<robot name="bot"><link name="shell">
    <collision><geometry><mesh filename="inner.off"/></geometry></collision>
    <collision><geometry><mesh filename="outer.off"/></geometry></collision></link></robot>)";
  const std::string robots = R"(, "robots": [{"name": "bot", "urdf": "bot.urdf"}])";
  const std::string surface =
      " inside the closed mesh of \"bot/shell\", a surface that only its triangles touch\n";
  EXPECT_EQ(warnings(ball("can"), robots), "\"can\" begins" + surface);
  EXPECT_EQ(warnings(ball("a") + "," + ball("b"), robots), "\"a\", \"b\" begin" + surface);
  EXPECT_EQ(warnings(ball("a") + "," + ball("b") + "," + ball("c") + "," + ball("d"), robots),
            "\"a\", \"b\", \"c\" and 1 more begin" + surface);
}

// Links of 100 m and bodies of 1,000 m; what is said in numbers may have any size.
TEST_F(StartWarnings, AskOfWhatIsImplausiblyLarge) {
  write_box("plate.off", {2000.0, 1.0, 1.0});
  EXPECT_NE(warnings(mesh("plate", R"(, "solid": true)")).find("body \"plate\" is 2000 m across"),
            std::string::npos);
  std::ofstream(folder_ / "bot.urdf") << R"(<robot name="bot"><link name="mast">
    <collision><geometry><sphere radius="51"/></geometry></collision></link></robot>)";
  const std::string said =
      warnings(ball("far", "9"), R"(, "robots": [{"name": "bot", "urdf": "bot.urdf",
                                     "base": {"position": [0, 0, 500]}}])");
  EXPECT_EQ(said, "bot: link \"mast\" is 102 m across: is its unit right?\n");
  EXPECT_EQ(warnings(ball("globe", "6e6")), "");
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
