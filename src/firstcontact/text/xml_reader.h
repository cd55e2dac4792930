/// @file
/// Reads values of an XML tree, or reports the element with an unexpected value.

#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tinyxml2.h>
#include <Eigen/Core>

#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {

using XmlElement = tinyxml2::XMLElement;

/// The text of an element, without the comments inside of it. Valid as long as its reader.
class XmlText {
 public:
  XmlText(std::string_view text, std::size_t line) : whole_(text), line_(line) {}

  /// Appends a further piece.
  void append(std::string_view text);

  [[nodiscard]] std::string_view view() const { return joined_.empty() ? whole_ : joined_; }
  [[nodiscard]] std::size_t line() const { return line_; }  ///< Line on which it begins.

 private:
  std::string_view whole_;
  std::string joined_;
  std::size_t line_;
};

/// An element as messages show it: "<joint name='a'>".
[[nodiscard]] std::string shown(const XmlElement& element);

/// Reads a parsed document.
///
/// Every function throws ParseError, "path:line: <element>: what was expected", where something is
/// not of the kind that the function names. Numbers are read exactly, whatever the locale.
class XmlReader {
 public:
  /// @param source  names the text in errors
  XmlReader(std::string_view text, std::string source);

  /// The one outermost element, which must have this name.
  [[nodiscard]] const XmlElement& root(const char* name) const;

  [[nodiscard]] const std::string& source() const { return source_; }

  /// The error that fail() throws.
  [[nodiscard]] ParseError error(const XmlElement& where, const std::string& message) const;

  [[noreturn]] void fail(const XmlElement& where, const std::string& message) const;
  [[noreturn]] void fail_at_line(std::size_t line, const std::string& message) const;

  /// All children of this name, in order.
  [[nodiscard]] std::vector<const XmlElement*> children(const XmlElement& element,
                                                        const char* name) const;
  /// The only child of this name, or null.
  ///
  /// Repeats with equal attributes and without children of their own count once.
  [[nodiscard]] const XmlElement* child(const XmlElement& element, const char* name) const;
  /// The only child of this name, which must exist.
  [[nodiscard]] const XmlElement& required_child(const XmlElement& element, const char* name) const;

  /// Reads an attribute that must exist and not be empty.
  [[nodiscard]] std::string text(const XmlElement& element, const char* attribute) const;

  /// Reads a finite number of at most 1e60 in size.
  [[nodiscard]] double number(const XmlElement& element, const char* attribute) const;
  [[nodiscard]] std::optional<double> optional_number(const XmlElement& element,
                                                      const char* attribute) const;
  [[nodiscard]] double positive(const XmlElement& element, const char* attribute) const;
  [[nodiscard]] Eigen::Vector3d vector3(const XmlElement& element, const char* attribute) const;

  [[nodiscard]] std::vector<double> numbers(const XmlElement& element, const char* attribute) const;

  /// The text of an element that has no elements inside.
  [[nodiscard]] XmlText content(const XmlElement& element) const;

  /// Reads a whole number >= 0; `missing` where the attribute does not exist.
  [[nodiscard]] std::uint64_t whole_number(const XmlElement& element, const char* attribute,
                                           std::optional<std::uint64_t> missing = {}) const;

 private:
  std::string source_;
  tinyxml2::XMLDocument document_;
};

}  // namespace firstcontact::detail
