/// @file
/// FCL 0.7's methods for the first contact of two meshes, behind one small class.

#pragma once

#include <memory>

#include <firstcontact/geometry/mesh.h>

#include "benchmarks/support/random_motion.h"

namespace firstcontact::benchmarks {

struct PeerAnswer {
  bool contact = false;
  double t = 1.0;  ///< [-]  Time of contact, or 1.
};

/// Two meshes as FCL models, with three ways to compute their first contact by FCL.
class FclPeer {
 public:
  FclPeer(const Mesh& A, const Mesh& B);
  ~FclPeer();
  FclPeer(FclPeer&&) noexcept;
  FclPeer& operator=(FclPeer&&) noexcept;

  /// [m]  Computes fcl::distance at t; not positive where the meshes meet.
  [[nodiscard]] double distance(const PlainMotionPair& motions, double t) const;

  /// Advances conservatively by fcl::distance, in steps of distance / speed.
  ///
  /// The relative speed of any two points is at most |translation| + sum of angle x radius. Contact
  /// is a distance of at most `tolerance` [m]. The result is correct, and so it is the reference.
  [[nodiscard]] PeerAnswer distance_loop(const PlainMotionPair& motions, double tolerance) const;

  /// Runs FCL's advancement on the oriented boxes and swept spheres, from its detail headers.
  ///
  /// The public function refits both trees at every step; this one leaves them as they are.
  [[nodiscard]] PeerAnswer oriented_advancement(const PlainMotionPair& motions) const;

  /// Runs fcl::continuousCollide with CCDC_CONSERVATIVE_ADVANCEMENT on OBBRSS models.
  [[nodiscard]] PeerAnswer continuous_collide(const PlainMotionPair& motions) const;

 private:
  struct Models;
  std::unique_ptr<Models> models_;
};

}  // namespace firstcontact::benchmarks
