/// @file
/// Rows of numbers as the viewer's page has them.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/export.h>

namespace firstcontact {

/// Collects numbers, in the order of bytes that every browser of today has: the least first.
class FIRSTCONTACT_API PageNumbers {
 public:
  void add(float number);
  void add(double number);
  void add(const Eigen::Vector3d& v);  ///< Three in double precision.

  /// @param size  [byte]  of the number, up to 8: the lowest ones
  void add(std::uint64_t number, int size);

  /// [byte]  The size of all numbers together.
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }

  /// All numbers as base64 (RFC 4648, section 4).
  [[nodiscard]] std::string base64() const;

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace firstcontact
