// Simulates the scenes of laws.py in Bullet with its defaults: ten sweeps of its solver, no
// sleeping.

#include <cmath>
#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "benchmarks/simulation/laws/law_scene.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;

btScalar scalar(double x) { return static_cast<btScalar>(x); }
btVector3 vector(const Vector3d& v) { return {scalar(v.x()), scalar(v.y()), scalar(v.z())}; }
btQuaternion rotation(const Eigen::Quaterniond& q) {
  return {scalar(q.x()), scalar(q.y()), scalar(q.z()), scalar(q.w())};
}
Vector3d vector(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

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
  }
  return nullptr;
}

class BulletLaw final : public LawEngine {
 public:
  explicit BulletLaw(const LawScene& scene) : scene_(scene) {
    world_.setGravity({0, 0, scalar(-scene.gravity)});
    for (const LawBody& body : scene.bodies) {
      add(body);
    }
  }
  ~BulletLaw() override {
    for (const auto& body : bodies_) {
      world_.removeRigidBody(body.get());
    }
  }

  void step() override {
    time_ += scene_.step;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const LawBody& body = scene_.bodies[k];
      if (body.motion == LawMotion::spins) {
        const double angle = time_ * body.w.norm();
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, body.w.normalized()));
        states_[k]->setWorldTransform(btTransform(rotation(turn * body.q_WB), vector(body.p_WB)));
      }
    }
    world_.stepSimulation(scalar(scene_.step), 0);
  }

  [[nodiscard]] LawBody body(std::size_t k) const override {
    LawBody now = scene_.bodies[k];
    const btRigidBody& body = *bodies_[k];
    const btQuaternion q = body.getWorldTransform().getRotation();
    now.p_WB = vector(body.getWorldTransform().getOrigin());
    now.q_WB = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z());
    now.v = vector(body.getLinearVelocity());
    now.w = vector(body.getAngularVelocity());
    return now;
  }

  [[nodiscard]] std::vector<double> positions(std::size_t /*robot*/) const override { return {}; }

 private:
  void add(const LawBody& body) {
    const bool is_free = body.motion == LawMotion::free;
    shapes_.push_back(shape_of(body.shape));
    if (!body.p_CS.isZero()) {
      auto moved = std::make_unique<btCompoundShape>();
      moved->addChildShape(btTransform(btQuaternion::getIdentity(), vector(body.p_CS)),
                           shapes_.back().get());
      shapes_.push_back(std::move(moved));
    }
    states_.push_back(std::make_unique<btDefaultMotionState>(
        btTransform(rotation(body.q_WB), vector(body.p_WB))));
    btRigidBody::btRigidBodyConstructionInfo info(
        scalar(is_free ? body.mass : 0.0), states_.back().get(), shapes_.back().get(),
        is_free ? vector(body.moments) : btVector3{0, 0, 0});
    info.m_friction = scalar(std::sqrt(scene_.friction));  // Bullet multiplies the values of the
                                                           // two bodies.
    info.m_restitution = scalar(is_free ? body.restitution : 1.0);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    btRigidBody& added = *bodies_.back();
    added.setActivationState(DISABLE_DEACTIVATION);
    if (body.motion == LawMotion::spins) {
      added.setCollisionFlags(added.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    }
    world_.addRigidBody(&added);
    added.setLinearVelocity(vector(body.v));
    added.setAngularVelocity(vector(body.w));
  }

  LawScene scene_;
  double time_ = 0.0;  // [s]
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btDefaultMotionState>> states_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  return simulate_law(argc, argv, false,
                      [](const LawScene& scene) { return std::make_unique<BulletLaw>(scene); });
}
