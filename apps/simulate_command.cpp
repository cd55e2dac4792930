#include "simulate_command.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/run_page/write_run_animation.h>
#include <firstcontact/run_page/write_run_page.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene/simulation_duration.h>
#include <firstcontact/scene_files/read_simulation_scene.h>
#include <firstcontact/simulation/simulator.h>
#include <firstcontact/text/parse_error.h>

#include "atomic_file.h"
#include "command_line_file.h"
#include "command_line_number.h"
#include "interrupt.h"
#include "output_files.h"
#include "pair_text.h"
#include "progress.h"
#include "quantity_text.h"
#include "run_file.h"
#include "standard_streams.h"
#include "terminal_text.h"
#include "viewer_page.h"

namespace firstcontact::app {
namespace {

struct Arguments {
  std::string scene;
  std::string output;
  std::string page;
  std::string animation;
  std::optional<double> duration;  // [s]
  std::optional<double> step;      // [s]
  int threads = 0;
  bool resume = false;
  bool force = false;
  bool lenient = false;
};

/// The name of the scene in messages.
std::string name_of(const Arguments& arguments) {
  return arguments.scene == kStdin ? std::string(kStdinName) : arguments.scene;
}

Simulator load(const Arguments& arguments) {
  const std::vector<OutputFile> outputs{
      {"-o", arguments.output}, {"--html", arguments.page}, {"--glb", arguments.animation}};
  require_different(outputs);
  require_no_input(outputs, {arguments.scene});
  require_writable(outputs);
  const ReadingOptions reading{.lenient = arguments.lenient};
  Scene scene =
      arguments.scene == kStdin
          ? parse_simulation_scene(read_stdin(), std::filesystem::path(kStdinName), reading)
          : read_simulation_scene(arguments.scene, reading);
  require_no_input(outputs, files_of(scene));
  if (!scene.simulation) {
    throw ParseError(name_of(arguments),
                     "expected \"simulation\" or a body with \"dynamics\"; without them nothing "
                     "moves freely (see `check` for scripted motion)");
  }
  if (arguments.duration) {
    set_simulation_duration(scene, *arguments.duration);
  }
  if (arguments.step) {
    scene.simulation->step = *arguments.step;
  }
  try {
    ShapeCache cache;
    Simulator simulator(load_scene(std::move(scene), cache));
    simulator.set_threads(arguments.threads);
    return simulator;
  } catch (const std::invalid_argument& error) {
    throw ParseError(name_of(arguments), error.what());
  }
}

/// The work of this call.
struct Work {
  std::size_t steps = 0;
  double simulated = 0.0;  // [s]
  double seconds = 0.0;    // [s]
  double slowest = 0.0;    // [s]  Slowest step.

  void take(const RunStep& step, double took) {
    ++steps;
    simulated += step.lasted;
    seconds += took;
    slowest = std::max(slowest, took);
  }
};

/// The totals of the steps of a run, earlier ones included.
struct Tally {
  double time_lost = 0.0;                     // [s]
  std::map<std::size_t, double> behind = {};  // [s]  The most by which each scripted body was
                                              // behind.
  double clearance = std::numeric_limits<double>::infinity();  // [m]
  double residual = 0.0;                                       // [m/s]
  std::size_t events = 0;
  std::optional<double> impulse;       // [N s]  The greatest impulse of an impact at one place.
  std::optional<double> first_energy;  // [J]
  double last_energy = 0.0;            // [J]

  void take(const RunStep& step) {
    time_lost += step.time_lost;
    for (const RunBody& body : step.bodies) {
      if (body.behind > 0.0) {
        behind[body.body] = std::max(behind[body.body], body.behind);
      }
    }
    clearance = std::min(clearance, step.clearance);
    residual = std::max(residual, step.residual);
    events += step.events;
    for (const RunImpact& impact : step.impacts) {
      impulse = std::max(impulse.value_or(0.0), impact.impulse.norm());
    }
    last_energy = step.kinetic_energy + step.potential_energy;
    first_energy = first_energy.value_or(last_energy);
  }
};

class Run {
 public:
  explicit Run(const Arguments& arguments) : arguments_(arguments), simulator_(load(arguments)) {
    if (!arguments.page.empty()) {
      template_ = viewer_page();  // A missing viewer is reported before the work.
      page_.emplace(simulator_.header());
    }
    if (!arguments.animation.empty()) {
      animation_.emplace(simulator_.header());
    }
    if (arguments.output.empty()) {
      return;
    }
    if (!arguments.resume) {
      file_.emplace(RunFile::begin(arguments.output, simulator_.header(),
                                   arguments.force ? HeldRun::replaced : HeldRun::resumable));
      return;
    }
    file_.emplace(RunFile::resume(arguments.output, simulator_.header(),
                                  [this](const RunStep& step) { collect(step); }));
    if (file_->last()) {
      simulator_.resume(*file_->last());
    }
  }

  ExitStatus run() {
    const std::size_t count = simulation_step_count(*simulator_.header().scene.simulation);
    resumed_ = simulator_.step_count();
    while (simulator_.step_count() < count) {
      const auto begin = Clock::now();
      const std::optional<RunStep> done = simulator_.step(interrupt_.token());
      if (!done) {
        break;
      }
      const std::chrono::duration<double> seconds = Clock::now() - begin;
      work_.take(*done, seconds.count());
      collect(*done);
      if (file_) {
        file_->write(*done);
      }
      progress_.doing(bar(simulator_.step_count(), count));
    }
    const bool is_whole = simulator_.step_count() >= count;
    write_page();
    write_animation();
    print(is_whole, count);
    const bool is_as_asked = is_whole && tally_.time_lost == 0.0 && tally_.behind.empty();
    return is_as_asked ? ExitStatus::free : ExitStatus::undecided;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void collect(const RunStep& step) {
    tally_.take(step);
    if (page_) {
      page_->add(step);
    }
    if (animation_) {
      animation_->add(step);
    }
  }

  /// Writes the page, where it was asked for and there is something to play.
  void write_page() const {
    if (page_ && page_->time() > 0.0) {
      ShapeCache cache;
      const LoadedScene loaded = load_scene(simulator_.header().scene, cache);
      write_file(arguments_.page, page_->write(template_, loaded));
    }
  }

  void write_animation() const {
    if (animation_ && animation_->time() > 0.0) {
      write_file(arguments_.animation, animation_->write(simulator_.loaded()));
    }
  }

  [[nodiscard]] std::string bar(std::size_t done, std::size_t count) const {
    constexpr std::size_t kWidth = 24;
    const std::size_t filled = kWidth * done / count;
    return fmt::format("[{}{}] step {} of {}, {:.3g} s", std::string(filled, '#'),
                       std::string(kWidth - filled, '.'), done, count, simulator_.time());
  }

  static void line(const char* label, const std::string& value) { say(answer_line(label, value)); }

  void print(bool is_whole, std::size_t count) const {
    const Scene& scene = simulator_.header().scene;
    const LoadedScene& loaded = simulator_.loaded();
    say(fmt::format(
        "{}: {}\n", visible(name_of(arguments_)),
        is_whole ? "simulated; " + no_penetration_text(loaded.pair_counts) : "stopped early"));
    const auto free =
        std::ranges::count_if(scene.bodies, [](const Body& b) { return b.free.has_value(); });
    line("bodies", fmt::format("{}, {} of them free", scene.bodies.size(), free));
    if (!scene.robots.empty()) {
      line("robots", fmt::format("{}, {} of them moved by forces", scene.robots.size(),
                                 simulator_.robot_states().size()));
    }
    const std::string resumed =
        resumed_ > 0 ? fmt::format(" (the first {} were there)", resumed_) : "";
    line("steps", fmt::format("{} of {}, {} each{}", simulator_.step_count(), count,
                              time_text(scene.simulation->step), resumed));
    if (work_.steps > 0) {
      const auto steps = static_cast<double>(work_.steps);
      line("took",
           fmt::format("{}, {} a step, {} the slowest; {} times real time",
                       time_text(work_.seconds), time_text(work_.seconds / steps),
                       time_text(work_.slowest), plain_number(work_.simulated / work_.seconds)));
    }
    if (tally_.first_energy) {
      line("apart", apart_text(tally_.clearance));
      line("impacts", fmt::format("{}{}", tally_.events,
                                  tally_.impulse ? ", " + impulse_text(*tally_.impulse) +
                                                       " the greatest at one place"
                                                 : ""));
      line("residual", fmt::format("{:.2g} m/s at most, of the contact laws", tally_.residual));
      line("energy", fmt::format("{:.6g} J after the first step, {:.6g} J at the end",
                                 *tally_.first_energy, tally_.last_energy));
      line("time lost", tally_.time_lost > 0.0 ? time_text(tally_.time_lost) : "none");
    }
    if (!tally_.behind.empty()) {
      line("waited", waited());
    }
    for (const auto& [label, value] : pair_lines(loaded.pair_counts)) {
      line(label, value);
    }
    print_warnings(loaded);
    if (file_) {
      line("run", arguments_.output + (is_whole ? "" : "; --resume goes on"));
    }
    if (page_) {
      line("page", page_->time() > 0.0 ? arguments_.page : "none: there is nothing to play");
    }
    if (animation_) {
      line("animation",
           animation_->time() > 0.0 ? arguments_.animation : "none: there is nothing to play");
    }
    flush_stdout();
  }

  /// The name of the mover of a body: itself, or the robot of which it is a link.
  [[nodiscard]] std::string mover_of(std::size_t body) const {
    const Scene& scene = simulator_.header().scene;
    const std::string& name = simulator_.loaded().scene.bodies[body].name;
    if (body < scene.bodies.size()) {
      return name;
    }
    const auto robot = std::ranges::find_if(scene.robots, [&](const SceneRobot& described) {
      return name.starts_with(described.name + "/");
    });
    return robot->name;
  }

  /// The bodies and robots that waited, those with the longest wait first.
  [[nodiscard]] std::string waited() const {
    constexpr std::size_t kMost = 3;
    std::map<std::string, double> movers;
    for (const auto& [body, seconds] : tally_.behind) {
      double& most = movers[mover_of(body)];
      most = std::max(most, seconds);
    }
    std::vector<std::pair<double, std::string>> longest;
    for (const auto& [name, seconds] : movers) {
      longest.emplace_back(-seconds, name);
    }
    std::ranges::sort(longest);
    std::string text;
    for (std::size_t k = 0; k < std::min(kMost, longest.size()); ++k) {
      text += fmt::format("{}{}, up to {} behind its motion", k == 0 ? "" : "; ", longest[k].second,
                          time_text(-longest[k].first));
    }
    return text +
           (longest.size() > kMost ? fmt::format("; {} others", longest.size() - kMost) : "");
  }

  static void print_warnings(const LoadedScene& loaded) {
    for (const std::string& warning : loaded.warnings) {
      line("warning", warning);
    }
    if (const std::string warning = no_pair_warning(loaded.pair_counts); !warning.empty()) {
      line("warning", warning);
    }
  }

  const Interrupt interrupt_;  // First, as other threads inherit its block of signals.
  Progress progress_;
  const Arguments& arguments_;
  Simulator simulator_;
  std::string template_;  // Template of the page.
  std::optional<RunPage> page_;
  std::optional<RunAnimation> animation_;
  std::optional<RunFile> file_;
  Work work_;
  Tally tally_;
  std::size_t resumed_ = 0;
};

constexpr const char* kFooter = R"(
SCENE is a scene with "dynamics" (docs/simulation.md) or a fixture of Rigid IPC.
The output file grows by a line with every step. An interrupted run continues with --resume and
gives the same bits. A file that is not empty is replaced only with --force. The summary is of the
whole run, after --resume too. `firstcontact verify RUN` proves the run with other code.
The simulation holds a pair apart where one of its bodies is free. Two scripted or fixed bodies may
pass through each other; the summary names such pairs.

Exit status: 0 done; 2 bad input; 3 stopped early, a script had to wait, or time was lost. Ctrl-C
ends after the current step; a second Ctrl-C ends at once.)";

}  // namespace

void add_simulate_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command = app.add_subcommand(
      "simulate", "Moves bodies under forces and contacts; free bodies never interpenetrate");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("SCENE", arguments->scene, "The scene, .json; - for standard input")
      ->required();
  CLI::Option* output = add_file(*command, "-o,--output", arguments->output,
                                 "Records the run: JSON Lines, one line for each step");
  add_file(*command, "--html", arguments->page, "Makes a page that plays the run");
  add_file(*command, "--glb", arguments->animation,
           "Makes an animation for other programs: binary glTF, .glb");
  add_number(*command, "--duration", arguments->duration, Range::positive,
             "[s] Time to simulate; replaces the scene's. Scripted bodies keep their speed");
  add_number(*command, "--step", arguments->step, Range::positive,
             "[s] Length of a step; replaces the scene's");
  add_threads(*command, arguments->threads, "The run");
  command->add_flag("--lenient", arguments->lenient,
                    "Unknown names in files are warnings, not errors");
  CLI::Option* resume =
      command->add_flag("--resume", arguments->resume, "Continues the run in the output file")
          ->needs(output);
  command->add_flag("--force", arguments->force, "Replaces the output file")
      ->needs(output)
      ->excludes(resume);
  command->footer(kFooter);
  command->callback([arguments, &status] { status = Run(*arguments).run(); });
}

}  // namespace firstcontact::app
