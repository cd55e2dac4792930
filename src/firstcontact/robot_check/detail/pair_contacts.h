/// @file
/// The contacts of two members at one time, from all of their geometries.

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <firstcontact/query/contact_selection.h>
#include <firstcontact/robot_check/check_robots.h>

namespace firstcontact::detail {

/// Keeps all contacts, or at most so many that ContactSelection chooses.
class PairContacts {
 public:
  explicit PairContacts(std::size_t most) : most_(most) {}

  void clear();
  void add(std::span<const Contact> contacts);

  /// Returns all kept contacts. Nothing may be added afterwards.
  [[nodiscard]] std::vector<Contact> take();

 private:
  std::size_t most_;
  std::vector<Contact> all_;
  std::optional<ContactSelection<Contact>> selection_;  // Only where there are more than are kept.
};

}  // namespace firstcontact::detail
