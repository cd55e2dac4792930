/// @file
/// A span of the time of a scene.

#pragma once

namespace firstcontact::detail {

struct TimeSpan {
  double from = 0.0;  ///< [-]  Normalised to the duration.
  double to = 1.0;
};

}  // namespace firstcontact::detail
