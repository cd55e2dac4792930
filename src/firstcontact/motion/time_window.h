/// @file
/// Windows of time in the step.

#pragma once

namespace firstcontact {

/// A window of time, both ends included.
struct TimeWindow {
  double begin = 0.0;  ///< [-]
  double end = 1.0;    ///< [-]
};

}  // namespace firstcontact
