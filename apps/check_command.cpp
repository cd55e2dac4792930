#include "check_command.h"

#include <cstdio>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/page/write_page.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/scene/gap_bound.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/text/parse_error.h>

#include "atomic_file.h"
#include "command_line_file.h"
#include "command_line_number.h"
#include "gap_plot.h"
#include "gap_table.h"
#include "interrupt.h"
#include "output_files.h"
#include "print_result.h"
#include "progress.h"
#include "question_options.h"
#include "robot_options.h"
#include "scene_answer.h"
#include "scene_source.h"
#include "standard_streams.h"
#include "terminal_text.h"
#include "viewer_page.h"

namespace firstcontact::app {
namespace {

struct Arguments {
  std::vector<std::string> files;
  std::string output;
  std::string plot;
  std::string gap;
  std::string page;
  bool json = false;
  bool explain = false;
  RobotArguments robot;
  Question question;
};

/// Answers the scenes of a command line one after another.
class Check {
 public:
  explicit Check(const Arguments& arguments)
      : arguments_(arguments),
        outputs_{{"-o", arguments.output},
                 {"--svg", arguments.plot},
                 {"--gap", arguments.gap},
                 {"--html", arguments.page}},
        question_(arguments.question),
        batch_(is_batch(arguments)) {
    if (batch_ && !arguments_.plot.empty()) {
      throw std::invalid_argument("--svg draws one scene; give one .json file");
    }
    if (batch_ && !arguments_.gap.empty()) {
      throw std::invalid_argument("--gap is of one scene; give one .json file");
    }
    if (batch_ && !arguments_.page.empty()) {
      throw std::invalid_argument("--html shows one scene; give one .json file");
    }
    if (!arguments_.page.empty()) {
      page_ = viewer_page();  // A missing viewer is reported before the work.
    }
    keep_inputs();
    if (!arguments_.output.empty()) {
      output_.emplace(arguments_.output);
    }
    question_.gap_curve =
        !arguments_.plot.empty() || !arguments_.gap.empty() || !arguments_.page.empty();
    question_.stop = interrupt_.token();
    question_.doing = [this](std::string what) { progress_.doing(std::move(what)); };
  }

  ExitStatus run() {
    for (const std::string& file : arguments_.files) {
      check_file(file);
    }
    if (arguments_.files.empty()) {
      check_source(
          {.file = named_in_errors(arguments_.robot), .line = std::nullopt, .read = [this] {
             return read_robot_scene(arguments_.robot, question_.reading());
           }});
    }
    if (output_ && (batch_ || answered_ > 0)) {
      output_->commit();
    }
    flush_stdout();
    return status_;
  }

 private:
  /// Whether there may be many scenes: one bad scene then does not end the others.
  static bool is_batch(const Arguments& arguments) {
    return arguments.files.size() > 1 ||
           (arguments.files.size() == 1 && is_json_lines(arguments.files.front()));
  }

  void keep_inputs() const {
    require_different(outputs_);
    const std::vector<std::string> named = files_of(arguments_.robot);
    require_no_input(outputs_, {named.begin(), named.end()});
    require_no_input(outputs_, {arguments_.files.begin(), arguments_.files.end()});
    require_writable(outputs_);
  }

  void check_file(const std::string& file) {
    std::size_t scenes = 0;
    try {
      for_each_scene(file, question_.reading(), [&](const SceneSource& source) {
        ++scenes;
        if (question_.stop.stop_requested()) {
          status_ = worse(status_, ExitStatus::undecided);
          return false;
        }
        check_source(source);
        return true;
      });
    } catch (const ParseError& error) {
      take_error("", file, std::nullopt, error);
      return;
    }
    if (scenes == 0) {
      take_error("", file, std::nullopt, ParseError(file, "expected at least one scene, got none"));
    }
  }

  void check_source(const SceneSource& source) {
    std::string id;
    try {
      Scene scene = source.read();
      id = scene.id;
      require_no_input(outputs_, files_of(scene));
      take_answer(source, answer_scene(std::move(scene), question_, *cache_, workspace_));
    } catch (const std::invalid_argument& error) {
      take_error(id, source.file, source.line, ParseError(source.file, error.what()));
    } catch (const ParseError& error) {
      take_error(id, source.file, source.line, error);
    } catch (const std::bad_alloc&) {
      take_lack_of_memory(id, source);
    }
  }

  /// Takes a lack of memory, which ends the work where there is only one scene.
  void take_lack_of_memory(const std::string& id, const SceneSource& source) {
    if (!batch_) {
      throw;
    }
    cache_.emplace();
    workspace_ = {};
    constexpr const char* kWhat = "not enough memory to answer this scene";
    take_error(
        id, source.file, source.line,
        source.line ? ParseError(source.file, *source.line, kWhat) : ParseError(source.file, kWhat),
        UndecidedReason::memory);
  }

  void take_answer(const SceneSource& source, const SceneAnswer& answer) {
    status_ = worse(status_, status_of(answer.result.verdict));
    write_json(result_text(answer, question_.writes_pairs(), source.line));
    ++answered_;  // Only once there is a result to keep.
    const std::string title = title_of(source, answer);
    if (!json_on_stdout()) {
      say(describe(title, answer,
                   {.all_pairs = question_.all_pairs, .explain = arguments_.explain}));
    }
    if (!arguments_.plot.empty()) {
      write_file(arguments_.plot, gap_plot(title, answer));
    }
    if (!arguments_.gap.empty()) {
      write_file(arguments_.gap, gap_table(answer));
    }
    if (!arguments_.page.empty()) {
      const std::string result = result_text(answer, /*all_pairs=*/true, source.line);
      const auto bound = gap_lower_bound(answer.loaded, answer.result, answer.curve);
      write_file(arguments_.page, write_page(page_, answer.loaded, result, {answer.curve, bound}));
    }
    if (!json_on_stdout()) {
      say_written();
    }
  }

  /// Reports the written files, once they exist.
  void say_written() const {
    for (const auto& [label, file] : {std::pair("plot", arguments_.plot),
                                      {"table", arguments_.gap},
                                      {"page", arguments_.page}}) {
      if (!file.empty()) {
        say(fmt::format("  {:<10} {}\n", label, visible(file)));
      }
    }
  }

  static std::string result_text(const SceneAnswer& answer, bool all_pairs,
                                 std::optional<std::size_t> line) {
    return write_result(answer.loaded, answer.result,
                        {.all_pairs = all_pairs, .line = line, .sampling = answer.sampling});
  }

  static std::string title_of(const SceneSource& source, const SceneAnswer& answer) {
    const std::string& id = answer.loaded.scene.id;
    if (!id.empty()) {
      return id;
    }
    return source.line ? fmt::format("{}:{}", source.file, *source.line) : source.file;
  }

  void take_error(const std::string& id, const std::string& file, std::optional<std::size_t> line,
                  const ParseError& error, UndecidedReason reason = UndecidedReason::none) {
    status_ = ExitStatus::bad_input;
    progress_.say(fmt::format("firstcontact: {}", error.what()));
    if (batch_ || line) {  // Standard input may have lines.
      write_json(write_error(id, file, line, error.what(), reason));
    }
  }

  [[nodiscard]] bool json_on_stdout() const { return arguments_.json || (batch_ && !output_); }

  void write_json(std::string text) {
    text += '\n';
    if (output_) {
      output_->write(text);
    }
    if (json_on_stdout()) {
      std::fwrite(text.data(), 1, text.size(), stdout);
      std::fflush(stdout);  // A line appears as soon as it is known.
    }
  }

  Interrupt interrupt_;  // First, as other threads inherit its block of signals.
  Progress progress_;
  const Arguments& arguments_;
  std::vector<OutputFile> outputs_;
  Question question_;
  bool batch_;
  std::string page_;  // The page without a result.
  std::optional<AtomicFile> output_;
  std::optional<ShapeCache> cache_ = std::make_optional<ShapeCache>();
  ManyBodiesWorkspace workspace_;
  ExitStatus status_ = kSuccess;
  std::size_t answered_ = 0;
};

/// Requires a scene, or a robot.
void require_one_question(const Arguments& arguments) {
  if (!arguments.files.empty() && arguments.robot.robot.empty()) {
    require_no_option_of_a_robot(arguments.robot);
  }
  if (arguments.robot.robot.empty() && !files_of(arguments.robot).empty()) {
    throw std::invalid_argument("expected --robot ROBOT.urdf beside " +
                                files_of(arguments.robot).front());
  }
  if (arguments.files.empty() == arguments.robot.robot.empty()) {
    throw std::invalid_argument(arguments.files.empty()
                                    ? "expected a SCENE, or --robot (see firstcontact check --help)"
                                    : "expected a SCENE or --robot, got both");
  }
}

constexpr const char* kFooter = R"(
Is a trajectory free?  firstcontact check --robot R.urdf --srdf R.srdf --trajectory T.csv \
                           --environment ROOM.stl

Exit status: 0 free, 1 contact (at the start too), 2 bad input, 3 undecided. The worst of
several scenes counts, in the order 2, 3, 1, 0.
Ctrl-C ends with what is proven so far; a second Ctrl-C ends at once.)";

}  // namespace

void add_check_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command = app.add_subcommand(
      "check", "First contact of the bodies in a scene: when, where, or proven never");
  auto arguments = std::make_shared<Arguments>();
  Question& question = arguments->question;
  command->add_option("SCENE", arguments->files,
                      ".json: one scene. .jsonl: one scene in each line. Then each answer is one "
                      "line, in the same order, and the answer to a bad line is an error. -: "
                      "either, from standard input");
  add_file(*command, "-o,--output", arguments->output, "Writes the result as JSON to a file");
  command->add_flag("--json", arguments->json, "Prints JSON in place of text for people");
  command->add_flag("--explain", arguments->explain,
                    "Adds what was read from each file, what was left out, and why");
  add_file(*command, "--svg", arguments->plot, "Draws the gap over time (one scene)");
  add_file(*command, "--gap", arguments->gap,
           "Writes the gap over time and its proven lower bound as a table (one scene)")
      ->type_name("FILE.csv");
  add_file(*command, "--html", arguments->page, "Makes a page that plays the answer (one scene)");
  add_question_options(*command, question);
  add_number(*command, "--sample-rate", question.sample_rate, Range::positive,
             "[1/s] Adds the answer that sampling at this rate would give");
  add_threads(*command, question.threads, "The answer");
  command->add_flag("--strict", question.strict, "A robot beyond its joint limits is an error");
  add_robot_options(*command, arguments->robot);
  command->footer(kFooter);
  command->callback([arguments, &status] {
    require_one_question(*arguments);
    status = Check(*arguments).run();
  });
}

}  // namespace firstcontact::app
