#include <firstcontact/robot_check/detail/contact_intervals.h>

#include <algorithm>
#include <utility>

namespace firstcontact::detail {
namespace {

/// Bisections of one step of the resolution, to find where a contact ends.
constexpr int kBisections = 10;

/// A contact without a search: one of the two starts inside of the other.
FirstContactResult inside_at(PartSearch& search, double t) {
  FirstContactResult result;
  result.verdict = t == 0.0 ? Verdict::contact_at_start : Verdict::contact;
  result.t = t;
  result.t_upper = t;
  result.contacts = {search.nearest(t).closest.value()};
  result.contact_count = {1, true};
  return result;
}

std::uint64_t steps_of(const FirstContactResult& result) {
  return result.work.node_groups + result.work.triangle_pairs + result.work.steps;
}

/// From a contact at t on: the first time found at which the two are apart, or the window's end.
double end_of_contact(PartSearch& search, double t, double t_end, double resolution,
                      double tolerance_used) {
  double touching = t;
  while (true) {
    double apart = std::min(touching + resolution, t_end);
    if (search.touch(apart, tolerance_used)) {
      touching = apart;
      if (apart == t_end) {
        return t_end;
      }
      continue;
    }
    for (int k = 0; k < kBisections; ++k) {
      const double middle = 0.5 * (touching + apart);
      (search.touch(middle, tolerance_used) ? touching : apart) = middle;
    }
    return apart;
  }
}

void finish(PartSearch& search, PartAnswer& answer) {
  answer.contacts = search.in_world(answer.first.contacts, answer.first.t);
  if (answer.first.verdict == Verdict::free) {
    answer.first.t = 1.0;
  }
}

}  // namespace

PartAnswer first_contact_of(PartSearch& search, const PartCandidate& candidate, double horizon,
                            bool may_start_inside) {
  PartAnswer answer;
  const auto [begin, end] = candidate.window;
  answer.first = may_start_inside && search.is_inside(begin)
                     ? inside_at(search, begin)
                     : search.first_contact({begin, std::min(end, horizon)});
  answer.steps = steps_of(answer.first);
  finish(search, answer);
  return answer;
}

PartAnswer contact_intervals_of(PartSearch& search, const PartCandidate& candidate,
                                double resolution) {
  PartAnswer answer;
  const auto [begin, end] = candidate.window;
  FirstContactResult found =
      search.is_inside(begin) ? inside_at(search, begin) : search.first_contact({begin, end});
  answer.first = found;
  while (true) {
    answer.steps += steps_of(found);
    if (found.verdict == Verdict::free) {
      break;
    }
    if (!is_contact(found.verdict)) {
      answer.intervals.push_back({found.t, end, found.reason});
      break;
    }
    const double leave = end_of_contact(search, found.t, end, resolution, found.tolerance_used);
    answer.intervals.push_back({found.t, leave});
    if (leave == end) {
      break;
    }
    found = search.first_contact({leave, end});
  }
  finish(search, answer);
  return answer;
}

std::vector<ContactInterval> joined(std::vector<ContactInterval> intervals, double resolution) {
  std::sort(intervals.begin(), intervals.end(),
            [](const ContactInterval& x, const ContactInterval& y) {
              return std::pair(x.enter, x.leave) < std::pair(y.enter, y.leave);
            });
  std::vector<ContactInterval> all;
  for (const ContactInterval& interval : intervals) {
    if (all.empty() || interval.enter - all.back().leave > resolution) {
      all.push_back(interval);
      continue;
    }
    ContactInterval& last = all.back();
    last.leave = std::max(last.leave, interval.leave);
    last.reason = last.reason != UndecidedReason::none ? last.reason : interval.reason;
  }
  return all;
}

}  // namespace firstcontact::detail
