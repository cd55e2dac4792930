// Simulates boxes shot at a thin plate, in Bullet, with the plate as a box and as a mesh of
// triangles. Bullet runs with and without its continuous collision detection, which sweeps a sphere
// in place of the box.

#include <btBulletDynamicsCommon.h>

#include "benchmarks/simulation/tunnelling/shots.h"

namespace firstcontact::benchmarks {
namespace {

/// [1/m]  Lengths are in centimetres, as Bullet is made for bodies of about size 1.
constexpr double kUnits = 100.0;

btVector3 length(const Eigen::Vector3d& v) {
  const Eigen::Vector3d scaled = kUnits * v;
  return {static_cast<btScalar>(scaled.x()), static_cast<btScalar>(scaled.y()),
          static_cast<btScalar>(scaled.z())};
}

btVector3 plain(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

std::unique_ptr<btTriangleMesh> triangles_of(const BoxMesh& mesh) {
  auto triangles = std::make_unique<btTriangleMesh>();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    triangles->addTriangle(length(mesh.corners[t[0]]), length(mesh.corners[t[1]]),
                           length(mesh.corners[t[2]]));
  }
  return triangles;
}

struct Use {
  bool plate_is_mesh = false;
  double swept_radius = 0.0;  ///< [m]  Radius of the sphere of continuous detection; 0 for none.
};

class BulletFlight final : public Flight {
 public:
  BulletFlight(const Shot& shot, const Use& use) {
    world_.setGravity({0, 0, 0});
    add_plate(use);
    add_box(shot, use);
  }
  ~BulletFlight() override {
    world_.removeRigidBody(box_.get());
    world_.removeRigidBody(plate_.get());
  }

  void step() override {
    // One step of exactly this length, without interpolation.
    world_.stepSimulation(static_cast<btScalar>(kStep), 0);
  }

  [[nodiscard]] Eigen::Isometry3d box() const override {
    const btTransform& X = box_->getWorldTransform();
    const btQuaternion q = X.getRotation();
    const btVector3& p = X.getOrigin();
    return Eigen::Translation3d(Eigen::Vector3d(p.x(), p.y(), p.z()) / kUnits) *
           Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized();
  }

 private:
  void add_plate(const Use& use) {
    if (use.plate_is_mesh) {
      triangles_ = triangles_of(plate_mesh());
      plate_shape_ = std::make_unique<btBvhTriangleMeshShape>(triangles_.get(), true);
    } else {
      plate_shape_ =
          std::make_unique<btBoxShape>(length({kPlateHalfThick, kPlateHalf, kPlateHalf}));
    }
    // The default of 4 cm would be thicker than the plate; a box shape includes the margin in its
    // size.
    plate_shape_->setMargin(static_cast<btScalar>(0.2 * kUnits * kPlateHalfThick));
    plate_ = std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(0, nullptr, plate_shape_.get()));
    plate_->setFriction(0);
    world_.addRigidBody(plate_.get());
  }

  void add_box(const Shot& shot, const Use& use) {
    box_shape_ = std::make_unique<btBoxShape>(length(Eigen::Vector3d::Constant(kBoxHalf)));
    btVector3 inertia;
    box_shape_->calculateLocalInertia(static_cast<btScalar>(kBoxMass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(kBoxMass), nullptr,
                                                  box_shape_.get(), inertia);
    const Eigen::Quaterniond q(shot.X_WB.linear());
    info.m_startWorldTransform =
        btTransform(btQuaternion(static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()),
                                 static_cast<btScalar>(q.z()), static_cast<btScalar>(q.w())),
                    length(shot.X_WB.translation()));
    box_ = std::make_unique<btRigidBody>(info);
    box_->setFriction(0);
    box_->setActivationState(DISABLE_DEACTIVATION);
    box_->setLinearVelocity(length({shot.speed, 0, 0}));
    box_->setAngularVelocity(plain(shot.spin));
    if (use.swept_radius > 0.0) {
      box_->setCcdMotionThreshold(static_cast<btScalar>(0.5 * kUnits * kBoxHalf));
      box_->setCcdSweptSphereRadius(static_cast<btScalar>(kUnits * use.swept_radius));
    }
    world_.addRigidBody(box_.get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::unique_ptr<btTriangleMesh> triangles_;
  std::unique_ptr<btCollisionShape> plate_shape_;
  std::unique_ptr<btCollisionShape> box_shape_;
  std::unique_ptr<btRigidBody> plate_;
  std::unique_ptr<btRigidBody> box_;
};

Contender contender(const char* name, const Use& use) {
  return {name, [use](const Shot& shot) { return std::make_unique<BulletFlight>(shot, use); }};
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  // A sphere inside the box, as the manual advises, lets corners through. A sphere around the box
  // stops it before it touches.
  constexpr double kInside = 0.9 * kBoxHalf;
  constexpr double kAround = 1.75 * kBoxHalf;
  return shoot(argc, argv,
               {contender("Bullet, plate a box", {}),
                contender("Bullet, plate a mesh", {.plate_is_mesh = true}),
                contender("Bullet, CCD by a sphere inside, plate a box", {.swept_radius = kInside}),
                contender("Bullet, CCD by a sphere inside, plate a mesh",
                          {.plate_is_mesh = true, .swept_radius = kInside}),
                contender("Bullet, CCD by a sphere around, plate a box", {.swept_radius = kAround}),
                contender("Bullet, CCD by a sphere around, plate a mesh",
                          {.plate_is_mesh = true, .swept_radius = kAround})});
}
