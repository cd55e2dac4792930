#include <firstcontact/scene/detail/start_warnings.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/query/begins_inside.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/body_shape.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// The shapes of all members at the start of the step.
struct Placed {
  std::vector<ShapeAtStart> shapes;
  std::vector<std::size_t> members;  ///< The member of each shape.
};

Placed place(const LoadedScene& loaded) {
  Placed placed;
  const auto add = [&](const Shape& shape, const Pose& X_WS, std::size_t member) {
    placed.shapes.push_back({&shape, X_WS});
    placed.members.push_back(member);
  };
  if (!loaded.robots) {
    for (std::size_t body = 0; body < loaded.bodies.size(); ++body) {
      add(loaded.bodies.shape(body), loaded.bodies.motion(body).pose(0.0), body);
    }
    return placed;
  }
  for (std::size_t member = 0; member < loaded.robots->size(); ++member) {
    const auto geometries = loaded.robots->geometries(member);
    const Pose X_WM = geometries.empty() ? Pose{} : loaded.robots->pose(member, 0.0);
    const Eigen::Quaterniond R_WM = X_WM.rotation.normalized();
    for (const MemberGeometry& geometry : geometries) {
      add(geometry.shape,
          {X_WM.position + R_WM * geometry.X_MG.position, R_WM * geometry.X_MG.rotation}, member);
    }
  }
  return placed;
}

bool is_tested(const LoadedScene& loaded, std::size_t a, std::size_t b) {
  const BodyPair pair = {std::min(a, b), std::max(a, b)};
  return a != b && margin_of_pair(loaded, pair).has_value();
}

/// "a", "b" and 3 more begin inside of ...
std::string warning(const Scene& scene, const std::vector<std::size_t>& inside,
                    std::size_t around) {
  constexpr std::size_t kNamed = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(inside.size(), kNamed); ++k) {
    text += (k == 0 ? "" : ", ") + in_quotes(member_name(scene, inside[k]));
  }
  if (inside.size() > kNamed) {
    text += " and " + std::to_string(inside.size() - kNamed) + " more";
  }
  text += inside.size() == 1 ? " begins" : " begin";
  text += " inside the closed mesh of " + in_quotes(member_name(scene, around)) +
          ", a surface that only its triangles touch";
  return around < scene.bodies.size() ? text + "; \"solid\": true in its shape fills it" : text;
}

}  // namespace

void warn_of_begins_inside(LoadedScene& loaded, ShapeCache& cache) {
  const Placed placed = place(loaded);
  // Each appears once: geometries of one link may have the same ones inside.
  std::map<std::size_t, std::set<std::size_t>> inside_of;
  for (const BeginsInside& found : find_begins_inside(placed.shapes)) {
    const std::size_t around = placed.members[found.around];
    const std::size_t inside = placed.members[found.inside];
    const BodyShape* source =
        around < loaded.scene.bodies.size() ? &loaded.scene.bodies[around].shape : nullptr;
    if (is_tested(loaded, inside, around) &&
        cache.encloses_space(*placed.shapes[found.around].shape, source)) {
      inside_of[around].insert(inside);
    }
  }
  for (const auto& [around, inside] : inside_of) {
    loaded.warnings.push_back(warning(loaded.scene, {inside.begin(), inside.end()}, around));
  }
}

}  // namespace firstcontact::detail
