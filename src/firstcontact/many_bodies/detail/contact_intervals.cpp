#include <firstcontact/many_bodies/detail/contact_intervals.h>

#include <algorithm>
#include <utility>

namespace firstcontact::detail {
namespace {

/// Bisections of one step of the resolution at the end of a contact.
constexpr int kBisections = 10;

/// Finds the first sampled time after a contact at which the two are apart, or the window's end.
double end_of_contact(const Outcome& contact, const IntervalSearch& search,
                      const ContactQueries& queries) {
  const auto touch = [&](double t) {
    return !(queries.distance(t) > search.margin + contact.tolerance_used);
  };
  double touching = contact.t;
  while (true) {
    double apart = std::min(touching + search.resolution, search.window.end);
    if (touch(apart)) {
      touching = apart;
      if (apart == search.window.end) {
        return apart;
      }
      continue;
    }
    for (int k = 0; k < kBisections; ++k) {
      const double middle = 0.5 * (touching + apart);
      (touch(middle) ? touching : apart) = middle;
    }
    return apart;
  }
}

}  // namespace

IntervalsFound contact_intervals(const FirstContactResult& first, const IntervalSearch& search,
                                 const ContactQueries& queries) {
  IntervalsFound all;
  const double end = search.window.end;
  Outcome found = first;
  while (true) {
    all.tolerance_used = std::max(all.tolerance_used, found.tolerance_used);
    if (found.verdict == Verdict::free) {
      return all;
    }
    if (!is_contact(found.verdict)) {
      all.intervals.push_back({found.t, end, found.reason});
      return all;
    }
    const double leave = end_of_contact(found, search, queries);
    all.intervals.push_back({found.t, leave});
    if (leave == end) {
      return all;
    }
    const FirstContactResult next = queries.first_contact({leave, end});
    all.work += next.work;
    found = next;
  }
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
