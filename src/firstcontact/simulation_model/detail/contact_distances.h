/// @file
/// The distances at which a simulation keeps bodies apart.

#pragma once

#include <firstcontact/simulation_model/detail/constants.h>

namespace firstcontact::detail {

/// Distances that keep bodies apart, in addition to the scene's margins of a pair.
///
/// A pair may not come closer than `least`, which is the margin of its first_contact(). Bodies rest
/// between it and `touching`. A pair that is nearer already, as a turn may bring it, is held to
/// half of its gap, and pushed back.
struct ContactDistances {
  explicit ContactDistances(double contact_distance)
      : least(contact_distance),
        tolerance(kToleranceOfDistance * contact_distance),
        touching(kTouchingOfDistance * contact_distance),
        band(kBandOfDistance * contact_distance),
        pushed(kPushedOfDistance * contact_distance),
        near(band) {}

  /// [m]  The distance by which a manifold point may come nearer before its pair rests.
  ///
  /// A touching pair rests on its nearest point, and all others may come as near: a body that rolls
  /// or leans does not stand on features ahead. A pair that does not touch rests a little before a
  /// contact would be found, as the planned way is straight and that of a point is not.
  ///
  /// @param gap     [m]  gap of the manifold point
  /// @param lowest  [m]  the least gap of the pair's points
  [[nodiscard]] double way_to_rest(double gap, double lowest) const {
    const double resting = lowest <= touching ? lowest : at_rest();
    const double way = gap - resting;
    return way > kSameGap * least ? way : 0.0;
  }

  /// [m]  The distance at which pairs come to rest.
  [[nodiscard]] double at_rest() const { return least + kRestOfTolerance * tolerance; }

  double least;      ///< [m]
  double tolerance;  ///< [m]  A contact is found between least and least + tolerance.
  double touching;   ///< [m]  Impacts act on pairs within it.
  double band;       ///< [m]  Constraints act on pairs within it.
  double pushed;     ///< [m]  Pairs below it are pushed apart.
  double near;       ///< [m]  Beyond it not even circles of any pair are within the band.
};

/// The margin and tolerance of a first contact for a pair with this gap at the start.
///
/// @param gap  [m]  the least gap, infinite where it is beyond the band
struct HeldDistance {
  double margin = 0.0;     ///< [m]  Margin of the first contact.
  double tolerance = 0.0;  ///< [m]
};
[[nodiscard]] HeldDistance held_distance(const ContactDistances& distances, double pair_margin,
                                         double gap);

}  // namespace firstcontact::detail
