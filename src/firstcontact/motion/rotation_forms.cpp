#include <firstcontact/motion/rotation_forms.h>

#include <stdexcept>

namespace firstcontact {

Eigen::Quaterniond rotation_from_rpy(const Eigen::Vector3d& angles) {
  return Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX());
}

Eigen::Quaterniond rotation_from_vector(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.stableNorm();
  return angle > 0.0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle))
                     : Eigen::Quaterniond::Identity();
}

Pose pose_from_matrix(const Eigen::Matrix4d& matrix) {
  constexpr double kRigid = 1e-9;  // [-]  Tolerance of the scene format.
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  // Written so that NaN, also from an overflow, is refused too.
  const Eigen::Matrix3d defect = R.transpose() * R - Eigen::Matrix3d::Identity();
  if (!(defect.array().abs() <= kRigid).all() || !(R.determinant() > 0.0)) {
    throw std::invalid_argument("expected a rotation in the upper left 3x3 to within 1e-9");
  }
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    throw std::invalid_argument("expected [0, 0, 0, 1] as the last row");
  }
  const Eigen::Vector3d position = matrix.topRightCorner<3, 1>();
  if (!(position.array().abs() <= 1e60).all()) {
    throw std::invalid_argument("expected a position of at most 1e60 in size in the last column");
  }
  return {.position = position, .rotation = Eigen::Quaterniond(R)};
}

}  // namespace firstcontact
