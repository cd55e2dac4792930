/// @file
/// Bytes as spacenavd sends them.

#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

namespace firstcontact::test {

inline std::string record(const std::array<std::int32_t, 8>& numbers) {
  std::string bytes(sizeof numbers, '\0');
  std::memcpy(bytes.data(), numbers.data(), sizeof numbers);
  return bytes;
}

inline std::string motion(const std::array<std::int32_t, 6>& axes) {
  return record({0, axes[0], axes[1], axes[2], axes[3], axes[4], axes[5], 16});
}

inline std::string button(std::int32_t number, bool pressed) {
  return record({pressed ? 1 : 2, number, 0, 0, 0, 0, 0, 0});
}

inline std::string device_event(bool removed) { return record({3, removed ? 1 : 0, 7}); }

/// Returns the answer to the request for a protocol.
inline std::string agreed_protocol() {
  const std::uint32_t word = 0x7faa5501;
  std::string bytes(sizeof word, '\0');
  std::memcpy(bytes.data(), &word, sizeof word);
  return bytes;
}

}  // namespace firstcontact::test
