/// @file
/// Finds in a file what makes the assimp library crash, hang or read past the end.

#pragma once

#include <string>
#include <string_view>

namespace firstcontact::detail {

/// The chunks of a GLB lie within the length that its header states, and that within the file.
///
/// @throws ParseError
void check_glb_chunks(const std::string& path, std::string_view bytes);

/// The lists of numbers of a COLLADA file hold numbers, and at least one, those of indices whole
/// ones that are not negative; accessors stay within the array before them.
///
/// @throws ParseError
void check_dae_numbers(const std::string& path, std::string_view text);

}  // namespace firstcontact::detail
