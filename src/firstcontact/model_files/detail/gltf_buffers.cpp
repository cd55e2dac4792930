#include <firstcontact/model_files/detail/gltf_buffers.h>

#include <cstdint>
#include <system_error>
#include <utility>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/uri.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// Whether a buffer has no bytes of its own, but is the target of a compressed view.
bool is_fallback(const GltfDocument& document, const JsonObject& buffer) {
  for (const char* const name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const JsonValue* const extension = document.extension(buffer, name);
    const JsonValue* const fallback =
        extension == nullptr ? nullptr : find(document.object(*extension), "fallback");
    if (fallback != nullptr && document.reader().boolean(*fallback)) {
      return true;
    }
  }
  return false;
}

}  // namespace

GltfBuffers::GltfBuffers(const GltfDocument& document, std::filesystem::path source,
                         std::optional<std::string_view> binary)
    : document_(document),
      source_(std::move(source)),
      binary_(binary),
      buffers_(document.all(GltfArray::buffers).size()) {}

GltfBufferView GltfBuffers::view(const JsonValue& value) {
  const std::size_t index = document_.index(value, GltfArray::buffer_views);
  const JsonValue& where = document_.all(GltfArray::buffer_views)[index];
  const JsonObject& view = document_.checked(where, GltfObject::buffer_view,
                                             "bufferViews[" + std::to_string(index) + "]");
  const std::string_view bytes =
      buffer(document_.index(document_.reader().member(where, "buffer"), GltfArray::buffers));
  static_cast<void>(document_.reader().member(where, "byteLength"));
  const std::uint64_t offset = document_.whole(view, "byteOffset", 0);
  const std::uint64_t length = document_.whole(view, "byteLength", 0);
  if (offset > bytes.size() || length > bytes.size() - offset) {
    document_.fail(where, "expected a view inside of its buffer of " +
                              std::to_string(bytes.size()) + " bytes, got " +
                              std::to_string(length) + " bytes from byte " +
                              std::to_string(offset));
  }
  GltfBufferView result{bytes.substr(offset, length), std::nullopt};
  if (find(view, "byteStride") != nullptr) {
    result.stride = document_.whole(view, "byteStride", 0);
  }
  return result;
}

std::string_view GltfBuffers::buffer(std::size_t index) {
  if (!buffers_[index]) {
    buffers_[index] = read(index);
    size_read_ += buffers_[index]->size();
  }
  return *buffers_[index];
}

std::string_view GltfBuffers::read(std::size_t index) {
  const JsonValue& where = document_.all(GltfArray::buffers)[index];
  const JsonObject& buffer =
      document_.checked(where, GltfObject::buffer, "buffers[" + std::to_string(index) + "]");
  static_cast<void>(document_.reader().member(where, "byteLength"));
  const std::uint64_t length = document_.whole(buffer, "byteLength", 0);
  const JsonValue* const uri = find(buffer, "uri");
  if (uri == nullptr && is_fallback(document_, buffer)) {
    document_.fail(where,
                   "expected bytes, got a place for compressed ones; decompress the file first");
  }
  if (uri == nullptr && !(index == 0 && binary_)) {
    document_.fail(where, "expected a URI, or the binary chunk of a GLB file, got neither");
  }
  const std::string_view bytes = uri == nullptr ? *binary_ : decode(*uri);
  if (bytes.size() < length) {
    document_.fail(where, "expected " + std::to_string(length) + " bytes (byteLength), got " +
                              std::to_string(bytes.size()));
  }
  return bytes.substr(0, length);
}

std::string_view GltfBuffers::decode(const JsonValue& uri) {
  const std::string& text = document_.reader().string(uri, "a URI");
  if (!is_data_uri(text)) {
    return open(uri);
  }
  std::optional<std::string> bytes = decode_data_uri(text);
  if (!bytes) {
    document_.fail(uri,
                   "expected a data URI, such as data:application/octet-stream;base64,AAAA, got " +
                       in_quotes(text));
  }
  return decoded_.emplace_back(std::move(*bytes));
}

std::string_view GltfBuffers::open(const JsonValue& uri) {
  const auto& text = std::get<std::string>(uri.value);
  if (has_scheme(text) || text.starts_with('/') || text.starts_with('\\')) {
    document_.fail(uri, "expected a URI relative to the file's folder, got " + in_quotes(text) +
                            "; nothing is fetched from elsewhere");
  }
  const std::optional<std::string> name = decode_percent(text);
  if (!name || name->find('\0') != std::string::npos) {
    document_.fail(uri,
                   "expected two hexadecimal digits after each '%' (a '%' itself is %25), got " +
                       in_quotes(text));
  }
  std::filesystem::path path = source_.parent_path() / *name;
  std::error_code error;
  if (const auto literal = source_.parent_path() / text; *name != text &&
                                                         !std::filesystem::exists(path, error) &&
                                                         std::filesystem::exists(literal, error)) {
    path = literal;
    document_.log().warn(
        ParseError(document_.log().path(), uri.line,
                   "the URI " + in_quotes(text) + " means the file " + in_quotes(*name) +
                       ", which is missing; the file of the URI's own letters was read"));
  }
  const MappedFile& file = files_.emplace_back(path);
  document_.log().add_file(path.string());
  return file.bytes();
}

}  // namespace firstcontact::detail
