#include "command_line_file.h"

#include <stdexcept>

namespace firstcontact::app {
namespace {

/// Requires a name of a file.
///
/// @param names  of the option; the error has the first
void require_name(const std::string& names, const std::string& file) {
  if (file.empty()) {
    throw std::invalid_argument(names.substr(0, names.find(',')) +
                                " expects a file, got an empty name");
  }
}

}  // namespace

CLI::Option* add_file(CLI::App& command, const std::string& names, std::string& file,
                      const std::string& description) {
  const auto take = [&file, names](const std::string& text) {
    require_name(names, text);
    file = text;
  };
  return command.add_option_function<std::string>(names, take, description)->type_name("FILE");
}

CLI::Option* add_files(CLI::App& command, const std::string& names, std::vector<std::string>& files,
                       const std::string& description) {
  const auto take = [&files, names](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      require_name(names, text);
    }
    files = texts;
  };
  return command.add_option_function<std::vector<std::string>>(names, take, description)
      ->expected(1)
      ->type_name("FILE")
      ->take_all();
}

}  // namespace firstcontact::app
