/// @file
/// What FCL 0.7 offers for the same question, behind one small class.

#pragma once

#include <memory>

#include <firstcontact/geometry/mesh.h>

#include "benchmarks/support/random_motion.h"

namespace firstcontact::benchmarks {

struct PeerAnswer {
  bool contact = false;
  double t = 1.0;  ///< [-]  Of contact, or 1.
};

/// Two meshes as FCL models, and three ways to ask FCL for their first contact.
class FclPeer {
 public:
  FclPeer(const Mesh& A, const Mesh& B);
  ~FclPeer();
  FclPeer(FclPeer&&) noexcept;
  FclPeer& operator=(FclPeer&&) noexcept;

  /// [m]  fcl::distance at t; not positive where the meshes meet.
  [[nodiscard]] double distance(const PlainMotionPair& motions, double t) const;

  /// Conservative advancement over fcl::distance: steps of distance / speed, where the relative
  /// speed of any two points is at most |translation| + sum of angle x radius. Contact is a
  /// distance of at most `tolerance` [m]. Right, and so the reference.
  [[nodiscard]] PeerAnswer distance_loop(const PlainMotionPair& motions, double tolerance) const;

  /// FCL's advancement on the oriented boxes and swept spheres as they are, from its detail
  /// headers: the public function refits both trees at every step instead.
  [[nodiscard]] PeerAnswer oriented_advancement(const PlainMotionPair& motions) const;

  /// fcl::continuousCollide with CCDC_CONSERVATIVE_ADVANCEMENT on OBBRSS models.
  [[nodiscard]] PeerAnswer continuous_collide(const PlainMotionPair& motions) const;

 private:
  struct Models;
  std::unique_ptr<Models> models_;
};

}  // namespace firstcontact::benchmarks
