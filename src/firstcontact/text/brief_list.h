/// @file
/// Long lists of names, cut short for a line.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace firstcontact::detail {

/// Lists some names: "a, b and 7 more".
[[nodiscard]] inline std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 9;
  std::string text;
  for (std::size_t k = 0; k < names.size() && k < kMost; ++k) {
    text += (k == 0 ? "" : ", ") + names[k];
  }
  return names.size() > kMost ? text + " and " + std::to_string(names.size() - kMost) + " more"
                              : text;
}

}  // namespace firstcontact::detail
