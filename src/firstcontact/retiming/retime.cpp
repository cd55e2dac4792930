#include <firstcontact/retiming/retime.h>

#include <algorithm>
#include <optional>
#include <utility>

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

  BlendedMotion blended_within_limits(const std::vector<double>& longest) const {
    BlendedMotion blended;
    (void)within_limits([&](double share) {
      blended = blend_motion(path_, limits_, longest, share);
      if (options_.mode == RetimingMode::time_optimal) {
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
    while (!options_.proof.budget.stop.stop_requested()) {
      BlendedMotion blended = blended_within_limits(longest);
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

  /// Shortens the blend that is in contact or undecided; false where none is.
  bool shorten(const std::vector<Blend>& blends, const ExecutedProof& proof,
               std::vector<double>& longest) {
    constexpr double kShortest = 1e-3;  // [-]  Share of an edge; shorter blends gain nothing.
    const double at = proof.contact_time() * 1e9;
    for (std::size_t k = 0; k < blends.size(); ++k) {
      const Blend& blend = blends[k];
      const bool is_blend = blend.end > blend.begin;
      // A contact at the instant where an edge and a blend meet counts for the blend.
      constexpr double kMeeting = 1000.0;  // [ns]
      if (is_blend && static_cast<double>(blend.begin) - kMeeting <= at &&
          at <= static_cast<double>(blend.end) + kMeeting) {
        longest[k] = 0.5 * std::max(blend.before, blend.after);
        longest[k] = longest[k] < kShortest ? 0.0 : longest[k];
        ++shortened_;
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
