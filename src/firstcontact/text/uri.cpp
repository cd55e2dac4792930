#include <firstcontact/text/uri.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <system_error>

#include <firstcontact/text/ascii.h>
#include <firstcontact/text/base64.h>

namespace firstcontact::detail {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

constexpr std::string_view kData = "data:";
constexpr std::string_view kBase64 = ";base64";

}  // namespace

std::optional<std::string> decode_percent(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      bytes += text[i];
      continue;
    }
    std::uint8_t byte = 0;
    const std::string_view digits = text.substr(i + 1, 2);
    const char* const end = digits.data() + digits.size();
    const auto [last, error] = std::from_chars(digits.data(), end, byte, 16);
    if (digits.size() < 2 || error != std::errc() || last != end) {
      return std::nullopt;
    }
    bytes += static_cast<char>(byte);
    i += 2;
  }
  return bytes;
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon == 0 || !is_letter(uri.front())) {
    return false;
  }
  const std::string_view scheme = uri.substr(0, colon);
  return std::all_of(scheme.begin(), scheme.end(), [](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
  });
}

bool is_data_uri(std::string_view uri) { return lower(uri.substr(0, kData.size())) == kData; }

std::optional<std::string> decode_data_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view head = uri.substr(0, comma);
  const std::string_view data = uri.substr(comma + 1);
  const bool base64 = head.size() >= kData.size() - 1 + kBase64.size() &&
                      lower(head.substr(head.size() - kBase64.size())) == kBase64;
  if (!base64) {
    return decode_percent(data);
  }
  if (data.find('%') == std::string_view::npos) {
    return from_base64(data);
  }
  const std::optional<std::string> text = decode_percent(data);
  return text ? from_base64(*text) : std::nullopt;
}

}  // namespace firstcontact::detail
