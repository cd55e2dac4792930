#include <firstcontact/scene/trajectory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

constexpr std::array<std::string_view, 3> kPlanarSuffixes = {"/x", "/y", "/theta"};
constexpr std::array<std::string_view, 7> kFloatingSuffixes = {
    "/trans_x", "/trans_y", "/trans_z", "/rot_w", "/rot_x", "/rot_y", "/rot_z"};

[[noreturn]] void refuse(const std::string& joint, const std::string& why) {
  throw std::invalid_argument("joint " + detail::in_quotes(joint) + ": " + why);
}

/// The endings of the names of a joint's coordinates; none where the joint has one at most.
std::span<const std::string_view> suffixes_of(JointType type) {
  if (type == JointType::planar) {
    return kPlanarSuffixes;
  }
  return type == JointType::floating ? kFloatingSuffixes : std::span<const std::string_view>();
}

/// The joint and coordinate of a name such as "NAME/theta" or "NAME/rot_w".
std::optional<JointCoordinate> find_by_suffix(const RobotModel& robot, std::string_view name) {
  const std::size_t slash = name.rfind('/');
  const auto joint =
      slash == std::string_view::npos ? std::nullopt : robot.find_joint(name.substr(0, slash));
  if (!joint) {
    return std::nullopt;
  }
  const auto suffixes = suffixes_of(robot.joints()[*joint].type);
  const auto found = std::ranges::find(suffixes, name.substr(slash));
  return found == suffixes.end() ? std::nullopt
                                 : std::optional(JointCoordinate{
                                       *joint, static_cast<std::size_t>(found - suffixes.begin())});
}

[[noreturn]] void refuse_unknown(const RobotModel& robot, std::string_view name) {
  std::vector<std::string> names;
  for (std::size_t joint = 0; joint < robot.joints().size(); ++joint) {
    for (std::size_t k = 0; k < position_count(robot.joints()[joint].type); ++k) {
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
      } else if (what.type == JointType::floating) {
        result.joints.insert({what.name, pose_motion(joint)});
      } else if (what.type == JointType::ball) {
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

  /// The motion of a floating joint through the points, where the trajectory names it.
  [[nodiscard]] Motion pose_motion(std::size_t joint) const {
    const std::string& name = robot_.joints()[joint].name;
    std::array<JointCoordinate, kFloatingSuffixes.size()> all;
    bool moves = false;
    for (std::size_t k = 0; k < all.size(); ++k) {
      all.at(k) = {joint, k};
      moves = moves || columns_.contains(all.at(k));
    }
    if (moves && !trajectory_.points.front().velocities.empty()) {
      refuse(name, "expected positions alone, as it is floating; got velocities");
    }
    std::vector<double> times;
    std::vector<Pose> poses;
    for (std::size_t point = 0; point < (moves ? trajectory_.points.size() : 1); ++point) {
      std::array<double, kFloatingSuffixes.size()> positions{};
      for (std::size_t k = 0; k < all.size(); ++k) {
        positions.at(k) = position(all.at(k), point);
      }
      times.push_back(trajectory_.points[point].time / duration_);
      poses.push_back(pose_of_positions(positions));
    }
    try {
      return poses.size() == 1 ? Motion::fixed(poses.front()) : Motion::waypoints(times, poses);
    } catch (const std::invalid_argument& error) {
      refuse(name, error.what());
    }
  }

  /// [rad or m]  The position of a coordinate at a point, from the trajectory or the given
  /// positions.
  [[nodiscard]] double position(const JointCoordinate& which, std::size_t point) const {
    if (const auto column = columns_.find(which); column != columns_.end()) {
      return trajectory_.points[point].positions[column->second];
    }
    if (const auto held = held_.find(which); held != held_.end()) {
      return held->second;
    }
    const Joint& what = robot_.joints()[which.joint];
    return what.mimic ? mimicked(*what.mimic, point) : default_position(what, which.index);
  }

  [[nodiscard]] double mimicked(const Mimic& mimic, std::size_t point) const {
    return mimic.multiplier * position({*robot_.find_joint(mimic.joint), 0}, point) + mimic.offset;
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
      const double said = position(which, point);
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
  if (const auto found = find_by_suffix(robot, name)) {
    return found;
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
  if (type == JointType::floating) {
    refuse(std::string(name),
           "expected one coordinate of this floating joint: NAME/trans_x, NAME/trans_y, "
           "NAME/trans_z, NAME/rot_w, NAME/rot_x, NAME/rot_y or NAME/rot_z");
  }
  refuse(std::string(name),
         std::string("expected a joint with a coordinate, this one is ") + to_string(type));
}

std::string coordinate_name(const RobotModel& robot, const JointCoordinate& coordinate) {
  return coordinate_name(robot.joints()[coordinate.joint], coordinate.index);
}

std::string coordinate_name(const Joint& joint, std::size_t index) {
  const auto suffixes = suffixes_of(joint.type);
  return suffixes.empty() ? joint.name : joint.name + std::string(suffixes[index]);
}

bool names_fixed_joint(const RobotModel& robot, std::string_view name) {
  const auto joint = robot.find_joint(name);
  return joint && robot.joints()[*joint].type == JointType::fixed;
}

double default_position(const Joint& joint, std::size_t index) {
  if (joint.type == JointType::floating) {
    return index == 3 ? 1.0 : 0.0;
  }
  const double below = std::min(0.0, joint.limits.upper.value_or(0.0));
  return joint.limits.lower ? std::max(below, *joint.limits.lower) : below;
}

std::size_t position_count(JointType type) {
  return type == JointType::floating ? kFloatingSuffixes.size() : coordinate_count(type);
}

std::optional<std::size_t> pose_index(std::string_view ending) {
  const auto found = std::ranges::find_if(
      kFloatingSuffixes, [&](std::string_view suffix) { return suffix.substr(1) == ending; });
  return found == kFloatingSuffixes.end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - kFloatingSuffixes.begin()));
}

Pose pose_of_positions(std::span<const double> positions) {
  return {{positions[0], positions[1], positions[2]},
          Eigen::Quaterniond(positions[3], positions[4], positions[5], positions[6])};
}

std::array<double, 7> positions_of_pose(const Pose& pose) {
  const Eigen::Quaterniond& r = pose.rotation;
  return {pose.position.x(), pose.position.y(), pose.position.z(), r.w(), r.x(), r.y(), r.z()};
}

TrajectoryMotion joint_motions(const RobotModel& robot, const Trajectory& trajectory,
                               const JointPositions& held, double duration) {
  require_counts(trajectory);
  return MotionBuilder(robot, trajectory, held, duration).build();
}

}  // namespace firstcontact
