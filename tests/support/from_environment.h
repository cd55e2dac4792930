/// @file
/// Numbers by which a test becomes a longer campaign.

#pragma once

#include <cstdint>
#include <cstdlib>

namespace firstcontact::test {

/// The whole number that an environment variable holds, or another where it is not set.
inline std::uint64_t from_environment(const char* variable, std::uint64_t otherwise) {
  const char* value = std::getenv(variable);
  return value == nullptr ? otherwise : std::strtoull(value, nullptr, 10);
}

}  // namespace firstcontact::test
