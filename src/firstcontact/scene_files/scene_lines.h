/// @file
/// A file of scenes, one in each line (JSON Lines).

#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <firstcontact/math/export.h>

namespace firstcontact {

/// A line of a file of scenes.
struct SceneLine {
  std::size_t number = 0;  ///< Number of the line in the file; the first line is 1.
  std::string text;        ///< Text of the scene, not read yet: see parse_scene().
};

/// Reads the lines of a file in order; skips blank lines.
class FIRSTCONTACT_API SceneLines {
 public:
  explicit SceneLines(std::filesystem::path file);

  /// Reads the next scene; none at the end of the file.
  ///
  /// @throws ParseError if the file cannot be read
  [[nodiscard]] std::optional<SceneLine> next();

  /// The digest of all lines up to here, in hexadecimal.
  ///
  /// The text for each line's SHA-256 begins with the digest before it.
  [[nodiscard]] const std::string& digest() const { return digest_; }

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  std::size_t number_ = 0;
  std::string digest_;
};

}  // namespace firstcontact
