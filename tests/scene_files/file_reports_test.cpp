#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/robot_question.h>
#include <firstcontact/scene_files/write_reports.h>
#include <firstcontact/scene_files/write_result.h>
#include <firstcontact/scene_files/write_scene.h>

#include "scene/robot_text.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

constexpr const char* kArm =
    R"({"firstcontact": 1, "robots": [{"name": "arm", "urdf": "arm.urdf", "srdf": "arm.srdf",
        "trajectory": "move.csv"}]})";

std::vector<std::string> formats_of(const LoadedScene& loaded) {
  std::vector<std::string> formats;
  for (const FileReport& report : loaded.files) {
    formats.push_back(report.format);
  }
  return formats;
}

TEST(FileReports, AreThereForEveryFileOfAScene) {
  const test::ArmFolder folder;
  ShapeCache cache;
  const LoadedScene loaded = load_scene(parse_scene(kArm, folder.path() / "s.json"), cache);
  const std::vector<std::string> expected = {"trajectory", "URDF", "SRDF"};
  EXPECT_EQ(formats_of(loaded), expected);
  ManyBodiesWorkspace workspace;
  const std::string json = write_result(loaded, check_scene(loaded, workspace));
  EXPECT_NE(json.find(R"("format":"trajectory","contents":[{"what":"joints","count":1},)"
                      R"({"what":"points","count":2}])"),
            std::string::npos)
      << json;
}

TEST(FileReports, AreThereForTheFilesOfAQuestion) {
  const test::ArmFolder folder;
  ShapeCache cache;
  const LoadedScene loaded =
      load_scene(read_robot_question({.robot = {.urdf = folder.path() / "arm.urdf"},
                                      .srdf = folder.path() / "arm.srdf",
                                      .trajectory = folder.path() / "move.csv"}),
                 cache);
  const std::vector<std::string> expected = {"trajectory", "URDF", "SRDF"};
  EXPECT_EQ(formats_of(loaded), expected);
}

TEST(FileReports, BringTheirWarnings) {
  const test::ArmFolder folder;
  folder.write("arm.srdf", R"(<robot name="arm"><group name="all"><joint name="elbow"/></group>
    <group_state name="half" group="all"><joint name="elbow" value="0.5"/><joint name="weld" value="1"/>
    </group_state></robot>)");
  ShapeCache cache;
  const LoadedScene loaded =
      load_scene(read_robot_question({.robot = {.urdf = folder.path() / "arm.urdf"},
                                      .srdf = folder.path() / "arm.srdf",
                                      .start = {"half"},
                                      .goal = {"elbow=1"}}),
                 cache);
  int told = 0;
  for (const std::string& warning : loaded.warnings) {
    told += warning.find("weld") == std::string::npos ? 0 : 1;
  }
  EXPECT_EQ(told, 1) << "the joint is fixed";
}

TEST(FileReports, AreWrittenWithWhatThereIs) {
  FileReport report;
  report.path = "a.glb";
  report.format = "GLB";
  report.contents = {{"triangles", 12}};
  EXPECT_EQ(write_file_reports({&report, 1}),
            R"([{"path":"a.glb","format":"GLB","contents":[{"what":"triangles","count":12}]}])");
  report.unit = "1 m";
  report.left_out = {{"KHR_lights_punctual", "looks", 2}};
  report.warnings = {"a.glb: one thing"};
  report.also_read = {"a.bin"};
  EXPECT_EQ(
      write_file_reports({&report, 1}),
      R"([{"path":"a.glb","format":"GLB","contents":[{"what":"triangles","count":12}],)"
      R"("unit":"1 m","left_out":[{"name":"KHR_lights_punctual","reason":"looks","count":2}],)"
      R"("warnings":["a.glb: one thing"],"also_read":["a.bin"]}])");
}

// A result holds its scene, and is read again by what that says.
TEST(LenientReading, StaysWithTheScene) {
  const std::string plain = test::scene(test::body("a"));
  EXPECT_FALSE(parse_scene(plain, "s").options.lenient);
  EXPECT_EQ(write_scene(parse_scene(plain, "s")).find("lenient"), std::string::npos);
  const Scene asked = parse_scene(plain, "s", 1, {.lenient = true});
  EXPECT_TRUE(asked.options.lenient);
  EXPECT_TRUE(parse_scene(write_scene(asked), "s").options.lenient);
  const std::string own = test::scene(test::body("a"), R"("options": {"lenient": true})");
  EXPECT_TRUE(parse_scene(own, "s").options.lenient);
}

TEST(EnvironmentScale, IsOfMeshesOfTheSurroundings) {
  const test::ArmFolder folder;
  folder.write("post.off", "OFF\n3 1 0\n0 0 9000\n1 0 9000\n0 1 9000\n3 0 1 2\n");
  const Scene scene = read_robot_question({.robot = {.urdf = folder.path() / "arm.urdf"},
                                           .environment = {folder.path() / "post.off"},
                                           .environment_scale = 0.001});
  ShapeCache cache;
  const LoadedScene loaded = load_scene(scene, cache);
  EXPECT_EQ(loaded.robots->geometries(0).front().shape.mesh().vertices[0].z(), 9.0);
}

}  // namespace
}  // namespace firstcontact
