#include <firstcontact/scene/loaded_scene.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/geometry/deforming_body.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/detail/add_report.h>
#include <firstcontact/scene/detail/load_body.h>
#include <firstcontact/scene/detail/load_robots.h>
#include <firstcontact/scene/detail/size_warning.h>
#include <firstcontact/scene/detail/start_warnings.h>
#include <firstcontact/text/sha256.h>

namespace firstcontact {

namespace {

LoadedScene load_bodies(Scene scene, ShapeCache& cache) {
  LoadedScene loaded{.scene = {}, .bodies = BodySet(detail::rules_of(scene)), .input_digest = {}};
  loaded.warnings = scene.warnings;
  detail::add_reports(scene.file_reports, loaded);
  std::string digests = scene.text_digest + '\n';
  for (const Body& body : scene.bodies) {
    DeformingBody moved = detail::load_body(body, scene, cache, digests, loaded);
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
