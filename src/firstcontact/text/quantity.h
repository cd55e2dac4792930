/// @file
/// Numbers with units as warnings and errors have them.

#pragma once

#include <string>

#include <firstcontact/math/number_text.h>

namespace firstcontact::detail {

/// "1.5 s": as many digits as a person reads.
inline std::string quantity(double value, const char* unit) {
  return rounded(value, 6) + " " + unit;
}

}  // namespace firstcontact::detail
