/// @file
/// A geometry wherever it is in a window of time, and how far apart two of them stay.

#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include <firstcontact/motion/time_window.h>
#include <firstcontact/robot/link_path.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>
#include <firstcontact/robot_check/detail/tree_poses.h>

namespace firstcontact::detail {

/// A geometry at one time.
struct GeometryPlace {
  Eigen::Matrix3d R_FS = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]  Of the geometry's box.
  double error = 0.0;                                ///< [m]  Of any point's place.
};

/// A geometry throughout a window: its points are never farther than `error` from parabolas.
///
/// The parabola of a point over the window has that point's places in `controls` for control
/// points.
struct SweptGeometry {
  const BoundedGeometry* geometry = nullptr;
  std::array<GeometryPlace, 3> controls = {};  ///< The first and the last are places of it.
  GeometryPlace middle = {};
  bool rests = false;                              ///< All are one.
  double error = 0.0;                              ///< [m]
  Eigen::Vector3d low = Eigen::Vector3d::Zero();   ///< [m]  Of a box along the axes of F that
  Eigen::Vector3d high = Eigen::Vector3d::Zero();  ///<      holds the geometry all the time.
};

/// Where a geometry is fixed to a node of a course.
struct GeometryMount {
  TreePoses* course = nullptr;
  std::size_t node = 0;
  Eigen::Matrix3d R_LS = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();  ///< [m]  The centre of the geometry's box.
  double far = 0.0;  ///< [m]  No point is farther from the node's origin, nor was in between.

  /// @param X_LS  rests
  GeometryMount(const BoundedGeometry& geometry, TreePoses& course, std::size_t node,
                const JointPath& X_LS);

  /// Mounts a geometry that is a node of its own.
  GeometryMount(const BoundedGeometry& geometry, TreePoses& course);
};

/// How a geometry moves over a piece of time, in a frame F: a node that carries it, or the world.
class GeometryTrack {
 public:
  GeometryTrack(const BoundedGeometry& geometry, const GeometryMount& mount, std::size_t frame);

  /// In F, in the piece.
  [[nodiscard]] bool rests() const { return speed_ == 0.0; }

  /// At a time of the grid.
  [[nodiscard]] GeometryPlace place(int k) const;

  /// Throughout a window of the piece.
  ///
  /// Derivation: let q be the parabola through a point's places at the window's ends and middle. In
  /// each direction the path departs from it by a third derivative, J at most, times a product of
  /// three differences of times over 6: with T the window's length,
  ///   |p - q| <= J T^3 / (72 sqrt(3)) < J T^3 / 124.
  /// The control points of q are p(begin), 2 p(middle) - (p(begin) + p(end)) / 2 and p(end): within
  /// three times the error of a place. They depend linearly on the place of the point in S.
  ///
  /// @param begin, middle, end  places at these times of the window
  [[nodiscard]] SweptGeometry sweep(const TimeWindow& window, const GeometryPlace& begin,
                                    const GeometryPlace& middle, const GeometryPlace& end) const;

  /// The same for a geometry that rests, for all windows.
  [[nodiscard]] SweptGeometry rest() const;

 private:
  const BoundedGeometry* geometry_;
  GeometryMount mount_;
  std::size_t frame_;
  double speed_;  // [m per step]    Of no point more, in the piece.
  double jerk_;   // [m per step^3]  So too.
};

/// A bound of how far apart two geometries stay.
struct SweptGap {
  double bound = 0.0;                            ///< [m]  Proven; may be negative.
  Eigen::Vector3d n = Eigen::Vector3d::UnitX();  ///< [-]  From A to B; what it was found along.
};

/// Throughout a window, by the boxes along the axes of F.
[[nodiscard]] SweptGap gap_of_boxes(const SweptGeometry& A, const SweptGeometry& B);

/// At the middle of a window, by the convex hulls, along nearly the direction between them.
///
/// @param enough  [m]  no less is of interest
/// @param n       [-]  unit; where to look first
/// @param near    [-]  the share of the distance that is looked for
[[nodiscard]] SweptGap gap_at_middle(const SweptGeometry& A, const SweptGeometry& B, double enough,
                                     const Eigen::Vector3d& n, double near = 0.9);

/// The same at the end of a window.
///
/// @param enough  [m]  neither less nor more is of interest
[[nodiscard]] SweptGap gap_at_end(const SweptGeometry& A, const SweptGeometry& B, double enough,
                                  const Eigen::Vector3d& n);

/// The same throughout the window, by the convex hull of all differences of control points.
///
/// Derivation: along n the gap of a point of A and one of B is a polynomial of time, within the sum
/// of the errors. A polynomial is nowhere less than the least of its control points: the gaps of
/// the two at the same index.
///
/// @param enough  [m]  neither less nor more is of interest
[[nodiscard]] SweptGap gap_throughout(const SweptGeometry& A, const SweptGeometry& B, double enough,
                                      const Eigen::Vector3d& n);

}  // namespace firstcontact::detail
