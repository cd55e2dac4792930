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
The kind of the file is found by its contents.

--scene refuses a file that was not made of this scene file as it is now. It compares the digest of
the scene's text and of the trajectories that this names. In runs of haptics with robots that is the
digest of all files that it names. Options of the command that made the file are not compared.

A run: looked at are the pairs that a simulation holds apart: one of the two is free, and no rule
ignores them. Scripted and resting bodies may pass through each other; the answer names such pairs.

A result: each tested pair is proven to stay farther apart than its margin until t. The pair of a
contact is proven to be within margin and tolerance at t. A tolerance_used has to be one that the
rounding of doubles explains. Clearances are proven, too. The proof is about the resolved scene in
the result. It is refused if that was edited, or if a mesh or robot file has changed. Not proven
again are contacts (bodies, features, points, counts), intervals of contact, closest approaches, and
the counts of pairs that are not tested.

A path: every edge is proven to keep the margin and the extra clearance. A path that ends before a
goal is called approximate; its distance to the goal is measured again. The path is refused if a
mesh or robot file has changed. Costs and statistics are not proven again.

Exit status: 0 proven, 1 refuted, 2 bad input, 3 not proven. Refuted means that bodies
interpenetrate or come closer than the file claims, or that those of a contact are apart. A file that
contradicts itself is bad input. Ctrl-C ends with status 3; again, at once.)";

}  // namespace

void add_verify_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command = app.add_subcommand("verify",
                                         "Proves a second time, by other code, what a simulation, "
                                         "a check or a plan wrote into a file");
  auto arguments = std::make_shared<ProofArguments>();
  command
      ->add_option("FILE", arguments->file,
                   "The .jsonl file that a simulation wrote, a result of check, or a path of plan")
      ->required();
  command
      ->add_option("--scene", arguments->scene,
                   "The file has to be one of this scene file as it is now")
      ->type_name("FILE");
  command->add_flag("--json", arguments->json, "Prints JSON in place of text for people");
  command->add_flag("--lenient", arguments->lenient,
                    "Unknown names in files are warnings, as in a run with this option");
  add_threads(*command, arguments->threads, "The answer");
  command->footer(kFooter);
  command->callback([arguments, &status] { status = verify(*arguments); });
}

}  // namespace firstcontact::app
