/// @file
/// Changes texts of lines and words as people and hostile programs do: whole lines, blocks and
/// words instead of bytes, so that most of what comes out is nearly right.

#pragma once

#include <cstddef>
#include <random>
#include <span>
#include <string>
#include <string_view>

namespace firstcontact::test {

/// The text after one to four changes.
///
/// Lines and blocks (a line with those below that are indented deeper) are swapped, repeated,
/// dropped and nested; words become other words of the text, or words that readers stumble over
/// (numbers out of range, words of other types, quotes, anchors, aliases, document marks); values
/// are wrapped in up to 12,000 brackets; separators change.
///
/// @param words  of the format, such as its keys
[[nodiscard]] std::string changed_text(std::string text, std::span<const std::string_view> words,
                                       std::mt19937& random);

/// As LLVMFuzzerCustomMutator: mostly changed_text, sometimes bytes.
std::size_t mutate_text(char* data, std::size_t size, std::size_t most, unsigned seed,
                        std::span<const std::string_view> words);

}  // namespace firstcontact::test
