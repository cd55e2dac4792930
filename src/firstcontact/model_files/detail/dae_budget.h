/// @file
/// How much work a COLLADA document may make.

#pragma once

#include <cstddef>
#include <cstdint>

#include <firstcontact/model_files/detail/dae_document.h>

namespace firstcontact::detail {

/// Bounds what a small file can unfold to: nodes that instance nodes double with every level.
class DaeBudget {
 public:
  /// @param bytes  the size of the file: what it states itself is never refused
  explicit DaeBudget(std::size_t bytes);

  /// Takes `work` nodes, corners, vertices or influences.
  ///
  /// @param where  for the error
  /// @throws ParseError  more than the file may unfold to
  void spend(const DaeDocument& document, const XmlElement& where, std::uint64_t work);

 private:
  std::uint64_t left_;
};

}  // namespace firstcontact::detail
