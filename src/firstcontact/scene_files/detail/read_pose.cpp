#include <firstcontact/scene_files/detail/read_pose.h>

#include <cstddef>
#include <stdexcept>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/motion/rotation_forms.h>

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
  // The range in which a motion can normalise exactly.
  if (!(largest >= 1e-60 && largest <= 1e60)) {
    read.fail(value, "expected " + expected + ", its length in 1e-60 ... 1e60");
  }
  return q;
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
  const Eigen::Matrix4d matrix = read_numbers(value, read);
  try {
    return pose_from_matrix(matrix);
  } catch (const std::invalid_argument& error) {
    read.fail(value, error.what());
  }
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
    pose.rotation = rotation_from_rpy(read.vector3(*rpy));
  } else if (const JsonValue* rotation_vector = find(object, "rotation_vector")) {
    pose.rotation = rotation_from_vector(read.vector3(*rotation_vector));
  }
  return pose;
}

}  // namespace firstcontact::detail
