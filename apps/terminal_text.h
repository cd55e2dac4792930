/// @file
/// Text for people: nothing that a file says may steer their terminal.

#pragma once

#include <string>
#include <string_view>

namespace firstcontact::app {

/// The text with control characters written out, such as "\n" and "\x1b", and so on one line. So
/// are bytes that are not UTF-8, characters that separate lines, and those that turn the direction
/// of writing.
[[nodiscard]] std::string visible(std::string_view text);

/// The same of every line of a text: line feeds stay.
[[nodiscard]] std::string visible_lines(std::string_view text);

/// A line of an answer for people: "  label      value", and a line feed.
[[nodiscard]] std::string answer_line(std::string_view label, std::string_view value);

/// Writes text for people to standard output, visible_lines() of it.
void say(std::string_view text);

}  // namespace firstcontact::app
