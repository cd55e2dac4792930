/// @file
/// The verifier's own arithmetic for a frame on a chain of joints.

#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/interval_vector.h>
#include <firstcontact/robot/tracking_error.h>
#include <firstcontact/separation/detail/covered_motion.h>
#include <firstcontact/verification/detail/coordinate_course.h>
#include <firstcontact/verification/detail/rigid_motion.h>

namespace firstcontact::detail {

/// A joint that moves, in one piece of its coordinates: slides along fixed directions, then a turn;
/// or a rigid motion of its own.
struct ChainJoint {
  struct Slide {
    IntervalVector3 direction;  ///< [-]  In J.
    const CoordinatePolynomial* coordinate = nullptr;
  };
  IntervalTransform before;  ///< Transform to J from the child of the joint before, or from the
                             ///< frame.
  IntervalVector3 axis;      ///< [-]  Unit, in J.
  const CoordinatePolynomial* angle = nullptr;
  std::vector<Slide> slides = {};
  TrackingError error = {};
  /// The motion of the child's origin in J; null where the joint slides and turns.
  const RigidMotion* free = nullptr;
};

/// The motion of a frame with a pivot at its end of a chain of joints.
///
/// Bounds of accelerations go along the chain. A point at a distance r from the origin of a frame
/// accelerates by at most a + (e + w^2) r. a is that of the origin; e and w bound the turn of the
/// frame. A joint adds its own rates to w. It adds their derivatives, and w times the rates, to e.
/// Its slides, with Coriolis' term, add to a. So does the way of a joint that moves freely.
///
/// Source: the recursion of J. Y. S. Luh, M. W. Walker, R. P. C. Paul, "On-line computational
/// scheme for mechanical manipulators", Journal of Dynamic Systems, Measurement, and Control 102
/// (1980), in sizes.
class ChainMotion : public CoveredMotion {
 public:
  /// @param base    motion of the chain's begin in the world; none where the chain begins in a
  ///                frame that serves as the world
  /// @param tail    transform from the child of the last joint to the pivot
  ChainMotion(double from, double to, std::shared_ptr<const RigidMotion> base,
              std::vector<ChainJoint> joints, const IntervalTransform& tail);

  [[nodiscard]] const Eigen::Vector3d& position() const override;
  [[nodiscard]] IntervalTransform enclosure(double time,
                                            const Eigen::Vector3d& origin) const override;
  [[nodiscard]] BodyInstant around(double time, double half,
                                   const Eigen::Vector3d& origin) const override;

 private:
  std::shared_ptr<const RigidMotion> base_;
  std::vector<ChainJoint> joints_;
  IntervalTransform tail_;
  bool has_errors_ = false;
};

}  // namespace firstcontact::detail
