#include <firstcontact/text/word_reader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include <firstcontact/text/ascii.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_double.h>

namespace firstcontact::detail {
namespace {

constexpr double kGreatestNumber = 1e9;
constexpr std::size_t kShownCharacters = 40;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f'; }

/// A word in quotes; characters that cannot be shown become dots.
std::string shown(std::string_view word) {
  if (word.empty()) {
    return "the end";
  }
  std::string text(word.substr(0, kShownCharacters));
  for (char& c : text) {
    c = c > ' ' && c <= '~' ? c : '.';
  }
  return "'" + text + (word.size() > kShownCharacters ? "...'" : "'");
}

std::from_chars_result read_number(const char* begin, const char* end, double& value) {
  return read_double(begin, end, value);
}

std::from_chars_result read_number(const char* begin, const char* end, std::size_t& value) {
  return std::from_chars(begin, end, value);
}

/// Whether all of a word is a number.
template <class T>
bool parse(std::string_view word, T& value) {
  if (!word.empty() && word.front() == '+') {
    word.remove_prefix(1);
    if (!word.empty() && word.front() == '-') {
      return false;
    }
  }
  const char* end = word.data() + word.size();
  const auto [read_to, error] = read_number(word.data(), end, value);
  return error == std::errc() && read_to == end;
}

}  // namespace

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

WordReader::WordReader(std::string_view text, std::string source, std::string_view separators)
    : text_(text), source_(std::move(source)), separators_(separators) {
  advance();
}

void WordReader::advance() {
  const auto separates = [&](char c) {
    return is_space(c) || separators_.find(c) != std::string_view::npos;
  };
  while (at_ < text_.size()) {
    if (text_[at_] == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else if (!separates(text_[at_])) {
      break;
    } else {
      line_ += text_[at_] == '\n' ? 1 : 0;
      ++at_;
    }
  }
  const std::size_t begin = at_;
  while (at_ < text_.size() && !separates(text_[at_]) && text_[at_] != '#') {
    ++at_;
  }
  word_ = text_.substr(begin, at_ - begin);
}

std::string_view WordReader::word(const std::string& what) {
  if (at_end()) {
    fail_expected(what);
  }
  const std::string_view taken = word_;
  taken_line_ = line_;
  advance();
  return taken;
}

void WordReader::expect(std::string_view word) {
  if (!same_word(word_, word)) {
    fail_expected("'" + std::string(word) + "'");
  }
  (void)this->word("");
}

double WordReader::number(const std::string& what) {
  double value = 0.0;
  if (!parse(word_, value) || !(std::abs(value) <= kGreatestNumber)) {
    fail_expected(what + ", a number within 1e9");
  }
  (void)word(what);
  return value;
}

std::size_t WordReader::count(const std::string& what) {
  std::size_t value = 0;
  if (!parse(word_, value)) {
    fail_expected(what + ", a whole number");
  }
  (void)word(what);
  return value;
}

Eigen::Vector3d WordReader::vector(const std::string& what) {
  Eigen::Vector3d v;
  for (double& component : v) {
    component = number(what);
  }
  return v;
}

void WordReader::fail_expected(const std::string& what) const {
  throw ParseError(source_, line_, "expected " + what + ", got " + shown(word_));
}

void WordReader::fail(const std::string& message) const {
  throw ParseError(source_, taken_line_, message);
}

}  // namespace firstcontact::detail
