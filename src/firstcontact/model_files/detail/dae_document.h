/// @file
/// A COLLADA document: its elements by id, and the rules for all other elements.

#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include <firstcontact/text/reading_log.h>
#include <firstcontact/text/xml_reader.h>

namespace firstcontact::detail {

/// Children of one name that make no contact, and the reason.
struct DaePassedOver {
  std::string_view name;
  std::string_view reason;
};

/// A COLLADA document.
///
/// Source: M. Barnes, E. Levy Finch (eds.), "COLLADA – Digital Asset Schema Release 1.4.1" and
/// "1.5.0", Khronos Group 2008.
class DaeDocument {
 public:
  /// Parses a document.
  ///
  /// @throws ParseError  no XML, or no <COLLADA>
  DaeDocument(std::string_view bytes, ReadingLog& log);

  [[nodiscard]] const XmlReader& xml() const { return xml_; }
  [[nodiscard]] ReadingLog& log() const { return log_; }
  [[nodiscard]] const XmlElement& root() const { return root_; }

  /// Finds the element that a reference "#id" names.
  ///
  /// @param attribute  of `where`, holds the reference
  /// @param kind       the element's name; "array" for each kind of array
  /// @throws ParseError  it is in another document, not there, or there twice
  [[nodiscard]] const XmlElement& find(const XmlElement& where, const char* attribute,
                                       std::string_view kind) const;

  /// Finds an element as find(); among several elements with this id, the child of `scope`.
  [[nodiscard]] const XmlElement& find_in(const XmlElement& scope, const XmlElement& where,
                                          const char* attribute, std::string_view kind) const;

  /// Whether a reference "#id" names this element.
  [[nodiscard]] bool names(const XmlElement& where, const char* attribute,
                           const XmlElement& element) const;

  /// Finds the element of this kind and id; null where there is none, or several.
  [[nodiscard]] const XmlElement* find_id(std::string_view id, std::string_view kind) const;

  [[noreturn]] void fail(const XmlElement& where, const std::string& message) const {
    xml_.fail(where, message);
  }

  /// Refuses an element that could hold or place geometry; see ReadingLog::refuse().
  ///
  /// @param cause  the common cause of such errors; the message where it is empty
  void refuse(const XmlElement& where, const std::string& message,
              std::string_view cause = {}) const;

  /// Checks the children that the caller does not take. Notes those that are passed over, and
  /// <extra> and <technique>; refuses others. An <asset> must not change the unit or the axes.
  void check_children(const XmlElement& element, std::initializer_list<std::string_view> taken,
                      std::initializer_list<DaePassedOver> passed_over = {}) const;

  /// Refuses attributes of other names than these.
  void check_attributes(const XmlElement& element,
                        std::initializer_list<std::string_view> known) const;

  /// The length of the document's unit [m].
  [[nodiscard]] double unit() const { return unit_; }

 private:
  struct Named {
    const XmlElement* element = nullptr;
    bool repeated = false;
  };

  void read_version() const;
  void index();
  void read_asset();
  void check_asset(const XmlElement& asset) const;
  void leave_out_profile(const XmlElement& element) const;
  [[nodiscard]] const Named* named(std::string_view id, std::string_view kind) const;
  [[nodiscard]] std::string_view reference(const XmlElement& where, const char* attribute) const;
  void warn_of_unit_without_size(const XmlElement& asset) const;
  [[nodiscard]] double unit_of(const XmlElement& asset) const;

  ReadingLog& log_;
  XmlReader xml_;
  const XmlElement& root_;
  std::unordered_map<std::string, Named> by_id_;  ///< "kind#id"
  mutable std::unordered_set<std::string> profiles_;
  double unit_ = 1.0;
  std::string up_axis_ = "Y_UP";
};

}  // namespace firstcontact::detail
