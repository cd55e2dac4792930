// A captured figure walks through surroundings of some 300,000 triangles, checked between all
// captured frames: where does it touch what, and when?
//
// usage: walking_figure SKELETON.asf MOTION.amc MESH...
//
// The meshes, scaled to the size of furniture and each taken several times, line the way; one
// stands on it.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_files/read_amc.h>
#include <firstcontact/robot_files/read_asf.h>

namespace {

using namespace firstcontact;

constexpr std::size_t kTriangles = 300'000;
constexpr double kHeight = 0.8;  // [m]  Of each obstacle.
constexpr double kAside = 0.75;  // [m]  Of their middles from the way.

/// Scaled to its height, with its middle at the origin.
Shape obstacle(const std::string& path) {
  Mesh mesh = read_mesh(path);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    box.extend(v);
  }
  const double scale = kHeight / box.sizes().maxCoeff();
  for (Eigen::Vector3d& v : mesh.vertices) {
    v = scale * (v - box.center());
  }
  return Shape(std::move(mesh));
}

/// Captures are y-up; here z is up.
const Pose kUpright{
    Eigen::Vector3d::Zero(),
    Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()))};

Eigen::Vector3d root_at(const MotionCapture& walk, std::size_t frame) {
  return kUpright.rotation * walk.frames[frame].root_position;
}

/// The i-th of n places: by turns left and right of the way, the last one on it.
Pose place_of(const MotionCapture& walk, std::size_t i, std::size_t n) {
  const Eigen::Vector3d from = root_at(walk, 0);
  const Eigen::Vector3d way = root_at(walk, walk.frames.size() - 1) - from;
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(way).normalized();
  const double share = static_cast<double>(i + 1) / static_cast<double>(n);
  const double aside = i + 1 == n ? 0.0 : i % 2 == 0 ? kAside : -kAside;
  Eigen::Vector3d position = from + share * way + aside * left;
  position.z() = 0.5 * kHeight;
  return {position,
          Eigen::Quaterniond(Eigen::AngleAxisd(static_cast<double>(i), Eigen::Vector3d::UnitZ()))};
}

struct Surroundings {
  std::vector<Shape> shapes;
  std::vector<std::size_t> order;  // Of the places, which shape stands there.
  std::size_t triangles = 0;
};

Surroundings read_surroundings(int count, char** paths) {
  Surroundings all;
  for (int i = 0; i < count; ++i) {
    all.shapes.push_back(obstacle(paths[i]));
  }
  for (std::size_t i = 0; all.triangles < kTriangles; ++i) {
    all.order.push_back(i % all.shapes.size());
    all.triangles += all.shapes[all.order.back()].mesh().triangles.size();
  }
  return all;
}

/// The figure between two frames, tested against the surroundings alone.
RobotScene scene_between(const RobotModel& figure, const MotionCapture& walk, std::size_t frame,
                         const Surroundings& all, const std::vector<DisabledPair>& itself) {
  RobotScene scene;
  for (std::size_t i = 0; i < all.order.size(); ++i) {
    scene.add_body("obstacle " + std::to_string(i), all.shapes[all.order[i]],
                   Motion::fixed(place_of(walk, i, all.order.size())));
  }
  scene.add_robot("figure", capture_motion(figure, walk, frame, frame + 1, kUpright), itself);
  return scene;
}

std::vector<DisabledPair> all_pairs(std::size_t links) {
  std::vector<DisabledPair> pairs;
  for (std::size_t a = 0; a < links; ++a) {
    for (std::size_t b = a + 1; b < links; ++b) {
      pairs.push_back({a, b, ""});
    }
  }
  return pairs;
}

int walk_through(int count, char** paths) {
  const AsfSkeleton skeleton = read_asf(paths[0]);
  const MotionCapture walk = read_amc(paths[1], skeleton);
  const RobotModel figure = make_figure(walk);
  const Surroundings all = read_surroundings(count - 2, paths + 2);
  std::printf("%zu links, %zu frames, %zu obstacles of %zu triangles\n", figure.links().size(),
              walk.frames.size(), all.order.size(), all.triangles);
  const std::vector<DisabledPair> itself = all_pairs(figure.links().size());
  std::vector<double> milliseconds;
  for (std::size_t k = 0; k + 1 < walk.frames.size(); ++k) {
    const RobotScene scene = scene_between(figure, walk, k, all, itself);
    const auto begin = std::chrono::steady_clock::now();
    const SceneResult result = check_robots(scene, {.threads = 1});
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    milliseconds.push_back(took.count());
    if (result.verdict != Verdict::free) {
      const BodyPair pair = result.pairs[result.first.value()].members;
      std::printf("%s touches %s %.4f s after the start, %.2f of the way from frame %zu to %zu\n",
                  scene.name(pair[1]).c_str(), scene.name(pair[0]).c_str(),
                  walk.frame_time * (static_cast<double>(k) + result.t), result.t, k, k + 1);
      break;
    }
  }
  std::sort(milliseconds.begin(), milliseconds.end());
  std::printf("%zu pairs of frames checked, %.3f ms each (median), %.3f ms at most\n",
              milliseconds.size(), milliseconds[milliseconds.size() / 2], milliseconds.back());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: walking_figure SKELETON.asf MOTION.amc MESH...\n", stderr);
    return 2;
  }
  try {
    return walk_through(argc - 1, argv + 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "walking_figure: %s\n", error.what());
    return 2;
  }
}
