#include "benchmarks/simulation/laws/bullet_shapes.h"

namespace firstcontact::benchmarks {
namespace {

std::unique_ptr<btCollisionShape> hull_of(const LawShape& shape) {
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Eigen::Vector3d& corner : shape.corners) {
    hull->addPoint(vector(corner), false);
  }
  hull->setMargin(0);  // Its margin lies outside; that of a box lies inside.
  hull->recalcLocalAabb();
  return hull;
}

std::unique_ptr<btCollisionShape> shape_of(const LawShape& shape) {
  switch (shape.kind) {
    case LawShape::Kind::box:
      return std::make_unique<btBoxShape>(vector(shape.half));
    case LawShape::Kind::sphere:
      return std::make_unique<btSphereShape>(scalar(shape.half.x()));
    case LawShape::Kind::cylinder:
      return std::make_unique<btCylinderShapeZ>(vector(shape.half));
    case LawShape::Kind::capsule:
      return std::make_unique<btCapsuleShapeZ>(scalar(shape.half.x()),
                                               scalar(2.0 * shape.half.z()));
    case LawShape::Kind::ellipsoid: {
      const btVector3 middle(0, 0, 0);
      const btScalar radius = 1;
      auto ball = std::make_unique<btMultiSphereShape>(&middle, &radius, 1);
      ball->setLocalScaling(vector(shape.half));
      return ball;
    }
    case LawShape::Kind::hull:
      return hull_of(shape);
  }
  return nullptr;
}

}  // namespace

btCollisionShape* BulletShapes::add(const LawShape& shape) {
  shapes_.push_back(shape_of(shape));
  return shapes_.back().get();
}

btCollisionShape* BulletShapes::add(const std::vector<LawShape>& shapes,
                                    const Eigen::Vector3d& p_BC) {
  if (shapes.empty()) {
    return nullptr;
  }
  if (shapes.size() == 1 && shapes[0].p_BS == p_BC) {
    return add(shapes[0]);
  }
  auto compound = std::make_unique<btCompoundShape>();
  for (const LawShape& shape : shapes) {
    compound->addChildShape(
        btTransform(btQuaternion::getIdentity(), vector(Eigen::Vector3d(shape.p_BS - p_BC))),
        add(shape));
  }
  shapes_.push_back(std::move(compound));
  return shapes_.back().get();
}

}  // namespace firstcontact::benchmarks
