/// @file
/// Frames that hang on each other by joints, over a piece of time.

#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/robot/joint_path.h>
#include <firstcontact/robot/link_path.h>
#include <firstcontact/robot_check/detail/time_grid.h>

namespace firstcontact::detail {

/// A frame in the world at one time. Errors bound the distance from the exact motion.
struct FramePlace {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< [m]
  double rotation_error = 0.0;                  ///< [-]  R y is within this of exact, per |y|.
  double position_error = 0.0;                  ///< [m]  By rotations and pivots.
  double rounding = 0.0;                        ///< [m]  Of p.
  double length = 0.0;                          ///< [m]  Of the chain that leads here.
};

/// A robot, or a body that moves on its own: the links that joints move against each other. What
/// ChainMemory knows of one chain after the other, without velocities, for all links at once: cheap
/// where most of them are asked about.
class TreePoses {
 public:
  static constexpr std::size_t kWorld = std::numeric_limits<std::size_t>::max();

  struct Node {
    std::size_t parent = kWorld;      ///< Comes before it.
    const JointPath* path = nullptr;  ///< From the parent; smooth in the piece.
  };

  TreePoses(const std::vector<Node>& nodes, const TimeGrid& grid);

  [[nodiscard]] std::size_t size() const { return joints_.size(); }
  [[nodiscard]] std::size_t parent(std::size_t node) const { return joints_[node].node.parent; }

  /// At a time of the grid.
  [[nodiscard]] const FramePlace& place(std::size_t node, int k);

  /// Whether it does not move in the world.
  [[nodiscard]] bool rests(std::size_t node) const { return joints_[node].rests; }

  /// Bounds the derivatives of every point of a ball that is fixed in a node, over the piece.
  ///
  /// They are as seen from a node that carries it, or the world. The derivation is that of
  /// LinkPath::window().
  [[nodiscard]] CoordinateSegment::Bounds bounds(std::size_t node, const Eigen::Vector3d& p_LC,
                                                 double reach, std::size_t frame);

 private:
  /// At the middle of the piece, in the world.
  struct Lever {
    Eigen::Vector3d p_WQ;  // [m]
    Eigen::Vector3d axis;  // [-]
    double step = 0.0;     // [m]  |p_PQ|
    double lever = 0.0;    // [m]  |p_QL|
    JointBounds bounds;
  };
  struct Joint {
    Node node;
    bool rests = false;  // With all that it hangs on.
  };
  void place_all(int k);
  void add_lever(const FramePlace& parent, const JointState& state, const JointPath& path);

  TimeGrid grid_;
  std::vector<Joint> joints_;
  std::vector<Lever> levers_;  // Empty until a place at the middle was asked for.
  std::array<std::vector<FramePlace>, GridWindow::kSize + 1> places_;  // So, too, each.
};

}  // namespace firstcontact::detail
