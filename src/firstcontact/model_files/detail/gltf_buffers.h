/// @file
/// The bytes to which a glTF document points.

#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/model_files/detail/gltf_document.h>
#include <firstcontact/text/mapped_file.h>

namespace firstcontact::detail {

/// Part of a buffer.
struct GltfBufferView {
  std::string_view bytes;
  std::optional<std::size_t> stride;  ///< [byte]  Distance between elements; packed where missing.
};

/// The buffers of a document. Each is read at its first use, so a buffer that serves only the looks
/// may be missing. Files are mapped, not copied.
class GltfBuffers {
 public:
  /// @param document  outlives this
  /// @param source    the file of the document; URIs are relative to its folder
  /// @param binary    the binary chunk of a GLB file; outlives this
  GltfBuffers(const GltfDocument& document, std::filesystem::path source,
              std::optional<std::string_view> binary);

  /// Finds the bytes of a view.
  ///
  /// @param value  an index of bufferViews
  /// @throws ParseError  an index out of range, a file that cannot be opened, an absolute URI, a
  ///         buffer shorter than it states, a view past the end of its buffer, compressed bytes
  [[nodiscard]] GltfBufferView view(const JsonValue& value);

  /// [byte]  The size of all that was read for the document so far, beside the document itself.
  [[nodiscard]] std::size_t size_read() const { return size_read_; }

 private:
  [[nodiscard]] std::string_view buffer(std::size_t index);
  [[nodiscard]] std::string_view read(std::size_t index);
  [[nodiscard]] std::string_view decode(const JsonValue& uri);
  [[nodiscard]] std::string_view open(const JsonValue& uri);

  const GltfDocument& document_;
  std::filesystem::path source_;
  std::optional<std::string_view> binary_;
  std::vector<std::optional<std::string_view>> buffers_;
  std::deque<MappedFile> files_;
  std::deque<std::string> decoded_;
  std::size_t size_read_ = 0;
};

}  // namespace firstcontact::detail
