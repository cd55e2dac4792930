// Simulates boxes shot at a thin plate, in DART, with its default collision detector, FCL, and with
// that of Bullet.

#include <dart/collision/bullet/BulletCollisionDetector.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>

#include "benchmarks/simulation/tunnelling/shots.h"

namespace firstcontact::benchmarks {
namespace {

using dart::dynamics::BoxShape;
using dart::dynamics::Skeleton;

/// Makes a skeleton of one body, a box.
///
/// @param half  [m]  half the size in x, y, z
template <class Joint>
dart::dynamics::SkeletonPtr one_box(const std::string& name, const Eigen::Vector3d& half) {
  const dart::dynamics::SkeletonPtr skeleton = Skeleton::create(name);
  dart::dynamics::BodyNode* body = skeleton->createJointAndBodyNodePair<Joint>().second;
  const auto shape = std::make_shared<BoxShape>(2.0 * half);
  auto* node =
      body->createShapeNodeWith<dart::dynamics::CollisionAspect, dart::dynamics::DynamicsAspect>(
          shape);
  node->getDynamicsAspect()->setFrictionCoeff(0.0);
  dart::dynamics::Inertia inertia;
  inertia.setMass(kBoxMass);
  inertia.setMoment(shape->computeInertia(kBoxMass));
  body->setInertia(inertia);
  return skeleton;
}

class DartFlight final : public Flight {
 public:
  DartFlight(const Shot& shot, const dart::collision::CollisionDetectorPtr& detector) {
    world_->setTimeStep(kStep);
    world_->setGravity(Eigen::Vector3d::Zero());
    if (detector != nullptr) {
      world_->getConstraintSolver()->setCollisionDetector(detector);
    }
    world_->addSkeleton(
        one_box<dart::dynamics::WeldJoint>("plate", {kPlateHalfThick, kPlateHalf, kPlateHalf}));
    const auto box = one_box<dart::dynamics::FreeJoint>("box", Eigen::Vector3d::Constant(kBoxHalf));
    auto* joint = static_cast<dart::dynamics::FreeJoint*>(box->getJoint(0));
    joint->setTransform(shot.X_WB);
    joint->setLinearVelocity({shot.speed, 0, 0});
    joint->setAngularVelocity(shot.spin);
    world_->addSkeleton(box);
    body_ = box->getBodyNode(0);
  }

  void step() override { world_->step(); }
  [[nodiscard]] Eigen::Isometry3d box() const override { return body_->getWorldTransform(); }

 private:
  dart::simulation::WorldPtr world_ = dart::simulation::World::create();
  dart::dynamics::BodyNode* body_ = nullptr;
};

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  return shoot(
      argc, argv,
      {{"DART", [](const Shot& shot) { return std::make_unique<DartFlight>(shot, nullptr); }},
       {"DART with Bullet's detector", [](const Shot& shot) {
          return std::make_unique<DartFlight>(shot,
                                              dart::collision::BulletCollisionDetector::create());
        }}});
}
