/// @file
/// Scenes of text, loaded with a cache of their own.

#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/read_scene.h>

namespace firstcontact::test {

/// Loads the scene; `source` is the file that the text seems to come from.
inline LoadedScene load_text(const std::string& text, const std::filesystem::path& source = "s") {
  ShapeCache cache;
  return load_scene(parse_scene(text, source), cache);
}

/// Writes a ball with a constant velocity, or at rest where that is zero; `more` has other keys.
inline std::string moving_ball(const std::string& name, const std::string& radius,
                               const std::string& position, const std::string& translation,
                               const std::string& more = "") {
  return R"({"name": ")" + name + R"(", "shape": {"sphere": {"radius": )" + radius +
         R"(}}, "motion": {"type": "constant_velocity", "from": {"position": )" + position +
         R"(}, "translation": )" + translation + "}" + (more.empty() ? "" : ", ") + more + "}";
}

/// Returns the message of the exception of `call`; "accepted" where it throws nothing.
template <class Error, class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

/// Joins all lines, each with its end.
inline std::string lines_of(std::span<const std::string> lines) {
  std::string text;
  for (const std::string& line : lines) {
    text += line + "\n";
  }
  return text;
}

}  // namespace firstcontact::test
