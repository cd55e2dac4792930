/// @file
/// Writing to a file descriptor.

#pragma once

#include <string_view>

namespace firstcontact::app {

/// Writes all of a text, in as many calls as it takes. Where that fails, errno has the reason.
[[nodiscard]] bool write_all(int descriptor, std::string_view text);

}  // namespace firstcontact::app
