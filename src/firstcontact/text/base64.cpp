#include <firstcontact/text/base64.h>

#include <array>
#include <cstddef>

namespace firstcontact::detail {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNoDigit = 64;

/// The value of each character; kNoDigit for one that is no digit.
constexpr std::array<std::uint8_t, 256> digit_values() {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNoDigit);
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    values[static_cast<std::uint8_t>(kDigits[i])] = static_cast<std::uint8_t>(i);
  }
  return values;
}

/// The text without one or two '=' that fill up a group of four.
std::string_view without_padding(std::string_view text) {
  for (int i = 0; i < 2 && text.size() % 4 != 1 && text.ends_with('='); ++i) {
    text.remove_suffix(1);
  }
  return text;
}

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
  const auto byte = [&](std::size_t i) -> std::uint32_t { return i < bytes.size() ? bytes[i] : 0; };
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::uint32_t group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    const std::size_t left = bytes.size() - i;
    text += kDigits[group >> 18 & 63];
    text += kDigits[group >> 12 & 63];
    text += left > 1 ? kDigits[group >> 6 & 63] : '=';
    text += left > 2 ? kDigits[group & 63] : '=';
  }
  return text;
}

std::optional<std::string> from_base64(std::string_view text) {
  constexpr auto kValues = digit_values();
  const std::string_view digits = text.size() % 4 == 0 ? without_padding(text) : text;
  if (digits.size() % 4 == 1) {
    return std::nullopt;
  }
  std::string bytes;
  bytes.reserve(digits.size() / 4 * 3 + 2);
  std::uint32_t group = 0;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    const std::uint8_t value = kValues[static_cast<std::uint8_t>(digits[i])];
    if (value == kNoDigit) {
      return std::nullopt;
    }
    group = group << 6 | value;
    if (i % 4 != 0) {  // The digits of a group hold 6, 12, 18 and 24 bits.
      bytes += static_cast<char>(group >> (6 - 2 * (i % 4)) & 0xff);
    }
  }
  return bytes;
}

}  // namespace firstcontact::detail
