#include <firstcontact/scene/detail/scene_names.h>

#include <numeric>

#include <firstcontact/scene/scene.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {

SceneNames names_in(const Scene& scene) {
  SceneNames names;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    names[scene.bodies[k].name] = {Named::Kind::member, k};
  }
  for (std::size_t k = 0; k < scene.robots.size(); ++k) {
    names[scene.robots[k].name] = {Named::Kind::robot, k};
    for (const std::size_t member : members_of(scene, {Named::Kind::robot, k})) {
      names.insert({member_name(scene, member), {Named::Kind::member, member}});
    }
  }
  for (std::size_t k = 0; k < scene.groups.size(); ++k) {
    names.insert({scene.groups[k].name, {Named::Kind::group, k}});
  }
  return names;
}

std::vector<std::size_t> members_of(const Scene& scene, const Named& named) {
  switch (named.kind) {
    case Named::Kind::group:
      return scene.groups[named.index].bodies;
    case Named::Kind::robot: {
      std::vector<std::size_t> links(scene.robots[named.index].model.links().size());
      std::iota(links.begin(), links.end(), first_member(scene, named.index));
      return links;
    }
    case Named::Kind::member:
      break;
  }
  return {named.index};
}

std::string hint(const SceneNames& names, std::string_view unknown) {
  std::vector<std::string_view> known;
  for (const auto& entry : names) {
    known.push_back(entry.first);
  }
  const std::string_view nearest = nearest_word(unknown, known);
  return nearest.empty() ? "" : "; did you mean " + in_quotes(nearest) + "?";
}

}  // namespace firstcontact::detail
