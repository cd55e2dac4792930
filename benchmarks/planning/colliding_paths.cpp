// Counts the colliding paths of OMPL's planners on edges that FCL samples, and of plan_path().
//
//   colliding_paths [--planners A,B] [--seeds N] [--every N] [--time SECONDS] [--plates N]
//                   [--thickness METRES] [OUTPUT.json]
//
// The problems are every N-th of MotionBenchMaker's 400 problems of the Panda. The samples of an
// edge lie 1 % of the extent of the space apart, OMPL's default; 5 or 1 degrees of the joint that
// moves most; or there are 32 for each radian of the norm of the joints, as VAMP has them. A
// planner ends with its first path. Each path is judged as found, as OMPL simplifies it, and as it
// is after a retiming like MoveIt's: circles at corners that leave the path by up to 0.1 rad, and
// straight edges between samples of 0.1 s. A path collides where one of its edges is proven to
// collide.
//
// plan_path() has one row. Its paths are judged by FCL at every 0.25 degrees too. The exit status
// is 1 where one of them collides. The program needs FIRSTCONTACT_DATA_DIR.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/est/BiEST.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/BKPIECE1.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/kpiece/LBKPIECE1.h>
#include <ompl/geometric/planners/prm/LazyPRM.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/geometric/planners/sbl/SBL.h>
#include <ompl/geometric/planners/stride/STRIDE.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/robot_question.h>
#include <firstcontact_ompl/proven_edges.h>

#include "benchmarks/planning/blended_path.h"
#include "benchmarks/planning/fcl_motions.h"
#include "benchmarks/planning/fcl_places.h"
#include "benchmarks/planning/peer_settings.h"
#include "benchmarks/planning/thin_plates.h"
#include "benchmarks/support/panda_problems.h"
#include "planning/ompl_planners.h"

namespace firstcontact::benchmarks {
namespace {

using nlohmann::json;
namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::array<const char*, 4> kSteps = {"1 % of the extent", "5 degrees", "1 degree",
                                               "32 per radian"};

struct Settings : PeerSettings {
  std::vector<std::string> planners;
};

const std::map<std::string, test::MakePlanner>& planners() {
  static const std::map<std::string, test::MakePlanner> all = {
      test::planner<og::RRTConnect>("RRTConnect"), test::planner<og::RRT>("RRT"),
      test::planner<og::RRTstar>("RRTstar"),       test::planner<og::PRM>("PRM"),
      test::planner<og::LazyPRM>("LazyPRM"),       test::planner<og::KPIECE1>("KPIECE1"),
      test::planner<og::BKPIECE1>("BKPIECE1"),     test::planner<og::LBKPIECE1>("LBKPIECE1"),
      test::planner<og::BiEST>("BiEST"),           test::planner<og::SBL>("SBL"),
      test::planner<og::STRIDE>("STRIDE"),         test::planner<og::BITstar>("BITstar")};
  return all;
}

/// Numbers of paths of one planner with one step, or of plan_path().
struct Counts {
  std::size_t runs = 0;
  std::size_t found = 0;
  std::size_t colliding = 0;
  std::size_t simplified = 0;  // Number of paths that collide once simplified; so below.
  std::size_t retimed = 0;
  std::size_t undecided = 0;

  [[nodiscard]] json summary() const {
    return {{"runs", runs},
            {"found", found},
            {"colliding", colliding},
            {"colliding_simplified", simplified},
            {"colliding_retimed", retimed},
            {"undecided", undecided}};
  }
};

class Problem {
 public:
  Problem(const ScenePlan& scene, const Settings& settings)
      : scene_(scene),
        settings_(settings),
        space_(make_ompl_space(scene.plan.space)),
        states_(*space_, scene.plan.space),
        places_(scene) {}

  void run(const std::string& planner, std::size_t step, std::uint64_t seed, Counts& counts) {
    const auto si = std::make_shared<ob::SpaceInformation>(space_);
    Spent spent;
    si->setStateValidityChecker(std::make_shared<SampledStates>(si, states_, places_));
    si->setMotionValidator(
        std::make_shared<SampledMotions>(si, states_, places_, count_of(step), spent));
    si->setup();
    const auto problem = std::make_shared<ob::ProblemDefinition>(si);
    problem->setStartAndGoalStates(state(scene_.start), state(scene_.goals.front()), 1e-9);
    ompl::RNG::setSeed(seed);
    const ob::PlannerPtr made = planners().at(planner)(si);
    made->setProblemDefinition(problem);
    made->setup();
    made->solve(
        ob::plannerOrTerminationCondition(ob::timedPlannerTerminationCondition(settings_.time),
                                          ob::exactSolnPlannerTerminationCondition(problem)));
    ++counts.runs;
    if (!problem->hasExactSolution()) {
      return;
    }
    ++counts.found;
    auto path = std::static_pointer_cast<og::PathGeometric>(problem->getSolutionPath());
    counts.colliding += collides(waypoints(*path), counts) ? 1 : 0;
    og::PathSimplifier(si).simplifyMax(*path);
    const std::vector<Configuration> simple = waypoints(*path);
    counts.simplified += collides(simple, counts) ? 1 : 0;
    counts.retimed += collides(blended_path(simple), counts) ? 1 : 0;
  }

  void run_ours(std::uint64_t seed, Counts& counts) {
    PlanOptions options = scene_.options;
    options.seed = seed;
    options.time = settings_.time;
    options.threads = 1;
    const PlanResult result = plan_path(scene_.plan, scene_.start, scene_.goals, options);
    ++counts.runs;
    if (result.verdict != PlanVerdict::proven) {
      return;
    }
    ++counts.found;
    bool is_hit = collides(result.path, counts);
    for (std::size_t k = 0; k + 1 < result.path.size(); ++k) {
      is_hit = is_hit || places_.collide(result.path[k], result.path[k + 1], 0.25 * kDegree);
    }
    counts.colliding += is_hit ? 1 : 0;
  }

 private:
  [[nodiscard]] SampledMotions::Count count_of(std::size_t step) const {
    if (step == 0) {
      return [this](const ob::State* from, const ob::State* to) {
        return static_cast<int>(space_->validSegmentCount(from, to));
      };
    }
    return [this, step](const ob::State* from, const ob::State* to) {
      const Configuration a = states_.read(from);
      const Configuration b = states_.read(to);
      double most = 0.0;
      double squares = 0.0;
      for (std::size_t k = 0; k < a.size(); ++k) {
        most = std::max(most, std::abs(b[k] - a[k]));
        squares += (b[k] - a[k]) * (b[k] - a[k]);
      }
      const double count = step == 1   ? most / (5.0 * kDegree)
                           : step == 2 ? most / kDegree
                                       : 32.0 * std::sqrt(squares);
      return static_cast<int>(std::ceil(count));
    };
  }

  [[nodiscard]] ob::ScopedState<> state(const Configuration& q) const {
    ob::ScopedState<> made(space_);
    states_.write(q, made.get());
    return made;
  }

  [[nodiscard]] std::vector<Configuration> waypoints(og::PathGeometric& path) const {
    std::vector<Configuration> all;
    for (const ob::State* state : path.getStates()) {
      all.push_back(states_.read(state));
    }
    return all;
  }

  [[nodiscard]] bool collides(const std::vector<Configuration>& path, Counts& counts) const {
    bool is_undecided = false;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      const EdgeVerdict verdict = judge_.check_quickly(path[k], path[k + 1]).verdict;
      if (verdict == EdgeVerdict::blocked) {
        return true;
      }
      is_undecided = is_undecided || verdict == EdgeVerdict::undecided;
    }
    counts.undecided += is_undecided ? 1 : 0;
    return false;
  }

  const ScenePlan& scene_;
  const Settings& settings_;
  ob::StateSpacePtr space_;
  OmplStates states_;
  // Bodies nearer than 0.1 um count as blocked.
  EdgeChecker judge_{scene_.plan, {.tolerance = 1e-7, .extra_clearance = 0.0}};
  FclPlaces places_;
};

int run(const Settings& settings) {
  const char* data = std::getenv("FIRSTCONTACT_DATA_DIR");
  if (data == nullptr) {
    std::cerr << "colliding_paths: needs FIRSTCONTACT_DATA_DIR\n";
    return 2;
  }
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  std::map<std::string, std::array<Counts, kSteps.size()>> all;
  Counts ours;
  ShapeCache cache;
  for (const char* family : kPandaFamilies) {
    for (int problem = 1; problem <= kPandaProblems; problem += settings.every) {
      Scene scene = read_robot_question(panda_problem(data, family, problem));
      scene = with_plates(scene, settings.plates, problem, cache);
      const ScenePlan plan = make_scene_plan(scene, question_of_trajectory(scene), cache);
      Problem work(plan, settings);
      for (std::uint64_t seed = 1; seed <= settings.seeds; ++seed) {
        work.run_ours(seed, ours);
        for (const std::string& planner : settings.planners) {
          for (std::size_t step = 0; step < kSteps.size(); ++step) {
            work.run(planner, step, seed, all[planner][step]);
          }
        }
      }
    }
    std::cerr << family << " done\n";
  }
  json out = {{"seeds", settings.seeds},
              {"every", settings.every},
              {"plates", settings.plates.count},
              {"thickness_m", settings.plates.thickness},
              {"plan_path", ours.summary()}};
  for (const auto& [planner, counts] : all) {
    for (std::size_t step = 0; step < kSteps.size(); ++step) {
      out["planners"][planner][kSteps[step]] = counts[step].summary();
    }
  }
  std::cout << out.dump(2) << '\n';
  if (!settings.output.empty()) {
    std::ofstream(settings.output) << out.dump(2) << '\n';
  }
  return ours.colliding == 0 ? 0 : 1;
}

std::vector<std::string> planners_of(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream stream(text);
  for (std::string name; std::getline(stream, name, ',');) {
    if (!planners().contains(name)) {
      throw std::invalid_argument("--planners: unknown planner " + name);
    }
    names.push_back(name);
  }
  return names;
}

Settings settings_of(int count, char** arguments) {
  Settings settings;
  settings.time = 2.0;
  for (const auto& [name, make] : planners()) {
    settings.planners.push_back(name);
  }
  read_arguments(count, arguments, settings,
                 [&](const std::string& name, const std::string& value) {
                   if (name == "--planners") {
                     settings.planners = planners_of(value);
                   }
                   return name == "--planners";
                 });
  return settings;
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int count, char** arguments) {
  try {
    return firstcontact::benchmarks::run(firstcontact::benchmarks::settings_of(count, arguments));
  } catch (const std::exception& error) {
    std::cerr << "colliding_paths: " << error.what() << '\n';
    return 2;
  }
}
