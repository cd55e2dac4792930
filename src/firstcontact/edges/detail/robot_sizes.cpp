#include <firstcontact/edges/detail/robot_sizes.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include <firstcontact/robot/detail/mimicked_joint.h>

namespace firstcontact::detail {
namespace {

double size_of(const CoordinatePath& path) {
  double size = 0.0;
  for (const CoordinateSegment& segment : path.segments()) {
    size = std::max(size, segment.size_bound());
  }
  return size;
}

/// [rad or m]  The size of a coordinate of a joint at rest.
double size_at_rest(const JointMotion& motion, std::size_t index) {
  if (const auto* path = std::get_if<CoordinatePath>(&motion)) {
    return size_of(*path);
  }
  return size_of(std::get<PlanarPath>(motion)[index]);
}

}  // namespace

bool is_slide(JointType type, std::size_t index) {
  return type == JointType::prismatic || (type == JointType::planar && index != 2);
}

RobotSizes robot_sizes(const RobotMotion& rest, std::size_t mover,
                       std::span<const SpaceCoordinate> coordinates,
                       std::span<const double> of_coordinates) {
  const RobotModel& model = rest.model();
  RobotSizes sizes;
  const auto add = [&](const Joint& joint, const MimickedJoint& follows, std::size_t index) {
    const auto planned = std::ranges::find_if(coordinates, [&](const SpaceCoordinate& one) {
      return one.mover == mover && one.joint == follows.joint && one.index == index;
    });
    const bool is_planned = planned != coordinates.end();
    const double leads =
        is_planned ? of_coordinates[static_cast<std::size_t>(planned - coordinates.begin())]
                   : size_at_rest(rest.given(follows.joint).value(), index);
    const double size = std::abs(follows.multiplier) * leads + std::abs(follows.offset);
    const bool slides = is_slide(joint.type, index);
    const double pitch = joint.type == JointType::screw ? std::abs(joint.pitch) : 0.0;
    const double slide = slides ? size : pitch * size;
    sizes.slides += slide;
    sizes.planned_slides += is_planned ? slide : 0.0;
    sizes.planned_turns += is_planned && !slides ? size : 0.0;
  };
  for (std::size_t joint = 0; joint < model.joints().size(); ++joint) {
    const JointType type = model.joints()[joint].type;
    for (std::size_t index = 0; index < coordinate_count(type); ++index) {
      add(model.joints()[joint], mimicked_joint(model, joint), index);
    }
    if (type == JointType::floating) {
      const std::optional<JointMotion> given = rest.given(joint);
      sizes.slides += std::get<Motion>(given.value()).pose(0.0).position.norm();
    }
  }
  return sizes;
}

}  // namespace firstcontact::detail
