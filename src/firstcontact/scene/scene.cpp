#include <firstcontact/scene/scene.h>

#include <stdexcept>

namespace firstcontact {

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
