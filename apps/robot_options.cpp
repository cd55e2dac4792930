#include "robot_options.h"

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/scene_files/robot_question.h>

#include "command_line_file.h"
#include "command_line_number.h"

namespace firstcontact::app {
namespace {

RobotSurface surface_of(const RobotArguments& arguments) {
  if (arguments.visual) {
    return RobotSurface::visual;
  }
  return arguments.visual_where_missing ? RobotSurface::collision_or_visual
                                        : RobotSurface::collision;
}

/// The texts that differ between uses.
struct RobotTexts {
  const char* robot;
  const char* trajectory;
  const char* request;
  const char* start;
};

RobotTexts texts_for(RobotUse use) {
  switch (use) {
    case RobotUse::check:
      break;
    case RobotUse::plan:
      return {"URDF: plans for this robot in place of a SCENE", "",
              "MoveIt request (.yaml): its start and goal; the goal may be the pose of a link",
              "Start of the path: state of the SRDF or JOINT=POSITION; repeatable; with --goal"};
    case RobotUse::retime:
      return {"URDF: times the motion of this robot in place of a PATH",
              "Its positions are the path, its times are not used: .csv (header: time and joint "
              "names), .json, or .yaml as ROS prints a JointTrajectory",
              "MoveIt request (.yaml): the path is the straight line from its start to its goal",
              "Start of a straight path: state of the SRDF or JOINT=POSITION; repeatable; with "
              "--goal"};
  }
  return {"URDF: checks this robot in place of a SCENE",
          ".csv (header: time and joint names), .json, or .yaml as ROS prints a JointTrajectory",
          "MoveIt request (.yaml): the motion is the straight line from its start to its goal",
          "Start of a straight motion at the joints' greatest speeds: state of the SRDF or "
          "JOINT=POSITION; repeatable; with --goal"};
}

}  // namespace

void add_robot_options(CLI::App& command, RobotArguments& arguments, RobotUse use) {
  const RobotTexts texts = texts_for(use);
  // A plan refuses these options with a reason, and its help does not list them.
  const char* const of_motion = use == RobotUse::plan ? "" : "Robot";
  const auto file = [&](const char* name, std::string& value, const char* text) {
    return add_file(command, name, value, text)->group("Robot");
  };
  const auto list = [&](const char* name, std::vector<std::string>& values, const char* type,
                        const char* text) {
    command.add_option(name, values, text)
        ->type_name(type)
        ->group("Robot")
        ->allow_extra_args(false);
  };
  file("--robot", arguments.robot, texts.robot);
  file("--srdf", arguments.srdf, "SRDF: pairs of links not to test, named states");
  file("--trajectory", arguments.trajectory, texts.trajectory)->group(of_motion);
  file("--request", arguments.request, texts.request);
  list("--start", arguments.start, "STATE", texts.start);
  list("--goal", arguments.goal, "STATE", "As --start");
  list("--state", arguments.state, "STATE",
       "Positions of joints that the motion does not name: as --start; 0 by default");
  command
      .add_option("--turning", arguments.turning,
                  "Motion of continuous joints. short: by at most half a turn. long: through all "
                  "numbers between. Default: short to a goal, as in MoveIt; long with --trajectory")
      ->check(CLI::IsMember(std::vector<std::string>(kTurningWords.begin(), kTurningWords.end())))
      ->group(of_motion);
  command
      .add_flag(
          "--unwrap", arguments.unwrap,
          "With --trajectory: removes jumps of whole turns from a recording whose angles wrap")
      ->group(of_motion);
  list("--environment", arguments.environment, "FILE",
       "Mesh, MoveIt planning scene (.yaml), or scene (.json) without robots; repeatable");
  list("--package-root", arguments.package_roots, "FOLDER",
       "Folder of the packages that the robot names as package://; repeatable");
  add_number(command, "--environment-scale", arguments.environment_scale, Range::positive,
             "Multiplies coordinates of environment meshes: 0.001 where they are in millimetres")
      ->group("Robot");
  add_number(command, "--padding", arguments.padding, Range::not_negative,
             "[m] Thickens every link")
      ->group("Robot");
  add_number(command, "--tracking-error", arguments.tracking_error, Range::not_negative,
             "[rad or m] Greatest difference between each joint and its motion, at any time")
      ->group("Robot");
  command
      .add_flag("--visual", arguments.visual,
                "Uses the visual geometry of links in place of their collision geometry")
      ->group("Robot");
  command
      .add_flag("--visual-where-missing", arguments.visual_where_missing,
                "Uses the visual geometry of links that have no collision geometry")
      ->group("Robot")
      ->excludes("--visual");
}

std::vector<std::string> files_of(const RobotArguments& arguments) {
  std::vector<std::string> files = arguments.environment;
  for (const std::string& file :
       {arguments.robot, arguments.srdf, arguments.trajectory, arguments.request}) {
    if (!file.empty()) {
      files.push_back(file);
    }
  }
  return files;
}

void require_no_option_of_a_robot(const RobotArguments& arguments, RobotUse use) {
  const bool plans = use == RobotUse::plan;
  struct Option {
    bool is_given;
    const char* name;
    const char* in_a_scene;
  };
  const std::array options{
      Option{!arguments.srdf.empty(), "--srdf", "robots[].srdf"},
      Option{!arguments.trajectory.empty(), "--trajectory", "robots[].trajectory"},
      Option{!arguments.request.empty(), "--request", plans ? "plan" : "robots[].trajectory"},
      Option{!arguments.start.empty(), "--start", plans ? "plan.start" : "robots[].trajectory"},
      Option{!arguments.goal.empty(), "--goal", plans ? "plan.goal" : "robots[].trajectory"},
      Option{!arguments.state.empty(), "--state", "robots[].state"},
      Option{!arguments.environment.empty(), "--environment", "bodies"},
      Option{arguments.environment_scale.has_value(), "--environment-scale",
             "\"scale\" of the mesh"},
      Option{!arguments.package_roots.empty(), "--package-root", "package_roots"},
      Option{arguments.padding.has_value(), "--padding", "robots[].padding"},
      Option{arguments.tracking_error.has_value(), "--tracking-error", "robots[].tracking_error"},
      Option{arguments.visual, "--visual", "robots[].surface"},
      Option{!arguments.turning.empty(), "--turning", "robots[].turning"},
      Option{arguments.unwrap, "--unwrap", "robots[].unwrap"},
      Option{arguments.visual_where_missing, "--visual-where-missing", "robots[].surface"}};
  for (const Option& option : options) {
    if (option.is_given) {
      throw std::invalid_argument(fmt::format("{} belongs to --robot; in a scene, say it in {}",
                                              option.name, option.in_a_scene));
    }
  }
}

const std::string& named_in_errors(const RobotArguments& arguments) {
  if (!arguments.trajectory.empty()) {
    return arguments.trajectory;
  }
  return arguments.request.empty() ? arguments.robot : arguments.request;
}

Scene read_robot_scene(const RobotArguments& arguments, const ReadingOptions& reading, bool plans) {
  RobotQuestion question;
  question.plans = plans;
  question.reading = reading;
  question.environment_scale = arguments.environment_scale.value_or(1.0);
  question.robot.urdf = arguments.robot;
  question.robot.package_roots.assign(arguments.package_roots.begin(),
                                      arguments.package_roots.end());
  question.robot.surface = surface_of(arguments);
  question.srdf = arguments.srdf;
  question.trajectory = arguments.trajectory;
  question.request = arguments.request;
  question.start = arguments.start;
  question.goal = arguments.goal;
  question.state = arguments.state;
  question.environment.assign(arguments.environment.begin(), arguments.environment.end());
  question.padding = arguments.padding.value_or(0.0);
  question.tracking_error = arguments.tracking_error.value_or(0.0);
  if (!arguments.turning.empty()) {
    question.turning = turning_of(arguments.turning);
  }
  question.unwrap = arguments.unwrap;
  return read_robot_question(question);
}

}  // namespace firstcontact::app
