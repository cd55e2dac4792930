#include "planning/box_walk.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot/robot_description.h>

#include "planning/plan_cases.h"
#include "support/convex_distance.h"

namespace firstcontact::test {
namespace {

constexpr double kLink = 0.3;                      // [m]  From joint to joint.
const Eigen::Vector3d kHalfLink{0.1, 0.03, 0.03};  // [m]

oracle::Support support_of(const PlacedBox& box) {
  return [&box](const Eigen::Vector3d& n_W) -> Eigen::Vector3d {
    const Eigen::Vector3d n_B = box.X_WB.linear().transpose() * n_W;
    const Eigen::Vector3d signs =
        n_B.unaryExpr([](double number) { return number < 0.0 ? -1.0 : 1.0; });
    return box.X_WB * Eigen::Vector3d(signs.cwiseProduct(box.half));
  };
}

Eigen::Vector3d axis_of(std::size_t joint) {
  return joint % 2 == 0 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
}

std::string joint_name(std::size_t joint) { return "j" + std::to_string(joint); }

/// The model of an arm of boxes.
RobotModel model_of(const std::vector<ArmJoint>& joints) {
  RobotDescription robot{.name = "arm", .links = {{"base"}}, .joints = {}};
  for (std::size_t k = 0; k < joints.size(); ++k) {
    Link link{"l" + std::to_string(k)};
    link.collision.push_back(
        {.name = "",
         .X_LG = {{0.5 * kLink, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
         .source = SphereGeometry{},
         .shape = make_box({2 * kHalfLink.x(), 2 * kHalfLink.y(), 2 * kHalfLink.z()})});
    Joint joint{.name = joint_name(k),
                .type = joints[k].is_continuous ? JointType::continuous : JointType::revolute,
                .parent = robot.links.back().name,
                .child = link.name,
                .X_PJ = {{k == 0 ? 0.0 : kLink, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
                .axis = axis_of(k)};
    if (!joints[k].is_continuous) {
      joint.limits = {.lower = -1.5, .upper = 1.5};
    }
    if (const auto leader = joints[k].follows) {
      joint.mimic = Mimic{.joint = joint_name(*leader),
                          .multiplier = joints[k].multiplier,
                          .offset = joints[k].offset};
    }
    robot.links.push_back(std::move(link));
    robot.joints.push_back(std::move(joint));
  }
  return RobotModel(robot);
}

constexpr double kMet = 1e-12;  // [m]

/// Bounds the distance of two boxes. Those of far ones are of their spheres and middles.
oracle::ConvexDistance gap(const PlacedBox& A, const PlacedBox& B) {
  constexpr double kFar = 0.1;  // [m]
  const double between = (A.X_WB.translation() - B.X_WB.translation()).norm();
  const double spheres = between - A.half.norm() - B.half.norm();
  return spheres > kFar ? oracle::ConvexDistance{spheres, between}
                        : oracle::convex_distance(support_of(A), support_of(B));
}

}  // namespace

WalkedEdge walk(const MovingBoxes& boxes, double near, double finest) {
  WalkedEdge found;
  for (double share = 0.0;;) {
    const std::vector<PlacedBox> at = boxes.at(share);
    double least = 10.0;
    bool has_met = false;
    for (const auto& [a, b] : boxes.pairs) {
      const oracle::ConvexDistance between = gap(at[a], at[b]);
      least = std::min(least, between.lower);
      has_met = has_met || between.upper <= kMet;
    }
    if (!found.near_from && least <= near + boxes.speed * finest) {
      found.near_from = share;
    }
    if (has_met) {
      found.met_by = share;
      return found;
    }
    if (share >= 1.0) {
      return found;
    }
    const double step = boxes.speed > 0.0 ? (least - near) / boxes.speed : 1.0;
    share = std::min(1.0, share + std::max(step, finest));
  }
}

BoxArm::BoxArm(std::vector<ArmJoint> joints)
    : joints_(std::move(joints)), rest_(at_rest(model_of(joints_))) {}

ConfigurationSpace BoxArm::space() const {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    if (!joints_[k].follows) {
      names.push_back(joint_name(k));
    }
  }
  return ConfigurationSpace::of_joints(rest_.model(), names, detail::given_motions(rest_));
}

std::vector<double> BoxArm::positions(std::span<const double> planned) const {
  std::vector<double> all;
  std::size_t next = 0;
  for (const ArmJoint& joint : joints_) {
    all.push_back(joint.follows ? joint.multiplier * all[*joint.follows] + joint.offset
                                : planned[next++]);
  }
  return all;
}

std::vector<PlacedBox> BoxArm::links(std::span<const double> planned) const {
  const std::vector<double> turned = positions(planned);
  std::vector<PlacedBox> placed;
  Eigen::Isometry3d X_WL = Eigen::Isometry3d::Identity();
  for (std::size_t k = 0; k < turned.size(); ++k) {
    X_WL = X_WL * Eigen::Translation3d(k == 0 ? 0.0 : kLink, 0.0, 0.0) *
           Eigen::AngleAxisd(turned[k], axis_of(k));
    placed.push_back({X_WL * Eigen::Translation3d(0.5 * kLink, 0.0, 0.0), kHalfLink});
  }
  return placed;
}

double BoxArm::way(std::span<const double> from, std::span<const double> to) const {
  const std::vector<double> begin = positions(from);
  const std::vector<double> end = positions(to);
  double sum = 0.0;
  std::vector<double> turns;
  for (std::size_t k = 0; k < begin.size(); ++k) {
    double turn = std::abs(end[k] - begin[k]);
    if (joints_[k].is_continuous) {
      turn = std::abs(std::remainder(turn, 2.0 * std::numbers::pi));
    } else if (const auto leader = joints_[k].follows) {
      turn = std::abs(joints_[k].multiplier) * turns[*leader];
    }
    turns.push_back(turn);
    sum += turn * kLink * static_cast<double>(begin.size() - k);
  }
  return sum;
}

PlacedBox placed_box(std::span<const double> pose, const Eigen::Vector3d& half) {
  PlacedBox box{.half = half};
  box.X_WB = Eigen::Translation3d(pose[0], pose[1], pose[2]) *
             Eigen::Quaterniond(pose[3], pose[4], pose[5], pose[6]).normalized();
  return box;
}

double way_of_box(std::span<const double> from, std::span<const double> to,
                  const Eigen::Vector3d& half) {
  double squared = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    squared += (to[k] - from[k]) * (to[k] - from[k]);
  }
  const Eigen::Quaterniond begin(from[3], from[4], from[5], from[6]);
  const Eigen::Quaterniond end(to[3], to[4], to[5], to[6]);
  return std::sqrt(squared) + begin.angularDistance(end) * half.norm();
}

}  // namespace firstcontact::test
