#include <firstcontact/model_files/detail/gltf_accessor.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

template <class T>
T load(const char* bytes) {
  std::array<char, sizeof(T)> copy{};
  std::memcpy(copy.data(), bytes, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) {
    std::reverse(copy.begin(), copy.end());
  }
  return std::bit_cast<T>(copy);
}

template <class T>
double whole_or_share(const char* bytes, bool normalized) {
  const auto value = static_cast<double>(load<T>(bytes));
  return normalized ? std::max(value / std::numeric_limits<T>::max(), -1.0) : value;
}

/// [rows]  Greatest number of rows of an accessor without bytes in a small file.
constexpr std::size_t kMostZeros = std::size_t{1} << 20;

/// Counts the numbers in a row of each type.
std::size_t columns_of(std::string_view type) {
  return type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
}

/// Names the type of numbers in a message.
std::string_view name_of(GltfNumber type) {
  switch (type) {
    case GltfNumber::int8:
      return "byte";
    case GltfNumber::uint8:
      return "unsigned byte";
    case GltfNumber::int16:
      return "short";
    case GltfNumber::uint16:
      return "unsigned short";
    case GltfNumber::uint32:
      return "unsigned int";
    case GltfNumber::float32:
      return "float";
  }
  return "";
}

bool is_right(GltfNumber type, const GltfExpected& expected) {
  const bool is_signed = type == GltfNumber::int8 || type == GltfNumber::int16;
  return type == GltfNumber::float32 ? expected.floats
                                     : expected.integers && (!is_signed || expected.floats);
}

}  // namespace

std::size_t size_of(GltfNumber type) {
  switch (type) {
    case GltfNumber::int8:
    case GltfNumber::uint8:
      return 1;
    case GltfNumber::int16:
    case GltfNumber::uint16:
      return 2;
    case GltfNumber::uint32:
    case GltfNumber::float32:
      break;
  }
  return 4;
}

double GltfRows::at(std::size_t row, std::size_t column) const {
  const char* const place = bytes.data() + row * stride + column * size_of(type);
  switch (type) {
    case GltfNumber::int8:
      return whole_or_share<std::int8_t>(place, normalized);
    case GltfNumber::uint8:
      return whole_or_share<std::uint8_t>(place, normalized);
    case GltfNumber::int16:
      return whole_or_share<std::int16_t>(place, normalized);
    case GltfNumber::uint16:
      return whole_or_share<std::uint16_t>(place, normalized);
    case GltfNumber::uint32:
      return whole_or_share<std::uint32_t>(place, normalized);
    case GltfNumber::float32:
      break;
  }
  return static_cast<double>(load<float>(place));
}

GltfAccessor::Row GltfAccessor::find_row(std::size_t row) const {
  std::size_t begin = 0;
  std::size_t end = sparse_.count;
  while (begin < end) {
    const std::size_t middle = begin + (end - begin) / 2;
    const auto index = static_cast<std::size_t>(sparse_.indices.at(middle, 0));
    if (index == row) {
      return {&sparse_.values, middle};
    }
    (index < row ? begin : end) = index < row ? middle + 1 : middle;
  }
  return {has_bytes() ? &base_ : nullptr, row};
}

double GltfAccessor::at(std::size_t row, std::size_t column) const {
  const Row found = find_row(row);
  return found.rows == nullptr ? 0.0 : found.rows->at(found.row, column);
}

Eigen::Vector3d GltfAccessor::vector3(std::size_t row) const {
  const Row found = find_row(row);
  if (found.rows == nullptr) {
    return Eigen::Vector3d::Zero();
  }
  return {found.rows->at(found.row, 0), found.rows->at(found.row, 1), found.rows->at(found.row, 2)};
}

GltfAccessor GltfAccessorReader::read(const JsonValue& value, const GltfExpected& expected) const {
  const std::size_t index = document_.index(value, GltfArray::accessors);
  const std::string place = "accessors[" + std::to_string(index) + "]";
  const JsonValue& where = document_.all(GltfArray::accessors)[index];
  const JsonObject& object = document_.checked(where, GltfObject::accessor, place);
  const JsonValue& type = document_.reader().member(where, "type");
  if (document_.reader().string(type, "a type") != expected.type) {
    document_.reader().fail_expected(in_quotes(expected.type), type);
  }
  GltfRows shape;
  shape.type = number_type(where);
  if (const JsonValue* const normalized = find(object, "normalized")) {
    shape.normalized = document_.reader().boolean(*normalized) && shape.type != GltfNumber::float32;
    if (shape.normalized && !expected.floats) {
      document_.reader().fail(*normalized,
                              "expected false here: the integers count from 0 on, and as shares "
                              "of the greatest one they would be 0 or 1");
    }
  }
  if (!is_right(shape.type, expected)) {
    document_.fail(
        where, "expected numbers of another type here, got " + std::string(name_of(shape.type)));
  }
  static_cast<void>(document_.reader().member(where, "count"));
  const std::size_t count = document_.whole(object, "count", 0);
  GltfAccessor accessor(count, columns_of(expected.type), shape);
  if (find(object, "bufferView") != nullptr) {
    accessor.base_ = rows(where, shape, count, accessor.columns_);
  }
  if (const JsonValue* const sparse = find(object, "sparse")) {
    add_sparse(*sparse, place + ".sparse", accessor);
  }
  if (!accessor.has_bytes() && count > std::max(kMostZeros, file_size_ + buffers_.size_read())) {
    document_.fail(where, "expected a bufferView for " + std::to_string(count) +
                              " elements, which are more than the file has bytes, got none");
  }
  return accessor;
}

GltfNumber GltfAccessorReader::number_type(const JsonValue& object) const {
  const JsonValue& value = document_.reader().member(object, "componentType");
  const double code = document_.reader().number(value);
  for (const GltfNumber type : {GltfNumber::int8, GltfNumber::uint8, GltfNumber::int16,
                                GltfNumber::uint16, GltfNumber::uint32, GltfNumber::float32}) {
    if (code == static_cast<double>(type)) {
      return type;
    }
  }
  document_.reader().fail_expected("5120, 5121, 5122, 5123, 5125 or 5126 (float)", value);
}

GltfRows GltfAccessorReader::rows(const JsonValue& where, GltfRows shape, std::size_t count,
                                  std::size_t columns) const {
  const JsonObject& object = document_.object(where);
  const GltfBufferView view = buffers_.view(document_.reader().member(where, "bufferView"));
  const std::uint64_t offset = document_.whole(object, "byteOffset", 0);
  const std::size_t row_size = columns * size_of(shape.type);
  shape.stride = view.stride.value_or(row_size);
  if (shape.stride < row_size) {
    document_.fail(where, "expected a byteStride of at least " + std::to_string(row_size) +
                              " bytes for its elements, got " + std::to_string(shape.stride));
  }
  const std::size_t left = offset <= view.bytes.size() ? view.bytes.size() - offset : 0;
  if (count > 0 && (row_size > left || count - 1 > (left - row_size) / shape.stride)) {
    document_.fail(where, "expected " + std::to_string(count) + " elements of " +
                              std::to_string(row_size) + " bytes in its bufferView, which has " +
                              std::to_string(left) + " bytes for them");
  }
  shape.bytes = view.bytes.substr(std::min<std::size_t>(offset, view.bytes.size()));
  return shape;
}

void GltfAccessorReader::add_sparse(const JsonValue& where, const std::string& place,
                                    GltfAccessor& accessor) const {
  const JsonObject& object = document_.checked(where, GltfObject::sparse, place);
  static_cast<void>(document_.reader().member(where, "count"));
  const std::size_t count = document_.whole(object, "count", 0);
  const JsonValue& indices = document_.reader().member(where, "indices");
  const JsonValue& values = document_.reader().member(where, "values");
  static_cast<void>(document_.checked(indices, GltfObject::sparse_part, place + ".indices"));
  static_cast<void>(document_.checked(values, GltfObject::sparse_part, place + ".values"));
  GltfRows index_shape;
  index_shape.type = number_type(indices);
  if (!is_right(index_shape.type, {.type = "SCALAR", .floats = false, .integers = true})) {
    document_.fail(indices, "expected indices of unsigned integers, got " +
                                std::string(name_of(index_shape.type)));
  }
  GltfRows value_shape = accessor.base_;
  value_shape.stride = 0;
  accessor.sparse_.indices = rows(indices, index_shape, count, 1);
  accessor.sparse_.values = rows(values, value_shape, count, accessor.columns_);
  accessor.sparse_.count = count;
  double before = -1.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double index = accessor.sparse_.indices.at(i, 0);
    if (!(index > before) || !(index < static_cast<double>(accessor.count_))) {
      document_.fail(indices, "expected ascending indices below " +
                                  std::to_string(accessor.count_) + ", got " + write_json(index) +
                                  " as number " + std::to_string(i));
    }
    before = index;
  }
}

}  // namespace firstcontact::detail
