#include <firstcontact/text/read_file.h>

#include <fstream>
#include <iterator>
#include <system_error>

#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {

std::string read_file(const std::filesystem::path& path, const std::string& what) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw ParseError(path.string(), "expected " + what + ", got a folder");
  }
  if (!std::filesystem::exists(path, error)) {
    throw ParseError(path.string(), "expected " + what + ", found none");
  }
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) {
    throw ParseError(path.string(), "expected " + what + ", cannot open this one");
  }
  return text;
}

}  // namespace firstcontact::detail
