#include <firstcontact/robot_check/detail/tracked_contact.h>

#include <algorithm>
#include <optional>

namespace firstcontact::detail {
namespace {

/// [-]  Part of the tolerance by which a bound over a window may exceed that at a contact.
constexpr double kShareOfTolerance = 0.25;

/// [-]  Lengths of windows, by the one before: after a contact that may be none, and after a free
/// one.
constexpr double kShorter = 0x1p-4;
constexpr double kLonger = 4.0;

/// The steps of an answer that count, as in WorkBudget; at least one, so that all searches end.
std::uint64_t steps_of(const WorkCount& work) {
  return std::max<std::uint64_t>(1, work.node_groups + work.steps);
}

}  // namespace

FirstContactResult first_contact_within_errors(const TimeWindow& window, double tolerance,
                                               std::uint64_t steps, const TrackedQueries& queries) {
  const double loose = kShareOfTolerance * tolerance;
  TimeWindow part = window;
  WorkCount work;
  std::uint64_t left = steps;
  while (true) {
    const double error = queries.error(part);
    FirstContactResult found =
        queries.first_contact(part, error, tolerance - loose, std::max<std::uint64_t>(1, left));
    work += found.work;
    left -= std::min(left, steps_of(found.work));
    found.work = work;
    const double length = part.end - part.begin;
    if (found.verdict == Verdict::free) {
      if (part.end == window.end) {
        found.tolerance_used = tolerance;
        return found;
      }
      part = {part.end, std::min(window.end, part.end + kLonger * length)};
    } else if (!is_contact(found.verdict)) {
      found.t_upper = std::nullopt;  // It may be no contact within the bound of its own time.
      return found;
    } else {
      const double t = found.t;
      const double excess = std::max(0.0, error - queries.error({t, t}));
      const double end = std::min(window.end, t + kShorter * length);
      const bool is_shortest = t < window.end && !(t < end);  // No double is in between.
      if (excess <= loose || is_shortest) {
        found.tolerance_used = std::max(tolerance, found.tolerance_used + excess);
        return found;
      }
      part = {t, end};
    }
    if (left == 0) {
      found.verdict = Verdict::undecided;
      found.reason = UndecidedReason::work;
      found.t = part.begin;
      found.t_upper = std::nullopt;
      found.contacts.clear();
      found.contact_count = {};
      return found;
    }
  }
}

}  // namespace firstcontact::detail
