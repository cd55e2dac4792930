#include <firstcontact/scene/check_scene.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

namespace firstcontact {

namespace {

using Clock = std::chrono::steady_clock;

WorkBudget budget_of(const Scene& scene, const CheckOptions& options) {
  WorkBudget budget;
  budget.stop = options.stop;
  if (scene.options.deadline) {
    budget.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                         std::chrono::duration<double>(*scene.options.deadline));
  }
  return budget;
}

PairResult ask(const LoadedScene& loaded, const ScenePair& pair, const WorkBudget& budget,
               bool closest, Workspace& workspace) {
  const SceneOptions& asked = loaded.scene.options;
  const MovingShape A = loaded.moving_shape(pair.bodies[0]);
  const MovingShape B = loaded.moving_shape(pair.bodies[1]);
  PairResult result{.bodies = pair.bodies,
                    .first_contact = first_contact(A, B, workspace,
                                                   {.margin = pair.margin,
                                                    .tolerance = asked.tolerance,
                                                    .start_contacts = asked.start_contacts,
                                                    .contacts = asked.contacts,
                                                    .contact_band = asked.contact_band,
                                                    .budget = budget}),
                    .closest_approach = {}};
  if (closest) {
    result.closest_approach =
        closest_approach(A, B, workspace, {.tolerance = asked.tolerance, .budget = budget});
  }
  return result;
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
std::size_t least(const std::vector<PairResult>& pairs, Less less) {
  return static_cast<std::size_t>(std::min_element(pairs.begin(), pairs.end(), less) -
                                  pairs.begin());
}

/// The pair that answers for the scene gives the verdict and the time.
void take_verdict(SceneResult& result) {
  const std::size_t first = least(result.pairs, [](const PairResult& a, const PairResult& b) {
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
  for (const PairResult& pair : result.pairs) {
    const FirstContactResult& answer = pair.first_contact;
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

}  // namespace

SceneResult check_scene(const LoadedScene& loaded, Workspace& workspace,
                        const CheckOptions& options) {
  SceneResult result;
  result.verdict = Verdict::free;
  result.t = 1.0;
  result.clearance = std::numeric_limits<double>::infinity();
  result.tolerance_used = loaded.scene.options.tolerance;
  if (loaded.pairs.empty()) {
    return result;
  }
  const WorkBudget budget = budget_of(loaded.scene, options);
  for (const ScenePair& pair : loaded.pairs) {
    if (options.progress) {
      options.progress(result.pairs.size());
    }
    result.pairs.push_back(ask(loaded, pair, budget, options.closest, workspace));
  }
  take_verdict(result);
  gather(result);
  if (options.closest) {
    result.closest = least(result.pairs, [](const PairResult& a, const PairResult& b) {
      return a.closest_approach->distance < b.closest_approach->distance;
    });
  }
  return result;
}

}  // namespace firstcontact
