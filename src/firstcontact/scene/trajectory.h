/// @file
/// What a robot is told to do, in seconds, and the joint motions over a scene that follow from it.

#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/articulated/robot_model.h>
#include <firstcontact/articulated/robot_motion.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Where the joints are at one time. Numbers are in the order of the trajectory's joint names.
struct TrajectoryPoint {
  double time = 0.0;                       ///< [s]
  std::vector<double> positions = {};      ///< [rad or m]
  std::vector<double> velocities = {};     ///< [rad/s or m/s]  As many, or none.
  std::vector<double> accelerations = {};  ///< [rad/s^2 or m/s^2]  So too; not without velocities.
};

/// Positions at times; between them linear, cubic where there are velocities, quintic where there
/// are accelerations too. The robot rests before the first time and after the last.
///
/// A planar joint has three names: NAME/x, NAME/y [m], NAME/theta [rad].
struct Trajectory {
  std::vector<std::string> joint_names;  ///< Each once.
  std::vector<TrajectoryPoint> points;  ///< At least one. Times >= 0, strictly increasing; all have
                                        ///< velocities (accelerations), or none has.
};

/// Coordinates by the names that trajectories use [rad or m].
using JointPositions = std::map<std::string, double, std::less<>>;

/// One coordinate of a joint.
struct JointCoordinate {
  std::size_t joint = 0;  ///< Of the model.
  std::size_t index = 0;  ///< 0; up to 2 for planar joints.

  friend auto operator<=>(const JointCoordinate&, const JointCoordinate&) = default;
};

/// The coordinate that a trajectory calls `name`.
///
/// @throws std::invalid_argument if the robot has none of this name (with the nearest that it has),
///         or it cannot follow a trajectory: fixed, floating and ball joints
[[nodiscard]] FIRSTCONTACT_API JointCoordinate find_coordinate(const RobotModel& robot,
                                                               std::string_view name);

/// What trajectories call a coordinate.
[[nodiscard]] FIRSTCONTACT_API std::string coordinate_name(const RobotModel& robot,
                                                           const JointCoordinate& coordinate);

/// Where a coordinate is that nothing else is said of: at 0, or at its limit next to it.
///
/// @returns  [rad or m]
[[nodiscard]] FIRSTCONTACT_API double default_position(const Joint& joint);

/// The joint motions of a robot over a scene, and what nobody said.
struct TrajectoryMotion {
  std::map<std::string, JointMotion> joints;  ///< As RobotMotion takes them.
  /// The coordinates that neither the trajectory nor the given positions name; they rest at their
  /// default positions.
  std::vector<std::string> at_default;
};

/// Joint motions over step time t = time / duration. Quotients of times, and velocities and
/// accelerations per step, are rounded to doubles; certificates hold for the rounded numbers.
///
/// Coordinates that the trajectory does not name rest: at `held`, else at default_position. A joint
/// that mimics another may be named as long as it says the same, to 1e-6 (what six digits leave);
/// it follows the other exactly. Floating and ball joints rest at the identity.
///
/// @param held      where coordinates rest that the trajectory does not name
/// @param duration  [s]  > 0, at least the last time
/// @throws std::invalid_argument  names the joint
[[nodiscard]] FIRSTCONTACT_API TrajectoryMotion joint_motions(const RobotModel& robot,
                                                              const Trajectory& trajectory,
                                                              const JointPositions& held,
                                                              double duration);

}  // namespace firstcontact
