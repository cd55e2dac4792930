#include "scene_source.h"

#include <sstream>
#include <string_view>

#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/scene_lines.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>

#include "standard_streams.h"

namespace firstcontact::app {

bool is_json_lines(const std::filesystem::path& file) {
  return file.extension() == ".jsonl" || file.extension() == ".ndjson";
}

namespace {

/// Whether the first line that is not blank holds a whole JSON value, with more lines behind it.
bool is_lines_of_scenes(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  const std::size_t end = begin == std::string::npos ? begin : text.find('\n', begin);
  if (end == std::string::npos || text.find_first_not_of(" \t\r\n", end) == std::string::npos) {
    return false;
  }
  try {
    (void)detail::parse_json(std::string_view(text).substr(begin, end - begin), "");
  } catch (const ParseError&) {
    return false;
  }
  return true;
}

void for_each_scene_of_stdin(const ReadingOptions& reading,
                             const std::function<bool(const SceneSource&)>& visit) {
  const std::string text = read_stdin();
  const std::string name(kStdinName);
  if (!is_lines_of_scenes(text)) {
    visit({.file = name, .line = std::nullopt, .read = [&] {
             return parse_scene(text, name, 1, reading);
           }});
    return;
  }
  std::istringstream lines(text);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    if (line.find_first_not_of(" \t\r") != std::string::npos &&
        !visit({.file = name, .line = number, .read = [&] {
                  return parse_scene(line, name, number, reading);
                }})) {
      return;
    }
  }
}

}  // namespace

void for_each_scene(const std::filesystem::path& file, const ReadingOptions& reading,
                    const std::function<bool(const SceneSource&)>& visit) {
  if (file == kStdin) {
    for_each_scene_of_stdin(reading, visit);
    return;
  }
  if (!is_json_lines(file)) {
    visit({.file = file.string(), .line = std::nullopt, .read = [&] {
             return read_scene(file, reading);
           }});
    return;
  }
  SceneLines lines(file);
  while (const std::optional<SceneLine> line = lines.next()) {
    if (!visit({.file = file.string(), .line = line->number, .read = [&] {
                  return parse_scene(line->text, file, line->number, reading);
                }})) {
      return;
    }
  }
}

}  // namespace firstcontact::app
