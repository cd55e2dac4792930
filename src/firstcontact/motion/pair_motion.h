/// @file
/// The relative motion of two bodies: all that a query of two bodies knows of their motions.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/relative_state.h>

namespace firstcontact {

/// Two motions over the step, t in [0, 1], piece after piece.
///
/// Pieces are entered in any order. The other functions belong to the piece entered last, from the
/// time of entering to its end.
class FIRSTCONTACT_API PairMotion {
 public:
  virtual ~PairMotion() = default;

  /// Enters a piece that contains t; where a piece ends at t, the next one. Returns its end.
  virtual double enter(double t) = 0;

  /// The state of both bodies at a time of the piece.
  [[nodiscard]] virtual RelativeState state(double t) const = 0;

  /// [m per step]  Bounds the rate of every distance between two points during the piece. The
  /// points are within the radii from the bodies' points C.
  [[nodiscard]] virtual double speed_bound(double radius_A, double radius_B) const = 0;

  /// Whether chains of joints carry the bodies.
  ///
  /// Then a state takes long to compute, and bodies stay beside each other for long. It steers how
  /// a search proceeds, not what the search proves.
  [[nodiscard]] virtual bool follows_joints() const { return false; }

  /// [m]  A's point C in the frame of the motions, in which points are reported.
  [[nodiscard]] virtual Eigen::Vector3d origin(double t) const = 0;

 protected:
  PairMotion() = default;
  PairMotion(const PairMotion&) = default;
  PairMotion& operator=(const PairMotion&) = default;
};

}  // namespace firstcontact
