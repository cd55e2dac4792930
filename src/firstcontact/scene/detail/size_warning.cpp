#include <firstcontact/scene/detail/size_warning.h>

#include <variant>

#include <firstcontact/text/quantity.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

double diameter(const Shape& shape) { return 2.0 * (shape.hierarchy().radius + shape.radius()); }

std::string warning(const std::string& what, double size) {
  return what + " is " + quantity(size, "m") + " across: is its unit right?";
}

}  // namespace

void warn_of_size(const Body& body, const Shape& shape, std::vector<std::string>& warnings) {
  constexpr double kImplausible = 1000.0;  // [m]
  const auto& source = body.shape.source;
  const bool is_mesh = std::holds_alternative<MeshFile>(source) ||
                       std::holds_alternative<Mesh>(source) ||
                       std::holds_alternative<Shape>(source);
  if (is_mesh && diameter(shape) >= kImplausible) {
    warnings.push_back(warning("body " + in_quotes(body.name), diameter(shape)));
  }
}

void warn_of_sizes(const SceneRobot& robot, const RobotModel& loaded,
                   std::vector<std::string>& warnings) {
  constexpr double kImplausible = 100.0;  // [m]
  for (const Link& link : loaded.links()) {
    for (const LinkGeometry& geometry : link.collision) {
      if (geometry.shape && diameter(*geometry.shape) > kImplausible) {
        warnings.push_back(
            warning(robot.name + ": link " + in_quotes(link.name), diameter(*geometry.shape)));
      }
    }
  }
}

}  // namespace firstcontact::detail
