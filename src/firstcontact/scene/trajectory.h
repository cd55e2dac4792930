/// @file
/// The trajectory of a robot, in seconds, and the joint motions over a scene that follow from it.

#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/robot/robot_motion.h>

namespace firstcontact {

/// The state of the joints at one time. Numbers are in the order of the trajectory's joint names.
struct TrajectoryPoint {
  double time = 0.0;                       ///< [s]
  std::vector<double> positions = {};      ///< [rad or m]
  std::vector<double> velocities = {};     ///< [rad/s or m/s]  As many, or none.
  std::vector<double> accelerations = {};  ///< [rad/s^2 or m/s^2]  As many, or none; only with
                                           ///< velocities.
};

/// Positions at times: linear between them, cubic with velocities, quintic with accelerations too.
///
/// The robot rests before the first time and after the last.
///
/// A planar joint has three names: NAME/x, NAME/y [m], NAME/theta [rad]. A floating joint has
/// seven, as MoveIt calls them: NAME/trans_x, NAME/trans_y, NAME/trans_z [m] and the quaternion
/// NAME/rot_w, NAME/rot_x, NAME/rot_y, NAME/rot_z. Between points it moves its origin on a line and
/// turns at a constant rate by the shortest rotation; it takes no velocities.
struct Trajectory {
  std::vector<std::string> joint_names;  ///< Names of coordinates, each once.
  std::vector<TrajectoryPoint> points;  ///< At least one. Times are >= 0 and increase strictly; the
                                        ///< same numbers are given in all points.
  /// The way of continuous joints, and of the angles of planar ones, between points.
  ///
  /// See takes_short_way().
  Turning turning = Turning::as_given;
  std::vector<std::string> warnings = {};  ///< Notes for the user about the file that was read.
};

/// Coordinates by the names that trajectories use [rad or m].
using JointPositions = std::map<std::string, double, std::less<>>;

/// One coordinate of a joint.
struct JointCoordinate {
  std::size_t joint = 0;  ///< Index of the joint in the model.
  std::size_t index = 0;  ///< 0; up to 2 for planar joints, up to 6 for floating ones.

  friend auto operator<=>(const JointCoordinate&, const JointCoordinate&) = default;
};

/// Finds the coordinate that a trajectory calls `name`.
///
/// @throws std::invalid_argument if the robot has none of this name (with the nearest that it has),
///         or it cannot follow a trajectory: fixed and ball joints
[[nodiscard]] FIRSTCONTACT_API JointCoordinate find_coordinate(const RobotModel& robot,
                                                               std::string_view name);

/// Finds the coordinate that a trajectory calls `name`; none where find_coordinate() throws.
[[nodiscard]] FIRSTCONTACT_API std::optional<JointCoordinate> known_coordinate(
    const RobotModel& robot, std::string_view name);

/// The name of a coordinate in trajectories.
[[nodiscard]] FIRSTCONTACT_API std::string coordinate_name(const RobotModel& robot,
                                                           const JointCoordinate& coordinate);

/// The name of a joint's coordinate in trajectories.
[[nodiscard]] FIRSTCONTACT_API std::string coordinate_name(const Joint& joint, std::size_t index);

/// Whether a position of this name has no effect, as the joint is fixed.
[[nodiscard]] FIRSTCONTACT_API bool names_fixed_joint(const RobotModel& robot,
                                                      std::string_view name);

/// Whether a coordinate goes the short way where a trajectory has Turning::shortest, as MoveIt
/// interpolates.
///
/// A continuous joint does, and the angle of a planar one. It does not where a joint mimics it and
/// shows whole turns: by sliding, or by a multiplier that is no integer. The positions of that
/// joint at the points hold only for the way as given.
[[nodiscard]] FIRSTCONTACT_API bool takes_short_way(const RobotModel& robot,
                                                    const JointCoordinate& coordinate);

/// The position of a coordinate that nothing else states: 0, or the limit next to it.
///
/// A floating joint is at the identity.
///
/// @param index  of the coordinate in the joint
/// @returns  [rad or m]
[[nodiscard]] FIRSTCONTACT_API double default_position(const Joint& joint, std::size_t index = 0);

/// The number of coordinates that trajectories have of a joint: 7 of a floating one.
[[nodiscard]] FIRSTCONTACT_API std::size_t position_count(JointType type);

/// The index of a floating joint's coordinate by the ending of its name, such as "rot_w"; none for
/// other texts.
[[nodiscard]] FIRSTCONTACT_API std::optional<std::size_t> pose_index(std::string_view ending);

/// The pose of seven positions of a floating joint, in their order.
[[nodiscard]] FIRSTCONTACT_API Pose pose_of_positions(std::span<const double> positions);

/// The seven positions of a floating joint at a pose, in their order.
[[nodiscard]] FIRSTCONTACT_API std::array<double, 7> positions_of_pose(const Pose& pose);

/// The way that a continuous joint, or the angle of a planar one, went along a trajectory.
struct JointTurn {
  std::string joint;    ///< As trajectories name the coordinate.
  double from = 0.0;    ///< [rad]  Position at the first point.
  double to = 0.0;      ///< [rad]  Position at the last point.
  double turned = 0.0;  ///< [rad]  From the first point to the last; `to` - `from` as given.
  Turning turning = Turning::as_given;
  /// Whether a step between two points is of more than half a turn, so that the two ways differ.
  bool differs = false;
};

/// The turns of all such joints that the trajectory names and that move, in its order.
///
/// @throws std::invalid_argument if the robot does not have a joint
[[nodiscard]] FIRSTCONTACT_API std::vector<JointTurn> joint_turns(const RobotModel& robot,
                                                                  const Trajectory& trajectory);

/// The word of a way to turn: "long" or "short".
[[nodiscard]] FIRSTCONTACT_API const char* to_string(Turning turning);

/// The way to turn that a word names.
///
/// @throws std::invalid_argument  names both words
[[nodiscard]] FIRSTCONTACT_API Turning turning_of(std::string_view word);

/// The joint motions of a robot over a scene, and the coordinates at default positions.
struct TrajectoryMotion {
  std::map<std::string, JointMotion> joints;  ///< As RobotMotion takes them.
  /// The coordinates that neither the trajectory nor the given positions name.
  ///
  /// They rest at their default positions.
  std::vector<std::string> at_default;
};

/// Makes joint motions over step time t = time / duration.
///
/// Quotients of times are rounded to doubles, and so are velocities and accelerations per step.
/// Certificates hold for the rounded numbers.
///
/// Coordinates that the trajectory does not name rest at `held`, else at default_position(). A
/// joint that mimics another may be named as long as its positions agree to 1e-6, the rounding of
/// six digits. It follows the other exactly. Ball joints rest at the identity.
///
/// @param held      positions of coordinates that the trajectory does not name
/// @param duration  [s]  > 0, at least the last time
/// @throws std::invalid_argument  names the joint
[[nodiscard]] FIRSTCONTACT_API TrajectoryMotion joint_motions(const RobotModel& robot,
                                                              const Trajectory& trajectory,
                                                              const JointPositions& held,
                                                              double duration);

}  // namespace firstcontact
