/// @file
/// Walks over binary data of either byte order.

#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {

/// A position in a file's bytes. Nothing is read past the end.
class ByteCursor {
 public:
  ByteCursor(std::string_view data, const std::string& source, bool big_endian,
             std::size_t first_offset = 0)
      : data_(data),
        source_(source),
        first_offset_(first_offset),
        swap_(big_endian != (std::endian::native == std::endian::big)) {}

  [[nodiscard]] std::size_t remaining() const { return data_.size() - next_; }
  [[nodiscard]] std::size_t offset() const { return first_offset_ + next_; }
  [[nodiscard]] std::string_view rest() const { return data_.substr(next_); }

  void skip(std::size_t size, const char* what) {
    if (size > remaining()) {
      next_ = data_.size();
      fail("expected " + std::string(what) + ", got the end of the file");
    }
    next_ += size;
  }

  template <class T>
  T read(const char* what) {
    const char* begin = data_.data() + next_;
    skip(sizeof(T), what);
    std::array<char, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), begin, sizeof(T));
    if (swap_) {
      std::reverse(bytes.begin(), bytes.end());
    }
    return std::bit_cast<T>(bytes);
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw ParseError::at_byte(source_, offset(), message);
  }

 private:
  std::string_view data_;
  std::string source_;
  std::size_t first_offset_;
  std::size_t next_ = 0;
  bool swap_;
};

}  // namespace firstcontact::detail
