#include "command_line_file.h"

#include <stdexcept>

namespace firstcontact::app {

CLI::Option* add_file(CLI::App& command, const std::string& names, std::string& file,
                      const std::string& description) {
  const auto take = [&file, name = names.substr(0, names.find(','))](const std::string& text) {
    if (text.empty()) {
      throw std::invalid_argument(name + " expects a file, got an empty name");
    }
    file = text;
  };
  return command.add_option_function<std::string>(names, take, description)->type_name("FILE");
}

}  // namespace firstcontact::app
