/// @file
/// The options that ask about one robot without a scene file.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <firstcontact/scene/scene.h>

namespace firstcontact::app {

/// What the command line says of a robot; paths as they were written.
struct RobotArguments {
  std::string robot;  ///< Empty where none is asked about.
  std::string srdf;
  std::string trajectory;
  std::string request;
  std::vector<std::string> start;
  std::vector<std::string> goal;
  std::vector<std::string> state;
  std::vector<std::string> environment;
  std::vector<std::string> package_roots;
  std::optional<double> padding;            ///< [m]
  std::optional<double> tracking_error;     ///< [rad or m]
  std::optional<double> environment_scale;  ///< [-]
  bool visual = false;
  bool visual_where_missing = false;
  std::string turning;  ///< "long", "short", or empty.
  bool unwrap = false;
};

/// What the robot is for.
enum class RobotUse { check, plan, retime };

/// Adds the options with texts for their use. Those that a plan refuses are not listed by its help.
void add_robot_options(CLI::App& command, RobotArguments& arguments,
                       RobotUse use = RobotUse::check);

/// All files that the arguments name.
[[nodiscard]] std::vector<std::string> files_of(const RobotArguments& arguments);

/// A scene says of its robots itself what these options say: they must not be lost in silence.
///
/// @throws std::invalid_argument, the first that is given beside a scene
void require_no_option_of_a_robot(const RobotArguments& arguments);

/// The file that errors without a file of their own are about: the motion's, or the robot's.
[[nodiscard]] const std::string& named_in_errors(const RobotArguments& arguments);

/// @param plans  as RobotQuestion::plans
/// @throws ParseError, std::invalid_argument
[[nodiscard]] Scene read_robot_scene(const RobotArguments& arguments, const ReadingOptions& reading,
                                     bool plans = false);

}  // namespace firstcontact::app
