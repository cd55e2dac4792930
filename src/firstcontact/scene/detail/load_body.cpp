#include <firstcontact/scene/detail/load_body.h>

#include <cstddef>
#include <utility>
#include <variant>

#include <firstcontact/scene/detail/add_report.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {
namespace {

DeformingBody moving(const Body& body, Shape shape, double duration) {
  const auto* vertices = std::get_if<VertexMotion>(&body.motion);
  if (vertices == nullptr) {
    return {std::move(shape), normalised_motion(body.motion, duration)};
  }
  const std::size_t count = shape.mesh().vertices.size();
  const auto* file = std::get_if<MeshFile>(&body.shape.source);
  if (file != nullptr && vertices->to.size() != count) {
    throw ParseError(file->path.string(), "expected a mesh of the " +
                                              std::to_string(vertices->to.size()) +
                                              " vertices that \"" + body.name +
                                              "\" moves, got one of " + std::to_string(count));
  }
  return move_vertices(shape, vertices->to);
}

}  // namespace

DeformingBody load_body(const Body& body, const Scene& scene, ShapeCache& cache,
                        std::string& digests, LoadedScene& loaded) {
  CachedShape cached = cache.load(body.shape, {.lenient = scene.options.lenient});
  if (!cached.digest.empty()) {
    digests += cached.digest + '\n';
  }
  if (cached.report) {
    add_report(*cached.report, loaded);
  }
  return moving(body, std::move(cached.shape), scene.duration);
}

}  // namespace firstcontact::detail
