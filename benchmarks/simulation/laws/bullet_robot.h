/// @file
/// A robot in Bullet: a multi-body.

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "benchmarks/simulation/laws/bullet_shapes.h"
#include "benchmarks/simulation/laws/law_scene.h"

namespace firstcontact::benchmarks {

class BulletRobot {
 public:
  /// @param shapes  Outlives the robot.
  /// @param world  Likewise; the robot is in it until it is destroyed.
  BulletRobot(const LawRobot& robot, const LawScene& scene, BulletShapes& shapes,
              btMultiBodyDynamicsWorld& world);
  ~BulletRobot();
  BulletRobot(const BulletRobot&) = delete;
  BulletRobot& operator=(const BulletRobot&) = delete;

  /// Sets forces and targets of motors for the step that ends at a time [s].
  void drive_to(double time);

  [[nodiscard]] LawState link(std::size_t k);
  [[nodiscard]] double position(std::size_t k) const;

  [[nodiscard]] btMultiBody& multi_body() { return *body_; }
  /// Returns a point of a link from the link's centre of mass.
  [[nodiscard]] btVector3 from_middle(int link, const Eigen::Vector3d& point) const;

 private:
  void add_joint(int k);
  void add_collider(int k, double friction, BulletShapes& shapes);
  void add_motor(int k);
  void place();

  LawRobot robot_;
  btMultiBodyDynamicsWorld& world_;
  std::unique_ptr<btMultiBody> body_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btMultiBodyJointMotor>> motors_;  // One for each link, or nothing.
};

}  // namespace firstcontact::benchmarks
