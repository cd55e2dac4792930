#include <firstcontact/scene_files/read_simulation_scene.h>

#include <firstcontact/foreign_scenes/detail/rigid_ipc_keys.h>
#include <firstcontact/foreign_scenes/read_rigid_ipc.h>
#include <firstcontact/scene_files/detail/scene_text.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_json.h>

namespace firstcontact {

Scene read_simulation_scene(const std::filesystem::path& path, const ReadingOptions& options) {
  return parse_simulation_scene(detail::scene_text(path), path, options);
}

Scene parse_simulation_scene(std::string_view text, const std::filesystem::path& source,
                             const ReadingOptions& options) {
  if (!detail::is_rigid_ipc(detail::parse_json(text, source.string()))) {
    return parse_scene(text, source, 1, options);
  }
  Scene scene = parse_rigid_ipc(text, source);
  scene.options.lenient = options.lenient;
  return scene;
}

}  // namespace firstcontact
