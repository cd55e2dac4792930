#include <firstcontact/foreign_scenes/detail/given_positions.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <firstcontact/text/brief_list.h>
#include <firstcontact/text/read_double.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/fixed_joints.h>

namespace firstcontact::detail {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

/// Reads a state of the SRDF, or NAME=POSITION, also for a fixed joint.
JointPositions said_by(const std::string& text, const SceneRobot& robot) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos && robot.semantics.states.empty()) {
    refuse("expected NAME=POSITION of a joint, got " + in_quotes(text) +
           "; names of states are those of an SRDF");
  }
  if (sign == std::string::npos) {
    return group_state(robot.model, robot.semantics, text);
  }
  const std::string name = text.substr(0, sign);
  if (!names_fixed_joint(robot.model, name)) {
    (void)find_coordinate(robot.model, name);
  }
  double position = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = read_double(text.data() + sign + 1, end, position);
  if (error != std::errc() || stop != end || !std::isfinite(position)) {
    refuse("expected NAME=POSITION with a finite number, such as " + name + "=0.1, got " +
           in_quotes(text));
  }
  return {{name, position}};
}

GivenPositions moving(const JointPositions& positions, const std::string& what,
                      const RobotModel& robot) {
  GivenPositions given{.positions = without_fixed_joints(robot, positions), .warnings = {}};
  if (const auto fixed = fixed_joints_in(robot, positions); !fixed.empty()) {
    given.warnings.push_back(what + ": " + fixed_joints_warning(fixed));
  }
  return given;
}

}  // namespace

GivenPositions positions_of(const std::vector<std::string>& texts, const std::string& what,
                            const SceneRobot& robot) try {
  JointPositions positions;
  std::set<std::string> told;  // Joints named one by one; joints of states may be set again.
  for (const std::string& text : texts) {
    for (const auto& [name, position] : said_by(text, robot)) {
      positions[name] = position;
      if (text.find('=') != std::string::npos && !told.insert(name).second) {
        refuse("expected joint " + in_quotes(name) + " once, got it again in " + in_quotes(text));
      }
    }
  }
  return moving(positions, what, robot.model);
} catch (const std::invalid_argument& error) {
  refuse(what + ": " + error.what());
}

GivenPositions positions_at_rest(const JointPositions& state, const std::string& source,
                                 const SceneRobot& robot) {
  GivenPositions given = moving(state, source, robot.model);
  const std::vector<std::string>& moved = robot.trajectory.joint_names;
  std::vector<std::string> unknown;
  std::erase_if(given.positions, [&](const auto& entry) {
    const auto coordinate = known_coordinate(robot.model, entry.first);
    if (!coordinate) {
      unknown.push_back(entry.first);
    }
    return !coordinate || robot.model.joints()[coordinate->joint].mimic ||
           std::find(moved.begin(), moved.end(), entry.first) != moved.end();
  });
  if (!unknown.empty()) {
    given.warnings.push_back(
        source + ": robot_state names joints that the robot does not have: " + some_of(unknown));
  }
  return given;
}

}  // namespace firstcontact::detail
