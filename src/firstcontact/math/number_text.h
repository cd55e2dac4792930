/// @file
/// Numbers as text, in any locale the same: for files, errors and warnings.

#pragma once

#include <array>
#include <charconv>
#include <string>

namespace firstcontact::detail {

/// Writes a number with the fewest digits that give it back: "0.25", "-1e-07", "nan".
inline std::string shortest(double number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

/// Writes a number with at most `digits` digits, for a person to read: "0.00123".
inline std::string rounded(double number, int digits) {
  std::array<char, 32> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), number,
                                     std::chars_format::general, digits);
  return {text.data(), written.ptr};
}

}  // namespace firstcontact::detail
