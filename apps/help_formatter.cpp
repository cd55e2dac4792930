#include "help_formatter.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>

#include <fmt/core.h>
#include <fmt/format.h>

namespace firstcontact::app {
namespace {

/// The names of options in alphabetical order, as a set of options has that of their addresses.
std::string names_of(const std::set<CLI::Option*>& options) {
  std::set<std::string> names;
  for (const CLI::Option* option : options) {
    names.insert(option->get_name());
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The value of an option: "FILE", "N", or its words as "stop|blend"; empty for an option without
/// one.
std::string value_name(const CLI::Option& option) {
  const std::string type = option.get_type_name();  // With checks: "TEXT:{stop,blend}".
  const std::size_t colon = type.find(':');
  std::string name = type.substr(0, colon);
  if (colon != std::string::npos && type[colon + 1] == '{') {
    name = type.substr(colon + 2, type.size() - colon - 3);
    std::ranges::replace(name, ',', '|');
  } else if (name == "INT" || name == "UINT") {
    name = "N";
  }
  return option.get_positional() && name == "TEXT" ? "" : name;
}

}  // namespace

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (option->get_type_size() == 0) {
    return {};  // A flag.
  }
  const std::string name = value_name(*option);
  std::string text = name.empty() ? "" : " " + name;
  if (option->get_expected_max() == CLI::detail::expected_max_vector_size) {
    text += " ...";
  }
  return text + (option->get_required() ? " " + get_label("REQUIRED") : "");
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  std::string text = option->get_description();
  if (!option->get_needs().empty()) {
    text += "; with " + names_of(option->get_needs());
  }
  if (!option->get_excludes().empty()) {
    text += "; not with " + names_of(option->get_excludes());
  }
  return text;
}

}  // namespace firstcontact::app
