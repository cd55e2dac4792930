/// @file
/// URIs, with which robots and models name files and data.

#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace firstcontact::detail {

/// The text with each %XX replaced by its byte (RFC 3986, section 2.1).
///
/// It is empty where two hexadecimal digits are missing after a '%'.
[[nodiscard]] std::optional<std::string> decode_percent(std::string_view text);

/// Whether a URI begins with a scheme such as "http:" (RFC 3986, section 3.1).
[[nodiscard]] bool has_scheme(std::string_view uri);

/// Whether a URI holds its data ("data:...", RFC 2397).
[[nodiscard]] bool is_data_uri(std::string_view uri);

/// The bytes of a data URI, with base64 or without; empty where its encoding is broken.
[[nodiscard]] std::optional<std::string> decode_data_uri(std::string_view uri);

}  // namespace firstcontact::detail
