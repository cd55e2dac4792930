/// @file
/// First contact of boxes along an edge, by distances and speeds that are independent of the
/// library.

#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/robot/robot_motion.h>

namespace firstcontact::test {

/// A box at a place in the world.
struct PlacedBox {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half = Eigen::Vector3d::Zero();  ///< [m]  Half of its sizes.
};

/// Boxes that move along an edge.
struct MovingBoxes {
  std::function<std::vector<PlacedBox>(double share)> at;
  std::vector<std::array<std::size_t, 2>> pairs;  ///< Pairs that may meet.
  double speed = 0.0;                             ///< [m]  No pair moves further on the whole edge.
};

/// The contact of an edge.
struct WalkedEdge {
  /// [-]  Before this share all pairs are farther apart than `near`. None where they always are.
  std::optional<double> near_from = {};
  /// [-]  At this share a pair is within 1e-12 m, the rounding of its distance.
  std::optional<double> met_by = {};
};

/// Walks along an edge in steps that no speed can leap over.
///
/// @param near    [m]  > 0
/// @param finest  [-]  least step
[[nodiscard]] WalkedEdge walk(const MovingBoxes& boxes, double near, double finest);

/// A joint of an arm of boxes: it turns about z or y in turn.
struct ArmJoint {
  bool is_continuous = false;
  std::optional<std::size_t> follows = {};  ///< The joint that it mimics, an earlier one.
  double multiplier = 1.0;
  double offset = 0.0;  ///< [rad]
};

/// An arm of boxes of 0.2 m in chain, 0.3 m from joint to joint, with limits of 1.5 rad.
class BoxArm {
 public:
  explicit BoxArm(std::vector<ArmJoint> joints);

  [[nodiscard]] const RobotMotion& rest() const { return rest_; }
  /// The space of all joints that follow no other one.
  [[nodiscard]] ConfigurationSpace space() const;
  /// Its links by its own kinematics.
  ///
  /// @param planned  [rad]  positions of the joints that follow no other one
  [[nodiscard]] std::vector<PlacedBox> links(std::span<const double> planned) const;
  /// [m]  How far no point of a link moves on an edge from one place to the other.
  [[nodiscard]] double way(std::span<const double> from, std::span<const double> to) const;

 private:
  [[nodiscard]] std::vector<double> positions(std::span<const double> planned) const;

  std::vector<ArmJoint> joints_;
  RobotMotion rest_;
};

/// The box of a floating body from the seven numbers of its pose.
[[nodiscard]] PlacedBox placed_box(std::span<const double> pose, const Eigen::Vector3d& half);

/// [m]  How far no point of a floating box moves between two poses.
[[nodiscard]] double way_of_box(std::span<const double> from, std::span<const double> to,
                                const Eigen::Vector3d& half);

}  // namespace firstcontact::test
