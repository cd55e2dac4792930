#include <firstcontact/robot_check/detail/candidates.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include <firstcontact/robot_check/detail/placed_geometry.h>
#include <firstcontact/robot_check/detail/search_memory.h>

namespace firstcontact::detail {
namespace {

constexpr double kUp = 1.0 + 0x1p-40;

/// [-]  Part of the distance at a window's middle from which a gap is accepted: greater gaps cost
/// more than the windows that they save.
constexpr double kNear = 0.5;

/// Two geometries that may still touch.
struct Question {
  std::size_t pair = 0;
  std::array<std::size_t, 2> geometries = {};
  std::optional<std::array<std::size_t, 2>> placed = {};  // Places in a frame that carries both.
  Eigen::Vector3d n = Eigen::Vector3d::Zero();            // Direction between the two, found last.
  double middle = 0.0;                                    // [m]  Gap at the middle of the window.
  bool apart = false;  // Whether they are beyond the threshold there.
};

class Search {
 public:
  /// @param distance  [m]  in place of all thresholds, where it is given
  Search(const RobotTimeline& timeline, std::size_t piece, const std::vector<RobotTree>& trees,
         const std::vector<std::optional<SweptGeometry>>& resting,
         std::span<const double> held = {}, const std::optional<double>& distance = std::nullopt)
      : timeline_(timeline),
        piece_(piece),
        grid_{timeline.piece(piece)},
        middle_(grid_.at(TimeGrid::kMiddle)),
        held_(held),
        distance_(distance),
        has_tracking_errors_(!distance && timeline.has_tracking_errors()),
        scratch_(has_tracking_errors_ ? std::make_optional<LinkScratch>() : std::nullopt),
        trees_(trees),
        resting_(resting),
        robots_(trees.size()),
        in_world_(resting.size()),
        in_frames_(resting.size()) {}

  std::vector<GeometryCandidate> run(const std::function<bool(std::size_t)>& wanted) {
    return run_of(near_by_boxes(wanted));
  }

  std::vector<GeometryCandidate> run_until_contact(const WindowProbe& probe) {
    window_probe_ = &probe;
    return run_of(near_by_boxes({}));
  }

  ProbedCandidates run_unless_contact(const InstantProbe& probe) {
    probe_ = &probe;
    std::vector<Question> near = near_by_boxes({});
    probe_end(near);
    std::vector<GeometryCandidate> candidates = run_of(std::move(near));
    return {std::move(candidates), contact_};
  }

 private:
  /// The box of a geometry over the piece, tracking errors included.
  struct Box {
    Eigen::Vector3d low;
    Eigen::Vector3d high;
  };

  /// The questions of a window.
  struct Part {
    GridWindow window;
    std::vector<Question> questions;
  };

  /// The questions for which shorter windows help.
  struct Open {
    std::vector<Question> apart;     // Pairs that are apart at the middle.
    std::vector<Question> in_first;  // Pairs in the first half alone.
  };

  std::vector<GeometryCandidate> run_of(std::vector<Question> near) {
    narrow(std::move(near));
    if (contact_) {
      return {};
    }
    join_windows();
    std::sort(found_.begin(), found_.end());
    return std::move(found_);
  }

  /// [m]  The margin of a tested pair, without tracking errors.
  [[nodiscard]] double margin_of(std::size_t pair) const {
    const double margin = distance_.value_or(timeline_.pairs()[pair].margin);
    return held_.empty() ? margin : std::max(margin, held_[pair]);
  }

  /// The tested geometries whose boxes are not farther apart than their margins.
  std::vector<Question> near_by_boxes(const std::function<bool(std::size_t)>& wanted) {
    const std::vector<Box> boxes = boxes_of_piece();
    std::vector<Question> near;
    for (std::size_t k = 0; k < timeline_.pairs().size(); ++k) {
      const TestedPair& pair = timeline_.pairs()[k];
      if (!timeline_.is_tested(pair, piece_) || (wanted && !wanted(k))) {
        continue;
      }
      for (const auto& [a, b] : timeline_.geometry_pairs(pair)) {
        const auto gap = (boxes[b].low - boxes[a].high).cwiseMax(boxes[a].low - boxes[b].high);
        if (!(gap.maxCoeff() > margin_of(k) * kUp)) {
          near.push_back({.pair = k, .geometries = {a, b}});
        }
      }
    }
    return near;
  }

  std::vector<Box> boxes_of_piece() {
    std::vector<Box> boxes;
    boxes.reserve(resting_.size());
    for (std::size_t geometry = 0; geometry < resting_.size(); ++geometry) {
      const SweptGeometry& swept = in_world(geometry, {});
      Box box{swept.low, swept.high};
      if (has_tracking_errors_) {
        const Eigen::Vector3d more = Eigen::Vector3d::Constant(tracking_bound(geometry) * kUp);
        box.low -= more;
        box.high += more;
      }
      boxes.push_back(box);
    }
    return boxes;
  }

  /// Halves windows, so that instants are tested all over the piece, or the first windows come
  /// first.
  void narrow(std::vector<Question> near) {
    std::deque<Part> parts;
    parts.push_back({{}, std::move(near)});
    while (!parts.empty() && !contact_) {
      const Part part = std::move(parts.front());
      parts.pop_front();
      if (part.questions.empty() || grid_.at(part.window.begin) > horizon_) {
        continue;
      }
      Open open = still_open(part);
      open.in_first.insert(open.in_first.begin(), open.apart.begin(), open.apart.end());
      Part halves[] = {{part.window.first_half(), std::move(open.in_first)},
                       {part.window.second_half(), std::move(open.apart)}};
      if (window_probe_ != nullptr) {
        parts.insert(parts.begin(), std::begin(halves), std::end(halves));
      } else {
        parts.insert(parts.end(), std::begin(halves), std::end(halves));
      }
    }
  }

  /// The questions for which shorter windows help; the others that may touch become candidates.
  Open still_open(const Part& part) {
    Open open;
    std::vector<Question> overlapping;
    std::vector<GeometryCandidate> instants;
    const double middle = grid_.at(part.window.middle());
    for (Question question : part.questions) {
      if (is_far(question, part.window)) {
        continue;
      }
      // Shorter windows help where the geometries are apart at the middle of this one.
      if (part.window.can_be_halved() && question.apart) {
        open.apart.push_back(question);
        continue;
      }
      if (window_probe_ != nullptr && !question.apart) {
        overlapping.push_back(question);
        continue;
      }
      found_.push_back(candidate_of(question, grid_.at(part.window)));
      if (probe_ != nullptr && !question.apart) {
        instants.push_back(candidate_of(question, {middle, middle}));
      }
    }
    probe(instants);
    open.in_first = left_by_search(std::move(overlapping), part.window);
    return open;
  }

  /// Searches a window for contacts of geometries that overlap at its middle, the deepest first.
  ///
  /// It returns those that are left once the second half does not matter.
  std::vector<Question> left_by_search(std::vector<Question> overlapping,
                                       const GridWindow& window) {
    const auto gap = [this](const Question& q) { return q.middle - margin_of(q.pair); };
    std::stable_sort(overlapping.begin(), overlapping.end(),
                     [&](const Question& x, const Question& y) { return gap(x) < gap(y); });
    std::vector<Question> left;
    for (const Question& question : overlapping) {
      if (window.can_be_halved() && horizon_ <= grid_.at(window.middle())) {
        left.push_back(question);
      } else {
        horizon_ = (*window_probe_)(candidate_of(question, grid_.at(window)));
      }
    }
    return left;
  }

  [[nodiscard]] GeometryCandidate candidate_of(const Question& question,
                                               const TimeWindow& window) const {
    const double margin = margin_of(question.pair);
    return {.window = window,
            .piece = piece_,
            .pair = question.pair,
            .geometries = question.geometries,
            .threshold = margin,
            .has_tracking_errors = has_tracking_errors_,
            .gap = question.middle - margin};
  }

  /// Probes candidates of one instant, the deepest first, until the probe finds a contact.
  void probe(std::vector<GeometryCandidate>& suspects) {
    std::sort(suspects.begin(), suspects.end());
    const auto hit = std::ranges::find_if(
        suspects, [this](const GeometryCandidate& candidate) { return (*probe_)(candidate); });
    if (hit != suspects.end()) {
      contact_ = *hit;
    }
  }

  /// Probes the end of the piece.
  void probe_end(std::vector<Question>& near) {
    std::vector<GeometryCandidate> suspects;
    const double end = grid_.at(GridWindow::kSize);
    for (Question& question : near) {
      const SweptGeometry& A = in_world(question.geometries[0], {});
      const SweptGeometry& B = in_world(question.geometries[1], {});
      const double threshold = margin_of(question.pair) * kUp;
      if ((A.rests && B.rests) || boxes_are_far(question, A, B, threshold)) {
        continue;  // A pair at rest is tested at the middle.
      }
      const SweptGap gap = gap_at_end(A, B, threshold, question.n);
      question.n = gap.n;
      question.middle = gap.bound;
      if (!(gap.bound > threshold)) {
        suspects.push_back(candidate_of(question, {end, end}));
      }
    }
    probe(suspects);
  }

  /// Whether the two are proven farther apart than their threshold throughout the window.
  bool is_far(Question& question, const GridWindow& window) {
    if (!question.placed) {
      const auto [first, second] = question.geometries;
      const SweptGeometry& A = in_world(first, window);
      const SweptGeometry& B = in_world(second, window);
      const double threshold = threshold_of(question, window);
      if (boxes_are_far(question, A, B, threshold)) {
        return true;
      }
      if (!place_in_frame(question)) {
        return hulls_are_far(question, A, B, threshold);
      }
    }
    const SweptGeometry& A = placed_[(*question.placed)[0]].over(window);
    const SweptGeometry& B = placed_[(*question.placed)[1]].over(window);
    const double threshold = threshold_of(question, window);
    return boxes_are_far(question, A, B, threshold) || hulls_are_far(question, A, B, threshold);
  }

  /// Places a pair in a frame of its own, in which the motion of both has cancelled.
  ///
  /// In the world all pairs share their places. A pair that is not far there may be far in such a
  /// frame. It returns false where there is no such frame.
  bool place_in_frame(Question& question) {
    const auto [first, second] = question.geometries;
    const std::optional<RobotLink> frame = frame_of(first, second);
    if (!frame) {
      return false;
    }
    question.placed = {in_frame(first, *frame), in_frame(second, *frame)};
    question.n.setZero();
    return true;
  }

  static bool boxes_are_far(Question& question, const SweptGeometry& A, const SweptGeometry& B,
                            double threshold) {
    const SweptGap gap = gap_of_boxes(A, B);
    if (question.n.isZero(0.0)) {
      const Eigen::Vector3d between = B.middle.centre - A.middle.centre;
      question.n = between.isZero(0.0) ? gap.n : between.normalized();
    }
    return gap.bound > threshold;
  }

  static bool hulls_are_far(Question& question, const SweptGeometry& A, const SweptGeometry& B,
                            double threshold) {
    const SweptGap middle = gap_at_middle(A, B, threshold, question.n, kNear);
    question.n = middle.n;
    question.middle = middle.bound;
    question.apart = middle.bound > threshold;
    return question.apart && gap_throughout(A, B, threshold, middle.n).bound > threshold;
  }

  double threshold_of(const Question& question, const GridWindow& window) {
    double threshold = margin_of(question.pair);
    if (has_tracking_errors_) {
      for (std::size_t k = 0; k < 2; ++k) {
        threshold += question.placed
                         ? placed_[(*question.placed)[k]].tracking_bound(window, *scratch_)
                         : tracking_bound(question.geometries[k], window);
      }
    }
    return threshold * kUp;
  }

  double tracking_bound(std::size_t geometry, const GridWindow& window = {}) {
    return resting_[geometry] ? 0.0
                              : placed_[place_in_world(geometry)].tracking_bound(window, *scratch_);
  }

  const SweptGeometry& in_world(std::size_t geometry, const GridWindow& window) {
    return resting_[geometry] ? *resting_[geometry]
                              : placed_[place_in_world(geometry)].over(window);
  }

  std::size_t place_in_world(std::size_t geometry) {
    if (!in_world_[geometry]) {
      in_world_[geometry] = place(geometry, std::nullopt);
    }
    return *in_world_[geometry];
  }

  std::size_t in_frame(std::size_t geometry, const RobotLink& frame) {
    for (const auto& [known, index] : in_frames_[geometry]) {
      if (known == frame) {
        return index;
      }
    }
    in_frames_[geometry].emplace_back(frame, place(geometry, frame));
    return in_frames_[geometry].back().second;
  }

  /// The last link that carries both, where that link moves.
  std::optional<RobotLink> frame_of(std::size_t a, std::size_t b) {
    const std::optional<RobotLink> link = timeline_.seat_of(a, middle_).link;
    const std::optional<RobotLink> other = timeline_.seat_of(b, middle_).link;
    if (!link || !other || link->robot != other->robot) {
      return std::nullopt;
    }
    const RobotModel& model = timeline_.scene().robot_motion(link->robot).model();
    const std::size_t frame = model.rigid_root(model.last_common_ancestor(link->link, other->link));
    const bool rests = robot(link->robot).rests(trees_[link->robot].node_of_link[frame]);
    return rests ? std::nullopt : std::optional(RobotLink{link->robot, frame});
  }

  TreePoses& robot(std::size_t index) {
    std::optional<TreePoses>& course = robots_[index];
    if (!course) {
      const RobotMotion& motion = timeline_.scene().robot_motion(index);
      std::pmr::vector<TreePoses::Node> nodes({{TreePoses::kWorld, &motion.base_path(middle_)}},
                                              &memory_.resource());
      for (const auto& [parent, joint] : std::span(trees_[index].nodes).subspan(1)) {
        nodes.push_back({parent, motion.joint_path(joint, middle_)});
      }
      course.emplace(nodes, grid_, memory_.resource());
    }
    return *course;
  }

  GeometryMount mount(std::size_t geometry) {
    const auto [link, path] = timeline_.seat_of(geometry, middle_);
    if (link) {
      return {timeline_.geometries()[geometry], robot(link->robot),
              trees_[link->robot].node_of_link[link->link], *path};
    }
    bodies_.emplace_back(*path, grid_);
    return {timeline_.geometries()[geometry], bodies_.back()};
  }

  std::size_t place(std::size_t geometry, const std::optional<RobotLink>& frame) {
    placed_.emplace_back(
        memory_.resource(), timeline_.geometries()[geometry], mount(geometry),
        frame ? trees_[frame->robot].node_of_link[frame->link] : TreePoses::kWorld, grid_,
        has_tracking_errors_ ? std::optional(timeline_.path(geometry, middle_, frame))
                             : std::nullopt);
    return placed_.size() - 1;
  }

  void join_windows() {
    const auto key = [](const GeometryCandidate& c) {
      return std::tuple(c.pair, c.geometries, c.window.begin);
    };
    std::sort(
        found_.begin(), found_.end(),
        [&](const GeometryCandidate& x, const GeometryCandidate& y) { return key(x) < key(y); });
    std::vector<GeometryCandidate> joined;
    for (const GeometryCandidate& c : found_) {
      const bool follows = !joined.empty() && joined.back().pair == c.pair &&
                           joined.back().geometries == c.geometries &&
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

  const RobotTimeline& timeline_;
  std::size_t piece_;
  TimeGrid grid_;
  double middle_;                 // Time.
  std::span<const double> held_;  // [m]  For each tested pair, or empty.
  std::optional<double> distance_;
  bool has_tracking_errors_;
  std::optional<LinkScratch> scratch_;  // Where there are tracking errors.
  const std::vector<RobotTree>& trees_;
  const std::vector<std::optional<SweptGeometry>>& resting_;
  SearchMemory memory_;
  std::vector<std::optional<TreePoses>> robots_;
  std::deque<TreePoses> bodies_;
  std::pmr::deque<PlacedGeometry> placed_{&memory_.resource()};
  std::vector<std::optional<std::size_t>> in_world_;  // For each geometry, where it is placed.
  std::vector<std::vector<std::pair<RobotLink, std::size_t>>> in_frames_;
  std::vector<GeometryCandidate> found_;
  const InstantProbe* probe_ = nullptr;
  std::optional<GeometryCandidate> contact_;  // The contact that this probe has found.
  const WindowProbe* window_probe_ = nullptr;
  double horizon_ = std::numeric_limits<double>::infinity();  // Time after which nothing matters.
};

}  // namespace

CandidateSearch::CandidateSearch(const RobotTimeline& timeline)
    : timeline_(timeline), resting_(timeline.geometries().size()) {
  for (std::size_t robot = 0; robot < timeline.scene().robot_count(); ++robot) {
    trees_.emplace_back(timeline.scene().robot_motion(robot).model());
  }
  const TimeGrid step{{0.0, 1.0}};
  for (std::size_t k = 0; k < resting_.size(); ++k) {
    const BoundedGeometry& geometry = timeline.geometries()[k];
    if (geometry.rests) {
      TreePoses course(*timeline.seat_of(k, 0.5).path, step);
      resting_[k] =
          GeometryTrack(geometry, GeometryMount(geometry, course), TreePoses::kWorld).rest();
    }
  }
}

std::vector<GeometryCandidate> CandidateSearch::find(std::size_t piece,
                                                     const std::function<bool(std::size_t)>& wanted,
                                                     std::span<const double> held) const {
  return Search(timeline_, piece, trees_, resting_, held).run(wanted);
}

ProbedCandidates CandidateSearch::find_unless_contact(std::size_t piece,
                                                      const InstantProbe& probe) const {
  return Search(timeline_, piece, trees_, resting_).run_unless_contact(probe);
}

std::vector<GeometryCandidate> CandidateSearch::find_until_contact(std::size_t piece,
                                                                   const WindowProbe& probe) const {
  return Search(timeline_, piece, trees_, resting_).run_until_contact(probe);
}

std::vector<GeometryCandidate> CandidateSearch::find_within(std::size_t piece,
                                                            double distance) const {
  return Search(timeline_, piece, trees_, resting_, {}, distance).run({});
}

}  // namespace firstcontact::detail
