// Simulates boxes that fall, rest and pile up, in Bullet with its defaults: one thread, ten sweeps
// of its solver, sleeping bodies.

#include <cmath>

#include <btBulletDynamicsCommon.h>

#include "benchmarks/simulation/piles/piles.h"

namespace firstcontact::benchmarks {
namespace {

btScalar scalar(double x) { return static_cast<btScalar>(x); }
btVector3 vector(const Eigen::Vector3d& v) { return {scalar(v.x()), scalar(v.y()), scalar(v.z())}; }

class BulletPile final : public PileWorld {
 public:
  explicit BulletPile(const Pile& pile) {
    world_.setGravity({0, 0, scalar(-9.81)});
    btTransform floor = btTransform::getIdentity();
    floor.setOrigin({0, 0, scalar(-0.5 * kFloorThick)});
    add(0.0, floor_shape_, floor);
    btVector3 inertia;
    box_shape_.calculateLocalInertia(scalar(kBoxMass), inertia);
    for (std::size_t k = 0; k < pile.boxes.size(); ++k) {
      const Eigen::Quaterniond q(pile.boxes[k].linear());
      const btQuaternion rotation(scalar(q.x()), scalar(q.y()), scalar(q.z()), scalar(q.w()));
      add(kBoxMass, box_shape_, btTransform(rotation, vector(pile.boxes[k].translation())), inertia)
          .setAngularVelocity(vector(pile.spins[k]));
    }
  }
  ~BulletPile() override {
    for (const auto& body : bodies_) {
      world_.removeRigidBody(body.get());
    }
  }

  // One step of exactly this length, without interpolation.
  void step() override { world_.stepSimulation(scalar(kStep), 0); }

 private:
  btRigidBody& add(double mass, btCollisionShape& shape, const btTransform& X_WB,
                   const btVector3& inertia = {0, 0, 0}) {
    btRigidBody::btRigidBodyConstructionInfo info(scalar(mass), nullptr, &shape, inertia);
    info.m_startWorldTransform = X_WB;
    info.m_friction = scalar(std::sqrt(kFriction));  // Bullet multiplies the values of the two
                                                     // bodies.
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(bodies_.back().get());
    return *bodies_.back();
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btBoxShape floor_shape_{vector({kFloorHalf, kFloorHalf, 0.5 * kFloorThick})};
  btBoxShape box_shape_{vector(Eigen::Vector3d::Constant(kBoxHalf))};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  return measure_piles(argc, argv, "Bullet",
                       [](const Pile& pile) { return std::make_unique<BulletPile>(pile); });
}
