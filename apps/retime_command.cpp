#include "retime_command.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/retiming/joint_limits.h>
#include <firstcontact/retiming/retime.h>
#include <firstcontact/retiming/retiming_path.h>
#include <firstcontact/retiming/retiming_scene.h>
#include <firstcontact/retiming/write_trajectory.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/parse_error.h>

#include "atomic_file.h"
#include "command_line_file.h"
#include "command_line_number.h"
#include "interrupt.h"
#include "motion_page.h"
#include "output_files.h"
#include "progress.h"
#include "quantity_text.h"
#include "robot_options.h"
#include "standard_streams.h"
#include "terminal_text.h"
#include "viewer_page.h"

namespace firstcontact::app {
namespace {

struct Arguments {
  std::string path;
  std::string output;
  std::string page;
  std::string mode = kRetimingModeWords[0];
  std::string limits;
  GivenLimits others;
  std::optional<double> tolerance;
  std::optional<double> blend_deviation;
  std::string which;  ///< Robot of a scene.
  bool lenient = false;
  int threads = 0;
  RobotArguments robot;
};

std::string input_name(const Arguments& arguments) {
  return arguments.path.empty() ? named_in_errors(arguments.robot) : arguments.path;
}

RetimingMode mode_of(const std::string& word) {
  const auto found = std::find(kRetimingModeWords.begin(), kRetimingModeWords.end(), word);
  return static_cast<RetimingMode>(found - kRetimingModeWords.begin());
}

/// The path and its scene, with the controller's tolerance in it.
RetimingPath read_input(const Arguments& arguments) {
  const ReadingOptions reading{.lenient = arguments.lenient};
  RetimingPath input = arguments.path.empty()
                           ? retiming_path_of(read_robot_scene(arguments.robot, reading))
                           : read_retiming_path(arguments.path, arguments.which, reading);
  if (!arguments.path.empty() && arguments.robot.tracking_error) {
    for (const std::size_t moving : input.robots) {
      SceneRobot& robot = input.scene.robots.at(moving);
      robot.tracking_error = joint_errors(robot.model, *arguments.robot.tracking_error);
    }
  }
  return input;
}

/// Multiplies limits by the factors of a request.
void scale_by_request(const std::string& file, const RobotModel& model,
                      std::vector<RateLimits>& limits) {
  const PlanningRequest request = read_planning_request(file, model);
  if (request.cartesian_speed > 0.0) {
    throw ParseError(file, fmt::format("max_cartesian_speed: expected 0, as the speed of a link is "
                                       "not limited here, got {}",
                                       request.cartesian_speed));
  }
  scale_limits(request.velocity_scaling, request.acceleration_scaling, limits);
}

/// @param model  the model of all robots that move
std::vector<RateLimits> rate_limits(const Arguments& arguments, const RetimingPath& input,
                                    const RobotModel& model,
                                    const std::map<std::string, GivenLimits>& given) {
  std::vector<RateLimits> limits =
      limits_of(model, input.path.joint_names, given, arguments.others);
  if (!arguments.robot.request.empty()) {
    scale_by_request(arguments.robot.request, model, limits);
  }
  return limits;
}

/// Writes the lines of the answer.
class Report {
 public:
  Report(const Arguments& arguments, const RetimingPath& input, const LoadedRetimingScene& scene,
         const RetimedMotion& retimed)
      : arguments_(arguments),
        input_(input),
        warnings_(scene.loaded.warnings),
        where_(scene.where),
        model_(joined_model(where_)),
        retimed_(retimed) {}

  std::string proven(const ExecutedProof& proof) {
    text_ = fmt::format("{}: {}\n", visible(input_name(arguments_)), "proven");
    line("written", arguments_.output);
    mode();
    const TimedMotion& motion = retimed_.motion;
    line("duration",
         time_text(proof.duration) + (retimed_.mode == RetimingMode::stop
                                          ? ""
                                          : fmt::format("; with rest at each waypoint {}",
                                                        time_text(retimed_.stop_duration))));
    line("points", fmt::format("{}, with {} between them", motion.points.size(),
                               motion.has_accelerations() ? "quintics" : "cubics"));
    rates(proof);
    clearance(proof);
    held(proof);
    turns();
    warnings();
    return text_;
  }

  std::string refused(const ExecutedProof& proof) {
    const bool is_undecided = proof.contact.verdict == Verdict::undecided;
    text_ = fmt::format("{}: {}\n", visible(input_name(arguments_)),
                        is_undecided ? "not proven" : "no proven retiming");
    mode();
    if (proof.contact.verdict != Verdict::free) {
      line(is_undecided ? "undecided" : "contact",
           fmt::format("at {} of {}{}", time_text(proof.contact_time()), time_text(proof.duration),
                       deciding_pair(proof)));
    }
    for (const SceneLimits& left : proof.positions) {
      for (const LimitViolation& violation : left.violations) {
        line("limit", describe(input_.scene.robots.at(left.robot), violation, proof.duration));
      }
    }
    if (const auto use = rate_beyond_limit(proof.rates)) {
      line("limit", describe(*use, joint(use->joint), is_prismatic(use->joint)));
    }
    line("written", "nothing");
    return text_;
  }

 private:
  void line(const char* label, const std::string& value) {
    text_ += fmt::format("  {:<12} {}\n", label, visible(value));
  }

  void mode() {
    const std::size_t inner = input_.path.waypoints.size() - 2;
    const std::string word = kRetimingModeWords.at(static_cast<std::size_t>(retimed_.mode));
    if (mode_of(arguments_.mode) == RetimingMode::stop) {
      line("mode", word);
      return;
    }
    line("mode",
         retimed_.mode == RetimingMode::stop
             ? word + ": no motion with blends is proven and faster"
             : fmt::format("{}: passes {} of {} waypoints on blends, {} made shorter to be free",
                           word, retimed_.blends, inner, retimed_.shortened) +
                   (retimed_.left_out == 0
                        ? ""
                        : fmt::format("; {} on straight edges", retimed_.left_out)));
  }

  [[nodiscard]] const std::string& joint(std::size_t index) const {
    return input_.path.joint_names.at(index);
  }

  [[nodiscard]] bool is_prismatic(std::size_t index) const {
    const JointCoordinate which = find_coordinate(model_, joint(index));
    const JointType type = model_.joints()[which.joint].type;
    return type == JointType::prismatic || (type == JointType::planar && which.index < 2);
  }

  [[nodiscard]] std::string names(const BodyPair& members) const {
    return where_.scene.name(members[0]) + " and " + where_.scene.name(members[1]);
  }

  [[nodiscard]] std::string deciding_pair(const ExecutedProof& proof) const {
    return proof.contact.first ? ": " + names(proof.contact.pairs.at(*proof.contact.first).members)
                               : "";
  }

  /// Writes the joint that comes closest to its limit, for each rate; rounded up, as a proven
  /// bound.
  void rates(const ExecutedProof& proof) {
    for (std::size_t what = 0; what < kJointRateWords.size(); ++what) {
      const RateUse* most = nullptr;
      for (const RateUse& use : proof.rates) {
        const bool is_of_it = static_cast<std::size_t>(use.what) == what;
        if (is_of_it && (most == nullptr || use.bound / use.limit > most->bound / most->limit)) {
          most = &use;
        }
      }
      if (most != nullptr) {
        line(kJointRateWords[what],
             fmt::format("at most {:.1f} % of its limit, proven; {} at {}",
                         std::min(100.0, std::ceil(1000.0 * most->bound / most->limit) / 10.0),
                         joint(most->joint), time_text(most->time)));
      }
    }
  }

  void clearance(const ExecutedProof& proof) {
    if (!proof.contact.closest) {
      line("clearance", "no pair is tested");
      return;
    }
    const PairAnswer& pair = proof.contact.pairs.at(*proof.contact.closest);
    line("closest", fmt::format("{} at {}: {}", length_text(pair.closest->distance),
                                time_text(pair.closest->t * proof.duration), names(pair.members)));
  }

  /// Writes the pairs that were in contact at an end of the path.
  void held(const ExecutedProof& proof) {
    for (const ProvenHold& hold : proof.held) {
      const std::string until = hold.to < proof.duration ? " until " + time_text(hold.to) : "";
      const std::string since = hold.from > 0.0 ? " from " + time_text(hold.from) + " on" : "";
      line("held", fmt::format("{}: more than {} apart{}{}", names(hold.members),
                               length_text(hold.distance), since, until));
    }
  }

  /// Writes the joints that end whole turns away from where the path has them.
  void turns() {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const std::vector<double>& end = input_.path.waypoints.back();
    for (std::size_t k = 0; k < end.size(); ++k) {
      const auto count = std::llround(std::abs(input_.named_end.at(k) - end[k]) / kTurn);
      if (count > 0) {
        line("turns", fmt::format("{} ends at {:.6g} rad, {} {} from the {:.6g} rad of the path",
                                  joint(k), end[k], count, count == 1 ? "turn" : "turns",
                                  input_.named_end[k]));
      }
    }
  }

  void warnings() {
    if (input_.is_approximate) {
      line("warning", "the path is approximate: it ends before its goal");
    }
    for (const std::string& warning : warnings_) {
      line("warning", visible(warning));
    }
  }

  const Arguments& arguments_;
  const RetimingPath& input_;
  const std::vector<std::string>& warnings_;
  const RetimingScene& where_;
  const RobotModel model_;  // Model of all robots that move.
  const RetimedMotion& retimed_;
  std::string text_;
};

ExitStatus status_of_refusal(const ExecutedProof& proof) {
  return proof.contact.verdict == Verdict::undecided ? ExitStatus::undecided : ExitStatus::contact;
}

ExitStatus retime_path(const Arguments& arguments) {
  const Interrupt interrupt;  // First, as other threads inherit its block of signals.
  Progress progress;
  const TrajectoryFormat format = trajectory_format_of(arguments.output);
  const std::vector<OutputFile> outputs{{"-o", arguments.output}, {"--html", arguments.page}};
  require_different(outputs);
  // A missing viewer is reported before the work.
  const std::string viewer = arguments.page.empty() ? "" : viewer_page();
  std::vector<std::filesystem::path> named{arguments.path, arguments.limits};
  for (const std::string& file : files_of(arguments.robot)) {
    named.emplace_back(file);
  }
  std::erase_if(named, [](const std::filesystem::path& file) { return file.empty(); });
  require_no_input(outputs, named);
  require_writable(outputs);
  try {
    progress.doing("reading");
    const RetimingPath input = read_input(arguments);
    require_no_input(outputs, files_of(input.scene));
    ShapeCache cache;
    LoadedRetimingScene scene = load_retiming_scene(input, cache);
    const RobotModel model = joined_model(scene.where);
    const auto given = arguments.limits.empty() ? std::map<std::string, GivenLimits>{}
                                                : read_joint_limits(arguments.limits, model);
    scene.where.positions = position_limits_of(given);
    const std::vector<RateLimits> limits = rate_limits(arguments, input, model, given);
    require_names(input.path.joint_names, format, model);
    progress.doing("retiming");
    RetimingOptions options{.mode = mode_of(arguments.mode),
                            .blend_deviation = arguments.blend_deviation};
    options.proof.tolerance = arguments.tolerance.value_or(input.scene.options.tolerance);
    options.proof.threads = arguments.threads;
    options.proof.budget.stop = interrupt.token();
    const RetimedMotion retimed = retime(input.path, limits, scene.where, options);
    Report report(arguments, input, scene, retimed);
    if (!retimed.proof.is_proven()) {
      say(report.refused(retimed.proof));
      flush_stdout();
      return status_of_refusal(retimed.proof);
    }
    progress.doing("proving the file");
    // The file counts: its text is read as a controller reads it, and that motion is proven.
    const std::string text = write_trajectory(retimed.motion, format);
    options.proof.closest = true;
    const ExecutedProof proof = prove_motion(parse_timed_motion(text, arguments.output, model),
                                             limits, scene.where, options.proof);
    if (!proof.is_proven()) {
      say(report.refused(proof));
      flush_stdout();
      return status_of_refusal(proof);
    }
    write_file(arguments.output, text);
    if (!arguments.page.empty()) {
      const auto doing = [&](const std::string& what) { progress.doing("page: " + what); };
      write_motion_page({arguments.page, viewer, interrupt.token(), doing},
                        scene_in_motion(input, scene.where, retimed.motion),
                        rate_looks(input, limits));
    }
    say(report.proven(proof));
    flush_stdout();
    return kSuccess;
  } catch (const std::invalid_argument& error) {
    throw ParseError(input_name(arguments), error.what());
  }
}

void require_one_input(const Arguments& arguments) {
  if (arguments.path.empty() == arguments.robot.robot.empty()) {
    throw std::invalid_argument(arguments.path.empty()
                                    ? "expected a PATH, or --robot (see firstcontact retime --help)"
                                    : "expected a PATH or --robot, got both");
  }
  if (!arguments.path.empty()) {
    RobotArguments others = arguments.robot;
    others.tracking_error.reset();  // It is the controller's, whatever moves.
    require_no_option_of_a_robot(others);
  }
}

constexpr const char* kFooter = R"(
  firstcontact retime path.json --limits joint_limits.yaml --mode blend -o trajectory.yaml

The file is read back, and the motion that a controller interpolates from it is proven. That is a
cubic between points with velocities, and a quintic where accelerations are given too. A motion that
is not proven is not written.

Exit status: 0 proven and written, 1 no proven retiming, 2 bad input, 3 undecided.
Ctrl-C ends with status 3; a second Ctrl-C ends at once.)";

}  // namespace

void add_retime_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command = app.add_subcommand(
      "retime", "Times a path within joint limits, proven as a controller executes it");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("PATH", arguments->path,
                      "Path that \"firstcontact plan\" wrote; or a scene (.json) whose robot has "
                      "waypoints as its trajectory");
  add_file(*command, "-o,--output", arguments->output,
           "The trajectory: .yaml or .json (trajectory_msgs/JointTrajectory), or .csv")
      ->required();
  add_file(*command, "--html", arguments->page, "Makes a page that plays the trajectory");
  command
      ->add_option(
          "--mode", arguments->mode,
          "stop: stays on the path and rests at each waypoint. blend: rounds the corners by "
          "blends that are proven free. time_optimal: blends, in the least time")
      ->check(CLI::IsMember(
          std::vector<std::string>(kRetimingModeWords.begin(), kRetimingModeWords.end())));
  add_file(
      *command, "--limits", arguments->limits,
      "joint_limits.yaml of MoveIt: velocities, accelerations, jerks. A path of several robots "
      "names its joints ROBOT/NAME");
  add_number(*command, "--max-velocity", arguments->others.velocity, Range::positive,
             "[rad/s or m/s] For joints that have no limit in --limits and in the URDF");
  add_number(*command, "--max-acceleration", arguments->others.acceleration, Range::positive,
             "[rad/s^2 or m/s^2] For joints that have no limit in --limits");
  add_number(*command, "--max-jerk", arguments->others.jerk, Range::positive,
             "[rad/s^3 or m/s^3] For joints that have no limit in --limits; by default unlimited");
  add_number(*command, "--tolerance", arguments->tolerance, Range::positive,
             "[m] Replaces the scene's");
  add_number(*command, "--blend-deviation", arguments->blend_deviation, Range::positive,
             "[rad or m] How far each joint may leave the path in the modes blend and "
             "time_optimal; by default as far as blends gain time");
  command->add_option("--which", arguments->which, "The robot, in a scene with several")
      ->type_name("NAME");
  command->add_flag("--lenient", arguments->lenient, "Unknown names in files are warnings");
  add_threads(*command, arguments->threads, "The answer");
  add_robot_options(*command, arguments->robot, RobotUse::retime);
  command->footer(kFooter);
  command->callback([arguments, &status] {
    require_one_input(*arguments);
    status = retime_path(*arguments);
  });
}

}  // namespace firstcontact::app
