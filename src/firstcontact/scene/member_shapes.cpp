#include <firstcontact/scene/member_shapes.h>

#include <variant>

#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {

std::vector<MemberShape> shapes_of_member(const LoadedScene& loaded, std::size_t member) {
  if (!loaded.robots) {
    return {{loaded.bodies.shape(member), {}}};
  }
  std::vector<MemberShape> shapes;
  for (const MemberGeometry& geometry : loaded.robots->geometries(member)) {
    shapes.push_back({geometry.shape, geometry.X_MG});
  }
  return shapes;
}

std::vector<FrozenPose> frozen_poses(const LoadedScene& loaded, std::size_t body) {
  std::vector<FrozenPose> poses;
  if (!loaded.robots) {
    return poses;
  }
  for (const BodyStretch& stretch : loaded.robots->stretches(body)) {
    if (const auto* carried = std::get_if<BodyStretch::Carried>(&stretch.how)) {
      poses.push_back({stretch.t_begin, true, carried->X_LB});
    } else if (const auto* resting = std::get_if<BodyStretch::Resting>(&stretch.how)) {
      poses.push_back({stretch.t_begin, false, resting->X_WB});
    }
  }
  return poses;
}

}  // namespace firstcontact
