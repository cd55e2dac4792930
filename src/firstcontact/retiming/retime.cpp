#include <firstcontact/retiming/retime.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <firstcontact/retiming/blend_motion.h>
#include <firstcontact/retiming/stop_motion.h>
#include <firstcontact/retiming/time_optimal_motion.h>

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
    if (options_.mode != RetimingMode::stop) {
      if (std::optional<RetimedMotion> blended = blend(stop.duration())) {
        return std::move(*blended);
      }
      best.shortened = shortened_;
    }
    best.proof = prove(stop);
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

  BlendedMotion blended_within_limits(const std::vector<double>& longest, RetimingMode mode) const {
    BlendedMotion blended;
    (void)within_limits([&](double share) {
      blended = blend_motion(path_, limits_, longest, share);
      if (mode == RetimingMode::time_optimal) {
        blended = time_optimal_motion(blended, path_, limits_, share);
      }
      return blended.motion;
    });
    return blended;
  }

  /// The longest blends. The motion rests where pairs have to be open, as the time of their hold
  /// ends there.
  [[nodiscard]] std::vector<double> longest_blends() const {
    std::vector<double> longest(path_.waypoints.size() - 2, kLongestBlend);
    for (const RetimingHold& hold : where_.holds) {
      if (!hold.opens_at.empty() && !longest.empty()) {
        (hold.at == PathEnd::start ? longest.front() : longest.back()) = 0.0;
      }
    }
    return longest;
  }

  /// A proven motion with blends that is faster than the one without; none where there is none.
  std::optional<RetimedMotion> blend(double stop_duration) {
    std::vector<double> longest = longest_blends();
    if (where_.holds.empty()) {  // Holds are for the times of the whole motion.
      shorten_apart(longest);
    }
    while (!options_.proof.budget.stop.stop_requested()) {
      BlendedMotion blended = blended_within_limits(longest, options_.mode);
      if (!(blended.motion.duration() < stop_duration)) {
        return std::nullopt;
      }
      ExecutedProof proof = prove(blended.motion);
      if (proof.is_proven()) {
        const auto passed =
            std::count_if(blended.blends.begin(), blended.blends.end(),
                          [](const Blend& blend) { return blend.end > blend.begin; });
        return RetimedMotion{.mode = options_.mode,
                             .motion = std::move(blended.motion),
                             .proof = std::move(proof),
                             .stop_duration = stop_duration,
                             .blends = static_cast<std::size_t>(passed),
                             .shortened = shortened_};
      }
      if (!proof.holds_limits() || !shorten(blended.blends, proof, longest)) {
        break;
      }
    }
    return std::nullopt;
  }

  /// Shortens all blends that are not free by themselves, until the others are free.
  ///
  /// A proof of the whole motion ends at its first contact: that would take a proof for each blend.
  /// Of a blend only the motion that was not yet proven is proven.
  void shorten_apart(std::vector<double>& longest) {
    std::vector<TimedMotion> free(longest.size());
    bool is_done = false;
    while (!is_done && !options_.proof.budget.stop.stop_requested()) {
      const BlendedMotion blended = blended_within_limits(longest, RetimingMode::blend);
      is_done = true;
      for (std::size_t k = 0; k < longest.size(); ++k) {
        const Blend& blend = blended.blends[k];
        TimedMotion part = part_of(blended.motion, blend.begin, blend.end);
        if (part.points.size() < 2 || part == free[k]) {
          continue;
        }
        if (prove(part).contact.verdict == Verdict::free) {
          free[k] = std::move(part);
        } else {
          halve(blend, longest[k]);
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
  bool shorten(const std::vector<Blend>& blends, const ExecutedProof& proof,
               std::vector<double>& longest) {
    const double at = proof.contact_time() * 1e9;
    for (std::size_t k = 0; k < blends.size(); ++k) {
      const Blend& blend = blends[k];
      const bool is_blend = blend.end > blend.begin;
      // A contact at the instant where an edge and a blend meet counts for the blend.
      constexpr double kMeeting = 1000.0;  // [ns]
      if (is_blend && static_cast<double>(blend.begin) - kMeeting <= at &&
          at <= static_cast<double>(blend.end) + kMeeting) {
        halve(blend, longest[k]);
        return true;
      }
    }
    return false;
  }

  const WaypointPath& path_;
  const std::vector<RateLimits>& limits_;
  const RetimingScene& where_;
  const RetimingOptions& options_;
  std::size_t shortened_ = 0;
};

}  // namespace

RetimedMotion retime(const WaypointPath& path, const std::vector<RateLimits>& limits,
                     const RetimingScene& where, const RetimingOptions& options) {
  require_path(path);
  require_limits(path.joint_names, limits);
  require_resting_surroundings(where);
  return Retimer(path, limits, where, options).run();
}

}  // namespace firstcontact
