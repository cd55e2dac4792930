#include "scene_source.h"

#include <fstream>

#include <firstcontact/geometry/parse_error.h>
#include <firstcontact/scene/read_scene.h>

namespace firstcontact::app {
namespace {

bool is_blank(const std::string& line) {
  return line.find_first_not_of(" \t\r") == std::string::npos;
}

void for_each_line(const std::filesystem::path& file,
                   const std::function<bool(const SceneSource&)>& visit) {
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  for (std::size_t line = 1; std::getline(stream, text); ++line) {
    if (!is_blank(text) && !visit({.file = file.string(), .line = line, .read = [&] {
                                     return parse_scene(text, file, line);
                                   }})) {
      return;
    }
  }
  if (!stream.eof()) {
    throw ParseError(file.string(), "expected a file of scenes, cannot read this one");
  }
}

}  // namespace

bool is_json_lines(const std::filesystem::path& file) {
  return file.extension() == ".jsonl" || file.extension() == ".ndjson";
}

void for_each_scene(const std::filesystem::path& file,
                    const std::function<bool(const SceneSource&)>& visit) {
  if (is_json_lines(file)) {
    for_each_line(file, visit);
  } else {
    visit({.file = file.string(), .line = std::nullopt, .read = [&] { return read_scene(file); }});
  }
}

}  // namespace firstcontact::app
