#include <firstcontact/scene/detail/robot_name.h>

#include <optional>
#include <stdexcept>

#include <firstcontact/scene/scene.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {

RobotName split_robot_name(const Scene& scene, std::span<const std::size_t> robots,
                           std::string_view name) {
  if (robots.size() == 1) {
    return {0, std::string(name)};
  }
  std::optional<RobotName> found;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    const std::string begin = scene.robots[robots[k]].name + "/";
    if (!name.starts_with(begin)) {
      continue;
    }
    if (found) {
      throw std::invalid_argument(
          in_quotes(name) +
          " may be of two robots: the name of one begins with that of the other; rename it");
    }
    found = {k, std::string(name.substr(begin.size()))};
  }
  if (!found) {
    throw std::invalid_argument("expected ROBOT/NAME with one of the robots that move, got " +
                                in_quotes(name));
  }
  return *found;
}

}  // namespace firstcontact::detail
