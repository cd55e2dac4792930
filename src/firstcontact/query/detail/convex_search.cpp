#include <firstcontact/query/detail/convex_search.h>

#include <algorithm>

#include <firstcontact/query/detail/budget_watch.h>

namespace firstcontact::detail {
namespace {

/// Number of steps between two looks at the budget.
constexpr std::uint64_t kStepsAtOnce = 64;

}  // namespace

PieceResult search_convex_pair(const ConvexPair& cores, double t_begin, double t_end,
                               const SearchLimits& limits, WorkCount& work) {
  ConvexContactOptions options{.threshold = limits.threshold,
                               .tolerance = limits.tolerance,
                               .t_begin = t_begin,
                               .t_end = t_end};
  ConvexGuess guess;
  BudgetWatch watch(limits.budget);
  ++work.triangle_pairs;
  PieceResult result;
  result.t = t_begin;
  while (true) {
    result.reason = watch.spent(work.node_groups + work.steps, 0);
    if (result.reason != UndecidedReason::none) {
      return result;
    }
    const std::uint64_t left = limits.budget.steps - (work.node_groups + work.steps);
    options.most_steps = std::min(kStepsAtOnce, left);
    const ConvexContact found = convex_first_contact(cores, options, guess);
    work.steps += found.steps;
    result.t = found.t;
    switch (found.verdict) {
      case ConvexVerdict::free:
        result.finished = true;
        return result;
      case ConvexVerdict::contact:
        result.contact = true;
        return result;
      case ConvexVerdict::unresolved:
        result.contact = found.distance_bound <= limits.band;
        result.reason = result.contact ? UndecidedReason::none : UndecidedReason::precision;
        return result;
      case ConvexVerdict::unfinished:
        break;
    }
    options.t_begin = found.t;
  }
}

}  // namespace firstcontact::detail
