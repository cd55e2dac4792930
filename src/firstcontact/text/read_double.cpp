#include <firstcontact/text/read_double.h>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace firstcontact::detail {
namespace {

/// The exponent of "", "e5", "E+5", "e-5"; infinite where it fits no double.
double exponent(std::string_view text) {
  if (text.empty()) {
    return 0.0;
  }
  text.remove_prefix(1);
  const bool negative = text.front() == '-';
  text.remove_prefix(negative || text.front() == '+' ? 1 : 0);
  double value = std::numeric_limits<double>::infinity();
  std::from_chars(text.data(), text.data() + text.size(), value);
  return negative ? -value : value;
}

}  // namespace

// The number is so far from 1 that the decimal place of its first digit decides.
bool is_too_small(std::string_view number) {
  const std::size_t mantissa = std::min(number.find_first_of("eE"), number.size());
  const std::size_t point = std::min(number.substr(0, mantissa).find('.'), mantissa);
  const std::size_t first = number.find_first_of("123456789");
  const double place = static_cast<double>(point) - static_cast<double>(first);
  return exponent(number.substr(mantissa)) + place <= 0.0;
}

}  // namespace firstcontact::detail
