#include <firstcontact/model_files/detail/dae_document.h>

#include <algorithm>
#include <optional>

#include <firstcontact/math/number_text.h>
#include <firstcontact/text/ascii.h>
#include <firstcontact/text/text_cursor.h>
#include <firstcontact/text/uri.h>

namespace firstcontact::detail {
namespace {

constexpr std::string_view kOtherTools = "settings of other tools";

bool holds(std::initializer_list<std::string_view> names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Finds the kind under which an element is indexed; empty for those that nothing refers to.
std::string_view kind_of(std::string_view name) {
  if (name.ends_with("_array")) {
    return "array";
  }
  return holds({"geometry", "controller", "node", "visual_scene", "source"}, name)
             ? name
             : std::string_view();
}

std::string key_of(std::string_view kind, std::string_view id) {
  return std::string(kind) + "#" + std::string(id);
}

/// Finds the next element in the order of the document, or null.
const XmlElement* next_in_document(const XmlElement& element) {
  if (const XmlElement* child = element.FirstChildElement()) {
    return child;
  }
  const tinyxml2::XMLNode* node = &element;
  while (node != nullptr) {
    if (const XmlElement* sibling = node->NextSiblingElement()) {
      return sibling;
    }
    node = node->Parent();
  }
  return nullptr;
}

}  // namespace

DaeDocument::DaeDocument(std::string_view bytes, ReadingLog& log)
    : log_(log), xml_(bytes, log.path()), root_(xml_.root("COLLADA")) {
  read_version();
  read_asset();
  index();
}

void DaeDocument::read_version() const {
  const char* const version = root_.Attribute("version");
  const std::string_view known = version == nullptr ? "" : version;
  if (!known.starts_with("1.4") && !known.starts_with("1.5")) {
    refuse(root_, "expected version=\"1.4.1\" or \"1.5.0\", got " + detail::quoted(known));
  }
}

void DaeDocument::index() {
  for (const XmlElement* element = &root_; element != nullptr;
       element = next_in_document(*element)) {
    const std::string_view kind = kind_of(element->Name());
    const char* const id = kind.empty() ? nullptr : element->Attribute("id");
    if (id != nullptr) {
      const auto [known, is_new] = by_id_.try_emplace(key_of(kind, id), Named{element});
      known->second.repeated = !is_new;
    }
  }
}

void DaeDocument::read_asset() {
  if (const XmlElement* asset = xml_.child(root_, "asset")) {
    warn_of_unit_without_size(*asset);
    unit_ = unit_of(*asset);
    if (const XmlElement* axis = xml_.child(*asset, "up_axis")) {
      up_axis_ = trimmed(xml_.content(*axis).view());
      if (!holds({"X_UP", "Y_UP", "Z_UP"}, up_axis_)) {
        fail(*axis, "expected X_UP, Y_UP or Z_UP, got " + detail::quoted(up_axis_));
      }
    }
  }
  log_.set_unit(shortest(unit_) + " m (" + up_axis_ + ", axes as in the file)");
}

void DaeDocument::warn_of_unit_without_size(const XmlElement& asset) const {
  const XmlElement* unit = xml_.child(asset, "unit");
  const char* const name = unit == nullptr ? nullptr : unit->Attribute("name");
  if (name != nullptr && unit->Attribute("meter") == nullptr && !holds({"meter", "metre"}, name)) {
    log_.warn(xml_.error(*unit, "no 'meter' states the size of the unit " + detail::quoted(name) +
                                    "; it is taken as 1 m"));
  }
}

double DaeDocument::unit_of(const XmlElement& asset) const {
  const XmlElement* unit = xml_.child(asset, "unit");
  if (unit == nullptr || unit->Attribute("meter") == nullptr) {
    return 1.0;
  }
  return xml_.positive(*unit, "meter");
}

void DaeDocument::check_asset(const XmlElement& asset) const {
  warn_of_unit_without_size(asset);
  if (const XmlElement* unit = xml_.child(asset, "unit"); unit && unit_of(asset) != unit_) {
    refuse(*unit, "another unit than that of the document is not read; write one unit");
  }
  const XmlElement* axis = xml_.child(asset, "up_axis");
  if (axis != nullptr && trimmed(xml_.content(*axis).view()) != up_axis_) {
    refuse(*axis, "another up axis than that of the document is not read; write one axis");
  }
}

void DaeDocument::refuse(const XmlElement& where, const std::string& message,
                         std::string_view cause) const {
  log_.refuse(xml_.error(where, message), cause.empty() ? message : cause);
}

std::string_view DaeDocument::reference(const XmlElement& where, const char* attribute) const {
  const char* const value = where.Attribute(attribute);
  const std::string_view text = value == nullptr ? "" : trimmed(value);
  if (text.size() < 2) {
    fail(where, "expected a reference '#id' in '" + std::string(attribute) + "'");
  }
  if (text.front() != '#') {
    fail(where, "expected '#' and an id in '" + std::string(attribute) + "', got " +
                    detail::quoted(text) + "; other documents are not read: write all into one");
  }
  return text.substr(1);
}

/// Finds an element by id. Some writers have %20 for a space in references, and the space in ids.
const DaeDocument::Named* DaeDocument::named(std::string_view id, std::string_view kind) const {
  auto known = by_id_.find(key_of(kind, id));
  if (known == by_id_.end()) {
    if (const std::optional<std::string> decoded = decode_percent(id)) {
      known = by_id_.find(key_of(kind, *decoded));
    }
  }
  return known == by_id_.end() ? nullptr : &known->second;
}

const XmlElement* DaeDocument::find_id(std::string_view id, std::string_view kind) const {
  const Named* const found = named(id, kind);
  return found == nullptr || found->repeated ? nullptr : found->element;
}

const XmlElement& DaeDocument::find(const XmlElement& where, const char* attribute,
                                    std::string_view kind) const {
  const std::string_view id = reference(where, attribute);
  const Named* const found = named(id, kind);
  if (found == nullptr) {
    fail(where, "expected an element <" + std::string(kind) + "> with the id " +
                    detail::quoted(id) + ", got none");
  }
  if (found->repeated) {
    fail(where, "expected one element <" + std::string(kind) + "> with the id " +
                    detail::quoted(id) + ", got several");
  }
  return *found->element;
}

bool DaeDocument::names(const XmlElement& where, const char* attribute,
                        const XmlElement& element) const {
  const std::string_view id = reference(where, attribute);
  const char* const its = element.Attribute("id");
  return its != nullptr && (id == its || decode_percent(id) == its);
}

const XmlElement& DaeDocument::find_in(const XmlElement& scope, const XmlElement& where,
                                       const char* attribute, std::string_view kind) const {
  const std::string_view id = reference(where, attribute);
  const XmlElement* found = nullptr;
  for (const XmlElement* child = scope.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const char* const its = kind_of(child->Name()) == kind ? child->Attribute("id") : nullptr;
    if (its == nullptr || id != its) {
      continue;
    }
    if (found != nullptr) {
      fail(*child, "a second element with the id " + detail::quoted(id) + "; keep one");
    }
    found = child;
  }
  return found != nullptr ? *found : find(where, attribute, kind);
}

void DaeDocument::leave_out_profile(const XmlElement& element) const {
  // A longer list of names is of no use, and each takes a search through the notes.
  constexpr std::size_t kMostProfiles = 32;
  const auto note = [&](const XmlElement& technique) {
    const char* const profile = technique.Attribute("profile");
    const std::string name = "<" + std::string(element.Name()) + "> of " +
                             (profile == nullptr ? "no profile" : detail::quoted(profile));
    const bool few = profiles_.size() < kMostProfiles || profiles_.contains(name);
    if (few) {
      profiles_.insert(name);
    }
    log_.leave_out(few ? name : "<" + std::string(element.Name()) + "> of other profiles",
                   kOtherTools);
  };
  const XmlElement* technique = element.FirstChildElement("technique");
  if (technique == nullptr) {
    note(element);
  }
  for (; technique != nullptr; technique = technique->NextSiblingElement("technique")) {
    note(*technique);
  }
}

void DaeDocument::check_children(const XmlElement& element,
                                 std::initializer_list<std::string_view> taken,
                                 std::initializer_list<DaePassedOver> passed_over) const {
  for (const XmlElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string_view name = child->Name();
    const auto* const known =
        std::find_if(passed_over.begin(), passed_over.end(),
                     [&](const DaePassedOver& entry) { return entry.name == name; });
    if (known != passed_over.end()) {
      if (!child->NoChildren() || child->FirstAttribute() != nullptr) {
        log_.leave_out("<" + std::string(name) + ">", known->reason);
      }
    } else if (name == "extra" || name == "technique") {
      leave_out_profile(*child);
    } else if (name == "asset") {
      check_asset(*child);
    } else if (!holds(taken, name)) {
      refuse(*child, "not known inside <" + std::string(element.Name()) +
                         ">; it could hold or place geometry: correct or remove it");
    }
  }
}

void DaeDocument::check_attributes(const XmlElement& element,
                                   std::initializer_list<std::string_view> known) const {
  for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    if (!holds(known, a->Name()) && std::string_view(a->Name()).find(':') == std::string::npos) {
      refuse(element, "unknown attribute " + detail::quoted(a->Name()) + "; correct or remove it",
             "unknown attribute");
    }
  }
}

}  // namespace firstcontact::detail
