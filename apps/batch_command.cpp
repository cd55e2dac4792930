#include "batch_command.h"

#include <charconv>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <firstcontact/scene/version.h>
#include <firstcontact/scene_files/check_lines.h>
#include <firstcontact/scene_files/read_result.h>
#include <firstcontact/scene_files/scene_lines.h>
#include <firstcontact/text/parse_error.h>

#include "batch_tally.h"
#include "command_line_file.h"
#include "command_line_number.h"
#include "interrupt.h"
#include "output_files.h"
#include "progress.h"
#include "question_options.h"
#include "results_file.h"
#include "results_page.h"
#include "scene_answer.h"
#include "standard_streams.h"
#include "terminal_text.h"
#include "viewer_page.h"

namespace firstcontact::app {
namespace {

/// The lines i, i + N, i + 2 N, ... of a file; the first line is 1.
struct Shard {
  std::size_t index = 1;  ///< i, from 1 to N
  std::size_t count = 1;  ///< N

  [[nodiscard]] bool has(std::size_t line) const { return line % count == index % count; }
};

struct Arguments {
  std::string jobs;
  std::string results;
  std::string page;
  int threads = 0;  // 0 for as many as there are processors.
  Shard shard;
  bool resume = false;
  Question question;
};

/// Reads the next scene of a shard.
std::optional<SceneLine> next_of(const Shard& shard, SceneLines& lines) {
  std::optional<SceneLine> line = lines.next();
  while (line && !shard.has(line->number)) {
    line = lines.next();
  }
  return line;
}

/// A survey of the jobs before the first is answered.
struct Survey {
  std::size_t scenes = 0;  ///< Number of scenes of the shard.
  std::string digest;      ///< Digest of the whole file.
};

/// Requires one scene in each line.
///
/// @throws ParseError if the jobs are one scene that goes over several lines
void require_lines(const std::string& jobs, const std::string& first) {
  constexpr std::uintmax_t kMost = 1U << 26U;  // [bytes]  A larger file is no scene of a person.
  if (nlohmann::json::accept(first) || std::filesystem::file_size(jobs) > kMost) {
    return;
  }
  std::ifstream file(jobs, std::ios::binary);
  if (nlohmann::json::accept(file)) {
    throw ParseError(jobs,
                     "expected JSON Lines, a whole scene in each line, got one scene over several "
                     "lines; `firstcontact check` answers it");
  }
}

Survey survey(const std::string& jobs, const Shard& shard) {
  std::error_code error;
  const auto status = std::filesystem::status(jobs, error);
  if (!std::filesystem::exists(status)) {
    throw ParseError(jobs, "expected a file of scenes, found none");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw ParseError(jobs, "expected a plain file of scenes, which can be read twice");
  }
  Survey found;
  bool any = false;
  SceneLines lines(jobs);
  while (const std::optional<SceneLine> line = lines.next()) {
    if (!std::exchange(any, true)) {
      require_lines(jobs, line->text);
    }
    found.scenes += shard.has(line->number) ? 1 : 0;
  }
  if (!any) {
    throw ParseError(jobs, "expected at least one scene, got none");
  }
  found.digest = lines.digest();
  return found;
}

/// The options that change results, all in one line.
std::string options_text(const Arguments& arguments) {
  const Question& question = arguments.question;
  std::string text;
  const auto number = [&](const char* name, const std::optional<double>& value) {
    text += value ? fmt::format(" {} {}", name, *value) : "";
  };
  number("--margin", question.margin);
  number("--tolerance", question.tolerance);
  number("--deadline", question.deadline);
  text += question.lenient ? " --lenient" : "";
  text += question.contacts ? " --contacts " + contacts_text(*question.contacts) : "";
  text += question.closest ? " --closest" : "";
  text += question.all_pairs ? " --all-pairs" : "";
  text += question.all_contacts_in_time ? " --all-contacts-in-time" : "";
  return text.empty() ? " none" : text;
}

/// The origin of the results of a command line; where any of it differs, the results may differ.
std::string origin_of(const Arguments& arguments, const Survey& found) {
  return fmt::format("firstcontact {}\nthe jobs {}, digest {}\nthe options{}\nthe shard {}/{}\n",
                     version(), arguments.jobs, found.digest, options_text(arguments),
                     arguments.shard.index, arguments.shard.count);
}

class Batch {
 public:
  explicit Batch(const Arguments& arguments)
      : arguments_(arguments),
        survey_(survey(arguments.jobs, arguments.shard)),
        tally_(survey_.scenes),
        lines_(arguments.jobs),
        results_(open_results()) {}

  ExitStatus run() {
    keep_results();
    begin_ = std::chrono::steady_clock::now();
    const Question& question = arguments_.question;
    check_lines(
        arguments_.jobs, [this] { return next_of(arguments_.shard, lines_); },
        [this](const LineAnswer& answer) { take(answer); },
        {.threads = static_cast<std::size_t>(arguments_.threads),
         .closest = question.closest,
         .all_pairs = question.all_pairs,
         .all_contacts_in_time = question.all_contacts_in_time,
         .reading = question.reading(),
         .stop = interrupt_.token(),
         .adjust = [&](SceneOptions& options) { override_options(question, options); }});
    if (!interrupt_.token().stop_requested() && lines_.digest() != survey_.digest) {
      throw ParseError(arguments_.jobs, "changed while its scenes were answered");
    }
    say(tally_.summary(seconds()));
    if (!arguments_.page.empty() && !interrupt_.token().stop_requested()) {
      say(write_results_page(arguments_.results, arguments_.page, question.reading(),
                             interrupt_.token(),
                             [this](std::string text) { progress_.doing(std::move(text)); }));
    }
    flush_stdout();
    return tally_.status();
  }

 private:
  /// Opens the results, which must not replace the jobs.
  ResultsFile open_results() const {
    const std::vector<OutputFile> outputs{{"-o", arguments_.results},
                                          {"-o", arguments_.results + ".batch"},
                                          {"--html", arguments_.page}};
    require_different(outputs);
    require_no_input(outputs, {arguments_.jobs});
    require_writable(outputs);
    if (!arguments_.page.empty()) {
      (void)viewer_page();  // Without the viewer all jobs would be answered, and no page made.
    }
    return {arguments_.results, origin_of(arguments_, survey_), arguments_.resume};
  }

  /// Counts the results of an earlier run, and passes over their jobs.
  void keep_results() {
    results_.for_each_kept([this](std::size_t number, const std::string& line) {
      const ResultSummary kept = read_summary(line, arguments_.results, number);
      const std::optional<SceneLine> job = next_of(arguments_.shard, lines_);
      if (!job) {
        throw ParseError(arguments_.results, number, "expected no more results than jobs");
      }
      if (kept.line != job->number) {
        throw ParseError(
            arguments_.results, number,
            fmt::format("expected the result of line {} of the jobs, got that of {}; results have "
                        "to stay as they were written",
                        job->number,
                        kept.line ? fmt::format("line {}", *kept.line) : "an unknown one"));
      }
      tally_.keep(kept.verdict);
    });
  }

  void take(const LineAnswer& answer) {
    results_.append(answer.text);
    tally_.add(answer.verdict);
    progress_.doing(tally_.progress(seconds()));
    if (!answer.error.empty()) {
      progress_.say("firstcontact: " + named(answer));
    }
  }

  /// The error with the job's line; the error of a mesh alone names only the mesh.
  [[nodiscard]] std::string named(const LineAnswer& answer) const {
    const std::string place = fmt::format("{}:{}: ", arguments_.jobs, answer.line);
    return answer.error.rfind(place, 0) == 0 ? answer.error : place + answer.error;
  }

  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

  Interrupt interrupt_;  // First, as other threads inherit its block of signals.
  Progress progress_;
  std::chrono::steady_clock::time_point begin_;
  const Arguments& arguments_;
  Survey survey_;
  BatchTally tally_;
  SceneLines lines_;
  ResultsFile results_;
};

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, wrong_index] = std::from_chars(text.data(), end, shard.index);
  if (wrong_index == std::errc() && slash != end && *slash == '/') {
    const auto [rest, wrong_count] = std::from_chars(slash + 1, end, shard.count);
    if (wrong_count == std::errc() && rest == end && 1 <= shard.index &&
        shard.index <= shard.count) {
      return shard;
    }
  }
  throw CLI::ValidationError(
      "--shard", fmt::format("expected i/N, such as 1/4, with i from 1 to N, got \"{}\"", text));
}

constexpr const char* kFooter = R"(
Each line of RESULTS answers one job, in the order of the jobs. The result of a job that cannot be
answered is an error. After an interruption, --resume continues with the next job. No result is
lost and no job runs twice. The file RESULTS.batch records the jobs and options; --resume refuses
different ones.

Exit status: 0 free, 1 contact (at the start too), 2 bad input, 3 undecided or interrupted. The
worst of all results counts, in the order 2, 3, 1, 0.)";

}  // namespace

void add_batch_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command = app.add_subcommand(
      "batch",
      "First contact in many scenes, on all processors; an interrupted batch can be resumed");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("JOBS", arguments->jobs, "A file with one scene in each line (JSON Lines)")
      ->required();
  add_file(*command, "-o,--output", arguments->results, "File for the results, one in each line")
      ->required()
      ->type_name("RESULTS");
  add_file(*command, "--html", arguments->page,
           "Makes a page that lists the results and plays each");
  command->add_flag("--resume", arguments->resume, "Continues after the last result in RESULTS");
  add_threads(*command, arguments->threads, "Each result");
  command
      ->add_option_function<std::string>(
          "--shard", [arguments](const std::string& text) { arguments->shard = parse_shard(text); },
          "Takes only the lines i, i + N, i + 2 N, ... of the jobs; the first line is 1")
      ->type_name("i/N");
  add_question_options(*command, arguments->question);
  command->footer(kFooter);
  command->callback([arguments, &status] { status = Batch(*arguments).run(); });
}

}  // namespace firstcontact::app
