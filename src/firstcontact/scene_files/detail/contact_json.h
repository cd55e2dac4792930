/// @file
/// Contacts as JSON, written as text at once.
///
/// There may be very many, and values of a tree take ten times the memory.

#pragma once

#include <string>

#include <firstcontact/query/contact.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// Writes contacts of several pairs into one array.
class ContactArray {
 public:
  /// @param duration    [s]  of the step; velocities are written in m/s
  /// @param geometries  also writes which geometries of the members touch
  ContactArray(double duration, bool geometries) : duration_(duration), geometries_(geometries) {}

  /// Sets the names of the pair whose contacts are added next.
  ///
  /// @param names  a JSON array of two strings
  void set_names(const JsonValue& names);

  void add(const Contact& contact);

  /// Returns the array. Nothing may be added afterwards.
  [[nodiscard]] JsonValue take();

 private:
  double duration_;
  bool geometries_;
  std::string names_;
  std::string text_;
};

/// Adds the number of contacts, those included that are not listed.
void append_contact_count(const ContactCount& count, JsonObject& object);

}  // namespace firstcontact::detail
