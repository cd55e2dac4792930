/// @file
/// Base64, by which numbers travel in text.

#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <firstcontact/math/export.h>

namespace firstcontact::detail {

/// The bytes as base64 with padding (RFC 4648, section 4).
[[nodiscard]] FIRSTCONTACT_API std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace firstcontact::detail
