/// @file
/// FCL's dynamic broad phase on a scene of many bodies of one shape.

#pragma once

#include <memory>
#include <vector>

#include <firstcontact/geometry/mesh.h>

#include "benchmarks/support/random_motion.h"

namespace firstcontact::benchmarks {

class FclScene {
 public:
  FclScene(const Mesh& mesh, const std::vector<PlainMotion>& motions);
  ~FclScene();

  struct Answer {
    bool contact = false;
    double t = 1.0;  ///< [-]  Time of the first sample in collision, or 1.
  };
  /// Tests `count` instants from 0 to 1 with fcl::DynamicAABBTreeCollisionManager until one has a
  /// collision.
  ///
  /// Collisions between two instants are missed.
  [[nodiscard]] Answer sample(int count);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace firstcontact::benchmarks
