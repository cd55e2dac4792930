/// @file
/// The options for a question about one robot without a scene file.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <firstcontact/scene/scene.h>

namespace firstcontact::app {

/// The arguments of the command line about a robot; paths as they were written.
struct RobotArguments {
  std::string robot;  ///< Empty where there is no robot.
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

/// The use of the robot.
enum class RobotUse { check, plan, retime };

/// Adds the options with texts for their use. The help does not list those that a plan refuses.
void add_robot_options(CLI::App& command, RobotArguments& arguments,
                       RobotUse use = RobotUse::check);

/// All files that the arguments name.
[[nodiscard]] std::vector<std::string> files_of(const RobotArguments& arguments);

/// Refuses these options beside a scene, which has its own robots: they must not be lost in
/// silence.
///
/// @throws std::invalid_argument  names the first option that is given beside a scene
void require_no_option_of_a_robot(const RobotArguments& arguments, RobotUse use = RobotUse::check);

/// The file that errors name which have no file of their own: the motion's, or the robot's.
[[nodiscard]] const std::string& named_in_errors(const RobotArguments& arguments);

/// Reads the scene of the arguments.
///
/// @param plans  as RobotQuestion::plans
/// @throws ParseError, std::invalid_argument
[[nodiscard]] Scene read_robot_scene(const RobotArguments& arguments, const ReadingOptions& reading,
                                     bool plans = false);

}  // namespace firstcontact::app
