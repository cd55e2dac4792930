#include <firstcontact/scene/loaded_scene.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include <firstcontact/geometry/deforming_body.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/detail/add_report.h>
#include <firstcontact/scene/detail/load_robots.h>
#include <firstcontact/scene/detail/size_warning.h>
#include <firstcontact/scene/detail/start_warnings.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/sha256.h>

namespace firstcontact {

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

LoadedScene load_bodies(Scene scene, ShapeCache& cache) {
  LoadedScene loaded{.scene = {}, .bodies = BodySet(detail::rules_of(scene)), .input_digest = {}};
  loaded.warnings = scene.warnings;
  detail::add_reports(scene.file_reports, loaded);
  std::string digests = scene.text_digest + '\n';
  for (const Body& body : scene.bodies) {
    CachedShape cached = cache.load(body.shape, {.lenient = scene.options.lenient});
    if (!cached.digest.empty()) {
      digests += cached.digest + '\n';
    }
    if (cached.report) {
      detail::add_report(*cached.report, loaded);
    }
    DeformingBody moved = moving(body, std::move(cached.shape), scene.duration);
    loaded.bodies.add(std::move(moved.shape), std::move(moved.X_WS));
  }
  loaded.input_digest = detail::sha256(digests);
  loaded.scene = std::move(scene);
  return loaded;
}

}  // namespace

const Shape& shape_of_body(const LoadedScene& loaded, std::size_t body) {
  return loaded.robots ? loaded.robots->geometries(body).front().shape : loaded.bodies.shape(body);
}

std::optional<double> margin_of_pair(const LoadedScene& loaded, const BodyPair& members) {
  return loaded.robots ? loaded.robots->margin(members) : loaded.bodies.rules().margin(members);
}

LoadedScene load_scene(Scene scene, ShapeCache& cache) {
  LoadedScene loaded = scene.robots.empty() ? load_bodies(std::move(scene), cache)
                                            : detail::load_robots(std::move(scene), cache);
  detail::warn_of_sizes(loaded);
  detail::warn_of_begins_inside(loaded, cache);
  loaded.pair_counts = count_checked_pairs(loaded);
  return loaded;
}

}  // namespace firstcontact
