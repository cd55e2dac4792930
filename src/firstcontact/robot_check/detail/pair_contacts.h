/// @file
/// The contacts of two members at one time, which may be those of several of their geometries.

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <firstcontact/query/contact_selection.h>
#include <firstcontact/robot_check/check_robots.h>

namespace firstcontact::detail {

/// Keeps all, or at most so many that ContactSelection chooses.
class PairContacts {
 public:
  explicit PairContacts(std::size_t most) : most_(most) {}

  void clear();
  void add(std::span<const Contact> contacts);

  /// All that is kept. Nothing may be added afterwards.
  [[nodiscard]] std::vector<Contact> take();

 private:
  std::size_t most_;
  std::vector<Contact> all_;
  std::optional<ContactSelection<Contact>> selection_;  // Where there are more.
};

}  // namespace firstcontact::detail
