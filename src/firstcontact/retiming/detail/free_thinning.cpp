#include <firstcontact/retiming/detail/free_thinning.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include <firstcontact/retiming/detail/thinned_path.h>
#include <firstcontact/retiming/stop_motion.h>

namespace firstcontact::detail {
namespace {

class FreeThinning {
 public:
  FreeThinning(const WaypointPath& path, const std::vector<RateLimits>& limits,
               const RetimingScene& where, const ProofOptions& options,
               std::vector<std::size_t> kept)
      : path_(path), limits_(limits), where_(where), options_(options), kept_(std::move(kept)) {}

  std::vector<std::size_t> run() {
    std::size_t proven = 0;  // Edges before this one are free.
    while (!options_.budget.stop.stop_requested()) {
      const std::optional<std::size_t> blocked = first_blocked(proven);
      if (!blocked) {
        break;
      }
      const auto edge = static_cast<std::ptrdiff_t>(*blocked);
      const std::size_t farthest =
          farthest_from_edge(path_, kept_[*blocked], kept_[*blocked + 1]).waypoint;
      if (farthest == kept_[*blocked]) {
        if (!where_.holds.empty()) {
          break;  // The proof of the motion begins anew each time.
        }
        proven = *blocked + 1;
      } else {
        kept_.insert(kept_.begin() + edge + 1, farthest);
        proven = *blocked;
      }
    }
    return std::move(kept_);
  }

 private:
  /// The first edge from a given one on that is not proven free.
  [[nodiscard]] std::optional<std::size_t> first_blocked(std::size_t from) const {
    // Holds are for the times of the whole motion.
    from = where_.holds.empty() ? from : 0;
    if (from + 1 >= kept_.size()) {
      return std::nullopt;
    }
    const WaypointPath rest = through_waypoints(
        path_, {std::next(kept_.begin(), static_cast<std::ptrdiff_t>(from)), kept_.end()});
    const TimedMotion motion = stop_motion(rest, limits_);
    const ExecutedProof proof = prove_motion(motion, limits_, where_, options_);
    if (proof.contact.verdict == Verdict::free) {
      return std::nullopt;
    }
    return from + edge_at(motion, rest, proof.contact_time() * 1e9);
  }

  /// The edge of a motion with rests that is under way at a time [ns].
  static std::size_t edge_at(const TimedMotion& motion, const WaypointPath& path, double time) {
    std::size_t edge = 0;
    for (const TimedPoint& point : motion.points) {
      const bool is_end = edge + 2 < path.waypoints.size() &&
                          point.positions == path.waypoints[edge + 1] &&
                          std::ranges::all_of(point.velocities, [](double v) { return v == 0.0; });
      if (static_cast<double>(point.time) > time) {
        break;
      }
      edge += is_end ? 1 : 0;
    }
    return edge;
  }

  const WaypointPath& path_;
  const std::vector<RateLimits>& limits_;
  const RetimingScene& where_;
  const ProofOptions& options_;
  std::vector<std::size_t> kept_;
};

}  // namespace

std::vector<std::size_t> free_thinning(const WaypointPath& path,
                                       const std::vector<RateLimits>& limits,
                                       const RetimingScene& where, const ProofOptions& options,
                                       double tolerance, const std::vector<std::size_t>& kept) {
  std::vector<std::size_t> thinned = thinned_waypoints(path, tolerance, kept);
  if (thinned.size() == path.waypoints.size()) {
    return thinned;
  }
  return FreeThinning(path, limits, where, options, std::move(thinned)).run();
}

}  // namespace firstcontact::detail
