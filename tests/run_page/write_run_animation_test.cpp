// The animation moves every vertex as the run does, at keys and between them.

#include <firstcontact/run_page/write_run_animation.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>

#include "record/recorded_run.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

constexpr const char* kAnimatedScene =
    R"({"firstcontact": 1, "simulation": {"duration": 4}, "bodies": [
    {"name": "box", "shape": {"box": {"size": [1, 2, 3]}}, "dynamics": {}},
    {"name": "ball", "shape": {"sphere": {"radius": 0.5}}, "pose": {"position": [7, 0, 0]}},
    {"name": "floor", "shape": {"box": {"size": [9, 9, 0.2]}}, "pose": {"position": [0, 0, -3]}},
    {"name": "wall", "shape": {"box": {"size": [9, 9, 0.2]}}, "pose": {"position": [0, 9, 0]}}]})";

std::string animation_of(const test::RecordedRun& run) {
  RunAnimation animation(run.header);
  for (const RunStep& step : run.steps) {
    animation.add(step);
  }
  ShapeCache cache;
  return animation.write(load_scene(run.header.scene, cache));
}

/// The parts of a .glb, read by the specification.
class Glb {
 public:
  explicit Glb(const std::string& file) {
    EXPECT_EQ(file.substr(0, 4), "glTF");
    EXPECT_EQ(number(file, 4), 2u);
    EXPECT_EQ(number(file, 8), file.size());
    const std::uint32_t size = number(file, 12);
    EXPECT_EQ(size % 4, 0u);
    EXPECT_EQ(file.substr(16, 4), "JSON");
    document = json::parse(file.substr(20, size));
    const std::uint32_t binary = number(file, 20 + size);
    EXPECT_EQ(file.substr(24 + size, 4), std::string("BIN\0", 4));
    EXPECT_EQ(28 + size + binary, file.size());
    bytes_ = file.substr(28 + size);
  }

  [[nodiscard]] std::vector<float> floats(std::size_t accessor) const {
    const json& it = document["accessors"][accessor];
    EXPECT_EQ(it["componentType"], 5126);
    const json& view = document["bufferViews"][it["bufferView"].get<std::size_t>()];
    std::vector<float> numbers(view["byteLength"].get<std::size_t>() / 4);
    std::memcpy(numbers.data(), bytes_.data() + view["byteOffset"].get<std::size_t>(),
                4 * numbers.size());
    return numbers;
  }

  [[nodiscard]] std::size_t node(const std::string& name) const {
    const json& nodes = document["nodes"];
    const auto found = std::find_if(nodes.begin(), nodes.end(),
                                    [&](const json& one) { return one.value("name", "") == name; });
    return static_cast<std::size_t>(found - nodes.begin());
  }

  /// The row that moves a property of a node; empty where none does.
  [[nodiscard]] std::array<std::vector<float>, 2> track(std::size_t node,
                                                        const std::string& path) const {
    for (const json& channel : document["animations"][0]["channels"]) {
      if (channel["target"]["node"] == node && channel["target"]["path"] == path) {
        const json& sampler =
            document["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
        EXPECT_EQ(sampler["interpolation"], "LINEAR");
        return {floats(sampler["input"].get<std::size_t>()),
                floats(sampler["output"].get<std::size_t>())};
      }
    }
    return {};
  }

  /// A node's pose at a time, as a player computes it: linear, and slerp the short way.
  [[nodiscard]] Pose pose(std::size_t node, double time) const {
    const auto [times, places] = track(node, "translation");
    const auto [same, turns] = track(node, "rotation");
    EXPECT_EQ(times, same);
    EXPECT_TRUE(std::is_sorted(times.begin(), times.end(), std::less_equal<>()));
    const auto place = [&places = places](std::size_t k) {
      return Vector3d(places[3 * k], places[3 * k + 1], places[3 * k + 2]);
    };
    const auto turn = [&turns = turns](std::size_t k) {
      return Eigen::Quaterniond(turns[4 * k + 3], turns[4 * k], turns[4 * k + 1], turns[4 * k + 2]);
    };
    std::size_t k = 0;
    while (k + 2 < times.size() && times[k + 1] <= time) {
      ++k;
    }
    const double share = std::clamp((time - times[k]) / (times[k + 1] - times[k]), 0.0, 1.0);
    return {place(k) + share * (place(k + 1) - place(k)), turn(k).slerp(share, turn(k + 1))};
  }

  json document;

 private:
  static std::uint32_t number(const std::string& file, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(file.at(at + k))) << (8 * k);
    }
    return value;
  }

  std::string bytes_;
};

TEST(RunAnimation, MovesAsTheRunDoes) {
  test::RecordedRun run(kAnimatedScene);
  const Vector3d centre(0.3, -0.2, 0.1);
  run.header.centres_of_mass[0] = centre;
  run.add({{0,
            {{.lasts = 0.5, .velocity = {2, 0, 0}, .angular_velocity = {0, 9, 0}},
             {.lasts = 1e-12, .velocity = {0, 5, 0}},
             {.lasts = 0.5, .velocity = {0, 1, 0}, .angular_velocity = {3, 0, -20}}}}});
  run.add({}).lasted = 1.0;  // Left out, it stays.
  run.steps.back().time = 2.0;
  run.add({{0, {{.lasts = 1.0, .angular_velocity = {0, 0, std::numbers::pi}}}}});
  const Glb glb(animation_of(run));
  const std::size_t node = glb.node("box");

  double begin = 0.0;
  int compared = 0;
  for (const RunStep& step : run.steps) {
    for (const RunBody& moved : step.bodies) {
      double from = 0.0;
      for (const RunPiece& piece : moved.pieces) {
        const std::vector<ConstantRatePiece> one{
            {1.0, piece.X_WB, piece.translation, piece.rotation_vector}};
        const Motion motion = Motion::constant_rates(one, centre);
        for (const double share : {0.01, 0.3, 0.6, 0.99}) {
          if (piece.to - from > 1e-6) {
            const Pose seen = glb.pose(node, begin + from + share * (piece.to - from));
            for (const Vector3d& point : {Vector3d(0.5, 1, 1.5), Vector3d(-0.5, 1, -1.5)}) {
              const Pose pose = motion.pose(share);
              const Vector3d right = pose.position + pose.rotation.normalized() * point;
              const Vector3d shown = seen.position + seen.rotation.normalized() * (point - centre);
              EXPECT_LE((shown - right).norm(), 1e-5) << begin + from << " " << share;
              ++compared;
            }
          }
        }
        from = piece.to;
      }
    }
    begin = step.time;
  }
  EXPECT_EQ(compared, 24);
  const Pose rest = glb.pose(node, 1.5);
  EXPECT_LE((rest.position - glb.pose(node, 1.0).position).norm(), 1e-6);
}

TEST(RunAnimation, HasEveryBodyAndEachLookOnce) {
  test::RecordedRun run(kAnimatedScene);
  run.add({{0, {{.lasts = 1.0, .velocity = {1, 0, 0}}}}, {3, {{.lasts = 1.0}}}});
  const Glb glb(animation_of(run));
  const json& document = glb.document;
  EXPECT_EQ(document["asset"]["version"], "2.0");
  EXPECT_EQ(document["nodes"].size(), 9u);  // Two of each body, and the world.
  const auto mesh_of = [&](const char* name) -> json {
    const std::size_t child = document["nodes"][glb.node(name)]["children"][0];
    return document["meshes"][document["nodes"][child]["mesh"].get<std::size_t>()]["primitives"][0];
  };
  // The floor and the wall are one shape in two colours: the numbers are there once.
  EXPECT_EQ(mesh_of("floor")["attributes"], mesh_of("wall")["attributes"]);
  EXPECT_EQ(mesh_of("box")["material"], 0);
  EXPECT_EQ(mesh_of("wall")["material"], 1);
  EXPECT_EQ(mesh_of("floor")["material"], 2);
  // The floor rests where the scene has it.
  EXPECT_EQ(document["nodes"][glb.node("floor")]["translation"], json({0.0, 0.0, -3.0}));
  EXPECT_TRUE(glb.track(glb.node("floor"), "translation")[0].empty());
  // Gravity along -z becomes -y.
  const json world = document["nodes"][glb.node("world")]["rotation"];
  const Eigen::Quaterniond turn(world[3], world[0], world[1], world[2]);
  EXPECT_LE((turn * Vector3d::UnitZ() - Vector3d::UnitY()).norm(), 1e-6);
  // All vertices of the ball are on it.
  const std::vector<float> ball =
      glb.floats(mesh_of("ball")["attributes"]["POSITION"].get<std::size_t>());
  ASSERT_GT(ball.size(), 300u);
  for (std::size_t k = 0; k < ball.size(); k += 3) {
    EXPECT_NEAR(Vector3d(ball[k], ball[k + 1], ball[k + 2]).norm(), 0.5, 1e-6);
  }
}

TEST(RunAnimation, RefusesARunOfNoTime) {
  const test::RecordedRun run(kAnimatedScene);
  EXPECT_THROW((void)animation_of(run), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
