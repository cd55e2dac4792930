#include "robot_check/fcl_shape.h"

#include <algorithm>

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "benchmarks/support/fcl_model.h"

#include <firstcontact/geometry/hierarchy.h>

namespace firstcontact::test {

struct FclShape::Model {
  std::shared_ptr<benchmarks::FclModel> mesh;
};

FclShape::FclShape(const Shape& shape)
    : model_(std::make_shared<Model>(Model{benchmarks::fcl_model(shape.mesh())})),
      centre_(shape.hierarchy().centre),
      radius_(shape.radius()) {
  for (const Eigen::Vector3d& p : shape.mesh().vertices) {
    reach_ = std::max(reach_, (p - centre_).norm() + radius_);
  }
}

double FclShape::distance(const Eigen::Isometry3d& X_WA, const FclShape& B,
                          const Eigen::Isometry3d& X_WB) const {
  const fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  return fcl::distance(model_->mesh.get(), X_WA, B.model_->mesh.get(), X_WB, request, result) -
         radius_ - B.radius_;
}

bool FclShape::collides(const Eigen::Isometry3d& X_WA, const FclShape& B,
                        const Eigen::Isometry3d& X_WB) const {
  if (far_from(X_WA, B, X_WB)) {
    return false;
  }
  if (radius_ + B.radius_ > 0.0) {
    return distance(X_WA, B, X_WB) <= 0.0;
  }
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  return fcl::collide(model_->mesh.get(), X_WA, B.model_->mesh.get(), X_WB, request, result) > 0;
}

bool FclShape::far_from(const Eigen::Isometry3d& X_WA, const FclShape& B,
                        const Eigen::Isometry3d& X_WB) const {
  return (X_WA * centre_ - X_WB * B.centre_).norm() > reach_ + B.reach_;
}

}  // namespace firstcontact::test
