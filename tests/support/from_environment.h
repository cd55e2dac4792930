/// @file
/// Environment variables that make a test a longer campaign.

#pragma once

#include <cstdint>
#include <cstdlib>

namespace firstcontact::test {

/// Returns the whole number in an environment variable, or `otherwise` where it is not set.
inline std::uint64_t from_environment(const char* variable, std::uint64_t otherwise) {
  const char* value = std::getenv(variable);
  return value == nullptr ? otherwise : std::strtoull(value, nullptr, 10);
}

}  // namespace firstcontact::test
