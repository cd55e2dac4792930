#include <firstcontact/articulated/detail/least_clearance.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include <firstcontact/articulated/detail/part_search.h>

namespace firstcontact::detail {
namespace {

/// [-]  Of the tolerance: room for the rounding of differences.
constexpr double kPart = 0.999;

/// Two parts in one piece of time, and how far apart balls say that they are.
struct Place {
  PartCandidate candidate;
  double bound = 0.0;  ///< [m]
};

std::vector<Place> places_by_distance(const RobotTimeline& timeline, const BallsOfPieces& balls,
                                      std::size_t index) {
  std::vector<Place> places;
  const TestedPair& pair = timeline.pairs()[index];
  const auto [first, second] = pair.members;
  for (std::size_t piece = 0; piece < timeline.piece_count(); ++piece) {
    if (!timeline.is_tested(pair, piece)) {
      continue;
    }
    for (std::size_t a = timeline.first_part(first); a < timeline.first_part(first + 1); ++a) {
      for (std::size_t b = timeline.first_part(second); b < timeline.first_part(second + 1); ++b) {
        places.push_back({{timeline.piece(piece), piece, index, {a, b}, 0.0},
                          gap_bound(balls[piece][a], balls[piece][b])});
      }
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& x, const Place& y) { return x.bound < y.bound; });
  return places;
}

class Descent {
 public:
  Descent(const RobotCheckOptions& options, LeastClearance& best)
      : options_(options), tolerance_(kPart * options.tolerance), best_(best) {}

  /// [m]  Half way.
  double look(PartSearch& search, const TimeWindow& window) {
    return try_time(search, 0.5 * (window.begin + window.end));
  }

  /// At a few times, and down from the least of them.
  void sample(PartSearch& search, const TimeWindow& window) {
    constexpr int kSamples = 4;
    const auto at = [&](int k) {
      return k == kSamples ? window.end : window.begin + (window.end - window.begin) * k / kSamples;
    };
    std::array<double, kSamples + 1> distances{};
    for (int k = 0; k <= kSamples; ++k) {
      distances[static_cast<std::size_t>(k)] = try_time(search, at(k));
    }
    const auto least =
        static_cast<int>(std::min_element(distances.begin(), distances.end()) - distances.begin());
    narrow(search, at(std::max(least - 1, 0)), at(least), at(std::min(least + 1, kSamples)));
  }

  /// Proves the piece farther than the best distance less the tolerance, or finds a lesser one.
  void run(PartSearch& search, const TimeWindow& window) {
    double t = window.begin;
    while (best_.distance > tolerance_ && best_.reason == UndecidedReason::none) {
      best_.reason = spent(options_.budget);
      if (best_.reason != UndecidedReason::none) {
        return;
      }
      const FirstContactResult found =
          search.first_contact(t, window.end, best_.distance - tolerance_, 0.25 * tolerance_);
      if (found.verdict == Verdict::free) {
        return;
      }
      if (!is_contact(found.verdict)) {
        best_.reason = found.reason;
        return;
      }
      const double before = best_.distance;
      t = found.t;
      sample(search, {t, window.end});
      if (!(best_.distance < before - 0.5 * tolerance_)) {
        best_.reason = UndecidedReason::precision;
      }
    }
  }

 private:
  double try_time(PartSearch& search, double t) {
    const double distance = search.distance(t);
    if (distance < best_.distance) {
      best_.distance = distance;
      best_.t = t;
    }
    return distance;
  }

  /// Descends from the middle of three times.
  void narrow(PartSearch& search, double left, double middle, double right) {
    constexpr int kSteps = 24;
    double at_middle = try_time(search, middle);
    for (int k = 0; k < kSteps && best_.distance > tolerance_; ++k) {
      const bool is_left = middle - left > right - middle;
      const double other = 0.5 * (middle + (is_left ? left : right));
      const double at_other = try_time(search, other);
      if (at_other < at_middle) {
        (is_left ? right : left) = middle;
        middle = other;
        at_middle = at_other;
      } else {
        (is_left ? left : right) = other;
      }
    }
  }

  const RobotCheckOptions& options_;
  double tolerance_;
  LeastClearance& best_;
};

}  // namespace

LeastClearance least_clearance_of(const RobotTimeline& timeline, const BallsOfPieces& balls,
                                  std::size_t pair, const RobotCheckOptions& options,
                                  LinkWorkspace& workspace) {
  constexpr std::size_t kLooks = 8;  // What is near half way is likely to be nearest.
  const double tolerance = kPart * options.tolerance;
  const std::vector<Place> places = places_by_distance(timeline, balls, pair);
  const auto search_of = [&](const Place& place) {
    return PartSearch(timeline, place.candidate, options, workspace);
  };
  LeastClearance best;
  Descent descent(options, best);
  const Place* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  const std::size_t looks =
      spent(options.budget) == UndecidedReason::none ? std::min(kLooks, places.size()) : 0;
  for (std::size_t k = 0; k < looks && places[k].bound < least; ++k) {
    PartSearch search = search_of(places[k]);
    const double distance = descent.look(search, places[k].candidate.window);
    if (distance < least) {
      least = distance;
      nearest = &places[k];
    }
  }
  if (nearest != nullptr) {
    PartSearch search = search_of(*nearest);
    descent.sample(search, nearest->candidate.window);
  }
  double unproven = std::numeric_limits<double>::infinity();  // [m]  Where the budget ended it.
  for (const Place& place : places) {
    if (place.bound >= best.distance - tolerance || best.distance <= tolerance) {
      break;
    }
    PartSearch search = search_of(place);
    descent.run(search, place.candidate.window);
    if (best.reason != UndecidedReason::none) {
      unproven = place.bound;  // Those that come later are no nearer.
      break;
    }
  }
  best.lower_bound = std::max(0.0, std::min(best.distance - tolerance, unproven));
  return best;
}

}  // namespace firstcontact::detail
