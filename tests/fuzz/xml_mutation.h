/// @file
/// Changes XML documents as a careless writer would: whole elements, references, numbers.

#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace firstcontact::test {

/// One change of a document, by chance.
class XmlMutation {
 public:
  XmlMutation(std::string text, unsigned seed) : text_(std::move(text)), random_(seed) { split(); }

  [[nodiscard]] std::string changed() {
    if (tokens_.empty()) {
      return text_;
    }
    switch (below(8)) {
      case 0:
        return without(any_element());
      case 1:
        return repeated(any_element());
      case 2:
        return swapped(any_element(), any_element());
      case 3:
        return nested(any_element());
      case 4:
        return with_value_of_another();
      case 5:
        return with_other_name();
      default:
        return with_other_number();
    }
  }

 private:
  /// A piece of the text.
  struct Span {
    std::size_t begin = 0;
    std::size_t end = 0;
  };

  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  void split() {
    std::size_t at = text_.find('<');
    while (at != std::string::npos) {
      const std::size_t end = std::min(text_.find('>', at), text_.size() - 1) + 1;
      tokens_.push_back({at, end});
      at = text_.find('<', end);
    }
  }

  [[nodiscard]] std::string_view of(Span span) const {
    return std::string_view(text_).substr(span.begin, span.end - span.begin);
  }

  /// From a tag to the one that closes it.
  Span any_element() {
    std::size_t first = below(tokens_.size());
    while (first > 0 && of(tokens_[first]).starts_with("</")) {
      --first;
    }
    int depth = 0;
    for (std::size_t i = first; i < tokens_.size(); ++i) {
      const std::string_view tag = of(tokens_[i]);
      depth += tag.starts_with("</") ? -1 : tag.ends_with("/>") || tag.starts_with("<?") ? 0 : 1;
      if (depth <= 0) {
        return {tokens_[first].begin, tokens_[i].end};
      }
    }
    return tokens_[first];
  }

  [[nodiscard]] std::string with(Span span, std::string_view other) const {
    return text_.substr(0, span.begin) + std::string(other) + text_.substr(span.end);
  }

  [[nodiscard]] std::string without(Span span) const { return with(span, ""); }

  std::string repeated(Span span) {
    std::string copies;
    for (std::size_t i = below(4) + 2; i > 0 && copies.size() < 10'000; --i) {
      copies += of(span);
    }
    return with(span, copies);
  }

  [[nodiscard]] std::string swapped(Span a, Span b) const {
    if (a.begin > b.begin) {
      std::swap(a, b);
    }
    if (a.end > b.begin) {
      return with(a, of(b));
    }
    return text_.substr(0, a.begin) + std::string(of(b)) + text_.substr(a.end, b.begin - a.end) +
           std::string(of(a)) + text_.substr(b.end);
  }

  /// An element inside of a copy of its own tag, once or many times.
  std::string nested(Span span) {
    const std::string_view whole = of(span);
    const std::string_view tag = whole.substr(0, whole.find('>') + 1);
    if (tag.ends_with("/>") || tag.size() < 3) {
      return text_;
    }
    const std::string name(tag.substr(1, std::min(tag.find_first_of(" \n\t>"), tag.size()) - 1));
    std::string inside(whole);
    for (std::size_t i = below(3) == 0 ? 120 : 1; i > 0; --i) {
      inside = std::string(tag) + inside + "</" + name + ">";
      if (inside.size() > 20'000) {
        break;
      }
    }
    return with(span, inside);
  }

  /// What stands between quotes.
  [[nodiscard]] std::vector<Span> values() const {
    std::vector<Span> found;
    for (const Span& token : tokens_) {
      std::size_t at = text_.find_first_of("'\"", token.begin);
      while (at < token.end) {
        const std::size_t end = text_.find(text_[at], at + 1);
        if (end >= token.end) {
          break;
        }
        found.push_back({at + 1, end});
        at = text_.find_first_of("'\"", end + 1);
      }
    }
    return found;
  }

  std::string with_value_of_another() {
    const std::vector<Span> all = values();
    if (all.empty()) {
      return text_;
    }
    const std::string_view other = of(all[below(all.size())]);
    const Span span = all[below(all.size())];
    const bool reference = of(span).starts_with('#') && !other.starts_with('#');
    return with(span, (reference ? "#" : "") + std::string(other));
  }

  /// A tag with the name of another: opening and closing ones no longer fit, unless it is empty.
  std::string with_other_name() {
    const Span span = any_element();
    const Span other = tokens_[below(tokens_.size())];
    const auto name = [this](Span tag) {
      const std::size_t end = text_.find_first_of(" \n\t/>", tag.begin + 2);
      return Span{tag.begin + 1, std::min(end, text_.size())};
    };
    std::string_view whole = of(span);
    const std::string old(of(name(span)));
    const std::string next(of(name(other)));
    std::string result = "<" + next + std::string(whole.substr(1 + old.size()));
    if (result.ends_with("</" + old + ">")) {
      result.resize(result.size() - old.size() - 1);
      result += next + ">";
    }
    return with(span, result);
  }

  std::string with_other_number() {
    static const std::vector<std::string> kNumbers = {
        "0",     "-1",         "1",          "2",
        "3",     "4294967295", "4294967296", "18446744073709551615",
        "1e308", "1e-320",     "1e999",      "NaN",
        "INF",   "-1.#IND",    "0.5",        "",
        "90",    "1e17",       "99999999"};
    std::vector<Span> numbers;
    constexpr std::string_view kDigits = "0123456789.-+e";
    std::size_t at = text_.find_first_of("0123456789");
    while (at != std::string::npos) {
      const std::size_t end = std::min(text_.find_first_not_of(kDigits, at), text_.size());
      numbers.push_back({at, end});
      at = text_.find_first_of("0123456789", end);
    }
    return numbers.empty() ? text_
                           : with(numbers[below(numbers.size())], kNumbers[below(kNumbers.size())]);
  }

  std::string text_;
  std::mt19937 random_;
  std::vector<Span> tokens_;
};

}  // namespace firstcontact::test
