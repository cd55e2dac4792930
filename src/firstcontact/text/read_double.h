/// @file
/// Reads a double out of text; numbers too small for one are zeros.

#pragma once

#include <charconv>
#include <string_view>
#include <system_error>

#include <firstcontact/math/export.h>

namespace firstcontact::detail {

/// Whether a decimal number that fits no double is too small for one, and not too large.
[[nodiscard]] FIRSTCONTACT_API bool is_too_small(std::string_view number);

/// Reads as std::from_chars() does, but a number that rounds to zero is one, with its sign, and no
/// error.
inline std::from_chars_result read_double(const char* begin, const char* end, double& value) {
  std::from_chars_result result = std::from_chars(begin, end, value);
  if (result.ec == std::errc::result_out_of_range && is_too_small({begin, result.ptr})) {
    value = *begin == '-' ? -0.0 : 0.0;
    result.ec = {};
  }
  return result;
}

}  // namespace firstcontact::detail
