#include "fuzz/text_mutator.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace firstcontact::test {
namespace {

using Lines = std::vector<std::string>;

constexpr std::array<std::string_view, 44> kStumbles = {
    "0",  "-0",   "1",     "-1",  "1e308", "1e999",    "-1e-400", ".5",      "5.",
    "+3", "0x10", "1_000", "0o7", ".nan",  ".inf",     "-.inf",   "nan",     "inf",
    "~",  "null", "true",  "no",  "''",    "\"\"",     "[]",      "{}",      "[~]",
    "*a", "&a",   "&a 1",  "*b",  "!!str", "!!binary", "!x",      "<<",      "|",
    ">",  "---",  "...",   "?",   "1,5",   "0;1",      "\t",      "\xc3\xa9"};

std::size_t below(std::size_t count, std::mt19937& random) {
  return std::uniform_int_distribution<std::size_t>(0, std::max<std::size_t>(count, 1) - 1)(random);
}

Lines lines_of(const std::string& text) {
  Lines lines(1);
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

std::string text_of(const Lines& lines) {
  std::string text;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    text += (k == 0 ? "" : "\n") + lines[k];
  }
  return text;
}

std::size_t indent(const std::string& line) {
  return std::min(line.find_first_not_of(' '), line.size());
}

/// Where the block that begins at a line ends.
std::size_t block_end(const Lines& lines, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < lines.size() && indent(lines[end]) > indent(lines[begin])) {
    ++end;
  }
  return end;
}

std::string change_lines(const std::string& text, std::mt19937& random) {
  Lines lines = lines_of(text);
  const std::size_t begin = below(lines.size(), random);
  const std::size_t end = block_end(lines, begin);
  const auto at = [&](std::size_t k) { return lines.begin() + static_cast<std::ptrdiff_t>(k); };
  const Lines block(at(begin), at(end));
  switch (below(6, random)) {
    case 0:
      std::swap(lines[begin], lines[below(lines.size(), random)]);
      break;
    case 1:
      lines.erase(at(begin), at(end));
      break;
    case 2:
      lines.insert(at(below(lines.size() + 1, random)), block.begin(), block.end());
      break;
    case 3:  // Deeper, below the line before.
      for (std::size_t k = begin; k < end; ++k) {
        lines[k].insert(0, 1 + below(4, random), ' ');
      }
      break;
    case 4:
      lines.insert(at(begin), below(2, random) == 0 ? "---" : "# " + lines[begin]);
      break;
    default: {  // The block inside of itself.
      Lines inside = block;
      for (std::string& line : inside) {
        line.insert(0, 2, ' ');
      }
      lines.insert(at(end), inside.begin(), inside.end());
    }
  }
  return text_of(lines);
}

/// A stretch of the text: a word, or what stands between words.
struct Word {
  std::size_t begin = 0;
  std::size_t size = 0;
};

std::vector<Word> words_of(const std::string& text) {
  constexpr std::string_view kBetween = " \t\r\n,;:[]{}\"'";
  std::vector<Word> words;
  for (std::size_t k = 0; k < text.size();) {
    const std::size_t begin = std::min(text.find_first_not_of(kBetween, k), text.size());
    k = std::min(text.find_first_of(kBetween, begin), text.size());
    if (begin < k) {
      words.push_back({begin, k - begin});
    }
  }
  return words;
}

std::string brackets(const std::string& value, std::mt19937& random) {
  constexpr std::array<std::size_t, 4> kDepths = {1, 2, 63, 12'000};
  const std::size_t depth = kDepths.at(below(kDepths.size(), random));
  const bool closes = below(4, random) != 0;
  std::string open;
  std::string close;
  const bool map = below(2, random) == 0;
  for (std::size_t k = 0; k < depth; ++k) {
    open += map ? "{a: " : "[";
    close += map ? "}" : "]";
  }
  return open + value + (closes ? close : "");
}

std::string change_word(std::string text, std::span<const std::string_view> known,
                        std::mt19937& random) {
  const std::vector<Word> words = words_of(text);
  if (words.empty()) {
    return text + std::string(kStumbles.at(below(kStumbles.size(), random)));
  }
  const Word word = words[below(words.size(), random)];
  const std::string old = text.substr(word.begin, word.size);
  const Word other = words[below(words.size(), random)];
  std::string by;
  switch (below(7, random)) {
    case 0:
    case 1:
      by = kStumbles.at(below(kStumbles.size(), random));
      break;
    case 2:
      by = known.empty() ? old : std::string(known[below(known.size(), random)]);
      break;
    case 3:
      by = text.substr(other.begin, other.size);
      break;
    case 4:
      by = brackets(old, random);
      break;
    case 5:
      by = "&a " + old;
      break;
    default:
      by = "*a";
  }
  return text.replace(word.begin, word.size, by);
}

std::string change_separator(std::string text, std::mt19937& random) {
  constexpr std::string_view kSeparators = ",;\t :.";
  const char from = kSeparators[below(kSeparators.size(), random)];
  const char to = kSeparators[below(kSeparators.size(), random)];
  const bool all = below(2, random) == 0;
  std::size_t at = text.find(from, below(text.size(), random));
  while (at != std::string::npos) {
    text[at] = to;
    at = all ? text.find(from, at + 1) : std::string::npos;
  }
  return text;
}

}  // namespace

std::string changed_text(std::string text, std::span<const std::string_view> words,
                         std::mt19937& random) {
  const std::size_t changes = 1 + below(4, random);
  for (std::size_t k = 0; k < changes; ++k) {
    switch (below(8, random)) {
      case 0:
        text = change_separator(std::move(text), random);
        break;
      case 1:
      case 2:
      case 3:
        text = change_lines(text, random);
        break;
      default:
        text = change_word(std::move(text), words, random);
    }
  }
  return text;
}

std::size_t mutate_text(char* data, std::size_t size, std::size_t most, unsigned seed,
                        std::span<const std::string_view> words) {
  std::mt19937 random(seed);
  if (below(5, random) == 0) {
    return LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(data), size, most);
  }
  const std::string text = changed_text({data, size}, words, random);
  const std::size_t kept = std::min(text.size(), most);
  std::memcpy(data, text.data(), kept);
  return kept;
}

}  // namespace firstcontact::test
