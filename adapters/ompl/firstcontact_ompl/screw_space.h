/// @file
/// Poses of a body with screws between them, for planners of OMPL.

#pragma once

#include <ompl/base/spaces/SE3StateSpace.h>

#include <firstcontact/motion/motion.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// SE(3) in which an edge is a screw: the body turns about an axis, and slides along it, at
/// constant rates, by the shortest rotation (M. Chasles, 1830).
///
/// interpolate() is Motion::screw(), bit for bit: densified paths are those that were proven. The
/// distance is that of SE3StateSpace. It bounds no screw whose axis is far away.
class ScrewStateSpace : public ompl::base::SE3StateSpace {
 public:
  ScrewStateSpace() { setName("Screw" + getName()); }

  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double share,
                   ompl::base::State* state) const override {
    if (share <= 0.0 || share >= 1.0) {
      copyState(state, share <= 0.0 ? from : to);
      return;
    }
    const Pose pose = Motion::screw(pose_of(from), pose_of(to)).pose(share);
    auto* made = state->as<StateType>();
    made->setXYZ(pose.position.x(), pose.position.y(), pose.position.z());
    made->rotation().x = pose.rotation.x();
    made->rotation().y = pose.rotation.y();
    made->rotation().z = pose.rotation.z();
    made->rotation().w = pose.rotation.w();
  }

 private:
  static Pose pose_of(const ompl::base::State* state) {
    const auto* pose = state->as<StateType>();
    const auto& r = pose->rotation();
    return {{pose->getX(), pose->getY(), pose->getZ()}, Eigen::Quaterniond(r.w, r.x, r.y, r.z)};
  }
};

}  // namespace firstcontact
