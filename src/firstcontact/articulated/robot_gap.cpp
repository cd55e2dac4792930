#include <firstcontact/articulated/robot_gap.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

#include <firstcontact/articulated/detail/candidates.h>
#include <firstcontact/articulated/detail/link_query.h>
#include <firstcontact/articulated/detail/robot_timeline.h>
#include <firstcontact/math/float_environment.h>

namespace firstcontact {
namespace {

/// Two parts, and how far apart balls around them are at least.
struct NearParts {
  double bound = 0.0;      ///< [m]
  double threshold = 0.0;  ///< [m]
  std::array<std::size_t, 2> parts = {};
};

class GapSampler {
 public:
  explicit GapSampler(const RobotScene& scene) : timeline_(scene) {}

  [[nodiscard]] RobotGap at(double t) {
    RobotGap gap;
    for (const NearParts& near : by_distance(t)) {
      const bool may_touch = !gap.contact && near.bound <= near.threshold;
      if (near.bound > gap.distance && !may_touch) {
        continue;
      }
      const DistanceResult found = distance(near, t);
      gap.distance = std::min(gap.distance, found.distance);
      gap.lower_bound = std::min(gap.lower_bound, found.lower_bound);
      gap.contact = gap.contact || found.distance <= near.threshold;
    }
    return gap;
  }

 private:
  /// The earlier one at a break.
  [[nodiscard]] std::size_t piece_at(double t) const {
    std::size_t first = 0;
    std::size_t last = timeline_.piece_count() - 1;
    while (first < last) {
      const std::size_t middle = (first + last) / 2;
      if (timeline_.piece(middle).end < t) {
        first = middle + 1;
      } else {
        last = middle;
      }
    }
    return first;
  }

  [[nodiscard]] std::vector<detail::SweptBall> balls_at(double t) {
    std::vector<detail::SweptBall> balls;
    for (std::size_t part = 0; part < timeline_.parts().size(); ++part) {
      balls.push_back(detail::swept_ball(timeline_.parts()[part].ball, timeline_.path(part, t),
                                         {t, t}, workspace_.places));
    }
    return balls;
  }

  /// All parts of the pairs that are tested at t, the nearest balls first.
  [[nodiscard]] std::vector<NearParts> by_distance(double t) {
    const std::vector<detail::SweptBall> balls = balls_at(t);
    const std::size_t piece = piece_at(t);
    std::vector<NearParts> all;
    for (const detail::TestedPair& pair : timeline_.pairs()) {
      if (!timeline_.is_tested(pair, piece)) {
        continue;
      }
      const auto [first, second] = pair.members;
      for (std::size_t a = timeline_.first_part(first); a < timeline_.first_part(first + 1); ++a) {
        for (std::size_t b = timeline_.first_part(second); b < timeline_.first_part(second + 1);
             ++b) {
          const double errors = balls[a].tracking_error + balls[b].tracking_error;
          all.push_back({detail::gap_bound(balls[a], balls[b]), pair.margin + errors, {a, b}});
        }
      }
    }
    std::sort(all.begin(), all.end(), [](const NearParts& x, const NearParts& y) {
      return x.bound != y.bound ? x.bound < y.bound : x.parts < y.parts;
    });
    return all;
  }

  [[nodiscard]] DistanceResult distance(const NearParts& near, double t) {
    const auto [a, b] = near.parts;
    const detail::PairPaths paths = timeline_.paths(a, b, t);
    const LinkMotion X_FA(std::vector<LinkPath>{paths.A.X_FS});
    const LinkMotion X_FB(std::vector<LinkPath>{paths.B.X_FS});
    return detail::distance({*timeline_.parts()[a].shape, X_FA},
                            {*timeline_.parts()[b].shape, X_FB}, t, workspace_);
  }

  detail::RobotTimeline timeline_;
  detail::LinkWorkspace workspace_;
};

}  // namespace

std::vector<RobotGap> robot_gaps(const RobotScene& scene, std::span<const double> times,
                                 const std::stop_token& stop) {
  const FloatEnvironmentGuard guard;
  GapSampler sampler(scene);
  std::vector<RobotGap> gaps;
  for (const double t : times) {
    if (!(t >= 0.0 && t <= 1.0)) {
      throw std::invalid_argument("robot_gaps: t must be in [0, 1], got " + std::to_string(t));
    }
    if (stop.stop_requested()) {
      break;
    }
    gaps.push_back(sampler.at(t));
  }
  return gaps;
}

}  // namespace firstcontact
