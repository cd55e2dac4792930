#include <firstcontact/trajectory_files/detail/fixed_joints.h>

#include <algorithm>
#include <utility>

#include <firstcontact/text/brief_list.h>

namespace firstcontact::detail {

std::vector<std::string> fixed_joints_in(const RobotModel& robot, const JointPositions& positions) {
  std::vector<std::string> names;
  for (const auto& [name, position] : positions) {
    if (names_fixed_joint(robot, name)) {
      names.push_back(name);
    }
  }
  return names;
}

JointPositions without_fixed_joints(const RobotModel& robot, JointPositions positions) {
  std::erase_if(positions,
                [&](const auto& entry) { return names_fixed_joint(robot, entry.first); });
  return positions;
}

std::string fixed_joints_warning(std::vector<std::string> names) {
  if (names.empty()) {
    return {};
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const bool one = names.size() == 1;
  return (one ? "a position is given for a fixed joint, " + some_of(names) + "; it is"
              : "positions are given for " + std::to_string(names.size()) + " fixed joints, " +
                    some_of(names) + "; they are") +
         " where the URDF has " + (one ? "it" : "them");
}

}  // namespace firstcontact::detail
