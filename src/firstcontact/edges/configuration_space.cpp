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

#include <firstcontact/edges/detail/robot_sizes.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

constexpr double kLimitTolerance = 1e-9;  // [rad or m]  Equal to that of limit_report().
constexpr std::array<double, 2> kEdgeTimes = {0.0, 1.0};

[[noreturn]] void refuse_space(const std::string& what) { throw std::invalid_argument(what); }

Pose pose_of(const Configuration& q) {
  return {{q[0], q[1], q[2]}, Eigen::Quaterniond(q[3], q[4], q[5], q[6])};
}

/// [rad]  The angle of the shortest rotation between two quaternions of any length.
double angle_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::Quaterniond way = from.conjugate() * to;
  return 2.0 * std::atan2(way.vec().norm(), std::abs(way.w()));
}

double way_of(const SpaceCoordinate& coordinate, double from, double to) {
  return coordinate.turns_short ? shortest_way(from, to) : to - from;
}

Turning turning_of(const SpaceCoordinate& coordinate) {
  return coordinate.turns_short ? Turning::shortest : Turning::as_given;
}

/// Takes the limits of a coordinate, or its sampled range where it has none.
void take_limits(const Joint& joint, SpaceCoordinate& coordinate) {
  coordinate.slides = detail::is_slide(joint.type, coordinate.index);
  const bool has_own = joint.type == JointType::revolute || joint.type == JointType::prismatic ||
                       joint.type == JointType::screw;
  if (has_own && joint.limits.lower && joint.limits.upper) {
    coordinate.lower = *joint.limits.lower;
    coordinate.upper = *joint.limits.upper;
    return;
  }
  coordinate.has_limits = false;
  if (!coordinate.slides) {
    coordinate.lower = -std::numbers::pi;
    coordinate.upper = std::numbers::pi;
  }
}

/// Narrows the limits of a coordinate to those that the joints which mimic it have.
///
/// @param multiplier, offset  a joint that follows the coordinate is at multiplier q + offset
void narrow_by_mimics(const RobotModel& model, std::size_t joint, double multiplier, double offset,
                      SpaceCoordinate& coordinate) {
  for (std::size_t other = 0; other < model.joints().size(); ++other) {
    const Joint& follower = model.joints()[other];
    if (!follower.mimic || follower.mimic->joint != model.joints()[joint].name) {
      continue;
    }
    const double factor = follower.mimic->multiplier * multiplier;
    const double shift = follower.mimic->multiplier * offset + follower.mimic->offset;
    SpaceCoordinate own;
    take_limits(follower, own);
    if (own.has_limits && factor != 0.0) {
      const auto [low, high] =
          std::minmax({(own.lower - shift) / factor, (own.upper - shift) / factor});
      coordinate.lower = coordinate.has_limits ? std::max(coordinate.lower, low) : low;
      coordinate.upper = coordinate.has_limits ? std::min(coordinate.upper, high) : high;
      coordinate.has_limits = true;
      coordinate.turns_short = false;
    }
    narrow_by_mimics(model, other, factor, shift, coordinate);
  }
}

/// [m]  Bounds the distance of any point of the robot from the root, without the displacements of
/// sliding joints.
double length_of(const RobotModel& model) {
  double length = 0.0;
  for (const Joint& joint : model.joints()) {
    length += joint.X_PJ.position.norm();
  }
  double part = 0.0;
  for (const Link& link : model.links()) {
    for (const LinkGeometry& geometry : link.collision) {
      if (geometry.shape) {
        const Hierarchy& hierarchy = geometry.shape->hierarchy();
        part = std::max(part, geometry.X_LG.position.norm() + hierarchy.centre.norm() +
                                  hierarchy.radius + geometry.shape->radius());
      }
    }
  }
  return length + part;
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
  const double reach = length_of(model);
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
    const JointCoordinate found = find_coordinate(of, name);
    const Joint& joint = of.joints()[found.joint];
    const std::string quoted = detail::in_quotes(name);
    if (joint.mimic) {
      refuse_space("joint " + quoted + " mimics " + detail::in_quotes(joint.mimic->joint) +
                   ": it follows that one and is not planned by itself");
    }
    SpaceCoordinate coordinate{.name = coordinate_name(of, found),
                               .turns_short = takes_short_way(of, found),
                               .joint = found.joint,
                               .index = found.index};
    const auto is_same = [&](const SpaceCoordinate& other) {
      return other.joint == found.joint && other.index == found.index;
    };
    if (std::any_of(space.coordinates_.begin(), space.coordinates_.end(), is_same)) {
      refuse_space("joint " + quoted + " is named twice");
    }
    take_limits(joint, coordinate);
    narrow_by_mimics(of, found.joint, 1.0, 0.0, coordinate);
    space.coordinates_.push_back(std::move(coordinate));
  }
  space.movers_.front().rest.emplace(of, std::move(held), std::move(base));
  return space;
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
  space.is_body_ = true;
  space.edges_ = edges;
  space.low_ = low;
  space.high_ = high;
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
    refuse_space("expected at least one robot that moves, and a name for each");
  }
  ConfigurationSpace joined;
  for (std::size_t k = 0; k < spaces.size(); ++k) {
    if (spaces[k].is_body() || spaces[k].mover_count() != 1) {
      refuse_space(detail::in_quotes(names[k]) + ": expected the joints of one robot");
    }
    joined.movers_.push_back(spaces[k].movers_.front());
    for (SpaceCoordinate coordinate : spaces[k].coordinates_) {
      coordinate.name = names[k] + "/" + coordinate.name;
      coordinate.mover = k;
      joined.coordinates_.push_back(std::move(coordinate));
    }
  }
  return joined;
}

std::optional<std::string> ConfigurationSpace::defect_of_body(const Configuration& q) const {
  const double size = Eigen::Vector4d(q[3], q[4], q[5], q[6]).norm();
  if (!(std::abs(size - 1.0) <= 1e-6)) {
    return "expected a quaternion of length 1, got one of length " + detail::write_json(size);
  }
  return std::nullopt;
}

std::optional<std::string> ConfigurationSpace::defect(const Configuration& q) const {
  if (q.size() != size()) {
    return "expected " + std::to_string(size()) + " numbers, got " + std::to_string(q.size());
  }
  for (std::size_t k = 0; k < q.size(); ++k) {
    if (!(std::abs(q[k]) <= 1e8)) {
      const std::string what =
          is_body_ ? "its pose" : "joint " + detail::in_quotes(coordinates_[k].name);
      return what + ": expected a finite number of at most 1e8";
    }
  }
  if (is_body_) {
    return defect_of_body(q);
  }
  for (std::size_t k = 0; k < q.size(); ++k) {
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

bool ConfigurationSpace::is_in_box(const Configuration& q) const { return !is_body_ || holds(q); }

bool ConfigurationSpace::holds(const Configuration& q) const {
  if (is_body_) {
    const Eigen::Vector3d place(q[0], q[1], q[2]);
    return (place.array() >= low_.array()).all() && (place.array() <= high_.array()).all();
  }
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    if (coordinates_[k].has_limits &&
        !(q[k] >= coordinates_[k].lower && q[k] <= coordinates_[k].upper)) {
      return false;
    }
  }
  return true;
}

double ConfigurationSpace::distance(const Configuration& from, const Configuration& to) const {
  if (is_body_) {
    const Pose a = pose_of(from);
    const Pose b = pose_of(to);
    return (b.position - a.position).norm() +
           movers_.front().reach * angle_between(a.rotation, b.rotation);
  }
  double square = 0.0;
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    const double way = way_of(coordinates_[k], from[k], to[k]);
    square += way * way;
  }
  return std::sqrt(square);
}

Motion ConfigurationSpace::body_motion(const Configuration& from, const Configuration& to) const {
  return has_screws() ? Motion::screw(pose_of(from), pose_of(to))
                      : Motion::constant_velocity(pose_of(from), pose_of(to));
}

Configuration ConfigurationSpace::interpolate(const Configuration& from, const Configuration& to,
                                              double share) const {
  if (share <= 0.0) {
    return from;
  }
  if (share >= 1.0) {
    return to;
  }
  if (is_body_) {
    return configuration_of(body_motion(from, to).pose(share));
  }
  Configuration q(from.size());
  for (std::size_t k = 0; k < q.size(); ++k) {
    q[k] = from[k] + share * way_of(coordinates_[k], from[k], to[k]);
    if (!coordinates_[k].turns_short) {
      const auto [low, high] = std::minmax(from[k], to[k]);
      q[k] = std::clamp(q[k], low, high);  // Rounding must not leave a limit.
    }
  }
  return q;
}

double ConfigurationSpace::rounding_bound(const Configuration& from, const Configuration& to,
                                          double carried) const {
  if (has_screws()) {
    return std::numeric_limits<double>::infinity();
  }
  constexpr double kUlps = 0x1p-48;  // More than the rounding errors of a place and of its edge.
  std::vector<double> sizes(from.size());
  for (std::size_t k = 0; k < from.size(); ++k) {
    sizes[k] = std::abs(from[k]) + std::abs(to[k]);
  }
  if (is_body_) {
    constexpr double kNearHalfTurn = 1e-9;  // [rad]  A rounded place may be beyond it.
    if (angle_between(pose_of(from).rotation, pose_of(to).rotation) >
        std::numbers::pi - kNearHalfTurn) {
      return std::numeric_limits<double>::infinity();
    }
    // A body turns about its own origin. Rounded quaternions move a point by at most its reach
    // times their error, wherever the body is. Rounded positions move all points alike.
    const double places = sizes[0] + sizes[1] + sizes[2];
    const double turns = sizes[3] + sizes[4] + sizes[5] + sizes[6];
    return kUlps * (places + turns * movers_.front().reach);
  }
  double bound = 0.0;
  for (std::size_t k = 0; k < movers_.size(); ++k) {
    const Mover& mover = movers_[k];
    const detail::RobotSizes robot = detail::robot_sizes(*mover.rest, k, coordinates_, sizes);
    // A radian moves a point by at most the length of its robot, with sliding joints drawn out. A
    // slide moves all points alike.
    const double lever = mover.reach + carried + robot.slides;
    bound += robot.planned_slides + robot.planned_turns * lever;  // Two movers may be a pair.
  }
  return kUlps * bound;
}

RobotMotion ConfigurationSpace::motion(const Configuration& from, const Configuration& to,
                                       std::size_t mover) const {
  if (is_body_) {
    return {model(), {}, body_motion(from, to)};
  }
  const std::array<Configuration, 2> ends = {from, to};
  return motion(ends, kEdgeTimes, mover);
}

RobotMotion ConfigurationSpace::motion(std::span<const Configuration> places,
                                       std::span<const double> times, std::size_t mover) const {
  if (is_body_) {
    std::vector<Pose> poses;
    for (const Configuration& place : places) {
      poses.push_back(pose_of(place));
    }
    return {model(),
            {},
            Motion::waypoints(times, poses,
                              has_screws() ? Between::screw : Between::constant_velocity)};
  }
  const RobotMotion& rest = *movers_[mover].rest;
  std::vector<std::pair<std::size_t, JointMotion>> joints;
  joints.reserve(coordinates_.size());
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
  return rest.with(std::move(joints));
}

double ConfigurationSpace::travel_time(const Configuration& from, const Configuration& to,
                                       std::span<const double> speeds) const {
  if (is_body_) {
    const Pose a = pose_of(from);
    const Pose b = pose_of(to);
    return std::max((b.position - a.position).norm() / speeds[0],
                    angle_between(a.rotation, b.rotation) / speeds[1]);
  }
  double time = 0.0;
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    time = std::max(time, std::abs(way_of(coordinates_[k], from[k], to[k])) / speeds[k]);
  }
  return time;
}

Configuration ConfigurationSpace::sample(RandomNumbers& random) const {
  if (!is_body_) {
    Configuration q;
    q.reserve(coordinates_.size());
    for (const SpaceCoordinate& coordinate : coordinates_) {
      q.push_back(random.uniform(coordinate.lower, coordinate.upper));
    }
    return q;
  }
  Pose pose;
  for (Eigen::Index k = 0; k < 3; ++k) {
    pose.position[k] = random.uniform(low_[k], high_[k]);
  }
  // K. Shoemake, "Uniform random rotations", Graphics Gems III (1992).
  const double u = random.uniform();
  const double a = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double b = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double r = std::sqrt(1.0 - u);
  const double s = std::sqrt(u);
  pose.rotation =
      Eigen::Quaterniond(s * std::cos(b), r * std::sin(a), r * std::cos(a), s * std::sin(b))
          .normalized();
  return configuration_of(pose);
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

void ConfigurationSpace::set_limits(const std::string& name, double lower, double upper) {
  const auto found = std::find_if(coordinates_.begin(), coordinates_.end(),
                                  [&](const SpaceCoordinate& c) { return c.name == name; });
  if (found == coordinates_.end()) {
    refuse_space("limits of joint " + detail::in_quotes(name) + ", which is not planned");
  }
  if (!(lower <= upper && std::isfinite(lower) && std::isfinite(upper))) {
    refuse_space("limits of joint " + detail::in_quotes(name) +
                 ": expected two finite numbers, the lower one first");
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
  return std::nullopt;
}

}  // namespace firstcontact
