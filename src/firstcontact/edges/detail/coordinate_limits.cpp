#include <firstcontact/edges/detail/coordinate_limits.h>

#include <algorithm>
#include <numbers>

#include <firstcontact/edges/detail/robot_sizes.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/shape.h>

namespace firstcontact::detail {
namespace {

/// Takes the limits of a coordinate, or its sampled range where it has none.
void take_own_limits(const Joint& joint, SpaceCoordinate& coordinate) {
  coordinate.slides = is_slide(joint.type, coordinate.index);
  const bool has_own = joint.type == JointType::revolute || joint.type == JointType::prismatic ||
                       joint.type == JointType::screw;
  if (has_own && joint.limits.lower && joint.limits.upper) {
    coordinate.lower = *joint.limits.lower;
    coordinate.upper = *joint.limits.upper;
    return;
  }
  coordinate.has_limits = false;
  if (!coordinate.slides) {
    coordinate.lower = -std::numbers::pi;
    coordinate.upper = std::numbers::pi;
  }
}

/// Narrows the limits of a coordinate to those that the joints which mimic it have.
///
/// @param multiplier, offset  a joint that follows the coordinate is at multiplier q + offset
void narrow_by_mimics(const RobotModel& model, std::size_t joint, double multiplier, double offset,
                      SpaceCoordinate& coordinate) {
  for (std::size_t other = 0; other < model.joints().size(); ++other) {
    const Joint& follower = model.joints()[other];
    if (!follower.mimic || follower.mimic->joint != model.joints()[joint].name) {
      continue;
    }
    const double factor = follower.mimic->multiplier * multiplier;
    const double shift = follower.mimic->multiplier * offset + follower.mimic->offset;
    SpaceCoordinate own;
    take_own_limits(follower, own);
    if (own.has_limits && factor != 0.0) {
      const auto [low, high] =
          std::minmax({(own.lower - shift) / factor, (own.upper - shift) / factor});
      coordinate.lower = coordinate.has_limits ? std::max(coordinate.lower, low) : low;
      coordinate.upper = coordinate.has_limits ? std::min(coordinate.upper, high) : high;
      coordinate.has_limits = true;
      coordinate.turns_short = false;
    }
    narrow_by_mimics(model, other, factor, shift, coordinate);
  }
}

}  // namespace

void take_limits(const RobotModel& model, SpaceCoordinate& coordinate) {
  take_own_limits(model.joints()[coordinate.joint], coordinate);
  narrow_by_mimics(model, coordinate.joint, 1.0, 0.0, coordinate);
}

double length_of(const RobotModel& model) {
  double length = 0.0;
  for (const Joint& joint : model.joints()) {
    length += joint.X_PJ.position.norm();
  }
  double part = 0.0;
  for (const Link& link : model.links()) {
    for (const LinkGeometry& geometry : link.collision) {
      if (geometry.shape) {
        const Hierarchy& hierarchy = geometry.shape->hierarchy();
        part = std::max(part, geometry.X_LG.position.norm() + hierarchy.centre.norm() +
                                  hierarchy.radius + geometry.shape->radius());
      }
    }
  }
  return length + part;
}

}  // namespace firstcontact::detail
