#include <firstcontact/robot_check/detail/robot_tree.h>

namespace firstcontact::detail {

RobotTree::RobotTree(const RobotModel& model) : nodes{{}}, node_of_link(model.links().size()) {
  std::vector<std::size_t> open = {model.root()};
  while (!open.empty()) {
    const std::size_t link = open.back();
    open.pop_back();
    for (std::size_t joint = 0; joint < model.joints().size(); ++joint) {
      if (model.parent_link(joint) != link) {
        continue;
      }
      open.push_back(model.child_link(joint));
      if (model.joints()[joint].type != JointType::fixed) {
        node_of_link[model.child_link(joint)] = nodes.size();
        nodes.push_back({node_of_link[model.rigid_root(link)], joint});
      }
    }
  }
}

}  // namespace firstcontact::detail
