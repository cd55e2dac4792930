#include <firstcontact/robot_check/check_robots.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/many_bodies/detail/contact_intervals.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/parallel/parallel_for.h>
#include <firstcontact/robot_check/detail/candidates.h>
#include <firstcontact/robot_check/detail/geometry_answer.h>
#include <firstcontact/robot_check/detail/geometry_search.h>
#include <firstcontact/robot_check/detail/least_clearance.h>
#include <firstcontact/robot_check/detail/least_of_all.h>
#include <firstcontact/robot_check/detail/pair_contacts.h>
#include <firstcontact/robot_check/detail/pair_holds.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>

namespace firstcontact {
namespace {

using detail::GeometryAnswer;
using detail::GeometryCandidate;
using detail::GeometrySearch;

/// Number of pieces that are looked at together, and of searches with the same horizon in the first
/// round. The first round is small, as a contact makes other searches needless. Both are fixed, so
/// that answers do not depend on the number of threads.
constexpr std::size_t kBlock = 32;
constexpr std::size_t kFirstRound = 1;
constexpr std::size_t kLargestRound = 32;

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

void require(bool condition, const char* message) {
  if (!condition) {
    throw std::invalid_argument(std::string("RobotCheckOptions::") + message);
  }
}

void validate(const RobotCheckOptions& options) {
  require(options.tolerance > 0.0 && std::isfinite(options.tolerance),
          "tolerance must be finite and > 0");
  require(options.time_resolution > 0.0 && options.time_resolution <= 1.0,
          "time_resolution must be in (0, 1]");
  require(options.contacts.kind != ContactState::Kind::nearest || options.contacts.most >= 1,
          "contacts must be nearest(1) or more");
  require(options.contact_band >= 0.0 && std::isfinite(options.contact_band),
          "contact_band must be finite and >= 0");
}

/// The data that all checks of a scene share.
struct Prepared {
  explicit Prepared(const RobotScene& scene) : timeline(scene), candidates(timeline) {}

  detail::RobotTimeline timeline;
  detail::CandidateSearch candidates;
  detail::LinkWorkspaces workspaces;
};

class RobotCheck {
 public:
  RobotCheck(Prepared& scene, const RobotCheckOptions& options)
      : timeline_(scene.timeline),
        candidates_(scene.candidates),
        workspaces_(scene.workspaces),
        options_(options),
        place_of_(scene.timeline.pairs().size(), kNone) {
    if (asks_each_pair()) {
      answer_all();
    }
  }

  SceneResult run() {
    if (options_.start_contacts == StartContacts::keep_half) {
      find_holds();
    }
    walk();
    if (options_.closest && asks_each_pair()) {
      find_closest_of_each();
    } else if (options_.closest) {
      find_closest_of_all();
    }
    report(1.0);
    return result();
  }

 private:
  [[nodiscard]] bool asks_each_pair() const {
    return options_.all_pairs || options_.all_contacts_in_time;
  }

  void find_holds() {
    require(!timeline_.has_tracking_errors(),
            "start_contacts: keep_half is not for robots with tracking errors, within which they "
            "may start in contact");
    holds_.emplace(timeline_, options_, workspaces_);
    for (std::size_t pair = 0; pair < timeline_.pairs().size(); ++pair) {
      give_up_without_hold(pair);
    }
  }

  /// Makes a pair undecided whose start gap the budget left open.
  void give_up_without_hold(std::size_t pair) {
    for (const detail::HeldStretch& stretch : holds_->stretches(pair)) {
      if (stretch.hold.stopped != UndecidedReason::none) {
        const double t = timeline_.piece(stretch.first_piece).begin;
        give_up(answer_of(pair), t, stretch.hold.stopped);
        first_ = std::min(first_, t);
      }
    }
  }

  /// Takes the pieces one after the other, as far as they matter.
  void walk() {
    std::size_t k = 0;
    while (k < timeline_.piece_count() && timeline_.piece(k).begin <= horizon()) {
      const double begin = timeline_.piece(k).begin;
      if (const UndecidedReason reason = detail::spent(options_.budget);
          reason != UndecidedReason::none) {
        give_up(begin, reason);
        break;
      }
      const std::size_t end = std::min(k + kBlock, timeline_.piece_count());
      search(find_candidates(k, end));
      k = end;
    }
  }

  [[nodiscard]] PairAnswer free_answer(std::size_t pair) const {
    const detail::TestedPair& tested = timeline_.pairs()[pair];
    PairAnswer answer;
    answer.members = tested.members;
    answer.margin = tested.margin;
    answer.verdict = Verdict::free;
    answer.t = 1.0;
    answer.tolerance_used = options_.tolerance;
    return answer;
  }

  /// The answer of a tested pair, by index; free until a search finds something else.
  ///
  /// Most pairs never need one.
  PairAnswer& answer_of(std::size_t pair) {
    std::size_t& place = place_of_[pair];
    if (place == kNone) {
      place = pairs_.size();
      pairs_.push_back(free_answer(pair));
      contacts_.emplace_back(most_contacts());
      deciding_geometries_.emplace_back();
    }
    return pairs_[place];
  }

  /// The greatest number of contacts of a pair of members that are listed.
  [[nodiscard]] std::size_t most_contacts() const {
    return options_.contacts.kind == ContactState::Kind::nearest ? options_.contacts.most
                                                                 : ContactState::all.most;
  }

  void answer_all() {
    pairs_.reserve(timeline_.pairs().size());
    contacts_.reserve(timeline_.pairs().size());
    for (std::size_t pair = 0; pair < timeline_.pairs().size(); ++pair) {
      (void)answer_of(pair);
    }
  }

  /// The time after which nothing matters.
  [[nodiscard]] double horizon() const { return asks_each_pair() || only_ ? 1.0 : first_; }

  void report(double done) const {
    if (options_.progress) {
      options_.progress(asks_each_pair() ? done : std::min(done, first_));
    }
  }

  void for_each(std::size_t count, const std::function<void(std::size_t)>& use) const {
    parallel_for(options_.threads, count, use);
  }

  std::vector<GeometryCandidate> find_candidates(std::size_t first, std::size_t last) {
    std::function<bool(std::size_t)> wanted;
    if (only_) {
      wanted = [&](std::size_t pair) { return pair == *only_; };
    } else if (asks_each_pair() && !options_.all_contacts_in_time) {
      wanted = [&](std::size_t pair) { return answer_of(pair).verdict == Verdict::free; };
    }
    const std::span<const double> held = holds_ ? holds_->greatest() : std::span<const double>();
    std::vector<std::vector<GeometryCandidate>> found(last - first);
    for_each(found.size(),
             [&](std::size_t k) { found[k] = candidates_.find(first + k, wanted, held); });
    std::vector<GeometryCandidate> all;
    for (const std::vector<GeometryCandidate>& of_piece : found) {
      all.insert(all.end(), of_piece.begin(), of_piece.end());
    }
    if (holds_) {
      std::for_each(all.begin(), all.end(),
                    [&](GeometryCandidate& candidate) { holds_->apply(candidate); });
    }
    return all;
  }

  void search(std::span<const GeometryCandidate> left) {
    std::size_t size = kFirstRound;
    while (!left.empty()) {
      const auto round = left.first(std::min(size, left.size()));
      left = left.subspan(round.size());
      size = std::min(2 * size, kLargestRound);
      const double end = horizon();
      report(timeline_.piece(round.front().piece).begin);
      std::vector<std::optional<GeometryAnswer>> answers(round.size());
      for_each(round.size(), [&](std::size_t k) {
        if (round[k].window.begin <= end) {
          answers[k] = ask(round[k], end);
        }
      });
      for (std::size_t k = 0; k < round.size(); ++k) {
        if (answers[k]) {
          take(round[k], std::move(*answers[k]));
        }
      }
    }
  }

  GeometryAnswer ask(const GeometryCandidate& candidate, double end) {
    GeometrySearch search(timeline_, candidate, options_, workspaces_.local());
    if (options_.all_contacts_in_time) {
      return contact_intervals_of(search, candidate, options_.time_resolution);
    }
    return first_contact_of(search, candidate, end, is_tested_anew(candidate));
  }

  /// Whether a pair comes to be tested: its bodies may be inside of each other by then.
  [[nodiscard]] bool is_tested_anew(const GeometryCandidate& candidate) const {
    return candidate.piece > 0 &&
           candidate.window.begin == timeline_.piece(candidate.piece).begin &&
           !timeline_.is_tested(timeline_.pairs()[candidate.pair], candidate.piece - 1);
  }

  /// Takes the answer of a candidate. A contact holds for the pair even beside an undecided search:
  /// nothing touches before it.
  void take(const GeometryCandidate& candidate, GeometryAnswer&& answer) {
    PairAnswer& pair = answer_of(candidate.pair);
    const FirstContactResult& found = answer.first;
    detail::PairContacts& contacts = contacts_[place_of_[candidate.pair]];
    pair.work += answer.work;
    pair.intervals.insert(pair.intervals.end(), answer.intervals.begin(), answer.intervals.end());
    const bool decides = decides_before(found, pair);
    const bool adds = !decides && found.t == pair.t && is_contact(found.verdict);
    merge(found, pair);
    if (decides) {
      pair.margin = answer.margin;
      pair.contact_count = found.contact_count;
      contacts.clear();
      contacts.add(found.contacts);
      deciding_geometries_[place_of_[candidate.pair]] = {candidate.geometries};
    } else if (adds) {
      pair.contact_count += found.contact_count;
      contacts.add(found.contacts);
      deciding_geometries_[place_of_[candidate.pair]].push_back(candidate.geometries);
    }
    if (found.verdict == Verdict::free) {
      return;
    }
    if (!earliest_ || pair.t < first_) {
      earliest_ = {candidate, found.t};
    }
    first_ = std::min(first_, pair.t);
  }

  /// Makes all pairs that are free so far undecided from t on.
  void give_up(double t, UndecidedReason reason) {
    if (only_) {
      give_up(answer_of(*only_), t, reason);
      return;
    }
    answer_all();
    for (PairAnswer& pair : pairs_) {
      give_up(pair, t, reason);
    }
    first_ = std::min(first_, t);
  }

  static void give_up(PairAnswer& pair, double t, UndecidedReason reason) {
    pair.intervals.push_back({t, 1.0, reason});
    if (pair.verdict == Verdict::free) {
      pair.verdict = Verdict::undecided;
      pair.reason = reason;
      pair.t = t;
    }
  }

  void find_closest_of_each() {
    detail::BallsOfPieces balls(timeline_.piece_count());
    const auto spent = [&] { return detail::spent(options_.budget); };
    for_each(balls.size(), [&](std::size_t piece) {
      if (spent() != UndecidedReason::none) {
        return;  // It stays so: no pair needs the balls any more.
      }
      const TimeWindow window = timeline_.piece(piece);
      for (std::size_t geometry = 0; geometry < timeline_.geometries().size(); ++geometry) {
        balls[piece].push_back(
            detail::swept_ball(timeline_.geometries()[geometry].ball,
                               timeline_.path(geometry, 0.5 * (window.begin + window.end)), window,
                               workspaces_.local().places));
      }
    });
    for_each(timeline_.pairs().size(), [&](std::size_t k) {
      if (!timeline_.is_tested(timeline_.pairs()[k])) {
        return;  // The two are of interest at no time.
      }
      const UndecidedReason reason = spent();
      answer_of(k).closest =
          reason == UndecidedReason::none
              ? least_clearance_of(timeline_, balls, k, options_, workspaces_.local())
              : ClosestApproach{.reason = reason};
    });
  }

  void find_closest_of_all() {
    const auto found =
        detail::least_of_all(timeline_, candidates_, earliest_, options_, workspaces_);
    if (!found) {
      return;
    }
    const PairAnswer& pair = answer_of(found->pair);
    const bool decides = pair.verdict != Verdict::free && pair.t == first_;
    if (first_ < 1.0 && !decides && detail::spent(options_.budget) == UndecidedReason::none) {
      answer_whole_step(found->pair);
    }
    answer_of(found->pair).closest = found->least;
    least_of_all_ = found->least.lower_bound;
  }

  /// Answers a pair over the whole step; it was searched only until another pair's contact.
  void answer_whole_step(std::size_t pair) {
    PairAnswer& answer = answer_of(pair);
    const WorkCount work = answer.work;
    answer = free_answer(pair);
    answer.work = work;
    contacts_[place_of_[pair]].clear();
    if (holds_) {
      give_up_without_hold(pair);
    }
    only_ = pair;
    walk();
    only_.reset();
  }

  SceneResult result() {
    SceneResult result;
    static_cast<Outcome&>(result) = outcome_of_no_pair(options_.tolerance);
    for (std::size_t pair = 0; pair < timeline_.pairs().size(); ++pair) {
      if (place_of_[pair] != kNone) {
        finish(pair);
      } else if (holds_) {
        result.clearance = std::min(result.clearance, holds_->least(pair));
      } else {
        result.clearance = timeline_.least_margin();  // Clearance of the pairs without an answer,
                                                      // which are all free.
      }
    }
    std::sort(pairs_.begin(), pairs_.end(),
              [](const PairAnswer& x, const PairAnswer& y) { return x.members < y.members; });
    for (const PairAnswer& pair : pairs_) {
      merge(pair, result);
      result.work += pair.work;
    }
    for (PairAnswer& pair : pairs_) {
      const bool decides = pair.verdict != Verdict::free && pair.t == result.t;
      if (asks_each_pair() || decides || pair.closest) {
        result.pairs.push_back(std::move(pair));
      }
    }
    result.first = deciding_pair(result.pairs);
    result.closest = closest_pair(result.pairs);
    result.clearance = std::max(result.clearance, least_of_all_);
    return result;
  }

  void finish(std::size_t index) {
    const std::size_t place = place_of_[index];
    PairAnswer& pair = pairs_[place];
    if (options_.contact_band > 0.0 && is_contact(pair.verdict)) {
      list_band(index);
    }
    pair.contacts = contacts_[place].take();
    pair.intervals = options_.all_contacts_in_time
                         ? detail::joined(std::move(pair.intervals), options_.time_resolution)
                         : std::vector<ContactInterval>();
    if (!timeline_.is_tested(timeline_.pairs()[index])) {
      pair.clearance = std::numeric_limits<double>::infinity();
      return;
    }
    // The effect of tracking errors may be less before t than at t.
    const double proven = holds_ ? holds_->least(index) : timeline_.pairs()[index].margin;
    pair.clearance =
        std::max(pair.t > 0.0 ? proven : 0.0, pair.closest ? pair.closest->lower_bound : 0.0);
    if (holds_) {
      for (const detail::HeldStretch& stretch : holds_->stretches(index)) {
        pair.work += stretch.work;
      }
    }
  }

  /// Lists the features within the band of geometries that do not decide; the others are listed
  /// already.
  void list_band(std::size_t index) {
    const std::size_t place = place_of_[index];
    PairAnswer& pair = pairs_[place];
    const std::vector<std::array<std::size_t, 2>>& known = deciding_geometries_[place];
    const double band = pair.margin + pair.tolerance_used + options_.contact_band;
    for (const std::array<std::size_t, 2>& geometries :
         timeline_.geometry_pairs(timeline_.pairs()[index])) {
      if (std::find(known.begin(), known.end(), geometries) != known.end()) {
        continue;
      }
      const GeometryCandidate candidate{.window = {pair.t, pair.t},
                                        .pair = index,
                                        .geometries = geometries,
                                        .threshold = pair.margin};
      GeometrySearch search(timeline_, candidate, options_, workspaces_.local());
      const FirstContactResult found = search.features_within(pair.t, band);
      pair.work += found.work;
      if (found.verdict != Verdict::free) {
        pair.contact_count += found.contact_count;
        contacts_[place].add(search.in_world(found.contacts, pair.t));
      }
    }
  }

  const detail::RobotTimeline& timeline_;
  const detail::CandidateSearch& candidates_;
  detail::LinkWorkspaces& workspaces_;
  const RobotCheckOptions& options_;
  std::vector<std::size_t> place_of_;  // Place in pairs_ of each tested pair; or kNone.
  std::vector<PairAnswer> pairs_;
  std::vector<detail::PairContacts> contacts_;  // Contacts of each of them, at its t.
  // The geometries of these contacts.
  std::vector<std::vector<std::array<std::size_t, 2>>> deciding_geometries_;
  std::optional<detail::PairHolds> holds_;     // For keep_half.
  double first_ = 1.0;                         // Before this time all pairs are proven free.
  std::optional<detail::KnownNear> earliest_;  // The search that found it.
  double least_of_all_ = 0.0;        // [m]  Least distance of all pairs, where that was asked for.
  std::optional<std::size_t> only_;  // The only pair that is answered now.
};

SceneResult check(Prepared& scene, const RobotCheckOptions& options) {
  validate(options);
  return RobotCheck(scene, options).run();
}

}  // namespace

struct RobotChecker::Data {
  explicit Data(RobotScene given) : scene(std::move(given)), prepared(scene) {}

  RobotScene scene;
  Prepared prepared;
};

RobotChecker::RobotChecker(RobotScene scene) {
  const FloatEnvironmentGuard guard;
  data_ = std::make_unique<Data>(std::move(scene));
}

RobotChecker::~RobotChecker() = default;
RobotChecker::RobotChecker(RobotChecker&&) noexcept = default;
RobotChecker& RobotChecker::operator=(RobotChecker&&) noexcept = default;

const RobotScene& RobotChecker::scene() const { return data_->scene; }

void RobotChecker::set_motion(std::size_t robot, RobotMotion motion) {
  const FloatEnvironmentGuard guard;
  data_->scene.set_motion(robot, std::move(motion));
  data_->prepared.timeline.follow_motions();
}

SceneResult RobotChecker::check(const RobotCheckOptions& options) {
  const FloatEnvironmentGuard guard;
  return firstcontact::check(data_->prepared, options);
}

SceneResult check_robots(const RobotScene& scene, const RobotCheckOptions& options) {
  const FloatEnvironmentGuard guard;
  Prepared prepared(scene);
  return check(prepared, options);
}

}  // namespace firstcontact
