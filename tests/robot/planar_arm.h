/// @file
/// An arm of hinges in a plane, whose distances have closed forms.

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot/robot_motion.h>

namespace firstcontact::test {

constexpr double kBarRadius = 0.05;  // [m]
constexpr std::array<double, 2> kStep = {0.0, 1.0};

inline CoordinatePath ramp(double from, double to) {
  const std::array<double, 2> q = {from, to};
  return CoordinatePath::linear(kStep, q);
}

/// Makes a bar of length 1 along x, from the origin on.
inline Shape bar() {
  return Shape(Mesh{.vertices = {{0, 0, 0}, {1, 0, 0}}, .triangles = {{0, 1, 1}}}, kBarRadius);
}

/// Makes the arm base - l0 - l1 - ...: continuous joints j0, j1, ... about z.
///
/// The base has no geometry.
inline RobotModel planar_arm(std::size_t bars) {
  RobotDescription arm{.name = "arm", .links = {{"base", {}, {}}}, .joints = {}};
  for (std::size_t k = 0; k < bars; ++k) {
    Link link{"l" + std::to_string(k), {}, {}};
    link.collision.push_back({.name = "", .X_LG = {}, .source = SphereGeometry{}, .shape = bar()});
    Joint joint{.name = "j" + std::to_string(k),
                .type = JointType::continuous,
                .parent = arm.links.back().name,
                .child = link.name};
    joint.axis = Eigen::Vector3d::UnitZ();
    joint.X_PJ.position.x() = k == 0 ? 0.0 : 1.0;
    arm.links.push_back(std::move(link));
    arm.joints.push_back(std::move(joint));
  }
  return RobotModel(arm);
}

inline RobotMotion planar_motion(const std::vector<CoordinatePath>& angles,
                                 const Motion& base = Motion::fixed()) {
  std::map<std::string, JointMotion> joints;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    joints.emplace("j" + std::to_string(k), angles[k]);
  }
  return {planar_arm(angles.size()), joints, base};
}

/// Computes the positions of the hinges and of the tip.
inline std::vector<Eigen::Vector2d> hinges(const std::vector<double>& angles) {
  std::vector<Eigen::Vector2d> points = {Eigen::Vector2d::Zero()};
  double sum = 0.0;
  for (const double angle : angles) {
    sum += angle;
    points.push_back(points.back() + Eigen::Vector2d(std::cos(sum), std::sin(sum)));
  }
  return points;
}

/// Computes the distance from a point to the segment between two others.
inline double segment_distance(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                               const Eigen::Vector2d& b) {
  const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - s * (b - a)).norm();
}

/// Computes the distance of two segments in the plane.
inline double segments_distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                const Eigen::Vector2d& c, const Eigen::Vector2d& d) {
  const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q,
                       const Eigen::Vector2d& r) {
    return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
  };
  if (side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0) {
    return 0.0;
  }
  return std::min({segment_distance(a, c, d), segment_distance(b, c, d), segment_distance(c, a, b),
                   segment_distance(d, a, b)});
}

}  // namespace firstcontact::test
