/// @file
/// Which version of the library this is.

#pragma once

#include <firstcontact/math/export.h>

namespace firstcontact {

/// "major.minor.patch"
[[nodiscard]] FIRSTCONTACT_API const char* version();

}  // namespace firstcontact
