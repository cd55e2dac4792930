/// @file
/// Arrays of numbers in a glTF document.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include <firstcontact/model_files/detail/gltf_buffers.h>
#include <firstcontact/model_files/detail/gltf_document.h>

namespace firstcontact::detail {

/// The types of numbers, by their codes in the document.
enum class GltfNumber : std::uint16_t {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126
};

/// [byte]  Computes the size of a number of this type.
[[nodiscard]] std::size_t size_of(GltfNumber type);

/// Rows of numbers in bytes, little-endian.
struct GltfRows {
  std::string_view bytes;  ///< The first row begins at the first byte; all rows are inside.
  std::size_t stride = 0;  ///< [byte]  Distance from one row to the next.
  GltfNumber type = GltfNumber::float32;
  bool normalized = false;  ///< Whether integers stand for fractions of the greatest one.

  /// Reads a number as a double: exact for floats and plain integers.
  ///
  /// A normalised number is the quotient c / 127, c / 255, c / 32767 or c / 65535, rounded once,
  /// and not below -1.
  [[nodiscard]] double at(std::size_t row, std::size_t column) const;
};

/// One accessor. Its numbers are read from the bytes when they are needed.
class GltfAccessor {
 public:
  /// @param columns  numbers in a row: 1 for SCALAR, 3 for VEC3, 16 for MAT4
  GltfAccessor(std::size_t count, std::size_t columns, GltfRows shape)
      : count_(count), columns_(columns), base_(shape) {}

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] GltfNumber type() const { return base_.type; }
  [[nodiscard]] bool normalized() const { return base_.normalized; }

  /// Whether the numbers stand in bytes. Otherwise they are zeros, except for sparse ones.
  [[nodiscard]] bool has_bytes() const { return base_.stride > 0; }

  /// Reads a number of a row below count().
  [[nodiscard]] double at(std::size_t row, std::size_t column) const;

  /// Reads the first three numbers of a row.
  [[nodiscard]] Eigen::Vector3d vector3(std::size_t row) const;

 private:
  friend class GltfAccessorReader;

  /// The rows that replace those of the base: row index[i] is values[i]; the indices ascend.
  struct Sparse {
    std::size_t count = 0;
    GltfRows indices;
    GltfRows values;
  };

  /// The place of a row: in the base or among the sparse ones.
  struct Row {
    const GltfRows* rows;
    std::size_t row;
  };
  [[nodiscard]] Row find_row(std::size_t row) const;

  std::size_t count_;
  std::size_t columns_;
  GltfRows base_;
  Sparse sparse_;
};

/// The properties that an accessor must have in its place.
struct GltfExpected {
  std::string_view type;  ///< "VEC3"
  bool floats = true;     ///< Whether floats are accepted.
  /// Whether unsigned integers are accepted, and signed ones where floats are accepted, too.
  bool integers = false;
};

/// The accessors of a document.
class GltfAccessorReader {
 public:
  /// Prepares the reading of accessors.
  ///
  /// @param buffers    outlives this
  /// @param file_size  [byte]  of the document. An accessor without bytes has at most as many rows
  ///         (or 2^20), as its count has no other support
  GltfAccessorReader(const GltfDocument& document, GltfBuffers& buffers, std::size_t file_size)
      : document_(document), buffers_(buffers), file_size_(file_size) {}

  /// Reads an accessor.
  ///
  /// @param value  an index of accessors
  /// @throws ParseError  an index out of range, another type than expected, rows past the end of
  ///         the bytes, sparse indices that do not ascend
  [[nodiscard]] GltfAccessor read(const JsonValue& value, const GltfExpected& expected) const;

 private:
  [[nodiscard]] GltfNumber number_type(const JsonValue& object) const;
  [[nodiscard]] GltfRows rows(const JsonValue& where, GltfRows shape, std::size_t count,
                              std::size_t columns) const;
  void add_sparse(const JsonValue& where, const std::string& place, GltfAccessor& accessor) const;

  const GltfDocument& document_;
  GltfBuffers& buffers_;
  std::size_t file_size_;
};

}  // namespace firstcontact::detail
