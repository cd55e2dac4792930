/// @file
/// The shapes of the members of a scene, and the poses that loading rounded.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

struct LoadedScene;

/// A shape of a member, in a frame G that is fixed in the member's frame M.
struct MemberShape {
  Shape shape;
  Pose X_MG = {};
};

/// The shapes of a member: one for a body, any number for a link.
[[nodiscard]] FIRSTCONTACT_API std::vector<MemberShape> shapes_of_member(const LoadedScene& loaded,
                                                                         std::size_t member);

/// A pose of a body that is rounded to doubles when a link takes the body up or puts it down.
///
/// It defines the motion from then on.
struct FrozenPose {
  double t = 0.0;       ///< [-]
  bool in_link = true;  ///< Whether the pose is X_LB, as the link takes the body up; else it is
                        ///< X_WB, where it was put down.
  Pose pose = {};
};

/// The poses at which a body was taken up or put down, in the order of time.
[[nodiscard]] FIRSTCONTACT_API std::vector<FrozenPose> frozen_poses(const LoadedScene& loaded,
                                                                    std::size_t body);

}  // namespace firstcontact
