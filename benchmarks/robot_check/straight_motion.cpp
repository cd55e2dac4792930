#include "benchmarks/robot_check/straight_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

namespace firstcontact::benchmarks {
namespace {

bool has_coordinate(const Joint& joint) { return joint.type != JointType::fixed && !joint.mimic; }

bool turns(const Joint& joint) {
  return has_coordinate(joint) && joint.type != JointType::prismatic;
}

double low(const Joint& joint) { return joint.limits.lower.value_or(-std::numbers::pi); }
double high(const Joint& joint) { return joint.limits.upper.value_or(std::numbers::pi); }

}  // namespace

RobotMotion StraightMotion::of(const RobotModel& model) const {
  constexpr std::array<double, 2> kTimes = {0.0, 1.0};
  std::map<std::string, JointMotion> joints;
  for (std::size_t k = 0; k < from.size(); ++k) {
    if (has_coordinate(model.joints()[k])) {
      const std::array<double, 2> values = {from[k], to[k]};
      joints.emplace(model.joints()[k].name, CoordinatePath::linear(kTimes, values));
    }
  }
  return {model, std::move(joints)};
}

double StraightMotion::longest_joint() const {
  double longest = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    longest = std::max(longest, std::abs(to[k] - from[k]));
  }
  return longest;
}

Configuration StraightMotion::at(double t) const {
  Configuration q(from.size());
  for (std::size_t k = 0; k < q.size(); ++k) {
    q[k] = from[k] + t * (to[k] - from[k]);
  }
  return q;
}

Configuration random_configuration(const RobotModel& model, test::Random& random) {
  Configuration q;
  for (const Joint& joint : model.joints()) {
    q.push_back(has_coordinate(joint) ? random.uniform(low(joint), high(joint)) : 0.0);
  }
  return q;
}

StraightMotion random_motion(const RobotModel& model, const Configuration& from, double length,
                             test::Random& random) {
  Configuration way(from.size());
  double square = 0.0;
  for (std::size_t k = 0; k < way.size(); ++k) {
    // The sum of three uniform numbers is close enough to normal, so that all directions are about
    // as likely.
    way[k] = turns(model.joints()[k])
                 ? random.uniform(-1.0, 1.0) + random.uniform(-1.0, 1.0) + random.uniform(-1.0, 1.0)
                 : 0.0;
    square += way[k] * way[k];
  }
  StraightMotion motion{from, from};
  for (std::size_t k = 0; k < way.size(); ++k) {
    const Joint& joint = model.joints()[k];
    if (turns(joint)) {
      motion.to[k] =
          std::clamp(from[k] + length / std::sqrt(square) * way[k], low(joint), high(joint));
    }
  }
  return motion;
}

PlainKinematics::PlainKinematics(const RobotModel& model)
    : places_(model.links().size(), Eigen::Isometry3d::Identity()) {
  std::vector<std::size_t> open = {model.root()};
  while (!open.empty()) {
    const std::size_t link = open.back();
    open.pop_back();
    for (std::size_t k = 0; k < model.joints().size(); ++k) {
      if (model.parent_link(k) != link) {
        continue;
      }
      const Joint& joint = model.joints()[k];
      Step step{link, model.child_link(k), joint.type, {}, joint.axis.normalized(), k, 1.0, 0.0};
      step.X_PJ = Eigen::Translation3d(joint.X_PJ.position) * joint.X_PJ.rotation.normalized();
      while (const std::optional<Mimic>& mimic = model.joints()[step.source].mimic) {
        step.offset += step.multiplier * mimic->offset;
        step.multiplier *= mimic->multiplier;
        step.source = model.find_joint(mimic->joint).value();
      }
      steps_.push_back(step);
      open.push_back(step.child);
    }
  }
}

const std::vector<Eigen::Isometry3d>& PlainKinematics::places(const Configuration& q) {
  for (const Step& step : steps_) {
    Eigen::Isometry3d& X = places_[step.child];
    X = places_[step.parent] * step.X_PJ;
    const double at = step.multiplier * q[step.source] + step.offset;
    if (step.type == JointType::prismatic) {
      X.translate(at * step.axis);
    } else if (step.type != JointType::fixed) {
      X.rotate(Eigen::AngleAxisd(at, step.axis));
    }
  }
  return places_;
}

}  // namespace firstcontact::benchmarks
