#include <firstcontact/planning/plan_path.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/edges/detail/blocked_place.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/parallel/parallel_for.h>
#include <firstcontact/planning/detail/contact_ends.h>
#include <firstcontact/planning/detail/lazy_prm.h>
#include <firstcontact/planning/detail/plan_in_time.h>
#include <firstcontact/planning/detail/plan_range.h>
#include <firstcontact/planning/detail/plan_work.h>
#include <firstcontact/planning/detail/rrt_connect.h>
#include <firstcontact/planning/detail/shorten_path.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::EdgePlace;
using detail::FoundPath;
using detail::PlanWork;

constexpr std::uint64_t kLessEffort = 20;

/// [-]  Trees grow to less than a blocked edge's fraction; slides begin where it ends.
constexpr double kFractionTolerance = 1e-3;
constexpr int kWiderMargins = 20;  // Number of margins, each wider than the one before.
constexpr double kWider = 4.0;     // [-]  Factor from one margin to the next; the last one grows by
                                   // half of it.
/// [-]  Divisor of the effort: the least distance is computed along edges whose proof takes less.
constexpr std::uint64_t kShareOfEasy = 100;

void require_plan(bool condition, const std::string& what) {
  if (!condition) {
    throw std::invalid_argument(what);
  }
}

void require_plan_options(const PlanOptions& options) {
  require_plan(options.time > 0.0 && std::isfinite(options.time),
               "the time must be finite and > 0 s, got " + detail::shortest(options.time));
  require_plan(options.spent >= 0.0 && std::isfinite(options.spent),
               "the time that is spent must be finite and >= 0 s");
  require_plan(options.range >= 0.0 && std::isfinite(options.range),
               "the range must be finite and >= 0");
  require_plan(options.contacts == ContactUse::none || options.planner == Planner::rrt_connect,
               "contacts: only rrt_connect moves in contact; lazy_prm_star takes \"none\"");
}

void require_places(const ConfigurationSpace& space, const Configuration& start,
                    const std::vector<Configuration>& goals) {
  require_plan(!goals.empty(), "expected at least one goal, got none");
  const std::optional<std::string> of_start = space.defect(start);
  require_plan(!of_start, "the start: " + of_start.value_or(""));
  for (std::size_t k = 0; k < goals.size(); ++k) {
    const std::optional<std::string> of_goal = space.defect(goals[k]);
    const std::string which = goals.size() == 1 ? "" : " " + std::to_string(k);
    require_plan(!of_goal, "the goal" + which + ": " + of_goal.value_or(""));
  }
  require_plan(
      space.is_in_box(start),
      "the start is outside of the box; widen the box, or the bounds of the floating joint");
  for (const Configuration& goal : goals) {
    require_plan(
        space.is_in_box(goal),
        "a goal is outside of the box; widen the box, or the bounds of the floating joint");
  }
  const std::optional<std::string> unbounded = space.unbounded();
  require_plan(!unbounded, "joint " + detail::in_quotes(unbounded.value_or("")) +
                               " slides without limits; give it bounds");
}

/// The effort of the search. In contact an edge is soon tried again and its proven part is kept, so
/// that less effort gains more.
std::uint64_t hasty_effort(const PlanOptions& options) {
  return options.contacts == ContactUse::none
             ? options.effort
             : std::max<std::uint64_t>(options.effort / kLessEffort, 1);
}

/// [m]  The distance that a search keeps beyond the margins.
double kept_by_search(const PlanOptions& options) {
  return options.extra_clearance + 2.0 * options.tolerance;
}

/// One question, from the start to the proof.
class PlanSearch {
 public:
  PlanSearch(const PlanScene& scene, const PlanOptions& options, detail::ContactEnds contacts)
      : scene_(scene),
        options_(options),
        begin_(PlanWork::Clock::now() - detail::time_in_clock(options.spent)),
        end_(begin_ + detail::time_in_clock(options.time)),
        contacts_(std::move(contacts)),
        checker_(scene, options_of_search(EdgePlace::inner, options.effort)),
        hasty_(hasty_effort(options) < options.effort
                   ? std::make_optional<EdgeChecker>(
                         scene, options_of_search(EdgePlace::inner, hasty_effort(options)))
                   : std::nullopt),
        work_(checker_, hasty_ ? *hasty_ : checker_, options_, begin_, end_) {
    for (const PathEnd at : {PathEnd::start, PathEnd::goal}) {
      if (contacts_.opens(at)) {
        at_end(at).emplace(scene, options_of_search(at == PathEnd::start ? EdgePlace::at_start
                                                                         : EdgePlace::at_goal,
                                                    options.effort));
      }
    }
  }

  PlanResult run(const Configuration& start, const std::vector<Configuration>& goals) {
    try {
      require_free(start, goals);
    } catch (const Stopped&) {
      PlanResult none;
      none.statistics = work_.statistics();
      none.statistics.seconds = work_.seconds();
      return none;
    }
    RandomNumbers random(options_.seed);
    const std::optional<Configuration> from = open_ends(start, random);
    FoundPath found = from ? search(*from, random) : FoundPath{{start}, false};
    PlanResult result;
    result.trees = std::move(found.trees);
    result.warnings = contacts_.warnings();
    result.warnings.insert(result.warnings.end(), warnings_.begin(), warnings_.end());
    if (found.reaches_goal) {
      work_.counts().first_path_seconds = work_.seconds();
      FoundPath whole = found;
      add_ends(start, whole);
      work_.counts().first_cost = detail::cost_of(scene_.space, whole.places);
      work_.report(work_.counts().nodes, work_.counts().first_cost);
      detail::shorten_path(work_, found.places, options_.shortcuts, random);
    }
    if (from && (found.reaches_goal || options_.approximate)) {
      add_ends(start, found);
      prove(std::move(found), goals, result);
    }
    result.statistics = work_.statistics();
    result.statistics.seconds = work_.seconds();
    return result;
  }

 private:
  /// Thrown where the search was stopped before it began.
  struct Stopped {};

  /// Throws Stopped where the search was stopped: an undecided check is then no fault of the
  /// question.
  void require_going_on() const {
    if (options_.stop.stop_requested()) {
      throw Stopped();
    }
  }

  /// Leaves out goals that are not free, as long as one is free.
  ///
  /// Only the place of a refusal is described in full: that takes as long as thousands of checks.
  void require_free(const Configuration& start, const std::vector<Configuration>& goals) {
    if (!is_free(start, PathEnd::start)) {
      refuse_blocked(start, PathEnd::start, "the start");
    }
    for (std::size_t k = 0; k < goals.size(); ++k) {
      if (is_free(goals[k], PathEnd::goal)) {
        goals_.push_back(goals[k]);
        continue;
      }
      require_going_on();
      warnings_.push_back(detail::name_blocked(
          scene_, checker_at(PathEnd::goal).check_quickly(goals[k], goals[k]).pair,
          "goal " + std::to_string(k)));
    }
    if (goals_.empty()) {
      refuse_blocked(goals.front(), PathEnd::goal,
                     goals.size() == 1 ? "the goal" : "no goal is free: goal 0");
    }
  }

  [[noreturn]] void refuse_blocked(const Configuration& q, PathEnd at, const std::string& what) {
    require_going_on();
    throw std::invalid_argument(detail::describe_blocked(checker_at(at), q, what));
  }

  [[nodiscard]] EdgeCheckOptions options_of_search(EdgePlace place, std::uint64_t effort) const {
    return {.tolerance = options_.tolerance,
            .extra_clearance = kept_by_search(options_),
            .fraction_tolerance = options_.contacts == ContactUse::none ? kFractionTolerance : 0.0,
            .effort = effort,
            .stop = options_.stop,
            .held = contacts_.held_in_search(place)};
  }

  std::optional<EdgeChecker>& at_end(PathEnd at) {
    return at == PathEnd::start ? at_start_ : at_goal_;
  }

  const EdgeChecker& checker_at(PathEnd at) { return at_end(at) ? *at_end(at) : checker_; }

  bool is_free(const Configuration& q, PathEnd at) {
    if (!at_end(at)) {
      return work_.thoroughly([&] { return work_.is_free(q); });
    }
    ++work_.counts().states_checked;
    return at_end(at)->is_free(q);
  }

  /// Finds the edges on which pairs open; the search begins and ends at their ends.
  ///
  /// It returns none where there is no such edge.
  std::optional<Configuration> open_ends(const Configuration& start, RandomNumbers& random) {
    const auto opening = [&](const Configuration& end, PathEnd at) {
      return at_end(at) ? detail::find_opening({*at_end(at), checker_, end, at, first_step()},
                                               random, [this] { return work_.is_over(); })
                        : std::optional(end);
    };
    std::optional<Configuration> from = opening(start, PathEnd::start);
    for (const Configuration& goal : goals_) {
      if (std::optional<Configuration> target = opening(goal, PathEnd::goal)) {
        targets_.push_back(std::move(*target));
        goal_of_target_.push_back(goal);
      }
    }
    if (!from || targets_.empty()) {
      warnings_.push_back(std::string("contact_pairs: no straight edge was found on which the "
                                      "pairs open at ") +
                          (from ? "the goal" : "the start"));
      from.reset();
    }
    return from;
  }

  /// [m]  Length below which no way leads out of contact.
  [[nodiscard]] double first_step() const { return options_.extra_clearance + options_.tolerance; }

  /// Adds the edges on which pairs open.
  ///
  /// Another edge always remains beside these, if only one of no length: along it the pairs keep
  /// their margins.
  void add_ends(const Configuration& start, FoundPath& found) {
    if (found.places.size() == 1 && (at_start_ || at_goal_)) {
      found.places.push_back(found.places.front());
    }
    if (at_end(PathEnd::goal) && found.reaches_goal) {
      const auto target = std::find(targets_.begin(), targets_.end(), found.places.back());
      found.places.push_back(goal_of_target_[static_cast<std::size_t>(target - targets_.begin())]);
    }
    if (at_end(PathEnd::start)) {
      found.places.insert(found.places.begin(), start);
    }
  }

  FoundPath search(const Configuration& start, RandomNumbers& random) {
    if (std::find(targets_.begin(), targets_.end(), start) != targets_.end()) {
      return {{start}, true};
    }
    const double range =
        options_.range > 0.0 ? options_.range : detail::default_range(scene_.space);
    if (options_.planner == Planner::lazy_prm_star) {
      return detail::lazy_prm_star(work_, start, targets_, range, random);
    }
    return detail::rrt_connect(work_, start, targets_, range, random);
  }

  /// The place of an edge in a path with the edges on which pairs open.
  [[nodiscard]] EdgePlace place_of(std::size_t edge, const FoundPath& found) const {
    if (at_start_ && edge == 0) {
      return EdgePlace::at_start;
    }
    return at_goal_ && found.reaches_goal && edge + 2 == found.places.size() ? EdgePlace::at_goal
                                                                             : EdgePlace::inner;
  }

  [[nodiscard]] EdgeCheckOptions options_of_proof(EdgePlace place) const {
    return {.tolerance = options_.tolerance,
            .extra_clearance = options_.extra_clearance,
            .effort = options_.effort,
            .held = contacts_.held(place)};
  }

  /// Checkers that have not seen the edges of the path.
  struct Proof {
    Proof(const PlanScene& scene, EdgeCheckOptions options) : fresh(scene, options) {
      options.effort = std::max<std::uint64_t>(1, options.effort / kShareOfEasy);
      brief.emplace(scene, options);
    }

    EdgeChecker fresh;
    std::optional<EdgeChecker> brief = {};
  };

  /// Proves an edge, with a clearance that is near the least distance where that takes little work.
  ///
  /// The least distance costs far more than the proof where surfaces are close to each other over
  /// large areas, as screw threads are. So it does where the tolerance is small beside the sizes. A
  /// bound by wider and wider margins avoids that cost.
  [[nodiscard]] EdgeAnswer proof_of(const Proof& proof, const Configuration& from,
                                    const Configuration& to) const {
    const EdgeChecker& fresh = proof.fresh;
    std::optional<double> known;
    if (proof.brief->check(from, to).verdict != EdgeVerdict::undecided) {
      const EdgeAnswer close = fresh.check_closely(from, to);
      if (close.reason == UndecidedReason::none) {
        return close;
      }
      known = close.verdict == EdgeVerdict::free ? close.clearance : std::nullopt;
    }
    EdgeAnswer best = clearance_by_margins(fresh, from, to);
    best.clearance = std::max(best.clearance, known);
    return best;
  }

  /// Proves an edge, with a clearance by wider and wider margins.
  ///
  /// The clearance is at least a quarter of the least distance, where the effort suffices.
  [[nodiscard]] EdgeAnswer clearance_by_margins(const EdgeChecker& fresh, const Configuration& from,
                                                const Configuration& to) const {
    EdgeAnswer best = fresh.check(from, to);
    EdgeCheckOptions asked = fresh.options();
    double extra = options_.extra_clearance + options_.tolerance;
    double wider = kWider;
    for (int k = 0; k < kWiderMargins && best.verdict == EdgeVerdict::free && wider > 1.0; ++k) {
      asked.extra_clearance = wider * extra;
      const EdgeAnswer more = EdgeChecker(scene_, asked).check(from, to);
      const bool is_free = more.verdict == EdgeVerdict::free;
      if (is_free) {
        extra = asked.extra_clearance;
        best.clearance = more.clearance;
      }
      wider = is_free && wider == kWider ? kWider : wider / 2.0;
    }
    return best;
  }

  /// Proves the edges anew, by checkers that have not seen them.
  void prove(FoundPath found, const std::vector<Configuration>& goals, PlanResult& result) const {
    const Proof inner(scene_, options_of_proof(EdgePlace::inner));
    std::optional<Proof> at_start;
    std::optional<Proof> at_goal;
    if (at_start_) {
      at_start.emplace(scene_, options_of_proof(EdgePlace::at_start));
    }
    if (at_goal_) {
      at_goal.emplace(scene_, options_of_proof(EdgePlace::at_goal));
    }
    const auto proof_at = [&](EdgePlace place) -> const Proof& {
      return place == EdgePlace::inner      ? inner
             : place == EdgePlace::at_start ? *at_start
                                            : *at_goal;
    };
    const std::vector<Configuration>& path = found.places;
    const std::size_t edges = std::max<std::size_t>(path.size() - 1, 1);
    std::vector<EdgeAnswer> answers(edges);
    parallel_for(options_.threads, edges, [&](std::size_t k) {
      answers[k] =
          proof_of(proof_at(place_of(k, found)), path[k], path[std::min(k + 1, path.size() - 1)]);
    });
    for (const EdgeAnswer& answer : answers) {
      if (answer.verdict != EdgeVerdict::free) {
        result.warnings.emplace_back("a path was found, but its edges could not be proven again");
        return;
      }
      result.clearances.push_back(answer.clearance);
    }
    result.contact_pairs = contacts_.pairs();
    result.cost = detail::cost_of(scene_.space, path);
    result.distance_to_goal = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < goals.size(); ++k) {
      result.distance_to_goal =
          std::min(result.distance_to_goal, scene_.space.distance(path.back(), goals[k]));
      if (found.reaches_goal && !result.goal && goals[k] == path.back()) {
        result.goal = k;
      }
    }
    result.distance_to_goal = found.reaches_goal ? 0.0 : result.distance_to_goal;
    result.verdict = found.reaches_goal ? PlanVerdict::proven : PlanVerdict::approximate;
    result.path = std::move(found.places);
  }

  const PlanScene& scene_;
  const PlanOptions& options_;
  PlanWork::Clock::time_point begin_;
  PlanWork::Clock::time_point end_;
  detail::ContactEnds contacts_;
  EdgeChecker checker_;
  std::optional<EdgeChecker> hasty_;     // Checker of the search, where that has less effort.
  std::optional<EdgeChecker> at_start_;  // Checker where pairs must open at that end.
  std::optional<EdgeChecker> at_goal_;
  PlanWork work_;
  std::vector<Configuration> goals_;    // The goals that are free.
  std::vector<Configuration> targets_;  // Targets of the search: goals, or places where pairs have
                                        // opened.
  std::vector<Configuration> goal_of_target_;
  std::vector<std::string> warnings_;
};

}  // namespace

PlanResult plan_path(const PlanScene& scene, const Configuration& start,
                     const std::vector<Configuration>& goals, const PlanOptions& options) {
  const FloatEnvironmentGuard guard;
  require_plan_options(options);
  if (goals.empty() && options.stop.stop_requested()) {  // Before there were any.
    PlanResult none;
    none.statistics.seconds = options.spent;
    return none;
  }
  PlanScene widened = scene;
  require_places(scene.space, start, goals);
  widened.space.include(start);
  for (const Configuration& goal : goals) {
    widened.space.include(goal);
  }
  if (widened.times) {
    require_plan(widened.contact_pairs.empty(),
                 "contact_pairs: something else moves; pairs may begin in contact only among "
                 "surroundings at rest");
    require_plan(options.planner == Planner::rrt_connect && options.contacts == ContactUse::none &&
                     !options.approximate,
                 "something else moves: there only the planner rrt_connect plans, with contacts "
                 "\"none\" and without an approximate answer");
    const double range = options.range > 0.0 ? options.range : detail::default_range(widened.space);
    return detail::plan_in_time(widened, start, goals, range, options);
  }
  detail::ContactEnds contacts(widened, start, goals, kept_by_search(options), options.tolerance);
  const bool measures_goal = std::ranges::any_of(
      contacts.pairs(), [](const PlannedContact& one) { return one.pair.at == PathEnd::goal; });
  require_plan(!measures_goal || (!options.approximate && goals.size() == 1),
               "contact_pairs at the goal are measured there; expected one goal, and no "
               "approximate path");
  return PlanSearch(widened, options, std::move(contacts)).run(start, goals);
}

}  // namespace firstcontact
