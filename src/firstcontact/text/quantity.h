/// @file
/// Numbers with units as warnings and errors have them.

#pragma once

#include <array>
#include <charconv>
#include <string>

namespace firstcontact::detail {

/// "1.5 s": as many digits as a person reads, whatever the locale.
inline std::string quantity(double value, const char* unit) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6)
          .ptr;
  return std::string(text.data(), end) + " " + unit;
}

}  // namespace firstcontact::detail
