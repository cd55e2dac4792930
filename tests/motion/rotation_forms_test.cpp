#include <firstcontact/motion/rotation_forms.h>

#include <limits>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace firstcontact {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

constexpr double kQuarter = std::numbers::pi / 2;

TEST(RotationFromRpy, TurnsAboutFixedXThenYThenZ) {
  // About x: y becomes z; about the fixed y: z becomes x; about the fixed z: x becomes y.
  const Eigen::Quaterniond q = rotation_from_rpy({kQuarter, kQuarter, kQuarter});
  EXPECT_LT((q * Vector3d::UnitY() - Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((q * Vector3d::UnitX() + Vector3d::UnitZ()).norm(), 1e-15);
}

TEST(RotationFromVector, TurnsAboutItByItsLength) {
  const Eigen::Quaterniond q = rotation_from_vector({0.0, 0.0, kQuarter});
  EXPECT_LT((q * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_EQ(rotation_from_vector(Vector3d::Zero()).coeffs(),
            Eigen::Quaterniond::Identity().coeffs());
}

TEST(PoseFromMatrix, IsTheTransformOfTheMatrix) {
  Matrix4d matrix = Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = rotation_from_rpy({0.3, -1.1, 2.5}).toRotationMatrix();
  matrix.topRightCorner<3, 1>() = Vector3d(1.0, -2.0, 3.0);
  const Pose pose = pose_from_matrix(matrix);
  const Vector3d p(0.5, 0.25, -4.0);
  const Vector3d expected = (matrix * p.homogeneous()).head<3>();
  EXPECT_LT((pose.position + pose.rotation * p - expected).norm(), 1e-14);
}

TEST(PoseFromMatrix, RefusesWhatIsNotRigid) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double wrong : {1.0 + 1e-8, -1.0, nan}) {
    Matrix4d matrix = Matrix4d::Identity();
    matrix(0, 0) = wrong;
    EXPECT_THROW((void)pose_from_matrix(matrix), std::invalid_argument) << wrong;
  }
  Matrix4d matrix = Matrix4d::Identity();
  matrix(3, 0) = 1.0;
  EXPECT_THROW((void)pose_from_matrix(matrix), std::invalid_argument);
  matrix = Matrix4d::Identity();
  matrix(0, 3) = nan;
  EXPECT_THROW((void)pose_from_matrix(matrix), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
