/// @file
/// The joint at the end of a chain of joints that mimic each other.

#pragma once

#include <cstddef>
#include <optional>

#include <firstcontact/robot/robot_model.h>

namespace firstcontact::detail {

/// A coordinate of a joint as a function of the one that it follows: multiplier q + offset.
struct MimickedJoint {
  std::size_t joint = 0;    ///< Index of the joint, which mimics none.
  double multiplier = 1.0;  ///< [-]  In the units of both.
  double offset = 0.0;      ///< [rad or m]
};

/// The joint that a joint follows in the end, through others that mimic it; itself if it mimics
/// none.
inline MimickedJoint mimicked_joint(const RobotModel& model, std::size_t joint) {
  MimickedJoint found{.joint = joint};
  while (const std::optional<Mimic>& mimic = model.joints()[found.joint].mimic) {
    found.offset += found.multiplier * mimic->offset;
    found.multiplier *= mimic->multiplier;
    found.joint = model.find_joint(mimic->joint).value();
  }
  return found;
}

}  // namespace firstcontact::detail
