#include <firstcontact/query/closest_approach.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/query/detail/order.h>
#include <firstcontact/query/shape_pair.h>

namespace firstcontact {
namespace {

/// Bounds the least distance from above by sampling and local descent; first_contact() certifies
/// it.
class Descent {
 public:
  Descent(const ShapePair& pair, Workspace& workspace, const WorkBudget& budget,
          ClosestApproachResult& best)
      : pair_(pair), workspace_(workspace), budget_(budget), best_(best) {}

  /// Whether to leave the rest to a search, which reports why it ends.
  [[nodiscard]] bool is_over() const {
    return budget_.stop.stop_requested() ||
           (budget_.deadline && std::chrono::steady_clock::now() >= *budget_.deadline);
  }

  double sample(double t) {
    const DistanceResult here = distance(pair_, t, workspace_);
    best_.work.node_groups += here.work.node_groups;
    best_.work.triangle_pairs += here.work.triangle_pairs;
    if (here.distance < best_.distance) {
      best_.distance = here.distance;
      best_.t = t;
      best_.closest = here.closest;
    }
    return here.distance;
  }

  /// Golden-section search around t, within `width` on either side.
  void improve(double t, double width, double tolerance) {
    constexpr double kGolden = 0.6180339887498949;
    double low = std::max(0.0, t - width);
    double high = std::min(1.0, t + width);
    double x = high - kGolden * (high - low);
    double y = low + kGolden * (high - low);
    double dx = sample(x);
    double dy = sample(y);
    constexpr int kSteps = 60;
    for (int i = 0; i < kSteps && std::abs(dx - dy) > 0.01 * tolerance && !is_over(); ++i) {
      if (dx < dy) {
        high = y;
        y = x;
        dy = dx;
        x = high - kGolden * (high - low);
        dx = sample(x);
      } else {
        low = x;
        x = y;
        dx = dy;
        y = low + kGolden * (high - low);
        dy = sample(y);
      }
    }
  }

 private:
  const ShapePair& pair_;
  Workspace& workspace_;
  const WorkBudget& budget_;
  ClosestApproachResult& best_;
};

}  // namespace

ClosestApproachResult closest_approach(const ShapePair& pair, Workspace& workspace,
                                       const ClosestApproachOptions& options) {
  if (!(options.tolerance > 0.0 && std::isfinite(options.tolerance))) {
    throw std::invalid_argument("ClosestApproachOptions::tolerance must be finite and > 0, got " +
                                detail::shortest(options.tolerance));
  }
  const FloatEnvironmentGuard guard;
  ClosestApproachResult best;
  best.tolerance_used = options.tolerance;
  best.enclosure_error = detail::enclosure_error(pair.A, pair.B);
  Descent descent(pair, workspace, options.budget, best);
  FirstContactOptions query;
  query.tolerance = options.tolerance;
  query.contacts = ContactState::none;
  query.budget = options.budget;
  FirstContactResult found;
  const auto search = [&]() -> const FirstContactResult& {
    first_contact(pair, {}, workspace, query, found);
    best.work += found.work;
    best.tolerance_used =
        std::max(best.tolerance_used, found.tolerance_used + options.tolerance - query.tolerance);
    best.reason = found.reason;
    return found;
  };
  // Bodies that touch are closest at their first contact.
  if (const FirstContactResult& touch = search(); touch.verdict != Verdict::free) {
    descent.sample(touch.t);
    return best;
  }
  constexpr int kSamples = 8;
  for (int i = 0; i <= kSamples && !descent.is_over(); ++i) {
    descent.sample(static_cast<double>(i) / kSamples);
  }
  descent.improve(best.t, 1.0 / kSamples, options.tolerance);
  // Proves that nothing is closer than distance - tolerance, or finds a closer place. After a round
  // that gained little, as from a plateau above a short dip, the next margin is midway.
  query.tolerance = 0.5 * options.tolerance;
  bool is_slow = false;
  while (best.lower_bound < best.distance - options.tolerance) {
    const double middle = 0.5 * (best.lower_bound + best.distance);
    query.margin = is_slow ? std::min(middle, best.distance - options.tolerance)
                           : best.distance - options.tolerance;
    const FirstContactResult& closer = search();
    if (closer.verdict == Verdict::free) {
      best.lower_bound = query.margin;
      continue;
    }
    if (closer.verdict == Verdict::undecided) {
      return best;
    }
    const double before = best.distance;
    descent.sample(closer.t);
    descent.improve(closer.t, 0.01, options.tolerance);
    if (!(best.distance < before)) {  // Rounding hides the gain of the search.
      best.reason = UndecidedReason::precision;
      return best;
    }
    is_slow = best.distance > 0.5 * (best.lower_bound + before);
  }
  return best;
}

ClosestApproachResult closest_approach(const MovingShape& A, const MovingShape& B,
                                       Workspace& workspace,
                                       const ClosestApproachOptions& options) {
  const auto ask = [&](const MovingShape& first, const MovingShape& second) {
    const FloatEnvironmentGuard guard;
    // Distances are to err much less than the tolerance.
    ConstantRatePair motion = detail::motion_of(first, second, 1e-3 * options.tolerance);
    return closest_approach({first.shape, second.shape, motion}, workspace, options);
  };
  if (detail::in_order(A, B)) {
    return ask(A, B);
  }
  ClosestApproachResult result = ask(B, A);
  if (result.closest) {
    swap_bodies(*result.closest);
  }
  return result;
}

}  // namespace firstcontact
