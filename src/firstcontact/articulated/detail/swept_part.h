/// @file
/// A part wherever it is in a window of time, and how far apart two of them stay.

#pragma once

#include <Eigen/Core>

#include <firstcontact/articulated/detail/robot_timeline.h>
#include <firstcontact/articulated/link_path.h>
#include <firstcontact/motion/time_window.h>

namespace firstcontact::detail {

/// A box around a part at the middle of a window, in the world, and the part's motion about then.
struct SweptPart {
  LinkWindow motion;
  const Part* part = nullptr;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]  Of the box.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();    ///< [-]  Of the box, one per row.
  double reach = 0.0;                                ///< [m]  Of the part, from the centre.
  double error = 0.0;                                ///< [m]  Of any point's place.
  double sweep = 0.0;           ///< [m]  No point is farther from its place at the middle.
  double tracking_error = 0.0;  ///< [m]  Bounds that of the part; not in the others.
};

[[nodiscard]] SweptPart sweep(const Part& part, const PartPath& path, const TimeWindow& window,
                              LinkScratch& scratch);

/// How far apart two parts stay throughout a window.
struct SweptGap {
  double bound = 0.0;   ///< [m]  Proven; may be negative.
  double middle = 0.0;  ///< [m]  The same at the middle of the window alone.
  Eigen::Vector3d n = Eigen::Vector3d::UnitX();  ///< [-]  From A to B; what it was found along.
};

/// By balls where their gap exceeds `enough`; else by boxes along a few directions.
///
/// Derivation: along n, the gap at the middle is n . (c_B - c_A) less both extents. In a time tau
/// from there, forth or back, A's points gain along n, and B's against it, what
/// LinkWindow::displacement() bounds by s tau + a tau^2 / 2 each, a >= 0: their sum is convex in
/// tau, so that it is greatest at 0 or at the window's end.
///
/// @param window  that of both; of a part that rests, any
[[nodiscard]] SweptGap gap_of_boxes(const SweptPart& A, const SweptPart& B,
                                    const TimeWindow& window, double enough);

/// By the convex hulls, along nearly the direction between them.
///
/// @param n  [-]  unit; where to look first
[[nodiscard]] SweptGap gap_of_hulls(const SweptPart& A, const SweptPart& B,
                                    const TimeWindow& window, double enough,
                                    const Eigen::Vector3d& n);

}  // namespace firstcontact::detail
