/// @file
/// The rules of an XML reader for names: known, left out, warned of, or refused.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/text/reading_log.h>
#include <firstcontact/text/xml_reader.h>

namespace firstcontact::detail {

/// A name that a reader leaves out, and the reason why it may.
struct HarmlessName {
  std::string_view name;
  std::string_view reason;
};

/// Names of elements, or of attributes, that may stand inside of an element.
struct XmlNames {
  std::vector<std::string_view> read;
  std::vector<HarmlessName> harmless = {};
  bool is_strict = false;  ///< Whether all other names are refused, as any could change the
                           ///< contents.
};

/// The names that an element may hold.
struct XmlContents {
  XmlNames attributes;
  XmlNames children;
};

/// The names of a format that hold, place or move geometry, wherever they stand.
struct TellingNames {
  std::vector<std::string_view> anywhere;    ///< Also where they are empty: "mesh".
  std::vector<std::string_view> with_parts;  ///< Where they have children: "link".
  std::vector<std::string_view> in_place;    ///< Directly inside of a known element: "origin".
};

/// Checks the names inside of elements.
///
/// In order: a name that is read or harmless is known. A name that xacro would replace is refused,
/// and so is one like a known name. A name with a prefix belongs to another program, and is left
/// out unless it is one of geometry. A name of geometry is refused, and so is an element that holds
/// such names. Other names get a warning.
class XmlNameCheck {
 public:
  /// Makes the check. All three arguments outlive it.
  XmlNameCheck(const XmlReader& xml, ReadingLog& log, const TellingNames& telling)
      : xml_(xml), log_(log), telling_(telling) {}

  void check(const XmlElement& element, const XmlContents& known) const;

 private:
  void check_attributes(const XmlElement& element, const XmlNames& known) const;
  void check_children(const XmlElement& element, const XmlNames& known) const;
  void check_stranger(const XmlElement& stranger, const XmlElement& parent,
                      const XmlNames& known) const;
  void check_text(const XmlElement& element) const;
  [[nodiscard]] bool tells(const XmlElement& stranger) const;
  [[nodiscard]] const XmlElement* telling_part(const XmlElement& element) const;

  const XmlReader& xml_;
  ReadingLog& log_;
  const TellingNames& telling_;
};

/// The known name nearest to a misspelt one; empty if there is none, or a harmless name is nearer.
[[nodiscard]] std::string_view misspelt_name(std::string_view name, const XmlNames& known);

}  // namespace firstcontact::detail
