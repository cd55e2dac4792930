/// @file
/// A geometry at all times of a window, and a bound of the distance of two of them.

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
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]  Centre of the geometry's box.
  double error = 0.0;                                ///< [m]  Error of any point's place.
};

/// A geometry throughout a window: its points are never farther than `error` from parabolas.
///
/// The control points of a point's parabola are the point's places in `controls`.
struct SweptGeometry {
  const BoundedGeometry* geometry = nullptr;
  std::array<GeometryPlace, 3> controls = {};  ///< The first and the last are places of the
                                               ///< geometry.
  GeometryPlace middle = {};
  bool rests = false;                             ///< Whether all places are equal.
  double error = 0.0;                             ///< [m]
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< [m]  Low corner of a box along the axes of F.
  Eigen::Vector3d high = Eigen::Vector3d::Zero();  ///< [m]  High corner; the box holds the geometry
                                                   ///< all the time.
};

/// The node of a tree on which a geometry is mounted.
struct GeometryMount {
  TreePoses* course = nullptr;
  std::size_t node = 0;
  Eigen::Matrix3d R_LS = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();  ///< [m]  The centre of the geometry's box.
  double far = 0.0;  ///< [m]  Bound of the distance of any point, and of the centres between, from
                     ///< the node's origin.

  /// @param X_LS  a path at rest
  GeometryMount(const BoundedGeometry& geometry, TreePoses& course, std::size_t node,
                const JointPath& X_LS);

  /// Mounts a geometry that is a node of its own.
  GeometryMount(const BoundedGeometry& geometry, TreePoses& course);
};

/// The motion of a geometry over a piece of time, in a frame F: a node that carries it, or the
/// world.
class GeometryTrack {
 public:
  GeometryTrack(const BoundedGeometry& geometry, const GeometryMount& mount, std::size_t frame);

  /// Whether the geometry rests in F, in the piece.
  [[nodiscard]] bool rests() const { return speed_ == 0.0; }

  /// The place of the geometry at a time of the grid.
  [[nodiscard]] GeometryPlace place(int k) const;

  /// The geometry throughout a window of the piece.
  ///
  /// Derivation: q is the parabola through a point's places at the window's ends and middle. In
  /// each direction the path departs from it by a third derivative, J at most, times a product of
  /// three differences of times over 6. With T the window's length,
  ///   |p - q| <= J T^3 / (72 sqrt(3)) < J T^3 / 124.
  /// The control points of q are p(begin), 2 p(middle) - (p(begin) + p(end)) / 2 and p(end). They
  /// are within three times the error of a place, and depend linearly on the place of the point in
  /// S.
  ///
  /// @param begin, middle, end  places at these times of the window
  [[nodiscard]] SweptGeometry sweep(const TimeWindow& window, const GeometryPlace& begin,
                                    const GeometryPlace& middle, const GeometryPlace& end) const;

  /// The geometry throughout all windows, where it rests.
  [[nodiscard]] SweptGeometry rest() const;

 private:
  const BoundedGeometry* geometry_;
  GeometryMount mount_;
  std::size_t frame_;
  double speed_;  // [m per step]    Bound for any point, in the piece.
  double jerk_;   // [m per step^3]  Bound for any point, in the piece.
};

/// A bound of the distance of two geometries.
struct SweptGap {
  double bound = 0.0;                            ///< [m]  Proven; may be negative.
  Eigen::Vector3d n = Eigen::Vector3d::UnitX();  ///< [-]  From A to B; the direction of the bound.
};

/// Bounds the gap throughout a window, by the boxes along the axes of F.
[[nodiscard]] SweptGap gap_of_boxes(const SweptGeometry& A, const SweptGeometry& B);

/// Bounds the gap at the middle of a window, by the convex hulls, along nearly the direction
/// between them.
///
/// @param enough  [m]  no smaller gap is of interest
/// @param n       [-]  unit; the first direction to try
/// @param near    [-]  part of the distance that the search aims at
[[nodiscard]] SweptGap gap_at_middle(const SweptGeometry& A, const SweptGeometry& B, double enough,
                                     const Eigen::Vector3d& n, double near = 0.9);

/// Bounds the gap at the end of a window likewise.
///
/// @param enough  [m]  neither smaller nor greater gaps are of interest
[[nodiscard]] SweptGap gap_at_end(const SweptGeometry& A, const SweptGeometry& B, double enough,
                                  const Eigen::Vector3d& n);

/// Bounds the gap throughout a window, by the convex hull of all differences of control points.
///
/// Derivation: along n the gap of a point of A and one of B is a polynomial of time, within the sum
/// of the errors. A polynomial is nowhere less than the least of its control points. These are the
/// gaps of the two at the same index.
///
/// @param enough  [m]  neither smaller nor greater gaps are of interest
[[nodiscard]] SweptGap gap_throughout(const SweptGeometry& A, const SweptGeometry& B, double enough,
                                      const Eigen::Vector3d& n);

}  // namespace firstcontact::detail
