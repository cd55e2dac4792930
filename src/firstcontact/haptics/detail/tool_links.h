/// @file
/// The links of all tools, and their places by joints.

#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/haptic_scene.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact::detail {

/// Links and joints of all tools, numbered tool after tool.
class ToolLinks {
 public:
  /// A link. -1 stands for none.
  struct Node {
    std::size_t tool = 0;
    int parent = -1;  ///< A link before it; -1 for the tool's body.
    int joint = -1;   ///< Its joint; -1 where it is fixed.
    double turn = 0.0;
    double slide = 0.0;
    Pose X_PJ;
    Eigen::Vector3d axis_J = Eigen::Vector3d::UnitZ();
  };

  ToolLinks() = default;
  /// Numbers the links and joints of all tools.
  ///
  /// @param tools  that were checked (check_haptic_scene())
  explicit ToolLinks(const std::vector<HapticTool>& tools);

  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  [[nodiscard]] std::span<const HapticJoint> joints() const { return joints_; }
  [[nodiscard]] std::size_t tool_of_joint(std::size_t joint) const { return tool_of_joint_[joint]; }

  /// The number of coordinates: first those of the tools, six each, then those of joints.
  [[nodiscard]] std::size_t coordinates() const { return 6 * tools_ + joints_.size(); }
  [[nodiscard]] std::size_t coordinate_of(std::size_t joint) const { return 6 * tools_ + joint; }

  /// Whether two links touch by construction: one hangs on the other, or no joint moves one against
  /// the other.
  ///
  /// @param a, b  links; -1 for the body of their tool
  [[nodiscard]] bool are_joined(int a, int b) const;

  /// Places all links.
  ///
  /// @param X_WB    of the tools
  /// @param joints  [rad or m]
  /// @param X_WL    takes their poses
  void place(std::span<const Pose> X_WB, std::span<const double> joints, std::span<Pose> X_WL,
             std::span<HapticAxis> axes) const;

  /// [rad]  Bounds the turn of each link against its tool where joints move by `of_joints`.
  [[nodiscard]] std::vector<double> turns(std::span<const double> of_joints) const;

  /// [m]  Bounds the slide of each link against its tool where joints move by `of_joints`.
  [[nodiscard]] std::vector<double> slides(std::span<const double> of_joints) const;

  /// [rad]  Computes the turn of a link by its own joint.
  [[nodiscard]] double own_turn(std::size_t link, std::span<const double> of_joints) const;

 private:
  [[nodiscard]] int rigid_root(int link) const;
  [[nodiscard]] std::vector<double> sums(std::span<const double> of_joints,
                                         double Node::*rate) const;

  std::size_t tools_ = 0;
  std::vector<Node> nodes_;
  std::vector<HapticJoint> joints_;
  std::vector<std::size_t> tool_of_joint_;
};

}  // namespace firstcontact::detail
