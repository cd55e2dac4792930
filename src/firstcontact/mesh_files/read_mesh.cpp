#include <firstcontact/mesh_files/read_mesh.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include <firstcontact/geometry/weld.h>
#include <firstcontact/mesh_files/detail/parse_mesh.h>
#include <firstcontact/model_files/detail/parse_dae.h>
#include <firstcontact/model_files/detail/parse_gltf.h>
#include <firstcontact/text/file_extension.h>
#include <firstcontact/text/mapped_file.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/reading_log.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact {
namespace {

/// Finds the name of the format in reports, by the extension of its files; empty for an unknown
/// one.
std::string format_of(std::string_view extension) {
  constexpr std::array<std::array<std::string_view, 2>, 7> kFormats = {{{"obj", "OBJ"},
                                                                        {"stl", "STL"},
                                                                        {"ply", "PLY"},
                                                                        {"off", "OFF"},
                                                                        {"dae", "DAE"},
                                                                        {"gltf", "glTF"},
                                                                        {"glb", "GLB"}}};
  for (const auto& [known, name] : kFormats) {
    if (extension == known) {
      return std::string(name);
    }
  }
  return {};
}

Mesh parse(std::string_view bytes, const std::string& extension, detail::ReadingLog& log) {
  if (extension == "obj") {
    return detail::parse_obj(bytes, log);
  }
  if (extension == "stl") {
    return detail::parse_stl(bytes, log);
  }
  if (extension == "ply") {
    return detail::parse_ply(bytes, log);
  }
  if (extension == "off") {
    return detail::parse_off(bytes, log);
  }
  if (extension == "gltf" || extension == "glb") {
    return detail::parse_gltf(bytes, log.path(), log);
  }
  return detail::parse_dae(bytes, log);
}

}  // namespace

MeshReading read_mesh_file(const std::filesystem::path& path, const ReadingOptions& options) {
  const std::string extension = detail::file_extension(path);
  const std::string format = format_of(extension);
  const detail::MappedFile file(path);
  if (format.empty()) {
    throw ParseError(path.string(),
                     "expected a mesh file named .obj, .stl, .ply, .off, .dae, .glb or "
                     ".gltf, got " +
                         detail::quoted("." + extension));
  }
  detail::ReadingLog log(path.string(), format, options);
  Mesh mesh = parse(file.bytes(), extension, log);
  weld(mesh);
  log.add_content("triangles", mesh.triangles.size());
  log.add_content("vertices", mesh.vertices.size());
  return {std::move(mesh), log.finish()};
}

Mesh read_mesh(const std::filesystem::path& path) { return read_mesh_file(path).mesh; }

}  // namespace firstcontact
