/// @file
/// How two bodies move against each other: all that a query of two bodies knows of their motions.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/relative_state.h>

namespace firstcontact {

/// Two motions over the step, t in [0, 1], piece after piece. Pieces are entered in any order; what
/// is asked after that belongs to the piece entered last, from the time of entering to its end.
class FIRSTCONTACT_API PairMotion {
 public:
  virtual ~PairMotion() = default;

  /// Enters a piece that contains t; where one ends at t, the one after it. Returns its end.
  virtual double enter(double t) = 0;

  /// Both bodies at a time of the piece.
  [[nodiscard]] virtual RelativeState state(double t) const = 0;

  /// [m per step]  No distance of two points within the radii from the bodies' points C changes
  /// faster during the piece.
  [[nodiscard]] virtual double speed_bound(double radius_A, double radius_B) const = 0;

  /// [-]  The motion, as a part of the shapes' size, below which boxes are not placed anew.
  ///
  /// A bound from a little earlier loses only a part of second order in time. The number is larger
  /// where a state is dear.
  [[nodiscard]] virtual double boxes_window() const { return 0x1p-9; }

  /// [-]  Boxes farther apart than this part of their sizes are bounded once more when they are
  /// due, nearer ones opened. The less the longer bodies stay beside each other.
  [[nodiscard]] virtual double far_boxes() const { return 0.15; }

  /// [-]  The factor of two boxes' sizes from which the larger is opened alone; below it both are.
  ///
  /// The number is larger where boxes that come near are seldom of one size.
  [[nodiscard]] virtual double larger_boxes() const { return 1.5; }

  /// [m]  A's point C in the frame of the motions, where points are reported.
  [[nodiscard]] virtual Eigen::Vector3d origin(double t) const = 0;

 protected:
  PairMotion() = default;
  PairMotion(const PairMotion&) = default;
  PairMotion& operator=(const PairMotion&) = default;
};

}  // namespace firstcontact
