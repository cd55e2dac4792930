/// @file
/// A file's bytes without a copy.

#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace firstcontact::detail {

/// The bytes of a regular file, mapped read-only for the lifetime of this object.
class MappedFile {
 public:
  /// @throws ParseError if the file cannot be opened or is not a regular file
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::string_view bytes() const {
    return {static_cast<const char*>(address_), size_};
  }

 private:
  void* address_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace firstcontact::detail
