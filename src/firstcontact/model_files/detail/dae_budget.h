/// @file
/// A bound of the work that a COLLADA document may cause.

#pragma once

#include <cstddef>
#include <cstdint>

#include <firstcontact/model_files/detail/dae_document.h>

namespace firstcontact::detail {

/// Bounds the work of a small file: nodes that instance nodes double with every level.
class DaeBudget {
 public:
  /// Makes a budget.
  ///
  /// @param bytes  the size of the file; nothing that the file states itself is refused
  explicit DaeBudget(std::size_t bytes);

  /// Spends the work of `work` nodes, corners, vertices or influences.
  ///
  /// @param where  for the error
  /// @throws ParseError  the document unfolds to more than it may
  void spend(const DaeDocument& document, const XmlElement& where, std::uint64_t work);

 private:
  std::uint64_t left_;
};

}  // namespace firstcontact::detail
