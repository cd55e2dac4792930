#include <firstcontact/geometry/read_mesh.h>

#include <firstcontact/geometry/detail/read_with_assimp.h>
#include <firstcontact/geometry/weld.h>
#include <firstcontact/text/file_extension.h>
#include <firstcontact/text/mapped_file.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact {
namespace {

Mesh parse(const std::filesystem::path& path) {
  const std::string source = path.string();
  const std::string extension = detail::file_extension(path);
  const detail::MappedFile file(path);
  if (extension == "obj") {
    return parse_obj(file.bytes(), source);
  }
  if (extension == "stl") {
    return parse_stl(file.bytes(), source);
  }
  if (extension == "ply") {
    return parse_ply(file.bytes(), source);
  }
  if (extension == "off") {
    return parse_off(file.bytes(), source);
  }
  if (extension == "dae" || extension == "glb" || extension == "gltf") {
    return detail::read_with_assimp(source, file.bytes(), extension);
  }
  throw ParseError(source,
                   "expected a mesh file named .obj, .stl, .ply, .off, .dae, .glb or "
                   ".gltf, got " +
                       detail::quoted("." + extension));
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  Mesh mesh = parse(path);
  weld(mesh);
  return mesh;
}

}  // namespace firstcontact
