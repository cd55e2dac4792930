// Simulates the scenes of laws.py in Bullet with its defaults: ten sweeps of its solver, no
// sleeping. Robots are its multi-bodies.

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <btBulletDynamicsCommon.h>

#include "benchmarks/simulation/laws/bullet_robot.h"
#include "benchmarks/simulation/laws/bullet_shapes.h"
#include "benchmarks/simulation/laws/law_scene.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;

class BulletLaw final : public LawEngine {
 public:
  explicit BulletLaw(const LawScene& scene) : scene_(scene) {
    if (scene.integrator == "RK4" && scene.robots.empty()) {
      throw NotForPeer();  // Its other bodies have one integrator.
    }
    world_.setGravity({0, 0, scalar(-scene.gravity)});
    for (const LawBody& body : scene.bodies) {
      add(body);
    }
    for (const LawRobot& robot : scene.robots) {
      robots_.push_back(std::make_unique<BulletRobot>(robot, scene, shapes_, world_));
    }
    for (const LawTie& tie : scene.ties) {
      add(tie);
    }
  }
  ~BulletLaw() override {
    for (const auto& pin : pins_) {
      world_.removeMultiBodyConstraint(pin.get());
    }
    for (const auto& spring : springs_) {
      world_.removeConstraint(spring.get());
    }
    robots_.clear();
    for (const auto& body : bodies_) {
      world_.removeRigidBody(body.get());
    }
  }

  void step() override {
    const double next = ++steps_ * scene_.step;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const LawBody& body = scene_.bodies[k];
      if (body.motion == LawMotion::spins) {
        const double angle = next * body.start.w.norm();
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, body.start.w.normalized()));
        states_[k]->setWorldTransform(
            btTransform(rotation(turn * body.start.q_WB), vector(body.start.p_WC)));
      }
    }
    for (const auto& robot : robots_) {
      robot->drive_to(next);
    }
    world_.stepSimulation(scalar(scene_.step), 0);
  }

  [[nodiscard]] LawState body(std::size_t k) override {
    LawState now = scene_.bodies[k].start;
    const btRigidBody& body = *bodies_[k];
    now.p_WC = vector(body.getWorldTransform().getOrigin());
    now.q_WB = rotation(body.getWorldTransform().getRotation());
    now.v = vector(body.getLinearVelocity());
    now.w = vector(body.getAngularVelocity());
    return now;
  }

  [[nodiscard]] LawState link(std::size_t robot, std::size_t k) override {
    return robots_[robot]->link(k);
  }

  [[nodiscard]] double position(std::size_t robot, std::size_t k) override {
    return robots_[robot]->position(k);
  }

 private:
  void add(const LawBody& body) {
    const LawState& start = body.start;
    const bool is_free = body.motion == LawMotion::free || body.motion == LawMotion::plane;
    states_.push_back(std::make_unique<btDefaultMotionState>(
        btTransform(rotation(start.q_WB), vector(start.p_WC))));
    btRigidBody::btRigidBodyConstructionInfo info(
        scalar(is_free ? start.mass : 0.0), states_.back().get(),
        shapes_.add(body.shapes, Vector3d::Zero()),
        is_free ? vector(start.moments) : btVector3{0, 0, 0});
    info.m_friction = scalar(std::sqrt(scene_.friction));  // Bullet multiplies the values of the
                                                           // two bodies.
    info.m_restitution = scalar(is_free ? body.restitution : 1.0);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    btRigidBody& added = *bodies_.back();
    added.setActivationState(DISABLE_DEACTIVATION);
    if (body.motion == LawMotion::spins) {
      added.setCollisionFlags(added.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    }
    if (body.motion == LawMotion::plane) {
      added.setLinearFactor({1, 0, 1});
      added.setAngularFactor({0, 1, 0});
    }
    world_.addRigidBody(&added);
    added.setLinearVelocity(vector(start.v));
    added.setAngularVelocity(vector(start.w));
  }

  void add(const LawTie& tie) {
    if (tie.kind == LawTie::Kind::pin) {
      add_pin(tie);
      return;
    }
    const LawTie::End& load = tie.ends[1];
    if (tie.ends[0].member >= 0 || load.robot >= 0) {
      throw NotForPeer();
    }
    btRigidBody& body = *bodies_.at(static_cast<std::size_t>(load.member));
    springs_.push_back(std::make_unique<btGeneric6DofSpring2Constraint>(
        btTypedConstraint::getFixedBody(), body,
        btTransform(btQuaternion::getIdentity(), vector(tie.ends[0].point)),
        btTransform(btQuaternion::getIdentity(), vector(load.point))));
    btGeneric6DofSpring2Constraint& spring = *springs_.back();
    for (int axis = 0; axis < 6; ++axis) {
      spring.setLimit(axis, 1, -1);  // Free.
    }
    spring.enableSpring(2, true);
    spring.setStiffness(2, scalar(tie.stiffness));
    spring.setEquilibriumPoint(2, scalar(-tie.length));  // The load hangs below.
    world_.addConstraint(&spring);
  }

  void add_pin(const LawTie& tie) {
    const LawTie::End& a = tie.ends[0];
    const LawTie::End& b = tie.ends[1];
    if (a.robot < 0 || b.robot < 0) {
      throw NotForPeer();
    }
    BulletRobot& first = *robots_[static_cast<std::size_t>(a.robot)];
    BulletRobot& second = *robots_[static_cast<std::size_t>(b.robot)];
    pins_.push_back(std::make_unique<btMultiBodyPoint2Point>(
        &first.multi_body(), a.member - 1, &second.multi_body(), b.member - 1,
        first.from_middle(a.member, a.point), second.from_middle(b.member, b.point)));
    pins_.back()->finalizeMultiDof();
    world_.addMultiBodyConstraint(pins_.back().get());
  }

  LawScene scene_;
  int steps_ = 0;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  BulletShapes shapes_;
  std::vector<std::unique_ptr<btDefaultMotionState>> states_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<BulletRobot>> robots_;
  std::vector<std::unique_ptr<btGeneric6DofSpring2Constraint>> springs_;
  std::vector<std::unique_ptr<btMultiBodyPoint2Point>> pins_;
};

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  return simulate_law(argc, argv, [](const LawScene& scene) -> std::unique_ptr<LawEngine> {
    return std::make_unique<BulletLaw>(scene);
  });
}
