#include <firstcontact/articulated/detail/candidates.h>

#include <algorithm>
#include <optional>
#include <span>
#include <tuple>

namespace firstcontact::detail {
namespace {

constexpr double kUp = 1.0 + 0x1p-40;

/// Halvings of a piece. More cost more places of links than they spare searches.
constexpr int kDepth = 3;

/// [-]  Of the sweeps of both balls: halved, they have to be enough for the other pairs.
constexpr double kSweepThatHelps = 1.0;

/// [-]  A bound of tracking errors over a window may exceed that at its middle by this part of it.
constexpr double kLooseError = 0.05;
constexpr int kErrorDepth = 8;

/// Two parts that are still in question.
struct Question {
  std::size_t pair = 0;
  std::array<std::size_t, 2> parts = {};
};

class Search {
 public:
  Search(const RobotTimeline& timeline, std::size_t piece,
         const std::vector<std::optional<SweptBall>>& resting, LinkScratch& scratch)
      : timeline_(timeline),
        piece_(piece),
        scratch_(scratch),
        balls_(resting),
        paths_(resting.size()) {}

  std::vector<PartCandidate> run(const std::vector<Question>& questions) {
    narrow(timeline_.piece(piece_), questions, 0);
    join_windows();
    std::vector<PartCandidate> whole;
    whole.swap(found_);
    for (PartCandidate& candidate : whole) {
      if (timeline_.has_tracking_errors()) {
        add_thresholds(candidate, 0);
      } else {
        candidate.threshold = timeline_.pairs()[candidate.pair].margin;
        found_.push_back(candidate);
      }
    }
    std::sort(found_.begin(), found_.end());
    return std::move(found_);
  }

 private:
  const SweptBall& ball(std::size_t part, const TimeWindow& window) {
    std::optional<SweptBall>& ball = balls_[part];
    if (!ball) {
      std::optional<PartPath>& path = paths_[part];
      if (!path) {
        path = timeline_.path(part, 0.5 * (window.begin + window.end));
      }
      ball = swept_ball(timeline_.parts()[part].ball, *path, window, scratch_);
      placed_.push_back(part);
    }
    return *ball;
  }

  void forget_balls() {
    for (const std::size_t part : placed_) {
      balls_[part].reset();
    }
    placed_.clear();
  }

  void narrow(const TimeWindow& window, std::span<const Question> questions, int depth) {
    std::vector<Question> open;
    for (const Question& question : questions) {
      const SweptBall& a = ball(question.parts[0], window);
      const SweptBall& b = ball(question.parts[1], window);
      const double threshold = timeline_.pairs()[question.pair].margin;
      const double missing =
          (threshold + a.tracking_error + b.tracking_error) * kUp - gap_bound(a, b);
      if (missing < 0.0) {
        continue;
      }
      // Shorter windows help where the balls are apart but for their sweeps.
      if (depth < kDepth && missing < kSweepThatHelps * (a.sweep + b.sweep)) {
        open.push_back(question);
      } else {
        found_.push_back({window, piece_, question.pair, question.parts, 0.0});
      }
    }
    forget_balls();
    if (!open.empty()) {
      const double middle = 0.5 * (window.begin + window.end);
      narrow({window.begin, middle}, open, depth + 1);
      narrow({middle, window.end}, open, depth + 1);
    }
  }

  void join_windows() {
    const auto key = [](const PartCandidate& c) {
      return std::tuple(c.pair, c.parts, c.window.begin);
    };
    std::sort(found_.begin(), found_.end(),
              [&](const PartCandidate& x, const PartCandidate& y) { return key(x) < key(y); });
    std::vector<PartCandidate> joined;
    for (const PartCandidate& c : found_) {
      const bool follows = !joined.empty() && joined.back().pair == c.pair &&
                           joined.back().parts == c.parts &&
                           joined.back().window.end == c.window.begin;
      if (follows) {
        joined.back().window.end = c.window.end;
      } else {
        joined.push_back(c);
      }
    }
    found_ = std::move(joined);
  }

  /// Windows so short that the bound of tracking errors is tight.
  void add_thresholds(const PartCandidate& candidate, int depth) {
    const auto& [window, piece, pair, parts, unused] = candidate;
    const double middle = 0.5 * (window.begin + window.end);
    const PairPaths paths = timeline_.paths(parts[0], parts[1], middle);
    const auto error_over = [&, &parts = candidate.parts](const TimeWindow& part) {
      return (paths.A.tracking_bound(timeline_.parts()[parts[0]].ball, part) +
              paths.B.tracking_bound(timeline_.parts()[parts[1]].ball, part)) *
             kUp;
    };
    const double error = error_over(window);
    if (depth < kErrorDepth && error > (1.0 + kLooseError) * error_over({middle, middle})) {
      add_thresholds({{window.begin, middle}, piece, pair, parts, 0.0}, depth + 1);
      add_thresholds({{middle, window.end}, piece, pair, parts, 0.0}, depth + 1);
      return;
    }
    found_.push_back({window, piece, pair, parts, timeline_.pairs()[pair].margin + error});
  }

  const RobotTimeline& timeline_;
  std::size_t piece_;
  LinkScratch& scratch_;
  std::vector<std::optional<SweptBall>> balls_;
  std::vector<std::optional<PartPath>> paths_;  // Of the piece.
  std::vector<std::size_t> placed_;
  std::vector<PartCandidate> found_;
};

}  // namespace

SweptBall swept_ball(const LinkPart& ball, const PartPath& path, const TimeWindow& window,
                     LinkScratch& scratch) {
  const double middle = 0.5 * (window.begin + window.end);
  const auto [pose, speed] = path.X_FS.swept(middle, window.begin, window.end, ball, scratch);
  SweptBall swept;
  swept.centre = pose.p_OL + pose.R_FL * ball.centre;
  swept.sweep = speed * std::max(window.end - middle, middle - window.begin) * kUp;
  const double error = pose.position_error + pose.rotation_error * ball.centre.norm() +
                       0x1p-48 * swept.centre.norm();
  swept.radius = (ball.radius + swept.sweep + error) * kUp;
  swept.tracking_error = path.tracking_bound(ball, window);
  return swept;
}

double gap_bound(const SweptBall& a, const SweptBall& b) {
  return (a.centre - b.centre).norm() * (1.0 - 0x1p-48) - (a.radius + b.radius) * kUp;
}

CandidateSearch::CandidateSearch(const RobotTimeline& timeline)
    : timeline_(timeline), resting_(timeline.parts().size()) {
  LinkScratch scratch;
  for (std::size_t part = 0; part < resting_.size(); ++part) {
    if (timeline.parts()[part].rests) {
      resting_[part] =
          swept_ball(timeline.parts()[part].ball, timeline.path(part, 0.5), {0.0, 1.0}, scratch);
    }
  }
}

std::vector<PartCandidate> CandidateSearch::find(std::size_t piece,
                                                 const std::function<bool(std::size_t)>& wanted,
                                                 LinkScratch& scratch) const {
  std::vector<Question> questions;
  for (std::size_t k = 0; k < timeline_.pairs().size(); ++k) {
    const TestedPair& pair = timeline_.pairs()[k];
    if (!wanted(k) || !timeline_.is_tested(pair, piece)) {
      continue;
    }
    const auto [first, second] = pair.members;
    for (std::size_t a = timeline_.first_part(first); a < timeline_.first_part(first + 1); ++a) {
      for (std::size_t b = timeline_.first_part(second); b < timeline_.first_part(second + 1);
           ++b) {
        questions.push_back({k, {a, b}});
      }
    }
  }
  return Search(timeline_, piece, resting_, scratch).run(questions);
}

}  // namespace firstcontact::detail
