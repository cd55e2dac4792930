#include "support/robot_input.h"

#include <algorithm>

namespace firstcontact::oracle {

std::vector<std::size_t> joints_between(const RobotInput& robot, std::size_t ancestor,
                                        std::size_t link) {
  std::vector<std::size_t> joints;
  while (link != ancestor) {
    joints.push_back(link - 1);
    link = robot.joints[link - 1].parent;
  }
  std::reverse(joints.begin(), joints.end());
  return joints;
}

std::size_t common_ancestor(const RobotInput& robot, std::size_t link, std::size_t other) {
  // A link's number is greater than that of the one on which it hangs.
  while (link != other) {
    std::size_t& farther = link > other ? link : other;
    farther = robot.joints[farther - 1].parent;
  }
  return link;
}

}  // namespace firstcontact::oracle
