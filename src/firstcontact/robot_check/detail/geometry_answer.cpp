#include <firstcontact/robot_check/detail/geometry_answer.h>

#include <algorithm>
#include <utility>

#include <firstcontact/many_bodies/detail/contact_intervals.h>

namespace firstcontact::detail {
namespace {

/// A contact without a search: one of the two starts inside of the other.
FirstContactResult inside_at(GeometrySearch& search, double t) {
  FirstContactResult result;
  result.verdict = t == 0.0 ? Verdict::contact_at_start : Verdict::contact;
  result.t = t;
  result.t_upper = t;
  result.contacts = {search.nearest(t).closest.value()};
  result.contact_count = {1, true};
  return result;
}

void finish(GeometrySearch& search, GeometryAnswer& answer) {
  answer.first.contacts = search.in_world(answer.first.contacts, answer.first.t);
  answer.margin = search.threshold_at(answer.first.t);
  if (answer.first.verdict == Verdict::free) {
    answer.first.t = 1.0;
  }
}

}  // namespace

GeometryAnswer first_contact_of(GeometrySearch& search, const GeometryCandidate& candidate,
                                double horizon, bool may_start_inside) {
  GeometryAnswer answer;
  const auto [begin, end] = candidate.window;
  answer.first = may_start_inside && search.is_inside(begin)
                     ? inside_at(search, begin)
                     : search.first_contact({begin, std::min(end, horizon)});
  answer.work = answer.first.work;
  finish(search, answer);
  return answer;
}

GeometryAnswer contact_intervals_of(GeometrySearch& search, const GeometryCandidate& candidate,
                                    double resolution) {
  GeometryAnswer answer = first_contact_of(search, candidate, candidate.window.end, true);
  const double margin = candidate.threshold;
  const ContactQueries queries{
      .first_contact = [&](const TimeWindow& window) { return search.first_contact(window); },
      .distance = [&](double t) { return search.distance(t) - (search.threshold_at(t) - margin); }};
  IntervalsFound found = contact_intervals(
      answer.first, {.window = candidate.window, .margin = margin, .resolution = resolution},
      queries);
  answer.intervals = std::move(found.intervals);
  answer.first.tolerance_used = std::max(answer.first.tolerance_used, found.tolerance_used);
  answer.work += found.work;
  return answer;
}

}  // namespace firstcontact::detail
