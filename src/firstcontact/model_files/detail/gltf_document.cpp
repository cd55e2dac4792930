#include <firstcontact/model_files/detail/gltf_document.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <variant>
#include <vector>

#include <firstcontact/model_files/detail/gltf_extensions.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr std::array<std::string_view, 7> kArrayNames = {
    "accessors", "bufferViews", "buffers", "meshes", "nodes", "scenes", "skins"};

/// Lists the keys of each kind of object, in the order of GltfObject. All may have "name",
/// "extensions" and "extras".
const std::array<std::vector<std::string_view>, 11>& keys_of_kinds() {
  static const std::array<std::vector<std::string_view>, 11> keys = {{
      {"bufferView", "byteOffset", "componentType", "count", "max", "min", "normalized", "sparse",
       "type"},
      {"byteLength", "uri"},
      {"buffer", "byteLength", "byteOffset", "byteStride", "target"},
      {"primitives", "weights"},
      {"camera", "children", "matrix", "mesh", "rotation", "scale", "skin", "translation",
       "weights"},
      {"attributes", "indices", "material", "mode", "targets"},
      {"accessors", "animations", "asset", "bufferViews", "buffers", "cameras",
       "extensionsRequired", "extensionsUsed", "images", "materials", "meshes", "nodes", "samplers",
       "scene", "scenes", "skins", "textures"},
      {"nodes"},
      {"inverseBindMatrices", "joints", "skeleton"},
      {"count", "indices", "values"},
      {"bufferView", "byteOffset", "componentType"},
  }};
  return keys;
}

bool could_hold_geometry(GltfObject kind) {
  return kind == GltfObject::mesh || kind == GltfObject::node || kind == GltfObject::primitive ||
         kind == GltfObject::scene || kind == GltfObject::skin;
}

constexpr const char* kMend = "write the file without it";

std::string about(std::string_view name, const GltfExtension& extension) {
  std::string text = in_quotes(name);
  if (!extension.reason.empty()) {
    text += " (" + std::string(extension.reason) + ")";
  }
  return text;
}

}  // namespace

GltfDocument::GltfDocument(const JsonValue& root, ReadingLog& log)
    : root_(root), log_(log), reader_(root, log.path()) {
  if (std::get_if<JsonObject>(&root.value) == nullptr) {
    reader_.fail_expected("an object, the glTF document", root);
  }
  check_version();
  static const JsonArray none;
  for (std::size_t i = 0; i < arrays_.size(); ++i) {
    const JsonValue* const found = find(this->root(), kArrayNames[i]);
    arrays_[i] = found == nullptr ? &none : &array(*found);
  }
  check_named_extensions();
  static_cast<void>(checked(root, GltfObject::root, ""));
}

const JsonArray& GltfDocument::all(GltfArray which) const {
  return *arrays_[static_cast<std::size_t>(which)];
}

std::size_t GltfDocument::index(const JsonValue& value, GltfArray of) const {
  const std::size_t count = all(of).size();
  const auto* number = std::get_if<double>(&value.value);
  if (number == nullptr || !(*number >= 0.0) || !(*number < static_cast<double>(count)) ||
      std::trunc(*number) != *number) {
    reader_.fail_expected("an index of " + std::string(kArrayNames[static_cast<std::size_t>(of)]) +
                              ", of which the file has " + std::to_string(count),
                          value);
  }
  return static_cast<std::size_t>(*number);
}

std::uint64_t GltfDocument::whole(const JsonObject& object, std::string_view key,
                                  std::uint64_t otherwise) const {
  const JsonValue* const value = find(object, key);
  if (value == nullptr) {
    return otherwise;
  }
  constexpr double kMost = 9007199254740992.0;  // 2^53; a double holds all whole numbers up to it.
  const auto* number = std::get_if<double>(&value->value);
  if (number == nullptr || !(*number >= 0.0) || !(*number <= kMost) ||
      std::trunc(*number) != *number) {
    reader_.fail_expected("a whole number >= 0", *value);
  }
  return static_cast<std::uint64_t>(*number);
}

const JsonObject& GltfDocument::object(const JsonValue& value) const {
  const auto* object = std::get_if<JsonObject>(&value.value);
  if (object == nullptr) {
    reader_.fail_expected("an object", value);
  }
  return *object;
}

const JsonArray& GltfDocument::array(const JsonValue& value) const {
  return reader_.array(value, "an array");
}

const JsonValue* GltfDocument::extension(const JsonObject& object, std::string_view name) const {
  const JsonValue* const extensions = find(object, "extensions");
  return extensions == nullptr ? nullptr : find(this->object(*extensions), name);
}

const JsonObject& GltfDocument::checked(const JsonValue& value, GltfObject kind,
                                        const std::string& place) const {
  const JsonObject& result = object(value);
  const std::vector<std::string_view>& keys = keys_of_kinds()[static_cast<std::size_t>(kind)];
  for (const auto& [key, member] : result) {
    if (key == "name" || std::find(keys.begin(), keys.end(), key) != keys.end()) {
      continue;
    }
    if (key == "extras") {
      log_.leave_out("extras", "data of an application");
      continue;
    }
    if (key == "extensions") {
      if (kind != GltfObject::root) {
        check_extensions(member, place);
      }
      continue;
    }
    const std::string_view nearest = nearest_word(key, keys);
    const std::string message = "unknown key " + in_quotes(key) +
                                (nearest.empty() ? "; known are " + listed(keys)
                                                 : "; did you mean " + in_quotes(nearest) + "?");
    if (could_hold_geometry(kind) || !nearest.empty()) {
      refuse(member, place, message, key);
    } else {
      log_.warn(ParseError(log_.path(), member.line, place + ": " + message), key);
    }
  }
  return result;
}

void GltfDocument::refuse(const JsonValue& where, const std::string& place,
                          const std::string& message, std::string_view cause) const {
  log_.refuse(ParseError(log_.path(), where.line, (place.empty() ? "" : place + ": ") + message),
              cause);
}

void GltfDocument::check_version() const {
  const JsonObject& asset = object(reader_.member(root_, "asset"));
  for (const std::string_view key : {"version", "minVersion"}) {
    const JsonValue* const value = find(asset, key);
    if (value == nullptr && key == "version") {
      fail(reader_.member(root_, "asset"), "expected a key \"version\", got none");
    }
    if (value == nullptr) {
      continue;
    }
    const std::string& version = reader_.string(*value, "a version such as \"2.0\"");
    const bool fits = key == "version" ? version.starts_with("2.") : version == "2.0";
    if (!fits) {
      fail(*value, "expected glTF of version 2.0, got " + in_quotes(version) +
                       "; convert the file to glTF 2.0");
    }
  }
}

void GltfDocument::check_named_extensions() {
  for (const std::string_view key : {"extensionsRequired", "extensionsUsed"}) {
    const JsonValue* const names = find(root(), key);
    if (names == nullptr) {
      continue;
    }
    for (const JsonValue& value : array(*names)) {
      const std::string& name = reader_.string(value, "the name of an extension");
      if (!named_.insert(name).second) {
        continue;
      }
      if (key == "extensionsRequired") {
        check_required(value);
      } else {
        check_used(name, value);
      }
    }
  }
  if (const JsonValue* const extensions = find(root(), "extensions")) {
    for (const auto& [name, value] : object(*extensions)) {
      if (named_.insert(name).second) {
        check_used(name, value);
      }
    }
  }
}

void GltfDocument::check_required(const JsonValue& name) const {
  const auto& word = std::get<std::string>(name.value);
  const GltfExtension extension = gltf_extension(word);
  switch (extension.meaning) {
    case GltfMeaning::understood:
      return;
    case GltfMeaning::harmless:
      log_.leave_out(word, extension.reason);
      return;
    case GltfMeaning::compressed:
      log_.add_error(ParseError(log_.path(), name.line,
                                "extensionsRequired: " + about(word, extension) +
                                    " is not read; decompress the file first"));
      return;
    case GltfMeaning::geometry:
    case GltfMeaning::unknown:
      refuse(name, "extensionsRequired",
             about(word, extension) +
                 " is not read, and may hold or place geometry. Extensions that are read: "
                 "KHR_mesh_quantization, EXT_mesh_gpu_instancing; " +
                 kMend,
             word);
  }
}

void GltfDocument::check_used(const std::string& name, const JsonValue& where) const {
  const GltfExtension extension = gltf_extension(name);
  if (extension.meaning == GltfMeaning::harmless) {
    log_.leave_out(name, extension.reason);
  } else if (extension.meaning == GltfMeaning::geometry) {
    refuse(where, "", about(name, extension) + " is not read; " + kMend, name);
  } else if (extension.meaning == GltfMeaning::unknown) {
    log_.warn(ParseError(log_.path(), where.line,
                         "the extension " + in_quotes(name) +
                             " is not known, and was not read; it is not required by the file"),
              name);
  }
}

void GltfDocument::check_extensions(const JsonValue& extensions, const std::string& place) const {
  for (const auto& [name, value] : object(extensions)) {
    const GltfExtension extension = gltf_extension(name);
    if (extension.meaning == GltfMeaning::unknown) {
      refuse(value, place,
             "the extension " + in_quotes(name) +
                 " is not known, and may hold or place geometry; " + kMend,
             name);
    } else if (extension.meaning == GltfMeaning::geometry && !named_.contains(name)) {
      refuse(value, place, about(name, extension) + " is not read; " + kMend, name);
    } else if (extension.meaning == GltfMeaning::harmless && !named_.contains(name)) {
      log_.leave_out(name, extension.reason);
    }
  }
}

}  // namespace firstcontact::detail
