#include <firstcontact/planning/detail/timed_edges.h>

#include <algorithm>
#include <array>
#include <utility>

#include <firstcontact/edges/detail/edge_question.h>

namespace firstcontact::detail {
namespace {

constexpr double kRounding = 1e-12;  // [-]  Relative excess that rounding allows over the speeds.

}  // namespace

TimedEdges::TimedEdges(const PlanScene& plan, const EdgeCheckOptions& options)
    : plan_(plan),
      search_(scene_of_edges(plan, options.extra_clearance), question_of_edges(options)) {}

EdgeFound TimedEdges::ask(const TimedPlace& from, const TimedPlace& to) {
  // Times are divided as in a check of the whole motion, bit for bit.
  const std::array<double, 2> times{from.t / duration(), to.t / duration()};
  const bool is_place = !(times[0] < times[1]);
  const std::array<Configuration, 2> places{from.q, to.q};
  if (is_place) {
    plan_.set_motions(search_, from.q, from.q);
  } else {
    plan_.set_motions(search_, places, times);
  }
  ++(is_place ? counts_.states_checked : counts_.edges_checked);
  const EdgeFound found = search_.any_contact({times[0], std::max(times[0], times[1])});
  if (found.verdict == Verdict::undecided) {
    ++counts_.undecided;
  } else if (found.verdict != Verdict::free && found.pair) {
    ++blocked_[*found.pair];
  }
  return found;
}

bool TimedEdges::is_free(const TimedPlace& from, const TimedPlace& to) {
  // Where the quotients are equal, only a place would be checked.
  const bool has_length = from.t / duration() < to.t / duration();
  return has_length && travel_time(from.q, to.q) <= (to.t - from.t) * (1.0 + kRounding) &&
         ask(from, to).verdict == Verdict::free;
}

EdgeFound TimedEdges::at(const TimedPlace& place) { return ask(place, place); }

PlanStatistics TimedEdges::statistics() const {
  PlanStatistics statistics = counts_;
  for (const auto& [pair, count] : blocked_) {
    statistics.blocked.push_back({pair, count});
  }
  std::stable_sort(statistics.blocked.begin(), statistics.blocked.end(),
                   [](const BlockingPair& a, const BlockingPair& b) { return a.count > b.count; });
  return statistics;
}

}  // namespace firstcontact::detail
