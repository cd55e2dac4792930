/// @file
/// The rules of an XML reader for names: it takes them, leaves them out, warns of them, or refuses
/// them.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/text/reading_log.h>
#include <firstcontact/text/xml_reader.h>

namespace firstcontact::detail {

/// A name that a reader leaves out, and why it may.
struct HarmlessName {
  std::string_view name;
  std::string_view reason;
};

/// Names of elements, or of attributes, that may stand inside of an element.
struct XmlNames {
  std::vector<std::string_view> read;
  std::vector<HarmlessName> harmless = {};
  bool is_strict = false;  ///< All other names are refused: any could change what is read.
};

/// The names that an element may hold.
struct XmlContents {
  XmlNames attributes;
  XmlNames children;
};

/// The names of a format that hold, place or move geometry, wherever they stand.
struct TellingNames {
  std::vector<std::string_view> anywhere;    ///< Even empty: "mesh".
  std::vector<std::string_view> with_parts;  ///< Where they have children: "link".
  std::vector<std::string_view> in_place;    ///< Right inside of what is read: "origin".
};

/// The check of the names inside of elements.
///
/// In order: a name that is read or harmless is known. A name that xacro would replace is refused,
/// and so is one like a name that is read. A name with a prefix belongs to another program, and is
/// left out unless it is one of geometry. A name of geometry is refused, and so is an element that
/// holds such things; the rest gets a warning.
class XmlNameCheck {
 public:
  /// All three outlive the check.
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

/// The known name that a misspelt one is near, or empty: none, or it is nearer to a harmless one.
[[nodiscard]] std::string_view misspelt_name(std::string_view name, const XmlNames& known);

}  // namespace firstcontact::detail
