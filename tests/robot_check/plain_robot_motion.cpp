#include "robot_check/plain_robot_motion.h"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

namespace firstcontact::test {
namespace {

double coordinate(const PlainRobotMotion& m, std::size_t joint, double t) {
  const std::optional<Mimic>& mimic = m.model.joints()[joint].mimic;
  if (mimic) {
    const std::size_t source = m.model.find_joint(mimic->joint).value();
    return mimic->multiplier * coordinate(m, source, t) + mimic->offset;
  }
  return m.from[joint] + t * (m.to[joint] - m.from[joint]);
}

Eigen::Isometry3d place_in_parent(const Joint& joint, double q) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translate(joint.X_PJ.position).rotate(joint.X_PJ.rotation.normalized());
  const Eigen::Vector3d axis = joint.axis.normalized();
  switch (joint.type) {
    case JointType::fixed:
      return X;
    case JointType::revolute:
    case JointType::continuous:
      return X * Eigen::AngleAxisd(q, axis);
    case JointType::prismatic:
      return X * Eigen::Translation3d(q * axis);
    default:
      throw std::invalid_argument("joint '" + joint.name + "': no place for its type here");
  }
}

bool has_coordinate(const Joint& joint) { return joint.type != JointType::fixed && !joint.mimic; }

}  // namespace

std::vector<Eigen::Isometry3d> PlainRobotMotion::places(double t) const {
  std::vector<Eigen::Isometry3d> result;
  for (std::size_t link = 0; link < model.links().size(); ++link) {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    for (const std::size_t joint : model.chain(model.root(), link)) {
      X = X * place_in_parent(model.joints()[joint], coordinate(*this, joint, t));
    }
    result.push_back(X);
  }
  return result;
}

RobotMotion PlainRobotMotion::motion() const {
  std::map<std::string, JointMotion> joints;
  for (std::size_t k = 0; k < from.size(); ++k) {
    if (has_coordinate(model.joints()[k])) {
      const std::array<double, 2> times = {0.0, 1.0};
      const std::array<double, 2> values = {from[k], to[k]};
      joints.emplace(model.joints()[k].name, CoordinatePath::linear(times, values));
    }
  }
  return RobotMotion(model, joints);
}

PlainRobotMotion random_motion(const RobotModel& model, Random& random, double spread,
                               double most) {
  PlainRobotMotion result{model, {}, {}};
  for (const Joint& joint : model.joints()) {
    const double low = joint.limits.lower.value_or(-std::numbers::pi);
    const double high = joint.limits.upper.value_or(std::numbers::pi);
    const double rest = std::clamp(0.0, low, high);
    result.from.push_back(rest + spread * (random.uniform(low, high) - rest));
    result.to.push_back(std::clamp(result.from.back() + random.uniform(-most, most), low, high));
  }
  return result;
}

}  // namespace firstcontact::test
