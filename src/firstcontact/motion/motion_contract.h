/// @file
/// The motion contract: all that the algorithms may use of a motion.

#pragma once

#include <concepts>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include <firstcontact/math/double_double.h>
#include <firstcontact/motion/constant_rate_path.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// The path of a body point C over one smooth, rigid piece of a motion.
///
/// Laws, for the exact motion that the defining numbers mean, at all t, t' in [t_begin, t_end]:
/// - Place: |pivot(t) + precise_lever(t) - p_WC(t)| <= position_error() + 2^-90 of their sizes, and
///   state(t).R_WB errs by no more than 22 2^-53 + rotation_error() in each column.
/// - Rigidity: the distance of any two body points is the same at all times.
/// - Bound: for a unit n and a point at rho(t) from the axis, with v its velocity at t,
///   |n . (p(t') - p(t) - v(t) (t' - t))| <= rate^2 |n x axis| |rho| (t' - t)^2 / 2,
///   for any total angle; it is attained to first order where n is along rho.
template <class Path>
concept MotionPath = requires(const Path& path, double t) {
  { path.t_begin() } -> std::same_as<double>;
  { path.t_end() } -> std::same_as<double>;
  { path.axis() } -> std::convertible_to<Eigen::Vector3d>;
  { path.rate() } -> std::same_as<double>;
  { path.pivot_velocity() } -> std::convertible_to<DoubleDoubleVector3>;
  { path.pivot(t) } -> std::same_as<DoubleDoubleVector3>;
  { path.precise_lever(t) } -> std::same_as<DoubleDoubleVector3>;
  { path.lever_length() } -> std::same_as<double>;
  { path.state(t).R_WB } -> std::convertible_to<Eigen::Matrix3d>;
  { path.position_error() } -> std::same_as<double>;
  { path.rotation_error() } -> std::same_as<double>;
};

/// A motion over the step: pieces that follow each other.
///
/// Laws:
/// - Order: 0 = breaks[0] < ... < breaks[n] = 1; path(k, p) runs from breaks[k] to breaks[k + 1].
/// - Interpolation: X_WB is the given pose at each given time; neighbouring pieces agree at their
///   break, up to the errors of their paths.
template <class M>
concept MotionOfPieces = requires(const M& motion, std::size_t piece, const Eigen::Vector3d& p_BC,
                                  double t) {
  { motion.breaks() } -> std::convertible_to<std::span<const double>>;
  { motion.path(piece, p_BC) } -> MotionPath;
  { motion.pose(t) } -> std::same_as<Pose>;
};

static_assert(MotionPath<ConstantRatePath>);
static_assert(MotionOfPieces<Motion>);

}  // namespace firstcontact
