#include <firstcontact/verification/detail/robot_course.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/scene/trajectory.h>

namespace firstcontact::detail {
namespace {

/// Makes the courses of a robot's coordinates from its scene.
class Coordinates {
 public:
  Coordinates(const SceneRobot& robot, double duration, const Turnings& turnings)
      : robot_(robot), duration_(duration), turnings_(turnings) {}

  [[nodiscard]] CoordinateCourse course(const JointCoordinate& which) const {
    const Joint& joint = robot_.model.joints()[which.joint];
    if (joint.mimic) {
      const auto source = robot_.model.find_joint(joint.mimic->joint);
      return course({source.value(), 0}).scaled(joint.mimic->multiplier, joint.mimic->offset);
    }
    const std::string name = coordinate_name(robot_.model, which);
    const Trajectory& trajectory = robot_.trajectory;
    const auto& names = trajectory.joint_names;
    const auto column = std::find(names.begin(), names.end(), name);
    if (column != names.end()) {
      return along(trajectory, static_cast<std::size_t>(column - names.begin()),
                   turning(which, name));
    }
    const auto held = robot_.state.find(name);
    return CoordinateCourse(held != robot_.state.end() ? held->second : default_position(joint));
  }

 private:
  [[nodiscard]] Turning turning(const JointCoordinate& which, const std::string& name) const {
    const auto own = turnings_.find(name);
    if (own != turnings_.end()) {
      return own->second;
    }
    return takes_short_way(robot_.model, which) ? robot_.trajectory.turning : Turning::as_given;
  }

  // Quotients of times, and rates per unit of time, are rounded, and define the motion as they are.
  [[nodiscard]] CoordinateCourse along(const Trajectory& trajectory, std::size_t column,
                                       Turning turning) const {
    std::vector<double> times;
    std::vector<double> positions;
    std::vector<double> velocities;
    std::vector<double> accelerations;
    for (const TrajectoryPoint& point : trajectory.points) {
      times.push_back(point.time / duration_);
      positions.push_back(point.positions.at(column));
      if (!point.velocities.empty()) {
        velocities.push_back(point.velocities.at(column) * duration_);
      }
      if (!point.accelerations.empty()) {
        accelerations.push_back(point.accelerations.at(column) * (duration_ * duration_));
      }
    }
    const auto is_whole = [&](const std::vector<double>& rates) {
      return rates.empty() || rates.size() == times.size();
    };
    if (times.empty() || !is_whole(velocities) || !is_whole(accelerations)) {
      throw std::invalid_argument("expected as many rates as positions in each point");
    }
    return {times, positions, velocities, accelerations, turning};
  }

  const SceneRobot& robot_;
  double duration_;
  const Turnings& turnings_;
};

/// The directions x and y, turned by the shortest rotation that takes z to n; x and -y where n is
/// -z.
std::array<IntervalVector3, 2> across_directions(const IntervalVector3& n) {
  const Interval one(1.0);
  const IntervalVector3 x{{one, Interval(0.0), Interval(0.0)}};
  const IntervalVector3 y{{Interval(0.0), one, Interval(0.0)}};
  const Interval across = sqr(n.c[0]) + sqr(n.c[1]);
  const bool is_up = n.c[2].lower() > 0.0;
  if (across == Interval(0.0)) {
    return {x, is_up ? y : Interval(-1.0) * y};
  }
  // Where 1 + n_z would cancel, it is across / (1 - n_z).
  const Interval sum = is_up ? one + n.c[2] : across / (one - n.c[2]);
  const IntervalVector3 halfway{{n.c[0], n.c[1], sum}};
  return {x - (n.c[0] / sum) * halfway, y - (n.c[1] / sum) * halfway};
}

bool turns(JointType type) {
  return type == JointType::revolute || type == JointType::continuous || type == JointType::screw ||
         type == JointType::planar;
}

}  // namespace

RobotCourse::RobotCourse(const SceneRobot& robot, double duration, const Turnings& turnings)
    : model_(robot.model) {
  breaks_ = {0.0, 1.0};
  for (const RigidMotion& piece : rigid_motions(robot.base, duration, Eigen::Vector3d::Zero())) {
    breaks_.push_back(piece.to());
    base_.push_back(std::make_shared<const RigidMotion>(piece));
  }
  for (std::size_t joint = 0; joint < model_.joints().size(); ++joint) {
    add_joint(robot, joint, duration, turnings);
  }
  std::sort(breaks_.begin(), breaks_.end());
  breaks_.erase(std::unique(breaks_.begin(), breaks_.end()), breaks_.end());
}

void RobotCourse::add_joint(const SceneRobot& robot, std::size_t index, double duration,
                            const Turnings& turnings) {
  const Joint& joint = model_.joints()[index];
  const Coordinates coordinates(robot, duration, turnings);
  JointCourse course{.X_PJ = exact_transform(joint.X_PJ), .axis = {}};
  if (turns(joint.type) || joint.type == JointType::prismatic) {
    course.axis = exact_direction(joint.axis);
  }
  if (joint.type == JointType::planar) {
    const auto directions = across_directions(course.axis);
    course.directions.assign(directions.begin(), directions.end());
    course.slides = {coordinates.course({index, 0}), coordinates.course({index, 1})};
    course.angle = coordinates.course({index, 2});
  } else if (turns(joint.type)) {
    course.angle = coordinates.course({index, 0});
    if (joint.type == JointType::screw) {
      course.directions = {course.axis};
      course.slides = {course.angle->scaled(joint.pitch, 0.0)};
    }
  } else if (joint.type == JointType::prismatic) {
    course.directions = {course.axis};
    course.slides = {coordinates.course({index, 0})};
  }
  if (joint.type == JointType::floating) {
    float_freely(robot, index, duration, course);
  }
  course.error = error_of(robot, index);
  has_tracking_errors_ =
      has_tracking_errors_ || course.error.angle > 0.0 || course.error.distance > 0.0;
  const auto add_breaks = [&](const CoordinateCourse& of) {
    for (const CoordinatePolynomial& piece : of.pieces()) {
      breaks_.push_back(piece.to);
    }
  };
  if (course.angle) {
    add_breaks(*course.angle);
  }
  std::for_each(course.slides.begin(), course.slides.end(), add_breaks);
  for (const auto& piece : course.free) {
    breaks_.push_back(piece->to());
  }
  joints_.push_back(std::move(course));
}

/// Takes the pose of a floating joint at rest, or its motion through the points that name it.
void RobotCourse::float_freely(const SceneRobot& robot, std::size_t joint, double duration,
                               JointCourse& course) {
  const Trajectory& trajectory = robot.trajectory;
  const auto& names = trajectory.joint_names;
  std::array<std::size_t, 7> columns{};
  std::array<double, 7> held{};
  bool moves = false;
  for (std::size_t index = 0; index < columns.size(); ++index) {
    const std::string name = coordinate_name(robot.model, {joint, index});
    const auto column = std::find(names.begin(), names.end(), name);
    columns.at(index) = static_cast<std::size_t>(column - names.begin());
    moves = moves || column != names.end();
    const auto found = robot.state.find(name);
    held.at(index) = found != robot.state.end()
                         ? found->second
                         : default_position(robot.model.joints()[joint], index);
  }
  if (!moves) {
    course.X_PJ = course.X_PJ * exact_transform(pose_of_positions(held));
    return;
  }
  WaypointMotion motion;
  for (const TrajectoryPoint& point : trajectory.points) {
    std::array<double, 7> positions = held;
    for (std::size_t index = 0; index < columns.size(); ++index) {
      if (columns.at(index) < names.size()) {
        positions.at(index) = point.positions.at(columns.at(index));
      }
    }
    motion.times.push_back(point.time);
    motion.poses.push_back(pose_of_positions(positions));
  }
  if (!trajectory.points.front().velocities.empty()) {
    throw std::invalid_argument("expected no velocities beside a floating joint");
  }
  for (const RigidMotion& piece : rigid_motions(motion, duration, Eigen::Vector3d::Zero())) {
    course.free.push_back(std::make_shared<const RigidMotion>(piece));
  }
}

/// The tracking error of a joint. A mimic joint errs by that of its leader times its multiplier; a
/// screw slides, too.
TrackingError RobotCourse::error_of(const SceneRobot& robot, std::size_t index) const {
  constexpr double kUpwards = 1.0 + 0x1p-48;
  double multiplier = 1.0;
  std::size_t source = index;
  while (model_.joints()[source].mimic) {
    multiplier *= kUpwards * std::abs(model_.joints()[source].mimic->multiplier);
    source = model_.find_joint(model_.joints()[source].mimic->joint).value();
  }
  const auto found = robot.tracking_error.find(source);
  if (found == robot.tracking_error.end()) {
    return {};
  }
  TrackingError error = found->second;
  const Joint& joint = model_.joints()[index];
  if (source != index) {
    const double coordinate = kUpwards * multiplier * (error.angle + error.distance);
    error = turns(joint.type) ? TrackingError{.angle = coordinate}
                              : TrackingError{.distance = coordinate};
  }
  if (joint.type == JointType::screw) {
    error.distance = kUpwards * std::abs(joint.pitch) * error.angle;
  }
  return error;
}

std::size_t RobotCourse::common_ancestor(std::size_t link, std::size_t other) const {
  const auto ancestors = [&](std::size_t of) {
    std::vector<std::size_t> links{of};
    while (const auto joint = model_.parent_joint(links.back())) {
      links.push_back(model_.parent_link(*joint));
    }
    return links;
  };
  const std::vector<std::size_t> of_other = ancestors(other);
  for (const std::size_t candidate : ancestors(link)) {
    if (std::find(of_other.begin(), of_other.end(), candidate) != of_other.end()) {
      return candidate;
    }
  }
  return model_.root();
}

std::vector<std::size_t> RobotCourse::joints_between(std::optional<std::size_t> frame,
                                                     std::size_t link) const {
  std::vector<std::size_t> joints;
  for (std::size_t at = link; at != frame;) {
    const auto joint = model_.parent_joint(at);
    if (!joint) {
      break;
    }
    joints.push_back(*joint);
    at = model_.parent_link(*joint);
  }
  std::reverse(joints.begin(), joints.end());
  return joints;
}

CoveredMotions RobotCourse::motions(std::optional<std::size_t> frame, std::size_t link,
                                    const IntervalTransform& X_LP, double from, double to) const {
  const std::vector<std::size_t> between = joints_between(frame, link);
  CoveredMotions motions;
  for (std::size_t k = 0; k + 1 < breaks_.size(); ++k) {
    const bool is_inside = breaks_[k] <= to && from <= breaks_[k + 1];
    if (!is_inside) {
      continue;
    }
    const double middle = 0.5 * (breaks_[k] + breaks_[k + 1]);
    std::vector<ChainJoint> chain;
    std::optional<IntervalTransform> fixed;  // Only for joints that do not move.
    const auto after_fixed = [&](const IntervalTransform& X) { return fixed ? *fixed * X : X; };
    for (const std::size_t index : between) {
      const JointCourse& joint = joints_[index];
      const bool errs = joint.error.angle > 0.0 || joint.error.distance > 0.0;
      if (!joint.angle && joint.slides.empty() && joint.free.empty() && !errs) {
        fixed = after_fixed(joint.X_PJ);
        continue;
      }
      ChainJoint link_joint{.before = after_fixed(joint.X_PJ), .axis = joint.axis};
      fixed.reset();
      link_joint.error = joint.error;
      link_joint.angle = joint.angle ? &joint.angle->at(middle) : nullptr;
      for (std::size_t s = 0; s < joint.slides.size(); ++s) {
        link_joint.slides.push_back({joint.directions[s], &joint.slides[s].at(middle)});
      }
      const auto free = std::ranges::find_if(
          joint.free, [&](const auto& piece) { return middle <= piece->to(); });
      link_joint.free = free == joint.free.end() ? nullptr : free->get();
      chain.push_back(std::move(link_joint));
    }
    std::shared_ptr<const RigidMotion> base;
    for (std::size_t b = 0; !frame && b < base_.size() && !base; ++b) {
      if (middle <= base_[b]->to()) {
        base = base_[b];
      }
    }
    motions.push_back(std::make_shared<const ChainMotion>(
        breaks_[k], breaks_[k + 1], std::move(base), std::move(chain), after_fixed(X_LP)));
  }
  return motions;
}

}  // namespace firstcontact::detail
