/// @file
/// A path that is proven edge by edge, with the scene in which it is: what a path file holds.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/scene/contact_pair.h>
#include <firstcontact/scene/plan_question.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact {

/// Two members of a scene by name, and how many edges and places they ended.
struct NamedBlockingPair {
  std::array<std::string, 2> pair;
  std::size_t count = 0;
};

/// A pair of members by name that is in contact at an end of a path.
struct NamedContactPair {
  std::array<std::string, 2> pair = {};
  ContactPolicy policy = ContactPolicy::may_stay;
  PathEnd at = PathEnd::start;
  /// [m]  The pair is farther apart than this where the policy takes the place of its margin.
  double distance = 0.0;
};

/// A file from which the scene of a path was made, such as a planning scene or a mesh.
struct PathSource {
  std::filesystem::path file;  ///< As it was opened, or is found beside the path that was read.
  std::string digest;          ///< SHA-256, in hexadecimal.
};

/// How a path was found; see docs/path_format.md.
struct PlannedPathStatistics {
  double seconds = 0.0;                           ///< [s]
  std::optional<double> first_path_seconds = {};  ///< [s]
  std::size_t iterations = 0;
  std::size_t nodes = 0;
  std::size_t edges_checked = 0;
  std::size_t states_checked = 0;
  std::size_t undecided = 0;
  std::optional<double> first_cost = {};
  std::vector<NamedBlockingPair> blocked = {};  ///< The most frequent first.
};

/// The contents of a path file. Numbers are those of the file, bit for bit.
struct PlannedPath {
  bool is_proven = false;  ///< Else approximate: its edges are proven, but it ends before a goal.
  std::vector<std::string> robots = {};  ///< Robots that move; empty where a body does alone.
  std::string body = {};                 ///< Body that moves; empty where robots do alone.
  /// Names of the coordinates of waypoints; ROBOT/NAME where several movers move. Beside robots a
  /// body has those of a floating joint, BODY/trans_x and so on.
  std::vector<std::string> joints = {};
  std::vector<Turning> turnings = {};  ///< The way of each coordinate.
  /// At least one. That of a body alone is a position, then a quaternion w, x, y, z.
  std::vector<std::vector<double>> waypoints = {};
  /// [s]  Time of each waypoint, from 0 to the duration of the scene, where the environment moves;
  /// else empty.
  std::vector<double> times = {};
  /// [m]  Proven lower bound of the distance of tested pairs along each edge; none where no pair is
  /// tested.
  std::vector<std::optional<double>> clearances = {};
  double margin = 0.0;                   ///< [m]
  double tolerance = 1e-6;               ///< [m]
  double extra_clearance = 0.0;          ///< [m]
  std::optional<double> clearance = {};  ///< [m]  The least of `clearances`, or that of the only
                                         ///< waypoint.
  std::vector<NamedContactPair> contact_pairs = {};
  std::vector<std::vector<double>> goals = {};
  std::optional<std::size_t> goal = {};
  double distance_to_goal = 0.0;
  double cost = 0.0;
  Planner planner = Planner::rrt_connect;
  ContactUse contacts = ContactUse::none;
  std::uint64_t seed = 1;
  double time = 1.0;  ///< [s]
  PlannedPathStatistics statistics = {};
  /// The whole scene, with the movers at their starts.
  ///
  /// Its text_digest is that of the text from which the path was planned.
  Scene scene = {};
  std::vector<PathSource> sources = {};  ///< Files of the scene, where they are known.
  std::string version = {};
  std::string input_digest = {};  ///< SHA-256 of everything read, in hexadecimal.
};

}  // namespace firstcontact
