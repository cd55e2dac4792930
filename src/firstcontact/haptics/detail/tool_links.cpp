#include <firstcontact/haptics/detail/tool_links.h>

#include <cmath>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

Pose then(const Pose& X_AB, const Pose& X_BC) {
  return {X_AB.position + X_AB.rotation * X_BC.position,
          (X_AB.rotation * X_BC.rotation).normalized()};
}

}  // namespace

ToolLinks::ToolLinks(const std::vector<HapticTool>& tools) : tools_(tools.size()) {
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    const auto first_link = static_cast<int>(nodes_.size());
    const auto first_joint = static_cast<int>(joints_.size());
    for (const HapticLink& link : tools[tool].links) {
      nodes_.push_back({.tool = tool,
                        .parent = link.parent ? first_link + static_cast<int>(*link.parent) : -1,
                        .joint = link.joint ? first_joint + static_cast<int>(*link.joint) : -1,
                        .turn = link.joint ? link.turn : 0.0,
                        .slide = link.joint ? link.slide : 0.0,
                        .X_PJ = {link.X_PJ.position, link.X_PJ.rotation.normalized()},
                        .axis_J = link.axis.normalized()});
    }
    for (const HapticJoint& joint : tools[tool].joints) {
      joints_.push_back(joint);
      tool_of_joint_.push_back(tool);
    }
  }
}

int ToolLinks::rigid_root(int link) const {
  while (link >= 0 && nodes_[static_cast<std::size_t>(link)].joint < 0) {
    link = nodes_[static_cast<std::size_t>(link)].parent;
  }
  return link;
}

bool ToolLinks::are_joined(int a, int b) const {
  const auto parent = [&](int link) {
    return link < 0 ? -2 : nodes_[static_cast<std::size_t>(link)].parent;
  };
  return rigid_root(a) == rigid_root(b) || parent(a) == b || parent(b) == a;
}

void ToolLinks::place(std::span<const Pose> X_WB, std::span<const double> joints,
                      std::span<Pose> X_WL, std::span<HapticAxis> axes) const {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Node& node = nodes_[k];
    const Pose& at =
        node.parent < 0 ? X_WB[node.tool] : X_WL[static_cast<std::size_t>(node.parent)];
    const Pose X_WJ = then({at.position, at.rotation.normalized()}, node.X_PJ);
    axes[k] = {X_WJ.position, X_WJ.rotation * node.axis_J};
    X_WL[k] = X_WJ;
    if (node.joint >= 0) {
      const double q = joints[static_cast<std::size_t>(node.joint)];
      X_WL[k] = then(X_WJ, {node.slide * q * node.axis_J,
                            Eigen::Quaterniond(Eigen::AngleAxisd(node.turn * q, node.axis_J))});
    }
  }
}

double ToolLinks::own_turn(std::size_t link, std::span<const double> of_joints) const {
  const Node& node = nodes_[link];
  return node.joint < 0 ? 0.0
                        : std::abs(node.turn * of_joints[static_cast<std::size_t>(node.joint)]);
}

/// Sums for each link the rates of its joint and of those on which it hangs.
std::vector<double> ToolLinks::sums(std::span<const double> of_joints, double Node::*rate) const {
  std::vector<double> sums(nodes_.size());
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Node& node = nodes_[k];
    sums[k] = node.parent < 0 ? 0.0 : sums[static_cast<std::size_t>(node.parent)];
    if (node.joint >= 0) {
      sums[k] += std::abs(node.*rate * of_joints[static_cast<std::size_t>(node.joint)]);
    }
  }
  return sums;
}

std::vector<double> ToolLinks::turns(std::span<const double> of_joints) const {
  return sums(of_joints, &Node::turn);
}

std::vector<double> ToolLinks::slides(std::span<const double> of_joints) const {
  return sums(of_joints, &Node::slide);
}

}  // namespace firstcontact::detail
