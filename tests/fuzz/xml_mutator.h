/// @file
/// Mutations of XML that keep it XML; a fuzzer of bytes breaks nearly every document.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace firstcontact::test {

/// Words of a format.
struct XmlWords {
  std::vector<std::string_view> names;   ///< Names of elements and attributes.
  std::vector<std::string_view> values;  ///< Values of attributes and text.
};

/// Values that are special cases for readers of numbers and of paths.
inline const std::vector<std::string_view>& odd_values() {
  static const std::vector<std::string_view> values{"",
                                                    "0",
                                                    "-1",
                                                    "1e308",
                                                    "1e-320",
                                                    "nan",
                                                    "inf",
                                                    "1,5",
                                                    "1 2",
                                                    "0 0 0",
                                                    "1 2 3",
                                                    "1x",
                                                    "${x}",
                                                    "&amp;",
                                                    "&e;",
                                                    "../../x",
                                                    "\xff",
                                                    "4294967295",
                                                    "18446744073709551616",
                                                    "1 2 3 4"};
  return values;
}

/// Changes one to four places of a text.
///
/// It renames tags; sets, renames and removes attributes; removes, repeats, swaps, moves and nests
/// elements; and puts other numbers into text and attributes.
class XmlMutator {
 public:
  XmlMutator(std::string text, const XmlWords& words, unsigned seed)
      : text_(std::move(text)), words_(words), random_(seed) {}

  std::string mutated() {
    const std::size_t rounds = 1 + below(4);
    for (std::size_t k = 0; k < rounds; ++k) {
      find_elements();
      if (elements_.empty()) {
        return "<" + name() + "/>";
      }
      change();
    }
    return std::move(text_);
  }

 private:
  /// Element [begin, end) with its content; its first tag ends before `open_end`.
  struct Element {
    std::size_t begin;
    std::size_t open_end;
    std::size_t end;
  };

  std::size_t below(std::size_t count) {
    return count == 0 ? 0 : static_cast<std::size_t>(random_()) % count;
  }

  std::string_view one_of(const std::vector<std::string_view>& list) {
    return list.empty() ? std::string_view("x") : list[below(list.size())];
  }

  /// Returns a known name, sometimes misspelt or with a prefix.
  std::string name() {
    std::string result(one_of(words_.names));
    const std::size_t kind = below(12);
    if (kind == 0) {
      result.erase(below(result.size()), 1);
    } else if (kind == 1) {
      result.insert(0, "p:");
    } else if (kind == 2) {
      result.insert(0, "xacro:");
    }
    return result.empty() ? "x" : result;
  }

  std::string value() {
    return std::string(below(2) == 0 ? one_of(words_.values) : one_of(odd_values()));
  }

  void find_elements() {
    constexpr std::size_t kMost = 5000;
    elements_.clear();
    std::vector<std::size_t> open;
    for (std::size_t at = text_.find('<'); at != std::string::npos && elements_.size() < kMost;
         at = text_.find('<', at + 1)) {
      const std::size_t end = text_.find('>', at);
      if (end == std::string::npos) {
        return;
      }
      const char next = text_[at + 1];
      if (next == '/') {
        if (!open.empty()) {
          elements_[open.back()].end = end + 1;
          open.pop_back();
        }
      } else if (next != '?' && next != '!') {
        elements_.push_back({at, end + 1, end + 1});
        if (text_[end - 1] != '/') {
          open.push_back(elements_.size() - 1);
        }
      }
    }
  }

  void change() {
    const Element element = elements_[below(elements_.size())];
    switch (below(11)) {
      case 0:
        return rename(element);
      case 1:
      case 2:
        return change_attribute(element);
      case 3:
        text_.insert(name_end(element), " " + name() + "=\"" + value() + "\"");
        return;
      case 4:
        text_.erase(element.begin, element.end - element.begin);
        return;
      case 5:
        text_.insert(element.begin, text_.substr(element.begin, element.end - element.begin));
        return;
      case 6:
        return copy_into(element, elements_[below(elements_.size())]);
      case 7:
        return put_into(element, "<" + name() + " " + name() + "=\"" + value() + "\"/>" + value());
      case 8:
        return swap(element, elements_[below(elements_.size())]);
      case 9:
        return change_number();
      default:
        return nest(element);
    }
  }

  [[nodiscard]] std::size_t name_end(const Element& element) const {
    const std::size_t end = text_.find_first_of(" \t\r\n/>", element.begin + 1);
    return std::min(end, element.open_end - 1);
  }

  /// Renames both tags of an element, or the only one.
  void rename(const Element& element) {
    const std::string put = name();
    const std::size_t close = text_.rfind("</", element.end - 1);
    if (close != std::string::npos && close >= element.open_end) {
      text_.replace(close + 2, element.end - 1 - (close + 2), put);
    }
    text_.replace(element.begin + 1, name_end(element) - (element.begin + 1), put);
  }

  /// Removes an attribute, renames it, or gives it another value.
  void change_attribute(const Element& element) {
    std::vector<std::size_t> signs;
    for (std::size_t at = text_.find('=', element.begin); at < element.open_end;
         at = text_.find('=', at + 1)) {
      signs.push_back(at);
    }
    if (signs.empty()) {
      return;
    }
    const std::size_t sign = signs[below(signs.size())];
    const std::size_t begin = text_.find_last_of(" \t\r\n", sign) + 1;
    const std::size_t quote = sign + 1 < text_.size() ? sign + 1 : sign;
    const std::size_t end = text_.find(text_[quote], quote + 1);
    if (begin == 0 || end == std::string::npos || end >= element.open_end) {
      return;
    }
    const std::size_t kind = below(4);
    if (kind == 0) {
      text_.erase(begin, end + 1 - begin);
    } else if (kind == 1) {
      text_.replace(begin, sign - begin, name());
    } else {
      text_.replace(quote + 1, end - quote - 1, value());
    }
  }

  void copy_into(const Element& part, const Element& whole) {
    put_into(whole, text_.substr(part.begin, part.end - part.begin));
  }

  void put_into(const Element& element, const std::string& part) {
    if (element.end > element.open_end) {
      text_.insert(element.open_end, part);
    } else {
      text_.insert(element.end, part);
    }
  }

  /// Swaps two elements, neither of which contains the other.
  void swap(Element first, Element second) {
    if (second.begin < first.begin) {
      std::swap(first, second);
    }
    if (second.begin < first.end) {
      return;
    }
    const std::string before = text_.substr(first.begin, first.end - first.begin);
    const std::string after = text_.substr(second.begin, second.end - second.begin);
    text_.replace(second.begin, after.size(), before);
    text_.replace(first.begin, before.size(), after);
  }

  /// Changes the next number after a random place: lists of text hold most of a file's numbers.
  void change_number() {
    const std::size_t begin = text_.find_first_of("0123456789", below(text_.size()));
    if (begin == std::string::npos) {
      return;
    }
    const std::size_t end =
        std::min(text_.find_first_not_of("0123456789.-+e", begin), text_.size());
    text_.replace(begin, end - begin, one_of(odd_values()));
  }

  void nest(const Element& element) {
    const std::string tag = name();
    const std::size_t depth = below(40) == 0 ? 700 : 1 + below(4);
    std::string before;
    std::string after;
    for (std::size_t k = 0; k < depth; ++k) {
      before += "<" + tag + ">";
      after += "</" + tag + ">";
    }
    text_.insert(element.end, after);
    text_.insert(element.begin, before);
  }

  std::string text_;
  const XmlWords& words_;
  std::minstd_rand random_;
  std::vector<Element> elements_;
};

/// Changes `size` bytes in place, to at most `greatest`, as LLVMFuzzerCustomMutator requires.
///
/// One in four is left to the fuzzer's own mutations of bytes.
///
/// @returns the new number of bytes
template <class MutateBytes>
std::size_t mutate_xml(std::uint8_t* data, std::size_t size, std::size_t greatest, unsigned seed,
                       const XmlWords& words, const MutateBytes& mutate_bytes) {
  if (seed % 4 == 0) {
    return mutate_bytes(data, size, greatest);
  }
  const std::string text =
      XmlMutator({reinterpret_cast<const char*>(data), size}, words, seed).mutated();
  if (text.size() > greatest) {
    return mutate_bytes(data, size, greatest);
  }
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

}  // namespace firstcontact::test
