/// @file
/// The path of a body point under a motion of constant rates, and the bounds that queries use.

#pragma once

#include <array>

#include <Eigen/Core>

#include <firstcontact/math/double_double.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// One piece of a motion: a pivot Q moves on a line, and the body turns about Q at a constant rate.
///
///   p_WP(t) = p_WQ + (t - t_begin) velocity + Rot(axis, (t - t_begin) rate) R_WB (p_BP - p_BQ).
/// Constant velocity, screw and rest are all of this form (Redon, Kheddar, Coquillart, "Fast
/// continuous collision detection between rigid bodies", Computer Graphics Forum 21 (2002)).
///
/// The numbers are double-doubles; the exact motion stays within `position_error` plus
/// `rotation_error` times a point's distance from the body origin.
struct ConstantRateSegment {
  double t_begin = 0.0;
  double t_end = 1.0;
  DoubleDoubleVector3 p_WQ;                     ///< [m]  Pivot at t_begin.
  DoubleDoubleVector3 p_BQ;                     ///< [m]  Pivot in the body frame.
  DoubleDoubleVector3 velocity;                 ///< [m per step]  Velocity of the pivot.
  DoubleDoubleVector3 axis;                     ///< [-]  Unit, world frame; unused when rate is 0.
  DoubleDouble rate;                            ///< [rad per step]  >= 0.
  std::array<DoubleDoubleVector3, 3> rotation;  ///< [-]  Columns of R_WB at t_begin.
  double position_error = 0.0;                  ///< [m]
  double rotation_error = 0.0;                  ///< [-]
};

/// The path of a body point C over one piece, prepared for fast evaluation.
///
/// Every point P of the body at offset rho from the axis line has |acceleration| = rate^2 |rho|
/// and, along a fixed direction n, |n . acceleration(t')| <= rate^2 |n x axis| |rho| at every t'
/// of the piece, for any total angle: the acceleration is -rate^2 rho_perp, and |n . rho_perp|
/// <= |n x axis| |rho_perp| with |rho_perp| constant in time.
class FIRSTCONTACT_API ConstantRatePath {
 public:
  ConstantRatePath(const ConstantRateSegment& segment, const Eigen::Vector3d& p_BC);

  [[nodiscard]] double t_begin() const { return t_begin_; }
  [[nodiscard]] double t_end() const { return t_end_; }

  /// [-]  Unit axis, world frame, rounded; zero when the body does not turn.
  [[nodiscard]] const Eigen::Vector3d& axis() const { return axis_; }
  [[nodiscard]] double rate() const { return rate_.hi; }  ///< [rad per step]  >= 0, rounded.

  /// [m per step]  Velocity of the pivot Q: the point of the axis nearest to C.
  [[nodiscard]] const DoubleDoubleVector3& pivot_velocity() const { return velocity_; }
  /// [m]  Pivot at t_begin.
  [[nodiscard]] const DoubleDoubleVector3& pivot_begin() const { return p_WQ_; }

  /// [m]  Distance of C from the axis; constant over the piece.
  [[nodiscard]] double lever_length() const { return lever_length_; }

  /// [m]  Bound of |exact - stored| for C, all roundings of the parameters included.
  [[nodiscard]] double position_error() const { return position_error_; }
  /// [-]  Bound of |exact - stored| for the rotation; it acts times a point's distance from C.
  [[nodiscard]] double rotation_error() const { return rotation_error_; }

  struct State {
    Eigen::Matrix3d
        R_WB;  ///< Each product R y is within 22 2^-53 |y| of exact, before its own rounding.
    Eigen::Vector3d p_QC_W;  ///< [m]  Lever from the pivot to C; within 12 2^-53 of its length.
  };
  [[nodiscard]] State state(double t) const;

  [[nodiscard]] DoubleDoubleVector3 pivot(double t) const;  ///< [m]  p_WQ(t).
  [[nodiscard]] DoubleDoubleVector3 precise_lever(
      double t) const;  ///< [m]  p_QC_W(t) to 2^-94 of its length.

 private:
  double t_begin_;
  double t_end_;
  DoubleDouble rate_;
  Eigen::Vector3d axis_;
  DoubleDoubleVector3 p_WQ_;
  DoubleDoubleVector3 velocity_;
  DoubleDoubleVector3 lever_cosine_;  // p_QC_W = cos lever_cosine + sin lever_sine
  DoubleDoubleVector3 lever_sine_;
  double lever_length_;
  Eigen::Matrix3d rotation_constant_;  // R_WB = constant + cos cosine + sin sine
  Eigen::Matrix3d rotation_cosine_;
  Eigen::Matrix3d rotation_sine_;
  double position_error_;
  double rotation_error_;
};

}  // namespace firstcontact
