#include <firstcontact/simulation_model/detail/round_feature.h>

namespace firstcontact::detail {

using Eigen::Vector3d;

Vector3d farthest_on(const Pose& pose, const RoundFeature& feature, const Vector3d& beside,
                     const Vector3d& outwards) {
  const Eigen::Quaterniond R = pose.rotation.normalized();
  if (feature.ellipsoid != nullptr) {
    const RoundEllipsoid& ellipsoid = *feature.ellipsoid;
    return pose.position + R * (ellipsoid.centre_B + ellipsoid.farthest(R.conjugate() * outwards));
  }
  const Vector3d axis = R * feature.circle->axis_B;
  const Vector3d centre = pose.position + R * feature.circle->centre_B;
  const Vector3d across = outwards - outwards.dot(axis) * axis;
  return centre + (beside - centre).dot(axis) * axis + feature.radius() * across.normalized();
}

}  // namespace firstcontact::detail
