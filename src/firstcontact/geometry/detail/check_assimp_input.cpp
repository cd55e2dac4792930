#include <firstcontact/geometry/detail/check_assimp_input.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <firstcontact/geometry/detail/byte_cursor.h>
#include <firstcontact/geometry/parse_error.h>

namespace firstcontact::detail {
namespace {

/// Past the '>' of the tag whose name starts at `start`; quoted ones do not count.
std::size_t end_of_tag(std::string_view text, std::size_t start) {
  char quote = '\0';
  for (std::size_t i = start; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != '\0') {
      quote = c == quote ? '\0' : quote;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return i + 1;
    }
  }
  return text.size();
}

constexpr std::string_view kSpace = " \t\r\n";

void check_numbers(const std::string& path, std::string_view text, std::size_t begin) {
  const std::size_t end = std::min(text.find('<', begin), text.size());
  const std::string_view numbers = text.substr(begin, end - begin);
  const std::size_t odd = numbers.find_first_not_of("0123456789+-.eE \t\r\n");
  if (odd != std::string_view::npos) {
    throw ParseError::at_byte(path, begin + odd, "expected a number");
  }
  if (numbers.find_first_of("0123456789") == std::string_view::npos) {
    throw ParseError::at_byte(path, end, "expected at least one number");
  }
}

std::string_view without_spaces_before(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(kSpace), text.size()));
}

/// Whether the attributes of a tag contain count = "digits".
bool has_count(std::string_view attributes) {
  constexpr std::string_view kName = "count";
  const std::size_t name = attributes.find(kName);
  if (name == std::string_view::npos || name == 0 ||
      kSpace.find(attributes[name - 1]) == std::string_view::npos) {
    return false;
  }
  const std::string_view after = without_spaces_before(attributes.substr(name + kName.size()));
  if (after.empty() || after.front() != '=') {
    return false;
  }
  const std::string_view value = without_spaces_before(after.substr(1));
  if (value.empty() || (value.front() != '"' && value.front() != '\'')) {
    return false;
  }
  const std::size_t end = value.find_first_not_of("0123456789", 1);
  return end != std::string_view::npos && end > 1 && value[end] == value.front();
}

}  // namespace

void check_glb_chunks(const std::string& path, std::string_view bytes) {
  constexpr std::size_t kHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  if (bytes.size() < kHeader || bytes.substr(0, 4) != "glTF") {
    throw ParseError::at_byte(path, 0, "expected the header 'glTF' of 12 bytes");
  }
  ByteCursor cursor(bytes, path, /*big_endian=*/false);
  cursor.skip(8, "the header");
  const std::size_t length = cursor.read<std::uint32_t>("the length");
  const auto expect = [&](std::size_t end, std::size_t available) {
    if (end > available) {
      throw ParseError::at_byte(
          path, available, "expected " + std::to_string(end) + " bytes, got the end of the file");
    }
  };
  expect(length, bytes.size());
  for (std::size_t at = kHeader; at < length;) {
    expect(at + kChunkHeader, length);
    const std::size_t size = cursor.read<std::uint32_t>("the length of a chunk");
    expect(at + kChunkHeader + size, length);
    cursor.skip(4 + size, "a chunk");
    at += kChunkHeader + size;
  }
}

void check_dae_numbers(const std::string& path, std::string_view text) {
  for (std::size_t open = text.find('<'); open != std::string_view::npos;
       open = text.find('<', open + 1)) {
    const std::size_t name_end = std::min(text.find_first_of(" \t\r\n/>", open), text.size());
    const std::string_view name = text.substr(open + 1, name_end - open - 1);
    if (name != "float_array" && name != "p" && name != "vcount") {
      continue;
    }
    const std::size_t tag_end = end_of_tag(text, name_end);
    if (name == "float_array" && !has_count(text.substr(name_end, tag_end - name_end))) {
      throw ParseError::at_byte(path, open, "expected the count of a float_array");
    }
    check_numbers(path, text, tag_end);
  }
}

}  // namespace firstcontact::detail
