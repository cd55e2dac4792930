/// @file
/// The text of an XML file as UTF-8.

#pragma once

#include <string>
#include <string_view>

namespace firstcontact::detail {

/// Converts a text whose declaration states ISO-8859-1 to UTF-8; a text in UTF-8 stays.
///
/// Bytes of comments that are not UTF-8 become question marks, as nothing depends on them.
///
/// @param source  names the file in errors
/// @throws ParseError  at the line of other bytes that are not UTF-8
[[nodiscard]] std::string utf8_of_xml(std::string_view text, const std::string& source);

}  // namespace firstcontact::detail
