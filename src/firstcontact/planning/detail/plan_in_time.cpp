#include <firstcontact/planning/detail/plan_in_time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/edges/detail/blocked_place.h>
#include <firstcontact/edges/detail/edge_question.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/plan_work.h>
#include <firstcontact/planning/detail/shorten_timed_path.h>
#include <firstcontact/planning/detail/timed_connect.h>
#include <firstcontact/planning/detail/timed_edges.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

using Clock = std::chrono::steady_clock;

void require_times(const PlanScene& scene) {
  const PlanTimes& times = scene.times.value();
  if (!(times.duration > 0.0 && std::isfinite(times.duration))) {
    throw std::invalid_argument("expected a duration of the scene that is finite and > 0");
  }
  if (times.speeds.size() != scene.space.speed_count()) {
    throw std::invalid_argument("expected a speed for each coordinate, and two of each pose");
  }
  for (const double speed : times.speeds) {
    if (!(speed > 0.0 && std::isfinite(speed))) {
      throw std::invalid_argument("expected speeds that are finite and > 0");
    }
  }
}

class PlanInTime {
 public:
  PlanInTime(const PlanScene& scene, const PlanOptions& options)
      : scene_(scene),
        options_(options),
        begin_(Clock::now() - time_in_clock(options.spent)),
        asked_of_edges_{.tolerance = options.tolerance,
                        .extra_clearance = options.extra_clearance + 2.0 * options.tolerance,
                        .effort = options.effort,
                        .stop = options.stop},
        edges_(scene, asked_of_edges_) {}

  PlanResult run(const Configuration& start, const std::vector<Configuration>& goals,
                 double range) {
    PlanResult result;
    require_time(start, goals);
    if (require_free(start, goals)) {
      RandomNumbers random(options_.seed);
      const auto is_over = [this] { return report_and_ask(); };
      TimedFound found =
          timed_connect(edges_, start, goals, range, random, is_over, options_.keep_trees);
      result.trees = std::move(found.trees);
      std::vector<TimedPlace>& path = found.path;
      if (!path.empty()) {
        edges_.counts().first_path_seconds = seconds();
        edges_.counts().first_cost = cost_of(path);
        shorten_timed_path(edges_, path, options_.shortcuts, random, is_over);
        prove(path, goals, result);
      }
    }
    result.statistics = edges_.statistics();
    result.statistics.seconds = seconds();
    return result;
  }

 private:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
  }

  bool report_and_ask() {
    constexpr std::size_t kReportEvery = 64;
    if (options_.progress && ++asked_ % kReportEvery == 0) {
      options_.progress({seconds(), edges_.counts().nodes, edges_.counts().first_cost});
    }
    return options_.stop.stop_requested() || seconds() > options_.time;
  }

  [[nodiscard]] double cost_of(const std::vector<TimedPlace>& path) const {
    double cost = 0.0;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      cost += scene_.space.distance(path[k].q, path[k + 1].q);
    }
    return cost;
  }

  /// Refuses goals that are all too far for the speeds.
  void require_time(const Configuration& start, const std::vector<Configuration>& goals) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Configuration& goal : goals) {
      least = std::min(least, edges_.travel_time(start, goal));
    }
    if (least > edges_.duration()) {
      throw std::invalid_argument("the speeds are too low: the straight way to a goal takes " +
                                  write_json(least) + " s, and the scene lasts " +
                                  write_json(edges_.duration()) + " s");
    }
  }

  /// @param what  "the start, at the time 0,"
  [[noreturn]] void refuse(const TimedPlace& place, const std::string& what) {
    throw std::invalid_argument(describe_blocked(scene_, asked_of_edges_, edges_, place, what));
  }

  /// Requires that the start and a goal are free. False where the search was stopped.
  bool require_free(const Configuration& start, const std::vector<Configuration>& goals) {
    const TimedPlace first{start, 0.0};
    if (edges_.at(first).verdict != Verdict::free) {
      if (options_.stop.stop_requested()) {
        return false;
      }
      refuse(first, "the start, at the time 0,");
    }
    for (const Configuration& goal : goals) {
      const bool is_free = edges_.at({goal, edges_.duration()}).verdict == Verdict::free;
      if (is_free || options_.stop.stop_requested()) {
        return !options_.stop.stop_requested();
      }
    }
    refuse({goals.back(), edges_.duration()}, goals.size() == 1
                                                  ? "the goal, at the end of the time,"
                                                  : "each goal, at the end of the time,");
  }

  /// Proves the whole motion anew, in one piece.
  void prove(const std::vector<TimedPlace>& path, const std::vector<Configuration>& goals,
             PlanResult& result) const {
    std::vector<Configuration> places;
    std::vector<double> times;
    for (const TimedPlace& place : path) {
      places.push_back(place.q);
      times.push_back(place.t / edges_.duration());
    }
    RobotScene scene = scene_of_edges(scene_, options_.extra_clearance);
    scene_.set_motions(scene, places, times);
    RobotCheckOptions question =
        question_of_edges({.tolerance = options_.tolerance, .effort = options_.effort});
    question.threads = options_.threads;
    question.closest = true;
    const SceneResult found = check_robots(scene, question);
    if (found.verdict != Verdict::free) {
      result.warnings.emplace_back("a path was found, but it could not be proven again");
      return;
    }
    const std::optional<double> clearance = std::isfinite(found.clearance)
                                                ? std::optional(std::max(0.0, found.clearance))
                                                : std::nullopt;
    result.clearances.assign(path.size() - 1, clearance);
    result.cost = cost_of(path);
    for (std::size_t k = goals.size(); k-- > 0;) {
      result.goal = goals[k] == places.back() ? std::optional(k) : result.goal;
    }
    result.verdict = PlanVerdict::proven;
    result.path = std::move(places);
    for (const TimedPlace& place : path) {
      result.times.push_back(place.t);
    }
  }

  const PlanScene& scene_;
  const PlanOptions& options_;
  Clock::time_point begin_;
  EdgeCheckOptions asked_of_edges_;
  TimedEdges edges_;
  std::size_t asked_ = 0;
};

}  // namespace

std::string describe_blocked(const PlanScene& scene, const EdgeCheckOptions& options,
                             TimedEdges& edges, const TimedPlace& place, const std::string& what) {
  const EdgeFound found = edges.at(place);
  if (found.verdict == Verdict::undecided || !found.pair) {
    return name_blocked(scene, std::nullopt, what);
  }
  const auto is_free = [&](const Configuration& q) {
    return edges.at({q, place.t}).verdict == Verdict::free;
  };
  const PlaceTest test{scene, options, is_free, place.t / edges.duration()};
  return describe_pair(test, place.q, *found.pair, what + " is not free");
}

PlanResult plan_in_time(const PlanScene& scene, const Configuration& start,
                        const std::vector<Configuration>& goals, double range,
                        const PlanOptions& options) {
  require_times(scene);
  return PlanInTime(scene, options).run(start, goals, range);
}

}  // namespace firstcontact::detail
