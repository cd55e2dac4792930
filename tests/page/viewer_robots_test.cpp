// The viewer moves robots by itself. Its tests and these hold to one page and to one list of poses.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/page/write_page.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/detail/result_json.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::JsonArray;
using detail::JsonObject;
using detail::JsonValue;

const std::filesystem::path kStored = FIRSTCONTACT_SOURCE_DIR "/viewer/tests/data/robot_poses.json";
constexpr std::array kTimes = {0.0, 0.1, 0.3, 0.45, 0.6, 0.7, 0.95, 1.0};

Eigen::Quaterniond turned(double x, double y, double z) {
  const Eigen::Vector3d v(x, y, z);
  return Eigen::Quaterniond(Eigen::AngleAxisd(v.norm(), v.normalized()));
}

Link link(const std::string& name, double radius) {
  Link link{.name = name, .visual = {}, .collision = {}};
  link.collision.push_back({.name = "",
                            .X_LG = {.position = {0.0, 0.1, 0.0}, .rotation = turned(0.2, 0.1, 0)},
                            .source = SphereGeometry{radius},
                            .shape = make_sphere(radius)});
  return link;
}

/// A joint of every type, each with an axis and a place of its own.
RobotModel every_joint() {
  RobotDescription robot{.name = "zoo", .links = {}, .joints = {}};
  for (const char* name :
       {"ground", "cart", "mast", "hook", "bit", "weight", "plate", "eye", "drone", "rotor"}) {
    robot.links.push_back(link(name, 0.1));
  }
  const auto add = [&robot](const char* name, JointType type, const char* parent, const char* child,
                            const Eigen::Vector3d& axis) -> Joint& {
    const double k = static_cast<double>(robot.joints.size());
    robot.joints.push_back({.name = name,
                            .type = type,
                            .parent = parent,
                            .child = child,
                            .X_PJ = {.position = {0.3 + 0.1 * k, -0.2, 0.1 * k},
                                     .rotation = turned(0.1 * k, 0.3, -0.2)},
                            .axis = axis});
    return robot.joints.back();
  };
  add("rotor", JointType::continuous, "drone", "rotor", {0, 2, 1});
  add("rail", JointType::planar, "ground", "cart", {1, 2, -3});
  add("turn", JointType::revolute, "cart", "mast", {0, 0, 1}).limits = {-2.0, 2.0, 4.0, 1.0};
  add("lift", JointType::prismatic, "mast", "hook", {1, 1, 0}).limits = {-1.0, 1.0, 4.0, 1.0};
  add("bore", JointType::screw, "hook", "bit", {0, 1, 0}).pitch = 0.02;
  add("follow", JointType::prismatic, "mast", "weight", {0, 0, 1}).mimic = Mimic{"lift", 0.5, 0.1};
  add("weld", JointType::fixed, "mast", "plate", {1, 0, 0});
  add("look", JointType::ball, "plate", "eye", {1, 0, 0});
  add("fly", JointType::floating, "eye", "drone", {1, 0, 0});
  return RobotModel(robot);
}

RobotMotion every_motion() {
  const std::vector<double> times = {0.1, 0.5, 0.9};
  const std::vector<double> q = {0.2, -0.7, 1.1};
  const std::vector<double> v = {0.0, 3.0, -1.0};
  const std::vector<double> a = {1.0, 0.0, 2.0};
  const std::vector<double> halves = {0.0, 0.5, 1.0};
  const std::vector<std::vector<double>> pieces = {{1.0, 2.0, -4.0, 8.0, 16.0}, {3.0, 1.0}};
  const std::vector<Pose> poses = {{.position = {0, 0, 0.4}, .rotation = turned(0, 0.4, 0)},
                                   {.position = {0.5, 0, 0.6}, .rotation = turned(1, 0.4, 0)},
                                   {.position = {0.5, 1, 0.2}, .rotation = turned(0, 2.4, 1)}};
  return {every_joint(),
          {{"rail", PlanarPath{CoordinatePath::linear(times, q), CoordinatePath::constant(0.3),
                               CoordinatePath::cubic(times, q, v)}},
           {"turn", CoordinatePath::quintic(times, q, v, a)},
           {"lift", CoordinatePath::cubic(times, q, v)},
           {"bore", CoordinatePath::linear(times, std::vector<double>{0.0, 40.0, -3.0})},
           {"rotor", CoordinatePath::polynomials(halves, pieces)},
           {"look", Motion::constant_velocity({.rotation = turned(0.3, 0, 0)},
                                              Eigen::Vector3d::Zero(), {1, -2, 9})},
           {"fly", Motion::waypoints(times, poses, Between::screw)}},
          Motion::screw({.position = {4, 0, 0}, .rotation = turned(0, 0, 1)}, {3, 1, 0}, {0, 1, 4},
                        2.0, 0.3)};
}

/// The robot takes up a body that moves, and puts it down.
LoadedScene every_joint_and_a_load() {
  LoadedScene loaded;
  loaded.scene = parse_scene(R"({"firstcontact": 1, "id": "every joint", "bodies": [{"name": "load",
      "shape": {"sphere": {"radius": 0.2}}, "motion": {"type": "constant_velocity",
      "from": {"position": [4, 2, 1]}, "translation": [0, 1, 0], "rotation_vector": [0, 0, 2]}}]})",
                             "scene");
  RobotScene robots;
  const Body& load = loaded.scene.bodies[0];
  const std::size_t body =
      robots.add_body(load.name, make_sphere(0.2), normalised_motion(load.motion, 1.0));
  robots.add_robot("zoo", every_motion());
  robots.attach(
      {.body = body, .link = *robots.find_member("zoo/hook"), .t_from = 0.3, .t_to = 0.7});
  loaded.robots = std::make_shared<const RobotScene>(std::move(robots));
  return loaded;
}

/// As check would write it of a scene that is free.
std::string page_of(const LoadedScene& loaded) {
  const std::string result =
      R"({"id":"every joint","verdict":"free","reason":null,"t":1,"t_upper":null,"time":1,)"
      R"("pair":null,"contacts":[],"clearance":0,"version":"","scene":)" +
      write_scene(loaded.scene) + "}";
  return write_page("\"FIRSTCONTACT_RESULT\"", loaded, result, {});
}

JsonValue array_of(const auto& numbers) {
  JsonArray array;
  for (const double number : numbers) {
    array.push_back(detail::to_json(number));
  }
  return {.value = std::move(array)};
}

JsonValue poses_of(const RobotScene& robots) {
  JsonArray poses;
  for (std::size_t member = 0; member < robots.size(); ++member) {
    for (const double t : kTimes) {
      const Pose pose = robots.pose(member, t);
      const Eigen::Quaterniond& q = pose.rotation;
      poses.push_back({.value = JsonObject{
                           {"body", detail::to_json(robots.name(member))},
                           {"t", detail::to_json(t)},
                           {"position", array_of(pose.position)},
                           {"quaternion_wxyz", array_of(std::array{q.w(), q.x(), q.y(), q.z()})}}});
    }
  }
  return {.value = std::move(poses)};
}

void expect_same(const JsonValue& value, const JsonValue& stored, const std::string& place) {
  ASSERT_EQ(value.value.index(), stored.value.index()) << place;
  if (const auto* number = std::get_if<double>(&value.value)) {
    // Other compilers round sines otherwise.
    EXPECT_NEAR(*number, std::get<double>(stored.value), 1e-14 * (1.0 + std::abs(*number)))
        << place;
  } else if (const auto* text = std::get_if<std::string>(&value.value)) {
    EXPECT_EQ(*text, std::get<std::string>(stored.value)) << place;
  } else if (const auto* array = std::get_if<JsonArray>(&value.value)) {
    const auto& other = std::get<JsonArray>(stored.value);
    ASSERT_EQ(array->size(), other.size()) << place;
    for (std::size_t k = 0; k < array->size(); ++k) {
      expect_same((*array)[k], other[k], place + "[" + std::to_string(k) + "]");
    }
  } else if (const auto* object = std::get_if<JsonObject>(&value.value)) {
    const auto& other = std::get<JsonObject>(stored.value);
    ASSERT_EQ(object->size(), other.size()) << place;
    for (std::size_t k = 0; k < object->size(); ++k) {
      ASSERT_EQ((*object)[k].key, other[k].key) << place;
      expect_same((*object)[k].value, other[k].value, place + "." + other[k].key);
    }
  }
}

// FIRSTCONTACT_NEW_POSES names a file to be written anew, after a change of what a page holds.
TEST(Robot, IsWhereTheViewerShowsIt) {
  const LoadedScene loaded = every_joint_and_a_load();
  const JsonValue now = {
      .value =
          JsonObject{{"note",
                      {.value = std::string("A robot with every joint. Both the library "
                                            "(tests/scene) and the viewer must reproduce it.")}},
                     {"page", detail::parse_json(page_of(loaded), "page")},
                     {"poses", poses_of(*loaded.robots)}}};
  if (const char* file = std::getenv("FIRSTCONTACT_NEW_POSES")) {
    std::ofstream(file) << detail::write_json(now) << '\n';
  }
  std::ifstream file(kStored);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  expect_same(now, detail::parse_json(text, kStored.string()), "page");
}

}  // namespace
}  // namespace firstcontact
