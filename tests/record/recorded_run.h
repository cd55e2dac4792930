/// @file
/// Runs made by hand: a test chooses the pieces by which bodies of a scene move.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/motion/motion.h>
#include <firstcontact/record/run.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/verification/verify_run.h>

namespace firstcontact::test {

/// Motion of a body for some time.
struct Leg {
  double lasts = 1.0;                                  ///< [s]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]  Velocity of the centre of mass.
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
};

class RecordedRun {
 public:
  RunHeader header;
  std::vector<RunStep> steps;

  /// @param free  bodies that are not scripted
  explicit RecordedRun(const std::string& scene, const std::vector<std::size_t>& free = {0}) {
    header.scene = parse_scene(scene, "scene.json");
    const std::size_t count = header.scene.bodies.size();
    header.masses.assign(count, 0.0);
    header.centres_of_mass.assign(count, Eigen::Vector3d::Zero());
    for (const std::size_t body : free) {
      header.masses[body] = 1.0;
      header.scene.bodies[body].free.emplace();
    }
    for (const Body& body : header.scene.bodies) {
      poses_.push_back(normalised_motion(body.motion, header.scene.duration).pose(0.0));
    }
  }

  /// Changes the initial pose of a body.
  void place(std::size_t body, const Pose& X_WB) {
    header.scene.bodies[body].motion = FixedMotion{X_WB};
    poses_[body] = X_WB;
  }

  /// Adds a step in which the named bodies move on, each by legs with the same total duration.
  RunStep& add(const std::vector<std::pair<std::size_t, std::vector<Leg>>>& moves,
               double clearance = 0.0) {
    RunStep step;
    step.index = steps.size() + 1;
    step.clearance = clearance;
    for (const auto& [body, legs] : moves) {
      RunBody moved{.body = body, .pieces = {}, .X_WB = {}};
      double from = 0.0;
      for (const Leg& leg : legs) {
        const Eigen::Vector3d translation = leg.lasts * leg.velocity;
        const Eigen::Vector3d turn = leg.lasts * leg.angular_velocity;
        from += leg.lasts;
        moved.pieces.push_back({from, poses_[body], translation, turn});
        const std::vector<ConstantRatePiece> piece{{1.0, poses_[body], translation, turn}};
        poses_[body] = Motion::constant_rates(piece, header.centres_of_mass[body]).pose(1.0);
      }
      moved.X_WB = poses_[body];
      step.lasted = from;
      step.bodies.push_back(moved);
    }
    step.time = (steps.empty() ? 0.0 : steps.back().time) + step.lasted;
    steps.push_back(step);
    return steps.back();
  }

  [[nodiscard]] RunVerification verify(const VerifyRunOptions& options = {}) const {
    std::size_t next = 0;
    return verify_run(
        header,
        [&]() -> std::optional<RunStep> {
          return next < steps.size() ? std::optional(steps[next++]) : std::nullopt;
        },
        options);
  }

 private:
  std::vector<Pose> poses_;
};

}  // namespace firstcontact::test
