/// @file
/// SHA-1, for the handshake of WebSockets. It protects nothing.

#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace firstcontact::detail {

/// Computes the digest of a short text.
///
/// Source: NIST FIPS 180-4, "Secure Hash Standard", 2015, sections 5 and 6.1.
[[nodiscard]] std::array<std::uint8_t, 20> sha1(std::string_view bytes);

}  // namespace firstcontact::detail
