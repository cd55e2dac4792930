#include <firstcontact/retiming/retime.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <firstcontact/retiming/blend_motion.h>
#include <firstcontact/retiming/detail/free_thinning.h>
#include <firstcontact/retiming/detail/limit_breaks.h>
#include <firstcontact/retiming/detail/thinned_path.h>
#include <firstcontact/retiming/stop_motion.h>
#include <firstcontact/retiming/time_optimal_motion.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

/// Shares of the limits in the order of trial: the rounding of points to doubles takes little,
/// short phases take more.
constexpr std::array<double, 5> kShares{1.0 - 1e-8, 1.0 - 1e-6, 1.0 - 1e-4, 0.99, 0.9};

class Retimer {
 public:
  Retimer(const WaypointPath& path, const std::vector<RateLimits>& limits,
          const RetimingScene& where, const RetimingOptions& options)
      : path_(path), limits_(limits), where_(where), options_(options) {}

  RetimedMotion run() {
    const TimedMotion stop =
        within_limits([&](double share) { return stop_motion(path_, limits_, share); });
    RetimedMotion best{.motion = stop, .stop_duration = stop.duration()};
    best.proof = prove(stop);
    // An edge in contact is no matter of its blends, and takes far less time to find.
    if (options_.mode == RetimingMode::stop || best.proof.contact.verdict != Verdict::free ||
        !best.proof.positions.empty()) {
      return best;
    }
    leave_out_waypoints();
    if (std::optional<RetimedMotion> blended = blend(options_.mode, stop.duration())) {
      return std::move(*blended);
    }
    // Quintics of `time_optimal` leave the geometry of `blend`, which may be free alone.
    if (options_.mode == RetimingMode::time_optimal) {
      if (std::optional<RetimedMotion> blended = blend(RetimingMode::blend, stop.duration())) {
        return std::move(*blended);
      }
    }
    best.shortened = shortened_;
    return best;
  }

 private:
  [[nodiscard]] ExecutedProof prove(const TimedMotion& motion) const {
    return prove_motion(motion, limits_, where_, options_.proof);
  }

  /// Makes the first motion whose limits are proven; the last one where none is.
  template <class Make>
  TimedMotion within_limits(const Make& make) const {
    TimedMotion motion;
    for (const double share : kShares) {
      motion = make(share);
      if (!rate_beyond_limit(rate_report(motion, limits_))) {
        break;
      }
    }
    return motion;
  }

  /// Chooses the waypoints of the blended path.
  void leave_out_waypoints() {
    const double extent = detail::extent_of(path_);
    double tolerance = std::min(kLeftOutWithin, kLeftOutShare * extent);
    if (options_.blend_deviation) {
      tolerance = std::min(tolerance, 0.5 * *options_.blend_deviation);
    }
    // Pairs have to be open at these, so that the robot rests there.
    std::vector<std::size_t> kept;
    if (opens(PathEnd::start)) {
      kept.push_back(1);
    }
    if (opens(PathEnd::goal)) {
      kept.push_back(path_.waypoints.size() - 2);
    }
    thinned_ = detail::through_waypoints(
        path_, detail::free_thinning(path_, limits_, where_, options_.proof, tolerance, kept));
    if (options_.blend_deviation) {
      const bool is_whole = thinned_.waypoints.size() == path_.waypoints.size();
      deviation_ = *options_.blend_deviation - (is_whole ? 0.0 : tolerance);
    }
    set_longest_blends();
  }

  [[nodiscard]] bool opens(PathEnd at) const {
    return std::ranges::any_of(where_.holds, [at](const RetimingHold& hold) {
      return hold.at == at && !hold.opens_at.empty();
    });
  }

  /// The motion rests where pairs have to be open, as the time of their hold ends there, and where
  /// the way turns back.
  void set_longest_blends() {
    longest_.assign(thinned_.waypoints.size() - 2, kLongestBlend);
    for (std::size_t k = 0; k < longest_.size(); ++k) {
      longest_[k] = detail::turns_back(thinned_, k + 1) ? 0.0 : longest_[k];
    }
    if (opens(PathEnd::start) && !longest_.empty()) {
      longest_.front() = 0.0;
    }
    if (opens(PathEnd::goal) && !longest_.empty()) {
      longest_.back() = 0.0;
    }
  }

  BlendedMotion blended_with(RetimingMode mode, double share) const {
    BlendedMotion blended = blend_motion(thinned_, limits_, longest_, share, deviation_);
    return mode == RetimingMode::time_optimal
               ? time_optimal_motion(blended, thinned_, limits_, share)
               : std::move(blended);
  }

  /// The motion with blends; the robot rests where a limit is not proven with any share.
  BlendedMotion blended_within_limits(RetimingMode mode) {
    while (true) {
      BlendedMotion blended;
      const TimedMotion motion = within_limits([&](double share) {
        blended = blended_with(mode, share);
        return blended.motion;
      });
      if (!rate_beyond_limit(rate_report(motion, limits_)) || !rest_at_breaks(blended)) {
        return blended;
      }
    }
  }

  /// Rests at the waypoints beside segments that break a limit; false where it rests there already.
  bool rest_at_breaks(const BlendedMotion& blended) {
    bool has_changed = false;
    for (const detail::LimitBreak& segment : detail::limit_breaks(blended.motion, limits_)) {
      for (std::size_t k = 0; k < longest_.size(); ++k) {
        const std::int64_t before = k == 0 ? 0 : blended.blends[k - 1].end;
        const std::int64_t behind = k + 1 == longest_.size() ? blended.motion.points.back().time
                                                             : blended.blends[k + 1].begin;
        const bool is_beside = segment.begin < behind && before < segment.end;
        has_changed = has_changed || (is_beside && longest_[k] > 0.0);
        longest_[k] = is_beside ? 0.0 : longest_[k];
      }
    }
    return has_changed;
  }

  /// A proven motion with blends that is faster than the one without; none where there is none.
  std::optional<RetimedMotion> blend(RetimingMode mode, double stop_duration) {
    if (where_.holds.empty()) {  // Holds are for the times of the whole motion.
      shorten_apart();
    }
    while (!options_.proof.budget.stop.stop_requested()) {
      BlendedMotion blended = blended_within_limits(mode);
      if (!(blended.motion.duration() < stop_duration)) {
        return std::nullopt;
      }
      ExecutedProof proof = prove(blended.motion);
      if (proof.is_proven()) {
        const auto passed =
            std::count_if(blended.blends.begin(), blended.blends.end(),
                          [](const Blend& blend) { return blend.end > blend.begin; });
        return RetimedMotion{.mode = mode,
                             .motion = std::move(blended.motion),
                             .proof = std::move(proof),
                             .stop_duration = stop_duration,
                             .blends = static_cast<std::size_t>(passed),
                             .left_out = path_.waypoints.size() - thinned_.waypoints.size(),
                             .shortened = shortened_};
      }
      if (!proof.holds_limits() || !shorten(blended.blends, proof)) {
        break;
      }
    }
    return std::nullopt;
  }

  /// Shortens all blends that are not free by themselves, until the others are free.
  ///
  /// A proof of the whole motion ends at its first contact: that would take a proof for each blend.
  /// Of a blend only the motion that was not yet proven is proven.
  void shorten_apart() {
    std::vector<TimedMotion> free(longest_.size());
    bool is_done = false;
    while (!is_done && !options_.proof.budget.stop.stop_requested()) {
      const BlendedMotion blended = blended_within_limits(RetimingMode::blend);
      is_done = true;
      for (std::size_t k = 0; k < longest_.size(); ++k) {
        const Blend& blend = blended.blends[k];
        TimedMotion part = part_of(blended.motion, blend.begin, blend.end);
        if (part.points.size() < 2 || part == free[k]) {
          continue;
        }
        if (prove(part).contact.verdict == Verdict::free) {
          free[k] = std::move(part);
        } else {
          halve(blend, longest_[k]);
          is_done = false;
        }
      }
    }
  }

  /// The motion between two of its points, from the time 0 on.
  ///
  /// @param begin  [ns]
  /// @param end    [ns]
  static TimedMotion part_of(const TimedMotion& motion, std::int64_t begin, std::int64_t end) {
    TimedMotion part{.joint_names = motion.joint_names, .points = {}};
    for (const TimedPoint& point : motion.points) {
      if (begin <= point.time && point.time <= end) {
        part.points.push_back(point);
        part.points.back().time -= begin;
      }
    }
    return part;
  }

  /// Halves the longest blend at a waypoint.
  void halve(const Blend& blend, double& longest) {
    constexpr double kShortest = 1e-3;  // [-]  Share of an edge; shorter blends gain nothing.
    longest = 0.5 * std::max(blend.before, blend.after);
    longest = longest < kShortest ? 0.0 : longest;
    ++shortened_;
  }

  /// Shortens the blend that is in contact or undecided; false where none is.
  bool shorten(const std::vector<Blend>& blends, const ExecutedProof& proof) {
    const double at = proof.contact_time() * 1e9;
    for (std::size_t k = 0; k < blends.size(); ++k) {
      const Blend& blend = blends[k];
      const bool is_blend = blend.end > blend.begin;
      // A contact at the instant where an edge and a blend meet counts for the blend.
      constexpr double kMeeting = 1000.0;  // [ns]
      if (is_blend && static_cast<double>(blend.begin) - kMeeting <= at &&
          at <= static_cast<double>(blend.end) + kMeeting) {
        halve(blend, longest_[k]);
        return true;
      }
    }
    return false;
  }

  const WaypointPath& path_;
  const std::vector<RateLimits>& limits_;
  const RetimingScene& where_;
  const RetimingOptions& options_;
  WaypointPath thinned_ = {};         // The path without the waypoints that are left out.
  std::vector<double> longest_ = {};  // [-]  Longest blend at each of its inner waypoints.
  double deviation_ = kAnyDeviation;  // [rad or m]  Of blends.
  std::size_t shortened_ = 0;
};

}  // namespace

RetimedMotion retime(const WaypointPath& path, const std::vector<RateLimits>& limits,
                     const RetimingScene& where, const RetimingOptions& options) {
  require_path(path);
  require_limits(path.joint_names, limits);
  require_resting_surroundings(where);
  // Negated, so that NaN is refused too.
  if (options.blend_deviation && !(*options.blend_deviation > 0.0)) {
    throw std::invalid_argument("RetimingOptions::blend_deviation must be > 0, got " +
                                detail::write_json(*options.blend_deviation));
  }
  return Retimer(path, limits, where, options).run();
}

}  // namespace firstcontact
