#include <firstcontact/edges/configuration_space.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include <firstcontact/edges/detail/coordinate_limits.h>
#include <firstcontact/edges/detail/pose_numbers.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

constexpr double kLimitTolerance = 1e-9;  // [rad or m]  Equal to that of limit_report().
constexpr std::array<double, 2> kEdgeTimes = {0.0, 1.0};

[[noreturn]] void refuse_space(const std::string& what) { throw std::invalid_argument(what); }

double way_of(const SpaceCoordinate& coordinate, double from, double to) {
  return coordinate.turns_short ? shortest_way(from, to) : to - from;
}

Turning turning_of(const SpaceCoordinate& coordinate) {
  return coordinate.turns_short ? Turning::shortest : Turning::as_given;
}

/// Gives a coordinate of a robot its path. Other coordinates of its joint keep those of the rest,
/// unless they have paths of their own.
void set_path(const SpaceCoordinate& coordinate, CoordinatePath path, const RobotMotion& rest,
              std::vector<std::pair<std::size_t, JointMotion>>& joints) {
  if (rest.model().joints()[coordinate.joint].type != JointType::planar) {
    joints.emplace_back(coordinate.joint, std::move(path));
    return;
  }
  auto found =
      std::ranges::find(joints, coordinate.joint, &std::pair<std::size_t, JointMotion>::first);
  if (found == joints.end()) {
    found = joints.emplace(joints.end(), coordinate.joint, *rest.given(coordinate.joint));
  }
  std::get<PlanarPath>(found->second)[coordinate.index] = std::move(path);
}

}  // namespace

Configuration configuration_of(const Pose& pose) {
  const Eigen::Quaterniond& r = pose.rotation;
  return {pose.position.x(), pose.position.y(), pose.position.z(), r.w(), r.x(), r.y(), r.z()};
}

ConfigurationSpace::ConfigurationSpace(RobotModel model) {
  const double reach = detail::length_of(model);
  movers_.push_back({std::move(model), reach, {}});
}

ConfigurationSpace ConfigurationSpace::of_joints(RobotModel model,
                                                 std::span<const std::string> names,
                                                 std::map<std::string, JointMotion> held,
                                                 Motion base) {
  ConfigurationSpace space(std::move(model));
  const RobotModel& of = space.model();
  if (names.empty()) {
    refuse_space("expected at least one joint that moves, got none");
  }
  for (const std::string& name : names) {
    const std::optional<std::size_t> joint = of.find_joint(name);
    if (joint && of.joints()[*joint].type == JointType::floating) {
      space.add_pose(*joint);
    } else {
      space.add_coordinate(name);
    }
  }
  space.movers_.front().rest.emplace(of, std::move(held), std::move(base));
  return space;
}

void ConfigurationSpace::add_coordinate(const std::string& name) {
  const RobotModel& of = model();
  const JointCoordinate found = find_coordinate(of, name);
  const Joint& joint = of.joints()[found.joint];
  const std::string quoted = detail::in_quotes(name);
  if (joint.mimic) {
    refuse_space("joint " + quoted + " mimics " + detail::in_quotes(joint.mimic->joint) +
                 ": it follows that one and is not planned by itself");
  }
  if (joint.type == JointType::floating) {
    refuse_space("joint " + quoted + ": a floating joint is planned as a whole, by its name " +
                 detail::in_quotes(joint.name));
  }
  SpaceCoordinate coordinate{.name = coordinate_name(of, found),
                             .turns_short = takes_short_way(of, found),
                             .joint = found.joint,
                             .index = found.index};
  if (std::ranges::any_of(coordinates_, [&](const SpaceCoordinate& other) {
        return other.joint == found.joint && other.index == found.index;
      })) {
    refuse_space("joint " + quoted + " is named twice");
  }
  detail::take_limits(of, coordinate);
  coordinates_.push_back(std::move(coordinate));
}

void ConfigurationSpace::add_pose(std::size_t joint) {
  const std::string& name = model().joints()[joint].name;
  if (std::ranges::any_of(poses_, [&](const SpacePose& pose) { return pose.joint == joint; })) {
    refuse_space("joint " + detail::in_quotes(name) + " is named twice");
  }
  poses_.push_back({.name = name, .joint = joint, .has_limits = {false, false, false}});
}

ConfigurationSpace ConfigurationSpace::of_body(const std::string& name, const Shape& shape,
                                               const Eigen::Vector3d& low,
                                               const Eigen::Vector3d& high, BodyEdges edges) {
  if (!(low.allFinite() && high.allFinite() && (low.array() <= high.array()).all())) {
    refuse_space("body " + detail::in_quotes(name) +
                 ": expected a box of positions with finite corners, the low one first");
  }
  RobotDescription description{.name = name, .links = {{.name = "body"}}, .joints = {}};
  description.links[0].collision.push_back(
      {.name = "", .X_LG = {}, .source = SphereGeometry{}, .shape = shape});
  ConfigurationSpace space{RobotModel(std::move(description))};
  space.edges_ = edges;
  space.poses_.push_back({.name = name, .low = low, .high = high});
  return space;
}

ConfigurationSpace ConfigurationSpace::of_body_in_plane(const std::string& name, const Shape& shape,
                                                        const Eigen::Vector2d& low,
                                                        const Eigen::Vector2d& high, Motion base) {
  RobotDescription description{.name = name,
                               .links = {{.name = "base"}, {.name = "body"}},
                               .joints = {{.name = "plane",
                                           .type = JointType::planar,
                                           .parent = "base",
                                           .child = "body",
                                           .axis = Eigen::Vector3d::UnitZ()}}};
  description.links[1].collision.push_back(
      {.name = "", .X_LG = {}, .source = SphereGeometry{}, .shape = shape});
  const std::array<std::string, 3> names{"plane/x", "plane/y", "plane/theta"};
  const auto at_rest = CoordinatePath::constant(0.0);
  ConfigurationSpace space =
      of_joints(RobotModel(std::move(description)), names,
                {{"plane", PlanarPath{at_rest, at_rest, at_rest}}}, std::move(base));
  space.set_limits(names[0], low.x(), high.x());
  space.set_limits(names[1], low.y(), high.y());
  return space;
}

ConfigurationSpace ConfigurationSpace::joined(std::span<const std::string> names,
                                              std::span<const ConfigurationSpace> spaces) {
  if (names.empty() || names.size() != spaces.size()) {
    refuse_space("expected at least one mover, and a name for each");
  }
  ConfigurationSpace joined;
  for (std::size_t k = 0; k < spaces.size(); ++k) {
    if (spaces[k].mover_count() != 1 || spaces[k].has_screws()) {
      refuse_space(detail::in_quotes(names[k]) +
                   ": expected the joints of one robot, or a body with straight edges");
    }
    joined.movers_.push_back(spaces[k].movers_.front());
    for (SpaceCoordinate coordinate : spaces[k].coordinates_) {
      coordinate.name = names[k] + "/" + coordinate.name;
      coordinate.mover = k;
      joined.coordinates_.push_back(std::move(coordinate));
    }
    for (SpacePose pose : spaces[k].poses_) {
      pose.name = pose.joint ? names[k] + "/" + pose.name : names[k];
      pose.mover = k;
      joined.poses_.push_back(std::move(pose));
    }
  }
  return joined;
}

std::string ConfigurationSpace::number_name(std::size_t number) const {
  if (number < coordinates_.size()) {
    return coordinates_[number].name;
  }
  const std::size_t behind = number - coordinates_.size();
  const SpacePose& pose = poses_[behind / detail::kPoseNumbers];
  const Joint floating{.name = pose.name, .type = JointType::floating};
  return coordinate_name(floating, behind % detail::kPoseNumbers);
}

std::optional<std::string> ConfigurationSpace::defect(const Configuration& q) const {
  if (q.size() != size()) {
    return "expected " + std::to_string(size()) + " numbers, got " + std::to_string(q.size());
  }
  for (std::size_t k = 0; k < q.size(); ++k) {
    if (!(std::abs(q[k]) <= 1e8)) {
      const std::string what =
          is_body() ? "its pose" : "joint " + detail::in_quotes(number_name(k));
      return what + ": expected a finite number of at most 1e8";
    }
  }
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (const auto defect = detail::defect_of_pose(q, begin_of_pose(k))) {
      return is_body() ? *defect : detail::in_quotes(poses_[k].name) + ": " + *defect;
    }
  }
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    const SpaceCoordinate& coordinate = coordinates_[k];
    if (coordinate.has_limits && !(q[k] >= coordinate.lower - kLimitTolerance &&
                                   q[k] <= coordinate.upper + kLimitTolerance)) {
      return "joint " + detail::in_quotes(coordinate.name) + " is at " + detail::write_json(q[k]) +
             ", outside of its limits " + detail::write_json(coordinate.lower) + " to " +
             detail::write_json(coordinate.upper);
    }
  }
  return std::nullopt;
}

bool ConfigurationSpace::is_in_box(const Configuration& q) const {
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (!detail::is_in_box(poses_[k], q, begin_of_pose(k))) {
      return false;
    }
  }
  return true;
}

bool ConfigurationSpace::holds(const Configuration& q) const {
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    if (coordinates_[k].has_limits &&
        !(q[k] >= coordinates_[k].lower && q[k] <= coordinates_[k].upper)) {
      return false;
    }
  }
  return is_in_box(q);
}

double ConfigurationSpace::pose_distance(std::size_t pose, const Configuration& from,
                                         const Configuration& to) const {
  const Pose a = detail::pose_at(from, begin_of_pose(pose));
  const Pose b = detail::pose_at(to, begin_of_pose(pose));
  return poses_[pose].joint ? std::hypot((b.position - a.position).norm(),
                                         detail::angle_between(a.rotation, b.rotation))
                            : detail::body_distance(a, b, movers_[poses_[pose].mover].reach);
}

double ConfigurationSpace::distance(const Configuration& from, const Configuration& to) const {
  if (is_body()) {
    return pose_distance(0, from, to);
  }
  double square = 0.0;
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    const double way = way_of(coordinates_[k], from[k], to[k]);
    square += way * way;
  }
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const double way = pose_distance(k, from, to);
    square += way * way;
  }
  return std::sqrt(square);
}

Motion ConfigurationSpace::pose_motion(std::size_t pose, const Configuration& from,
                                       const Configuration& to) const {
  const Pose a = detail::pose_at(from, begin_of_pose(pose));
  const Pose b = detail::pose_at(to, begin_of_pose(pose));
  return has_screws() ? Motion::screw(a, b) : Motion::constant_velocity(a, b);
}

Motion ConfigurationSpace::pose_motion(std::size_t pose, std::span<const Configuration> places,
                                       std::span<const double> times) const {
  std::vector<Pose> poses;
  for (const Configuration& place : places) {
    poses.push_back(detail::pose_at(place, begin_of_pose(pose)));
  }
  return Motion::waypoints(times, poses,
                           has_screws() ? Between::screw : Between::constant_velocity);
}

Configuration ConfigurationSpace::interpolate(const Configuration& from, const Configuration& to,
                                              double share) const {
  if (share <= 0.0) {
    return from;
  }
  if (share >= 1.0) {
    return to;
  }
  Configuration q = from;
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const std::size_t first = begin_of_pose(k);
    if (is_body() || !detail::is_same_pose(from, to, first)) {
      detail::set_pose(pose_motion(k, from, to).pose(share), first, q);
    }
  }
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    q[k] = from[k] + share * way_of(coordinates_[k], from[k], to[k]);
    if (!coordinates_[k].turns_short) {
      const auto [low, high] = std::minmax(from[k], to[k]);
      q[k] = std::clamp(q[k], low, high);  // Rounding must not leave a limit.
    }
  }
  return q;
}

std::size_t ConfigurationSpace::pose_of_mover(std::size_t mover) const {
  const auto found = std::ranges::find(poses_, mover, &SpacePose::mover);
  return static_cast<std::size_t>(found - poses_.begin());
}

RobotMotion ConfigurationSpace::motion(const Configuration& from, const Configuration& to,
                                       std::size_t mover) const {
  if (is_body(mover)) {
    return {model(mover), {}, pose_motion(pose_of_mover(mover), from, to)};
  }
  const std::array<Configuration, 2> ends = {from, to};
  return motion(ends, kEdgeTimes, mover);
}

RobotMotion ConfigurationSpace::motion(std::span<const Configuration> places,
                                       std::span<const double> times, std::size_t mover) const {
  if (is_body(mover)) {
    return {model(mover), {}, pose_motion(pose_of_mover(mover), places, times)};
  }
  const RobotMotion& rest = *movers_[mover].rest;
  std::vector<std::pair<std::size_t, JointMotion>> joints;
  joints.reserve(coordinates_.size() + poses_.size());
  std::vector<double> positions(places.size());
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    const SpaceCoordinate& coordinate = coordinates_[k];
    if (coordinate.mover == mover) {
      for (std::size_t i = 0; i < places.size(); ++i) {
        positions[i] = places[i][k];
      }
      set_path(coordinate, CoordinatePath::linear(times, positions, turning_of(coordinate)), rest,
               joints);
    }
  }
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (poses_[k].mover == mover) {
      joints.emplace_back(*poses_[k].joint, pose_motion(k, places, times));
    }
  }
  return rest.with(std::move(joints));
}

double ConfigurationSpace::travel_time(const Configuration& from, const Configuration& to,
                                       std::span<const double> speeds) const {
  double time = 0.0;
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    time = std::max(time, std::abs(way_of(coordinates_[k], from[k], to[k])) / speeds[k]);
  }
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const Pose a = detail::pose_at(from, begin_of_pose(k));
    const Pose b = detail::pose_at(to, begin_of_pose(k));
    const double* of_pose = &speeds[coordinates_.size() + 2 * k];
    time = std::max({time, (b.position - a.position).norm() / of_pose[0],
                     detail::angle_between(a.rotation, b.rotation) / of_pose[1]});
  }
  return time;
}

Configuration ConfigurationSpace::sample(RandomNumbers& random) const {
  Configuration q;
  q.reserve(size());
  for (const SpaceCoordinate& coordinate : coordinates_) {
    q.push_back(random.uniform(coordinate.lower, coordinate.upper));
  }
  for (const SpacePose& pose : poses_) {
    const Configuration numbers = configuration_of(detail::sample_pose(pose, random));
    q.insert(q.end(), numbers.begin(), numbers.end());
  }
  return q;
}

void ConfigurationSpace::include(const Configuration& q) {
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    SpaceCoordinate& coordinate = coordinates_[k];
    if (!coordinate.has_limits && !coordinate.turns_short) {
      coordinate.lower = std::min(coordinate.lower, q[k]);
      coordinate.upper = std::max(coordinate.upper, q[k]);
    }
  }
}

/// Sets the box of a floating joint along one axis; returns whether the name is of one.
bool ConfigurationSpace::set_box(const std::string& name, double lower, double upper) {
  for (std::size_t k = 0; k < detail::kPoseNumbers * poses_.size(); ++k) {
    SpacePose& pose = poses_[k / detail::kPoseNumbers];
    const std::size_t index = k % detail::kPoseNumbers;
    if (!pose.joint || number_name(coordinates_.size() + k) != name) {
      continue;
    }
    if (index >= pose.has_limits.size()) {
      refuse_space("limits of " + detail::in_quotes(name) + ": a quaternion has none");
    }
    pose.low[static_cast<Eigen::Index>(index)] = lower;
    pose.high[static_cast<Eigen::Index>(index)] = upper;
    pose.has_limits.at(index) = true;
    return true;
  }
  return false;
}

void ConfigurationSpace::set_limits(const std::string& name, double lower, double upper) {
  const auto found = std::find_if(coordinates_.begin(), coordinates_.end(),
                                  [&](const SpaceCoordinate& c) { return c.name == name; });
  if (!(lower <= upper && std::isfinite(lower) && std::isfinite(upper))) {
    refuse_space("limits of joint " + detail::in_quotes(name) +
                 ": expected two finite numbers, the lower one first");
  }
  if (found == coordinates_.end()) {
    if (set_box(name, lower, upper)) {
      return;
    }
    refuse_space("limits of joint " + detail::in_quotes(name) +
                 ", which is not planned; plan it too, or leave its bounds out");
  }
  if (found->has_limits && (lower > found->upper || upper < found->lower)) {
    refuse_space("limits of joint " + detail::in_quotes(name) +
                 ": expected some that overlap with its own, " + detail::write_json(found->lower) +
                 " to " + detail::write_json(found->upper));
  }
  found->lower = found->has_limits ? std::max(found->lower, lower) : lower;
  found->upper = found->has_limits ? std::min(found->upper, upper) : upper;
  found->has_limits = true;
  found->turns_short = false;  // The short way might pass the limits.
}

std::optional<std::string> ConfigurationSpace::unbounded() const {
  for (const SpaceCoordinate& coordinate : coordinates_) {
    if (coordinate.slides && !coordinate.has_limits) {
      return coordinate.name;
    }
  }
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const auto open = std::ranges::find(poses_[k].has_limits, false);
    if (open != poses_[k].has_limits.end()) {
      return number_name(begin_of_pose(k) +
                         static_cast<std::size_t>(open - poses_[k].has_limits.begin()));
    }
  }
  return std::nullopt;
}

}  // namespace firstcontact
