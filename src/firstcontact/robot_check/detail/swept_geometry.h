/// @file
/// A part wherever it is in a window of time, and how far apart two of them stay.

#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include <firstcontact/motion/time_window.h>
#include <firstcontact/robot/link_path.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>
#include <firstcontact/robot_check/detail/tree_poses.h>

namespace firstcontact::detail {

/// A part at one time.
struct PartPlace {
  Eigen::Matrix3d R_FS = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]  Of the part's box.
  double error = 0.0;                                ///< [m]  Of any point's place.
};

/// A part throughout a window: its points are never farther than `error` from parabolas.
///
/// The parabola of a point over the window has that point's places in `controls` for control
/// points.
struct SweptPart {
  const Part* part = nullptr;
  std::array<PartPlace, 3> controls = {};  ///< The first and the last are places of the part.
  PartPlace middle = {};
  bool rests = false;                              ///< All are one.
  double error = 0.0;                              ///< [m]
  Eigen::Vector3d low = Eigen::Vector3d::Zero();   ///< [m]  Of a box along the axes of F that
  Eigen::Vector3d high = Eigen::Vector3d::Zero();  ///<      holds the part all the time.
};

/// Where a part is fixed to a node of a course.
struct PartMount {
  TreePoses* course = nullptr;
  std::size_t node = 0;
  Eigen::Matrix3d R_LS = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();  ///< [m]  The centre of the part's box.
  double far = 0.0;  ///< [m]  No point is farther from the node's origin, nor was in between.

  /// @param X_LS  rests
  PartMount(const Part& part, TreePoses& course, std::size_t node, const JointPath& X_LS);

  /// Mounts a part that is a node of its own.
  PartMount(const Part& part, TreePoses& course);
};

/// How a part moves over a piece of time, in a frame F: a node that carries it, or the world.
class PartTrack {
 public:
  PartTrack(const Part& part, const PartMount& mount, std::size_t frame);

  /// In F, in the piece.
  [[nodiscard]] bool rests() const { return speed_ == 0.0; }

  /// At a time of the grid.
  [[nodiscard]] PartPlace place(int k) const;

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
  [[nodiscard]] SweptPart sweep(const TimeWindow& window, const PartPlace& begin,
                                const PartPlace& middle, const PartPlace& end) const;

  /// The same for a part that rests, for all windows.
  [[nodiscard]] SweptPart rest() const;

 private:
  const Part* part_;
  PartMount mount_;
  std::size_t frame_;
  double speed_;  // [m per step]    Of no point more, in the piece.
  double jerk_;   // [m per step^3]  So too.
};

/// A bound of how far apart two parts stay.
struct SweptGap {
  double bound = 0.0;                            ///< [m]  Proven; may be negative.
  Eigen::Vector3d n = Eigen::Vector3d::UnitX();  ///< [-]  From A to B; what it was found along.
};

/// Throughout a window, by the boxes along the axes of F.
[[nodiscard]] SweptGap gap_of_boxes(const SweptPart& A, const SweptPart& B);

/// At the middle of a window, by the convex hulls, along nearly the direction between them.
///
/// @param enough  [m]  no less is of interest
/// @param n       [-]  unit; where to look first
/// @param near    [-]  the part of the distance that is looked for
[[nodiscard]] SweptGap gap_at_middle(const SweptPart& A, const SweptPart& B, double enough,
                                     const Eigen::Vector3d& n, double near = 0.9);

/// The same throughout the window, by the convex hull of all differences of control points.
///
/// Derivation: along n the gap of a point of A and one of B is a polynomial of time, within the sum
/// of the errors. A polynomial is nowhere less than the least of its control points: the gaps of
/// the two at the same index.
///
/// @param enough  [m]  neither less nor more is of interest
[[nodiscard]] SweptGap gap_throughout(const SweptPart& A, const SweptPart& B, double enough,
                                      const Eigen::Vector3d& n);

}  // namespace firstcontact::detail
