/// @file
/// Takes GLB files apart and puts them together, for mutations; shares no code with the reader.

#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace firstcontact::test {

struct GlbFile {
  std::string json;
  std::string binary;
};

inline std::uint32_t word_at(std::string_view bytes, std::size_t place) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + place, sizeof word);
  return word;
}

/// Splits a GLB file of a JSON chunk and perhaps a binary one; none where the bytes are no such
/// file.
inline std::optional<GlbFile> split(std::string_view bytes) {
  constexpr std::size_t kHeaders = 20;
  if (bytes.size() < kHeaders || bytes.substr(0, 4) != "glTF" || bytes.substr(16, 4) != "JSON") {
    return std::nullopt;
  }
  const std::size_t size = word_at(bytes, 12);
  if (size > bytes.size() - kHeaders) {
    return std::nullopt;
  }
  GlbFile file{std::string(bytes.substr(kHeaders, size)), ""};
  const std::string_view rest = bytes.substr(kHeaders + size);
  file.binary = rest.size() > 8 ? rest.substr(8) : std::string_view();
  return file;
}

inline std::string chunk(const char* type, std::string content, char filling) {
  content.resize((content.size() + 3) / 4 * 4, filling);
  const auto size = static_cast<std::uint32_t>(content.size());
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &size, 4);
  std::memcpy(bytes.data() + 4, type, 4);
  return bytes + content;
}

inline std::string joined(const GlbFile& file) {
  const std::string chunks = chunk("JSON", file.json, ' ') +
                             (file.binary.empty() ? "" : chunk("BIN\0", file.binary, '\0'));
  std::string header("glTF\2\0\0\0\0\0\0\0", 12);
  const auto size = static_cast<std::uint32_t>(header.size() + chunks.size());
  std::memcpy(header.data() + 8, &size, 4);
  return header + chunks;
}

}  // namespace firstcontact::test
