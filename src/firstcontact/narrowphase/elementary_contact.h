/// @file
/// The classical elementary tests of moving features: what they ask and what they answer.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/relative_motion.h>
#include <firstcontact/narrowphase/oscillation.h>

namespace firstcontact {

/// The outcome of an elementary test.
enum class ElementaryVerdict {
  free,        ///< Proven: the features do not meet in the window.
  contact,     ///< They meet in [t_lower, t_upper], where their coplanarity function has one root.
  degenerate,  ///< Proven free before t_lower, where they touch up to rounding (or the steps are
               ///< spent); nothing known after it.
};

struct ElementaryContact {
  ElementaryVerdict verdict = ElementaryVerdict::degenerate;
  /// [-]  The features provably do not meet in the window before this time.
  double t_lower = 0.0;
  /// [-]  The end of the isolating interval for `contact`, else equal to t_lower.
  double t_upper = 0.0;
  /// Whether it is proven that the features meet in [t_lower, t_upper], for `contact`.
  ///
  /// The proof is a change of sign of the coplanarity function and a point inside both features.
  /// Otherwise they touch there up to rounding: on a feature's border, along an edge, or at an end
  /// of the window.
  bool existence_proven = false;
  int steps = 0;  ///< Evaluations of the motion.
};

/// The part of the step that is searched, and how far.
struct ElementaryOptions {
  double t_begin = 0.0;           ///< [-]  Clipped to the piece of the motion.
  double t_end = 1.0;             ///< [-]  Belongs to the window; clipped like t_begin.
  double time_tolerance = 1e-10;  ///< [-]  Aim of t_upper - t_lower; rounding may leave more.
  int maximum_steps = 10'000;     ///< Beyond this many steps the test is `degenerate`.
};

/// A relative motion over one piece, prepared once for the tests of many features.
///
/// All vectors are in axes that stand still in the world and whose z is the axis of A. With
/// tau = t - t_begin, seen from A's pivot,
///   b(tau) = offset + tau drift + Rot(axis_B, rate_B tau) r_B,   a(tau) = Rot(z, rate_A tau) r_A
/// for points b of B and a of A with levers r from their pivots at t_begin.
///
/// The numbers are plain doubles. A position errs by `rounding` times the sum of its levers and
/// offsets, beyond the errors of the motion that it was made of.
struct ElementaryMotion {
  FIRSTCONTACT_API explicit ElementaryMotion(const RelativeMotion& motion);

  struct Body {
    Eigen::Matrix3d rotation;     ///< From the body's axes, at t_begin.
    Eigen::Vector3d lever;        ///< [m]  From the pivot to the path's point at t_begin.
    double lever_length = 0.0;    ///< [m]
    double rate = 0.0;            ///< [rad per step]  >= 0.
    double rotation_error = 0.0;  ///< [-]  Error of the motion's rotation, per distance of a point.
  };
  Body A;
  Body B;
  double t_begin = 0.0;
  double t_end = 1.0;
  Eigen::Vector3d axis_B;     ///< [-]  Unit; z where B does not turn.
  Eigen::Vector3d offset;     ///< [m]  Vector from A's pivot to B's at t_begin.
  Eigen::Vector3d drift;      ///< [m per step]
  double offset_bound = 0.0;  ///< [m]  Bound of |offset + tau drift| over the piece.
  double drift_length = 0.0;  ///< [m per step]
  Oscillation oscillation;
  double position_error = 0.0;  ///< [m]  Error of the motion's positions.
  double rounding = 0.0;        ///< [-]  (96 + 4 w) 2^-53 with w the greater rate.
};

}  // namespace firstcontact
