#include <firstcontact/robot_check/detail/least_of_all.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <firstcontact/parallel/parallel_for.h>
#include <firstcontact/robot_check/detail/geometry_search.h>
#include <firstcontact/robot_check/detail/least_descent.h>
#include <firstcontact/robot_check/detail/swept_ball.h>

namespace firstcontact::detail {
namespace {

/// Number of pairs that are looked at first: the nearest by balls are likely to be nearest.
constexpr std::size_t kLooks = 32;

/// Number of pieces that are looked at together, and of searches with the same distance. Rounds are
/// small at first, as one result makes other searches needless. Both are fixed, so that answers do
/// not depend on the number of threads.
constexpr std::size_t kBlock = 32;
constexpr std::size_t kLargestRound = 32;

/// Two geometries in one piece of time, and the bound of their distance by balls.
struct Place {
  GeometryCandidate candidate;
  double bound = std::numeric_limits<double>::infinity();  // [m]

  [[nodiscard]] double middle() const {
    return 0.5 * (candidate.window.begin + candidate.window.end);
  }
};

class Search {
 public:
  Search(const RobotTimeline& timeline, const CandidateSearch& candidates,
         const RobotCheckOptions& options, LinkWorkspaces& workspaces)
      : timeline_(timeline), candidates_(candidates), options_(options), workspaces_(workspaces) {}

  std::optional<LeastOfAll> run(const std::optional<KnownNear>& known) {
    const std::vector<Place> places = nearest_places();
    if (places.empty()) {
      return std::nullopt;
    }
    found_.pair = places.front().candidate.pair;
    if (known) {
      look(known->candidate, known->t);
    }
    look_at(places);
    prove_all();
    const double proven = found_.least.distance - tolerance();
    // Where the search was ended, only the bounds by balls are known.
    found_.least.lower_bound =
        std::max(0.0, is_ended() ? std::min(proven, places.front().bound) : proven);
    return found_;
  }

 private:
  [[nodiscard]] double tolerance() const { return kShareOfTolerance * options_.tolerance; }

  [[nodiscard]] bool is_ended() const { return found_.least.reason != UndecidedReason::none; }

  /// Whether no lesser distance is of interest, or the search has to end.
  [[nodiscard]] bool is_done() {
    if (!is_ended()) {
      found_.least.reason = spent(options_.budget);
    }
    return is_ended() || found_.least.distance <= tolerance();
  }

  /// Whether the two are nearer at t than all distances found so far.
  bool look(const GeometryCandidate& candidate, double t) {
    GeometrySearch search(timeline_, candidate, options_, workspaces_.local());
    const bool is_nearer = LeastDescent(options_, found_.least).improve(search, t);
    if (is_nearer) {
      found_.pair = candidate.pair;
    }
    return is_nearer;
  }

  [[nodiscard]] std::vector<SweptBall> balls_of(std::size_t piece) {
    const TimeWindow window = timeline_.piece(piece);
    std::vector<SweptBall> balls;
    for (std::size_t geometry = 0; geometry < timeline_.geometries().size(); ++geometry) {
      balls.push_back(swept_ball(timeline_.geometries()[geometry].ball,
                                 timeline_.path(geometry, 0.5 * (window.begin + window.end)),
                                 window, workspaces_.local().places));
    }
    return balls;
  }

  /// The place of each tested pair where its balls are nearest, the nearest pair first.
  std::vector<Place> nearest_places() {
    std::vector<Place> places(timeline_.pairs().size());
    for (std::size_t first = 0; first < timeline_.piece_count(); first += kBlock) {
      const std::size_t last = std::min(first + kBlock, timeline_.piece_count());
      std::vector<std::vector<SweptBall>> balls(last - first);
      parallel_for(options_.threads, balls.size(),
                   [&](std::size_t k) { balls[k] = balls_of(first + k); });
      parallel_for(options_.threads, places.size(), [&](std::size_t pair) {
        for (std::size_t piece = first; piece < last; ++piece) {
          find_nearest(pair, piece, balls[piece - first], places[pair]);
        }
      });
    }
    std::erase_if(places, [](const Place& place) {
      return place.bound == std::numeric_limits<double>::infinity();
    });
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& x, const Place& y) { return x.bound < y.bound; });
    return places;
  }

  void find_nearest(std::size_t index, std::size_t piece, const std::vector<SweptBall>& balls,
                    Place& nearest) const {
    const TestedPair& pair = timeline_.pairs()[index];
    if (!timeline_.is_tested(pair, piece)) {
      return;
    }
    for (const auto& [a, b] : timeline_.geometry_pairs(pair)) {
      const double bound = gap_bound(balls[a], balls[b]);
      if (bound < nearest.bound) {
        nearest = {{timeline_.piece(piece), piece, index, {a, b}}, bound};
      }
    }
  }

  /// Looks at the middles of places until no ball is nearer, then descends from the least distance.
  void look_at(const std::vector<Place>& places) {
    const Place* nearest = nullptr;
    for (std::size_t k = 0; k < std::min(kLooks, places.size()); ++k) {
      if (is_done() || places[k].bound >= found_.least.distance) {
        break;
      }
      if (look(places[k].candidate, places[k].middle())) {
        nearest = &places[k];
      }
    }
    if (nearest != nullptr && !is_done()) {
      GeometrySearch search(timeline_, nearest->candidate, options_, workspaces_.local());
      LeastDescent(options_, found_.least)
          .descend(search, nearest->candidate.window, nearest->middle());
    }
  }

  /// Proves that no pair comes nearer, or finds one that does.
  void prove_all() {
    for (std::size_t first = 0; first < timeline_.piece_count() && !is_done(); first += kBlock) {
      const std::size_t last = std::min(first + kBlock, timeline_.piece_count());
      std::vector<std::vector<GeometryCandidate>> of_pieces(last - first);
      const double distance = found_.least.distance - tolerance();
      parallel_for(options_.threads, of_pieces.size(), [&](std::size_t k) {
        of_pieces[k] = candidates_.find_within(first + k, distance);
      });
      std::vector<GeometryCandidate> all;
      for (const std::vector<GeometryCandidate>& of_piece : of_pieces) {
        all.insert(all.end(), of_piece.begin(), of_piece.end());
      }
      prove(all);
    }
  }

  void prove(std::span<const GeometryCandidate> left) {
    std::size_t size = 1;
    while (!left.empty() && !is_done()) {
      const auto round = left.first(std::min(size, left.size()));
      left = left.subspan(round.size());
      size = std::min(2 * size, kLargestRound);
      std::vector<ClosestApproach> bests(round.size(), found_.least);
      parallel_for(options_.threads, round.size(), [&](std::size_t k) {
        GeometrySearch search(timeline_, round[k], options_, workspaces_.local());
        LeastDescent(options_, bests[k]).run(search, round[k].window);
      });
      for (std::size_t k = 0; k < round.size(); ++k) {
        take(round[k], bests[k]);
      }
    }
  }

  void take(const GeometryCandidate& candidate, const ClosestApproach& best) {
    const UndecidedReason reason = is_ended() ? found_.least.reason : best.reason;
    if (best.distance < found_.least.distance) {
      found_ = {candidate.pair, best};
    }
    found_.least.reason = reason;
  }

  const RobotTimeline& timeline_;
  const CandidateSearch& candidates_;
  const RobotCheckOptions& options_;
  LinkWorkspaces& workspaces_;
  LeastOfAll found_;
};

}  // namespace

std::optional<LeastOfAll> least_of_all(const RobotTimeline& timeline,
                                       const CandidateSearch& candidates,
                                       const std::optional<KnownNear>& known,
                                       const RobotCheckOptions& options,
                                       LinkWorkspaces& workspaces) {
  return Search(timeline, candidates, options, workspaces).run(known);
}

}  // namespace firstcontact::detail
