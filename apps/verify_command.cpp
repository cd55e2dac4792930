#include "verify_command.h"

#include <fstream>
#include <istream>
#include <memory>
#include <sstream>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/verification/provable_file.h>

#include "command_line_number.h"
#include "interrupt.h"
#include "path_proof.h"
#include "progress.h"
#include "result_proof.h"
#include "run_proof.h"
#include "standard_streams.h"

namespace firstcontact::app {
namespace {

/// Finds the kind of a file by its first line; where that is no whole object, by all of its text.
///
/// It returns that text; nothing for a run.
std::string told_kind(std::istream& stream, ProvableFile& kind) {
  std::string text;
  std::getline(stream, text);
  kind = provable_file(text);
  if (kind == ProvableFile::run) {
    return {};
  }
  if (!stream.eof()) {
    std::ostringstream rest;
    rest << stream.rdbuf();
    text += '\n' + rest.str();
  }
  kind = kind == ProvableFile::unknown ? provable_file(text) : kind;
  kind = kind == ProvableFile::unknown ? damaged_file(text) : kind;
  return text;
}

/// Refuses a scene, of which nothing is claimed yet.
///
/// @throws ParseError if the text is a scene
void require_no_scene(const std::string& file, const std::string& text) {
  const auto root = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!root.is_object() || !root.contains("firstcontact")) {
    return;
  }
  const char* mend = root.contains("simulation") ? "simulate"
                     : root.contains("plan")     ? "plan"
                                                 : "check";
  throw ParseError(file, fmt::format("expected a run, a result or a path, got a scene; first "
                                     "`firstcontact {} {} -o FILE`, then verify FILE",
                                     mend, file));
}

/// Refuses a table of `haptics`, which proves nothing.
///
/// @throws ParseError if the text is one
void require_no_table(const std::string& file, const std::string& text) {
  const bool is_ticks = text.starts_with("time_ns,tool,status,");
  const bool is_cycles = text.starts_with("cycle,time_ns,asked_s,");
  if (is_ticks || is_cycles) {
    throw ParseError(file, fmt::format("expected the run of the session, which `firstcontact "
                                       "haptics -o run.jsonl` writes, got its table of {}",
                                       is_ticks ? "ticks" : "cycles"));
  }
}

ExitStatus verify(const ProofArguments& arguments) {
  const Interrupt interrupt;  // First, as other threads inherit its block of signals.
  Progress progress;
  std::ifstream stream(arguments.file, std::ios::binary);
  if (!stream) {
    throw ParseError(arguments.file, "expected a run, a result or a path, cannot open this file");
  }
  progress.doing("verifying");
  ProvableFile kind = ProvableFile::unknown;
  const std::string text = told_kind(stream, kind);
  const ExitStatus status = [&] {
    if (kind == ProvableFile::result) {
      return prove_results(arguments, text, progress, interrupt.token());
    }
    if (kind == ProvableFile::path) {
      return prove_path(arguments, text, progress, interrupt.token());
    }
    if (kind == ProvableFile::unknown) {
      require_no_scene(arguments.file, text);
      require_no_table(arguments.file, text);
    }
    stream.clear();
    if (!stream.seekg(0)) {
      throw ParseError(arguments.file, "expected a file that can be read twice, not a pipe");
    }
    return prove_run(arguments, stream, progress, interrupt.token());
  }();
  flush_stdout();
  return status;
}

constexpr const char* kFooter = R"(
The contents of FILE tell which kind it is.

--scene compares the digest of the scene's text and of the trajectories that the scene names. For
runs of haptics with robots it compares the digest of all files that the scene names. For a path it
compares the whole scene, and names the first key that differs. Options of the command that made
FILE are not compared.

A run: the proof is about the pairs that a simulation holds apart. One body of such a pair is free,
and no rule ignores the pair. Two scripted or fixed bodies may pass through each other; the answer
names such pairs.

A result: each tested pair is proven to stay farther apart than its margin until t. The pair in
contact is proven to be within margin and tolerance at t. A tolerance_used must be one that the
rounding of doubles explains. Clearances are proven, too. The proof is about the resolved scene in
the result. `verify` refuses a result whose scene was edited, or whose mesh or robot files have
changed. These are not proven again: contacts (bodies, features, points, counts), intervals of
contact, closest approaches, and the counts of pairs that are not tested.

A path: each edge is proven to keep the margin and the extra clearance. The proof is about the
scene, its rules for pairs and the goals in FILE; --scene compares them with yours. A path that ends
before a goal is called approximate; its distance to the goal is measured again. `verify` refuses a
path whose mesh or robot files have changed. Costs and statistics are not proven again.

Exit status: 0 proven, 1 refuted, 2 bad input, 3 not proven. Refuted: bodies interpenetrate or come
closer than FILE claims, or the bodies of a contact are apart. A FILE that contradicts itself is bad
input. Ctrl-C ends with status 3; a second Ctrl-C ends at once.)";

}  // namespace

void add_verify_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command = app.add_subcommand("verify",
                                         "Proves the file of a simulation, a check or a plan a "
                                         "second time, with other code");
  auto arguments = std::make_shared<ProofArguments>();
  command
      ->add_option(
          "FILE", arguments->file,
          "A run of `simulate` or `haptics` (.jsonl), a result of `check`, or a path of `plan`")
      ->required();
  command
      ->add_option("--scene", arguments->scene,
                   "Refuses FILE where it was not made from this scene file as it is now")
      ->type_name("FILE");
  command->add_flag("--json", arguments->json, "Prints JSON in place of text for people");
  command->add_flag(
      "--lenient", arguments->lenient,
      "Unknown names in files are warnings; needed where FILE was made with --lenient");
  add_threads(*command, arguments->threads, "The answer");
  command->footer(kFooter);
  command->callback([arguments, &status] { status = verify(*arguments); });
}

}  // namespace firstcontact::app
