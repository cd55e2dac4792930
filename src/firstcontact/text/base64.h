/// @file
/// Base64, the form of numbers in text.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <firstcontact/math/export.h>

namespace firstcontact::detail {

/// The bytes as base64 with padding (RFC 4648, section 4).
[[nodiscard]] FIRSTCONTACT_API std::string base64(std::span<const std::uint8_t> bytes);

/// The bytes of base64 text, whose padding may be missing.
///
/// The result is empty where another character stands in the text, or where no bytes have its
/// length.
[[nodiscard]] FIRSTCONTACT_API std::optional<std::string> from_base64(std::string_view text);

}  // namespace firstcontact::detail
