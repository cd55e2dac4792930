#include <firstcontact/robot_check/robot_gap.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/robot_check/detail/link_query.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>
#include <firstcontact/robot_check/detail/swept_ball.h>

namespace firstcontact {
namespace {

/// Two geometries, and a lower bound of their distance by balls.
struct NearGeometries {
  double bound = 0.0;      ///< [m]
  double margin = 0.0;     ///< [m]
  double threshold = 0.0;  ///< [m]  Bound of the margin with tracking errors.
  std::array<std::size_t, 2> geometries = {};
};

class GapSampler {
 public:
  explicit GapSampler(const RobotScene& scene) : timeline_(scene) {}

  [[nodiscard]] RobotGap at(double t) {
    RobotGap gap;
    for (const NearGeometries& near : by_distance(t)) {
      // Pairs that are farther apart than this change nothing.
      const double reach = gap.contact ? gap.distance : std::max(gap.distance, near.threshold);
      const GeometryPair pair(timeline_, near.geometries, t);
      if (near.bound > reach || is_farther(pair, t, reach)) {
        continue;
      }
      const DistanceResult found = detail::distance(pair.A(), pair.B(), t, workspace_);
      if (found.distance < gap.distance) {
        gap.distance = found.distance;
        nearest_ = near.geometries;
      }
      gap.lower_bound = std::min(gap.lower_bound, found.lower_bound);
      gap.contact = gap.contact || is_contact(near, t, found.distance);
    }
    return gap;
  }

 private:
  /// Whether a distance is that of a contact, as a check bounds the tracking errors.
  [[nodiscard]] bool is_contact(const NearGeometries& near, double t, double distance) {
    if (distance <= near.margin || distance > near.threshold) {
      return distance <= near.margin;
    }
    const auto [a, b] = near.geometries;
    return distance <= near.margin + timeline_.paths(a, b, t).tracking_bound(
                                         timeline_.geometries()[a], timeline_.geometries()[b],
                                         {t, t}, workspace_.places);
  }

  /// Two geometries with their motions about a time.
  class GeometryPair {
   public:
    GeometryPair(const detail::RobotTimeline& timeline,
                 const std::array<std::size_t, 2>& geometries, double t)
        : GeometryPair(timeline, geometries, timeline.paths(geometries[0], geometries[1], t)) {}

    [[nodiscard]] MovingLink A() const { return {A_, X_FA_}; }
    [[nodiscard]] MovingLink B() const { return {B_, X_FB_}; }

   private:
    GeometryPair(const detail::RobotTimeline& timeline,
                 const std::array<std::size_t, 2>& geometries, const detail::PairPaths& paths)
        : A_(*timeline.geometries()[geometries[0]].shape),
          B_(*timeline.geometries()[geometries[1]].shape),
          X_FA_(std::vector<LinkPath>{paths.A.X_FS}),
          X_FB_(std::vector<LinkPath>{paths.B.X_FS}) {}

    const Shape& A_;
    const Shape& B_;
    LinkMotion X_FA_;
    LinkMotion X_FB_;
  };

  /// Whether that can be proven without the distance, which costs more.
  [[nodiscard]] bool is_farther(const GeometryPair& pair, double t, double distance) {
    if (!std::isfinite(distance)) {
      return false;
    }
    FirstContactOptions query;
    query.margin = distance;
    query.tolerance = 1e-9 + 1e-3 * distance;
    query.contacts = ContactState::none;
    FirstContactResult result;
    detail::first_contact(pair.A(), pair.B(), {t, t}, workspace_, query, result);
    return result.verdict == Verdict::free;
  }

  /// The piece that contains t, the earlier one at a break.
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
    for (std::size_t geometry = 0; geometry < timeline_.geometries().size(); ++geometry) {
      balls.push_back(detail::swept_ball(timeline_.geometries()[geometry].ball,
                                         timeline_.path(geometry, t), {t, t}, workspace_.places));
    }
    return balls;
  }

  /// All geometries of the pairs that are tested at t: those that were nearest before, then those
  /// with the nearest balls.
  [[nodiscard]] std::vector<NearGeometries> by_distance(double t) {
    const std::vector<detail::SweptBall> balls = balls_at(t);
    const std::size_t piece = piece_at(t);
    std::vector<NearGeometries> all;
    for (const detail::TestedPair& pair : timeline_.pairs()) {
      if (!timeline_.is_tested(pair, piece)) {
        continue;
      }
      for (const auto& [a, b] : timeline_.geometry_pairs(pair)) {
        const double errors = balls[a].tracking_error + balls[b].tracking_error;
        all.push_back(
            {detail::gap_bound(balls[a], balls[b]), pair.margin, pair.margin + errors, {a, b}});
      }
    }
    std::sort(all.begin(), all.end(), [this](const NearGeometries& x, const NearGeometries& y) {
      const bool was_nearest = x.geometries == nearest_;
      if (was_nearest != (y.geometries == nearest_)) {
        return was_nearest;
      }
      return x.bound != y.bound ? x.bound < y.bound : x.geometries < y.geometries;
    });
    return all;
  }

  detail::RobotTimeline timeline_;
  detail::LinkWorkspace workspace_;
  std::array<std::size_t, 2> nearest_ = {};  // Geometries that were nearest at the time before.
};

}  // namespace

std::vector<RobotGap> robot_gaps(const RobotScene& scene, std::span<const double> times,
                                 const std::stop_token& stop) {
  const FloatEnvironmentGuard guard;
  GapSampler sampler(scene);
  std::vector<RobotGap> gaps;
  for (const double t : times) {
    if (!(t >= 0.0 && t <= 1.0)) {
      throw std::invalid_argument("robot_gaps: t must be in [0, 1], got " + detail::shortest(t));
    }
    if (stop.stop_requested()) {
      break;
    }
    gaps.push_back(sampler.at(t));
  }
  return gaps;
}

}  // namespace firstcontact
