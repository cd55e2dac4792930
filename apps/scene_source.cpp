#include "scene_source.h"

#include <firstcontact/scene/read_scene.h>
#include <firstcontact/scene/scene_lines.h>

namespace firstcontact::app {
bool is_json_lines(const std::filesystem::path& file) {
  return file.extension() == ".jsonl" || file.extension() == ".ndjson";
}

void for_each_scene(const std::filesystem::path& file,
                    const std::function<bool(const SceneSource&)>& visit) {
  if (!is_json_lines(file)) {
    visit({.file = file.string(), .line = std::nullopt, .read = [&] { return read_scene(file); }});
    return;
  }
  SceneLines lines(file);
  while (const std::optional<SceneLine> line = lines.next()) {
    if (!visit({.file = file.string(), .line = line->number, .read = [&] {
                  return parse_scene(line->text, file, line->number);
                }})) {
      return;
    }
  }
}

}  // namespace firstcontact::app
