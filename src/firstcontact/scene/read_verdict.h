/// @file
/// Reads back what a result says.

#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact {

/// The verdict of a result; none where it is an error that stands in place of one.
///
/// @param result  one JSON object, as write_result and write_error write it
/// @param source  the file that it is from, named in errors
/// @param line    of that file
/// @throws ParseError if it is neither
[[nodiscard]] FIRSTCONTACT_API std::optional<Verdict> read_verdict(
    std::string_view result, const std::filesystem::path& source, std::size_t line = 1);

}  // namespace firstcontact
