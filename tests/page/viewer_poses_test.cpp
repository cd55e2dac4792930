// The viewer evaluates motions by itself. Its tests and these hold to one list of poses.

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::JsonArray;
using detail::JsonObject;
using detail::JsonValue;

const JsonValue& member(const JsonValue& object, const char* key) {
  return *detail::find(std::get<JsonObject>(object.value), key);
}

double number(const JsonValue& value, std::size_t index) {
  return std::get<double>(std::get<JsonArray>(value.value).at(index).value);
}

TEST(Motion, IsWhereTheViewerShowsIt) {
  const std::filesystem::path path = FIRSTCONTACT_SOURCE_DIR "/viewer/tests/data/poses.json";
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const JsonValue root = detail::parse_json(text, path.string());
  const Scene scene = parse_scene(detail::write_json(member(root, "scene")), path);
  const auto& poses = std::get<JsonArray>(member(root, "poses").value);
  ASSERT_EQ(poses.size(), 8 * scene.bodies.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Body& body = scene.bodies[k / 8];
    ASSERT_EQ(std::get<std::string>(member(poses[k], "body").value), body.name);
    const double t = std::get<double>(member(poses[k], "t").value);
    const Pose pose = normalised_motion(body.motion, scene.duration).pose(t);
    const JsonValue& p = member(poses[k], "position");
    const JsonValue& q = member(poses[k], "quaternion_wxyz");
    const Eigen::Vector3d position(number(p, 0), number(p, 1), number(p, 2));
    const Eigen::Quaterniond rotation(number(q, 0), number(q, 1), number(q, 2), number(q, 3));
    EXPECT_LE((pose.position - position).norm(), 2e-14 * position.norm()) << body.name << " " << t;
    EXPECT_LE((pose.rotation.toRotationMatrix() - rotation.toRotationMatrix()).norm(), 1e-13)
        << body.name << " " << t;
  }
}

}  // namespace
}  // namespace firstcontact
