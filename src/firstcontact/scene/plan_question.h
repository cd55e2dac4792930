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

/// The method of a planner.
enum class Planner {
  /// Two trees of edges that grow towards each other.
  ///
  /// Where an edge is blocked, its free part is kept. Source: J. Kuffner, S. LaValle,
  /// "RRT-Connect", ICRA 2000.
  rrt_connect,
  /// A graph of places whose edges are only checked along the shortest path.
  ///
  /// Source: R. Bohlin, L. Kavraki, "Path planning using lazy PRM", ICRA 2000. The numbers of
  /// neighbours are those of S. Karaman, E. Frazzoli, "Sampling-based algorithms for optimal motion
  /// planning", IJRR 30 (2011).
  lazy_prm_star,
};

/// The words of Planner in files and in Python, in this order.
inline constexpr std::array<const char*, 2> kPlannerWords{"rrt_connect", "lazy_prm_star"};

/// A goal of a robot: a frame T of one of its links at a pose.
struct LinkGoal {
  std::string link = {};  ///< Link as ROBOT/LINK where several robots are planned; the other robots
                          ///< stay.
  Pose X_LT = {};         ///< Pose of T, which is fixed in the link.
  Pose X_WT = {};         ///< Pose that T is to have.
  double position_tolerance = 1e-6;  ///< [m]  > 0
  double rotation_tolerance = 1e-6;  ///< [rad]  > 0; with pi or more any rotation is accepted.
};

/// The answer of RRT-Connect to a blocked edge.
///
/// Source: S. Redon, M. Lin, "Practical local planning in the contact space", ICRA 2005.
enum class ContactUse {
  none,    ///< It keeps the free part of the edge.
  sample,  ///< The place of the contact becomes a place of the tree.
  slide,   ///< It goes on along the contacts.
  both,    ///< It slides, and moves from places in contact in random directions.
};

/// The words of ContactUse in files and in Python, in this order.
inline constexpr std::array<const char*, 4> kContactUseWords{"none", "sample", "slide", "both"};

/// A path that is asked for, of robots or of a body of the scene, or of both.
///
/// Coordinates are called as in trajectories; ROBOT/NAME where several movers are planned. Beside
/// robots a body has those of a floating joint: BODY/trans_x and so on, in the world.
struct PlanQuestion {
  std::vector<std::size_t> robots = {};  ///< Robots of the scene, each once.
  std::optional<std::size_t> body = {};  ///< A body that moves, alone or at once with robots.
  std::vector<std::string> joints = {};  ///< Coordinates that are planned; without any, those that
                                         ///< goals name.
  JointPositions start = {};  ///< Start of a robot; coordinates that it does not name begin where
                              ///< the scene has them.
  std::vector<JointPositions> goals = {};  ///< Goals; joints that they do not name keep their
                                           ///< start.
  /// [rad/s or m/s]  Speeds for an environment that moves, by coordinate; else those of the URDF.
  ///
  /// A body has "linear" and "angular".
  std::map<std::string, double> speeds = {};
  std::vector<LinkGoal> link_goals = {};  ///< Goals beside `goals`; the path ends at any one of
                                          ///< all.
  std::map<std::string, std::array<double, 2>> bounds = {};  ///< [rad or m]  Bounds by coordinate.
  std::optional<Pose> start_pose = {};  ///< Start of a body alone; else its pose in the scene.
  std::vector<Pose> goal_poses = {};    ///< Goals of a body alone.
  bool lists_goals = false;             ///< Whether the file has `goals`, a list, of one or more.
  /// [m]  Corners of the box in which the body's origin stays; by default the box is around the
  /// whole scene.
  std::optional<std::array<Eigen::Vector3d, 2>> box = {};
  std::optional<double> margin = {};            ///< [m]  Margin in place of the scene's; >= 0.
  std::vector<ContactPair> contact_pairs = {};  ///< Each pair of members once.
  std::optional<Planner> planner = {};
  std::optional<ContactUse> contacts = {};
  std::optional<std::uint64_t> seed = {};
  std::optional<double> time = {};  ///< [s]  > 0.
};

}  // namespace firstcontact
