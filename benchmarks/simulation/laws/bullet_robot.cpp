#include "benchmarks/simulation/laws/bullet_robot.h"

#include <cmath>

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;

// [N s] or [N m s]  Bounds of motors without bounds.
constexpr double kBoundless = 1e30;

const LawLink& link_at(const LawRobot& robot, int k) {
  return robot.links[static_cast<std::size_t>(k)];
}

}  // namespace

// Links are numbered as in the scene. Bullet's have one number less: its root link is not counted.
BulletRobot::BulletRobot(const LawRobot& robot, const LawScene& scene, BulletShapes& shapes,
                         btMultiBodyDynamicsWorld& world)
    : robot_(robot), world_(world) {
  const LawLink& root = robot.links[0];
  const int count = static_cast<int>(robot.links.size());
  body_ = std::make_unique<btMultiBody>(count - 1, scalar(root.mass), vector(root.moments),
                                        !robot.is_free, false);
  body_->setBasePos(vector(Vector3d(robot.p_WL + robot.q_WL * root.p_LC)));
  body_->setWorldToBaseRot(rotation(robot.q_WL).inverse());
  body_->setLinearDamping(0);  // No scene has air.
  body_->setAngularDamping(0);
  body_->setHasSelfCollision(false);
  for (int k = 1; k < count; ++k) {
    add_joint(k);
  }
  body_->finalizeMultiDof();
  body_->useRK4Integration(scene.integrator == "RK4");
  if (robot.is_free) {
    body_->setBaseVel(vector(Vector3d(robot.v + robot.w.cross(robot.q_WL * root.p_LC))));
    body_->setBaseOmega(vector(robot.w));
  }
  for (int k = 1; k < count; ++k) {
    body_->setJointPos(k - 1, scalar(link_at(robot, k).position));
    body_->setJointVel(k - 1, scalar(link_at(robot, k).velocity));
  }
  world.addMultiBody(body_.get());
  motors_.resize(robot.links.size());
  for (int k = 0; k < count; ++k) {
    add_collider(k, scene.friction, shapes);
    add_motor(k);
  }
  place();
}

BulletRobot::~BulletRobot() {
  for (const auto& motor : motors_) {
    if (motor) {
      world_.removeMultiBodyConstraint(motor.get());
    }
  }
  for (const auto& collider : colliders_) {
    world_.removeCollisionObject(collider.get());
  }
  world_.removeMultiBody(body_.get());
}

void BulletRobot::add_joint(int k) {
  const LawLink& link = link_at(robot_, k);
  const btVector3 pivot = vector(Vector3d(link.p_PJ - link_at(robot_, link.parent).p_LC));
  const btVector3 middle = vector(link.p_LC);
  if (link.is_slide) {
    body_->setupPrismatic(k - 1, scalar(link.mass), vector(link.moments), link.parent - 1,
                          btQuaternion::getIdentity(), vector(link.axis), pivot, middle, true);
  } else {
    body_->setupRevolute(k - 1, scalar(link.mass), vector(link.moments), link.parent - 1,
                         btQuaternion::getIdentity(), vector(link.axis), pivot, middle, true);
  }
}

void BulletRobot::add_collider(int k, double friction, BulletShapes& shapes) {
  const LawLink& link = link_at(robot_, k);
  btCollisionShape* shape = shapes.add(link.shapes, link.p_LC);
  if (shape == nullptr) {
    return;
  }
  colliders_.push_back(std::make_unique<btMultiBodyLinkCollider>(body_.get(), k - 1));
  btMultiBodyLinkCollider& collider = *colliders_.back();
  collider.setCollisionShape(shape);
  collider.setFriction(scalar(std::sqrt(friction)));  // Bullet multiplies those of two bodies.
  world_.addCollisionObject(&collider, btBroadphaseProxy::DefaultFilter,
                            btBroadphaseProxy::AllFilter);
  if (k == 0) {
    body_->setBaseCollider(&collider);
  } else {
    body_->getLink(k - 1).m_collider = &collider;
  }
}

void BulletRobot::add_motor(int k) {
  const LawMotor& motor = link_at(robot_, k).motor;
  if (motor.kind != LawMotor::Kind::position && motor.kind != LawMotor::Kind::velocity) {
    return;
  }
  auto& added = motors_[static_cast<std::size_t>(k)];
  added = std::make_unique<btMultiBodyJointMotor>(body_.get(), k - 1, 0, scalar(kBoundless));
  added->finalizeMultiDof();
  world_.addMultiBodyConstraint(added.get());
}

void BulletRobot::drive_to(double time) {
  for (std::size_t k = 1; k < robot_.links.size(); ++k) {
    const LawLink& link = robot_.links[k];
    const LawMotor& motor = link.motor;
    const int joint = static_cast<int>(k) - 1;
    if (motor.kind == LawMotor::Kind::velocity) {
      motors_[k]->setVelocityTarget(scalar(value_at(motor.target, time)));
      continue;
    }
    if (motor.kind == LawMotor::Kind::position) {
      motors_[k]->setPositionTarget(scalar(value_at(motor.target, time)));
      continue;
    }
    const double speed = body_->getJointVel(joint);
    double force = -link.damping * speed;
    if (motor.kind == LawMotor::Kind::spring) {
      const double target = motor.target.front().second;
      force -= motor.stiffness * (body_->getJointPos(joint) - target) + motor.damping * speed;
    }
    body_->addJointTorque(joint, scalar(force));
  }
}

void BulletRobot::place() {
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> places;
  body_->forwardKinematics(rotations, places);
  body_->updateCollisionObjectWorldTransforms(rotations, places);
}

LawState BulletRobot::link(std::size_t k) {
  place();
  const LawLink& link = robot_.links[k];
  const btTransform pose = k == 0 ? body_->getBaseWorldTransform()
                                  : body_->getLink(static_cast<int>(k) - 1).m_cachedWorldTransform;
  std::vector<btVector3> turns(robot_.links.size());
  std::vector<btVector3> speeds(robot_.links.size());
  body_->compTreeLinkVelocities(turns.data(), speeds.data());
  return {.mass = link.mass,
          .moments = link.moments,
          .p_WC = vector(pose.getOrigin()),
          .q_WB = rotation(pose.getRotation()),
          .v = vector(btVector3(pose.getBasis() * speeds[k])),
          .w = vector(btVector3(pose.getBasis() * turns[k]))};
}

double BulletRobot::position(std::size_t k) const {
  return body_->getJointPos(static_cast<int>(k) - 1);
}

btVector3 BulletRobot::from_middle(int link, const Vector3d& point) const {
  return vector(Vector3d(point - link_at(robot_, link).p_LC));
}

}  // namespace firstcontact::benchmarks
