// Times plans of the Panda in MotionBenchMaker's 400 problems and the tests of their edges, or
// plans in one scene.
//
//   planning_benchmark [--seeds N] [--every N] [--only plans|edges|threads] [--time SECONDS]
//                      [--range RAD] [--shortcuts N] [OUTPUT.json]
//   planning_benchmark --scene SCENE.json [--seeds N] [--time SECONDS] [--range RAD]
//                      [--shortcuts N] [OUTPUT.json]
//
// Times are processor times of one thread; with `--only threads` they are wall clock. The problems
// need FIRSTCONTACT_DATA_DIR.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/robot_question.h>

#include "benchmarks/support/panda_problems.h"
#include "benchmarks/support/timing.h"

namespace firstcontact::benchmarks {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr double kEdgeLengths[] = {0.5, 2.0};  // [rad]
constexpr int kEdgesOfProblem = 50;
constexpr double kFractionTolerance = 1e-3;
constexpr std::size_t kEdgesOfThreads = 4000;  // In each problem, for `--only threads`.

struct Settings {
  std::uint64_t seeds = 5;
  int every = 1;
  double time = 10.0;  // [s]
  double range = PlanOptions().range;
  std::size_t shortcuts = PlanOptions().shortcuts;
  std::string only;
  fs::path scene;
  std::string output;
};

json summary_of(const std::vector<double>& values) {
  return {{"count", values.size()},
          {"median", quantile(values, 0.5)},
          {"p95", quantile(values, 0.95)},
          {"p99", quantile(values, 0.99)},
          {"max", quantile(values, 1.0)}};
}

/// [ms]  Times of plans; a run without a path counts with the time that it was allowed.
struct PlanTimes {
  std::vector<double> plan;
  std::vector<double> whole;
  std::vector<double> rest;  // Shortcuts and the proof, in solved runs.
  std::vector<double> edges;
  std::vector<double> places;
  std::vector<double> shortened;  // Cost after the shortcuts, divided by the cost before.
  std::size_t solved = 0;
  std::size_t solved_in_a_second = 0;
  std::size_t undecided = 0;
  std::size_t unproven = 0;
  std::size_t refused = 0;

  void take(const PlanResult& result, double first, double processor_ms, double allowed_ms) {
    const bool is_solved = result.verdict == PlanVerdict::proven;
    solved += is_solved ? 1 : 0;
    unproven += !is_solved && result.statistics.first_path_seconds ? 1 : 0;
    solved_in_a_second += is_solved && processor_ms <= 1e3 ? 1 : 0;
    undecided += result.statistics.undecided;
    plan.push_back(is_solved ? first : allowed_ms);
    whole.push_back(is_solved ? processor_ms : allowed_ms);
    edges.push_back(static_cast<double>(result.statistics.edges_checked));
    if (is_solved) {
      rest.push_back(processor_ms - first);
      places.push_back(static_cast<double>(result.path.size()));
      shortened.push_back(result.cost / result.statistics.first_cost.value_or(result.cost));
    }
  }

  [[nodiscard]] json summary() const {
    return {{"runs", plan.size()},
            {"refused", refused},
            {"solved", solved},
            {"solved_within_1_s", solved_in_a_second},
            {"unproven", unproven},
            {"undecided_edges", undecided},
            {"plan_ms", summary_of(plan)},
            {"shortcuts_and_proof_ms", summary_of(rest)},
            {"whole_ms", summary_of(whole)},
            {"edges_checked", summary_of(edges)},
            {"places", summary_of(places)},
            {"cost_after_shortcuts", summary_of(shortened)}};
  }
};

template <class Use>
void for_each_problem(const Settings& settings, const std::string& family, const Use& use) {
  const char* data = std::getenv("FIRSTCONTACT_DATA_DIR");
  if (data == nullptr) {
    std::cerr << "planning_benchmark: needs FIRSTCONTACT_DATA_DIR\n";
    std::exit(2);
  }
  ShapeCache cache;
  for (int problem = 1; problem <= kPandaProblems; problem += settings.every) {
    const Scene scene = read_robot_question(panda_problem(data, family, problem));
    use(make_scene_plan(scene, question_of_trajectory(scene), cache), problem);
  }
}

/// Plans once; `take` gets the result, and the times [ms] of the first path and of the whole run.
template <class Take>
void plan_once(const Settings& settings, const ScenePlan& scene, std::uint64_t seed,
               const Take& take) {
  PlanOptions options = scene.options;
  options.seed = seed;
  options.time = settings.time;
  options.threads = 1;
  options.range = settings.range;
  options.shortcuts = settings.shortcuts;
  const double begin = thread_time();
  double first = 0.0;
  options.progress = [&](const PlanProgress& done) {
    if (done.cost && first == 0.0) {
      first = 1e-3 * (thread_time() - begin);
    }
  };
  const PlanResult result = plan_path(scene.plan, scene.start, scene.goals, options);
  take(result, first, 1e-3 * (thread_time() - begin));
}

json plans(const Settings& settings) {
  json out;
  PlanTimes all;
  for (const std::string family : kPandaFamilies) {
    PlanTimes times;
    for_each_problem(settings, family, [&](const ScenePlan& scene, int problem) {
      for (std::uint64_t seed = 1; seed <= settings.seeds; ++seed) {
        try {
          plan_once(settings, scene, seed,
                    [&](const PlanResult& result, double first, double took) {
                      times.take(result, first, took, settings.time * 1e3);
                      all.take(result, first, took, settings.time * 1e3);
                    });
        } catch (const std::invalid_argument& error) {
          ++times.refused;
          ++all.refused;
          std::cerr << family << ' ' << problem << ": " << error.what() << '\n';
          break;
        }
      }
    });
    out[family] = times.summary();
    std::cerr << family << ": " << out[family].dump() << '\n';
  }
  out["all"] = all.summary();
  return out;
}

json plans_in_scene(const Settings& settings) {
  const Scene read = read_scene(settings.scene);
  ShapeCache cache;
  const ScenePlan scene = make_scene_plan(read, read.plan.value(), cache);
  PlanTimes times;
  for (std::uint64_t seed = 1; seed <= settings.seeds; ++seed) {
    plan_once(settings, scene, seed, [&](const PlanResult& result, double first, double took) {
      times.take(result, first, took, settings.time * 1e3);
      std::cerr << "seed " << seed << ": " << first << " ms, " << took << " ms\n";
    });
  }
  return times.summary();
}

/// Times edges from the start and goal of a problem in random directions.
json edges(const Settings& settings) {
  json out = json::array();
  for (const double length : kEdgeLengths) {
    std::vector<double> free_times;
    std::vector<double> blocked_times;
    std::vector<double> quick_times;
    std::vector<double> state_times;
    std::vector<double> clearance_times;
    std::size_t undecided = 0;
    for (const std::string family : kPandaFamilies) {
      for_each_problem(settings, family, [&](const ScenePlan& scene, int problem) {
        const EdgeChecker checker(scene.plan, {.fraction_tolerance = kFractionTolerance});
        RandomNumbers random(static_cast<std::uint64_t>(problem));
        const ConfigurationSpace& space = scene.plan.space;
        for (int k = 0; k < kEdgesOfProblem; ++k) {
          const Configuration& from = k % 2 == 0 ? scene.start : scene.goals.front();
          const Configuration far = space.sample(random);
          const double share = std::min(1.0, length / space.distance(from, far));
          const Configuration to = space.interpolate(from, far, share);
          EdgeAnswer answer;
          double best = 1e300;
          for (int turn = 0; turn < 3; ++turn) {
            const double begin = thread_time();
            answer = checker.check(from, to);
            best = std::min(best, thread_time() - begin);
          }
          if (answer.verdict == EdgeVerdict::blocked) {
            const double start = thread_time();
            (void)checker.check_quickly(from, to);
            quick_times.push_back(thread_time() - start);
          }
          undecided += answer.verdict == EdgeVerdict::undecided ? 1 : 0;
          if (answer.verdict == EdgeVerdict::free) {
            free_times.push_back(best);
          } else if (answer.fraction > 0.0) {
            blocked_times.push_back(best);
          }
          const double begin = thread_time();
          (void)checker.is_free(to);
          state_times.push_back(thread_time() - begin);
          if (k % 10 == 0) {
            const double start = thread_time();
            (void)checker.state(to);
            clearance_times.push_back(thread_time() - start);
          }
        }
      });
    }
    out.push_back({{"length_rad", length},
                   {"free_us", summary_of(free_times)},
                   {"blocked_us", summary_of(blocked_times)},
                   {"blocked_verdict_us", summary_of(quick_times)},
                   {"is_free_us", summary_of(state_times)},
                   {"state_us", summary_of(clearance_times)},
                   {"undecided", undecided}});
    std::cerr << out.back().dump() << '\n';
  }
  return out;
}

/// [s]  Wall clock of checks of the same edges: of all by one thread, then of half of them by each
/// of two threads, which share a checker or have one each.
std::array<double, 3> times_of_threads(const EdgeChecker& checker, const EdgeChecker& other,
                                       const std::vector<Configuration>& from,
                                       const std::vector<Configuration>& to) {
  const auto check = [&](const EdgeChecker& with, std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k) {
      (void)with.check(from[k], to[k]);
    }
  };
  const auto wall = [](const auto& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const std::size_t half = from.size() / 2;  // Both halves have as many edges of each end.
  const auto by_two = [&](const EdgeChecker& second) {
    std::thread thread([&] { check(second, half, from.size()); });
    check(checker, 0, half);
    thread.join();
  };
  return {wall([&] { check(checker, 0, from.size()); }), wall([&] { by_two(checker); }),
          wall([&] { by_two(other); })};
}

/// Compares the edges a second of two threads with those of one, problem by problem.
json threads(const Settings& settings) {
  std::vector<double> shared;
  std::vector<double> own;
  std::vector<double> rates;  // [1/s]
  for (const std::string family : kPandaFamilies) {
    for_each_problem(settings, family, [&](const ScenePlan& scene, int problem) {
      const EdgeCheckOptions options{.fraction_tolerance = kFractionTolerance};
      const EdgeChecker checker(scene.plan, options);
      const EdgeChecker other(scene.plan, options);
      const ConfigurationSpace& space = scene.plan.space;
      RandomNumbers random(static_cast<std::uint64_t>(problem));
      std::vector<Configuration> from;
      std::vector<Configuration> to;
      for (std::size_t k = 0; k < kEdgesOfThreads; ++k) {
        from.push_back(k % 2 == 0 ? scene.start : scene.goals.front());
        const Configuration far = space.sample(random);
        const double share = std::min(1.0, kEdgeLengths[0] / space.distance(from.back(), far));
        to.push_back(space.interpolate(from.back(), far, share));
      }
      (void)times_of_threads(checker, other, from, to);  // The memory of both threads.
      const std::array<double, 3> times = times_of_threads(checker, other, from, to);
      rates.push_back(static_cast<double>(from.size()) / times[0]);
      shared.push_back(times[0] / times[1]);
      own.push_back(times[0] / times[2]);
    });
  }
  return {{"edges_per_second_of_one", summary_of(rates)},
          {"two_threads_by_one", summary_of(shared)},
          {"two_threads_with_a_checker_each_by_one", summary_of(own)}};
}

int run(const Settings& settings) {
  json out = {{"seeds", settings.seeds}, {"every", settings.every}, {"time_s", settings.time}};
  if (!settings.scene.empty()) {
    out["plans"] = plans_in_scene(settings);
  } else {
    if (settings.only.empty() || settings.only == "edges") {
      out["edges"] = edges(settings);
    }
    if (settings.only.empty() || settings.only == "plans") {
      out["plans"] = plans(settings);
    }
    if (settings.only == "threads") {
      out["threads"] = threads(settings);
    }
  }
  if (settings.output.empty()) {
    std::cout << out.dump(2) << '\n';
  } else {
    std::ofstream(settings.output) << out.dump(2) << '\n';
  }
  return 0;
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  firstcontact::benchmarks::Settings settings;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const bool has_value = k + 1 < argc;
    if (word == "--seeds" && has_value) {
      settings.seeds = std::strtoull(argv[++k], nullptr, 10);
    } else if (word == "--every" && has_value) {
      settings.every = std::max(1, std::atoi(argv[++k]));
    } else if (word == "--time" && has_value) {
      settings.time = std::atof(argv[++k]);
    } else if (word == "--range" && has_value) {
      settings.range = std::atof(argv[++k]);
    } else if (word == "--shortcuts" && has_value) {
      settings.shortcuts = std::strtoull(argv[++k], nullptr, 10);
    } else if (word == "--scene" && has_value) {
      settings.scene = argv[++k];
    } else if (word == "--only" && has_value) {
      settings.only = argv[++k];
    } else {
      settings.output = word;
    }
  }
  return firstcontact::benchmarks::run(settings);
}
