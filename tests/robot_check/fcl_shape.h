/// @file
/// Shape in FCL: its triangles, and the radius that thickens them.

#pragma once

#include <memory>

#include <Eigen/Geometry>

#include <firstcontact/geometry/shape.h>

namespace firstcontact::test {

/// FCL's discrete tests of two triangle meshes.
///
/// They test surfaces only: a body inside a solid does not collide.
class FclShape {
 public:
  explicit FclShape(const Shape& shape);

  /// [m]  Computes the distance of the thickened surfaces; not positive where they meet.
  [[nodiscard]] double distance(const Eigen::Isometry3d& X_WA, const FclShape& B,
                                const Eigen::Isometry3d& X_WB) const;

  /// Returns whether the thickened surfaces meet.
  [[nodiscard]] bool collides(const Eigen::Isometry3d& X_WA, const FclShape& B,
                              const Eigen::Isometry3d& X_WB) const;

 private:
  struct Model;
  [[nodiscard]] bool far_from(const Eigen::Isometry3d& X_WA, const FclShape& B,
                              const Eigen::Isometry3d& X_WB) const;

  std::shared_ptr<const Model> model_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double reach_ = 0.0;  // Greatest distance of the thickened triangles from the centre.
  double radius_ = 0.0;
};

}  // namespace firstcontact::test
