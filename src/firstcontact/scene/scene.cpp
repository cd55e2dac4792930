#include <firstcontact/scene/scene.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <variant>

#include <firstcontact/scene/detail/scene_names.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

/// [s]  The last time of waypoints; 0 where there is none.
double last_time(const BodyMotion& motion) {
  const auto* waypoints = std::get_if<WaypointMotion>(&motion);
  return waypoints == nullptr ? 0.0 : waypoints->times.back();
}

}  // namespace

double last_time(const Scene& scene) {
  double last = 0.0;
  for (const Body& body : scene.bodies) {
    last = std::max(last, last_time(body.motion));
  }
  for (const SceneRobot& robot : scene.robots) {
    last = std::max({last, last_time(robot.base), robot.trajectory.points.back().time});
  }
  return last;
}

void add_body(Scene& scene, Body body) {
  const std::size_t number = scene.bodies.size();
  const auto renumber = [number](auto& members) {
    for (std::size_t& member : members) {
      member += member >= number ? 1 : 0;
    }
  };
  for (BodyGroup& group : scene.groups) {
    renumber(group.bodies);
  }
  for (BodyPair& pair : scene.ignored_pairs) {
    renumber(pair);
  }
  for (BodyPair& pair : scene.allowed_pairs) {
    renumber(pair);
  }
  for (PairMargin& pair : scene.pair_margins) {
    renumber(pair.bodies);
  }
  if (scene.simulation) {
    for (PairSurface& pair : scene.simulation->pairs) {
      renumber(pair.bodies);
    }
    for (Tie& tie : scene.simulation->ties) {
      for (std::optional<std::size_t>& member : tie.bodies) {
        member = member && *member >= number ? *member + 1 : member;
      }
    }
  }
  scene.bodies.push_back(std::move(body));
}

std::vector<std::size_t> members_named(const Scene& scene, std::string_view name) {
  const detail::SceneNames names = detail::names_in(scene);
  const auto found = names.find(name);
  if (found == names.end()) {
    throw std::invalid_argument(
        "expected the name of a body, a robot or a group, or robot/link, "
        "got " +
        detail::in_quotes(name) + detail::hint(names, name));
  }
  return detail::members_of(scene, found->second);
}

std::size_t first_member(const Scene& scene, std::size_t robot) {
  std::size_t first = scene.bodies.size();
  for (std::size_t k = 0; k < robot; ++k) {
    first += scene.robots.at(k).model.links().size();
  }
  return first;
}

std::string member_name(const Scene& scene, std::size_t member) {
  if (member < scene.bodies.size()) {
    return scene.bodies[member].name;
  }
  member -= scene.bodies.size();
  for (const SceneRobot& robot : scene.robots) {
    if (member < robot.model.links().size()) {
      return robot.name + "/" + robot.model.links()[member].name;
    }
    member -= robot.model.links().size();
  }
  throw std::out_of_range("member_name: the scene has no such member");
}

}  // namespace firstcontact
