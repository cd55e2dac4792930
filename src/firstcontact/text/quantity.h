/// @file
/// Numbers with units, for warnings and errors.

#pragma once

#include <string>

#include <firstcontact/math/number_text.h>

namespace firstcontact::detail {

/// A number with its unit: "1.5 s", with as many digits as a person reads.
inline std::string quantity(double value, const char* unit) {
  return rounded(value, 6) + " " + unit;
}

}  // namespace firstcontact::detail
