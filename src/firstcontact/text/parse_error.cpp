#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

// Makes one line of a text, as promised, even where a name has a line break in it.
std::string in_one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') {
      c = ' ';
    }
  }
  return text;
}

std::string numbered(const char* place, std::size_t number) {
  std::string text = place;
  text += std::to_string(number);
  return text;
}

}  // namespace

ParseError::ParseError(const std::string& path, const std::string& place,
                       const std::string& message)
    : std::runtime_error(in_one_line(path + place + ": " + message)),
      path_(path),
      message_(in_one_line(message)) {}

ParseError::ParseError(const std::string& path, const std::string& message)
    : ParseError(path, std::string(), message) {}

ParseError::ParseError(const std::string& path, std::size_t line, const std::string& message)
    : ParseError(path, numbered(":", line), message) {
  line_ = line;
}

ParseError ParseError::at_byte(const std::string& path, std::size_t offset,
                               const std::string& message) {
  ParseError error(path, numbered(": byte ", offset), message);
  error.offset_ = offset;
  return error;
}

}  // namespace firstcontact
