/// @file
/// A ball around a geometry at all times of a window.
///
/// One is kept for every piece of a long trajectory. SweptGeometry is tighter, at ten times the
/// memory.

#pragma once

#include <Eigen/Core>

#include <firstcontact/motion/time_window.h>
#include <firstcontact/robot/link_path.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>

namespace firstcontact::detail {

/// A ball around a geometry at all times of a window.
struct SweptBall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]  In the world.
  double radius = 0.0;                               ///< [m]
  double tracking_error = 0.0;  ///< [m]  Bound of the geometry's tracking error; not in the radius.
};

[[nodiscard]] SweptBall swept_ball(const RoundedBox& ball, const GeometryPath& path,
                                   const TimeWindow& window, LinkScratch& scratch);

/// [m]  A proven lower bound of the distance of two geometries throughout the window; may be
/// negative.
[[nodiscard]] double gap_bound(const SweptBall& a, const SweptBall& b);

}  // namespace firstcontact::detail
