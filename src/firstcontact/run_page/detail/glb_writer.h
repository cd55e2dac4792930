/// @file
/// The container of binary glTF 2.0: rows of numbers, and the JSON that refers to them.

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace firstcontact::detail {

/// Writes the container of binary glTF.
///
/// Source: Khronos Group, "glTF 2.0 Specification" (2021), chapters 3.6 and 4.
class GlbWriter {
 public:
  /// The use of a row of numbers: the two kinds of buffer views that have a target.
  enum class Target : int { none = 0, vertices = 34962, indices = 34963 };

  /// Adds vectors of single precision, with their bounds.
  ///
  /// @param numbers  numbers of one vector after another; at least one
  /// @param width    count of numbers of a vector: 1, 3 or 4
  /// @returns the number of the accessor
  std::size_t add(std::span<const float> numbers, std::size_t width, Target target);

  /// Adds indices of vertices.
  std::size_t add(std::span<const std::uint32_t> indices);

  /// Returns the contents of the file.
  ///
  /// @throws std::invalid_argument beyond 4 GiB
  /// @param document  with all but "asset", "buffers", "bufferViews" and "accessors"
  [[nodiscard]] std::string write(nlohmann::ordered_json document) const;

 private:
  std::size_t add_view(std::string_view bytes, Target target);

  std::string bytes_;
  nlohmann::ordered_json views_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json accessors_ = nlohmann::ordered_json::array();
};

}  // namespace firstcontact::detail
