#include <firstcontact/mesh_files/detail/check_assimp_input.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <system_error>

#include <firstcontact/text/byte_cursor.h>
#include <firstcontact/text/parse_error.h>

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

/// The value of name = "digits" among the attributes of a tag.
std::optional<std::uint64_t> number_of(std::string_view attributes, std::string_view name) {
  const std::size_t at = attributes.find(name);
  if (at == std::string_view::npos || at == 0 ||
      kSpace.find(attributes[at - 1]) == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view after = without_spaces_before(attributes.substr(at + name.size()));
  if (after.empty() || after.front() != '=') {
    return std::nullopt;
  }
  const std::string_view value = without_spaces_before(after.substr(1));
  if (value.empty() || (value.front() != '"' && value.front() != '\'')) {
    return std::nullopt;
  }
  std::uint64_t number = 0;
  const char* const end = value.data() + value.size();
  const auto [last, error] = std::from_chars(value.data() + 1, end, number);
  return error == std::errc() && last != end && *last == value.front() ? std::optional(number)
                                                                       : std::nullopt;
}

/// What assimp takes from an array by an accessor has to lie within it: it does not look.
///
/// @param tag   past the name of the accessor's tag
/// @param held  numbers in the array before it
void check_accessor(const std::string& path, std::string_view text, std::size_t tag,
                    std::uint64_t held) {
  const std::size_t tag_end = end_of_tag(text, tag);
  const std::string_view attributes = text.substr(tag, tag_end - tag);
  const std::size_t close = std::min(text.find("</accessor", tag_end), text.size());
  std::uint64_t names = 0;
  for (std::size_t at = text.find("<param", tag_end); at < close;
       at = text.find("<param", at + 1)) {
    ++names;
  }
  const bool has_stride = attributes.find("stride") != std::string_view::npos;
  const bool has_offset = attributes.find("offset") != std::string_view::npos;
  const std::optional<std::uint64_t> stride =
      has_stride ? number_of(attributes, "stride") : std::optional<std::uint64_t>(1);
  const std::optional<std::uint64_t> offset =
      has_offset ? number_of(attributes, "offset") : std::optional<std::uint64_t>(0);
  const std::optional<std::uint64_t> rows = number_of(attributes, "count");
  const std::uint64_t most = text.size();
  const bool fits =
      stride && offset && rows && *stride <= most && *offset <= most && *rows <= most &&
      (*rows == 0 || *offset + (*rows - 1) * *stride + std::max(*stride, names) <= held);
  if (!fits) {
    throw ParseError::at_byte(path, tag, "expected an accessor of what the array before it holds");
  }
}

void check_indices(const std::string& path, std::string_view text, std::size_t begin) {
  const std::size_t end = std::min(text.find('<', begin), text.size());
  const std::size_t odd = text.substr(begin, end - begin).find_first_not_of("0123456789 \t\r\n");
  if (odd != std::string_view::npos) {
    throw ParseError::at_byte(path, begin + odd, "expected an index, a whole number >= 0");
  }
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
  std::uint64_t held = 0;  // In the last array of the source.
  for (std::size_t open = text.find('<'); open != std::string_view::npos;
       open = text.find('<', open + 1)) {
    const std::size_t name_end = std::min(text.find_first_of(" \t\r\n/>", open), text.size());
    const std::string_view name = text.substr(open + 1, name_end - open - 1);
    const std::size_t tag_end = end_of_tag(text, name_end);
    if (name == "source") {
      held = 0;
    } else if (name.ends_with("_array")) {
      const auto count = number_of(text.substr(name_end, tag_end - name_end), "count");
      if (name == "float_array" && !count) {
        throw ParseError::at_byte(path, open, "expected the count of a float_array");
      }
      held = count.value_or(0);
    } else if (name == "accessor") {
      check_accessor(path, text, name_end, held);
    }
    if (name == "float_array" || name == "p" || name == "vcount") {
      check_numbers(path, text, tag_end);
    }
    if (name == "p" || name == "vcount") {
      check_indices(path, text, tag_end);
    }
  }
}

}  // namespace firstcontact::detail
