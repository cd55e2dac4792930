#include <firstcontact/planning/detail/tangent_space.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/motion/rotation_forms.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::detail {
namespace {

constexpr double kNearScrew = 0.05;  // [-]  What a motion may depart from a screw about an axis.

Eigen::Vector3d place_of(const Configuration& q) { return {q[0], q[1], q[2]}; }

Eigen::Quaterniond turn_of(const Configuration& q) {
  return Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized();
}

Eigen::Vector3d rotation_vector_of(const Eigen::Quaterniond& rotation) {
  const double sine = rotation.vec().norm();
  const double angle = 2.0 * std::atan2(sine, std::abs(rotation.w()));
  const double factor = sine > 0.0 ? angle / sine : 2.0;
  return (rotation.w() < 0.0 ? -factor : factor) * rotation.vec();
}

/// [m]  How far geometries of a robot are from its base, in the motion that the scene has.
double reach_of_robot(const RobotScene& scene, std::size_t robot) {
  const Eigen::Vector3d base = scene.robot_motion(robot).base().pose(0.0).position;
  double reach = 0.0;
  for (std::size_t member = 0; member < scene.size(); ++member) {
    const auto link = scene.robot_link(member);
    if (!link || link->robot != robot) {
      continue;
    }
    for (const MemberGeometry& geometry : scene.geometries(member)) {
      const Hierarchy& hierarchy = geometry.shape.hierarchy();
      reach = std::max(reach, (scene.pose(member, 0.0).position - base).norm() +
                                  geometry.X_MG.position.norm() + hierarchy.centre.norm() +
                                  hierarchy.radius);
    }
  }
  return reach;
}

}  // namespace

TangentSpace::TangentSpace(const PlanScene& scene) : space_(scene.space) {
  if (space_.is_body()) {
    const std::size_t member = scene.scene.first_member(scene.robots.front());
    const Hierarchy& hierarchy = scene.scene.geometries(member)[0].shape.hierarchy();
    p_BC_ = hierarchy.centre;
    reach_ = hierarchy.radius;
    inverse_metric_ = Eigen::VectorXd::Ones(6);
    inverse_metric_.tail<3>().setConstant(1.0 / (reach_ * reach_));
    return;
  }
  std::vector<double> reaches;  // Of each mover.
  for (const std::size_t robot : scene.robots) {
    reaches.push_back(std::max(reach_of_robot(scene.scene, robot), 1e-9));
    reach_ = std::max(reach_, reaches.back());
  }
  inverse_metric_ = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(space_.size()));
  for (std::size_t k = 0; k < space_.size(); ++k) {
    const SpaceCoordinate& coordinate = space_.coordinates()[k];
    if (!coordinate.slides) {
      const double reach = reaches[coordinate.mover];
      inverse_metric_[static_cast<Eigen::Index>(k)] = 1.0 / (reach * reach);
    }
  }
}

double TangentSpace::product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  return (a.array() * b.array() / inverse_metric_.array()).sum();
}

double TangentSpace::length(const Eigen::VectorXd& dq) const { return std::sqrt(product(dq, dq)); }

Eigen::VectorXd TangentSpace::difference(const Configuration& from, const Configuration& to) const {
  Eigen::VectorXd dq(size());
  if (space_.is_body()) {
    const Eigen::Quaterniond begin = turn_of(from);
    const Eigen::Quaterniond end = turn_of(to);
    dq.head<3>() = place_of(to) + end * p_BC_ - place_of(from) - begin * p_BC_;
    dq.tail<3>() = rotation_vector_of(end * begin.conjugate());
    return dq;
  }
  for (std::size_t k = 0; k < from.size(); ++k) {
    dq[static_cast<Eigen::Index>(k)] =
        space_.coordinates()[k].turns_short ? shortest_way(from[k], to[k]) : to[k] - from[k];
  }
  return dq;
}

Configuration TangentSpace::moved(const Configuration& q, const Eigen::VectorXd& dq) const {
  if (space_.is_body()) {
    const Eigen::Quaterniond begin = turn_of(q);
    const Eigen::Quaterniond end =
        (rotation_from_vector(Eigen::Vector3d(dq.tail<3>())) * begin).normalized();
    const Eigen::Vector3d place = place_of(q) + begin * p_BC_ + dq.head<3>() - end * p_BC_;
    return {place.x(), place.y(), place.z(), end.w(), end.x(), end.y(), end.z()};
  }
  Configuration to = q;
  for (std::size_t k = 0; k < q.size(); ++k) {
    const SpaceCoordinate& coordinate = space_.coordinates()[k];
    to[k] += dq[static_cast<Eigen::Index>(k)];
    if (coordinate.has_limits) {
      to[k] = std::clamp(to[k], std::min(coordinate.lower, q[k]), std::max(coordinate.upper, q[k]));
    }
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
  const Eigen::Vector3d v = in_body.head<3>() - w.cross(p_BC_);  // Of the origin.
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
  const Eigen::Vector3d slide = screw->head<3>() - turn.cross(p_BC_);  // Of the origin.
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
