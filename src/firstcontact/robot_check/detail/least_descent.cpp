#include <firstcontact/robot_check/detail/least_descent.h>

#include <algorithm>

namespace firstcontact::detail {
namespace {

/// [-]  Part of the tolerance by which distances may differ where a descent ends. The proof finds
/// what is nearer by most of the tolerance.
constexpr double kShareOfClose = 0.125;

/// A time and the distance [m] then.
struct Sample {
  double t = 0.0;
  double distance = 0.0;
};

/// Three times, of which the one in the middle has the least distance.
struct Bracket {
  Sample left;
  Sample middle;
  Sample right;
};

/// The least of a few distances over a window, and its neighbours.
template <class Distance>
Bracket bracket(const TimeWindow& window, int samples, const Distance& distance) {
  const auto sample = [&](int k) {
    const double t =
        k == samples ? window.end : window.begin + (window.end - window.begin) * k / samples;
    return Sample{t, distance(t)};
  };
  Sample before = sample(0);
  Bracket least{before, before, before};
  bool is_last = true;  // Whether the least was the last one so far.
  for (int k = 1; k <= samples; ++k) {
    const Sample here = sample(k);
    if (here.distance < least.middle.distance) {
      least = {before, here, here};
      is_last = true;
    } else if (is_last) {
      least.right = here;
      is_last = false;
    }
    before = here;
  }
  return least;
}

/// Descends from the middle; returns the time of the least distance that it found.
///
/// @param close  [m]  nearer distances at all three times end it
template <class Distance>
double narrow(Bracket at, double close, const Distance& distance) {
  constexpr int kSteps = 24;
  for (int k = 0; k < kSteps; ++k) {
    if (std::max(at.left.distance, at.right.distance) - at.middle.distance <= close) {
      break;
    }
    const bool is_left = at.middle.t - at.left.t > at.right.t - at.middle.t;
    const double t = 0.5 * (at.middle.t + (is_left ? at.left.t : at.right.t));
    const Sample other{t, distance(t)};
    if (other.distance < at.middle.distance) {
      (is_left ? at.right : at.left) = at.middle;
      at.middle = other;
    } else {
      (is_left ? at.left : at.right) = other;
    }
  }
  return at.middle.t;
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
    t = narrow(bracket(window, kSamples, of_triangles), kShareOfClose * tolerance_, of_triangles);
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
  (void)narrow(bracket(window, kSamples, distance), kShareOfClose * tolerance_, distance);
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
