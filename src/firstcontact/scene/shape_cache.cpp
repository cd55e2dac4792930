#include <firstcontact/scene/shape_cache.h>

#include <array>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <firstcontact/geometry/parse_error.h>
#include <firstcontact/geometry/read_mesh.h>
#include <firstcontact/scene/detail/sha256.h>

namespace firstcontact {

namespace {

std::string digest_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  detail::Sha256 digest;
  std::array<char, 1 << 16> bytes;
  while (file.read(bytes.data(), bytes.size()) || file.gcount() > 0) {
    digest.add(std::string_view(bytes.data(), static_cast<std::size_t>(file.gcount())));
  }
  return digest.hexadecimal();
}

CachedShape read_shape(const MeshFile& file, double radius) {
  Mesh mesh = read_mesh(file.path);
  if (file.scale != 1.0) {
    for (Eigen::Vector3d& vertex : mesh.vertices) {
      vertex *= file.scale;
    }
  }
  try {
    return {.shape = Shape(std::move(mesh), radius), .digest = digest_of(file.path)};
  } catch (const std::invalid_argument& error) {
    throw ParseError(file.path.string(), error.what());
  }
}

}  // namespace

const CachedShape& ShapeCache::load(const MeshFile& file, double radius) {
  const std::tuple key(file.path.string(), file.scale, radius);
  const auto found = shapes_.find(key);
  return found != shapes_.end() ? found->second
                                : shapes_.emplace(key, read_shape(file, radius)).first->second;
}

}  // namespace firstcontact
