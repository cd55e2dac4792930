/// @file
/// The search that the elementary tests share.

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <firstcontact/math/interval.h>
#include <firstcontact/math/root_isolation.h>
#include <firstcontact/narrowphase/elementary_contact.h>

namespace firstcontact::detail {

/// The times for which a gap provably stays open, and has been open.
struct OpenTimes {
  double ahead = 0.0;
  double since = 0.0;
};

/// Gaps of pairs of corners along one direction, at one time.
template <std::size_t N>
struct Gaps {
  std::array<ValueAndRate, N> corners;
  CurvatureBound bounds;

  /// The times over all pairs: time_positive() forth and back, without branches and with one root
  /// for both.
  ///
  /// The root is that of the greater speed. NaN takes the safe side.
  [[nodiscard]] OpenTimes open_times() const {
    constexpr double kLeast = 0x1p-1000;  // Keeps 0 / 0 away.
    OpenTimes open{std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity()};
    for (const ValueAndRate& gap : corners) {
      const double clear = std::max(0.0, gap.value - bounds.value_error);
      const double speed = std::abs(gap.rate) + bounds.rate_error;
      const double root =
          std::sqrt(speed * speed + 2.0 * bounds.curvature * clear) + 0x1p-50 * speed + kLeast;
      const double enough = 2.0 * clear * (1.0 - 0x1p-44);
      open.ahead =
          std::min(open.ahead, std::max(0.0, enough / (root + (bounds.rate_error - gap.rate))));
      open.since =
          std::min(open.since, std::max(0.0, enough / (root + (bounds.rate_error + gap.rate))));
    }
    return open;
  }
};

/// Finds where the features of `Pair` first meet.
///
/// While much is left, the search looks for a gap at the middle of it. Then it goes from t to where
/// neither a gap nor the sign of f is certain any more. Near a root of f it leaps ahead, isolates
/// the root and looks back.
///
/// `Pair` offers:
/// - move_to(t) places the features.
/// - coplanarity() is their function f there, and coplanarity_bounds() bounds f over the whole
///   piece.
/// - gaps() are those along a direction that may keep the features apart.
/// - meet_if_coplanar(duration), after coplanarity_bounds(), is whether the features provably meet
///   where they are coplanar within `duration` of t.
template <class Pair>
class ElementarySearch {
 public:
  ElementarySearch(Pair& pair, const ElementaryMotion& motion, const ElementaryOptions& options)
      : pair_(pair),
        options_(options),
        t_begin_(std::max(options.t_begin, motion.t_begin)),
        t_end_(std::min(options.t_end, motion.t_end)),
        t_(t_begin_),
        t_checked_(t_begin_) {}

  ElementaryContact run() {
    if (!(t_ <= t_end_)) {
      finish(ElementaryVerdict::free, t_end_, t_end_);
    }
    while (!done_ && may_step() && !stalls()) {
      step();
    }
    if (!done_) {
      finish(ElementaryVerdict::degenerate, t_, t_);
    }
    result_.steps = steps_;
    return result_;
  }

 private:
  /// A time without contact.
  struct Proven {
    double begin = 0.0;
    double end = 0.0;
  };

  /// [-]  Where a gap holds for so long, f would rarely hold for longer.
  static constexpr double kFar = 1.0 / 32.0;
  /// [-]  The width from which an unproven window is looked at from its middle.
  static constexpr double kWide = 1.0 / 8.0;
  /// Number of steps that are to gain more than the tolerance together.
  static constexpr int kPatience = 64;

  void step() {
    if (const double end = open_end(); end - t_ > kWide && ahead_count_ < ahead_.size()) {
      look_ahead(end);
      return;
    }
    const double t = t_;
    move_to(t);
    const double open = pair_.gaps().open_times().ahead;
    if (open >= kFar) {
      proceed_to(later(t, open));
      return;
    }
    const ValueAndRate f = pair_.coplanarity();
    const ValueAndRate g = f.value > 0.0 ? f : -f;
    const CurvatureBound& bounds = coplanarity_bounds();
    proceed_to(later(t, std::max(open, time_positive(g, bounds))));
    if (done_) {
      return;
    }
    // Seen from a root, its own side reaches back by 2 |f'| / K. The rate here estimates that at
    // the root.
    const double root = g.value > bounds.value_error ? t - g.value / g.rate : t;
    if (root >= t && (root - t_) * bounds.curvature <= std::abs(g.rate)) {
      follow_root(std::clamp(root, t_, t_end_));
    }
    if (!done_ && !(t_ > t)) {
      finish(ElementaryVerdict::degenerate, t_, t_);
    }
  }

  /// The end of the window that is not yet proven.
  [[nodiscard]] double open_end() const {
    return ahead_count_ > 0 ? ahead_[ahead_count_ - 1].begin : t_end_;
  }

  /// Proves as much as possible on both sides of the middle between t_ and `end`.
  ///
  /// A gap there gains twice as much time as one at t_, and the features are more likely near.
  void look_ahead(double end) {
    const double x = 0.5 * (t_ + end);
    move_to(x);
    const OpenTimes open = pair_.gaps().open_times();
    const double begin = above(x - open.since);
    const double beyond = later(x, open.ahead);
    if (begin <= t_) {
      proceed_to(beyond);
    } else if (beyond >= end && ahead_count_ > 0) {
      ahead_[ahead_count_ - 1].begin = begin;
    } else {
      ahead_[ahead_count_++] = {begin, beyond};
    }
  }

  /// Looks at x >= t_ for a root whose own side reaches back to t_.
  ///
  /// The search shrinks the root's bracket until the features provably meet, a gap holds beyond it,
  /// or rounding allows no more.
  void follow_root(double x) {
    const CurvatureBound& bounds = coplanarity_bounds();
    ValueAndRate g = falling(evaluate(x));
    IsolatedRoot root = isolate_root(g, bounds);
    if (!(root.exists && x - t_ <= root.reach)) {
      proceed_along_gap(x, x);
      return;
    }
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();
    double curvature = 0.0;  // An estimate of the curvature of g.
    bool meets = false;
    bool halved = false;
    while (true) {
      const double width = upper - lower;
      if (root.exists) {
        lower = std::max(lower, below(x - root.behind));
        upper = std::min(upper, above(x + root.ahead));
      }
      if (lower > t_end_) {
        proceed_to(t_end_);
        return;
      }
      t_ = std::max(t_, lower);
      meets = meets || pair_.meet_if_coplanar(above(std::max(x - lower, upper - x)));
      if (!meets && proceed_along_gap(x, upper)) {
        return;
      }
      const bool shrunk = upper - lower < 0.75 * width;
      if ((meets && upper - lower <= options_.time_tolerance) || (halved && !shrunk)) {
        finish(ElementaryVerdict::contact, t_, std::max(t_, std::min(upper, t_end_)));
        result_.existence_proven = meets && lower >= t_begin_ && upper <= t_end_;
        return;
      }
      if (!may_step()) {
        return;
      }
      const double guess = shrunk ? x + newton_step(g, curvature) : 0.5 * (lower + upper);
      const double next = std::max(t_, std::min({guess, upper, t_end_}));
      const ValueAndRate g_next = falling(evaluate(next));
      curvature = next != x ? (g_next.rate - g.rate) / (next - x) : 0.0;
      g = g_next;
      x = next;
      root = isolate_root(g, bounds);
      halved = !shrunk;
    }
  }

  /// Whether the gap at x holds from t_ until beyond `to`; then proceeds there.
  bool proceed_along_gap(double x, double to) {
    const OpenTimes open = pair_.gaps().open_times();
    const double beyond = std::max(x, later(x, open.ahead));
    if (!(beyond >= to && above(x - open.since) <= t_)) {
      return false;
    }
    proceed_to(beyond);
    return true;
  }

  /// t + duration, rounded down; the step ends before 2.
  static double later(double t, double duration) { return below(t + std::min(duration, 2.0)); }

  /// The step to the root of g + g' y + curvature y^2 / 2, to second order.
  static double newton_step(const ValueAndRate& g, double curvature) {
    const double y = -g.value / g.rate;
    return y - 0.5 * curvature * y * y / g.rate;
  }

  static ValueAndRate falling(const ValueAndRate& f) { return f.rate < 0.0 ? f : -f; }

  /// Whether many steps have gained no time, as along a touch within rounding.
  bool stalls() {
    if (steps_ < next_check_) {
      return false;
    }
    const bool gained = t_ - t_checked_ > options_.time_tolerance;
    t_checked_ = t_;
    next_check_ = steps_ + kPatience;
    return !gained;
  }

  [[nodiscard]] bool may_step() const { return steps_ < options_.maximum_steps; }

  void move_to(double t) {
    ++steps_;
    pair_.move_to(t);
  }

  /// The bounds of f; only near a root are they worth their cost.
  const CurvatureBound& coplanarity_bounds() {
    if (!coplanarity_bounds_) {
      coplanarity_bounds_ = pair_.coplanarity_bounds();
    }
    return *coplanarity_bounds_;
  }

  ValueAndRate evaluate(double t) {
    move_to(t);
    return pair_.coplanarity();
  }

  /// Proven: no contact up to `time`.
  void proceed_to(double time) {
    t_ = std::max(t_, time);
    while (ahead_count_ > 0 && t_ >= ahead_[ahead_count_ - 1].begin) {
      --ahead_count_;
      t_ = std::max(t_, ahead_[ahead_count_].end);
    }
    if (t_ >= t_end_) {
      finish(ElementaryVerdict::free, t_end_, t_end_);
    }
  }

  void finish(ElementaryVerdict verdict, double t_lower, double t_upper) {
    result_ = {verdict, t_lower, t_upper, false, steps_};
    done_ = true;
  }

  Pair& pair_;
  const ElementaryOptions& options_;
  double t_begin_;
  double t_end_;
  double t_;          ///< Proven: the features do not meet before.
  double t_checked_;  ///< The value of t_ when stalls() last looked.
  int next_check_ = kPatience;
  int steps_ = 0;
  std::optional<CurvatureBound> coplanarity_bounds_;
  std::array<Proven, 4> ahead_;  ///< The next one last. Each halves the open window: there are 3.
  std::size_t ahead_count_ = 0;
  bool done_ = false;
  ElementaryContact result_;
};

}  // namespace firstcontact::detail
