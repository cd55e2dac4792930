/// @file
/// The question to a planner about a scene: the mover, its start, its goals.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/contact_pair.h>
#include <firstcontact/scene/trajectory.h>

namespace firstcontact {

enum class Planner {
  /// Two trees of edges that grow towards each other: J. Kuffner, S. LaValle, "RRT-Connect", ICRA
  /// 2000. The free part of an edge that is blocked is kept.
  rrt_connect,
  /// A graph of places whose edges are only checked along the shortest path.
  ///
  /// R. Bohlin, L. Kavraki, "Path planning using lazy PRM", ICRA 2000. The numbers of neighbours
  /// are
  /// those of S. Karaman, E. Frazzoli, "Sampling-based algorithms for optimal motion planning",
  /// IJRR
  /// 30 (2011).
  lazy_prm_star,
};

/// Its words in files and in Python, in this order.
inline constexpr std::array<const char*, 2> kPlannerWords{"rrt_connect", "lazy_prm_star"};

/// A goal of a robot: a frame T of one of its links at a pose.
struct LinkGoal {
  std::string link = {};  ///< ROBOT/LINK where several robots are planned; the others stay.
  Pose X_LT = {};         ///< T, fixed in the link.
  Pose X_WT = {};         ///< Where T is to be.
  double position_tolerance = 1e-6;  ///< [m]  > 0
  double rotation_tolerance = 1e-6;  ///< [rad]  > 0; pi or more: any rotation will do.
};

/// The answer of RRT-Connect to a blocked edge: S. Redon, M. Lin, "Practical local planning in
/// the contact space", ICRA 2005.
enum class ContactUse {
  none,    ///< It keeps the free part of the edge.
  sample,  ///< The place of the contact becomes a place of the tree.
  slide,   ///< It goes on along the contacts.
  both,    ///< It slides, and moves from places in contact in random directions.
};

/// Its words in files and in Python, in this order.
inline constexpr std::array<const char*, 4> kContactUseWords{"none", "sample", "slide", "both"};

/// A path that is asked for, of robots or of a body of the scene.
///
/// Coordinates are called as in trajectories; ROBOT/NAME where several robots are planned.
struct PlanQuestion {
  std::vector<std::size_t> robots = {};  ///< Of the scene, each once; or a body.
  std::optional<std::size_t> body = {};
  std::vector<std::string> joints = {};  ///< That are planned; without any, those that goals name.
  JointPositions start = {};             ///< Of a robot; others begin where the scene has them.
  std::vector<JointPositions> goals = {};  ///< Joints that they do not name keep their start.
  /// [rad/s or m/s]  Among surroundings that move: by coordinates, else those of the URDF; of a
  /// body "linear" and "angular".
  std::map<std::string, double> speeds = {};
  std::vector<LinkGoal> link_goals = {};  ///< Beside `goals`: any one of all will do.
  std::map<std::string, std::array<double, 2>> bounds = {};  ///< [rad or m]  By coordinates.
  std::optional<Pose> start_pose = {};  ///< Of a body; else where the scene has it.
  std::vector<Pose> goal_poses = {};    ///< Of a body.
  /// [m]  Corners of the box in which the body's origin stays; else around all that there is.
  std::optional<std::array<Eigen::Vector3d, 2>> box = {};
  std::optional<double> margin = {};            ///< [m]  In place of the scene's; >= 0.
  std::vector<ContactPair> contact_pairs = {};  ///< Each pair of members once.
  std::optional<Planner> planner = {};
  std::optional<ContactUse> contacts = {};
  std::optional<std::uint64_t> seed = {};
  std::optional<double> time = {};  ///< [s]  > 0.
};

}  // namespace firstcontact
