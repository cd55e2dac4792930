/// @file
/// The verifier's own arithmetic for what hangs on a chain of joints.

#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/interval_vector.h>
#include <firstcontact/robot/tracking_error.h>
#include <firstcontact/verification/detail/coordinate_course.h>
#include <firstcontact/verification/detail/covered_motion.h>
#include <firstcontact/verification/detail/rigid_motion.h>

namespace firstcontact::detail {

/// A joint that moves, in one piece of its coordinates: slides along fixed directions, then a turn.
struct ChainJoint {
  struct Slide {
    IntervalVector3 direction;  ///< [-]  In J.
    const CoordinatePolynomial* coordinate = nullptr;
  };
  IntervalTransform before;  ///< From the child of the joint before, or from the frame, to J.
  IntervalVector3 axis;      ///< [-]  Unit, in J.
  const CoordinatePolynomial* angle = nullptr;
  std::vector<Slide> slides = {};
  TrackingError error = {};
};

/// The motion of a frame with a pivot at its end of a chain of joints.
///
/// Bounds of accelerations go along the chain: a point at a distance r from the origin of a frame
/// accelerates by at most a + (e + w^2) r, with a of the origin, e and w of the turn of the frame;
/// a joint adds its own rates to w, their derivatives and w times them to e, and what it slides to
/// a, with Coriolis' term. (The recursion of J. Y. S. Luh, M. W. Walker, R. P. C. Paul, "On-line
/// computational scheme for mechanical manipulators", Journal of Dynamic Systems, Measurement, and
/// Control 102 (1980), in sizes.)
class ChainMotion : public CoveredMotion {
 public:
  /// @param base    where the chain begins, in the world; none where the chain begins in a frame
  ///                that serves as the world
  /// @param tail    from the child of the last joint to the pivot
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
