/// @file
/// The motion of a link in the frame of an ancestor: its pose, and rigorous bounds of its motion
/// along a direction.

#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/double_double.h>
#include <firstcontact/math/export.h>
#include <firstcontact/robot/joint_path.h>
#include <firstcontact/robot/precise_transform.h>
#include <firstcontact/robot/tracking_error.h>

namespace firstcontact {

/// A pose, in double precision, and how far it may be from the exact one.
struct LinkPose {
  Eigen::Matrix3d R_FL = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_OL = Eigen::Vector3d::Zero();  ///< [m]  From the origin asked for, in F.
  double rotation_error = 0.0;                     ///< [-]  R y is within this of exact, per |y|.
  double position_error = 0.0;                     ///< [m]
};

/// The place and the motion of a link: derivatives of its origin's place and of its rotation.
struct LinkState {
  LinkPose pose;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< [m per step]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< [m per step^2]
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();          ///< [rad per step]
  Eigen::Vector3d spin_rate = Eigen::Vector3d::Zero();     ///< [rad per step^2]
  double velocity_error = 0.0;  ///< [m per step]  Bound of the distance from the exact velocity.
  double acceleration_error = 0.0;
  double spin_error = 0.0;
  double spin_rate_error = 0.0;
};

/// A bound of a link or of one of its geometries: a box with any axes, rounded by a radius.
///
/// A ball is a box without extent.
struct RoundedBox {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();        ///< [m]  In L.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();      ///< [-]  One per row, in L.
  Eigen::Vector3d half_extents = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0.0;                                     ///< [m]

  /// [m]  Covers the box from its centre; rounded up.
  [[nodiscard]] double reach() const { return (half_extents.norm() + radius) * (1.0 + 0x1p-50); }
};

/// A bound of how far any point of a box gets along n from the window's time t on.
///
/// In a time tau it is at most  speed tau + acceleration tau^2 / 2.
struct DirectedBound {
  double speed = 0.0;         ///< [m per step]
  double acceleration = 0.0;  ///< [m per step^2]  May be negative.
};

/// The motion of a link at one time t, and bounds of it over a window around t.
class FIRSTCONTACT_API LinkWindow {
 public:
  [[nodiscard]] double t() const { return t_; }
  [[nodiscard]] double t_from() const { return t_from_; }
  [[nodiscard]] double t_to() const { return t_to_; }
  [[nodiscard]] const LinkPose& pose() const { return pose_; }

  /// Bounds of the sizes of velocity, acceleration and jerk of every point of the window's box, at
  /// every time of the window.
  [[nodiscard]] const CoordinateSegment::Bounds& bounds() const { return bounds_; }

  /// [per metre]  The growth of the bounds with the distance from the box.
  ///
  /// A point of the link at a distance r from the box exceeds the bounds by r times these at most.
  [[nodiscard]] const CoordinateSegment::Bounds& per_metre() const { return per_metre_; }

  /// The displacement along n, from t to t_to().
  ///
  /// Derivation: a point P at offset e from the link's origin has the velocity v + w x e. It has
  /// the acceleration a + al x e + w x (w x e). Both are linear in e, so their greatest values over
  /// a box are in closed form. Taylor's theorem with |jerk| <= J gives
  ///   n . (p(t + tau) - p(t)) <= n . v_P tau + (n . a_P + J T / 3) tau^2 / 2 for tau <= T.
  /// Where the bounds of size over the window are less, they are taken.
  ///
  /// @param box  inside of the window's box
  /// @param n    [-]  in F; the bound holds for n as stored if its length is at most 1
  [[nodiscard]] DirectedBound displacement(const RoundedBox& box, const Eigen::Vector3d& n) const;

  /// [m per step]  A bound of the velocity along n of every point of the box, at every time of
  /// the window.
  [[nodiscard]] double speed_bound(const RoundedBox& box, const Eigen::Vector3d& n) const;

 private:
  friend class LinkPath;

  /// The greatest n . (linear + angular e) over the box's offsets e from the link's origin.
  [[nodiscard]] double support(const RoundedBox& box, const Eigen::Vector3d& n,
                               const Eigen::Vector3d& linear, const Eigen::Matrix3d& angular) const;

  double t_ = 0.0;
  double t_from_ = 0.0;
  double t_to_ = 0.0;
  LinkPose pose_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();      // Velocity of the link's origin.
  Eigen::Vector3d acceleration_ = Eigen::Vector3d::Zero();  // Acceleration of the link's origin.
  Eigen::Matrix3d spin_ = Eigen::Matrix3d::Zero();          // [w]x
  Eigen::Matrix3d spin_rate_ = Eigen::Matrix3d::Zero();     // [al]x + [w]x [w]x
  double speed_error_ = 0.0;                                // Bound for any point of the box at t.
  double acceleration_error_ = 0.0;
  CoordinateSegment::Bounds bounds_;
  CoordinateSegment::Bounds per_metre_;
};

namespace detail {
class ChainMemory;
}

/// Scratch memory that remembers the last places of joints; each thread needs its own.
///
/// So links that share joints share the work, and so do questions that share times.
class FIRSTCONTACT_API LinkScratch {
 public:
  LinkScratch();
  ~LinkScratch();
  LinkScratch(LinkScratch&&) noexcept;
  LinkScratch& operator=(LinkScratch&&) noexcept;

  [[nodiscard]] detail::ChainMemory& memory() { return *memory_; }

  /// Drops entries of paths that no longer exist, so that lookups take less time.
  void forget();

 private:
  std::unique_ptr<detail::ChainMemory> memory_;
};

/// The path of a link L in the frame F of an ancestor, over one smooth piece of time.
class FIRSTCONTACT_API LinkPath {
 public:
  /// Joins the paths of joints, from F to L.
  ///
  /// @param joints  from F to L, none of them null; paths of other links share them
  LinkPath(double t_begin, double t_end, std::vector<std::shared_ptr<const JointPath>> joints);

  [[nodiscard]] double t_begin() const { return t_begin_; }
  [[nodiscard]] double t_end() const { return t_end_; }

  /// The path of a frame that is fixed in L.
  [[nodiscard]] LinkPath then(const PreciseTransform& X_LG) const;

  /// The path of a frame that is fixed in L, with a joint that does not move and can be shared.
  [[nodiscard]] LinkPath then(std::shared_ptr<const JointPath> X_LG) const;

  /// The pose X_FL(t).
  ///
  /// @param p_FO  [m]  positions are taken from here on, in double-double as far as the first joint
  [[nodiscard]] LinkPose pose(double t, const DoubleDoubleVector3& p_FO = {}) const;

  /// The pose X_FL(t) with the link's derivatives.
  [[nodiscard]] LinkState state(double t, LinkScratch& scratch,
                                const DoubleDoubleVector3& p_FO = {}) const;

  /// The place p_FO from which positions are best taken: the links of a robot are near it.
  ///
  /// It is the same for all links that share a first joint.
  [[nodiscard]] DoubleDoubleVector3 anchor() const;

  /// The path, where it is that of a free body; else null.
  [[nodiscard]] const ConstantRatePath* constant_rates() const;

  struct Swept {
    LinkPose pose;       ///< At t.
    double speed = 0.0;  ///< [m per step]  No point of the box is faster in the window.
  };
  /// The pose, and a bound of speed with the derivation of window(), at a fraction of its cost.
  [[nodiscard]] Swept swept(double t, double t_from, double t_to, const RoundedBox& box,
                            LinkScratch& scratch) const;

  /// Bounds over [t_from, t_to], which contains t and lies in the piece.
  ///
  /// Derivation: rho is the greatest distance of the box from a joint's axis. w, e, f bound the
  /// angle's derivatives, and d1, d2, d3 those of the pivot. v, a, j bound the derivatives of the
  /// box's points as seen from the child. A point as seen from the parent is p = pivot + Rot(axis,
  /// angle) y, so that there
  ///   v' <= d1 + v + w rho,
  ///   a' <= d2 + a + 2 w v + sqrt(e^2 + w^4) rho,
  ///   j' <= d3 + j + 3 w a + 3 sqrt(e^2 + w^4) v + sqrt((f + w^3)^2 + (3 w e)^2) rho,
  /// from the tip to F. rho is the distance at t, and v T more. Or it is the length of the chain
  /// beyond the axis, which holds for any angles.
  ///
  /// @param box  around the link, or around as much of it as is of interest
  [[nodiscard]] LinkWindow window(double t, double t_from, double t_to, const RoundedBox& box,
                                  LinkScratch& scratch, const DoubleDoubleVector3& p_FO = {}) const;

  /// [m]  A bound of how far the box's points are from their places, with every joint within an
  /// error of its path.
  ///
  /// It holds at any time of [t_from, t_to].
  ///
  /// Derivation: e bounds how far the box's points are from their places as seen from a child. With
  /// the joint at its path they are as far as seen from the parent. An error of the angle moves a
  /// point at a distance rho from the axis by 2 sin(error / 2) rho. An error of the slide moves it
  /// by as much as itself:
  ///   e' <= e + 2 sin(min(angle, pi) / 2) rho + distance,
  /// from the tip to F, with rho as in window().
  ///
  /// @param errors  one for each joint of the path, from F on
  [[nodiscard]] double tracking_bound(double t, double t_from, double t_to, const RoundedBox& box,
                                      std::span<const TrackingError> errors,
                                      LinkScratch& scratch) const;

  [[nodiscard]] std::size_t joint_count() const { return joints_.size(); }

 private:
  double t_begin_;
  double t_end_;
  std::vector<std::shared_ptr<const JointPath>> joints_;
};

}  // namespace firstcontact
