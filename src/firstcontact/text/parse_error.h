/// @file
/// The error that every reader throws when a file is not what it should be.

#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include <firstcontact/math/export.h>

namespace firstcontact {

/// The error that a file cannot be read, with its place and what was expected there.
///
/// Its text, what(), is one line: "path:line: message", "path: byte N: message" or "path: message".
class FIRSTCONTACT_API ParseError : public std::runtime_error {
 public:
  /// Makes the error that the file as a whole is wrong.
  ParseError(const std::string& path, const std::string& message);

  /// Makes the error that a line of a text file is wrong; the first line is 1.
  ParseError(const std::string& path, std::size_t line, const std::string& message);

  /// Makes the error that a byte of a binary file is wrong; the first byte is 0.
  [[nodiscard]] static ParseError at_byte(const std::string& path, std::size_t offset,
                                          const std::string& message);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] std::optional<std::size_t> line() const { return line_; }
  /// [byte]  Place in a binary file.
  [[nodiscard]] std::optional<std::size_t> offset() const { return offset_; }

 private:
  ParseError(const std::string& path, const std::string& place, const std::string& message);

  std::string path_;
  std::string message_;
  std::optional<std::size_t> line_;
  std::optional<std::size_t> offset_;
};

}  // namespace firstcontact
