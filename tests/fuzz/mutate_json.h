/// @file
/// Changes JSON text so that most of it stays JSON; a mutation of bytes rarely achieves that.

#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace firstcontact::test {

/// Range of characters of a text.
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Values of a JSON text, and the keys among them; brackets need not match.
struct JsonSpans {
  std::vector<Span> keys;
  std::vector<Span> values;    ///< Scalars, and whole arrays and objects.
  std::vector<Span> elements;  ///< Values with their key, if they have one.
};

inline JsonSpans find_spans(std::string_view text) {
  JsonSpans spans;
  std::vector<std::size_t> open;  // Starts of the elements around this place.
  std::size_t element = std::string_view::npos;
  const auto value = [&](Span span) {
    spans.values.push_back(span);
    spans.elements.push_back({element == std::string_view::npos ? span.begin : element, span.end});
    element = std::string_view::npos;
  };
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    std::size_t end = i + 1;
    if (c == '"') {
      while (end < text.size() && text[end] != '"') {
        end += text[end] == '\\' ? 2 : 1;
      }
      end = std::min(end + 1, text.size());
      if (end < text.size() && text[end] == ':') {
        spans.keys.push_back({i, end});
        element = i;
        ++end;
      } else {
        value({i, end});
      }
    } else if (c == '{' || c == '[') {
      open.push_back(element);
      open.push_back(i);
      element = std::string_view::npos;
    } else if ((c == '}' || c == ']') && !open.empty()) {
      const std::size_t begin = open.back();
      open.pop_back();
      element = open.back();
      open.pop_back();
      value({begin, end});
    } else if (c != ',' && c != ':' && c != ' ' && c != '}' && c != ']') {
      end = std::min(text.find_first_of(",:]} ", i), text.size());
      value({i, std::max(end, i + 1)});
      end = std::max(end, i + 1);
    }
    i = end;
  }
  return spans;
}

/// Makes one change: of a number, a key or a value, or it drops, repeats or swaps an element.
///
/// @param words  keys and names that have a meaning in the format
inline std::string mutate_json(std::string text, const std::vector<std::string_view>& words,
                               std::mt19937& random) {
  static const std::vector<std::string_view> numbers = {"0",
                                                        "1",
                                                        "2",
                                                        "3",
                                                        "-1",
                                                        "0.5",
                                                        "7",
                                                        "255",
                                                        "256",
                                                        "5121",
                                                        "5123",
                                                        "5126",
                                                        "65535",
                                                        "4294967295",
                                                        "1e308",
                                                        "-0",
                                                        "36",
                                                        "96",
                                                        "1e-300",
                                                        "9007199254740992",
                                                        "18446744073709551616",
                                                        "\"VEC3\"",
                                                        "\"VEC4\"",
                                                        "\"MAT4\"",
                                                        "[]",
                                                        "{}",
                                                        "true",
                                                        "null"};
  const JsonSpans spans = find_spans(text);
  const auto pick = [&](const auto& from) { return from[random() % from.size()]; };
  const auto put = [&](Span where, std::string_view what) {
    return text.replace(where.begin, where.end - where.begin, what);
  };
  if (spans.keys.empty() || spans.values.empty()) {
    return std::string(pick(numbers));
  }
  const Span one = pick(spans.elements);
  const Span other = pick(spans.elements);
  const auto part = [&](Span span) { return text.substr(span.begin, span.end - span.begin); };
  switch (random() % 7) {
    case 0:
      return put(pick(spans.keys), "\"" + std::string(pick(words)) + "\"");
    case 1:
      return put(pick(spans.values), pick(numbers));
    case 2:
      return put(pick(spans.values), part(pick(spans.values)));
    case 3: {
      const bool has_comma = one.end < text.size() && text[one.end] == ',';
      return put({one.begin, one.end + (has_comma ? 1 : 0)}, "");
    }
    case 4:
      return put({one.end, one.end}, "," + part(one));
    case 5: {
      if (one.end > other.begin) {
        return put(other, part(one));
      }
      const std::string first = part(one);
      const std::string second = part(other);
      put(other, first);
      return put(one, second);
    }
    default:
      return put({one.end, one.end},
                 ",\"" + std::string(pick(words)) + "\":" + part(pick(spans.values)));
  }
}

}  // namespace firstcontact::test
