/// @file
/// Text for people: no contents of a file may control their terminal.

#pragma once

#include <string>
#include <string_view>

namespace firstcontact::app {

/// The text with control characters as escapes, such as "\n" and "\x1b", and so on one line.
///
/// Bytes that are not UTF-8 become escapes, too. So do characters that separate lines, and those
/// that turn the direction of writing.
[[nodiscard]] std::string visible(std::string_view text);

/// Makes every line of a text visible(); line feeds stay.
[[nodiscard]] std::string visible_lines(std::string_view text);

/// A line of an answer for people: "  label      value", and a line feed.
[[nodiscard]] std::string answer_line(std::string_view label, std::string_view value);

/// Writes text for people to standard output, by visible_lines().
void say(std::string_view text);

}  // namespace firstcontact::app
