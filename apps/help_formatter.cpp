#include "help_formatter.h"

#include <set>
#include <string>

#include <fmt/core.h>
#include <fmt/format.h>

namespace firstcontact::app {
namespace {

/// In the order of their names, as sets of options are in that of their addresses.
std::string names_of(const std::set<CLI::Option*>& options) {
  std::set<std::string> names;
  for (const CLI::Option* option : options) {
    names.insert(option->get_name());
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (option->get_type_size() == 0) {
    return {};  // A flag.
  }
  std::string text = option->get_type_name().empty() ? "" : " " + option->get_type_name();
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
