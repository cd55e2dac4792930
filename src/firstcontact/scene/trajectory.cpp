#include <firstcontact/scene/trajectory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>

#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

constexpr std::array<std::string_view, 3> kPlanarSuffixes = {"/x", "/y", "/theta"};

[[noreturn]] void refuse(const std::string& joint, const std::string& why) {
  throw std::invalid_argument("joint " + detail::in_quotes(joint) + ": " + why);
}

/// The joint and coordinate of "NAME/x", "NAME/y", "NAME/theta".
std::optional<JointCoordinate> find_planar(const RobotModel& robot, std::string_view name) {
  for (std::size_t k = 0; k < kPlanarSuffixes.size(); ++k) {
    if (!name.ends_with(kPlanarSuffixes[k])) {
      continue;
    }
    const auto joint = robot.find_joint(name.substr(0, name.size() - kPlanarSuffixes[k].size()));
    if (joint && robot.joints()[*joint].type == JointType::planar) {
      return JointCoordinate{*joint, k};
    }
  }
  return std::nullopt;
}

[[noreturn]] void refuse_unknown(const RobotModel& robot, std::string_view name) {
  std::vector<std::string> names;
  for (std::size_t joint = 0; joint < robot.joints().size(); ++joint) {
    for (std::size_t k = 0; k < coordinate_count(robot.joints()[joint].type); ++k) {
      names.push_back(coordinate_name(robot, {joint, k}));
    }
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  const std::string_view nearest = detail::nearest_word(name, known);
  // Without the robot's name, as that of its URDF may differ from the scene's.
  throw std::invalid_argument(
      "expected a joint of the robot, got " + detail::in_quotes(name) + "; " +
      (known.empty()     ? "it has no joint with a coordinate"
       : nearest.empty() ? "it has " + detail::listed(known)
                         : "did you mean " + detail::in_quotes(nearest) + "?"));
}

/// The numbers of one coordinate of a trajectory, by points.
std::vector<double> column(const Trajectory& trajectory, std::size_t k,
                           const std::vector<double> TrajectoryPoint::*numbers, double factor) {
  std::vector<double> result;
  for (const TrajectoryPoint& point : trajectory.points) {
    result.push_back((point.*numbers).at(k) * factor);
  }
  return result;
}

void require_counts(const Trajectory& trajectory) {
  if (trajectory.points.empty()) {
    throw std::invalid_argument("expected a trajectory of at least one point, got none");
  }
  const TrajectoryPoint& first = trajectory.points.front();
  const auto wrong = [&](const std::vector<double>& numbers, const std::vector<double>& of_first) {
    return numbers.size() != of_first.size() ||
           (!numbers.empty() && numbers.size() != trajectory.joint_names.size());
  };
  for (const TrajectoryPoint& point : trajectory.points) {
    if (point.positions.size() != trajectory.joint_names.size() ||
        wrong(point.velocities, first.velocities) ||
        wrong(point.accelerations, first.accelerations) ||
        (point.velocities.empty() && !point.accelerations.empty())) {
      throw std::invalid_argument(
          "expected as many positions as joint names in each point, and so "
          "many velocities and accelerations, or none in all");
    }
  }
}

CoordinatePath path_of(const Trajectory& trajectory, std::size_t k, double duration,
                       Turning turning) {
  std::vector<double> times;
  for (const TrajectoryPoint& point : trajectory.points) {
    times.push_back(point.time / duration);
  }
  const std::vector<double> positions = column(trajectory, k, &TrajectoryPoint::positions, 1.0);
  const TrajectoryPoint& first = trajectory.points.front();
  if (first.velocities.empty() || trajectory.joint_names.empty()) {
    return CoordinatePath::linear(times, positions, turning);
  }
  const std::vector<double> velocities =
      column(trajectory, k, &TrajectoryPoint::velocities, duration);
  if (first.accelerations.empty()) {
    return CoordinatePath::cubic(times, positions, velocities, turning);
  }
  return CoordinatePath::quintic(
      times, positions, velocities,
      column(trajectory, k, &TrajectoryPoint::accelerations, duration * duration), turning);
}

/// Collects the knowledge of every coordinate, and makes joint motions of it.
class MotionBuilder {
 public:
  MotionBuilder(const RobotModel& robot, const Trajectory& trajectory, const JointPositions& held,
                double duration)
      : robot_(robot), trajectory_(trajectory), duration_(duration) {
    for (const auto& [name, position] : held) {
      held_[find_coordinate(robot, name)] = position;
    }
    for (std::size_t k = 0; k < trajectory.joint_names.size(); ++k) {
      const std::string& name = trajectory.joint_names[k];
      if (!columns_.insert({find_coordinate(robot, name), k}).second) {
        refuse(name, "expected each joint once, got it twice");
      }
    }
  }

  TrajectoryMotion build() {
    TrajectoryMotion result;
    for (std::size_t joint = 0; joint < robot_.joints().size(); ++joint) {
      const Joint& what = robot_.joints()[joint];
      if (what.mimic) {
        require_same(joint);
      } else if (what.type == JointType::floating || what.type == JointType::ball) {
        result.joints.insert({what.name, Motion::fixed()});
      } else if (what.type == JointType::planar) {
        result.joints.insert(
            {what.name, PlanarPath{coordinate({joint, 0}, result), coordinate({joint, 1}, result),
                                   coordinate({joint, 2}, result)}});
      } else if (what.type != JointType::fixed) {
        result.joints.insert({what.name, coordinate({joint, 0}, result)});
      }
    }
    return result;
  }

 private:
  [[nodiscard]] Turning turning_of(const JointCoordinate& which) const {
    return takes_short_way(robot_, which) ? trajectory_.turning : Turning::as_given;
  }

  CoordinatePath coordinate(const JointCoordinate& which, TrajectoryMotion& result) const {
    const std::string name = coordinate_name(robot_, which);
    try {
      if (const auto column = columns_.find(which); column != columns_.end()) {
        return path_of(trajectory_, column->second, duration_, turning_of(which));
      }
      if (const auto held = held_.find(which); held != held_.end()) {
        return CoordinatePath::constant(held->second);
      }
      result.at_default.push_back(name);
      return CoordinatePath::constant(default_position(robot_.joints()[which.joint]));
    } catch (const std::invalid_argument& error) {
      refuse(name, error.what());
    }
  }

  /// [rad or m]  The position of a coordinate at a point, from the trajectory or the given
  /// positions.
  [[nodiscard]] double position(std::size_t joint, std::size_t point) const {
    const JointCoordinate which{joint, 0};
    if (const auto column = columns_.find(which); column != columns_.end()) {
      return trajectory_.points[point].positions[column->second];
    }
    if (const auto held = held_.find(which); held != held_.end()) {
      return held->second;
    }
    const Joint& what = robot_.joints()[joint];
    return what.mimic ? mimicked(*what.mimic, point) : default_position(what);
  }

  [[nodiscard]] double mimicked(const Mimic& mimic, std::size_t point) const {
    return mimic.multiplier * position(*robot_.find_joint(mimic.joint), point) + mimic.offset;
  }

  /// Requires that a mimic joint has the positions that follow from the other joint.
  void require_same(std::size_t joint) const {
    constexpr double kSlack = 1e-6;  // [rad or m]  See joint_motions.
    const Joint& what = robot_.joints()[joint];
    const JointCoordinate which{joint, 0};
    if (!columns_.contains(which) && !held_.contains(which)) {
      return;
    }
    for (std::size_t point = 0; point < trajectory_.points.size(); ++point) {
      const double follows = mimicked(*what.mimic, point);
      const double said = position(joint, point);
      if (!(std::abs(said - follows) <= kSlack)) {
        refuse(what.name, "expected " + detail::write_json(follows) + " at " +
                              detail::write_json(trajectory_.points[point].time) +
                              " s, as it mimics " + detail::in_quotes(what.mimic->joint) +
                              ", got " + detail::write_json(said));
      }
    }
  }

  const RobotModel& robot_;
  const Trajectory& trajectory_;
  double duration_;
  std::map<JointCoordinate, std::size_t> columns_;
  std::map<JointCoordinate, double> held_;
};

}  // namespace

std::optional<JointCoordinate> known_coordinate(const RobotModel& robot, std::string_view name) {
  if (const auto planar = find_planar(robot, name)) {
    return planar;
  }
  const auto joint = robot.find_joint(name);
  const bool has_one = joint && coordinate_count(robot.joints()[*joint].type) == 1;
  return has_one ? std::optional(JointCoordinate{*joint, 0}) : std::nullopt;
}

JointCoordinate find_coordinate(const RobotModel& robot, std::string_view name) {
  if (const auto known = known_coordinate(robot, name)) {
    return *known;
  }
  const auto joint = robot.find_joint(name);
  if (!joint) {
    refuse_unknown(robot, name);
  }
  const JointType type = robot.joints()[*joint].type;
  if (type == JointType::planar) {
    refuse(std::string(name),
           "expected one coordinate of this planar joint: NAME/x, NAME/y or "
           "NAME/theta");
  }
  refuse(std::string(name),
         std::string("expected a joint with a coordinate, this one is ") + to_string(type));
}

std::string coordinate_name(const RobotModel& robot, const JointCoordinate& coordinate) {
  const Joint& joint = robot.joints()[coordinate.joint];
  return joint.type == JointType::planar
             ? joint.name + std::string(kPlanarSuffixes.at(coordinate.index))
             : joint.name;
}

bool names_fixed_joint(const RobotModel& robot, std::string_view name) {
  const auto joint = robot.find_joint(name);
  return joint && robot.joints()[*joint].type == JointType::fixed;
}

double default_position(const Joint& joint) {
  const double below = std::min(0.0, joint.limits.upper.value_or(0.0));
  return joint.limits.lower ? std::max(below, *joint.limits.lower) : below;
}

TrajectoryMotion joint_motions(const RobotModel& robot, const Trajectory& trajectory,
                               const JointPositions& held, double duration) {
  require_counts(trajectory);
  return MotionBuilder(robot, trajectory, held, duration).build();
}

}  // namespace firstcontact
