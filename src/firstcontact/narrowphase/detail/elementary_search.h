/// @file
/// The search that the elementary tests share: advance along a coplanarity function and along
/// separating directions, whichever reaches farther, until the first root is isolated.

#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <firstcontact/math/interval.h>
#include <firstcontact/narrowphase/advance.h>
#include <firstcontact/narrowphase/elementary_contact.h>

namespace firstcontact::detail {

/// A coplanarity function f at one time, with what is known about it there.
struct CoplanarityValue {
  double value = 0.0;
  double rate = 0.0;         ///< f'
  double value_error = 0.0;  ///< Bounds of |computed - exact|.
  double rate_error = 0.0;
  double curvature = 0.0;  ///< Bound of |f''| up to the end of the piece.
};

/// What a parabola on either side says about the first root of g = side f after t.
struct RootBracket {
  double lower = 0.0;  ///< g > 0 on [t, t + lower].
  double upper = 0.0;  ///< Where `closes`: g' < 0 on [t, t + upper] and g(t + upper) <= 0.
  bool closes = false;
};

/// g(t + x) lies between g +- (c x +- K x^2 / 2), c = -g'. The upper parabola reaches 0 at
/// x = 2 g / (c + sqrt(c^2 - 2 K g)) <= c / K, so that g' < 0 until there.
inline RootBracket root_bracket(const CoplanarityValue& f, int side) {
  const double g = side * f.value;
  const double closing = -side * f.rate;
  RootBracket bracket;
  bracket.lower = time_to_close(g - f.value_error, closing + f.rate_error, 0.5 * f.curvature);
  const double c = (closing - f.rate_error) * (1.0 - 0x1p-50);
  const double g_upper = std::max(g + f.value_error, 0.0) * (1.0 + 0x1p-50);
  const double discriminant = c * c * (1.0 - 0x1p-48) - 2.0 * f.curvature * g_upper;
  if (c > 0.0 && discriminant > 0.0) {
    bracket.closes = true;
    bracket.upper = 2.0 * g_upper / (c + std::sqrt(discriminant)) * (1.0 + 0x1p-44);
  }
  return bracket;
}

/// A gap along a direction: its value now less its error, the speed at which it closes, and half
/// the bound of its acceleration.
struct Gap {
  double clear;
  double speed;
  double half_acceleration;

  /// Whether the gap provably stays open for `time`; a parabola that opens downwards is least at an
  /// end.
  [[nodiscard]] bool open_for(double time) const {
    const double fall = speed * time + half_acceleration * time * time;
    return clear > 0.0 &&
           clear - fall > 0x1p-50 * (clear + std::abs(speed) * time + std::abs(fall));
  }
  [[nodiscard]] double time_open() const { return time_to_close(clear, speed, half_acceleration); }
};

/// Finds where the features of `pair` first meet.
///
/// Pair offers: move_to(t), places the features; coplanarity(), f there; separated_for(), for how
/// long some direction provably keeps them apart; meet_if_coplanar(duration), whether coplanar
/// features provably meet at any time from t to t + duration.
///
/// Invariants: the features do not meet in [t_begin, t); side f(t) >= 0, exactly, where side != 0.
template <class Pair>
ElementaryContact search_contact(Pair& pair, const ElementaryMotion& motion,
                                 const ElementaryOptions& options) {
  double t = std::max(options.t_begin, motion.t_begin());
  const double t_end = std::min(options.t_end, motion.t_end());
  int side = 0;
  double t_upper = t_end;
  bool meets = false;  // Proven: the root that the bracket isolates is a contact.
  ElementaryContact result;
  while (result.steps < options.maximum_steps && t <= t_end) {
    ++result.steps;
    pair.move_to(t);
    const CoplanarityValue f = pair.coplanarity();
    const bool known = side != 0 || std::abs(f.value) > f.value_error;
    if (side == 0) {
      // Within rounding of 0 the root is taken as ahead, whichever way f goes.
      side = (known ? f.value > 0.0 : f.rate < 0.0) ? 1 : -1;
    }
    const RootBracket bracket = root_bracket(f, side);
    const bool isolated = known && bracket.closes && above(t + bracket.upper) <= t_end;
    if (!meets && isolated) {
      meets = pair.meet_if_coplanar(bracket.upper);
    }
    if (bracket.closes) {
      t_upper = meets ? std::min(t_upper, above(t + bracket.upper)) : above(t + bracket.upper);
    }
    const double apart = meets ? 0.0 : pair.separated_for();
    const double next = below(t + std::max(bracket.lower, apart));
    if (meets) {
      const double t_lower = std::max(t, next);
      if (t_upper - t_lower <= options.time_tolerance || !(next > t)) {
        return {ElementaryVerdict::contact, t_lower, t_upper, true, result.steps};
      }
    } else if (next >= t_end) {
      return {ElementaryVerdict::free, t_end, t_end, false, result.steps};
    } else if (!(next > t)) {
      // Touching up to rounding. At most one root follows before t_upper, or the window ends.
      result.t_lower = result.t_upper = t;
      if (bracket.closes) {
        result.verdict = ElementaryVerdict::contact;
        result.t_upper = std::min(t_upper, t_end);
      }
      return result;
    }
    if (!(bracket.lower >= apart)) {
      side = 0;
    }
    t = next;
  }
  result.t_lower = result.t_upper = std::min(t, t_end);
  return result;
}

}  // namespace firstcontact::detail
