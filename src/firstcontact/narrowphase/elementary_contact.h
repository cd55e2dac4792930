/// @file
/// The classical elementary tests of moving features: what they ask and what they answer.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/relative_motion.h>

namespace firstcontact {

/// How an elementary test ends.
enum class ElementaryVerdict {
  free,        ///< Proven: the features do not meet in the window.
  contact,     ///< They meet in [t_lower, t_upper], where their coplanarity function has one root.
  degenerate,  ///< Proven free before t_lower, nothing known after it.
};

struct ElementaryContact {
  ElementaryVerdict verdict = ElementaryVerdict::degenerate;
  /// [-]  The features provably do not meet in the window before this time.
  double t_lower = 0.0;
  /// [-]  For `contact` the end of the isolating interval, else equal to t_lower.
  double t_upper = 0.0;
  /// For `contact`: proven that the features meet in [t_lower, t_upper], by a change of sign of the
  /// coplanarity function and a point inside both features. Otherwise they touch at t_lower up to
  /// rounding: on a feature's border, or at an end of the window.
  bool existence_proven = false;
  int steps = 0;  ///< Evaluations of the motion.
};

/// The part of the step that is searched, and how far.
struct ElementaryOptions {
  double t_begin = 0.0;           ///< [-]  Clipped to the piece of the motion.
  double t_end = 1.0;             ///< [-]  Belongs to the window; clipped like t_begin.
  double time_tolerance = 1e-10;  ///< [-]  Aim of t_upper - t_lower; rounding may leave more.
  int maximum_steps = 10'000;     ///< Spent: `degenerate`.
};

/// A relative motion over one piece, prepared once for the tests of many features.
///
/// With tau = t - t_begin, seen from A's pivot,
///   b(tau) = offset + tau drift + Rot(u_B, w_B tau) r_B,   a(tau) = Rot(u_A, w_A tau) r_A
/// for points b of B and a of A with levers r from their pivots at t_begin. In plain doubles: a
/// position is within (80 + 4 w) 2^-53 of the sum of its levers and offsets, w the greater rate.
class FIRSTCONTACT_API ElementaryMotion {
 public:
  explicit ElementaryMotion(const RelativeMotion& motion);

  struct Body {
    Eigen::Matrix3d rotation;     ///< R_WS at t_begin.
    Eigen::Vector3d lever;        ///< [m]  From the pivot to the path's point at t_begin.
    Eigen::Vector3d axis;         ///< [-]  Unit; zero where the body does not turn.
    double rate = 0.0;            ///< [rad per step]  >= 0.
    double rotation_error = 0.0;  ///< [-]  Of the stored motion.
  };

  [[nodiscard]] const Body& A() const { return A_; }
  [[nodiscard]] const Body& B() const { return B_; }
  [[nodiscard]] const Eigen::Vector3d& offset() const { return offset_; }  ///< [m]
  [[nodiscard]] const Eigen::Vector3d& drift() const { return drift_; }    ///< [m per step]
  [[nodiscard]] double t_begin() const { return t_begin_; }
  [[nodiscard]] double t_end() const { return t_end_; }
  /// [m]  Greatest |offset + tau drift| over the piece.
  [[nodiscard]] double offset_bound() const { return offset_bound_; }
  /// [m]  Bound of the error of the stored motion, beyond roundings relative to its sizes.
  [[nodiscard]] double position_error() const { return position_error_; }
  /// [-]  Relative error of a position computed from this motion.
  [[nodiscard]] double rounding() const { return rounding_; }
  [[nodiscard]] double axes_cosine() const { return axes_cosine_; }  ///< [-]  u_A . u_B
  [[nodiscard]] double axes_sine() const { return axes_sine_; }      ///< [-]  |u_A x u_B|

 private:
  Body A_;
  Body B_;
  Eigen::Vector3d offset_;
  Eigen::Vector3d drift_;
  double t_begin_;
  double t_end_;
  double offset_bound_;
  double position_error_;
  double rounding_;
  double axes_cosine_;
  double axes_sine_;
};

}  // namespace firstcontact
