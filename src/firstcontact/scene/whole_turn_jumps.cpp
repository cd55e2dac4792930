#include <firstcontact/scene/whole_turn_jumps.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/text/quantity.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Whether a recording may have an angle less whole turns.
bool may_wrap(const Joint& joint, const JointCoordinate& coordinate) {
  switch (joint.type) {
    case JointType::continuous:
      return true;
    case JointType::planar:
      return coordinate.index == 2;
    case JointType::revolute:
      return !joint.limits.lower || !joint.limits.upper ||
             *joint.limits.upper - *joint.limits.lower > kTurn;
    default:
      return false;
  }
}

/// One angle along a trajectory.
class RecordedAngle {
 public:
  RecordedAngle(const Trajectory& trajectory, std::size_t column, const Joint& joint)
      : points_(trajectory.points), column_(column), limit_(joint.limits.velocity.value_or(0.0)) {}

  [[nodiscard]] std::vector<std::size_t> jumps() const {
    std::vector<std::size_t> found;
    if (!within_one_turn()) {
      return found;
    }
    const double usual = greatest_speed();
    for (std::size_t k = 1; k < points_.size(); ++k) {
      if (short_way(k) != way(k) && is_no_motion(k, usual)) {
        found.push_back(k);
      }
    }
    return found;
  }

  [[nodiscard]] double angle(std::size_t k) const { return points_[k].positions.at(column_); }

 private:
  [[nodiscard]] double seconds(std::size_t k) const {
    return points_[k].time - points_[k - 1].time;
  }
  [[nodiscard]] double way(std::size_t k) const { return angle(k) - angle(k - 1); }
  [[nodiscard]] double short_way(std::size_t k) const {
    return shortest_way(angle(k - 1), angle(k));
  }

  [[nodiscard]] bool within_one_turn() const {
    constexpr double kSlack = 1e-3;  // [rad]  Covers recordings that round, or step over the end.
    double least = angle(0);
    double greatest = least;
    for (std::size_t k = 1; k < points_.size(); ++k) {
      least = std::min(least, angle(k));
      greatest = std::max(greatest, angle(k));
    }
    return greatest - least <= kTurn + kSlack;
  }

  /// [rad/s]  Greatest speed of the steps of at most half a turn.
  [[nodiscard]] double greatest_speed() const {
    double greatest = 0.0;
    for (std::size_t k = 1; k < points_.size(); ++k) {
      if (short_way(k) == way(k)) {
        greatest = std::max(greatest, std::abs(way(k)) / seconds(k));
      }
    }
    return greatest;
  }

  [[nodiscard]] bool is_no_motion(std::size_t k, double usual) const {
    if (!points_[k].velocities.empty()) {
      const double mean =
          0.5 * (points_[k - 1].velocities.at(column_) + points_[k].velocities.at(column_));
      const double expected = mean * seconds(k);
      return std::abs(short_way(k) - expected) < std::abs(way(k) - expected);
    }
    const double speed = std::abs(way(k)) / seconds(k);
    const double short_speed = std::abs(short_way(k)) / seconds(k);
    if (limit_ > 0.0 && speed > limit_ && short_speed <= limit_) {
      return true;
    }
    constexpr double kFaster = 3.0;
    constexpr double kAlike = 2.0;
    constexpr double kStill = 0.01;  // [rad]
    return points_.size() > 2 && speed > kFaster * usual &&
           (short_speed <= kAlike * usual || std::abs(short_way(k)) <= kStill);
  }

  const std::vector<TrajectoryPoint>& points_;
  std::size_t column_;
  double limit_;  // [rad/s]  0 where there is none.
};

}  // namespace

std::vector<WholeTurnJump> whole_turn_jumps(const RobotModel& robot, const Trajectory& trajectory) {
  std::vector<WholeTurnJump> jumps;
  for (std::size_t column = 0; column < trajectory.joint_names.size(); ++column) {
    const JointCoordinate coordinate = find_coordinate(robot, trajectory.joint_names[column]);
    const Joint& joint = robot.joints()[coordinate.joint];
    const bool is_short =
        trajectory.turning == Turning::shortest && takes_short_way(robot, coordinate);
    if (is_short || joint.mimic || !may_wrap(joint, coordinate)) {
      continue;
    }
    const RecordedAngle angle(trajectory, column, joint);
    const std::vector<std::size_t> found = angle.jumps();
    if (!found.empty()) {
      const std::size_t first = found.front();
      jumps.push_back({.joint = trajectory.joint_names[column],
                       .time = trajectory.points[first].time,
                       .from = angle.angle(first - 1),
                       .to = angle.angle(first),
                       .count = found.size()});
    }
  }
  return jumps;
}

Trajectory unwrapped(const RobotModel& robot, Trajectory trajectory) {
  for (std::size_t column = 0; column < trajectory.joint_names.size(); ++column) {
    const JointCoordinate coordinate = find_coordinate(robot, trajectory.joint_names[column]);
    if (!may_wrap(robot.joints()[coordinate.joint], coordinate)) {
      continue;
    }
    double turns = 0.0;
    double before = trajectory.points.front().positions.at(column);
    for (TrajectoryPoint& point : trajectory.points) {
      double& angle = point.positions.at(column);
      turns += std::round((shortest_way(before, angle) - (angle - before)) / kTurn);
      before = angle;
      angle += turns * kTurn;
    }
  }
  return trajectory;
}

std::string describe(const WholeTurnJump& jump) {
  const std::string others =
      jump.count > 1 ? ", and " + std::to_string(jump.count - 1) + " times more" : "";
  return "joint " + detail::in_quotes(jump.joint) + " jumps by a whole turn, from " +
         detail::quantity(jump.from, "rad") + " to " + detail::quantity(jump.to, "rad") + " at " +
         detail::quantity(jump.time, "s") + others +
         ": a recording that wraps; --unwrap, or \"unwrap\": true in a scene, takes the turns out";
}

}  // namespace firstcontact
