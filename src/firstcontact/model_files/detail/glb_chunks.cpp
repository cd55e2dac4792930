#include <firstcontact/model_files/detail/glb_chunks.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include <firstcontact/text/byte_cursor.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kJson = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t kBinary = 0x004e4942;  // "BIN" and a zero

/// Finds the bytes from the header's end to the file's end by its stated length.
std::string_view chunks_of(std::string_view bytes, ReadingLog& log) {
  ByteCursor cursor(bytes, log.path(), /*big_endian=*/false);
  cursor.skip(kMagic.size(), "the header 'glTF'");
  const auto version = cursor.read<std::uint32_t>("the version");
  if (version != 2) {
    throw ParseError::at_byte(log.path(), kMagic.size(),
                              "expected GLB of version 2, got version " + std::to_string(version) +
                                  "; convert the file to glTF 2.0");
  }
  const std::size_t length = cursor.read<std::uint32_t>("the length of the file");
  if (length > bytes.size()) {
    throw ParseError::at_byte(
        log.path(), bytes.size(),
        "expected " + std::to_string(length) + " bytes, got the end of the file");
  }
  if (length < cursor.offset()) {
    cursor.fail("expected a length of at least 12 bytes, got " + std::to_string(length));
  }
  if (length < bytes.size()) {
    log.warn(ParseError::at_byte(log.path(), length,
                                 "the header ends the file here; " +
                                     std::to_string(bytes.size() - length) +
                                     " bytes after it are left out"));
  }
  return bytes.substr(cursor.offset(), length - cursor.offset());
}

/// Whether bytes are a document of text: an object, perhaps after blanks and a byte order mark.
bool looks_like_json(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first != std::string_view::npos && bytes[first] == '{';
}

/// Removes zeros at the end: some writers pad the text with zeros in place of spaces.
std::string_view without_zeros_at_end(std::string_view text) {
  const std::size_t last = text.find_last_not_of('\0');
  return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

}  // namespace

GlbChunks split_glb(std::string_view bytes, ReadingLog& log) {
  if (looks_like_json(bytes)) {
    return {bytes, std::nullopt};
  }
  if (!bytes.starts_with(kMagic)) {
    throw ParseError::at_byte(log.path(), 0,
                              "expected the header 'glTF' of a GLB file, or the '{' of a document");
  }
  constexpr std::size_t kHeader = 12;
  ByteCursor cursor(chunks_of(bytes, log), log.path(), /*big_endian=*/false, kHeader);
  GlbChunks chunks;
  for (bool first = true; first || cursor.remaining() > 0; first = false) {
    const std::size_t place = cursor.offset();
    const std::size_t size = cursor.read<std::uint32_t>("the length of a chunk");
    const auto type = cursor.read<std::uint32_t>("the type of a chunk");
    const std::string_view content = cursor.rest().substr(0, size);
    cursor.skip(size, "a chunk");
    if (first != (type == kJson) || (type == kBinary && chunks.binary)) {
      throw ParseError::at_byte(log.path(), place,
                                first ? "expected a chunk of JSON first"
                                      : "expected one chunk of each type, got another of JSON or "
                                        "of binary data");
    }
    if (type == kJson) {
      chunks.json = without_zeros_at_end(content);
    } else if (type == kBinary) {
      chunks.binary = content;
    } else {
      log.leave_out("chunk " + in_quotes(bytes.substr(place + 4, 4)),
                    "a type that glTF does not have");
    }
  }
  return chunks;
}

}  // namespace firstcontact::detail
