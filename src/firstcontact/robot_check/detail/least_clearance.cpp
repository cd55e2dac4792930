#include <firstcontact/robot_check/detail/least_clearance.h>

#include <algorithm>
#include <limits>

#include <firstcontact/robot_check/detail/geometry_search.h>
#include <firstcontact/robot_check/detail/least_descent.h>

namespace firstcontact::detail {
namespace {

/// Two geometries in one piece of time, and the bound of their distance by balls.
struct Place {
  GeometryCandidate candidate;
  double bound = 0.0;  ///< [m]
};

std::vector<Place> places_by_distance(const RobotTimeline& timeline, const BallsOfPieces& balls,
                                      std::size_t index) {
  std::vector<Place> places;
  const TestedPair& pair = timeline.pairs()[index];
  for (std::size_t piece = 0; piece < timeline.piece_count(); ++piece) {
    if (!timeline.is_tested(pair, piece)) {
      continue;
    }
    for (const auto& [a, b] : timeline.geometry_pairs(pair)) {
      places.push_back({{timeline.piece(piece), piece, index, {a, b}, 0.0},
                        gap_bound(balls[piece][a], balls[piece][b])});
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& x, const Place& y) { return x.bound < y.bound; });
  return places;
}

}  // namespace

ClosestApproach least_clearance_of(const RobotTimeline& timeline, const BallsOfPieces& balls,
                                   std::size_t pair, const RobotCheckOptions& options,
                                   LinkWorkspace& workspace) {
  constexpr std::size_t kLooks = 8;  // Geometries that are near at the middle are likely to be
                                     // nearest.
  const double tolerance = kShareOfTolerance * options.tolerance;
  const std::vector<Place> places = places_by_distance(timeline, balls, pair);
  const auto search_of = [&](const Place& place) {
    return GeometrySearch(timeline, place.candidate, options, workspace);
  };
  ClosestApproach best;
  LeastDescent descent(options, best);
  const Place* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  const std::size_t looks =
      spent(options.budget) == UndecidedReason::none ? std::min(kLooks, places.size()) : 0;
  for (std::size_t k = 0; k < looks && places[k].bound < least; ++k) {
    GeometrySearch search = search_of(places[k]);
    const TimeWindow& window = places[k].candidate.window;
    const double distance = descent.look(search, 0.5 * (window.begin + window.end));
    if (distance < least) {
      least = distance;
      nearest = &places[k];
    }
  }
  if (nearest != nullptr) {
    const TimeWindow& window = nearest->candidate.window;
    GeometrySearch search = search_of(*nearest);
    descent.descend(search, window, 0.5 * (window.begin + window.end));
  }
  double unproven = std::numeric_limits<double>::infinity();  // [m]  Bound where the budget ended
                                                              // the search.
  for (const Place& place : places) {
    if (place.bound >= best.distance - tolerance || best.distance <= tolerance) {
      break;
    }
    GeometrySearch search = search_of(place);
    descent.run(search, place.candidate.window);
    if (best.reason != UndecidedReason::none) {
      unproven = place.bound;  // Later places are no nearer.
      break;
    }
  }
  best.lower_bound = std::max(0.0, std::min(best.distance - tolerance, unproven));
  return best;
}

}  // namespace firstcontact::detail
