/// @file
/// Frames that hang on each other by joints, over a piece of time.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>
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
  double position_error = 0.0;                  ///< [m]  Error by rotations and pivots.
  double rounding = 0.0;                        ///< [m]  Rounding of p.
  double length = 0.0;                          ///< [m]  Length of the chain to the frame.
};

/// The poses of a robot's links, or of a body that moves on its own, at the times of a grid.
///
/// It has for all links at once what ChainMemory has for one chain after another, without
/// velocities. That saves work where most links are needed.
class TreePoses {
 public:
  static constexpr std::size_t kWorld = std::numeric_limits<std::size_t>::max();

  struct Node {
    std::size_t parent = kWorld;      ///< Index of the parent, which comes before the node.
    const JointPath* path = nullptr;  ///< Path from the parent; smooth in the piece.
  };

  /// @param memory  outlives the object
  TreePoses(std::span<const Node> nodes, const TimeGrid& grid,
            std::pmr::memory_resource& memory = *std::pmr::get_default_resource());

  /// A body that is the only node.
  TreePoses(const JointPath& path, const TimeGrid& grid);

  [[nodiscard]] std::size_t size() const { return joints_.size(); }
  [[nodiscard]] std::size_t parent(std::size_t node) const { return joints_[node].node.parent; }

  /// The place of a node at a time of the grid. Valid until a place at another time is needed.
  [[nodiscard]] const FramePlace& place(std::size_t node, int k);

  /// Whether a node rests in the world.
  [[nodiscard]] bool rests(std::size_t node) const { return joints_[node].rests; }

  /// Bounds the derivatives of every point of a ball that is fixed in a node, over the piece.
  ///
  /// They are as seen from `frame`, a node that carries it or the world. LinkPath::window() has the
  /// derivation.
  [[nodiscard]] CoordinateSegment::Bounds bounds(std::size_t node, const Eigen::Vector3d& p_LC,
                                                 double reach, std::size_t frame);

 private:
  /// The axis and the lengths of a joint at the middle of the piece, in the world.
  struct Lever {
    Eigen::Vector3d p_WQ;  // [m]
    Eigen::Vector3d axis;  // [-]
    double step = 0.0;     // [m]  |p_PQ|
    double lever = 0.0;    // [m]  |p_QL|
    JointBounds bounds;
  };
  struct Joint {
    Node node;
    bool rests = false;  // Whether the node rests, with all nodes above it.
  };
  void place_all(int k);
  void add_lever(const FramePlace& parent, const JointState& state, const JointPath& path);

  static constexpr std::size_t kFewTimes = 5;  // Those of the piece and its halves.
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  TimeGrid grid_;
  std::pmr::vector<Joint> joints_;
  std::pmr::vector<Lever> levers_;  // Empty until a place at the middle is needed.
  std::pmr::vector<FramePlace> places_;
  std::array<std::uint32_t, GridWindow::kSize + 1> first_;  // Where those of a time begin; or none.
};

}  // namespace firstcontact::detail
