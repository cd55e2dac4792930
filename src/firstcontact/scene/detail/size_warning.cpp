#include <firstcontact/scene/detail/size_warning.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/body_shape.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/text/quantity.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr double kImplausible = 1000.0;     // [m]
constexpr double kImplausibleLink = 100.0;  // [m]
constexpr double kSuspicious = 100.0;       // [m]  Size of a mesh beside much smaller bodies.
constexpr double kMuchSmaller = 0.01;       // [-]

double diameter(const Shape& shape) { return 2.0 * (shape.hierarchy().radius + shape.radius()); }

/// A body or robot, and its size.
struct Sized {
  std::string name;      ///< 'body "post"'
  double size = 0.0;     ///< [m]
  bool is_mesh = false;  ///< Whether it is a mesh, whose coordinates state no unit.
  bool in_file = false;  ///< Whether it is also in a file, so that a scale can be given.
};

Sized size_of_body(const LoadedScene& loaded, std::size_t index) {
  const Body& body = loaded.scene.bodies[index];
  const auto& source = body.shape.source;
  const auto* hull = std::get_if<ConvexHullShape>(&source);
  const bool in_file = std::holds_alternative<MeshFile>(source) ||
                       (hull != nullptr && std::holds_alternative<MeshFile>(hull->of));
  return {.name = "body " + in_quotes(body.name),
          .size = diameter(shape_of_body(loaded, index)),
          .is_mesh = std::holds_alternative<MeshFile>(source) ||
                     std::holds_alternative<Mesh>(source) || std::holds_alternative<Shape>(source),
          .in_file = in_file};
}

Eigen::Vector3d at(const Pose& X_AB, const Eigen::Vector3d& p_BP) {
  return X_AB.position + X_AB.rotation.normalized() * p_BP;
}

/// The size of a robot by the balls around its geometries, at the start of the step.
Sized size_of_robot(const LoadedScene& loaded, std::size_t robot) {
  const RobotScene& members = *loaded.robots;
  const std::size_t first = members.first_member(robot);
  Eigen::AlignedBox3d box;
  for (std::size_t k = 0; k < loaded.scene.robots[robot].model.links().size(); ++k) {
    const Pose X_WL = members.pose(first + k, 0.0);
    for (const MemberGeometry& geometry : members.geometries(first + k)) {
      const Eigen::Vector3d centre = at(X_WL, at(geometry.X_MG, geometry.shape.hierarchy().centre));
      const Eigen::Vector3d reach = Eigen::Vector3d::Constant(0.5 * diameter(geometry.shape));
      box.extend(centre - reach);
      box.extend(centre + reach);
    }
  }
  return {.name = "robot " + in_quotes(loaded.scene.robots[robot].name),
          .size = box.isEmpty() ? 0.0 : box.sizes().maxCoeff()};
}

/// A factor as text: "6000", "1.2e+07".
std::string times(double ratio) {
  return ratio < 1e6 ? std::to_string(static_cast<long long>(ratio)) : rounded(ratio, 2);
}

std::string offer() {
  return " If its file is in millimetres, \"scale\": 0.001 reads it so (--environment-scale 0.001 "
         "on the command line, scale=0.001 in Python)";
}

/// The warning about a body, with its neighbour in size.
std::string warning(const Sized& body, const Sized* next_smaller) {
  std::string text = body.name + " is " + quantity(body.size, "m") + " across";
  if (next_smaller != nullptr) {
    text +=
        ", " + times(body.size / next_smaller->size) + " times as much as " + next_smaller->name;
  }
  return text + ": is its unit right?" + (body.in_file ? offer() : "");
}

void warn_of_links(const LoadedScene& loaded, std::vector<std::string>& warnings) {
  for (std::size_t robot = 0; robot < loaded.scene.robots.size(); ++robot) {
    const SceneRobot& described = loaded.scene.robots[robot];
    const std::size_t first = loaded.robots->first_member(robot);
    for (std::size_t k = 0; k < described.model.links().size(); ++k) {
      for (const MemberGeometry& geometry : loaded.robots->geometries(first + k)) {
        if (diameter(geometry.shape) > kImplausibleLink) {
          warnings.push_back(
              described.name + ": link " + in_quotes(described.model.links()[k].name) + " is " +
              quantity(diameter(geometry.shape), "m") + " across: is its unit right?");
        }
      }
    }
  }
}

/// The largest body that is much smaller than the next larger one, which is suspicious; null where
/// there is none.
///
/// @param by_size  sorted by size
const Sized* largest_of_usual(const std::vector<Sized>& by_size) {
  for (std::size_t k = 0; k + 1 < by_size.size(); ++k) {
    const Sized& larger = by_size[k + 1];
    if (larger.size >= kSuspicious && by_size[k].size > 0.0 &&
        by_size[k].size <= kMuchSmaller * larger.size) {
      return &by_size[k];
    }
  }
  return nullptr;
}

}  // namespace

void warn_of_sizes(LoadedScene& loaded) {
  std::vector<Sized> all;
  for (std::size_t body = 0; body < loaded.scene.bodies.size(); ++body) {
    all.push_back(size_of_body(loaded, body));
  }
  for (std::size_t robot = 0; robot < loaded.scene.robots.size(); ++robot) {
    all.push_back(size_of_robot(loaded, robot));
  }
  if (all.empty()) {
    return;
  }
  std::vector<Sized> by_size = all;
  std::stable_sort(by_size.begin(), by_size.end(),
                   [](const Sized& a, const Sized& b) { return a.size < b.size; });
  const Sized* usual = largest_of_usual(by_size);
  const bool all_large = by_size.front().size >= kSuspicious;
  for (const Sized& body : all) {
    const bool beside = usual != nullptr && body.size > usual->size;
    if (body.in_file && body.size >= kSuspicious && (beside || all_large)) {
      loaded.warnings.push_back(warning(body, beside ? usual : nullptr));
    } else if (body.is_mesh && body.size >= kImplausible) {
      loaded.warnings.push_back(warning(body, nullptr));
    }
  }
  warn_of_links(loaded, loaded.warnings);
  const double tolerance = loaded.scene.options.tolerance;
  if (by_size.back().size > 0.0 && by_size.back().size < tolerance) {
    loaded.warnings.push_back("nothing is as large as the tolerance of " +
                              quantity(tolerance, "m") + "; the largest, " + by_size.back().name +
                              ", is " + quantity(by_size.back().size, "m") +
                              " across: are units and tolerance right?");
  }
}

}  // namespace firstcontact::detail
