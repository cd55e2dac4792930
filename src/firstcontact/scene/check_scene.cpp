#include <firstcontact/scene/check_scene.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/text/write_json.h>

namespace firstcontact {

namespace {

using Clock = std::chrono::steady_clock;

WorkBudget budget_of(const Scene& scene, const CheckOptions& options) {
  WorkBudget budget;
  budget.stop = options.stop;
  constexpr double kYear = 3e7;  // [s]  Longer deadlines are none, and would overflow the clock.
  if (scene.options.deadline && *scene.options.deadline <= kYear) {
    budget.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                         std::chrono::duration<double>(*scene.options.deadline));
  }
  return budget;
}

ManyBodiesOptions query_options(const Scene& scene, const CheckOptions& options) {
  return {.pair = {.margin = 0.0,
                   .tolerance = scene.options.tolerance,
                   .start_contacts = scene.options.start_contacts,
                   .contacts = scene.options.contacts,
                   .contact_band = scene.options.contact_band,
                   .budget = budget_of(scene, options)},
          .threads = options.threads,
          .closest = options.closest,
          .progress = options.progress};
}

bool is_contact(const FirstContactResult& result) {
  return result.verdict == Verdict::contact || result.verdict == Verdict::contact_at_start;
}

/// Whether `a` says more about the scene than `b`: it ends what is proven earlier, or it is a
/// contact at the same time (which holds for the scene too, as no pair touches before it).
bool decides_before(const FirstContactResult& a, const FirstContactResult& b) {
  if (a.verdict == Verdict::free || b.verdict == Verdict::free) {
    return a.verdict != Verdict::free && b.verdict == Verdict::free;
  }
  return a.t < b.t || (a.t == b.t && is_contact(a) && !is_contact(b));
}

void add(const WorkCount& work, WorkCount& sum) {
  sum.node_groups += work.node_groups;
  sum.triangle_pairs += work.triangle_pairs;
  sum.steps += work.steps;
}

/// The index of the least pair by an order, the first of equals.
template <typename Less>
std::size_t least(const std::vector<PairAnswer>& pairs, Less less) {
  return static_cast<std::size_t>(std::min_element(pairs.begin(), pairs.end(), less) -
                                  pairs.begin());
}

/// The pair that answers for the scene gives the verdict and the time.
void take_verdict(SceneResult& result) {
  const std::size_t first = least(result.pairs, [](const PairAnswer& a, const PairAnswer& b) {
    return decides_before(a.first_contact, b.first_contact);
  });
  const FirstContactResult& deciding = result.pairs[first].first_contact;
  result.verdict = deciding.verdict;
  result.reason = deciding.reason;
  result.t = deciding.t;
  if (deciding.verdict != Verdict::free) {
    result.first = first;
  }
}

/// What holds of all pairs together.
void gather(SceneResult& result) {
  for (PairAnswer& pair : result.pairs) {
    FirstContactResult& answer = pair.first_contact;
    if (pair.closest_approach) {
      answer.clearance = std::max(answer.clearance, pair.closest_approach->lower_bound);
    }
    result.clearance = std::min(result.clearance, answer.clearance);
    result.tolerance_used = std::max(result.tolerance_used, answer.tolerance_used);
    if (answer.t_upper) {
      result.t_upper = std::min(result.t_upper.value_or(1.0), *answer.t_upper);
    }
    add(answer.work, result.work);
    if (pair.closest_approach) {
      add(pair.closest_approach->work, result.work);
    }
  }
}

/// The pair that comes closest; of those that touch the first to do so.
std::size_t closest_of(const std::vector<PairAnswer>& pairs) {
  const auto order = [](const PairAnswer& pair) {
    const ClosestApproachResult& found = *pair.closest_approach;
    const bool touch = found.reason == UndecidedReason::none && found.lower_bound == 0.0;
    return std::pair(touch ? 0.0 : found.distance, found.t);
  };
  return least(pairs,
               [&order](const PairAnswer& a, const PairAnswer& b) { return order(a) < order(b); });
}

SceneResult from_first(ManyBodiesResult found) {
  SceneResult result;
  result.verdict = found.verdict;
  result.reason = found.reason;
  result.t = found.t;
  result.t_upper = found.t_upper;
  result.clearance = found.clearance;
  result.tolerance_used = found.tolerance_used;
  result.work = found.work;
  result.pairs = std::move(found.first);
  if (!result.pairs.empty()) {
    result.first = 0;
  }
  return result;
}

SceneResult from_each_pair(std::vector<PairAnswer> pairs, const SceneOptions& asked, bool closest) {
  SceneResult result;
  result.verdict = Verdict::free;
  result.t = 1.0;
  result.clearance = std::numeric_limits<double>::infinity();
  result.tolerance_used = asked.tolerance;
  result.pairs = std::move(pairs);
  if (!result.pairs.empty()) {
    take_verdict(result);
    gather(result);
    result.closest = closest ? std::optional(closest_of(result.pairs)) : std::nullopt;
  }
  return result;
}

void require_for_robots(const SceneOptions& asked) {
  if (asked.start_contacts != StartContacts::report || asked.contact_band > 0.0) {
    throw std::invalid_argument(
        "options: start_contacts and contact_band are not for scenes with robots");
  }
}

SceneResult check_with_robots(const LoadedScene& loaded, const CheckOptions& options) {
  const SceneOptions& asked = loaded.scene.options;
  require_for_robots(asked);
  RobotCheckResult found =
      check_robots(*loaded.robots, {.tolerance = asked.tolerance,
                                    .contacts = asked.contacts,
                                    .budget = budget_of(loaded.scene, options),
                                    .threads = options.threads,
                                    .all_pairs = options.all_pairs,
                                    .all_contact_intervals = options.all_contacts_in_time,
                                    .least_clearance = options.closest,
                                    .progress = options.progress});
  SceneResult result;
  result.verdict = found.verdict;
  result.reason = found.reason;
  result.t = found.t;
  result.t_upper = found.t_upper;
  result.clearance = found.clearance;
  result.tolerance_used = found.tolerance_used;
  result.work.steps = found.steps;
  result.robots = std::move(found);
  return result;
}

}  // namespace

std::vector<std::string> check_warnings(const LoadedScene& loaded) {
  std::vector<std::string> names;
  for (const Body& body : loaded.scene.bodies) {
    if (body.free) {
      names.push_back(body.name);
    }
  }
  for (const SceneRobot& robot : loaded.scene.robots) {
    if (robot.dynamics) {
      names.push_back(robot.name);
    }
  }
  std::vector<std::string> warnings = loaded.warnings;
  if (std::string warning = no_pair_warning(loaded.pair_counts); !warning.empty()) {
    warnings.push_back(std::move(warning));
  }
  if (!names.empty()) {
    warnings.push_back(
        detail::in_quotes(names.front()) +
        (names.size() == 1 ? "" : " and " + std::to_string(names.size() - 1) + " more") +
        " with \"dynamics\": at rest here; \"firstcontact simulate\" moves what has dynamics");
  }
  return warnings;
}

double proven_clearance(const RobotPairAnswer& pair) {
  return std::max(pair.t > 0.0 ? pair.threshold : 0.0,
                  pair.least_clearance ? pair.least_clearance->lower_bound : 0.0);
}

SceneResult check_scene(const LoadedScene& loaded, ManyBodiesWorkspace& workspace,
                        const CheckOptions& options) {
  if (loaded.robots) {
    return check_with_robots(loaded, options);
  }
  if (options.all_contacts_in_time) {
    throw std::invalid_argument("all contacts in time are found in scenes with robots only");
  }
  const ManyBodiesOptions query = query_options(loaded.scene, options);
  if (options.all_pairs || options.closest) {
    return from_each_pair(answer_each_pair(loaded.bodies, workspace, query), loaded.scene.options,
                          options.closest);
  }
  return from_first(first_contact(loaded.bodies, workspace, query));
}

}  // namespace firstcontact
