#include <firstcontact/planning/detail/body_box.h>

#include <algorithm>
#include <cstddef>

#include <Eigen/Geometry>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::detail {

std::array<Eigen::Vector3d, 2> box_around(const RobotScene& scene, const std::vector<Pose>& goals) {
  constexpr int kLooks = 64;
  const std::size_t mover = scene.first_member(0);
  Eigen::AlignedBox3d box;
  for (std::size_t member = 0; member < scene.size(); ++member) {
    const BodyPair pair = {std::min(member, mover), std::max(member, mover)};
    const double kept = member == mover ? 0.0 : scene.margin(pair).value_or(0.0);
    const bool rests = member == mover || scene.rests(member);
    for (std::size_t k = 0; k < scene.geometries(member).size(); ++k) {
      const Shape& shape = scene.geometries(member)[k].shape;
      const double radius = shape.hierarchy().radius + shape.radius() + kept;
      for (int look = 0; look <= (rests ? 0 : kLooks); ++look) {
        const Pose pose = scene.geometry_pose(member, k, static_cast<double>(look) / kLooks);
        const Eigen::Vector3d centre =
            pose.position + pose.rotation.normalized() * shape.hierarchy().centre;
        box.extend(centre - Eigen::Vector3d::Constant(radius));
        box.extend(centre + Eigen::Vector3d::Constant(radius));
      }
    }
  }
  for (const Pose& goal : goals) {
    box.extend(goal.position);
  }
  const Shape& shape = scene.geometries(mover)[0].shape;
  const double reach = shape.hierarchy().centre.norm() + shape.hierarchy().radius + shape.radius();
  return {box.min() - Eigen::Vector3d::Constant(2.0 * reach),
          box.max() + Eigen::Vector3d::Constant(2.0 * reach)};
}

}  // namespace firstcontact::detail
