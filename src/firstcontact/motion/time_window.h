/// @file
/// A part of the step.

#pragma once

namespace firstcontact {

/// Both ends included.
struct TimeWindow {
  double begin = 0.0;  ///< [-]
  double end = 1.0;    ///< [-]
};

}  // namespace firstcontact
