#include <firstcontact/articulated/detail/candidates.h>

#include <algorithm>
#include <optional>
#include <span>
#include <tuple>

namespace firstcontact::detail {
namespace {

constexpr double kUp = 1.0 + 0x1p-40;

/// Halvings of a piece. More cost more places of links than they spare searches.
constexpr int kDepth = 4;

/// [-]  A bound of tracking errors over a window may exceed that at its middle by this part of it.
constexpr double kLooseError = 0.05;
constexpr int kErrorDepth = 8;

/// Two parts that are still in question.
struct Question {
  std::size_t pair = 0;
  std::array<std::size_t, 2> parts = {};
  std::optional<std::size_t> paths = {};         // Where they are remembered.
  Eigen::Vector3d n = Eigen::Vector3d::UnitX();  // Between the two, found last.
  double middle = 0.0;                           // [m]  Gap at the middle of the window.
  bool apart = false;                            // Beyond the threshold there.
};

class Search {
 public:
  Search(const RobotTimeline& timeline, std::size_t piece,
         const std::vector<std::optional<SweptPart>>& resting, LinkScratch& scratch)
      : timeline_(timeline),
        piece_(piece),
        scratch_(scratch),
        resting_(resting),
        swept_(resting.size()),
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
  const SweptPart& swept(std::size_t part, const TimeWindow& window) {
    if (resting_[part]) {
      return *resting_[part];
    }
    std::optional<SweptPart>& swept = swept_[part];
    if (!swept) {
      std::optional<PartPath>& path = paths_[part];
      if (!path) {
        path = timeline_.path(part, 0.5 * (window.begin + window.end));
      }
      swept = sweep(timeline_.parts()[part], *path, window, scratch_);
      placed_.push_back(part);
    }
    return *swept;
  }

  void forget_swept() {
    for (const std::size_t part : placed_) {
      swept_[part].reset();
    }
    placed_.clear();
  }

  void narrow(const TimeWindow& window, std::span<const Question> questions, int depth) {
    std::vector<Question> open;
    for (Question question : questions) {
      if (is_far(question, window, depth)) {
        continue;
      }
      // Shorter windows help where the parts are apart at the middle of this one.
      if (depth < kDepth && question.apart) {
        open.push_back(question);
      } else {
        found_.push_back({window, piece_, question.pair, question.parts, 0.0,
                          question.middle - timeline_.pairs()[question.pair].margin});
      }
    }
    forget_swept();
    if (!open.empty()) {
      const double middle = 0.5 * (window.begin + window.end);
      narrow({window.begin, middle}, open, depth + 1);
      narrow({middle, window.end}, open, depth + 1);
    }
  }

  /// Whether the two are proven farther apart than their threshold throughout the window.
  bool is_far(Question& question, const TimeWindow& window, int depth) {
    const auto [first, second] = question.parts;
    if (!timeline_.share_frame(first, second)) {
      const SweptPart& a = swept(first, window);
      const SweptPart& b = swept(second, window);
      return boxes_are_far(question, a, b, window) || hulls_are_far(question, a, b, window);
    }
    // In the world all pairs have their places in common. What is not far there may be so in a
    // frame of its own, in which what moves both has cancelled.
    if (depth == 0 &&
        boxes_are_far(question, swept(first, window), swept(second, window), window)) {
      return true;
    }
    const PairPaths& paths = paths_of(question, window);
    const SweptPart a = sweep(timeline_.parts()[first], paths.A, window, scratch_);
    const SweptPart b = sweep(timeline_.parts()[second], paths.B, window, scratch_);
    return boxes_are_far(question, a, b, window) || hulls_are_far(question, a, b, window);
  }

  bool boxes_are_far(Question& question, const SweptPart& a, const SweptPart& b,
                     const TimeWindow& window) const {
    const double threshold = threshold_of(question, a, b);
    return take(gap_of_boxes(a, b, window, threshold), threshold, question);
  }

  bool hulls_are_far(Question& question, const SweptPart& a, const SweptPart& b,
                     const TimeWindow& window) const {
    const double threshold = threshold_of(question, a, b);
    return take(gap_of_hulls(a, b, window, threshold, question.n), threshold, question);
  }

  [[nodiscard]] double threshold_of(const Question& question, const SweptPart& a,
                                    const SweptPart& b) const {
    const double margin = timeline_.pairs()[question.pair].margin;
    return (margin + a.tracking_error + b.tracking_error) * kUp;
  }

  static bool take(const SweptGap& gap, double threshold, Question& question) {
    question.n = gap.n;
    question.middle = gap.middle;
    question.apart = gap.middle > threshold;
    return gap.bound > threshold;
  }

  /// In the frame that both parts share, over the piece.
  const PairPaths& paths_of(Question& question, const TimeWindow& window) {
    if (!question.paths) {
      question.paths = pair_paths_.size();
      pair_paths_.push_back(
          timeline_.paths(question.parts[0], question.parts[1], 0.5 * (window.begin + window.end)));
    }
    return pair_paths_[*question.paths];
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
        joined.back().gap = std::min(joined.back().gap, c.gap);
      } else {
        joined.push_back(c);
      }
    }
    found_ = std::move(joined);
  }

  /// Windows so short that the bound of tracking errors is tight.
  void add_thresholds(const PartCandidate& candidate, int depth) {
    const auto& [window, piece, pair, parts, unused, gap] = candidate;
    const double middle = 0.5 * (window.begin + window.end);
    const PairPaths paths = timeline_.paths(parts[0], parts[1], middle);
    const auto error_over = [&, &parts = candidate.parts](const TimeWindow& part) {
      return (paths.A.tracking_bound(timeline_.parts()[parts[0]].ball, part) +
              paths.B.tracking_bound(timeline_.parts()[parts[1]].ball, part)) *
             kUp;
    };
    const double error = error_over(window);
    if (depth < kErrorDepth && error > (1.0 + kLooseError) * error_over({middle, middle})) {
      add_thresholds({{window.begin, middle}, piece, pair, parts, 0.0, gap}, depth + 1);
      add_thresholds({{middle, window.end}, piece, pair, parts, 0.0, gap}, depth + 1);
      return;
    }
    found_.push_back({window, piece, pair, parts, timeline_.pairs()[pair].margin + error, gap});
  }

  const RobotTimeline& timeline_;
  std::size_t piece_;
  LinkScratch& scratch_;
  const std::vector<std::optional<SweptPart>>& resting_;
  std::vector<std::optional<SweptPart>> swept_;
  std::vector<std::optional<PartPath>> paths_;  // Of the piece.
  std::vector<PairPaths> pair_paths_;           // Of the piece.
  std::vector<std::size_t> placed_;
  std::vector<PartCandidate> found_;
};

}  // namespace

CandidateSearch::CandidateSearch(const RobotTimeline& timeline)
    : timeline_(timeline), resting_(timeline.parts().size()) {
  LinkScratch scratch;
  for (std::size_t part = 0; part < resting_.size(); ++part) {
    if (timeline.parts()[part].rests) {
      resting_[part] = sweep(timeline.parts()[part], timeline.path(part, 0.5), {0.0, 1.0}, scratch);
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
        questions.push_back({.pair = k, .parts = {a, b}});
      }
    }
  }
  return Search(timeline_, piece, resting_, scratch).run(questions);
}

}  // namespace firstcontact::detail
