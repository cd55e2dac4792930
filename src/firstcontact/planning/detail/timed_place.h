/// @file
/// A node of trees in space and time.

#pragma once

#include <firstcontact/edges/configuration_space.h>

namespace firstcontact::detail {

/// A configuration at a time.
struct TimedPlace {
  Configuration q;
  double t = 0.0;  ///< [s]

  friend bool operator==(const TimedPlace&, const TimedPlace&) = default;
};

}  // namespace firstcontact::detail
