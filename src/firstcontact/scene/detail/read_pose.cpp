#include <firstcontact/scene/detail/read_pose.h>

#include <cstddef>
#include <string>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

Eigen::Quaterniond read_quaternion(const JsonValue& value, const JsonReader& read) {
  const std::string expected = "a quaternion [w, x, y, z], not zero";
  const JsonArray& elements = read.array(value, expected);
  if (elements.size() != 4) {
    read.fail_expected(expected, value);
  }
  Eigen::Quaterniond q(read.number(elements[0]), read.number(elements[1]), read.number(elements[2]),
                       read.number(elements[3]));
  const double largest = q.coeffs().cwiseAbs().maxCoeff();
  // What a motion can normalise exactly.
  if (!(largest >= 1e-60 && largest <= 1e60)) {
    read.fail(value, "expected " + expected + ", its length in 1e-60 ... 1e60");
  }
  return q;
}

/// Rotations about the fixed axes x, then y, then z.
Eigen::Quaterniond read_rpy(const JsonValue& value, const JsonReader& read) {
  const Eigen::Vector3d angles = read.vector3(value);
  return Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX());
}

Eigen::Quaterniond read_rotation_vector(const JsonValue& value, const JsonReader& read) {
  const Eigen::Vector3d rotation_vector = read.vector3(value);
  const double angle = rotation_vector.stableNorm();
  return angle > 0.0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle))
                     : Eigen::Quaterniond::Identity();
}

Eigen::Matrix4d read_numbers(const JsonValue& value, const JsonReader& read) {
  const std::string expected = "a matrix of four rows of four numbers";
  const JsonArray& rows = read.array(value, expected);
  if (rows.size() != 4) {
    read.fail_expected(expected, value);
  }
  Eigen::Matrix4d matrix;
  for (std::size_t i = 0; i < 4; ++i) {
    const JsonArray& row = read.array(rows[i], "a row of four numbers");
    if (row.size() != 4) {
      read.fail_expected("a row of four numbers", rows[i]);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = read.number(row[j]);
    }
  }
  return matrix;
}

Pose read_matrix(const JsonValue& value, const JsonReader& read) {
  constexpr double kRigid = 1e-9;  // [-]  Of the scene format.
  const Eigen::Matrix4d matrix = read_numbers(value, read);
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  // Written so that NaN from an overflow is refused too.
  const Eigen::Matrix3d defect = R.transpose() * R - Eigen::Matrix3d::Identity();
  if (!(defect.array().abs() <= kRigid).all() || !(R.determinant() > 0.0)) {
    read.fail(value, "expected a rotation in the upper left 3x3 to within 1e-9");
  }
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    read.fail(value, "expected [0, 0, 0, 1] as the last row");
  }
  const Eigen::Vector3d position = matrix.topRightCorner<3, 1>();
  if (!(position.array().abs() <= 1e60).all()) {
    read.fail(value, "expected a position of at most 1e60 in size in the last column");
  }
  return {.position = position, .rotation = Eigen::Quaterniond(R)};
}

}  // namespace

Pose read_pose(const JsonValue& value, const JsonReader& read) {
  const JsonObject& object =
      read.object(value, {{"position", "quaternion_wxyz", "rpy", "rotation_vector", "matrix"}});
  if (const JsonValue* matrix = find(object, "matrix")) {
    if (object.size() != 1) {
      read.fail(value, "expected \"matrix\" alone: it holds position and rotation");
    }
    return read_matrix(*matrix, read);
  }
  Pose pose;
  const JsonValue* position = find(object, "position");
  if (position != nullptr) {
    pose.position = read.vector3(*position);
  }
  if (object.size() > (position != nullptr ? 2u : 1u)) {
    read.fail(value, "expected one of \"quaternion_wxyz\", \"rpy\", \"rotation_vector\", got " +
                         std::to_string(object.size() - (position != nullptr ? 1 : 0)));
  }
  if (const JsonValue* quaternion = find(object, "quaternion_wxyz")) {
    pose.rotation = read_quaternion(*quaternion, read);
  } else if (const JsonValue* rpy = find(object, "rpy")) {
    pose.rotation = read_rpy(*rpy, read);
  } else if (const JsonValue* rotation_vector = find(object, "rotation_vector")) {
    pose.rotation = read_rotation_vector(*rotation_vector, read);
  }
  return pose;
}

}  // namespace firstcontact::detail
