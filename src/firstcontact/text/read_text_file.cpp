#include <firstcontact/text/read_text_file.h>

#include <fstream>
#include <iterator>

#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {

std::string read_text_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw ParseError(path.string(), "cannot be opened");
  }
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) {
    throw ParseError(path.string(), "cannot be read");
  }
  return text;
}

}  // namespace firstcontact::detail
