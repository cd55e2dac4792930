/// @file
/// Affine maps of glTF: those of nodes, of instances and of joints.

#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/model_files/detail/gltf_document.h>

namespace firstcontact::detail {

/// Reads the map from a node's frame to that of its parent: its matrix, or its translation,
/// rotation and scale. The quaternion is divided by its exact length, as that of a Pose.
///
/// @throws ParseError  both forms at once, a quaternion of zeros, a matrix that is not affine
[[nodiscard]] Eigen::Affine3d node_transform(const GltfDocument& document, const JsonValue& node);

/// Makes the map p -> translation + R(rotation) (scale * p), with scale taken coordinate by
/// coordinate. The entries of the rotation are rounded to doubles; those of turns by 90 degrees are
/// exact.
///
/// @param rotation  (x, y, z, w); of any length
/// @returns  nothing where the rotation is zero or not finite
[[nodiscard]] std::optional<Eigen::Affine3d> compose(const Eigen::Vector3d& translation,
                                                     const Eigen::Vector4d& rotation,
                                                     const Eigen::Vector3d& scale);

/// Makes the map of a 4x4 matrix; nothing where the matrix is not finite, or its last row is not
/// (0, 0, 0, 1). Writers invert matrices in single precision, so an error of 1e-5 in that row is
/// accepted.
[[nodiscard]] std::optional<Eigen::Affine3d> affine(const Eigen::Matrix4d& matrix);

/// Whether a map turns the outside of a closed surface inwards: its determinant is negative then.
[[nodiscard]] bool mirrors(const Eigen::Matrix3d& linear);

}  // namespace firstcontact::detail
