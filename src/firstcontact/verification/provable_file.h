/// @file
/// What kind of file a second proof is asked of.

#pragma once

#include <string_view>

#include <firstcontact/math/export.h>

namespace firstcontact {

enum class ProvableFile {
  unknown,  ///< No JSON, or none of these.
  run,      ///< Its header.
  result,   ///< Or an error in place of one.
  path,
};

/// The kind of a file by its text: all of it, or its first line where each line is one object.
[[nodiscard]] FIRSTCONTACT_API ProvableFile provable_file(std::string_view text);

/// Guesses what a text was to be that is no JSON any more, by its first key; `unknown` where that
/// tells nothing. The reader of the kind then tells what is wrong.
[[nodiscard]] FIRSTCONTACT_API ProvableFile damaged_file(std::string_view text);

}  // namespace firstcontact
