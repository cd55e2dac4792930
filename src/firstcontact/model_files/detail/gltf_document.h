/// @file
/// The JSON document of a glTF file: its arrays, and the keys of their objects.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/reading_log.h>

namespace firstcontact::detail {

/// The arrays at the root of a document to which other values point by index.
enum class GltfArray { accessors, buffer_views, buffers, meshes, nodes, scenes, skins };

/// The objects whose keys are checked.
enum class GltfObject {
  accessor,
  buffer,
  buffer_view,
  mesh,
  node,
  primitive,
  root,
  scene,
  skin,
  sparse,
  sparse_part
};

/// A glTF 2.0 document.
///
/// Functions throw ParseError, with line and place, where a value violates the standard.
///
/// Source: Khronos Group, "glTF 2.0 Specification", 5 (properties reference).
class GltfDocument {
 public:
  /// Checks the version, and the extensions that the document names.
  ///
  /// @param root  the whole document; it and the log outlive this
  GltfDocument(const JsonValue& root, ReadingLog& log);

  [[nodiscard]] const JsonObject& root() const { return object(root_); }
  [[nodiscard]] ReadingLog& log() const { return log_; }

  /// Finds the elements of an array at the root; none if the document does not have it.
  [[nodiscard]] const JsonArray& all(GltfArray which) const;

  /// Reads an index of an element that the document has.
  [[nodiscard]] std::size_t index(const JsonValue& value, GltfArray of) const;

  /// Reads the whole number of a key, from 0 to 2^53; `otherwise` if the key is missing.
  [[nodiscard]] std::uint64_t whole(const JsonObject& object, std::string_view key,
                                    std::uint64_t otherwise) const;

  [[nodiscard]] const JsonObject& object(const JsonValue& value) const;
  [[nodiscard]] const JsonArray& array(const JsonValue& value) const;
  [[nodiscard]] const JsonReader& reader() const { return reader_; }

  /// Finds an extension of an object; null if it has none of this name.
  [[nodiscard]] const JsonValue* extension(const JsonObject& object, std::string_view name) const;

  /// Checks that the keys and extensions of an object are known. Others are refused where they
  /// could hold or place geometry, and are warnings elsewhere.
  ///
  /// @param place  the object's own: "nodes[2]"
  [[nodiscard]] const JsonObject& checked(const JsonValue& value, GltfObject kind,
                                          const std::string& place) const;

  [[noreturn]] void fail(const JsonValue& where, const std::string& message) const {
    reader_.fail(where, message);
  }

  /// Notes an element that is not understood; an error, unless the options are lenient.
  void refuse(const JsonValue& where, const std::string& place, const std::string& message,
              std::string_view cause) const;

 private:
  void check_version() const;
  void check_named_extensions();
  void check_required(const JsonValue& name) const;
  void check_used(const std::string& name, const JsonValue& where) const;
  void check_extensions(const JsonValue& extensions, const std::string& place) const;

  const JsonValue& root_;
  ReadingLog& log_;
  JsonReader reader_;
  std::array<const JsonArray*, 7> arrays_{};
  std::set<std::string, std::less<>> named_;  ///< The extensions that the document lists as used.
};

}  // namespace firstcontact::detail
