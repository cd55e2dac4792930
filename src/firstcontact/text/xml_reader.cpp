#include <firstcontact/text/xml_reader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include <firstcontact/text/read_double.h>
#include <firstcontact/text/text_cursor.h>
#include <firstcontact/text/xml_encoding.h>

namespace firstcontact::detail {
namespace {

constexpr double kGreatest = 1e60;
constexpr std::string_view kBlanks = " \t\r\n";

std::size_t line_of(const XmlElement& element) {
  return static_cast<std::size_t>(std::max(element.GetLineNum(), 1));
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

/// A finite number of at most 1e60 in size; none for other words.
std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) {
    word.remove_prefix(1);
  }
  double value = 0.0;
  const auto [end, error] = read_double(word.data(), word.data() + word.size(), value);
  const bool complete = error == std::errc() && end == word.data() + word.size();
  return complete && std::abs(value) <= kGreatest ? std::optional(value) : std::nullopt;
}

/// Whether the other element has all attributes of this one, in any order.
bool says_all_of(const XmlElement& element, const XmlElement& other) {
  for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    if (other.Attribute(a->Name(), a->Value()) == nullptr) {
      return false;
    }
  }
  return true;
}

/// Whether the two have equal attributes and hold nothing else.
bool is_repeat(const XmlElement& element, const XmlElement& other) {
  return element.NoChildren() && other.NoChildren() && says_all_of(element, other) &&
         says_all_of(other, element);
}

/// A hint where xacro would replace a word.
const char* hint_of(std::string_view word) {
  return word.find("${") != std::string_view::npos || word.find("$(") != std::string_view::npos
             ? "; run xacro first"
             : "";
}

}  // namespace

void XmlText::append(std::string_view text) {
  if (joined_.empty()) {
    joined_ = whole_;
  }
  joined_ += text;
}

std::string shown(const XmlElement& element) {
  for (const char* const attribute : {"name", "id"}) {
    if (const char* value = element.Attribute(attribute)) {
      return "<" + std::string(element.Name()) + " " + attribute + "=" + detail::quoted(value) +
             ">";
    }
  }
  return "<" + std::string(element.Name()) + ">";
}

XmlReader::XmlReader(std::string_view text, std::string source) : source_(std::move(source)) {
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
    throw ParseError::at_byte(source_, zero, "expected text, got a zero byte");
  }
  const std::string utf8 = utf8_of_xml(text, source_);
  if (document_.Parse(utf8.data(), utf8.size()) == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED) {
    fail_at_line(static_cast<std::size_t>(std::max(document_.ErrorLineNum(), 1)),
                 "expected at most " + std::to_string(TINYXML2_MAX_ELEMENT_DEPTH) +
                     " elements inside of each other, got more");
  }
  if (document_.ErrorID() == tinyxml2::XML_ERROR_PARSING_DECLARATION) {
    fail_at_line(static_cast<std::size_t>(std::max(document_.ErrorLineNum(), 1)),
                 "expected <?xml ...?> before everything else; move it there, or remove it");
  }
  if (document_.Error()) {
    fail_at_line(static_cast<std::size_t>(std::max(document_.ErrorLineNum(), 1)),
                 "expected XML, got " + std::string(document_.ErrorName()));
  }
}

ParseError XmlReader::error(const XmlElement& where, const std::string& message) const {
  return ParseError(source_, line_of(where), shown(where) + ": " + message);
}

void XmlReader::fail(const XmlElement& where, const std::string& message) const {
  throw error(where, message);
}

void XmlReader::fail_at_line(std::size_t line, const std::string& message) const {
  throw ParseError(source_, line, message);
}

const XmlElement& XmlReader::root(const char* name) const {
  const XmlElement* root = document_.RootElement();
  if (root == nullptr) {
    throw ParseError(source_, "expected an element <" + std::string(name) + ">, got none");
  }
  if (std::string_view(root->Name()) != name) {
    const std::string_view found = root->Name();
    const bool is_other = found == "mujoco" || found == "sdf";
    fail(*root, "expected <" + std::string(name) + "> as the outermost element" +
                    (is_other ? ", got " + std::string(found == "sdf" ? "SDF" : "MJCF") +
                                    ", which is not read; convert it to URDF"
                              : ""));
  }
  for (const tinyxml2::XMLNode* node = document_.FirstChild(); node != nullptr;
       node = node->NextSibling()) {
    if (node->ToText() != nullptr || (node->ToElement() != nullptr && node != root)) {
      fail_at_line(static_cast<std::size_t>(std::max(node->GetLineNum(), 1)),
                   "expected one outermost element, <" + std::string(name) + ">, and nothing else");
    }
  }
  return *root;
}

std::vector<const XmlElement*> XmlReader::children(const XmlElement& element,
                                                   const char* name) const {
  std::vector<const XmlElement*> found;
  for (const XmlElement* child = element.FirstChildElement(name); child != nullptr;
       child = child->NextSiblingElement(name)) {
    found.push_back(child);
  }
  return found;
}

const XmlElement* XmlReader::child(const XmlElement& element, const char* name) const {
  const XmlElement* first = element.FirstChildElement(name);
  for (const XmlElement* next = first; next != nullptr; next = next->NextSiblingElement(name)) {
    if (next != first && !is_repeat(*first, *next)) {
      fail(*next, "a second <" + std::string(name) + "> inside " + shown(element) + "; keep one");
    }
  }
  return first;
}

const XmlElement& XmlReader::required_child(const XmlElement& element, const char* name) const {
  const XmlElement* found = child(element, name);
  if (found == nullptr) {
    fail(element, "expected an element <" + std::string(name) + "> inside");
  }
  return *found;
}

std::string XmlReader::text(const XmlElement& element, const char* attribute) const {
  const char* value = element.Attribute(attribute);
  if (value == nullptr || *value == '\0') {
    fail(element, "expected an attribute '" + std::string(attribute) + "' that is not empty");
  }
  return value;
}

std::vector<double> XmlReader::numbers(const XmlElement& element, const char* attribute) const {
  const std::string all = text(element, attribute);
  std::vector<double> values;
  std::string_view rest = all;
  while (true) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    if (rest.empty()) {
      return values;
    }
    const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
    const std::optional<double> value = parse_number(word);
    if (!value) {
      fail(element, "expected finite numbers of at most 1e60 in size in '" +
                        std::string(attribute) + "', got " + detail::quoted(word) + hint_of(word));
    }
    values.push_back(*value);
    rest.remove_prefix(word.size());
  }
}

double XmlReader::number(const XmlElement& element, const char* attribute) const {
  const std::vector<double> values = numbers(element, attribute);
  if (values.size() != 1) {
    fail(element, "expected one number in '" + std::string(attribute) + "', got " +
                      std::to_string(values.size()));
  }
  return values.front();
}

std::optional<double> XmlReader::optional_number(const XmlElement& element,
                                                 const char* attribute) const {
  return element.Attribute(attribute) != nullptr ? std::optional(number(element, attribute))
                                                 : std::nullopt;
}

double XmlReader::positive(const XmlElement& element, const char* attribute) const {
  const double value = number(element, attribute);
  if (!(value > 0.0)) {
    fail(element, "expected '" + std::string(attribute) + "' to be > 0");
  }
  return value;
}

Eigen::Vector3d XmlReader::vector3(const XmlElement& element, const char* attribute) const {
  const std::vector<double> values = numbers(element, attribute);
  if (values.size() != 3) {
    fail(element, "expected three numbers in '" + std::string(attribute) + "', got " +
                      std::to_string(values.size()));
  }
  return {values[0], values[1], values[2]};
}

XmlText XmlReader::content(const XmlElement& element) const {
  XmlText all({}, line_of(element));
  bool empty = true;
  for (const tinyxml2::XMLNode* node = element.FirstChild(); node != nullptr;
       node = node->NextSibling()) {
    if (node->ToElement() != nullptr) {
      fail(*node->ToElement(), "expected text alone inside " + shown(element));
    }
    if (node->ToText() != nullptr && empty) {
      all = XmlText(node->Value(), static_cast<std::size_t>(std::max(node->GetLineNum(), 1)));
      empty = false;
    } else if (node->ToText() != nullptr) {
      all.append(node->Value());
    }
  }
  return all;
}

std::uint64_t XmlReader::whole_number(const XmlElement& element, const char* attribute,
                                      std::optional<std::uint64_t> missing) const {
  if (element.Attribute(attribute) == nullptr && missing) {
    return *missing;
  }
  const std::string all = text(element, attribute);
  const std::string_view word = without_blanks(all);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) {
    fail(element, "expected a whole number >= 0 in '" + std::string(attribute) + "', got " +
                      detail::quoted(word));
  }
  return value;
}

}  // namespace firstcontact::detail
