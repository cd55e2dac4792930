#include <firstcontact/scene/loaded_scene.h>

#include <algorithm>
#include <utility>

#include <firstcontact/scene/detail/sha256.h>

namespace firstcontact {

namespace {

bool is_ignored(const Scene& scene, const BodyPair& bodies) {
  return std::find(scene.ignored_pairs.begin(), scene.ignored_pairs.end(), bodies) !=
         scene.ignored_pairs.end();
}

double margin_of(const Scene& scene, const BodyPair& bodies) {
  const auto own = std::find_if(scene.pair_margins.begin(), scene.pair_margins.end(),
                                [&](const PairMargin& pair) { return pair.bodies == bodies; });
  return own != scene.pair_margins.end() ? own->margin : scene.options.margin;
}

std::vector<ScenePair> list_pairs(const Scene& scene) {
  std::vector<ScenePair> pairs;
  for (std::size_t first = 0; first < scene.bodies.size(); ++first) {
    for (std::size_t second = first + 1; second < scene.bodies.size(); ++second) {
      const BodyPair bodies = {first, second};
      if (!is_ignored(scene, bodies)) {
        pairs.push_back({.bodies = bodies, .margin = margin_of(scene, bodies)});
      }
    }
  }
  return pairs;
}

}  // namespace

LoadedScene load_scene(Scene scene, ShapeCache& cache) {
  LoadedScene loaded;
  std::string digests = scene.text_digest + '\n';
  for (const Body& body : scene.bodies) {
    CachedShape cached = cache.load(body.shape);
    loaded.shapes.push_back(std::move(cached.shape));
    if (!cached.digest.empty()) {
      digests += cached.digest + '\n';
    }
    loaded.motions.push_back(normalised_motion(body.motion, scene.duration));
  }
  loaded.pairs = list_pairs(scene);
  loaded.input_digest = detail::sha256(digests);
  loaded.scene = std::move(scene);
  return loaded;
}

}  // namespace firstcontact
