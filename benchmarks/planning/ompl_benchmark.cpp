// Compares OMPL's RRT-Connect on proven edges with the same planner on edges that FCL samples. The
// program counts the colliding paths of the latter.
//
//   ompl_benchmark [--seeds N] [--every N] [--time SECONDS] [--plates N] [--thickness METRES]
//                  [OUTPUT.json]
//
// The problems are every N-th of MotionBenchMaker's 400 problems of the Panda. All validators have
// the same planner, sampler, range, seeds, geometries and tested pairs. FCL keeps its hierarchies,
// and tests samples of an edge by bisection, as OMPL's own validator does. The samples lie 1 or 5
// degrees of the joint that moves most apart, or 1 % of the extent of the space, OMPL's default.
// Plates are put at random where they leave start and goal free. Times are processor times of one
// thread; a run without a path counts with the time that it was allowed. A path collides where one
// of its edges is proven to collide. The program needs FIRSTCONTACT_DATA_DIR.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/robot_question.h>
#include <firstcontact_ompl/proven_edges.h>

#include "benchmarks/planning/fcl_motions.h"
#include "benchmarks/planning/fcl_places.h"
#include "benchmarks/planning/peer_settings.h"
#include "benchmarks/planning/thin_plates.h"
#include "benchmarks/support/panda_problems.h"
#include "benchmarks/support/timing.h"

namespace firstcontact::benchmarks {
namespace {

using nlohmann::json;
namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr double kDegree = std::numbers::pi / 180.0;

using Settings = PeerSettings;

double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

class TimedProof : public ob::MotionValidator {
 public:
  TimedProof(const ob::SpaceInformationPtr& si, std::shared_ptr<const EdgeChecker> edges,
             Spent& spent)
      : MotionValidator(si), proven_(si, std::move(edges)), spent_(spent) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return timed(spent_, [&] { return proven_.checkMotion(from, to); });
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last) const override {
    return timed(spent_, [&] { return proven_.checkMotion(from, to, last); });
  }

 private:
  ProvenEdges proven_;
  Spent& spent_;
};

/// The runs of one validator.
struct Runs {
  std::vector<double> solve_ms;  // [ms]  Runs without a path count with the time that they were
                                 // allowed.
  std::size_t solved = 0;
  std::size_t colliding = 0;
  std::size_t colliding_simplified = 0;
  std::size_t undecided = 0;  // Number of paths, simplified or not, that are neither proven nor
                              // refuted.
  double total_ms = 0.0;
  Spent spent = {};

  [[nodiscard]] json summary() const {
    return {{"runs", solve_ms.size()},
            {"solved", solved},
            {"solve_ms_median", median(solve_ms)},
            {"share_in_validation", spent.ms / std::max(total_ms, 1e-9)},
            {"edges_per_s", 1e3 * static_cast<double>(spent.edges) / std::max(spent.ms, 1e-9)},
            {"colliding", colliding},
            {"colliding_simplified", colliding_simplified},
            {"undecided", undecided}};
  }
};

const std::vector<std::string>& validators() {
  static const std::vector<std::string> names = {"proven", "FCL 1 degree", "FCL 5 degrees",
                                                 "FCL 1 % of the extent"};
  return names;
}

/// [%]  Computes the ratio of medians of two lists of runs, and its 95 % interval by bootstrap.
json ratio_of(const Runs& ours, const Runs& others) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, ours.solve_ms.size() - 1);
  std::vector<double> ratios;
  for (int draw = 0; draw < 1000; ++draw) {
    std::vector<double> a;
    std::vector<double> b;
    for (std::size_t k = 0; k < ours.solve_ms.size(); ++k) {
      const std::size_t run = any(random);  // Both lists have the same problem and seed at this
                                            // index.
      a.push_back(ours.solve_ms[run]);
      b.push_back(others.solve_ms[run]);
    }
    ratios.push_back(median(std::move(a)) / median(std::move(b)));
  }
  std::sort(ratios.begin(), ratios.end());
  return {{"ratio", median(ours.solve_ms) / median(others.solve_ms)},
          {"low", ratios[25]},
          {"high", ratios[975]}};
}

/// One problem, solved with all validators.
class Problem {
 public:
  Problem(const ScenePlan& scene, const Settings& settings)
      : scene_(scene),
        settings_(settings),
        edges_(std::make_shared<EdgeChecker>(scene.plan)),
        places_(scene) {
    (void)edges_->is_free(scene.start);  // Allocates the memory of the thread now, as FCL has its
                                         // hierarchies.
  }

  /// Runs each validator in turn; another one is first each time.
  void run(std::uint64_t seed, std::vector<Runs>& all) {
    const std::size_t first = seed + all[0].solve_ms.size();
    for (std::size_t k = 0; k < all.size(); ++k) {
      const std::size_t which = (first + k) % all.size();
      run(which, seed, all[which]);
    }
  }

 private:
  void run(std::size_t which, std::uint64_t seed, Runs& runs) {
    const ob::StateSpacePtr space = make_ompl_space(edges_->space());
    const auto si = std::make_shared<ob::SpaceInformation>(space);
    const OmplStates states(*space, edges_->space());
    if (which == 0) {
      si->setStateValidityChecker(std::make_shared<ProvenStates>(si, edges_));
      si->setMotionValidator(std::make_shared<TimedProof>(si, edges_, runs.spent));
    } else {
      si->setStateValidityChecker(std::make_shared<SampledStates>(si, states, places_));
      si->setMotionValidator(std::make_shared<SampledMotions>(
          si, states, places_, count_of(which, *space, states), runs.spent));
    }
    si->setup();
    const auto problem = std::make_shared<ob::ProblemDefinition>(si);
    problem->setStartAndGoalStates(state(space, states, scene_.start),
                                   state(space, states, scene_.goals.front()), 1e-9);
    ompl::RNG::setSeed(seed);
    og::RRTConnect planner(si);
    planner.setProblemDefinition(problem);
    planner.setup();
    const double begin = thread_time();
    planner.solve(ob::timedPlannerTerminationCondition(settings_.time));
    const double took = 1e-3 * (thread_time() - begin);  // [ms]
    runs.total_ms += took;
    if (!problem->hasExactSolution()) {
      runs.solve_ms.push_back(1e3 * settings_.time);
      return;
    }
    ++runs.solved;
    runs.solve_ms.push_back(took);
    auto path = std::static_pointer_cast<og::PathGeometric>(problem->getSolutionPath());
    judge(*path, states, runs.colliding, runs.undecided);
    std::size_t undecided_simplified = 0;
    const Spent before = runs.spent;
    og::PathSimplifier(si).simplifyMax(*path);
    runs.spent = before;
    judge(*path, states, runs.colliding_simplified, undecided_simplified);
    runs.undecided += undecided_simplified;
  }

  SampledMotions::Count count_of(std::size_t which, const ob::StateSpace& space,
                                 const OmplStates& states) const {
    if (which == 3) {
      return [&space](const ob::State* from, const ob::State* to) {
        return static_cast<int>(space.validSegmentCount(from, to));
      };
    }
    const double step = (which == 1 ? 1.0 : 5.0) * kDegree;
    return [&states, step](const ob::State* from, const ob::State* to) {
      const Configuration a = states.read(from);
      const Configuration b = states.read(to);
      double longest = 0.0;
      for (std::size_t k = 0; k < a.size(); ++k) {
        longest = std::max(longest, std::abs(b[k] - a[k]));
      }
      return static_cast<int>(std::ceil(longest / step));
    };
  }

  static ob::ScopedState<> state(const ob::StateSpacePtr& space, const OmplStates& states,
                                 const Configuration& q) {
    ob::ScopedState<> made(space);
    states.write(q, made.get());
    return made;
  }

  /// Counts a path if it is proven to collide.
  void judge(og::PathGeometric& path, const OmplStates& states, std::size_t& colliding,
             std::size_t& undecided) const {
    bool is_undecided = false;
    for (unsigned int k = 0; k + 1 < path.getStateCount(); ++k) {
      const EdgeVerdict verdict =
          judge_.check_quickly(states.read(path.getState(k)), states.read(path.getState(k + 1)))
              .verdict;
      if (verdict == EdgeVerdict::blocked) {
        ++colliding;
        return;
      }
      is_undecided = is_undecided || verdict == EdgeVerdict::undecided;
    }
    undecided += is_undecided ? 1 : 0;
  }

  const ScenePlan& scene_;
  const Settings& settings_;
  std::shared_ptr<EdgeChecker> edges_;
  // Bodies nearer than 0.1 um count as blocked.
  EdgeChecker judge_{scene_.plan, {.tolerance = 1e-7, .extra_clearance = 0.0}};
  FclPlaces places_;
};

int run(const Settings& settings) {
  const char* data = std::getenv("FIRSTCONTACT_DATA_DIR");
  if (data == nullptr) {
    std::cerr << "ompl_benchmark: needs FIRSTCONTACT_DATA_DIR\n";
    return 2;
  }
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  std::vector<Runs> all(validators().size());
  ShapeCache cache;
  for (const char* family : kPandaFamilies) {
    for (int problem = 1; problem <= kPandaProblems; problem += settings.every) {
      Scene scene = read_robot_question(panda_problem(data, family, problem));
      scene = with_plates(scene, settings.plates, problem, cache);
      const ScenePlan plan = make_scene_plan(scene, question_of_trajectory(scene), cache);
      Problem work(plan, settings);
      for (std::uint64_t seed = 1; seed <= settings.seeds; ++seed) {
        work.run(seed, all);
      }
    }
    std::cerr << family << " done\n";
  }
  json out = {{"seeds", settings.seeds},
              {"every", settings.every},
              {"plates", settings.plates.count},
              {"thickness_m", settings.plates.thickness}};
  for (std::size_t which = 0; which < all.size(); ++which) {
    out["validators"][validators()[which]] = all[which].summary();
    if (which > 0) {
      out["proven to"][validators()[which]] = ratio_of(all[0], all[which]);
    }
  }
  std::cout << out.dump(2) << '\n';
  if (!settings.output.empty()) {
    std::ofstream(settings.output) << out.dump(2) << '\n';
  }
  return all[0].colliding + all[0].colliding_simplified == 0 ? 0 : 1;
}

Settings settings_of(int count, char** arguments) {
  Settings settings;
  settings.time = 10.0;
  read_arguments(count, arguments, settings);
  return settings;
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int count, char** arguments) {
  try {
    return firstcontact::benchmarks::run(firstcontact::benchmarks::settings_of(count, arguments));
  } catch (const std::exception& error) {
    std::cerr << "ompl_benchmark: " << error.what() << '\n';
    return 2;
  }
}
