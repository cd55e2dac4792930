#include <firstcontact/robot_check/detail/least_descent.h>

#include <algorithm>

namespace firstcontact::detail {
namespace {

/// Three times, of which the one in the middle has the least distance.
struct Bracket {
  double left = 0.0;
  double middle = 0.0;
  double right = 0.0;
};

/// The least of a few distances over a window, and its neighbours.
template <class Distance>
Bracket bracket(const TimeWindow& window, int samples, const Distance& distance) {
  const auto at = [&](int k) {
    return k == samples ? window.end : window.begin + (window.end - window.begin) * k / samples;
  };
  int least = 0;
  double least_distance = distance(at(0));
  for (int k = 1; k <= samples; ++k) {
    const double here = distance(at(k));
    if (here < least_distance) {
      least = k;
      least_distance = here;
    }
  }
  return {at(std::max(least - 1, 0)), at(least), at(std::min(least + 1, samples))};
}

/// Descends from the middle; returns the time of the least distance that it found.
template <class Distance>
double narrow(Bracket times, const Distance& distance) {
  constexpr int kSteps = 24;
  double at_middle = distance(times.middle);
  for (int k = 0; k < kSteps; ++k) {
    const bool is_left = times.middle - times.left > times.right - times.middle;
    const double other = 0.5 * (times.middle + (is_left ? times.left : times.right));
    const double at_other = distance(other);
    if (at_other < at_middle) {
      (is_left ? times.right : times.left) = times.middle;
      times.middle = other;
      at_middle = at_other;
    } else {
      (is_left ? times.left : times.right) = other;
    }
  }
  return times.middle;
}

}  // namespace

double LeastDescent::look(GeometrySearch& search, double t) {
  const DistanceResult found = search.nearest(t);
  if (found.distance < best_.distance) {
    best_.distance = found.distance;
    best_.t = t;
    best_.closest = search.in_world(found.closest.value(), t);
  }
  return found.distance;
}

bool LeastDescent::improve(GeometrySearch& search, double t) {
  const double before = best_.distance;
  return !search.is_farther(t, before) && look(search, t) < before;
}

void LeastDescent::descend(GeometrySearch& search, const TimeWindow& window, double t) {
  constexpr int kMostPairs = 6;
  constexpr int kSamples = 16;
  double before = look(search, t);
  for (int k = 0; k < kMostPairs && best_.distance > tolerance_ && best_.t == t; ++k) {
    const auto of_triangles = [&, closest = best_.closest.value()](double time) {
      return search.distance_of_triangles(closest, time);
    };
    t = narrow(bracket(window, kSamples, of_triangles), of_triangles);
    if (!(look(search, t) < before - 0.5 * tolerance_)) {
      return;
    }
    before = best_.distance;
  }
  if (best_.distance > tolerance_ && best_.t == t) {
    sample(search, window);  // At each time other triangles are closest.
  }
}

void LeastDescent::sample(GeometrySearch& search, const TimeWindow& window) {
  constexpr int kSamples = 4;
  const auto distance = [&](double time) { return look(search, time); };
  (void)narrow(bracket(window, kSamples, distance), distance);
}

void LeastDescent::run(GeometrySearch& search, const TimeWindow& window) {
  double t = window.begin;
  while (best_.distance > tolerance_ && best_.reason == UndecidedReason::none) {
    best_.reason = spent(options_.budget);
    if (best_.reason != UndecidedReason::none) {
      return;
    }
    const FirstContactResult found =
        search.first_contact({t, window.end}, best_.distance - tolerance_, 0.25 * tolerance_);
    if (found.verdict == Verdict::free) {
      return;
    }
    if (!is_contact(found.verdict)) {
      best_.reason = found.reason;
      return;
    }
    const double before = best_.distance;
    t = found.t;
    descend(search, {t, window.end}, t);
    if (!(best_.distance < before - 0.5 * tolerance_)) {
      best_.reason = UndecidedReason::precision;
    }
  }
}

}  // namespace firstcontact::detail
