/// @file
/// Changes texts of lines and words as people and attackers do: whole lines, blocks and words
/// instead of bytes. Most results are therefore nearly correct.

#pragma once

#include <cstddef>
#include <random>
#include <span>
#include <string>
#include <string_view>

namespace firstcontact::test {

/// Changes a text in one to four places.
///
/// Lines and blocks (a line with those below that are indented deeper) are swapped, repeated,
/// dropped and nested. Values are wrapped in up to 12,000 brackets; separators change. A word
/// becomes another word of the text, or one that readers often handle wrongly. Such words are
/// numbers out of range, words of other types, quotes, anchors, aliases and document marks.
///
/// @param words  words of the format, such as its keys
[[nodiscard]] std::string changed_text(std::string text, std::span<const std::string_view> words,
                                       std::mt19937& random);

/// Mutates as LLVMFuzzerCustomMutator: mostly by changed_text, sometimes by bytes.
std::size_t mutate_text(char* data, std::size_t size, std::size_t most, unsigned seed,
                        std::span<const std::string_view> words);

}  // namespace firstcontact::test
