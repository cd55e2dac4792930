/// @file
/// FCL's collision tests of the configurations of a planner's robot.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <firstcontact/planning/plan_scene.h>

#include "benchmarks/robot_check/straight_motion.h"
#include "benchmarks/support/fcl_robot.h"

namespace firstcontact::benchmarks {

/// Tests the first robot of a plan among bodies at rest, one configuration at a time.
///
/// For use by one thread.
class FclPlaces {
 public:
  explicit FclPlaces(const ScenePlan& scene)
      : coordinates_(scene.plan.space.coordinates().begin(), scene.plan.space.coordinates().end()),
        kinematics_(scene.plan.space.model()) {
    fill(peer_, scene.plan.scene, sources_of(scene.loaded.scene));
    for (const Joint& joint : scene.plan.space.model().joints()) {
      const auto& state = scene.loaded.scene.robots[0].state;
      const auto found = state.find(joint.name);
      whole_.push_back(found == state.end() ? default_position(joint) : found->second);
    }
  }

  [[nodiscard]] bool collide(const std::vector<double>& waypoint) {
    ++count_;
    return peer_.collides(links(waypoint));
  }

  /// Returns X_WL of every link at a configuration; valid until the next call.
  [[nodiscard]] const std::vector<Eigen::Isometry3d>& links(const std::vector<double>& waypoint) {
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      whole_[coordinates_[k].joint] = waypoint[k];
    }
    return kinematics_.places(whole_);
  }

  /// Returns whether a sampled configuration of an edge collides.
  ///
  /// No joint moves by more than `step` [rad] between two samples.
  [[nodiscard]] bool collide(const std::vector<double>& from, const std::vector<double>& to,
                             double step) {
    double longest = 0.0;
    for (std::size_t k = 0; k < from.size(); ++k) {
      longest = std::max(longest, std::abs(to[k] - from[k]));
    }
    const int steps = std::max(1, static_cast<int>(std::ceil(longest / step)));
    std::vector<double> q = from;
    for (int at = 0; at <= steps; ++at) {
      for (std::size_t k = 0; k < from.size(); ++k) {
        q[k] = from[k] + (to[k] - from[k]) * at / steps;
      }
      if (collide(q)) {
        return true;
      }
    }
    return false;
  }

  /// Returns the number of configurations that were tested.
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::vector<SpaceCoordinate> coordinates_;
  FclRobot peer_;
  PlainKinematics kinematics_;
  std::vector<double> whole_;  // Coordinates of all joints.
  std::size_t count_ = 0;
};

}  // namespace firstcontact::benchmarks
