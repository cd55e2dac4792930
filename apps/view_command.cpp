#include "view_command.h"

#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/page/write_page.h>
#include <firstcontact/record/load_scene_of.h>
#include <firstcontact/record/read_run.h>
#include <firstcontact/run_page/write_run_animation.h>
#include <firstcontact/run_page/write_run_page.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/gap_bound.h>
#include <firstcontact/scene/gap_curve.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/read_result.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/verification/provable_file.h>

#include "atomic_file.h"
#include "command_line_file.h"
#include "interrupt.h"
#include "motion_page.h"
#include "output_files.h"
#include "standard_streams.h"
#include "terminal_text.h"
#include "viewer_page.h"

extern char** environ;

namespace firstcontact::app {
namespace {

struct Arguments {
  std::string result;
  std::string output;
  std::string animation;
  bool no_open = false;
  bool lenient = false;

  [[nodiscard]] ReadingOptions reading() const { return {.lenient = lenient}; }
};

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) {
    throw ParseError(path, "cannot be read");
  }
  return text;
}

/// Opens a page in the user's browser. The page is written whether or not this works.
void open(const std::string& page) {
  std::string program = "xdg-open";
  std::string argument = page;
  const std::array<char*, 3> arguments{program.data(), argument.data(), nullptr};
  pid_t process = 0;
  int status = -1;
  if (posix_spawnp(&process, program.c_str(), nullptr, nullptr, arguments.data(), environ) == 0) {
    waitpid(process, &status, 0);
  }
  if (status != 0) {
    say_on_stderr(
        fmt::format("firstcontact: cannot open a browser here; open {} yourself\n", visible(page)));
  }
}

/// Whether a file begins as write_run_header does.
bool is_run(const std::string& path) {
  constexpr std::string_view kBegin = "{\"firstcontact_run\"";
  std::string begin(kBegin.size(), ' ');
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == kBegin;
}

/// Reads a run into its collector (RunPage or RunAnimation), and its scene.
///
/// One line of the run is held at a time, as the run may be as large as a disk allows.
template <typename Collected>
std::pair<Collected, LoadedScene> collect_run(const std::string& path, const OutputFile& output,
                                              const ReadingOptions& reading) {
  std::ifstream stream(path, std::ios::binary);
  RunReader run(stream, path, reading);
  require_no_input({output}, files_of(run.header().scene));
  Collected collected(run.header());
  while (const std::optional<RunStep> step = run.next()) {
    collected.add(*step);
  }
  if (!(collected.time() > 0.0)) {
    throw ParseError(path, "expected steps after the header; there is nothing to play");
  }
  ShapeCache cache;
  try {
    return {std::move(collected), load_scene_of(run.header(), cache)};
  } catch (const std::invalid_argument& error) {
    throw ParseError(path, error.what());
  }
}

std::string page_of_run(const std::string& page, const std::string& path, const OutputFile& output,
                        const ReadingOptions& reading) {
  const auto [collected, loaded] = collect_run<RunPage>(path, output, reading);
  return collected.write(page, loaded);
}

/// @param text  of the result
std::string page_of_result(const std::string& page, const std::string& path,
                           const std::string& text, const OutputFile& output,
                           const ReadingOptions& reading) {
  StoredResult stored = read_result(text, path, reading);
  require_no_input({output}, files_of(stored.scene));
  const Interrupt interrupt;
  ShapeCache cache;
  const LoadedScene loaded = load_scene(std::move(stored.scene), cache);
  const std::vector<GapSample> gap = gap_curve(loaded, stored.t, interrupt.token());
  SceneResult answer;
  answer.t = stored.t;
  answer.clearance = stored.clearance;
  const std::vector<GapPoint> bound = gap_lower_bound(loaded, answer, gap);
  return write_page(page, loaded, text, {gap, bound});
}

/// @param text  of the path
void write_page_of_path(const std::string& page, const std::string& path, const std::string& text,
                        const OutputFile& output, const ReadingOptions& reading) {
  const PlannedPath planned = parse_planned_path(text, path, {.lenient = reading.lenient});
  require_no_input({output}, files_of(planned.scene));
  try {
    ShapeCache cache;
    (void)load_scene_of(planned, cache);  // Refuses a path of files that have changed.
    write_path_page({.file = output.path, .viewer = page}, planned);
  } catch (const std::invalid_argument& error) {
    throw ParseError(path, error.what());
  }
}

/// Writes the page of a run, a path or a result.
void write_page_of(const std::string& path, const OutputFile& output,
                   const ReadingOptions& reading) {
  const std::string page = viewer_page();
  if (is_run(path)) {
    write_file(output.path, page_of_run(page, path, output, reading));
    return;
  }
  const std::string text = read_text(path);
  if (provable_file(text) == ProvableFile::path) {
    write_page_of_path(page, path, text, output, reading);
  } else {
    write_file(output.path, page_of_result(page, path, text, output, reading));
  }
}

void write_animation(const Arguments& arguments) {
  const OutputFile file{.option = "--glb", .path = arguments.animation};
  require_no_input({file}, {arguments.result});
  if (!is_run(arguments.result)) {
    throw ParseError(arguments.result,
                     "expected a run for --glb; the page of a result has its animation behind a "
                     "button");
  }
  const auto [collected, loaded] =
      collect_run<RunAnimation>(arguments.result, file, arguments.reading());
  write_file(arguments.animation, collected.write(loaded));
  say(visible(arguments.animation) + "\n");
  flush_stdout();
}

void view(const Arguments& arguments) {
  if (!arguments.animation.empty()) {
    write_animation(arguments);
    return;
  }
  const std::string& path = arguments.result;
  const std::string output = arguments.output.empty()
                                 ? std::filesystem::path(path).replace_extension(".html").string()
                                 : arguments.output;
  const OutputFile file{.option = "-o", .path = output};
  require_no_input({file}, {path});
  write_page_of(path, file, arguments.reading());
  say(visible(output) + "\n");
  flush_stdout();
  if (!arguments.no_open) {
    open(output);
  }
}

}  // namespace

void add_view_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "view", "Makes a page that plays a result, a run or a path, and opens it in the browser");
  auto arguments = std::make_shared<Arguments>();
  command
      ->add_option(
          "RESULT", arguments->result,
          "File that `check`, `plan`, `simulate` or `haptics` wrote with -o. Run this in the same "
          "folder, as the mesh files are read again")
      ->required();
  CLI::Option* output = add_file(*command, "-o,--output", arguments->output,
                                 "File for the page; by default beside the result");
  add_file(*command, "--glb", arguments->animation,
           "Makes an animation for other programs in place of the page of a run: binary glTF")
      ->excludes(output);
  command->add_flag("--no-open", arguments->no_open, "Does not open the page");
  command->add_flag(
      "--lenient", arguments->lenient,
      "Unknown names in files are warnings; needed where RESULT was made with --lenient");
  command->callback([arguments] { view(*arguments); });
}

}  // namespace firstcontact::app
