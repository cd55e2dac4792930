/// @file
/// How far a simulation keeps bodies apart.

#pragma once

#include <firstcontact/simulation_model/detail/constants.h>

namespace firstcontact::detail {

/// Distances that keep bodies apart, beyond what the scene's margins ask of a pair.
///
/// A pair may not come closer than `least`: first_contact is asked with that margin. Bodies rest
/// between it and `touching`. A pair that is nearer already, as turning may bring it, is held to
/// half of what it has left, and pushed back.
struct ContactDistances {
  explicit ContactDistances(double contact_distance)
      : least(contact_distance),
        tolerance(kToleranceOfDistance * contact_distance),
        touching(kTouchingOfDistance * contact_distance),
        band(kBandOfDistance * contact_distance),
        pushed(kPushedOfDistance * contact_distance),
        near(band) {}

  /// [m]  How much nearer a touch may come before its pair rests.
  ///
  /// A pair that touches rests on its nearest touch, and all others may come as near: what rolls
  /// and what leans does not stand on features ahead. Another rests a little before a contact would
  /// be found, for the way there is straight and that of a point is not.
  ///
  /// @param gap     [m]  of the touch
  /// @param lowest  [m]  the least gap of the pair's touches
  [[nodiscard]] double way_to_rest(double gap, double lowest) const {
    const double resting = lowest <= touching ? lowest : at_rest();
    const double way = gap - resting;
    return way > kSameGap * least ? way : 0.0;
  }

  /// [m]  Where pairs come to rest.
  [[nodiscard]] double at_rest() const { return least + kRestOfTolerance * tolerance; }

  double least;      ///< [m]
  double tolerance;  ///< [m]  A contact is found at least .. least + tolerance.
  double touching;   ///< [m]  Impacts act on pairs within it.
  double band;       ///< [m]  Constraints act on pairs within it.
  double pushed;     ///< [m]  Pairs below it are pushed apart.
  double near;       ///< [m]  Beyond it not even circles of any pair are within the band.
};

/// How a pair is asked for first contact, which was this far apart at the start.
///
/// @param gap  [m]  least, infinite where it is beyond the band
struct HeldDistance {
  double margin = 0.0;     ///< [m]  Of the question.
  double tolerance = 0.0;  ///< [m]
};
[[nodiscard]] HeldDistance held_distance(const ContactDistances& distances, double pair_margin,
                                         double gap);

}  // namespace firstcontact::detail
