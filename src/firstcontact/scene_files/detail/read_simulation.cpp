#include <firstcontact/scene_files/detail/read_simulation.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include <firstcontact/scene/detail/scene_names.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene_files/detail/read_dynamics.h>
#include <firstcontact/scene_files/detail/read_ties.h>

namespace firstcontact::detail {
namespace {

PairSurface read_pair(const JsonValue& value, const SceneNames& names, const JsonReader& read) {
  const JsonObject& object = read.object(value, {{"bodies", "friction", "restitution"}});
  const JsonValue& bodies = read.member(value, "bodies");
  const JsonArray& sides = read.array(bodies, "a pair of names, such as [\"a\", \"b\"]");
  if (sides.size() != 2) {
    read.fail_expected("a pair of names, such as [\"a\", \"b\"]", bodies);
  }
  const std::size_t a = read_member(sides[0], names, read);
  const std::size_t b = read_member(sides[1], names, read);
  if (a == b) {
    read.fail(bodies, "expected two bodies, got one twice");
  }
  const PairSurface pair{{std::min(a, b), std::max(a, b)}, read_surface(object, read)};
  if (!pair.surface.friction && !pair.surface.restitution) {
    read.fail(value, "expected \"friction\" or \"restitution\", got neither");
  }
  return pair;
}

std::vector<PairSurface> read_pairs(const JsonValue& value, const SceneNames& names,
                                    const JsonReader& read) {
  std::vector<PairSurface> pairs;
  std::set<BodyPair> seen;
  for (const JsonValue& element : read.array(value, "an array of pairs with their surfaces")) {
    pairs.push_back(read_pair(element, names, read));
    if (!seen.insert(pairs.back().bodies).second) {
      read.fail(element, "expected each pair once, got a second one");
    }
  }
  return pairs;
}

}  // namespace

Simulation read_simulation(const JsonValue& value, const Scene& scene, const JsonReader& read) {
  const JsonObject& object =
      read.object(value, {{"duration", "step", "gravity", "friction", "restitution", "impacts",
                           "jams", "contact_distance", "events", "pairs", "ties"}});
  Simulation simulation;
  if (const JsonValue* duration = find(object, "duration")) {
    simulation.duration = read.positive(*duration);
  }
  if (const JsonValue* step = find(object, "step")) {
    simulation.step = read.positive(*step);
  }
  if (const JsonValue* gravity = find(object, "gravity")) {
    simulation.gravity = read.vector3(*gravity);
  }
  if (const JsonValue* friction = find(object, "friction")) {
    simulation.friction = read.not_negative(*friction);
  }
  if (const JsonValue* restitution = find(object, "restitution")) {
    simulation.restitution = read_restitution(*restitution, read);
  }
  if (const JsonValue* impacts = find(object, "impacts")) {
    simulation.impacts = read.enumerator<ImpactLaw>(*impacts, kImpactLawWords);
  }
  if (const JsonValue* jams = find(object, "jams")) {
    simulation.jams = read.enumerator<JamRule>(*jams, kJamRuleWords);
  }
  if (const JsonValue* distance = find(object, "contact_distance")) {
    simulation.contact_distance = read.positive(*distance);
  }
  if (const JsonValue* events = find(object, "events")) {
    simulation.events = read.index(*events, std::size_t{1} << 32, "a number of events");
    if (simulation.events == 0) {
      read.fail_expected("a number of events > 0", *events);
    }
  }
  if (const JsonValue* pairs = find(object, "pairs")) {
    simulation.pairs = read_pairs(*pairs, names_in(scene), read);
  }
  if (const JsonValue* ties = find(object, "ties")) {
    simulation.ties = read_ties(*ties, names_in(scene), read);
  }
  return simulation;
}

}  // namespace firstcontact::detail
