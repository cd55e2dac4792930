/// @file
/// The links of a robot as a tree.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/robot/robot_model.h>

namespace firstcontact::detail {

/// The links of a robot that joints move, each after the one that carries it.
struct RobotTree {
  struct Node {
    std::size_t parent = 0;  ///< Index of the parent; of no meaning for the first node.
    std::size_t joint = 0;   ///< Index of the joint that moves the node; of no meaning for the
                             ///< first.
  };
  std::vector<Node> nodes;
  std::vector<std::size_t> node_of_link;  ///< Node of each link that is its own rigid_root().

  explicit RobotTree(const RobotModel& model);
};

}  // namespace firstcontact::detail
