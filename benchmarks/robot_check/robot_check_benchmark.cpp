// Times certified checks of robots, side by side with FCL's discrete tests of the same motions, and
// shows how the times grow.
//
//   robot_check_benchmark [--quick] [--only NAME] OUTPUT.json
//
// Times are processor times of one thread. The program needs FIRSTCONTACT_DATA_DIR.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/touching_links.h>
#include <firstcontact/robot_files/motion_capture.h>
#include <firstcontact/robot_files/read_amc.h>
#include <firstcontact/robot_files/read_asf.h>
#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/robot_question.h>

#include "benchmarks/robot_check/straight_motion.h"
#include "benchmarks/support/fcl_robot.h"
#include "benchmarks/support/panda_problems.h"
#include "benchmarks/support/timing.h"
#include "benchmarks/support/torus_knot.h"

namespace firstcontact::benchmarks {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr double kFar = 0.05;  // [m]  A motion is "far" if it stays this far from the surroundings.
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kPlannersSteps[] = {1.0, 5.0};  // [degrees]  Steps of the joint that goes
                                                 // farthest.

fs::path data_dir() {
  const char* dir = std::getenv("FIRSTCONTACT_DATA_DIR");
  return dir == nullptr ? fs::path() : fs::path(dir);
}

/// A robot among bodies at rest, for our check and FCL's.
class Cell {
 public:
  /// @param sources  the descriptions that the bodies of the scene were made from; meshes where
  ///                 empty
  Cell(const RobotScene& scene, const std::vector<BodyShape>& sources)
      : model_(scene.robot_motion(0).model()),
        kinematics_(model_),
        checker_(scene),
        far_(with_padding(scene)) {
    fill(peer_, scene, sources);
  }

  [[nodiscard]] const RobotModel& model() const { return model_; }

  SceneResult check(const StraightMotion& motion) {
    checker_.set_motion(0, motion.of(model_));
    return checker_.check({.contacts = ContactState::first, .threads = 1});
  }

  /// Returns whether the robot stays farther than kFar from the surroundings.
  bool is_far(const StraightMotion& motion) {
    far_.set_motion(0, motion.of(model_));
    return far_.check({.contacts = ContactState::none, .threads = 1}).verdict == Verdict::free;
  }

  /// Returns the first sample in collision; none where every sample is free.
  std::optional<double> sample(const StraightMotion& motion, double degrees) {
    const int steps =
        std::max(1, static_cast<int>(std::ceil(motion.longest_joint() / (degrees * kDegree))));
    for (int k = 0; k <= steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      if (peer_.collides(kinematics_.places(motion.at(t)))) {
        return t;
      }
    }
    return std::nullopt;
  }

 private:
  static RobotScene with_padding(RobotScene scene) {
    for (std::size_t member = 0; member < scene.size(); ++member) {
      if (!scene.robot_link(member)) {
        scene.set_padding(member, kFar);
      }
    }
    return scene;
  }

  RobotModel model_;
  PlainKinematics kinematics_;
  RobotChecker checker_;
  RobotChecker far_;
  FclRobot peer_;
};

/// [us]  Times a query a few turns and returns the fastest, as a planner's caches are warm.
template <class Query>
double best_of(const Query& query) {
  constexpr int kTurns = 4;
  double best = time_of(query);
  for (int turn = 1; turn < kTurns; ++turn) {
    best = std::min(best, time_of(query));
  }
  return best;
}

/// Times of motions, by outcome.
struct Times {
  std::map<std::string, std::vector<double>> of;  // "all", "free", "far", "contact"

  void add(double time, bool is_free, bool is_far) {
    of["all"].push_back(time);
    of[is_free ? "free" : "contact"].push_back(time);
    if (is_far) {
      of["free and far"].push_back(time);
    }
  }
  [[nodiscard]] json summary() const {
    json out;
    for (const auto& [outcome, times] : of) {
      out[outcome] = {{"count", times.size()},
                      {"median", quantile(times, 0.5)},
                      {"p90", quantile(times, 0.9)},
                      {"p99", quantile(times, 0.99)},
                      {"max", quantile(times, 1.0)}};
    }
    return out;
  }
};

/// Counts and times of the answers for one set of motions.
class Tally {
 public:
  void take(Cell& cell, const StraightMotion& motion) {
    SceneResult found;
    const double ours = best_of([&] { found = cell.check(motion); });
    const bool is_free = found.verdict == Verdict::free;
    const bool is_far = is_free && cell.is_far(motion);
    undecided_ += found.verdict == Verdict::undecided ? 1 : 0;
    ours_.add(ours, is_free, is_far);
    steps_.push_back(static_cast<double>(found.work.total()));
    for (std::size_t k = 0; k < std::size(kPlannersSteps); ++k) {
      Peer& peer = peers_[k];
      std::optional<double> hit;
      const double time = best_of([&] { hit = cell.sample(motion, kPlannersSteps[k]); });
      peer.times.add(time, is_free, is_far);
      peer.ratios.push_back(time / ours);
      if (is_free) {
        peer.free_ratios.push_back(time / ours);
      }
      peer.missed += !is_free && !hit ? 1 : 0;
      // A sample in collision before the certified time would refute the certificate.
      peer.refuted += hit && *hit < found.t - 1e-9 ? 1 : 0;
    }
  }

  [[nodiscard]] json summary() const {
    json out = {{"times_us", ours_.summary()},
                {"undecided", undecided_},
                {"median_steps", quantile(steps_, 0.5)}};
    for (std::size_t k = 0; k < std::size(kPlannersSteps); ++k) {
      const Peer& peer = peers_[k];
      out["fcl"].push_back({{"step_degrees", kPlannersSteps[k]},
                            {"times_us", peer.times.summary()},
                            {"median_ratio", quantile(peer.ratios, 0.5)},
                            {"median_ratio_free", quantile(peer.free_ratios, 0.5)},
                            {"missed", peer.missed},
                            {"refuted", peer.refuted}});
    }
    return out;
  }

 private:
  struct Peer {
    Times times;
    std::vector<double> ratios;
    std::vector<double> free_ratios;
    int missed = 0;
    int refuted = 0;
  };
  Times ours_;
  std::vector<double> steps_;
  int undecided_ = 0;
  Peer peers_[std::size(kPlannersSteps)];
};

Configuration configuration_of(const RobotModel& model, const JointPositions& positions) {
  Configuration q;
  for (const Joint& joint : model.joints()) {
    const auto found = positions.find(joint.name);
    q.push_back(found == positions.end() ? default_position(joint) : found->second);
  }
  return q;
}

/// Returns the configuration of the robot at its start.
Configuration start_of(const RobotQuestion& question, const RobotModel& model) {
  return configuration_of(model, read_planning_request(question.request, model).start);
}

/// Times motions from the starts of MotionBenchMaker's problems, in random directions.
json panda_in_scenes(bool quick) {
  ShapeCache cache;
  std::map<double, Tally> tallies;
  test::Random random(20261122);
  for (const char* family : kPandaFamilies) {
    for (int problem = 1; problem <= kPandaProblems; problem += quick ? 20 : 1) {
      const RobotQuestion question = panda_problem(data_dir(), family, problem);
      const LoadedScene loaded = load_scene(read_robot_question(question), cache);
      Cell cell(*loaded.robots, sources_of(loaded.scene));
      const Configuration start = start_of(question, cell.model());
      for (const double length : {0.5, 2.0}) {
        tallies[length].take(cell, random_motion(cell.model(), start, length, random));
      }
    }
  }
  json out = json::array();
  for (const auto& [length, tally] : tallies) {
    json row = tally.summary();
    row["name"] = "Panda in MotionBenchMaker's scenes";
    row["length_rad"] = length;
    out.push_back(row);
  }
  return out;
}

/// Reads a mesh and scales it to a length along its longest side, with its middle at the origin.
Shape scaled(const fs::path& path, double length) {
  Mesh mesh = read_mesh(path);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    box.extend(v);
  }
  for (Eigen::Vector3d& v : mesh.vertices) {
    v = (length / box.sizes().maxCoeff()) * (v - box.center());
  }
  return Shape(std::move(mesh));
}

RobotModel read_robot(const char* urdf) {
  return read_urdf(data_dir() / "robots" / urdf, {.package_roots = {data_dir() / "robots"}});
}

std::vector<DisabledPair> all_pairs(const RobotModel& model) {
  std::vector<DisabledPair> pairs;
  for (std::size_t a = 0; a < model.links().size(); ++a) {
    for (std::size_t b = a + 1; b < model.links().size(); ++b) {
      pairs.push_back({a, b, ""});
    }
  }
  return pairs;
}

/// Returns the pairs of links that touch at rest, which are not tested.
std::vector<DisabledPair> touching_pairs(const RobotModel& model) {
  std::vector<DisabledPair> pairs;
  for (const LinkPairIndex& pair : touching_links(at_rest(model), 1e-3)) {
    pairs.push_back({pair.link, pair.other, "touch at rest"});
  }
  return pairs;
}

json random_motions(const std::string& name, const RobotModel& model, const Shape* obstacle,
                    const Pose& X_WO, int count) {
  RobotScene scene;
  if (obstacle != nullptr) {
    scene.add_body("obstacle", *obstacle, Motion::fixed(X_WO));
  }
  scene.add_robot("robot", at_rest(model), touching_pairs(model));
  Cell cell(std::move(scene), {});
  json out = json::array();
  for (const double length : {0.5, 2.0}) {
    test::Random random(20261123);
    Tally tally;
    for (int k = 0, tries = 0; k < count && tries < 100 * count; ++tries) {
      const StraightMotion motion =
          random_motion(model, random_configuration(model, random), length, random);
      if (!cell.sample({motion.from, motion.from}, 1.0)) {
        tally.take(cell, motion);
        ++k;
      }
    }
    json row = tally.summary();
    row["name"] = name;
    row["length_rad"] = length;
    out.push_back(row);
  }
  return out;
}

/// Reads the Puma with its visual geometry, as its URDF has no collision geometry.
RobotModel read_puma() {
  ShapeCache cache;
  return cache
      .load(RobotFile{data_dir() / "robots/puma560_description/urdf/puma560_robot.urdf",
                      {data_dir() / "robots"},
                      RobotSurface::visual})
      .model;
}

json puma_against_beetle(bool quick) {
  const RobotModel puma = read_puma();
  const Shape beetle = scaled(data_dir() / "meshes/classic/beetle.obj", 1.5);
  const Pose X_WB{{0.9, 0.0, 0.3}, Eigen::Quaterniond::Identity()};
  return random_motions("Puma against a car body", puma, &beetle, X_WB, quick ? 20 : 500);
}

json self_collision(bool quick) {
  const int count = quick ? 10 : 300;
  json out = random_motions("NAO, self-collision", read_robot("nao/nao.urdf"), nullptr, {}, count);
  const RobotModel hand =
      read_robot("example-robot-data/robots/allegro_hand_description/urdf/allegro_right_hand.urdf");
  for (const json& row : random_motions("Allegro hand, self-collision", hand, nullptr, {}, count)) {
    out.push_back(row);
  }
  return out;
}

/// Summarises the times [us] of one sequence of checks.
json sequence_summary(const std::vector<double>& times_us) {
  return {{"count", times_us.size()},
          {"median_us", quantile(times_us, 0.5)},
          {"p99_us", quantile(times_us, 0.99)},
          {"max_us", quantile(times_us, 1.0)}};
}

/// Times a captured walk among obstacles along its way, one check for each pair of frames.
json avatar(bool quick) {
  constexpr std::size_t kTriangles = 300'000;
  const AsfSkeleton skeleton = read_asf(data_dir() / "mocap/cmu/02.asf");
  const MotionCapture walk = read_amc(data_dir() / "mocap/cmu/02_01.amc", skeleton);
  const RobotModel figure = make_figure(walk);
  const Pose upright{
      Eigen::Vector3d::Zero(),
      Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()))};
  const auto root_at = [&](std::size_t frame) -> Eigen::Vector3d {
    return upright.rotation * walk.frames[frame].root_position;
  };
  const Eigen::Vector3d way = root_at(walk.frames.size() - 1) - root_at(0);
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(way).normalized();
  std::vector<Shape> obstacles;
  std::size_t triangles = 0;
  for (const char* mesh : {"stanford-bunny", "teapot", "homer", "cow", "spot", "suzanne"}) {
    obstacles.push_back(scaled(data_dir() / "meshes/classic" / (std::string(mesh) + ".obj"), 0.8));
  }
  RobotScene scene;
  for (std::size_t i = 0; triangles < kTriangles; ++i) {
    const Shape& shape = obstacles[i % obstacles.size()];
    triangles += shape.mesh().triangles.size();
    Eigen::Vector3d position =
        root_at(0) + 0.08 * static_cast<double>(i) * way + (i % 2 == 0 ? 0.75 : -0.75) * left;
    position.z() = 0.4;
    scene.add_body("obstacle " + std::to_string(i), shape,
                   Motion::fixed({position, Eigen::Quaterniond::Identity()}));
  }
  scene.add_robot("figure", capture_motion(figure, walk, 0, 1, upright), all_pairs(figure));
  RobotChecker checker(scene);
  std::vector<double> times;
  int contacts = 0;
  const std::size_t frames = quick ? 50 : walk.frames.size();
  for (std::size_t frame = 0; frame + 1 < frames; ++frame) {
    SceneResult found;
    times.push_back(best_of([&] {
      checker.set_motion(0, capture_motion(figure, walk, frame, frame + 1, upright));
      found = checker.check({.contacts = ContactState::first, .threads = 1});
    }));
    contacts += found.verdict == Verdict::free ? 0 : 1;
  }
  json row = sequence_summary(times);
  row["name"] = "Captured figure in its surroundings, a frame";
  row["links"] = figure.links().size();
  row["triangles"] = triangles;
  row["contacts"] = contacts;
  return json::array({row});
}

/// Times a hand with fingers of two bars each; every bar is 2 cm above its own block.
json hand(int links) {
  RobotDescription body{.name = "hand", .links = {{"palm", {}, {}}}, .joints = {}};
  RobotScene scene;
  const Shape block = make_box({0.06, 0.06, 0.06});
  const Shape bar = make_capsule(0.03, 0.14);
  const Pose along_x{
      {0.1, 0.0, 0.0},
      Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitY()))};
  for (int k = 0; k < links; ++k) {
    const bool is_second = k % 2 == 1;
    const double y = 0.2 * (k / 2);
    Link link{"l" + std::to_string(k), {}, {}};
    link.collision.push_back(
        {.name = "", .X_LG = along_x, .source = SphereGeometry{}, .shape = bar});
    Joint joint{.name = "j" + std::to_string(k),
                .type = JointType::continuous,
                .parent = is_second ? body.links.back().name : "palm",
                .child = link.name};
    joint.axis = Eigen::Vector3d::UnitZ();
    joint.X_PJ.position = is_second ? Eigen::Vector3d(0.2, 0.0, 0.0) : Eigen::Vector3d(0.0, y, 0.0);
    body.links.push_back(std::move(link));
    body.joints.push_back(std::move(joint));
    scene.add_body(
        "block" + std::to_string(k), block,
        Motion::fixed({{is_second ? 0.3 : 0.1, y, -0.08}, Eigen::Quaterniond::Identity()}));
  }
  const RobotModel model(body);
  scene.add_robot("hand", at_rest(model));
  RobotChecker checker(std::move(scene));
  const StraightMotion sway{Configuration(model.joints().size(), -0.05),
                            Configuration(model.joints().size(), 0.05)};
  SceneResult found;
  const double time = best_of([&] {
    checker.set_motion(0, sway.of(model));
    found = checker.check({.contacts = ContactState::first, .threads = 1});
  });
  return {{"name", "links near something"},
          {"size", links},
          {"time_us", time},
          {"free", found.verdict == Verdict::free}};
}

/// Times the Puma as it passes a knot of more and more triangles.
json passing(const RobotModel& puma, std::size_t triangles, int motions) {
  Mesh knot = torus_knot(triangles);
  for (Eigen::Vector3d& v : knot.vertices) {
    v *= 0.1;
  }
  const Shape shape(std::move(knot));
  RobotScene scene;
  scene.add_body("knot", shape, Motion::fixed({{0.6, 0.2, 0.4}, Eigen::Quaterniond::Identity()}));
  scene.add_robot("puma", at_rest(puma), touching_pairs(puma));
  RobotChecker checker(std::move(scene));
  test::Random random(20261124);
  std::vector<double> times;
  for (int k = 0; k < motions; ++k) {
    const StraightMotion motion =
        random_motion(puma, random_configuration(puma, random), 2.0, random);
    times.push_back(best_of([&] {
      checker.set_motion(0, motion.of(puma));
      (void)checker.check({.contacts = ContactState::first, .threads = 1});
    }));
  }
  double sum = 0.0;
  for (const double time : times) {
    sum += time;
  }
  return {{"name", "triangles of the obstacle"},
          {"size", shape.mesh().triangles.size()},
          {"time_us", sum / static_cast<double>(times.size())}};
}

json growth(bool quick) {
  json out = json::array();
  for (const int links : {4, 8, 16, 32, 64}) {
    out.push_back(hand(links));
  }
  const RobotModel puma = read_puma();
  for (const std::size_t triangles : {1'000, 10'000, 100'000, 1'000'000}) {
    if (!quick || triangles < 1'000'000) {
      out.push_back(passing(puma, triangles, quick ? 20 : 200));
    }
  }
  return out;
}

/// Times robots that touch in very many pairs of triangles at nearly the same time.
///
/// A round tool comes down on a round post, flat on flat, and turns about its axis meanwhile.
json ties(bool quick) {
  const double length = 0.2;  // [m]
  json out = json::array();
  for (const double radius : {0.02, 0.05}) {
    for (const double turn : {0.0, 0.3, 3.0, 30.0}) {
      RobotDescription lift{.name = "lift", .links = {{"base"}, {"slide"}, {"tool"}}, .joints = {}};
      lift.links[2].collision.push_back({.name = "",
                                         .X_LG = {},
                                         .source = SphereGeometry{},
                                         .shape = make_cylinder(radius, length)});
      lift.joints = {{.name = "z",
                      .type = JointType::prismatic,
                      .parent = "base",
                      .child = "slide",
                      .axis = Eigen::Vector3d::UnitZ()},
                     {.name = "turn",
                      .type = JointType::continuous,
                      .parent = "slide",
                      .child = "tool",
                      .axis = Eigen::Vector3d::UnitZ()}};
      const RobotModel model(lift);
      RobotScene scene;
      scene.add_body("post", make_cylinder(0.05, length), Motion::fixed({}));
      scene.add_robot("lift", at_rest(model));
      RobotChecker checker(std::move(scene));
      for (const double end : {0.1, 0.07}) {
        const StraightMotion down{{0.5, 0.0}, {end, turn}};
        SceneResult found;
        const double time = best_of([&] {
          checker.set_motion(0, down.of(model));
          found = checker.check({.contacts = ContactState::first, .threads = 1});
        });
        out.push_back({{"name", "round tool on a round post"},
                       {"radius", radius},
                       {"turn_rad", turn},
                       {"end", end},
                       {"time_us", time},
                       {"steps", found.work.total()},
                       {"contact", found.verdict == Verdict::contact}});
      }
    }
    if (quick) {
      break;
    }
  }
  return out;
}

/// Times the least distance of a robot's motion beside its check.
json closest(bool quick) {
  ShapeCache cache;
  test::Random random(20261125);
  std::vector<double> checks;
  std::vector<double> leasts;
  std::vector<double> ratios;
  std::vector<double> free_ratios;
  for (const char* family : kPandaFamilies) {
    for (int problem = 1; problem <= kPandaProblems; problem += quick ? 50 : 5) {
      const RobotQuestion question = panda_problem(data_dir(), family, problem);
      const LoadedScene loaded = load_scene(read_robot_question(question), cache);
      const RobotModel& model = loaded.robots->robot_motion(0).model();
      const Configuration start = start_of(question, model);
      RobotChecker checker(*loaded.robots);
      checker.set_motion(0, random_motion(model, start, 1.0, random).of(model));
      bool is_free = false;
      const double check = best_of([&] {
        is_free =
            checker.check({.contacts = ContactState::first, .threads = 1}).verdict == Verdict::free;
      });
      const double least = best_of([&] {
        (void)checker.check({.contacts = ContactState::first, .threads = 1, .closest = true});
      });
      checks.push_back(check);
      leasts.push_back(least);
      ratios.push_back(least / check);
      if (is_free) {
        free_ratios.push_back(least / check);
      }
    }
  }
  return json::array({{{"name", "Panda in MotionBenchMaker's scenes, 1 rad"},
                       {"check", sequence_summary(checks)},
                       {"least_clearance", sequence_summary(leasts)},
                       {"median_ratio", quantile(ratios, 0.5)},
                       {"p90_ratio", quantile(ratios, 0.9)},
                       {"median_ratio_free", quantile(free_ratios, 0.5)}}});
}

using Family = json (*)(bool quick);
constexpr std::pair<const char*, Family> kFamilies[] = {{"panda", panda_in_scenes},
                                                        {"puma", puma_against_beetle},
                                                        {"self_collision", self_collision},
                                                        {"avatar", avatar},
                                                        {"growth", growth},
                                                        {"ties", ties},
                                                        {"closest", closest}};

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  bool quick = false;
  std::string only;
  std::string output;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--quick") {
      quick = true;
    } else if (word == "--only" && k + 1 < argc) {
      only = argv[++k];
    } else {
      output = word;
    }
  }
  if (output.empty() || data_dir().empty()) {
    std::fprintf(stderr,
                 "usage: FIRSTCONTACT_DATA_DIR=... robot_check_benchmark [--quick] [--only NAME] "
                 "OUTPUT.json\n");
    return 2;
  }
  json all;
  for (const auto& [name, family] : kFamilies) {
    if (only.empty() || only == name) {
      std::fprintf(stderr, "  %s ...\n", name);
      all[name] = family(quick);
    }
  }
  std::ofstream(output) << all.dump(2) << '\n';
  return EXIT_SUCCESS;
}
