#include <firstcontact/retiming/detail/held_stretches.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

namespace firstcontact::detail {
namespace {

bool rests(const TimedPoint& point) {
  const auto is_zero = [](double number) { return number == 0.0; };
  return std::ranges::all_of(point.velocities, is_zero) &&
         std::ranges::all_of(point.accelerations, is_zero);
}

/// Whether a is closer than b: a free motion has the closest approach of its closest stretch.
bool is_closer(const SceneResult& a, const SceneResult& b) {
  const auto distance = [](const SceneResult& result) {
    return result.closest ? result.pairs.at(*result.closest).closest->distance
                          : std::numeric_limits<double>::infinity();
  };
  return distance(a) < distance(b);
}

/// A time of a stretch in the motion, rounded downward: before a contact all is proven free.
double in_motion(double t, const StretchResult& stretch, double duration) {
  const double time = stretch.begin + t * (stretch.end - stretch.begin);
  return std::clamp(time / duration * (1.0 - 0x1p-50), 0.0, 1.0);
}

void take_time(Outcome& outcome, const StretchResult& stretch, double duration) {
  outcome.t = in_motion(outcome.t, stretch, duration);
  outcome.t_upper = is_contact(outcome.verdict) ? std::optional(outcome.t) : std::nullopt;
  if (outcome.verdict == Verdict::contact_at_start && stretch.begin > 0.0) {
    outcome.verdict = Verdict::contact;
  }
}

void take_times(StretchResult& stretch, double duration) {
  if (stretch.begin == 0.0 && stretch.end == duration) {
    return;
  }
  take_time(stretch.result, stretch, duration);
  for (PairAnswer& pair : stretch.result.pairs) {
    take_time(pair, stretch, duration);
    pair.contacts.clear();  // Their velocities are per stretch.
    if (pair.closest) {
      pair.closest->t = in_motion(pair.closest->t, stretch, duration);
    }
  }
}

}  // namespace

HeldStretches::HeldStretches(const TimedMotion& motion, std::span<const RetimingHold> holds)
    : motion_(motion), holds_(holds) {
  const std::size_t end = motion.points.size() - 1;
  std::set<std::size_t> cuts{0, end};
  bool cuts_begin = false;
  bool cuts_end = false;
  for (const RetimingHold& hold : holds) {
    const Stretch held = held_points(hold);
    if (hold.opens_at.empty()) {
      continue;
    }
    const std::size_t cut = hold.at == PathEnd::start ? held.last : held.first;
    cuts.insert(cut);
    cuts_begin = cuts_begin || cut == 0;
    cuts_end = cuts_end || cut == end;
  }
  if (cuts_begin || end == 0) {
    stretches_.push_back({0, 0});
  }
  for (auto cut = cuts.begin(); std::next(cut) != cuts.end(); ++cut) {
    if (*cut > 0 && is_held_on_both_sides(*cut)) {
      stretches_.push_back({*cut, *cut});
    }
    stretches_.push_back({*cut, *std::next(cut)});
  }
  if (cuts_end && end > 0) {
    stretches_.push_back({end, end});
  }
}

bool HeldStretches::is_held_on_both_sides(std::size_t cut) const {
  bool any = false;
  for (const RetimingHold& opening : holds_) {
    for (const RetimingHold& closing : holds_) {
      const bool are_both_ends = opening.members == closing.members &&
                                 opening.at == PathEnd::start && closing.at == PathEnd::goal &&
                                 !opening.opens_at.empty() && !closing.opens_at.empty();
      if (!are_both_ends) {
        continue;
      }
      const std::size_t opened = held_points(opening).last;
      const std::size_t closes = held_points(closing).first;
      if (closes < opened) {
        throw std::invalid_argument(
            "expected a motion in which a contact pair has opened before it is held at the goal");
      }
      any = any || (opened == cut && closes == cut);
    }
  }
  return any;
}

HeldStretches::Stretch HeldStretches::held_points(const RetimingHold& hold) const {
  const std::vector<TimedPoint>& points = motion_.points;
  if (hold.opens_at.empty()) {
    return {0, points.size() - 1};
  }
  const auto is_open = [&](const TimedPoint& point) {
    return point.positions == hold.opens_at && rests(point);
  };
  const auto first = std::ranges::find_if(points, is_open);
  if (first == points.end()) {
    throw std::invalid_argument(
        "expected a motion that rests at the waypoint where contact pairs "
        "have opened");
  }
  if (hold.at == PathEnd::start) {
    return {0, static_cast<std::size_t>(first - points.begin())};
  }
  const auto last = std::find_if(points.rbegin(), points.rend(), is_open);
  return {static_cast<std::size_t>(points.rend() - last) - 1, points.size() - 1};
}

double HeldStretches::seconds(std::size_t point) const {
  return static_cast<double>(motion_.points[point].time) / 1e9;
}

double HeldStretches::begin(std::size_t stretch) const {
  return seconds(stretches_[stretch].first);
}

double HeldStretches::end(std::size_t stretch) const { return seconds(stretches_[stretch].last); }

TimedMotion HeldStretches::motion(std::size_t stretch) const {
  const auto [first, last] = stretches_[stretch];
  TimedMotion part{motion_.joint_names, {}};
  for (std::size_t k = first; k <= last; ++k) {
    part.points.push_back(motion_.points[k]);
    part.points.back().time -= motion_.points[first].time;
  }
  return part;
}

std::vector<RetimingHold> HeldStretches::holds(std::size_t stretch) const {
  const auto [first, last] = stretches_[stretch];
  std::vector<RetimingHold> all;
  for (const RetimingHold& hold : holds_) {
    const Stretch held = held_points(hold);
    // At the rest itself the pair is open.
    const bool is_open_rest = first == last && !hold.opens_at.empty() &&
                              first == (hold.at == PathEnd::start ? held.last : held.first);
    if (held.first <= first && last <= held.last && !is_open_rest) {
      all.push_back(hold);
    }
  }
  return all;
}

std::vector<ProvenHold> HeldStretches::times() const {
  std::vector<ProvenHold> all;
  for (const RetimingHold& hold : holds_) {
    const Stretch held = held_points(hold);
    all.push_back({hold.members, hold.distance, seconds(held.first), seconds(held.last)});
  }
  return all;
}

void append_result(StretchResult next, double duration, SceneResult& all) {
  take_times(next, duration);
  if (all.verdict != Verdict::free || next.result.verdict != Verdict::free) {
    all = std::move(next.result);
    return;
  }
  if (is_closer(next.result, all)) {
    all.pairs = std::move(next.result.pairs);
    all.closest = next.result.closest;
  }
  all.t = 1.0;
  all.clearance = std::min(all.clearance, next.result.clearance);
  all.tolerance_used = std::max(all.tolerance_used, next.result.tolerance_used);
  all.enclosure_error = std::max(all.enclosure_error, next.result.enclosure_error);
  all.work += next.result.work;
}

}  // namespace firstcontact::detail
