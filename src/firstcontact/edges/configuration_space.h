/// @file
/// The space in which a planner moves: the coordinates of robots' joints, or the pose of a body.

#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/robot/robot_motion.h>

namespace firstcontact {

class RandomNumbers;

/// A point of a space: one number for each coordinate of joints [rad or m].
///
/// A body has its position [m] and then its quaternion w, x, y, z, both in the world.
using Configuration = std::vector<double>;

/// The configuration of a body at a pose.
[[nodiscard]] FIRSTCONTACT_API Configuration configuration_of(const Pose& pose);

/// One number of a configuration of joints.
struct SpaceCoordinate {
  std::string name;          ///< As trajectories call it; ROBOT/NAME where several robots move.
  double lower = 0.0;        ///< [rad or m]  Samples lie between these two.
  double upper = 0.0;        ///< [rad or m]
  bool has_limits = true;    ///< Whether configurations beyond the two are refused.
  bool slides = false;       ///< Along an axis, in place of turning.
  bool turns_short = false;  ///< Edges take the way of at most half a turn: Turning::shortest.
  std::size_t mover = 0;     ///< Of the space.
  std::size_t joint = 0;     ///< Of the mover's model.
  std::size_t index = 0;     ///< Of the coordinate in it; up to 2 for planar joints.
};

/// The edges of a body.
enum class BodyEdges {
  straight,  ///< The origin on a line, the turn at a constant rate: Motion::constant_velocity().
  screw,     ///< A screw by the shortest rotation: Motion::screw().
};

/// The movers of a plan: their coordinates, their motions along an edge, the distance of two
/// places.
///
/// A mover is a robot, or the only body. An edge takes every coordinate of joints from its first
/// number to its second one at a constant rate. A body moves its origin on a line and turns at a
/// constant rate by the shortest rotation, or moves on a screw: BodyEdges. All else that a robot
/// has rests. Immutable.
class FIRSTCONTACT_API ConfigurationSpace {
 public:
  /// Makes the space of some coordinates of a robot; the other ones rest where `held` has them.
  ///
  /// The limits are those of the joints. A revolute or planar joint without limits is sampled over
  /// one turn.
  ///
  /// @param names  of coordinates, as find_coordinate() takes them; at least one
  /// @param held   every joint that moves, at rest; its place does not matter for the names
  /// @throws std::invalid_argument  names the joint: unknown, fixed, mimicking another, named
  ///         twice, or not held
  static ConfigurationSpace of_joints(RobotModel model, std::span<const std::string> names,
                                      std::map<std::string, JointMotion> held,
                                      Motion base = Motion::fixed());

  /// Makes the space of poses of a body whose origin stays in a box.
  ///
  /// The body is the only link, "body", of a robot of its own that has no joints.
  ///
  /// @param low, high  [m]  corners of the box, in the world
  /// @param edges      path files hold straight ones only
  /// @throws std::invalid_argument if the box is empty or not finite, or the shape deforms
  static ConfigurationSpace of_body(const std::string& name, const Shape& shape,
                                    const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                                    BodyEdges edges = BodyEdges::straight);

  /// Makes the space in which several robots move at once: the coordinates of one after the other.
  ///
  /// @param names   of the robots; coordinates are called ROBOT/NAME
  /// @param spaces  of joints of one robot each, as many as names
  /// @throws std::invalid_argument if there are no spaces, or not one for each name; if a space is
  /// of
  ///         a body or of several robots
  static ConfigurationSpace joined(std::span<const std::string> names,
                                   std::span<const ConfigurationSpace> spaces);

  /// Numbers of a configuration; 7 for a body.
  [[nodiscard]] std::size_t size() const { return is_body_ ? 7 : coordinates_.size(); }
  [[nodiscard]] bool is_body() const { return is_body_; }
  /// Whether edges are screws of a body.
  [[nodiscard]] bool has_screws() const { return edges_ == BodyEdges::screw; }
  /// How many robots move; 1 for a body.
  [[nodiscard]] std::size_t mover_count() const { return movers_.size(); }
  [[nodiscard]] const RobotModel& model(std::size_t mover = 0) const {
    return movers_[mover].model;
  }
  /// The coordinates of joints; empty for a body.
  [[nodiscard]] std::span<const SpaceCoordinate> coordinates() const { return coordinates_; }

  /// A reason why something is no configuration of the space, with the name of the coordinate; none
  /// where it is one. Beyond a limit by no more than 1e-9 is within it.
  [[nodiscard]] std::optional<std::string> defect(const Configuration& q) const;

  /// Whether a place is where samples lie: a body in its box, joints with limits within these.
  [[nodiscard]] bool holds(const Configuration& q) const;

  /// The length of an edge.
  ///
  /// That of joints is Euclid's [rad and m alike]. That of a body is the way of its origin plus its
  /// reach times the angle [m].
  [[nodiscard]] double distance(const Configuration& from, const Configuration& to) const;

  /// The place at a share of an edge, rounded to doubles; bit for bit an end for a share of 0 or 1.
  [[nodiscard]] Configuration interpolate(const Configuration& from, const Configuration& to,
                                          double share) const;

  /// [m]  A bound of how far any point of an edge's piece between rounded places may be from the
  /// edge itself. Infinite for screws, whose axes may be far away, and for half a turn of a body: a
  /// piece of it may take the other way. The errors of several movers are added up, as two of them
  /// may be a pair.
  ///
  /// Positions count once. Angles count with the length of what they turn: the reach of a body, or
  /// a robot drawn out.
  ///
  /// @param carried  [m]  how far what the robot holds reaches from the links that hold it
  [[nodiscard]] double rounding_bound(const Configuration& from, const Configuration& to,
                                      double carried = 0.0) const;

  /// The motion of a mover along an edge, t in [0, 1].
  [[nodiscard]] RobotMotion motion(const Configuration& from, const Configuration& to,
                                   std::size_t mover = 0) const;

  /// The motion through several places, t in [0, 1]; at rest before the first and after the last.
  ///
  /// @param times  [-]  in [0, 1], strictly increasing, as many as places
  [[nodiscard]] RobotMotion motion(std::span<const Configuration> places,
                                   std::span<const double> times, std::size_t mover = 0) const;

  /// [s]  The least time for an edge at given speeds.
  ///
  /// @param speeds  [rad/s or m/s]  of each coordinate; of a body two: of its origin [m/s], and of
  ///                its turn [rad/s]
  [[nodiscard]] double travel_time(const Configuration& from, const Configuration& to,
                                   std::span<const double> speeds) const;

  /// A place drawn evenly: within the limits; of poses within the box, turned in any way.
  [[nodiscard]] Configuration sample(RandomNumbers& random) const;

  /// [m]  Corners of the box in which the origin of a body is sampled; 0 of joints.
  [[nodiscard]] const Eigen::Vector3d& low() const { return low_; }
  [[nodiscard]] const Eigen::Vector3d& high() const { return high_; }

  /// Whether the place of a body is in the box in which it is sampled; true of joints.
  [[nodiscard]] bool is_in_box(const Configuration& q) const;

  /// Widens what is sampled of joints without limits, so that it holds a configuration.
  void include(const Configuration& q);

  /// Sets the limits of a coordinate of joints, within its own where it has some.
  ///
  /// @param name  of the coordinate
  /// @throws std::invalid_argument if the space has no such coordinate, or lower > upper, or one of
  ///         them is not finite
  void set_limits(const std::string& name, double lower, double upper);

  /// The name of a coordinate that slides without limits, so that nothing can be drawn from it.
  [[nodiscard]] std::optional<std::string> unbounded() const;

 private:
  struct Mover {
    RobotModel model;
    double reach = 0.0;  // [m]  Of a body from its origin; of a robot, how long it can be.
    std::optional<RobotMotion> rest;  // Of a robot, with every joint held.
  };

  ConfigurationSpace() = default;
  explicit ConfigurationSpace(RobotModel model);

  [[nodiscard]] std::optional<std::string> defect_of_body(const Configuration& q) const;
  [[nodiscard]] Motion body_motion(const Configuration& from, const Configuration& to) const;

  std::vector<Mover> movers_;
  std::vector<SpaceCoordinate> coordinates_;  // Those of a mover together.
  bool is_body_ = false;
  BodyEdges edges_ = BodyEdges::straight;
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();   // [m]
  Eigen::Vector3d high_ = Eigen::Vector3d::Zero();  // [m]
};

}  // namespace firstcontact
