#include <firstcontact/query/detail/triangle_follower.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/narrowphase/advance.h>
#include <firstcontact/narrowphase/advance_deforming.h>
#include <firstcontact/narrowphase/convex_pair.h>
#include <firstcontact/narrowphase/precise_linear_contact.h>
#include <firstcontact/narrowphase/separating_direction.h>
#include <firstcontact/query/detail/corner_lines.h>

namespace firstcontact::detail {
namespace {

/// Ratio of squared lengths below which the direction that the features define is better than that
/// between two closest points.
constexpr double kNearlyCoinciding = 0x1p-40;

/// [-]  A direction whose gap is this part of the distance is as good as the best one.
constexpr double kNearEnough = 0.75;

/// Most steps of one pair of triangles in a row; a dozen times what most take.
constexpr int kPatience = 100;

/// [m^2]  Squared size of the larger triangle, roughly.
double size2(const TrianglePair& pair) {
  return std::max((pair.A[1] - pair.A[0]).squaredNorm() + (pair.A[2] - pair.A[0]).squaredNorm(),
                  (pair.B[1] - pair.B[0]).squaredNorm() + (pair.B[2] - pair.B[0]).squaredNorm());
}

}  // namespace

void TriangleFollower::follow(TriangleEntry entry) {
  ++search_.work.triangle_pairs;
  if (search_.pair.is_convex()) {
    follow_convex(entry);
    return;
  }
  const SearchLimits& limits = search_.limits;
  PairInstant& instant = search_.instant;
  std::vector<OpenedPair>& opened = search_.workspace.opened_pairs;
  const double due = search_.queue.empty() ? search_.horizon()
                                           : search_.queue.top().priority() + search_.tie_window;
  double t = entry.key;
  int steps_left = kPatience;
  do {
    if (search_.best.contact && t >= search_.best.t) {
      return;  // No time is left before the contact.
    }
    ++search_.work.steps;
    instant.move_to(t);
    const TrianglePair triangles = search_.pair.place(instant.state(), entry.a, entry.b);
    const ClosestFeatures closest = triangle_distance(triangles.A, triangles.B);
    if (entry.opened < opened.size()) {
      opened[entry.opened].t = t;
      opened[entry.opened].distance = closest.distance;
    }
    const double apart = closest.distance + instant.error();
    if (apart <= limits.threshold + 0.5 * limits.tolerance) {
      if (limits.lines == nullptr || limits.asked >= limits.tolerance ||
          !decide_precisely(entry, t)) {
        search_.found(entry, t, limits.threshold + limits.tolerance - apart);
      }
      return;
    }
    const double tau = step(entry, triangles, closest, t);
    if (search_.covered(t, tau)) {
      ++search_.freed;
      return;
    }
    const double next = after(t, tau);
    if (!(next > t)) {
      // Doubles cannot advance the pair any further.
      if (limits.lines != nullptr && decide_precisely(entry, t)) {
        return;
      }
      if (apart <= limits.band) {
        search_.found(entry, t, limits.band - apart);
        return;
      }
      search_.unresolved = true;
      break;
    }
    if (comes_soon(entry, t, tau)) {
      return;
    }
    // A tiny gap lasts while triangles turn; double-doubles know a direction for that.
    if (--steps_left == 0 && limits.lines != nullptr && decide_precisely(entry, t)) {
      return;
    }
    t = next;
  } while (t <= due && !search_.watch.may_be_spent(search_.steps()));
  entry.key = t;
  search_.queue.push(entry);
}

void TriangleFollower::follow_convex(TriangleEntry entry) {
  const SearchLimits& limits = search_.limits;
  PairInstant& instant = search_.instant;
  const double due = search_.queue.empty() ? search_.horizon()
                                           : search_.queue.top().priority() + search_.tie_window;
  double t = entry.key;
  ConvexGuess guess;
  bool begins = true;
  do {
    if (search_.best.contact && t >= search_.best.t) {
      return;  // No time is left before the contact.
    }
    ++search_.work.steps;
    instant.move_to(t);
    const ConvexLeaf leaf(search_.pair, instant.state(), entry.a, entry.b);
    if (begins) {
      guess = guess_of(leaf);
      begins = false;
    }
    ConvexWanted wanted{.least = limits.threshold + instant.error(),
                        .near = kNearEnough,
                        .close = limits.threshold + 0.5 * limits.tolerance - instant.error()};
    ConvexClosest closest = leaf.closest(wanted, guess);
    double apart = closest.distance + instant.error();
    double tau = convex_step(leaf, closest.n);
    if (apart > limits.threshold + 0.5 * limits.tolerance && !(tau > 0.0)) {
      // The search ended early because it began with unsuitable points.
      guess.count = 0;
      wanted.near = 1.0;
      closest = leaf.closest(wanted, guess);
      apart = closest.distance + instant.error();
      tau = convex_step(leaf, closest.n);
    }
    if (apart <= limits.threshold + 0.5 * limits.tolerance) {
      search_.found(entry, t, limits.threshold + limits.tolerance - apart);
      return;
    }
    if (search_.covered(t, tau)) {
      ++search_.freed;
      return;
    }
    const double next = after(t, tau);
    if (!(next > t)) {
      if (apart <= limits.band) {
        search_.found(entry, t, limits.band - apart);
        return;
      }
      search_.unresolved = true;
      break;
    }
    if (comes_soon(entry, t, tau)) {
      return;
    }
    t = next;
  } while (t <= due && !search_.watch.may_be_spent(search_.steps()));
  entry.key = t;
  search_.queue.push(entry);
}

bool TriangleFollower::comes_soon(TriangleEntry entry, double t, double tau) {
  const SearchLimits& limits = search_.limits;
  const double ahead = 0.5 * limits.early;  // The rest is left for the order of ties.
  if (!(tau < ahead) || search_.best.contact) {
    return false;
  }
  const double later = std::min(t + ahead, search_.horizon());
  const RelativeState state = search_.pair.motion().state(later);
  ++search_.work.steps;
  if (distance_at(entry, state) + search_.pair.gap_error(state) >
      limits.threshold + 0.5 * limits.tolerance) {
    return false;
  }
  search_.found(entry, later, 0.0);
  entry.key = t;  // The pair is proven free until then.
  search_.queue.push(entry);
  return true;
}

double TriangleFollower::distance_at(const TriangleEntry& entry, const RelativeState& state) const {
  if (search_.pair.is_convex()) {
    const ConvexLeaf leaf(search_.pair, state, entry.a, entry.b);
    ConvexGuess guess = guess_of(leaf);
    return leaf.closest({.close = search_.limits.threshold}, guess).distance;
  }
  const TrianglePair triangles = search_.pair.place(state, entry.a, entry.b);
  return triangle_distance(triangles.A, triangles.B).distance;
}

double TriangleFollower::convex_step(const ConvexLeaf& leaf, const Eigen::Vector3d& n) const {
  const PairInstant& instant = search_.instant;
  return n.isZero(0.0)
             ? 0.0
             : advance_convex(instant.state(), leaf.A(), leaf.B(), n, search_.limits.threshold,
                              instant.error(), search_.horizon());
}

double TriangleFollower::step_of(const TriangleEntry& entry, double t) const {
  const SearchLimits& limits = search_.limits;
  const PairInstant& instant = search_.instant;
  const double within = limits.threshold + limits.tolerance;
  if (search_.pair.is_convex()) {
    const ConvexLeaf leaf(search_.pair, instant.state(), entry.a, entry.b);
    ConvexGuess guess = guess_of(leaf);
    const ConvexClosest closest = leaf.closest(
        {.least = within, .near = kNearEnough, .close = within - instant.error()}, guess);
    return closest.distance + instant.error() <= within ? 0.0 : convex_step(leaf, closest.n);
  }
  const TrianglePair triangles = search_.pair.place(instant.state(), entry.a, entry.b);
  const ClosestFeatures closest = triangle_distance(triangles.A, triangles.B);
  return closest.distance + instant.error() <= within ? 0.0 : step(entry, triangles, closest, t);
}

bool TriangleFollower::decide_precisely(const TriangleEntry& entry, double t) {
  const SearchLimits& limits = search_.limits;
  const LinearTriangles triangles = limits.lines->triangles(entry.a, entry.b);
  const PreciseLinearContact precise =
      precise_linear_contact(triangles.A, triangles.B,
                             {.threshold = limits.threshold,
                              .tolerance = limits.asked,
                              .least_tolerance = limits.tolerance,
                              .position_error = triangles.position_error + threshold_rounding(),
                              .t_begin = t});
  search_.work.steps += static_cast<std::uint64_t>(precise.steps);
  if (precise.verdict == PreciseLinearVerdict::unresolved) {
    return false;
  }
  if (precise.verdict == PreciseLinearVerdict::free || precise.t > search_.t_end) {
    ++search_.freed;
  } else {
    search_.found(entry, precise.t, 0.0, precise.tolerance_used);
  }
  return true;
}

double TriangleFollower::threshold_rounding() const {
  const SearchLimits& limits = search_.limits;
  const bool is_exact = limits.A == nullptr || limits.A->radius() + limits.B->radius() == 0.0;
  return is_exact ? 0.0 : 0x1p-52 * limits.threshold;
}

double TriangleFollower::step(const TriangleEntry& entry, const TrianglePair& triangles,
                              const ClosestFeatures& closest, double t) const {
  const Eigen::Vector3d d = closest.p_B - closest.p_A;
  double best = 0.0;
  const auto consider = [&](const Eigen::Vector3d& direction) {
    const double length = direction.norm();
    if (length > 0.0 && best <= search_.horizon() - t) {
      best = std::max(best, step_along(entry, triangles, closest, direction / length));
    }
  };
  consider(d);
  if (d.squaredNorm() < kNearlyCoinciding * size2(triangles)) {
    const Eigen::Vector3d by_features = separating_direction(triangles, closest);
    consider(by_features.dot(d) < 0.0 ? Eigen::Vector3d(-by_features) : by_features);
  }
  if (!(best > 0.0)) {
    for_each_plane_normal(triangles, [&](const Eigen::Vector3d& n) {
      consider(n);
      consider(-n);
    });
  }
  return best;
}

double TriangleFollower::step_along(const TriangleEntry& entry, const TrianglePair& triangles,
                                    const ClosestFeatures& closest,
                                    const Eigen::Vector3d& n) const {
  const PairInstant& instant = search_.instant;
  const double threshold = search_.limits.threshold;
  if (!search_.pair.deforms()) {
    return advance(instant.state(), triangles, n, threshold, instant.error(), search_.horizon());
  }
  return advance_deforming(instant.state(), triangles,
                           search_.pair.rates(instant.state(), entry.a, entry.b), closest, n,
                           threshold, instant.error(), search_.horizon());
}

}  // namespace firstcontact::detail
