#include <firstcontact/scene/loaded_scene.h>

#include <algorithm>
#include <utility>

#include <firstcontact/scene/detail/sha256.h>

namespace firstcontact {

namespace {

PairRules rules_of(const Scene& scene) {
  PairRules rules(scene.options.margin);
  for (const BodyGroup& group : scene.groups) {
    rules.add_group(group.bodies);
  }
  for (const BodyPair& pair : scene.ignored_pairs) {
    rules.ignore(pair);
  }
  for (const PairMargin& pair : scene.pair_margins) {
    rules.set_margin(pair.bodies, pair.margin);
  }
  for (const GroupPair& pair : scene.ignored_groups) {
    rules.ignore_groups(pair[0], pair[1]);
  }
  for (const GroupMargin& pair : scene.group_margins) {
    rules.set_group_margin(pair.groups[0], pair.groups[1], pair.margin);
  }
  return rules;
}

}  // namespace

LoadedScene load_scene(Scene scene, ShapeCache& cache) {
  LoadedScene loaded{.scene = {}, .bodies = BodySet(rules_of(scene)), .input_digest = {}};
  std::string digests = scene.text_digest + '\n';
  for (const Body& body : scene.bodies) {
    CachedShape cached = cache.load(body.shape);
    if (!cached.digest.empty()) {
      digests += cached.digest + '\n';
    }
    loaded.bodies.add(std::move(cached.shape), normalised_motion(body.motion, scene.duration));
  }
  loaded.input_digest = detail::sha256(digests);
  loaded.scene = std::move(scene);
  return loaded;
}

}  // namespace firstcontact
