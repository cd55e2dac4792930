#include <firstcontact/model_files/detail/dae_source.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <firstcontact/text/read_double.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact::detail {
namespace {

/// The layout of rows in an array.
struct Accessor {
  const XmlElement* element = nullptr;
  const XmlElement* array = nullptr;
  std::uint64_t rows = 0;
  std::uint64_t offset = 0;
  std::uint64_t stride = 1;
  std::vector<std::string_view> parameters;  ///< Their names; empty where they have none.
};

Accessor read_accessor(const DaeDocument& document, const XmlElement& source) {
  const XmlReader& xml = document.xml();
  document.check_children(source, {"technique_common", "float_array", "int_array", "Name_array",
                                   "IDREF_array", "SIDREF_array", "bool_array", "token_array"});
  const XmlElement& common = xml.required_child(source, "technique_common");
  document.check_children(common, {"accessor"});
  Accessor accessor;
  accessor.element = &xml.required_child(common, "accessor");
  const XmlElement& element = *accessor.element;
  document.check_attributes(element, {"source", "count", "offset", "stride", "id", "name"});
  document.check_children(element, {"param"});
  accessor.array = &document.find_in(source, element, "source", "array");
  accessor.rows = xml.whole_number(element, "count");
  accessor.offset = xml.whole_number(element, "offset", 0);
  accessor.stride = xml.whole_number(element, "stride", 1);
  for (const XmlElement* parameter : xml.children(element, "param")) {
    const char* const name = parameter->Attribute("name");
    accessor.parameters.emplace_back(name == nullptr ? "" : name);
  }
  return accessor;
}

/// Refuses rows that go past the array, or into each other.
///
/// @param used  values that a row takes
/// @param held  values of the array
void check_rows(const DaeDocument& document, const Accessor& accessor, std::uint64_t used,
                std::uint64_t held) {
  used = std::max<std::uint64_t>(used, accessor.parameters.size());
  if (accessor.rows > 0 && accessor.stride < used) {
    document.fail(*accessor.element, "expected a stride of at least " + std::to_string(used) +
                                         ", got " + std::to_string(accessor.stride));
  }
  // Each factor is bounded first: the product cannot overflow.
  const bool fits = accessor.rows == 0 ||
                    (accessor.rows <= held && accessor.stride <= held && accessor.offset <= held &&
                     held - accessor.offset >= used &&
                     (accessor.rows - 1) <= (held - accessor.offset - used) / accessor.stride);
  if (!fits) {
    document.fail(*accessor.element, "expected rows within the array, which holds " +
                                         std::to_string(held) + " values");
  }
}

void check_count(const DaeDocument& document, const XmlElement& array, std::uint64_t held) {
  const std::uint64_t count = document.xml().whole_number(array, "count");
  if (count != held) {
    document.refuse(array,
                    "expected " + std::to_string(count) + " values as its count says, got " +
                        std::to_string(held),
                    "the count of an array");
  }
}

/// Parses a number; NaN for the words that writers have for numbers that are not finite.
std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) {
    word.remove_prefix(1);
  }
  const char* const end = word.data() + word.size();
  double value = 0.0;
  auto [stop, error] = read_double(word.data(), end, value);
  if (error == std::errc::result_out_of_range) {
    value = HUGE_VAL;
    error = {};
  }
  if (error == std::errc() && stop != end && *stop == '#') {
    return std::numeric_limits<double>::quiet_NaN();  // "-1.#IND", "1.#QNAN", "1.#INF"
  }
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

std::vector<double> read_array(const DaeDocument& document, const XmlElement& array) {
  const std::string_view name = array.Name();
  if (name != "float_array" && name != "int_array") {
    document.fail(array, "expected a <float_array> of coordinates");
  }
  const XmlText text = document.xml().content(array);
  std::vector<double> values;
  const std::uint64_t count = document.xml().whole_number(array, "count");
  values.reserve(std::min<std::uint64_t>(count, text.view().size() / 2 + 1));
  TextCursor cursor(text.view(), document.xml().source(), {}, text.line());
  while (cursor.find_line()) {
    const std::string_view word = cursor.word();
    const std::optional<double> value = parse_number(word);
    if (!value) {
      cursor.fail("expected a number in <" + std::string(name) + ">, got " + detail::quoted(word));
    }
    values.push_back(*value);
  }
  check_count(document, array, values.size());
  return values;
}

/// Finds the positions of X, Y and Z in a row.
std::array<std::size_t, 3> places_of_axes(const DaeDocument& document, const Accessor& accessor) {
  const auto& names = accessor.parameters;
  if (std::all_of(names.begin(), names.end(), [](std::string_view n) { return n.empty(); })) {
    if (!names.empty() && names.size() < 3) {
      document.fail(*accessor.element, "expected three parameters, X, Y and Z");
    }
    return {0, 1, 2};
  }
  std::array<std::size_t, 3> places{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string_view name = std::string_view("XYZ").substr(axis, 1);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end() || std::find(found + 1, names.end(), name) != names.end()) {
      document.fail(*accessor.element, "expected one parameter " + detail::quoted(name) +
                                           " of positions, next to X, Y and Z");
    }
    places[axis] = static_cast<std::size_t>(found - names.begin());
  }
  return places;
}

}  // namespace

std::vector<Eigen::Vector3d> read_dae_points(const DaeDocument& document,
                                             const XmlElement& source) {
  const Accessor accessor = read_accessor(document, source);
  const std::array<std::size_t, 3> axes = places_of_axes(document, accessor);
  const std::vector<double> values = read_array(document, *accessor.array);
  check_rows(document, accessor, std::max({axes[0], axes[1], axes[2]}) + 1, values.size());
  std::vector<Eigen::Vector3d> points;
  points.reserve(accessor.rows);
  for (std::uint64_t row = 0; row < accessor.rows; ++row) {
    const double* const at = values.data() + accessor.offset + row * accessor.stride;
    points.emplace_back(at[axes[0]], at[axes[1]], at[axes[2]]);
  }
  return points;
}

std::vector<double> read_dae_numbers(const DaeDocument& document, const XmlElement& source,
                                     std::size_t width) {
  const Accessor accessor = read_accessor(document, source);
  const std::vector<double> values = read_array(document, *accessor.array);
  check_rows(document, accessor, width, values.size());
  std::vector<double> taken;
  taken.reserve(accessor.rows * width);
  for (std::uint64_t row = 0; row < accessor.rows; ++row) {
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(accessor.offset + row * accessor.stride);
    taken.insert(taken.end(), at, at + static_cast<std::ptrdiff_t>(width));
  }
  return taken;
}

DaeNames read_dae_names(const DaeDocument& document, const XmlElement& source) {
  const Accessor accessor = read_accessor(document, source);
  const std::string_view kind = accessor.array->Name();
  if (kind != "Name_array" && kind != "IDREF_array" && kind != "SIDREF_array") {
    document.fail(*accessor.array, "expected a <Name_array> or <IDREF_array>");
  }
  const XmlText text = document.xml().content(*accessor.array);
  std::vector<std::string> words;
  TextCursor cursor(text.view(), document.xml().source(), {}, text.line());
  while (cursor.find_line()) {
    words.emplace_back(cursor.word());
  }
  check_count(document, *accessor.array, words.size());
  check_rows(document, accessor, 1, words.size());
  DaeNames result;
  result.ids = kind == "IDREF_array";
  for (std::uint64_t row = 0; row < accessor.rows; ++row) {
    result.names.push_back(std::move(words[accessor.offset + row * accessor.stride]));
  }
  return result;
}

}  // namespace firstcontact::detail
