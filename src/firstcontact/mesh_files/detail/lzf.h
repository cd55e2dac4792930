/// @file
/// Expands LZF-compressed data of PCD files.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace firstcontact::detail {

/// Expands to exactly `size` bytes; none where the data is not LZF of that size.
///
/// The format: a control byte c < 32 is followed by c + 1 literal bytes. Any other copies (c >> 5)
/// + 2 earlier bytes; where c >> 5 is 7, it copies 9 and the next byte's value. The copy begins ((c
/// & 31) << 8 | next byte) + 1 bytes before.
std::optional<std::string> expand_lzf(std::string_view data, std::size_t size);

}  // namespace firstcontact::detail
