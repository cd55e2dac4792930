#include <firstcontact/scene/detail/robot_name.h>

#include <optional>
#include <stdexcept>

#include <firstcontact/scene/scene.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {

namespace {

bool is_alone(const MoverNumbers& movers) { return movers.robots.size() == 1 && !movers.body; }

const std::string& name_of(const Scene& scene, const MoverNumbers& movers, std::size_t which) {
  return which < movers.robots.size() ? scene.robots[movers.robots[which]].name
                                      : scene.bodies[movers.body.value()].name;
}

}  // namespace

RobotName split_mover_name(const Scene& scene, const MoverNumbers& movers, std::string_view name) {
  if (is_alone(movers)) {
    return {0, std::string(name)};
  }
  std::optional<RobotName> found;
  const std::size_t count = movers.robots.size() + (movers.body ? 1 : 0);
  for (std::size_t k = 0; k < count; ++k) {
    const std::string begin = name_of(scene, movers, k) + "/";
    if (!name.starts_with(begin)) {
      continue;
    }
    if (found) {
      throw std::invalid_argument(
          in_quotes(name) +
          " may be of two movers: the name of one begins with that of the other; rename it");
    }
    found = {k, std::string(name.substr(begin.size()))};
  }
  if (!found) {
    throw std::invalid_argument("expected ROBOT/NAME with one of the robots that move, got " +
                                in_quotes(name));
  }
  return *found;
}

RobotName split_robot_name(const Scene& scene, std::span<const std::size_t> robots,
                           std::string_view name) {
  return split_mover_name(scene, {.robots = robots}, name);
}

std::string joined_mover_name(const Scene& scene, const MoverNumbers& movers, std::size_t which,
                              const std::string& name) {
  return is_alone(movers) ? name : name_of(scene, movers, which) + "/" + name;
}

}  // namespace firstcontact::detail
