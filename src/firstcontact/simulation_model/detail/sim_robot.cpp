#include <firstcontact/simulation_model/detail/sim_robot.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <firstcontact/math/number_text.h>
#include <firstcontact/robot/detail/mimicked_joint.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/body_motion.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/simulation_model/detail/constants.h>

namespace firstcontact::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The positions over time of a coordinate on a trajectory, and their rates, at every step.
struct SampledPath {
  std::vector<TimedNumber> positions = {};  // [rad or m]
  std::vector<TimedNumber> rates = {};      // [rad/s or m/s]
};

SampledPath sampled(const RobotMotion& motion, std::size_t joint, double duration, double step) {
  SampledPath samples;
  const std::vector<CoordinateSegment> segments = motion.coordinate(joint);
  std::size_t piece = 0;
  for (std::size_t k = 0; samples.positions.empty() || samples.positions.back().time < duration;
       ++k) {
    const double time = std::min(duration, static_cast<double>(k) * step);
    const double t = time / duration;
    while (piece + 1 < segments.size() && segments[piece].t_end < t) {
      ++piece;
    }
    const CoordinateSegment::State state = segments[piece].state(t);
    samples.positions.push_back({time, state.value.value()});
    samples.rates.push_back({time, state.rate / duration});
  }
  return samples;
}

class RobotMaker {
 public:
  RobotMaker(const LoadedScene& loaded, std::size_t robot, const RobotModel& model)
      : scene_(loaded.scene),
        described_(loaded.scene.robots[robot]),
        dynamics_(*described_.dynamics),
        motion_(loaded.robots->robot_motion(robot)),
        number_(robot),
        model_(model) {}

  SimRobot make() {
    try {
      const auto& base = std::get<FixedMotion>(described_.base);
      Mechanism mechanism(model_, base.pose, dynamics_.has_free_base);
      MechanismState start = start_of(mechanism);
      mechanism.require_mass(start.positions);
      std::vector<JointLaw> laws = laws_of(mechanism, start);
      return {described_.name, number_, std::move(mechanism), std::move(laws), std::move(start)};
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("robot \"" + described_.name + "\": " + error.what());
    }
  }

 private:
  [[nodiscard]] bool is_base(const MechanismJoint& block) const {
    return block.joint == model_.joints().size();
  }

  MechanismState start_of(const Mechanism& mechanism) const {
    MechanismState state = mechanism.rest();
    for (const MechanismJoint& block : mechanism.joints()) {
      if (is_base(block)) {
        state.velocities.segment<3>(block.velocity) = dynamics_.linear_velocity;
        state.velocities.segment<3>(block.velocity + 3) = dynamics_.angular_velocity;
      } else if (!block.quaternion()) {
        set_coordinates(block, state);
      } else if (const auto given = motion_.given(block.joint)) {
        state.positions.segment(block.position, block.positions) =
            positions_at(std::get<Motion>(*given).pose(0.0), block.positions);
      }
    }
    return state;
  }

  /// A pose as the positions of a floating joint, or of a ball joint without the first three.
  static Eigen::VectorXd positions_at(const Pose& pose, Eigen::Index count) {
    const auto all = positions_of_pose(pose);
    return Eigen::Map<const Eigen::Matrix<double, 7, 1>>(all.data()).tail(count);
  }

  void set_coordinates(const MechanismJoint& block, MechanismState& state) const {
    const std::optional<JointMotion> given = motion_.given(block.joint);
    for (Eigen::Index k = 0; k < block.positions; ++k) {
      const auto index = static_cast<std::size_t>(k);
      const auto* planar = given ? std::get_if<PlanarPath>(&*given) : nullptr;
      const CoordinatePath& path =
          planar != nullptr ? planar->at(index) : std::get<CoordinatePath>(given.value());
      state.positions[block.position + k] = path.segments().front().state(0.0).value.value();
      const auto velocity =
          dynamics_.velocities.find(coordinate_name(model_, {block.joint, index}));
      if (velocity != dynamics_.velocities.end()) {
        state.velocities[block.velocity + k] = velocity->second;
      }
    }
  }

  std::vector<JointLaw> laws_of(const Mechanism& mechanism, const MechanismState& start) const {
    std::vector<JointLaw> laws;
    for (const MechanismJoint& block : mechanism.joints()) {
      if (is_base(block)) {
        continue;
      }
      const Joint& joint = model_.joints()[block.joint];
      require_sound(joint);
      for (Eigen::Index k = 0; k < block.velocities; ++k) {
        JointLaw law{.position = block.position + k,
                     .velocity = block.velocity + k,
                     .damping = joint.damping,
                     .friction = joint.friction};
        if (block.positions == 1) {
          const double q = start.positions[block.position];
          law.limits = limits_of(joint, q);
          take_followers(block.joint, q, law);
          take_motor(block.joint, law);
        }
        laws.push_back(std::move(law));
      }
    }
    return laws;
  }

  static void require_sound(const Joint& joint) {
    if (!(joint.damping >= 0.0 && joint.friction >= 0.0) || !std::isfinite(joint.damping) ||
        !std::isfinite(joint.friction)) {
      throw std::invalid_argument("joint \"" + joint.name +
                                  "\": its damping and friction must be finite and >= 0");
    }
  }

  /// The limits of a joint. A greatest effort of 0 is a gap in a file, not a joint without
  /// strength.
  static JointLimits limits_of(const Joint& joint, double q) {
    JointLimits limits = joint.limits;
    if (q < limits.lower.value_or(q) || q > limits.upper.value_or(q)) {
      throw std::invalid_argument("joint \"" + joint.name + "\" starts at " + detail::shortest(q) +
                                  ", beyond its limits; give it another \"state\"");
    }
    if (limits.effort == 0.0) {
      limits.effort.reset();
    }
    return limits;
  }

  /// Adds the laws of joints that mimic one to its coordinate.
  ///
  /// @param q  [rad or m]  where the joint starts
  void take_followers(std::size_t leader, double q, JointLaw& law) const {
    for (const Joint& joint : model_.joints()) {
      if (!joint.mimic) {
        continue;
      }
      const auto [followed, multiplier, offset] =
          mimicked_joint(model_, model_.find_joint(joint.name).value());
      if (followed != leader) {
        continue;
      }
      require_sound(joint);
      law.damping += multiplier * multiplier * joint.damping;
      law.friction += std::abs(multiplier) * joint.friction;
      narrow(limits_of(joint, multiplier * q + offset), multiplier, offset, law.limits);
    }
  }

  /// Narrows limits of a coordinate to those for multiplier q + offset.
  static void narrow(const JointLimits& there, double multiplier, double offset,
                     JointLimits& limits) {
    const auto here = [&](double limit) { return (limit - offset) / multiplier; };
    const bool is_reversed = multiplier < 0.0;
    const std::optional<double>& lower = is_reversed ? there.upper : there.lower;
    const std::optional<double>& upper = is_reversed ? there.lower : there.upper;
    if (lower && multiplier != 0.0) {
      limits.lower = std::max(here(*lower), limits.lower.value_or(here(*lower)));
    }
    if (upper && multiplier != 0.0) {
      limits.upper = std::min(here(*upper), limits.upper.value_or(here(*upper)));
    }
  }

  void take_motor(std::size_t joint, JointLaw& law) const {
    const auto found = dynamics_.motors.find(joint);
    if (found == dynamics_.motors.end()) {
      return;
    }
    law.motor = found->second;
    if (law.motor->target.empty()) {
      SampledPath path = sampled(motion_, joint, scene_.duration, scene_.simulation->step);
      law.motor->target = std::move(path.positions);
      law.rates = std::move(path.rates);
    }
  }

  const Scene& scene_;
  const SceneRobot& described_;
  const RobotDynamics& dynamics_;
  const RobotMotion& motion_;
  std::size_t number_;
  const RobotModel& model_;
};

}  // namespace

bool SimRobot::is_driven() const {
  return std::ranges::any_of(laws, [](const JointLaw& law) {
    return law.motor || law.limits.lower || law.limits.upper || law.damping > 0.0 ||
           law.friction > 0.0;
  });
}

bool SimRobot::is_passive(const Eigen::VectorXd& positions) const {
  return std::ranges::none_of(laws, [&](const JointLaw& law) {
    const double at = positions[law.position];
    return law.motor || law.damping > 0.0 || law.friction > 0.0 ||
           (law.limits.lower && at < *law.limits.lower + kAtLimit) ||
           (law.limits.upper && at > *law.limits.upper - kAtLimit);
  });
}

std::size_t SimRobot::motor_count() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(laws, [](const JointLaw& law) { return law.motor.has_value(); }));
}

std::size_t SimRobot::rigid_motor_count() const {
  return static_cast<std::size_t>(std::ranges::count_if(laws, is_rigid));
}

double SimRobot::share_within_limits(const MechanismState& from, const Eigen::VectorXd& to) const {
  double share = 1.0;
  const auto stop_at = [&](double q, double end, double farthest) {
    if (end > farthest) {
      share = std::min(share, std::max(0.0, (farthest - q) / (end - q)));
    }
  };
  for (const JointLaw& law : laws) {
    const double q = from.positions[law.position];
    const double end = to[law.position];
    if (law.limits.upper) {
      stop_at(q, end, std::max(*law.limits.upper + kMostBeyondLimit, q + kAtLimit));
    }
    if (law.limits.lower) {
      stop_at(-q, -end, std::max(-*law.limits.lower + kMostBeyondLimit, -q + kAtLimit));
    }
  }
  return share;
}

std::vector<JointDrive> SimRobot::drives_at_impact(const MechanismState& state,
                                                   std::size_t mechanism_number) const {
  std::vector<JointDrive> drives;
  for (const JointLaw& law : laws) {
    if (is_rigid(law)) {
      drives.push_back({.mechanism = mechanism_number,
                        .coordinate = static_cast<std::size_t>(law.velocity),
                        .target = state.velocities[law.velocity]});
    }
  }
  for (const JointLaw& law : laws) {
    if (is_rigid(law)) {
      continue;
    }
    const double q = state.positions[law.position];
    JointDrive drive{.mechanism = mechanism_number,
                     .coordinate = static_cast<std::size_t>(law.velocity)};
    if (law.limits.lower && q <= *law.limits.lower + kAtLimit) {
      drive.least = 0.0;
      drives.push_back(drive);
    } else if (law.limits.upper && q >= *law.limits.upper - kAtLimit) {
      drive.greatest = 0.0;
      drives.push_back(drive);
    }
  }
  return drives;
}

std::vector<JointDrive> SimRobot::stops(const MechanismState& state,
                                        std::size_t mechanism_number) const {
  std::vector<JointDrive> drives;
  for (const JointLaw& law : laws) {
    const double q = state.positions[law.position];
    JointDrive drive{.mechanism = mechanism_number,
                     .coordinate = static_cast<std::size_t>(law.velocity)};
    if (law.limits.lower) {
      drive.target = std::min(0.0, *law.limits.lower - q);
      drive.least = 0.0;
      drive.greatest = kInfinity;
      drives.push_back(drive);
    }
    if (law.limits.upper) {
      drive.target = std::max(0.0, *law.limits.upper - q);
      drive.least = -kInfinity;
      drive.greatest = 0.0;
      drives.push_back(drive);
    }
  }
  return drives;
}

std::vector<SimRobot> make_sim_robots(const LoadedScene& loaded, const LinksAsBodies& linked) {
  std::vector<SimRobot> robots;
  for (std::size_t r = 0; r < loaded.scene.robots.size(); ++r) {
    if (loaded.scene.robots[r].dynamics) {
      robots.push_back(RobotMaker(loaded, r, linked.models[r]).make());
    }
  }
  return robots;
}

}  // namespace firstcontact::detail
