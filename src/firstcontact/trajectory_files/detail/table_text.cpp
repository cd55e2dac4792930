#include <firstcontact/trajectory_files/detail/table_text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>
#include <utility>

#include <firstcontact/text/ascii.h>
#include <firstcontact/text/read_double.h>

namespace firstcontact::detail {
namespace {

/// The end of the first field of the text: a separator that is not in quotes.
std::size_t end_of_field(std::string_view text, char separator) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
  std::size_t from = 0;
  if (begin < text.size() && text[begin] == '"' && text[begin] != separator) {
    std::size_t closed = text.find('"', begin + 1);
    while (closed != std::string_view::npos && text.substr(closed + 1).starts_with('"')) {
      closed = text.find('"', closed + 2);  // Two of them are one in the field.
    }
    from = closed == std::string_view::npos ? 0 : closed + 1;
  }
  const std::size_t end =
      separator == ' ' ? text.find_first_of(" \t", from) : text.find(separator, from);
  return std::min(end, text.size());
}

/// The text of a field: without quotes around it, and with one for each two in it.
std::string without_quotes(std::string_view field) {
  const bool quoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
  if (!quoted) {
    return std::string(field);
  }
  std::string text(trimmed(field.substr(1, field.size() - 2)));
  for (std::size_t at = text.find("\"\""); at != std::string::npos;
       at = text.find("\"\"", at + 1)) {
    text.erase(at, 1);
  }
  return text;
}

/// The header of a line, if one of its fields is the time.
std::optional<TableHeader> header_of(std::string_view text, std::size_t line,
                                     std::optional<char> separator,
                                     const std::function<bool(std::string_view)>& is_time) {
  for (const char tried : {',', ';', '\t', ' '}) {
    if (separator && *separator != tried) {
      continue;
    }
    TableHeader header{.line = line, .separator = tried, .fields = table_fields(text, tried)};
    if (std::any_of(header.fields.begin(), header.fields.end(), is_time)) {
      return header;
    }
  }
  return std::nullopt;
}

/// The text without the sign of a comment before it.
std::string_view uncommented(std::string_view text) {
  text = trimmed(text);
  return trimmed(text.substr(std::min(text.find_first_not_of("#%"), text.size())));
}

}  // namespace

bool is_comment(const TableLine& line) {
  const std::string_view text = trimmed(line.text);
  return text.starts_with('#') || text.starts_with('%');
}

bool names_separator(const TableLine& line) {
  const std::string_view text = trimmed(line.text);
  return line.text.starts_with("sep=") && (text.size() == 5 || line.text == "sep=\t");
}

std::vector<TableLine> table_lines(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
  }
  std::vector<TableLine> lines;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\n\r"), text.size());
    const bool two = text.substr(end).starts_with("\r\n");
    ++number;
    if (const std::string_view line = text.substr(0, end); !trimmed(line).empty()) {
      lines.push_back({line, number});
    }
    text.remove_prefix(std::min(end + (two ? 2 : 1), text.size()));
  }
  return lines;
}

std::vector<std::string> table_fields(std::string_view line, char separator) {
  if (separator == ' ') {
    line = trimmed(line);
  }
  std::vector<std::string> fields;
  while (true) {
    const std::size_t end = end_of_field(line, separator);
    fields.push_back(without_quotes(trimmed(line.substr(0, end))));
    if (end == line.size()) {
      return fields;
    }
    line.remove_prefix(end + 1);
    if (separator == ' ') {
      line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    }
  }
}

std::optional<double> TableNumbers::read(std::string_view field) {
  if (field.starts_with('+') && !field.starts_with("+-")) {
    field.remove_prefix(1);
  }
  std::string text(field);
  const std::size_t mark = text.find_first_of(".,");
  if (mark != std::string::npos) {
    const char found = text[mark];
    if ((found == ',' && !allows_commas_) || (mark_ && *mark_ != found)) {
      return std::nullopt;
    }
    text[mark] = '.';
    mark_ = found;
  }
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = read_double(text.data(), end, number);
  if (error != std::errc() || stop != end || !std::isfinite(number)) {
    return std::nullopt;
  }
  return number;
}

std::optional<TableHeader> find_header(const std::vector<TableLine>& lines,
                                       const std::function<bool(std::string_view)>& is_time) {
  std::size_t first = 0;
  std::optional<char> separator;
  if (!lines.empty() && names_separator(lines[0])) {
    separator = lines[0].text[4];
    first = 1;
  }
  std::size_t k = first;
  while (k < lines.size() && is_comment(lines[k])) {
    ++k;
  }
  if (k < lines.size()) {
    if (auto header = header_of(lines[k].text, k, separator, is_time)) {
      return header;
    }
  }
  while (k-- > first) {
    if (auto header = header_of(uncommented(lines[k].text), k, separator, is_time)) {
      return header;
    }
  }
  return std::nullopt;
}

}  // namespace firstcontact::detail
