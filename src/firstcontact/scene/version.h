/// @file
/// The version of the library.

#pragma once

#include <firstcontact/math/export.h>

namespace firstcontact {

/// The version of the library: "major.minor.patch".
[[nodiscard]] FIRSTCONTACT_API const char* version();

}  // namespace firstcontact
