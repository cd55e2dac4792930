// Verifies paths as they are read back from their files, both planned and retimed.
//
//   path_campaign [--first N] [--seeds N] [--part K/N] [--shortcuts N] [--verify EVERY]
//                 [--fcl EVERY] [--retime EVERY] [--walls EVERY] OUTPUT.json
//
// The problems are MotionBenchMaker's 400 problems of the Panda, each with N seeds from the first
// one on. Every path is written and read back. An option with the number EVERY judges one path in
// EVERY:
//
// - --verify (1 by default): by the code of `verify`.
// - --fcl (1): by FCL at each 0.25 degrees.
// - --retime (10): as trajectories in all modes, which FCL tests as the controller interpolates
//   their files.
// - --walls (50): with a wall of 10 micrometres across the path, with which its proof has to fail.
//
// Parts run side by side, problem by problem. Processor times are those of one thread. The program
// needs FIRSTCONTACT_DATA_DIR.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/retiming/joint_limits.h>
#include <firstcontact/retiming/retime.h>
#include <firstcontact/retiming/retiming_path.h>
#include <firstcontact/retiming/write_trajectory.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/verification/verify_path.h>

#include "benchmarks/planning/fcl_places.h"
#include "benchmarks/support/panda_problems.h"
#include "benchmarks/support/timing.h"
#include "tests/retiming/retiming_cases.h"

namespace firstcontact::benchmarks {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr double kStep = 0.25 * std::numbers::pi / 180.0;  // [rad]  Step of the joint that moves
                                                           // most.
constexpr double kTimeStep = 1e-3;                         // [s]    Period of a controller.
constexpr double kWall = 1e-5;                             // [m]    Thickness of a wall.

struct Settings {
  std::uint64_t first = 1;
  std::uint64_t seeds = 1;
  int part = 0;
  int parts = 1;
  std::size_t shortcuts = PlanOptions().shortcuts;
  int verify_every = 1;
  int fcl_every = 1;
  int retime_every = 10;
  int walls_every = 50;
  std::string output;
};

/// Counts of a campaign; from `unsolved` to `refused` all should be 0.
struct Counts {
  int problems = 0;
  int paths = 0;
  int paths_of_verify = 0;  ///< Paths that `verify` judged.
  int paths_of_fcl = 0;     ///< Paths that FCL judged.
  long long samples = 0;
  int trajectories = 0;
  int walls = 0;
  int unsolved = 0;
  int not_verified = 0;          ///< Paths that the code of `verify` does not prove, from the file.
  int colliding = 0;             ///< Paths with a sample that FCL finds in collision.
  int trajectories_refused = 0;  ///< Trajectories without a proven retiming.
  int trajectories_colliding = 0;
  int walls_unseen = 0;    ///< Paths that are still proven with a wall across them.
  int refused = 0;         ///< Questions that are not valid.
  double planning = 0.0;   ///< [us]  Processor time, as are those below.
  double verifying = 0.0;  ///< [us]
  double fcl = 0.0;        ///< [us]  Tests of paths.
  double retiming = 0.0;   ///< [us]  Includes the tests by FCL.
  /// [ms]  Of retiming with its proof, for each mode.
  std::array<std::vector<double>, kRetimingModeWords.size()> retime_ms = {};

  [[nodiscard]] json summary() const {
    json medians = json::object();
    for (std::size_t mode = 0; mode < retime_ms.size(); ++mode) {
      if (!retime_ms[mode].empty()) {
        medians[kRetimingModeWords[mode]] = quantile(retime_ms[mode], 0.5);
      }
    }
    return {{"retime_ms_median", medians},
            {"problems", problems},
            {"paths", paths},
            {"paths_of_verify", paths_of_verify},
            {"paths_of_fcl", paths_of_fcl},
            {"samples_of_fcl", samples},
            {"trajectories", trajectories},
            {"walls", walls},
            {"unsolved", unsolved},
            {"refused", refused},
            {"not_verified", not_verified},
            {"colliding", colliding},
            {"trajectories_refused", trajectories_refused},
            {"trajectories_colliding", trajectories_colliding},
            {"walls_unseen", walls_unseen},
            {"planning_s", 1e-6 * planning},
            {"verifying_s", 1e-6 * verifying},
            {"fcl_s", 1e-6 * fcl},
            {"retiming_s", 1e-6 * retiming}};
  }
};

/// One problem: its scene for the planner, and the same scene for FCL.
class Problem {
 public:
  Problem(std::string name, ScenePlan scene, const Settings& settings, Counts& counts)
      : name_(std::move(name)),
        scene_(std::move(scene)),
        settings_(settings),
        counts_(counts),
        places_(scene_) {}

  void run(std::uint64_t seed) {
    PlanOptions options = scene_.options;
    options.seed = seed;
    options.shortcuts = settings_.shortcuts;
    options.threads = 1;
    double begin = thread_time();
    const PlanResult found = plan_path(scene_.plan, scene_.start, scene_.goals, options);
    counts_.planning += since(begin);
    if (found.verdict != PlanVerdict::proven) {
      ++counts_.unsolved;
      return;
    }
    const std::string text = write_planned_path(planned_path(scene_, options, found));
    const PlannedPath path = parse_planned_path(text, "path.json");
    const int number = counts_.paths++;
    if (number % settings_.verify_every == 0) {
      ++counts_.paths_of_verify;
      if (verify_path(path, {.threads = 1}).verdict != ProofVerdict::proven) {
        ++counts_.not_verified;
        report(seed, "not verified");
      }
      counts_.verifying += since(begin);
    }
    if (number % settings_.fcl_every == 0) {
      ++counts_.paths_of_fcl;
      if (collides(path)) {
        ++counts_.colliding;
        report(seed, "colliding");
      }
      counts_.fcl += since(begin);
    }
    if (number % settings_.retime_every == 0) {
      retime_all(text);
      counts_.retiming += since(begin);
    }
    if (number % settings_.walls_every == 0 && found.path.size() > 1) {
      put_a_wall_across(path, seed);
    }
  }

 private:
  /// [us]  Returns the processor time since `then`, and sets `then` to now.
  static double since(double& then) {
    const double now = thread_time();
    return now - std::exchange(then, now);
  }

  void report(std::uint64_t seed, const char* fault) const {
    std::cerr << name_ << ", seed " << seed << ": " << fault << '\n';
  }

  bool collides_at(const std::vector<double>& waypoint) {
    ++counts_.samples;
    return places_.collide(waypoint);
  }

  bool collides(const PlannedPath& path) {
    const std::size_t before = places_.count();
    bool any = false;
    for (std::size_t edge = 0; edge + 1 < path.waypoints.size() && !any; ++edge) {
      any = places_.collide(path.waypoints[edge], path.waypoints[edge + 1], kStep);
    }
    counts_.samples += static_cast<long long>(places_.count() - before);
    return any;
  }

  void retime_all(const std::string& text) {
    const RetimingPath input = parse_retiming_path(text, "path.json");
    const RobotModel& model = input.scene.robots[input.robots.front()].model;
    const std::vector<RateLimits> limits =
        limits_of(model, input.path.joint_names, {}, {.velocity = 2.0, .acceleration = 5.0});
    const LoadedRetimingScene loaded = load_retiming_scene(input, cache_);
    for (const RetimingMode mode :
         {RetimingMode::stop, RetimingMode::blend, RetimingMode::time_optimal}) {
      const double begin = thread_time();
      const RetimedMotion retimed =
          retime(input.path, limits, loaded.where, {.mode = mode, .proof = {.threads = 1}});
      counts_.retime_ms[static_cast<std::size_t>(mode)].push_back(1e-3 * (thread_time() - begin));
      ++counts_.trajectories;
      if (!retimed.proof.is_proven()) {
        ++counts_.trajectories_refused;
        continue;
      }
      const std::string file = write_trajectory(retimed.motion, TrajectoryFormat::csv);
      counts_.trajectories_colliding +=
          collides(parse_timed_motion(file, "trajectory.csv", model)) ? 1 : 0;
    }
  }

  bool collides(const TimedMotion& motion) {
    const int steps = static_cast<int>(std::ceil(motion.duration() / kTimeStep));
    for (int step = 0; step <= steps; ++step) {
      std::vector<double> q;
      for (std::size_t joint = 0; joint < motion.joint_names.size(); ++joint) {
        q.push_back(
            test::controller_state(motion, joint, std::min(step * kTimeStep, motion.duration()))
                .position);
      }
      if (collides_at(q)) {
        return true;
      }
    }
    return false;
  }

  /// Puts a plate at a vertex of the last link with geometry, somewhere on the path.
  void put_a_wall_across(PlannedPath path, std::uint64_t seed) {
    RandomNumbers random(seed + 1'000'003);
    const std::size_t edge = random.below(path.waypoints.size() - 1);
    const double share = random.uniform();
    std::vector<double> q = path.waypoints[edge];
    for (std::size_t k = 0; k < q.size(); ++k) {
      q[k] += share * (path.waypoints[edge + 1][k] - q[k]);
    }
    const RobotModel& model = scene_.plan.space.model();
    std::size_t link = model.links().size() - 1;
    while (model.links()[link].collision.empty()) {
      --link;
    }
    const std::size_t member = scene_.plan.scene.first_member(0) + link;
    const MemberGeometry& geometry = scene_.plan.scene.geometries(member).front();
    const auto& vertices = geometry.shape.mesh().vertices;
    const Eigen::Vector3d vertex = vertices[random.below(vertices.size())];
    const Eigen::Isometry3d X_WL = places_.links(q)[link];
    const Eigen::Vector3d place =
        X_WL * Eigen::Vector3d(geometry.X_MG.position + geometry.X_MG.rotation * vertex);
    add_body(path.scene, {.name = "a wall of 10 um",
                          .shape = {.source = BoxShape{{0.05, 0.05, kWall}}},
                          .motion = FixedMotion{{place, random_rotation(random)}}});
    ++counts_.walls;
    ShapeCache cache;
    path.input_digest = load_scene(path.scene, cache).input_digest;
    if (verify_path(path, {.threads = 1}).verdict == ProofVerdict::proven) {
      ++counts_.walls_unseen;
    }
  }

  static Eigen::Quaterniond random_rotation(RandomNumbers& random) {
    return Eigen::Quaterniond{random.uniform() + 0.1, random.uniform() - 0.5,
                              random.uniform() - 0.5, random.uniform() - 0.5}
        .normalized();
  }

  std::string name_;
  ScenePlan scene_;
  const Settings& settings_;
  Counts& counts_;
  FclPlaces places_;
  ShapeCache cache_;
};

int run(const Settings& settings) {
  const char* data = std::getenv("FIRSTCONTACT_DATA_DIR");
  if (data == nullptr || settings.output.empty()) {
    std::cerr
        << "usage: FIRSTCONTACT_DATA_DIR=... path_campaign [--first N] [--seeds N] [--part K/N] "
           "[--shortcuts N] [--verify EVERY] [--fcl EVERY] [--retime EVERY] [--walls EVERY] "
           "OUTPUT.json\n";
    return 2;
  }
  Counts counts;
  ShapeCache cache;
  int number = 0;
  for (const char* family : kPandaFamilies) {
    for (int problem = 1; problem <= kPandaProblems; ++problem) {
      if (number++ % settings.parts != settings.part) {
        continue;
      }
      ++counts.problems;
      const Scene scene = read_robot_question(panda_problem(data, family, problem));
      Problem work(family + (' ' + std::to_string(problem)),
                   make_scene_plan(scene, question_of_trajectory(scene), cache), settings, counts);
      for (std::uint64_t seed = settings.first; seed < settings.first + settings.seeds; ++seed) {
        try {
          work.run(seed);
        } catch (const std::invalid_argument& error) {
          ++counts.refused;
          std::cerr << family << ' ' << problem << ": " << error.what() << '\n';
          break;
        }
      }
    }
    std::cerr << family << ": " << counts.summary().dump() << '\n';
  }
  std::ofstream(settings.output) << counts.summary().dump(1) << '\n';
  return counts.not_verified + counts.colliding + counts.trajectories_colliding +
                     counts.walls_unseen ==
                 0
             ? 0
             : 1;
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  firstcontact::benchmarks::Settings settings;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const bool has_value = k + 1 < argc;
    if (word == "--first" && has_value) {
      settings.first = std::strtoull(argv[++k], nullptr, 10);
    } else if (word == "--seeds" && has_value) {
      settings.seeds = std::strtoull(argv[++k], nullptr, 10);
    } else if (word == "--part" && has_value) {
      std::sscanf(argv[++k], "%d/%d", &settings.part, &settings.parts);
    } else if (word == "--shortcuts" && has_value) {
      settings.shortcuts = std::strtoull(argv[++k], nullptr, 10);
    } else if (word == "--verify" && has_value) {
      settings.verify_every = std::max(1, std::atoi(argv[++k]));
    } else if (word == "--fcl" && has_value) {
      settings.fcl_every = std::max(1, std::atoi(argv[++k]));
    } else if (word == "--retime" && has_value) {
      settings.retime_every = std::max(1, std::atoi(argv[++k]));
    } else if (word == "--walls" && has_value) {
      settings.walls_every = std::max(1, std::atoi(argv[++k]));
    } else {
      settings.output = word;
    }
  }
  return firstcontact::benchmarks::run(settings);
}
