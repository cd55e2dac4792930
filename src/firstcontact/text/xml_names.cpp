#include <firstcontact/text/xml_names.h>

#include <algorithm>
#include <cstddef>

#include <firstcontact/text/ascii.h>
#include <firstcontact/text/edit_distance.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact::detail {
namespace {

bool holds(const std::vector<std::string_view>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const HarmlessName* find(const std::vector<HarmlessName>& names, std::string_view name) {
  const auto found = std::find_if(names.begin(), names.end(),
                                  [&](const HarmlessName& known) { return known.name == name; });
  return found == names.end() ? nullptr : &*found;
}

std::string listed(const std::vector<std::string_view>& names) {
  std::string text;
  for (const std::string_view name : names) {
    text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return names.empty() ? "none" : text;
}

/// A name in angle brackets, cut short.
std::string tag(std::string_view name) {
  constexpr std::size_t kLongest = 60;
  return "<" + std::string(name.substr(0, kLongest)) + (name.size() > kLongest ? "...>" : ">");
}

/// Number of changed letters beyond which a name is another word.
std::size_t most_changes(std::string_view name) { return name.size() < 8 ? 1 : 2; }

bool is_prefixed(std::string_view name) { return name.find(':') != std::string_view::npos; }

std::string_view without_prefix(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

bool is_xacro(std::string_view name) { return name.starts_with("xacro:"); }

/// Whether an attribute is one of XML itself.
bool is_declaration(std::string_view attribute) {
  return attribute == "xmlns" || attribute.starts_with("xmlns:") || attribute.starts_with("xml:") ||
         attribute.starts_with("xsi:");
}

/// Whether a text has an "&name;" that XML itself does not define; tinyxml2 leaves it unchanged.
bool has_entity(std::string_view text) {
  const std::size_t begin = text.find('&');
  return begin != std::string_view::npos && text.find(';', begin) != std::string_view::npos;
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

}  // namespace

std::string_view misspelt_name(std::string_view name, const XmlNames& known) {
  constexpr std::size_t kLongest = 60;  // The search is quadratic.
  if (name.size() > kLongest) {
    return {};
  }
  const std::string word = lower(name);
  std::string_view nearest;
  std::size_t least = kLongest;
  const auto look_at = [&](std::string_view candidate, bool is_read) {
    const std::size_t changes = edit_distance(word, lower(candidate));
    if (changes < least && changes <= most_changes(candidate) && changes + 1 < candidate.size()) {
      least = changes;
      nearest = is_read ? candidate : std::string_view();
    }
  };
  for (const HarmlessName& harmless : known.harmless) {
    look_at(harmless.name, false);
  }
  for (const std::string_view read : known.read) {
    look_at(read, true);
  }
  return nearest;
}

void XmlNameCheck::check(const XmlElement& element, const XmlContents& known) const {
  check_attributes(element, known.attributes);
  check_children(element, known.children);
  check_text(element);
}

void XmlNameCheck::check_attributes(const XmlElement& element, const XmlNames& known) const {
  for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const std::string_view name = a->Name();
    if (holds(known.read, name) || is_declaration(name)) {
      continue;
    }
    const std::string shown_name = detail::quoted(name) + " of " + tag(element.Name());
    if (const HarmlessName* harmless = find(known.harmless, name)) {
      log_.leave_out(shown_name, harmless->reason);
    } else if (is_prefixed(name)) {
      log_.leave_out(shown_name, "another program's");
    } else if (const std::string_view near = misspelt_name(name, known); !near.empty()) {
      log_.refuse(xml_.error(element, "unknown attribute " + detail::quoted(name) +
                                          "; did you mean '" + std::string(near) + "'?"));
    } else if (known.is_strict) {
      log_.refuse(xml_.error(element, "unknown attribute " + detail::quoted(name) +
                                          "; known are: " + listed(known.read)));
    } else {
      log_.warn(xml_.error(element, "unknown attribute " + detail::quoted(name) + " is left out"),
                "attribute " + shown_name);
    }
  }
}

void XmlNameCheck::check_children(const XmlElement& element, const XmlNames& known) const {
  for (const XmlElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string_view name = child->Name();
    if (holds(known.read, name)) {
      continue;
    }
    if (const HarmlessName* harmless = find(known.harmless, name)) {
      log_.leave_out(tag(name), harmless->reason);
    } else {
      check_stranger(*child, element, known);
    }
  }
}

void XmlNameCheck::check_stranger(const XmlElement& stranger, const XmlElement& parent,
                                  const XmlNames& known) const {
  const std::string_view name = stranger.Name();
  const auto refuse = [&](const std::string& message) {
    log_.refuse(xml_.error(stranger, message));
  };
  if (is_xacro(name)) {
    log_.refuse(xml_.error(stranger, "xacro is not expanded; run xacro first"), "xacro");
  } else if (tells(stranger)) {
    refuse("not known inside " + shown(parent) + "; known are: " + listed(known.read));
  } else if (is_prefixed(name)) {
    log_.leave_out(tag(name), "another program's");
  } else if (const std::string_view near = misspelt_name(name, known); !near.empty()) {
    refuse("not known inside " + shown(parent) + "; did you mean " + tag(near) + "?");
  } else if (const XmlElement* part = telling_part(stranger)) {
    refuse("not known inside " + shown(parent) + ", and it holds " + shown(*part) +
           "; known are: " + listed(known.read));
  } else if (known.is_strict) {
    refuse("not known inside " + shown(parent) + "; known are: " + listed(known.read));
  } else {
    log_.warn(xml_.error(stranger, "not known inside " + tag(parent.Name()) + " and left out"),
              "element " + tag(name) + " in " + tag(parent.Name()));
  }
}

void XmlNameCheck::check_text(const XmlElement& element) const {
  for (const tinyxml2::XMLNode* node = element.FirstChild(); node != nullptr;
       node = node->NextSibling()) {
    const std::string_view text =
        node->ToText() == nullptr ? std::string_view() : without_blanks(node->Value());
    if (text.empty()) {
      continue;
    }
    if (has_entity(text)) {
      log_.refuse(xml_.error(element, "expected no entities, got " + detail::quoted(text) +
                                          "; put in what they stand for"));
    } else {
      log_.warn(xml_.error(element, "the text " + detail::quoted(text) + " is left out"), "text");
    }
  }
}

/// Whether a name reports geometry; also "Link", "link1", and "loop_joint" with parts.
bool XmlNameCheck::tells(const XmlElement& stranger) const {
  std::string word = lower(without_prefix(stranger.Name()));
  while (!word.empty() && word.back() >= '0' && word.back() <= '9') {
    word.pop_back();
  }
  return holds(telling_.in_place, word) || holds(telling_.anywhere, word) ||
         holds(telling_.with_parts, word) ||
         (stranger.FirstChildElement() != nullptr &&
          holds(telling_.with_parts, word.substr(word.find_last_of("_-.") + 1)));
}

const XmlElement* XmlNameCheck::telling_part(const XmlElement& element) const {
  for (const XmlElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string name = lower(without_prefix(child->Name()));
    const bool has_parts = child->FirstChildElement() != nullptr;
    if (holds(telling_.anywhere, name) || (has_parts && holds(telling_.with_parts, name)) ||
        is_xacro(child->Name())) {
      return child;
    }
    if (const XmlElement* deeper = telling_part(*child)) {
      return deeper;
    }
  }
  return nullptr;
}

}  // namespace firstcontact::detail
