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

/// Collects numbers as bytes, the least significant first, as every browser of today has them.
class FIRSTCONTACT_API PageNumbers {
 public:
  /// Adds a number in single precision.
  void add(float number);
  /// Adds a number in double precision.
  void add(double number);
  void add(const Eigen::Vector3d& v);  ///< Adds three numbers in double precision.

  /// Adds the lowest bytes of a whole number.
  ///
  /// @param size  [byte]  1 to 8
  void add(std::uint64_t number, int size);

  /// [byte]  The size of all numbers together.
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }

  /// All numbers as base64 (RFC 4648, section 4).
  [[nodiscard]] std::string base64() const;

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace firstcontact
