/// @file
/// The path that is to be timed: from a path file (docs/path_format.md), or from a scene.

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/retiming/retiming_scene.h>
#include <firstcontact/retiming/waypoint_path.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact {

/// A path of one robot or several in a scene.
struct RetimingPath {
  Scene scene = {};
  std::vector<std::size_t> robots = {0};  ///< The robots of the scene that move.
  /// The path, whose numbers go the way that the joints turn. Joints are ROBOT/NAME where several
  /// robots move.
  WaypointPath path = {};
  /// The last waypoint as its file has it. The numbers of joints that go the short way may be whole
  /// turns away from those of `path`.
  std::vector<double> named_end = {};
  /// Pairs that are in contact at an end of the path, and the distances that they are held to.
  std::vector<NamedContactPair> contact_pairs = {};
  std::string input_digest = {};  ///< Digest of all files that the path was planned with; empty
                                  ///< where it was not planned.
  std::vector<PathSource> sources = {};  ///< The files that it was planned from.
  bool is_approximate = false;           ///< It ends before its goal.
};

/// Reads the part of a path file that retiming needs from its text.
///
/// @param name  the file of the text, for errors
/// @throws ParseError  where it is no path, or one of a body, or does not begin where its scene has
///                     the robots
[[nodiscard]] FIRSTCONTACT_API RetimingPath parse_retiming_path(std::string_view text,
                                                                const std::string& name,
                                                                const ReadingOptions& options = {});

/// Takes the path of a robot from a scene: the positions of its trajectory, without their times.
///
/// @param robot  its name; may be empty where the scene has only one
/// @throws std::invalid_argument if there is none, or the robot has no trajectory
[[nodiscard]] FIRSTCONTACT_API RetimingPath retiming_path_of(Scene scene,
                                                             const std::string& robot = {});

/// Reads a path file, or the path of a robot from a scene file.
///
/// @param robot  as retiming_path_of(). For a path file: empty, or the one robot that it moves.
/// @throws ParseError  The path may move another robot than `robot`, or several.
[[nodiscard]] FIRSTCONTACT_API RetimingPath read_retiming_path(const std::filesystem::path& file,
                                                               const std::string& robot = {},
                                                               const ReadingOptions& options = {});

/// Reads the text of a path file or of a scene file, as read_retiming_path() reads the file.
///
/// @param file  the file of the text: named in errors; relative paths begin in its folder
[[nodiscard]] FIRSTCONTACT_API RetimingPath parse_path_or_scene(std::string_view text,
                                                                const std::filesystem::path& file,
                                                                const std::string& robot = {},
                                                                const ReadingOptions& options = {});

/// A scene with the findings of its loading, ready for proofs.
struct LoadedRetimingScene {
  LoadedScene loaded;
  RetimingScene where;
};

/// Loads the scene of a path.
///
/// @throws std::invalid_argument if a file of the scene has changed since the path was planned, or
///         anything but its robots moves, or a contact pair is not tested
[[nodiscard]] FIRSTCONTACT_API LoadedRetimingScene load_retiming_scene(const RetimingPath& input,
                                                                       ShapeCache& cache);

}  // namespace firstcontact
