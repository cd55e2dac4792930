#include "plan_command.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/text/parse_error.h>

#include "atomic_file.h"
#include "command_line_file.h"
#include "command_line_number.h"
#include "drawn_path.h"
#include "failed_plan_json.h"
#include "interrupt.h"
#include "motion_page.h"
#include "output_files.h"
#include "progress.h"
#include "quantity_text.h"
#include "robot_options.h"
#include "scene_source.h"
#include "standard_streams.h"
#include "terminal_text.h"
#include "viewer_page.h"

namespace firstcontact::app {
namespace {

constexpr std::uint64_t kLargestSeed = (std::uint64_t{1} << 53) - 1;  // Greatest seed that JSON
                                                                      // keeps.
constexpr std::size_t kListedPairs = 3;

struct Arguments {
  std::string scene;
  std::string output;
  std::string page;
  bool json = false;
  bool lenient = false;
  bool approximate = false;
  RobotArguments robot;
  std::optional<double> margin;
  std::optional<double> tolerance;
  std::optional<double> time;
  std::optional<std::uint64_t> seed;
  std::string planner;
  std::string contacts;
  std::size_t shortcuts = PlanOptions().shortcuts;
  int threads = 0;
};

/// Does the work; errors of the question name the file that holds it.
template <class Work>
auto in_file(const std::string& source, const Work& work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    throw ParseError(source, error.what());
  }
}

class Plan {
 public:
  explicit Plan(const Arguments& arguments)
      : arguments_(arguments),
        source_(arguments.scene.empty() ? named_in_errors(arguments.robot) : arguments.scene),
        outputs_{{"-o", arguments.output}, {"--html", arguments.page}} {
    require_different(outputs_);
    const std::vector<std::string> inputs = files_of(arguments.robot);
    require_no_input(outputs_, {inputs.begin(), inputs.end()});
    require_no_input(outputs_, {arguments.scene});
    require_writable(outputs_);
    if (!arguments.page.empty()) {
      viewer_ = viewer_page();  // A missing viewer is reported before the work.
    }
  }

  ExitStatus run() {
    progress_.doing("reading");
    const ScenePlan scene = in_file(source_, [&] { return make(); });
    PlanOptions options = scene.options;
    take_options(options);
    progress_.doing("planning");
    const PlanResult result =
        in_file(source_, [&] { return plan_path(scene.plan, scene.start, scene.goals, options); });
    was_stopped_ = options.stop.stop_requested();
    return answer(scene, options, result);
  }

 private:
  ScenePlan make() const {
    const ReadingOptions reading{.lenient = arguments_.lenient};
    Scene scene = read(reading);
    require_no_input(outputs_, files_of(scene));
    if (arguments_.tolerance) {
      scene.options.tolerance = *arguments_.tolerance;
    }
    PlanQuestion question;
    if (scene.plan) {
      question = *scene.plan;
    } else if (arguments_.scene.empty()) {
      throw ParseError(source_, "expected --start and --goal, or a --request with a goal");
    } else {
      throw ParseError(source_, "expected \"plan\": what moves, and its goal; the scene has none");
    }
    if (arguments_.margin) {
      question.margin = arguments_.margin;
    }
    if (arguments_.seed) {
      question.seed = arguments_.seed;
    }
    if (arguments_.time) {
      question.time = arguments_.time;
    }
    ShapeCache cache;
    ScenePlan made = make_scene_plan(std::move(scene), question, cache, interrupt_.token());
    if (!arguments_.scene.empty()) {
      require_places(made, question);  // Requests and states have no keys of a plan.
    }
    require_goals_apart(made, question);
    return made;
  }

  Scene read(const ReadingOptions& reading) const {
    if (arguments_.scene.empty()) {
      return read_robot_scene(arguments_.robot, reading, true);
    }
    std::optional<Scene> scene;
    for_each_scene(arguments_.scene, reading, [&](const SceneSource& source) {
      if (scene || source.line) {
        throw ParseError(source_, "expected one scene, got lines of scenes");
      }
      scene = source.read();
      return true;
    });
    return *std::move(scene);
  }

  void take_options(PlanOptions& options) {
    if (!arguments_.planner.empty()) {
      const auto found = std::find(kPlannerWords.begin(), kPlannerWords.end(), arguments_.planner);
      options.planner = static_cast<Planner>(found - kPlannerWords.begin());
    }
    if (!arguments_.contacts.empty()) {
      const auto found =
          std::find(kContactUseWords.begin(), kContactUseWords.end(), arguments_.contacts);
      options.contacts = static_cast<ContactUse>(found - kContactUseWords.begin());
    }
    options.seed = arguments_.seed.value_or(options.seed);
    options.time = arguments_.time.value_or(options.time);
    options.shortcuts = arguments_.shortcuts;
    options.approximate = arguments_.approximate;
    options.threads = arguments_.threads;
    options.keep_trees = !arguments_.page.empty();
    options.stop = interrupt_.token();
    options.progress = [this](const PlanProgress& done) {
      progress_.doing(fmt::format("planning: {} configurations{}", done.nodes,
                                  done.cost ? fmt::format(", a path of {:.4g}", *done.cost) : ""));
    };
  }

  ExitStatus answer(const ScenePlan& scene, const PlanOptions& options, const PlanResult& result) {
    std::optional<PlannedPath> path;
    if (result.verdict != PlanVerdict::none) {
      path = planned_path(scene, options, result);
      path->sources = path_sources(sources_of(scene));
      const std::string text = write_planned_path(*path) + '\n';
      if (!arguments_.output.empty()) {
        write_file(arguments_.output, text);
      }
      if (arguments_.json) {
        std::fwrite(text.data(), 1, text.size(), stdout);
      }
      if (arguments_.json && was_stopped_) {
        say_on_stderr(visible(source_) + ": the best path so far, when it was stopped\n");
      }
    }
    has_page_ = write_page_of(scene, result, path);
    if (!arguments_.json) {
      say(describe(scene, options, result, path));
    } else if (!path) {
      say(failed_plan_json(scene, result));
      say_on_stderr(visible(describe_failure(scene, result)) + '\n');
    }
    flush_stdout();
    return result.verdict == PlanVerdict::proven        ? ExitStatus::free
           : result.verdict == PlanVerdict::approximate ? ExitStatus::undecided
                                                        : ExitStatus::contact;
  }

  /// Writes the page of a path, or that of a search without one; returns whether it did.
  bool write_page_of(const ScenePlan& scene, const PlanResult& result,
                     const std::optional<PlannedPath>& path) {
    if (arguments_.page.empty()) {
      return false;
    }
    // Where Ctrl-C has ended the search, it does not end the page, too.
    std::stop_token stop = interrupt_.token();
    const MotionPage page{
        .file = arguments_.page,
        .viewer = viewer_,
        .stop = stop.stop_requested() ? std::stop_token() : stop,
        .doing = [this](const std::string& what) { progress_.doing("page: " + what); }};
    return path ? write_path_page(page, *path, drawn_trees(scene, result.trees))
                : write_failure_page(page, scene, result);
  }

  /// The files that the scene was made of: texts, then robots and meshes.
  [[nodiscard]] std::vector<std::filesystem::path> sources_of(const ScenePlan& scene) const {
    std::vector<std::filesystem::path> files = scene.loaded.scene.files_read;
    if (!arguments_.scene.empty() && arguments_.scene != "-") {
      files.insert(files.begin(), arguments_.scene);
    }
    const auto add = [&](const std::filesystem::path& file) {
      std::error_code error;
      if (std::filesystem::is_regular_file(file, error)) {
        files.push_back(file);
      }
    };
    for (const FileReport& report : scene.loaded.files) {
      add(report.path);
      std::ranges::for_each(report.also_read, add);
    }
    return files;
  }

  [[nodiscard]] static std::string pair_name(const ScenePlan& scene, const BodyPair& pair) {
    return member_name(scene.loaded.scene, pair[0]) + " and " +
           member_name(scene.loaded.scene, pair[1]);
  }

  /// [s]  The time from which on the mover is at the goal.
  [[nodiscard]] static double arrival(const PlannedPath& path) {
    std::size_t last = path.waypoints.size() - 1;
    while (last > 0 && path.waypoints[last - 1] == path.waypoints.back()) {
      --last;
    }
    return path.times[last];
  }

  [[nodiscard]] static std::string blocking_text(const ScenePlan& scene,
                                                 const PlanStatistics& statistics) {
    std::string text;
    for (std::size_t k = 0; k < std::min(kListedPairs, statistics.blocked.size()); ++k) {
      const BlockingPair& blocking = statistics.blocked[k];
      text += fmt::format("{}{} ({} times)", k == 0 ? "" : "; ", pair_name(scene, blocking.members),
                          blocking.count);
    }
    return text.empty() ? "nothing" : text;
  }

  /// Describes a pair that is in contact at an end, and its proof.
  [[nodiscard]] static std::string contact_text(const NamedContactPair& one) {
    return fmt::format("{} and {} at the {} ({}): apart by {} or more (proven)", one.pair[0],
                       one.pair[1], kPathEndWords.at(static_cast<std::size_t>(one.at)),
                       kContactPolicyWords.at(static_cast<std::size_t>(one.policy)),
                       lower_bound_text(one.distance));
  }

  [[nodiscard]] static std::string shortened_text(double cost, std::optional<double> first) {
    return first && *first != cost ? fmt::format(" ({:.6g} before it was shortened)", *first) : "";
  }

  [[nodiscard]] std::string describe_failure(const ScenePlan& scene,
                                             const PlanResult& result) const {
    return fmt::format("{}: no path was found in {}{}; most in the way: {}", source_,
                       time_text(result.statistics.seconds),
                       was_stopped_ ? ", when it was stopped" : "",
                       blocking_text(scene, result.statistics));
  }

  [[nodiscard]] std::string describe(const ScenePlan& scene, const PlanOptions& options,
                                     const PlanResult& result,
                                     const std::optional<PlannedPath>& path) const {
    std::string text;
    const auto line = [&](const char* label, const std::string& value) {
      text += answer_line(label, value);
    };
    if (!path) {
      text = visible(describe_failure(scene, result)) + '\n';
    } else {
      text = fmt::format("{}: {}\n", visible(source_),
                         path->is_proven ? "a path to the goal, proven edge by edge"
                                         : "approximate: proven, but it ends before a goal");
      line("path",
           fmt::format("{}, {}, length {:.6g}{}", counted(path->waypoints.size(), "waypoint"),
                       counted(path->clearances.size(), "edge"), path->cost,
                       shortened_text(path->cost, result.statistics.first_cost)));
      if (!path->times.empty()) {
        line("arrives", fmt::format("after {}, and rests until {}", time_text(arrival(*path)),
                                    time_text(path->times.back())));
      }
      line("clearance", path->clearance
                            ? lower_bound_text(*path->clearance) + " or more everywhere" +
                                  (path->contact_pairs.empty() ? "" : " but for contact pairs") +
                                  " (proven)"
                        : path->contact_pairs.empty() ? "no pair is tested"
                                                      : "no other pair is tested");
      for (const NamedContactPair& one : path->contact_pairs) {
        line("contact", contact_text(one));
      }
      if (!path->is_proven) {
        line("to goal", fmt::format("{:.6g} left", path->distance_to_goal));
      }
      line("in the way", blocking_text(scene, result.statistics));
    }
    const PlanStatistics& counts = result.statistics;
    line("time",
         fmt::format("{}{}; {} checked, {} undecided, {} in trees", time_text(counts.seconds),
                     path && was_stopped_ ? ", when it was stopped" : "",
                     counted(counts.edges_checked, "edge"), counts.undecided,
                     counted(counts.nodes, "configuration")));
    line("planner",
         fmt::format("{}, seed {}", kPlannerWords.at(static_cast<std::size_t>(options.planner)),
                     options.seed));
    if (options.contacts != ContactUse::none) {
      line("contacts",
           fmt::format("{}: {} slides, {} pushes; {} of {} ends in contact, with at most {} active",
                       kContactUseWords.at(static_cast<std::size_t>(options.contacts)),
                       counts.contacts.slides, counts.contacts.pushes, counts.contacts.in_contact,
                       counts.contacts.nodes, counts.contacts.most_active));
    }
    for (const std::string& warning : scene.loaded.warnings) {
      line("warning", warning);
    }
    for (const std::string& warning : result.warnings) {
      line("warning", warning);
    }
    if (path && !arguments_.output.empty()) {
      line("written", arguments_.output + "; `firstcontact verify` proves it again");
    }
    if (has_page_) {
      line("page", arguments_.page);
    }
    return text;
  }

  Interrupt interrupt_;  // First, as other threads inherit its block of signals.
  Progress progress_;
  const Arguments& arguments_;
  std::string source_;
  std::vector<OutputFile> outputs_;
  std::string viewer_;  // Only where a page is wanted.
  bool has_page_ = false;
  bool was_stopped_ = false;
};

void require_one_plan(const Arguments& arguments) {
  if (!arguments.scene.empty() && arguments.robot.robot.empty()) {
    require_no_option_of_a_robot(arguments.robot, RobotUse::plan);
  }
  if (arguments.scene.empty() == arguments.robot.robot.empty()) {
    throw std::invalid_argument(arguments.scene.empty()
                                    ? "expected a SCENE, or --robot (see firstcontact plan --help)"
                                    : "expected a SCENE or --robot, got both");
  }
  if (arguments.robot.turning == "long") {
    throw std::invalid_argument("--turning long: edges of continuous joints go the short way");
  }
  if (!arguments.robot.trajectory.empty()) {
    throw std::invalid_argument(
        "--trajectory gives a motion; a plan takes --request, or --start and --goal");
  }
}

constexpr const char* kPlanFooter = R"(
Robot, request and environment as MoveIt has them:
    firstcontact plan --robot R.urdf --srdf R.srdf --environment S.yaml --request Q.yaml -o P.json

Exit status: 0 a proven path, 1 no path was found in the time, 2 bad input (also where the start or
the goal is not free), 3 the path is only approximate (with --approximate).
Ctrl-C ends with the best path so far; a second Ctrl-C ends at once.)";

}  // namespace

void add_plan_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command =
      app.add_subcommand("plan", "A path of a robot or body to a goal, proven edge by edge");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("SCENE", arguments->scene,
                      ".json with \"plan\": the moving robot or body, its start and its goal");
  add_file(*command, "-o,--output", arguments->output,
           "Writes the path to a file, with all that `verify` needs");
  add_file(*command, "--html", arguments->page,
           "Makes a page that plays the path, or shows a search that found none");
  command->add_flag("--json", arguments->json, "Prints the path as JSON in place of text");
  command
      ->add_option("--planner", arguments->planner,
                   "rrt_connect, the default, or lazy_prm_star, which looks for short paths")
      ->check(CLI::IsMember(std::vector<std::string>(kPlannerWords.begin(), kPlannerWords.end())));
  command
      ->add_option(
          "--contacts", arguments->contacts,
          "Use of contacts where an edge is blocked: none, the default; sample, slide or both, "
          "for narrow passages (docs/planning.md)")
      ->check(CLI::IsMember(
          std::vector<std::string>(kContactUseWords.begin(), kContactUseWords.end())));
  command
      ->add_option("--seed", arguments->seed,
                   "Seed of the random numbers; 1 by default. The same seed finds the same path")
      ->check(CLI::Range(std::uint64_t{0}, kLargestSeed));
  add_number(*command, "--time", arguments->time, Range::positive, "[s] Time limit; 10 by default");
  add_number(*command, "--margin", arguments->margin, Range::not_negative,
             "[m] All pairs stay farther apart than this; replaces the scene's");
  add_number(*command, "--tolerance", arguments->tolerance, Range::positive,
             "[m] A pair that is nearer than margin + tolerance may count as blocked");
  command
      ->add_option("--shortcuts", arguments->shortcuts,
                   "Number of attempts to shorten the path; half as many follow while they help. 0 "
                   "keeps the path as found")
      ->check(CLI::Range(std::size_t{0}, std::size_t{1'000'000}));
  command->add_flag("--approximate", arguments->approximate,
                    "Where no path is found: gives one that ends as near to a goal as was reached");
  add_threads(*command, arguments->threads, "The path");
  command->add_flag("--lenient", arguments->lenient,
                    "Unknown names in files are warnings, not errors");
  add_robot_options(*command, arguments->robot, RobotUse::plan);
  command->footer(kPlanFooter);
  command->callback([arguments, &status] {
    require_one_plan(*arguments);
    status = Plan(*arguments).run();
  });
}

}  // namespace firstcontact::app
