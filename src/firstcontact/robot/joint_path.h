/// @file
/// The motion of a link against its parent over one smooth piece of time.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/double_double.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/constant_rate_path.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/robot/precise_transform.h>

namespace firstcontact {

/// A child link L at one instant, all in the frame P of its parent.
///
/// The link turns about a pivot Q that moves. Errors bound the distance from the exact motion.
struct JointState {
  Eigen::Matrix3d R_PL;       ///< Each column within 24 2^-53 + angle_error.
  DoubleDoubleVector3 p_PQ;   ///< [m]  Within position_error + 2^-90 of its size.
  Eigen::Vector3d p_QL;       ///< [m]  Within (24 2^-53 + angle_error) of its length.
  Eigen::Vector3d axis;       ///< [-]  Within 2^-52.
  double rate = 0.0;          ///< [rad per step]    About the axis.
  double acceleration = 0.0;  ///< [rad per step^2]  About the axis.
  bool slides = false;        ///< Whether the pivot moves; else it rests.
  Eigen::Vector3d pivot_velocity = Eigen::Vector3d::Zero();      ///< [m per step]
  Eigen::Vector3d pivot_acceleration = Eigen::Vector3d::Zero();  ///< [m per step^2]
  double angle_error = 0.0;
  double position_error = 0.0;
  double rate_error = 0.0;
  double acceleration_error = 0.0;
  double pivot_velocity_error = 0.0;
  double pivot_acceleration_error = 0.0;
};

/// Upper bounds of the sizes of a joint's derivatives over a window of time.
struct JointBounds {
  CoordinateSegment::Bounds angle;  ///< [rad per step ...]
  CoordinateSegment::Bounds pivot;  ///< [m per step ...]
};

/// The transform X_PL(t) of a joint over one smooth piece of time.
///
/// There are two kinds. One is X_PJ, then slides along fixed directions, a turn about a fixed axis
/// and a fixed transform. The other is X_PJ, then a piece of a Motion.
class FIRSTCONTACT_API JointPath {
 public:
  struct Slide {
    DoubleDoubleVector3 direction;  ///< [-]  In J.
    CoordinateSegment coordinate;   ///< [m]
  };

  /// Makes a joint of slides and a turn: X_PL = X_PJ (slides) (turn) X_EL.
  ///
  /// @param axis  [-]  unit, in J; of no meaning without an angle
  static JointPath polynomial(const PreciseTransform& X_PJ, const DoubleDoubleVector3& axis,
                              const std::optional<CoordinateSegment>& angle,
                              const std::vector<Slide>& slides, const PreciseTransform& X_EL);

  /// Makes the same joint at other coordinates: an angle if it has one, as many slides as it has.
  [[nodiscard]] JointPath moved(const std::optional<CoordinateSegment>& angle,
                                std::span<const CoordinateSegment> slides) const;

  /// Makes a joint whose child's origin moves by one piece of a motion.
  static JointPath of_motion(const PreciseTransform& X_PJ, const ConstantRatePath& X_JL);

  /// Makes a joint that does not move: X_PL, always.
  static JointPath rigid(const PreciseTransform& X_PL);

  /// The path of the origin of a free body, whose parent's frame is J; null for any other joint.
  [[nodiscard]] const ConstantRatePath* free_body() const;

  /// [m]  A place in P near the joint's pivot, rounded.
  [[nodiscard]] const Eigen::Vector3d& anchor() const { return anchor_; }

  /// A number that only this path and copies of it have.
  [[nodiscard]] std::uint64_t id() const { return id_; }

  /// The state of the child at a time of the piece.
  [[nodiscard]] JointState state(double t) const;
  /// Bounds the derivatives over a window of the piece.
  [[nodiscard]] JointBounds bounds(double t_from, double t_to) const;

  /// The state of a joint that never changes; null for any other.
  [[nodiscard]] const JointState* rest() const { return rest_ ? &*rest_ : nullptr; }

  /// Whether the joint turns about one axis, else about any through the child's origin.
  [[nodiscard]] bool has_axis() const { return std::holds_alternative<Polynomial>(kind_); }

 private:
  struct Polynomial {
    DoubleDoubleVector3 p_PJ;
    DoubleDoubleVector3 axis;  // In P.
    std::optional<CoordinateSegment> angle;
    std::vector<Slide> slides;          // Directions in P.
    Eigen::Matrix3d rotation_constant;  // R_PL = constant + cos cosine + sin sine
    Eigen::Matrix3d rotation_cosine;
    Eigen::Matrix3d rotation_sine;
    Eigen::Vector3d lever_constant;  // p_QL likewise
    Eigen::Vector3d lever_cosine;
    Eigen::Vector3d lever_sine;
  };
  struct Piece {
    PreciseTransform X_PJ;
    Eigen::Matrix3d R_PJ;
    ConstantRatePath path;
    bool is_free_body;  // X_PJ is the identity.
  };

  JointPath(const Eigen::Vector3d& anchor, std::variant<Polynomial, Piece> kind);

  static bool rests(const std::variant<Polynomial, Piece>& kind);
  static JointState state(const Polynomial& joint, double t);
  static JointState state(const Piece& joint, double t);

  std::uint64_t id_;
  Eigen::Vector3d anchor_;
  std::variant<Polynomial, Piece> kind_;
  std::optional<JointState> rest_;
};

}  // namespace firstcontact
