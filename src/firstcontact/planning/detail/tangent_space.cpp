#include <firstcontact/planning/detail/tangent_space.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/edges/detail/robot_sizes.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/rotation_forms.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::detail {
namespace {

constexpr double kNearScrew = 0.05;  // [-]  Most by which a motion may depart from a screw about an
                                     // axis.
constexpr double kLeastReach = 1e-3;  // [-]  Part of a length of the scene.

Eigen::Vector3d place_of(const Configuration& q, std::size_t first = 0) {
  return {q[first], q[first + 1], q[first + 2]};
}

Eigen::Quaterniond turn_of(const Configuration& q, std::size_t first = 0) {
  return Eigen::Quaterniond(q[first + 3], q[first + 4], q[first + 5], q[first + 6]).normalized();
}

Eigen::Vector3d rotation_vector_of(const Eigen::Quaterniond& rotation) {
  const double sine = rotation.vec().norm();
  const double angle = 2.0 * std::atan2(sine, std::abs(rotation.w()));
  const double factor = sine > 0.0 ? angle / sine : 2.0;
  return (rotation.w() < 0.0 ? -factor : factor) * rotation.vec();
}

/// [m]  The radius of a geometry about the middle of its core, with its thickness.
double radius_of(const Shape& shape) { return shape.hierarchy().radius + shape.radius(); }

/// [m]  The distance of a geometry's farthest point from the origin of the member's frame.
double reach_of(const MemberGeometry& geometry) {
  return geometry.X_MG.position.norm() + geometry.shape.hierarchy().centre.norm() +
         radius_of(geometry.shape);
}

/// [m]  The radius of a mover that is a body.
double radius_of_body(const PlanScene& scene, std::size_t mover) {
  return radius_of(scene.scene.geometries(scene.scene.first_member(scene.robots[mover]))[0].shape);
}

/// The joint whose coordinates a joint has: itself, or the one that it mimics.
std::size_t leading_joint(const RobotModel& model, std::size_t joint) {
  while (const std::optional<Mimic>& mimic = model.joints()[joint].mimic) {
    joint = model.find_joint(mimic->joint).value();
  }
  return joint;
}

/// The reach of a mover that is a robot.
///
/// It is a length of the robot's chains, so that it is the same wherever the robot starts.
class RobotReach {
 public:
  RobotReach(const PlanScene& scene, std::size_t mover)
      : scene_(scene), mover_(mover), model_(scene.space.model(mover)) {}

  /// [m]  The distance that planned joints turn geometries at; where joints only slide a geometry,
  /// its radius.
  [[nodiscard]] double reach() const {
    const std::size_t robot = scene_.robots[mover_];
    double reach = 0.0;
    for (std::size_t link = 0; link < model_.links().size(); ++link) {
      const std::size_t member = scene_.scene.first_member(robot) + link;
      reach = std::max(reach, reach_of_member(member, link, 0.0));
      for (const Attachment& attachment : scene_.scene.attachments()) {
        if (attachment.link == member) {
          const double place = attachment.X_LB ? attachment.X_LB->position.norm() : 0.0;
          reach = std::max(reach, reach_of_member(attachment.body, link, place));
        }
      }
    }
    return reach;
  }

 private:
  [[nodiscard]] double reach_of_member(std::size_t member, std::size_t link, double place) const {
    const Lever lever = lever_of(link);
    double reach = 0.0;
    if (!lever.moves) {
      return reach;
    }
    for (const MemberGeometry& geometry : scene_.scene.geometries(member)) {
      reach = std::max(reach, lever.turned ? *lever.turned + place + reach_of(geometry)
                                           : radius_of(geometry.shape));
    }
    return reach;
  }

  struct Lever {
    bool moves = false;  // Whether planned joints move the link.
    /// [m]  Length from the first joint that turns a link to the link's frame; none where no joint
    /// does.
    std::optional<double> turned = {};
  };

  [[nodiscard]] Lever lever_of(std::size_t link) const {
    Lever lever;
    double length = 0.0;
    for (auto joint = model_.parent_joint(link); joint;
         joint = model_.parent_joint(model_.parent_link(*joint))) {
      double ways = 0.0;  // [m]
      for (const SpaceCoordinate& coordinate : scene_.space.coordinates()) {
        if (coordinate.mover != mover_ || coordinate.joint != leading_joint(model_, *joint)) {
          continue;
        }
        lever.moves = true;
        if (is_slide(model_.joints()[*joint].type, coordinate.index)) {
          ways += std::max(std::abs(coordinate.lower), std::abs(coordinate.upper));
        } else {
          lever.turned = length;  // A planar joint slides before it turns.
        }
      }
      for (const SpacePose& pose : scene_.space.poses()) {
        if (pose.mover == mover_ && pose.joint == *joint) {
          lever.moves = true;
          lever.turned = length;  // It slides before it turns.
          ways += std::max(pose.low.norm(), pose.high.norm());
        }
      }
      length += ways + model_.joints()[*joint].X_PJ.position.norm();
    }
    return lever;
  }

  const PlanScene& scene_;
  std::size_t mover_;
  const RobotModel& model_;
};

/// [m]  The least reach of a mover: a point has none, and all steps are shares of it.
///
/// It is a share of the greatest radius of a body or link, but of no more than the room in which
/// the mover is planned.
double least_reach(const PlanScene& scene) {
  double length = 0.0;
  for (std::size_t member = 0; member < scene.scene.size(); ++member) {
    for (const MemberGeometry& geometry : scene.scene.geometries(member)) {
      length = std::max(length, radius_of(geometry.shape));
    }
  }
  double room = 0.0;
  for (const SpacePose& pose : scene.space.poses()) {
    room = std::max(room, 0.5 * (pose.high - pose.low).norm());
  }
  for (const SpaceCoordinate& coordinate : scene.space.coordinates()) {
    room = std::max(room, coordinate.slides ? coordinate.upper - coordinate.lower : 0.0);
  }
  length = length > 0.0 && room > 0.0 ? std::min(length, room) : std::max(length, room);
  return kLeastReach * (length > 0.0 ? length : 1.0);
}

}  // namespace

TangentSpace::TangentSpace(const PlanScene& scene) : space_(scene.space) {
  const double least = least_reach(scene);
  if (space_.is_body()) {
    const std::size_t member = scene.scene.first_member(scene.robots.front());
    p_BC_ = scene.scene.geometries(member)[0].shape.hierarchy().centre;
    reach_ = std::max(radius_of_body(scene, 0), least);
    inverse_metric_ = Eigen::VectorXd::Ones(6);
    inverse_metric_.tail<3>().setConstant(1.0 / (reach_ * reach_));
    return;
  }
  std::vector<double> reaches;  // The reach of each mover.
  for (std::size_t mover = 0; mover < scene.robots.size(); ++mover) {
    reaches.push_back(std::max(scene.space.is_body(mover) ? radius_of_body(scene, mover)
                                                          : RobotReach(scene, mover).reach(),
                               least));
    reach_ = std::max(reach_, reaches.back());
  }
  inverse_metric_ = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(space_.dimension()));
  for (std::size_t k = 0; k < space_.coordinates().size(); ++k) {
    const SpaceCoordinate& coordinate = space_.coordinates()[k];
    if (!coordinate.slides) {
      const double reach = reaches[coordinate.mover];
      inverse_metric_[static_cast<Eigen::Index>(k)] = 1.0 / (reach * reach);
    }
  }
  for (std::size_t pose = 0; pose < space_.poses().size(); ++pose) {
    const double reach = reaches[space_.poses()[pose].mover];
    inverse_metric_.segment<3>(at(pose) + 3).setConstant(1.0 / (reach * reach));
  }
}

Eigen::Index TangentSpace::at(std::size_t pose) const {
  return static_cast<Eigen::Index>(space_.coordinates().size() + 6 * pose);
}

double TangentSpace::product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  return (a.array() * b.array() / inverse_metric_.array()).sum();
}

double TangentSpace::length(const Eigen::VectorXd& dq) const { return std::sqrt(product(dq, dq)); }

Eigen::VectorXd TangentSpace::difference(const Configuration& from, const Configuration& to) const {
  Eigen::VectorXd dq(size());
  for (std::size_t k = 0; k < space_.coordinates().size(); ++k) {
    dq[static_cast<Eigen::Index>(k)] =
        space_.coordinates()[k].turns_short ? shortest_way(from[k], to[k]) : to[k] - from[k];
  }
  for (std::size_t pose = 0; pose < space_.poses().size(); ++pose) {
    const std::size_t first = space_.begin_of_pose(pose);
    const Eigen::Quaterniond begin = turn_of(from, first);
    const Eigen::Quaterniond end = turn_of(to, first);
    dq.segment<3>(at(pose)) =
        place_of(to, first) + end * p_BC_ - place_of(from, first) - begin * p_BC_;
    dq.segment<3>(at(pose) + 3) = rotation_vector_of(end * begin.conjugate());
  }
  return dq;
}

void TangentSpace::move_pose(std::size_t pose, const Eigen::VectorXd& dq, Configuration& q) const {
  const std::size_t first = space_.begin_of_pose(pose);
  const Eigen::Quaterniond begin = turn_of(q, first);
  const Eigen::Vector3d turn = dq.segment<3>(at(pose) + 3);
  const Eigen::Quaterniond end = (rotation_from_vector(turn) * begin).normalized();
  const Eigen::Vector3d place =
      place_of(q, first) + begin * p_BC_ + dq.segment<3>(at(pose)) - end * p_BC_;
  const Configuration numbers = configuration_of({place, end});
  std::copy(numbers.begin(), numbers.end(), q.begin() + static_cast<std::ptrdiff_t>(first));
}

Configuration TangentSpace::moved(const Configuration& q, const Eigen::VectorXd& dq) const {
  Configuration to = q;
  for (std::size_t pose = 0; pose < space_.poses().size(); ++pose) {
    move_pose(pose, dq, to);
  }
  for (std::size_t k = 0; k < space_.coordinates().size(); ++k) {
    const SpaceCoordinate& coordinate = space_.coordinates()[k];
    to[k] += dq[static_cast<Eigen::Index>(k)];
    if (coordinate.has_limits) {
      to[k] = std::clamp(to[k], std::min(coordinate.lower, q[k]), std::max(coordinate.upper, q[k]));
    }
  }
  return to;
}

Configuration TangentSpace::beside(const Configuration& q, Eigen::Index number, double step) const {
  Configuration to = q;
  const auto k = static_cast<std::size_t>(number);
  const std::size_t coordinates = space_.coordinates().size();
  if (k < coordinates) {
    to[k] += step;
  } else {
    move_pose((k - coordinates) / 6, step * Eigen::VectorXd::Unit(size(), number), to);
  }
  return to;
}

Eigen::VectorXd TangentSpace::in_body(const Configuration& q, const Eigen::VectorXd& dq) const {
  if (!space_.is_body()) {
    return dq;
  }
  const Eigen::Quaterniond back = turn_of(q).conjugate();
  Eigen::VectorXd turned(6);
  turned << back * Eigen::Vector3d(dq.head<3>()), back * Eigen::Vector3d(dq.tail<3>());
  return turned;
}

Eigen::VectorXd TangentSpace::in_world(const Configuration& q, const Eigen::VectorXd& dq) const {
  if (!space_.is_body()) {
    return dq;
  }
  const Eigen::Quaterniond there = turn_of(q);
  Eigen::VectorXd turned(6);
  turned << there * Eigen::Vector3d(dq.head<3>()), there * Eigen::Vector3d(dq.tail<3>());
  return turned;
}

Eigen::VectorXd TangentSpace::twist(const Configuration& from, const Configuration& to) const {
  Eigen::VectorXd twist = in_body(from, difference(from, to));
  if (space_.is_body()) {
    const Eigen::Vector3d v = turn_of(from).conjugate() * (place_of(to) - place_of(from));
    twist.head<3>() = v + Eigen::Vector3d(twist.tail<3>()).cross(p_BC_);
  }
  return twist;
}

std::optional<Eigen::VectorXd> TangentSpace::about_an_axis(const Eigen::VectorXd& in_body) const {
  if (!space_.is_body()) {
    return std::nullopt;
  }
  const Eigen::Vector3d w = in_body.tail<3>();
  const Eigen::Vector3d v = in_body.head<3>() - w.cross(p_BC_);  // Velocity of the origin.
  const bool turns = reach_ * w.norm() > kNearScrew * v.norm();
  const Eigen::Vector3d& way = turns ? w : v;
  Eigen::Index axis = 0;
  const double along = way.cwiseAbs().maxCoeff(&axis);
  const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
  const Eigen::Vector3d beside = v - v[axis] * unit;
  if (!(along > 0.0) || (way - way[axis] * unit).norm() > kNearScrew * along ||
      (turns && beside.norm() > kNearScrew * reach_ * along)) {
    return std::nullopt;
  }
  const Eigen::Vector3d turn = turns ? Eigen::Vector3d(w[axis] * unit) : Eigen::Vector3d::Zero();
  Eigen::VectorXd screw(6);
  screw << v[axis] * unit + turn.cross(p_BC_), turn;
  return screw;
}

std::optional<Configuration> TangentSpace::screwed(const Configuration& q,
                                                   const Eigen::VectorXd& dq) const {
  const std::optional<Eigen::VectorXd> screw =
      space_.is_body() ? about_an_axis(in_body(q, dq)) : std::nullopt;
  if (!screw) {
    return std::nullopt;
  }
  const Eigen::Vector3d turn = screw->tail<3>();
  // Velocity of the origin.
  const Eigen::Vector3d slide = screw->head<3>() - turn.cross(p_BC_);
  const Eigen::Quaterniond begin = turn_of(q);
  const Eigen::Vector3d place = place_of(q) + begin * slide;
  const Eigen::Quaterniond end =
      turn.isZero(0.0) ? begin : (begin * rotation_from_vector(turn)).normalized();
  return Configuration{place.x(), place.y(), place.z(), end.w(), end.x(), end.y(), end.z()};
}

MovedMember TangentSpace::moved_body(const Configuration& q) const {
  MovedMember member;
  member.X_WM = {place_of(q), turn_of(q)};
  member.p_WR = member.X_WM.position + member.X_WM.rotation * p_BC_;
  member.J = Eigen::Matrix<double, 6, 6>::Identity();
  return member;
}

}  // namespace firstcontact::detail
