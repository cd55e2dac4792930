/// @file
/// Bullet's forms of what scenes of laws.py have.

#pragma once

#include <memory>
#include <vector>

#include <btBulletCollisionCommon.h>

#include "benchmarks/simulation/laws/law_scene.h"

namespace firstcontact::benchmarks {

inline btScalar scalar(double x) { return static_cast<btScalar>(x); }
inline btVector3 vector(const Eigen::Vector3d& v) {
  return {scalar(v.x()), scalar(v.y()), scalar(v.z())};
}
inline Eigen::Vector3d vector(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline btQuaternion rotation(const Eigen::Quaterniond& q) {
  return {scalar(q.x()), scalar(q.y()), scalar(q.z()), scalar(q.w())};
}
inline Eigen::Quaterniond rotation(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// The shapes of a world.
class BulletShapes {
 public:
  /// Adds the shapes of a body.
  ///
  /// @param p_BC  [m]  The centre of mass in the frame of the shapes
  /// @returns one shape whose origin is the centre of mass; nothing where there are none
  btCollisionShape* add(const std::vector<LawShape>& shapes, const Eigen::Vector3d& p_BC);

 private:
  btCollisionShape* add(const LawShape& shape);

  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
};

}  // namespace firstcontact::benchmarks
