#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include <firstcontact/robot/detail/mimicked_joint.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

/// Whether a joint that follows this one, or a follower of such, is elsewhere after a whole turn.
bool shows_whole_turns(const RobotModel& robot, std::size_t joint) {
  for (std::size_t k = 0; k < robot.joints().size(); ++k) {
    const Joint& follower = robot.joints()[k];
    if (!follower.mimic) {
      continue;
    }
    const detail::MimickedJoint of = detail::mimicked_joint(robot, k);
    const bool turns_about =
        follower.type == JointType::revolute || follower.type == JointType::continuous;
    const bool is_whole = turns_about && std::trunc(of.multiplier) == of.multiplier;
    if (of.joint == joint && of.multiplier != 0.0 && !is_whole) {
      return true;
    }
  }
  return false;
}

/// Whether a coordinate is at the same place after a whole turn.
bool is_endless(const RobotModel& robot, const JointCoordinate& coordinate) {
  const Joint& joint = robot.joints()[coordinate.joint];
  return !joint.mimic && (joint.type == JointType::continuous ||
                          (joint.type == JointType::planar && coordinate.index == 2));
}

}  // namespace

bool takes_short_way(const RobotModel& robot, const JointCoordinate& coordinate) {
  return is_endless(robot, coordinate) && !shows_whole_turns(robot, coordinate.joint);
}

std::vector<JointTurn> joint_turns(const RobotModel& robot, const Trajectory& trajectory) {
  std::vector<JointTurn> turns;
  for (std::size_t k = 0; k < trajectory.joint_names.size(); ++k) {
    const JointCoordinate coordinate = find_coordinate(robot, trajectory.joint_names[k]);
    if (!is_endless(robot, coordinate)) {
      continue;
    }
    const bool is_short =
        trajectory.turning == Turning::shortest && takes_short_way(robot, coordinate);
    JointTurn turn{.joint = trajectory.joint_names[k],
                   .from = trajectory.points.front().positions.at(k),
                   .to = trajectory.points.back().positions.at(k),
                   .turning = is_short ? Turning::shortest : Turning::as_given};
    bool moves = false;
    for (std::size_t i = 0; i + 1 < trajectory.points.size(); ++i) {
      const double from = trajectory.points[i].positions.at(k);
      const double to = trajectory.points[i + 1].positions.at(k);
      const double way = shortest_way(from, to);
      turn.turned += is_short ? way : to - from;
      turn.differs = turn.differs || way != to - from;
      moves = moves || from != to;
    }
    if (!is_short) {
      turn.turned = turn.to - turn.from;
    }
    if (moves) {
      turns.push_back(std::move(turn));
    }
  }
  return turns;
}

const char* to_string(Turning turning) { return kTurningWords[static_cast<std::size_t>(turning)]; }

Turning turning_of(std::string_view word) {
  const auto found = std::ranges::find(kTurningWords, word);
  if (found == kTurningWords.end()) {
    throw std::invalid_argument("expected \"long\" or \"short\", got " + detail::in_quotes(word));
  }
  return static_cast<Turning>(found - kTurningWords.begin());
}

}  // namespace firstcontact
