/// @file
/// The space in which a planner moves: the coordinates of robots' joints, and poses of floating
/// joints or of bodies.

#pragma once

#include <array>
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

/// A point of a space: one number for each coordinate of joints [rad or m], then seven for each
/// pose.
///
/// A pose has its position [m] and then its quaternion w, x, y, z: of a body in the world, of a
/// floating joint in the joint's frame.
using Configuration = std::vector<double>;

/// The configuration of a body at a pose.
[[nodiscard]] FIRSTCONTACT_API Configuration configuration_of(const Pose& pose);

/// One number of a configuration of joints.
struct SpaceCoordinate {
  std::string name;    ///< The name that trajectories use; ROBOT/NAME where several robots move.
  double lower = 0.0;  ///< [rad or m]  Least value of a sample.
  double upper = 0.0;  ///< [rad or m]  Greatest value of a sample.
  bool has_limits = true;    ///< Whether configurations beyond the two are refused.
  bool slides = false;       ///< Whether it moves along an axis, in place of turning.
  bool turns_short = false;  ///< Whether edges turn by at most half a turn: Turning::shortest.
  std::size_t mover = 0;     ///< Index of the mover in the space.
  std::size_t joint = 0;     ///< Index of the joint in the mover's model.
  std::size_t index = 0;     ///< Index of the coordinate in the joint; up to 2 for planar joints.
};

/// Seven numbers of a configuration: the pose of a body, or of a floating joint.
struct SpacePose {
  std::string name;       ///< Of the joint, or of the body; ROBOT/NAME where several movers move.
  std::size_t mover = 0;  ///< Index of the mover in the space.
  std::optional<std::size_t> joint = {};           ///< Index in the mover's model; none for a body.
  Eigen::Vector3d low = Eigen::Vector3d::Zero();   ///< [m]  Least position of a sample.
  Eigen::Vector3d high = Eigen::Vector3d::Zero();  ///< [m]  Greatest position of a sample.
  std::array<bool, 3> has_limits = {true, true, true};  ///< Whether the box ends along x, y, z.
};

/// The edges of a body.
enum class BodyEdges {
  straight,  ///< The origin on a line, the turn at a constant rate: Motion::constant_velocity().
  screw,     ///< A screw by the shortest rotation: Motion::screw().
};

/// The movers of a plan: their coordinates, their motions along an edge, the distance of two
/// places. Immutable.
///
/// A mover is a robot, or a body. An edge takes every coordinate of joints from its first number to
/// its second one at a constant rate. A body, and what a floating joint moves, has its origin on a
/// line and turns at a constant rate by the shortest rotation. A body alone may move on a screw:
/// BodyEdges. All other joints of a robot rest.
class FIRSTCONTACT_API ConfigurationSpace {
 public:
  /// Makes the space of some coordinates of a robot; the other ones rest where `held` has them.
  ///
  /// The limits are those of the joints. A revolute or planar joint without limits is sampled over
  /// one turn. A floating joint is planned as a whole, by its own name. It has no box at first.
  ///
  /// @param names  of coordinates, as find_coordinate() takes them, or of floating joints; at least
  ///               one
  /// @param held   every joint that moves, at rest; the position of a named joint has no effect
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

  /// Makes the space of poses of a body that moves in a plane: OMPL's SE2StateSpace.
  ///
  /// The body is the link "body" of a robot of its own, behind a planar joint "plane" with the axis
  /// z. The coordinates are plane/x, plane/y [m] and plane/theta [rad], which goes the short way.
  ///
  /// @param low, high  [m]  corners of the rectangle in which the origin stays, in the base's frame
  /// @param base       the place of the plane in the world
  /// @throws std::invalid_argument if the rectangle is empty or not finite, or the shape deforms
  static ConfigurationSpace of_body_in_plane(const std::string& name, const Shape& shape,
                                             const Eigen::Vector2d& low,
                                             const Eigen::Vector2d& high,
                                             Motion base = Motion::fixed());

  /// Makes the space in which several robots and bodies move at once: the coordinates of one after
  /// the other, then their poses.
  ///
  /// @param names   of the movers; coordinates are called ROBOT/NAME, and bodies by their names
  /// @param spaces  of one mover each, as many as names
  /// @throws std::invalid_argument if there are no spaces, or not one for each name; if a space has
  ///         several movers, or screws
  static ConfigurationSpace joined(std::span<const std::string> names,
                                   std::span<const ConfigurationSpace> spaces);

  /// The count of numbers of a configuration; 7 for a body.
  [[nodiscard]] std::size_t size() const { return coordinates_.size() + 7 * poses_.size(); }
  /// The count of independent rates: 6 of each pose.
  [[nodiscard]] std::size_t dimension() const { return coordinates_.size() + 6 * poses_.size(); }
  /// Whether the only mover is a body.
  [[nodiscard]] bool is_body() const { return movers_.size() == 1 && is_body(0); }
  /// Whether a mover is a body.
  [[nodiscard]] bool is_body(std::size_t mover) const { return !movers_[mover].rest.has_value(); }
  /// Whether edges are screws of a body.
  [[nodiscard]] bool has_screws() const { return edges_ == BodyEdges::screw; }
  /// The number of robots and bodies that move.
  [[nodiscard]] std::size_t mover_count() const { return movers_.size(); }
  [[nodiscard]] const RobotModel& model(std::size_t mover = 0) const {
    return movers_[mover].model;
  }
  /// The coordinates of joints; empty for a body.
  [[nodiscard]] std::span<const SpaceCoordinate> coordinates() const { return coordinates_; }
  /// The poses of bodies and floating joints.
  [[nodiscard]] std::span<const SpacePose> poses() const { return poses_; }
  /// The index of a pose's first number in a configuration.
  [[nodiscard]] std::size_t begin_of_pose(std::size_t pose) const {
    return coordinates_.size() + 7 * pose;
  }
  /// The name of a number of a configuration, as trajectories call it: JOINT/rot_w for a pose.
  [[nodiscard]] std::string number_name(std::size_t number) const;

  /// Finds why `q` is no configuration of the space, and names the coordinate; none where `q` is
  /// one.
  ///
  /// A number beyond a limit by at most 1e-9 counts as within it.
  [[nodiscard]] std::optional<std::string> defect(const Configuration& q) const;

  /// Whether a place is where samples lie: a body in its box, joints with limits within these.
  [[nodiscard]] bool holds(const Configuration& q) const;

  /// The length of an edge.
  ///
  /// It is the Euclidean length [rad and m alike]. A floating joint has a distance and an angle. A
  /// body has the path length of its origin plus its reach times the angle [m].
  [[nodiscard]] double distance(const Configuration& from, const Configuration& to) const;

  /// The place at a share of an edge, rounded to doubles. Bit for bit an end for a share of 0 or 1.
  [[nodiscard]] Configuration interpolate(const Configuration& from, const Configuration& to,
                                          double share) const;

  /// [m]  A bound of the distance between an edge and its pieces through rounded places.
  ///
  /// It holds for every point of the movers. It is infinite for screws, whose axes may be far away.
  /// It is infinite for half a turn of a body too: a piece of it may turn the other way. The errors
  /// of several movers are added up, as two of them may be a pair.
  ///
  /// Positions count once. Angles count with the length that they turn: the reach of a body, or the
  /// stretched-out length of a robot.
  ///
  /// @param carried  [m]  how far a body that the robot holds reaches from the links that hold it
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
  /// @param speeds  [rad/s or m/s]  of each coordinate, then two of each pose: of its origin [m/s],
  ///                and of its turn [rad/s]; speed_count() numbers
  [[nodiscard]] double travel_time(const Configuration& from, const Configuration& to,
                                   std::span<const double> speeds) const;

  /// The count of speeds that travel_time() takes.
  [[nodiscard]] std::size_t speed_count() const { return coordinates_.size() + 2 * poses_.size(); }

  /// Draws a place evenly: joints within their limits; poses within the box, turned in any way.
  [[nodiscard]] Configuration sample(RandomNumbers& random) const;

  /// [m]  The lower corner of the box in which the origin of the first pose is sampled; 0 for
  /// joints.
  [[nodiscard]] Eigen::Vector3d low() const {
    return poses_.empty() ? Eigen::Vector3d::Zero() : poses_.front().low;
  }
  /// [m]  The upper corner of that box; 0 for joints.
  [[nodiscard]] Eigen::Vector3d high() const {
    return poses_.empty() ? Eigen::Vector3d::Zero() : poses_.front().high;
  }

  /// Whether the positions of all poses are in the boxes in which they are sampled.
  [[nodiscard]] bool is_in_box(const Configuration& q) const;

  /// Widens the sampled range of joints without limits, so that it holds a configuration.
  void include(const Configuration& q);

  /// Sets the limits of a coordinate of joints, within its own limits where it has some. Those of
  /// a floating joint's JOINT/trans_x, trans_y and trans_z make its box.
  ///
  /// @param name  of the coordinate
  /// @throws std::invalid_argument if the space has no such coordinate, or lower > upper, or one of
  ///         them is not finite
  void set_limits(const std::string& name, double lower, double upper);

  /// Finds the name of a coordinate that slides without limits, or that of a pose without a box; no
  /// sample can be drawn from it.
  [[nodiscard]] std::optional<std::string> unbounded() const;

 private:
  struct Mover {
    RobotModel model;
    // [m]  The reach of a body from its origin; the stretched-out length of a robot.
    double reach = 0.0;
    std::optional<RobotMotion> rest;  // The motion of a robot with every joint held; not of a body.
  };

  ConfigurationSpace() = default;
  explicit ConfigurationSpace(RobotModel model);

  void add_coordinate(const std::string& name);
  void add_pose(std::size_t joint);
  /// The pose of a body that moves.
  [[nodiscard]] std::size_t pose_of_mover(std::size_t mover) const;
  [[nodiscard]] double pose_distance(std::size_t pose, const Configuration& from,
                                     const Configuration& to) const;
  [[nodiscard]] double pose_rounding(std::size_t pose, const std::vector<double>& sizes,
                                     double lever) const;
  [[nodiscard]] Motion pose_motion(std::size_t pose, const Configuration& from,
                                   const Configuration& to) const;
  [[nodiscard]] Motion pose_motion(std::size_t pose, std::span<const Configuration> places,
                                   std::span<const double> times) const;
  bool set_box(const std::string& name, double lower, double upper);

  std::vector<Mover> movers_;
  std::vector<SpaceCoordinate> coordinates_;  // The coordinates of one mover stand together.
  std::vector<SpacePose> poses_;              // So do its poses.
  BodyEdges edges_ = BodyEdges::straight;
};

}  // namespace firstcontact
