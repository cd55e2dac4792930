#include "verify_command.h"

#include <fstream>
#include <istream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <firstcontact/record/read_run.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_simulation_scene.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/verification/provable_file.h>
#include <firstcontact/verification/verify_run.h>
#include <firstcontact/verification/write_verification.h>

#include "interrupt.h"
#include "pair_text.h"
#include "path_proof.h"
#include "progress.h"
#include "quantity_text.h"
#include "result_proof.h"
#include "standard_streams.h"
#include "terminal_text.h"

namespace firstcontact::app {
namespace {

ExitStatus status_of(RunVerdict verdict) {
  switch (verdict) {
    case RunVerdict::proven:
      return ExitStatus::free;
    case RunVerdict::closer:
      return ExitStatus::contact;
    case RunVerdict::broken:
      return ExitStatus::bad_input;
    case RunVerdict::not_proven:
      break;
  }
  return ExitStatus::undecided;
}

/// Writes the lines of one answer, but for a broken record.
class Description {
 public:
  Description(const std::string& file, const RunReader& run, const RunVerification& found)
      : scene_(run.header().scene), run_(run), found_(found) {
    text_ = fmt::format("{}: {}\n", visible(file), verdict());
  }

  std::string write() {
    problem();
    const std::size_t steps = found_.steps;
    line("verified", fmt::format("{} step{}, {}{}", steps, steps == 1 ? "" : "s",
                                 time_text(found_.time), of_the_whole()));
    if (found_.verdict == RunVerdict::proven && found_.closest) {
      const RunMoment& at = *found_.closest;
      line("least", fmt::format("{} (proven) to {}: {} at {:.6g} s (step {})",
                                length_text(found_.least_distance), length_text(at.distance),
                                names(at.bodies), at.time, at.step));
    }
    line("time lost", found_.time_lost > 0.0 ? time_text(found_.time_lost) : "none");
    if (found_.greatest_behind > 0.0) {
      line("waited", fmt::format("scripted bodies are up to {} behind their motion",
                                 time_text(found_.greatest_behind)));
    }
    if (run_.is_cut_off()) {
      line("note", "the file ends in the middle of a line, which was left out");
    }
    for (const auto& [label, value] : pair_lines(found_.pair_counts)) {
      line(label, value);
    }
    for (const std::string& warning : found_.warnings) {
      line("warning", warning);
    }
    if (const std::string warning = no_pair_warning(found_.pair_counts); !warning.empty()) {
      line("warning", warning);
    }
    return text_;
  }

 private:
  [[nodiscard]] std::string verdict() const {
    if (found_.verdict == RunVerdict::proven) {
      return "proven: " + no_penetration_text(found_.pair_counts);
    }
    return found_.verdict == RunVerdict::closer ? "refuted" : "not proven";
  }

  void line(const char* label, const std::string& value) {
    text_ += fmt::format("  {:<10} {}\n", label, visible(value));
  }

  [[nodiscard]] std::string names(const BodyPair& bodies) const {
    const std::vector<std::string> all = names_with_links(scene_);
    return all.at(bodies[0]) + " and " + all.at(bodies[1]);
  }

  void problem() {
    if (!found_.problem.empty()) {
      line("problem", found_.problem);
    }
    if (found_.problem_at) {
      const RunMoment& at = *found_.problem_at;
      line("when", fmt::format("{:.9g} s (step {})", at.time, at.step));
      if (found_.verdict == RunVerdict::closer) {
        line("distance", at.distance > 0.0 ? length_text(at.distance) + " or less" : "0");
      }
    }
  }

  /// A simulation may have ended early.
  [[nodiscard]] std::string of_the_whole() const {
    const double whole = scene_.simulation ? scene_.simulation->duration : 0.0;
    return found_.time < (1.0 - 1e-9) * whole ? " of " + time_text(whole) : "";
  }

  const Scene& scene_;
  const RunReader& run_;
  const RunVerification& found_;
  std::string text_;
};

/// The first line where that is a whole object, else all of the text.
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

/// @throws ParseError if the text is a scene, of which nothing is claimed yet
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

/// The digest that a run of this scene file has in its header.
///
/// @throws ParseError if the file is no scene
std::string digest_of_scene(const ProofArguments& arguments, RunKind kind) {
  Scene scene = read_simulation_scene(arguments.scene, {.lenient = arguments.lenient});
  if (kind != RunKind::haptics || scene.robots.empty()) {
    return scene.text_digest;
  }
  try {
    ShapeCache cache;
    return load_scene(std::move(scene), cache).input_digest;  // As prepare_haptics() has it.
  } catch (const std::invalid_argument& error) {
    throw ParseError(arguments.scene, error.what());
  }
}

/// @throws ParseError if the run was not made of the scene file as it is now
void require_scene(const ProofArguments& arguments, const RunHeader& header) {
  const std::string digest = digest_of_scene(arguments, header.kind);
  if (header.scene.text_digest.empty()) {
    throw ParseError(arguments.file,
                     "header.scene_digest: the run states none, as its scene was no file; leave "
                     "out --scene");
  }
  if (header.scene.text_digest != digest) {
    throw ParseError(arguments.file,
                     fmt::format("the run is not one of {} as it is now; {} again", arguments.scene,
                                 header.kind == RunKind::haptics ? "record it" : "simulate"));
  }
}

ExitStatus prove_run(const ProofArguments& arguments, std::istream& stream, Progress& progress,
                     const std::stop_token& stop) {
  RunReader run(stream, arguments.file, {.lenient = arguments.lenient});
  if (!arguments.scene.empty()) {
    require_scene(arguments, run.header());
  }
  VerifyRunOptions options{.threads = arguments.threads, .stop = stop};
  options.progress = [&](double time) { progress.doing(fmt::format("verified {:.4g} s", time)); };
  const RunVerification found = [&] {
    try {
      return verify_run(
          run.header(), [&] { return run.next(); }, options);
    } catch (const std::invalid_argument& error) {
      throw ParseError(arguments.file, error.what());
    }
  }();
  if (arguments.json) {
    fmt::print("{}\n", write_verification(run.header(), found));
  } else if (found.verdict == RunVerdict::broken) {
    throw ParseError(arguments.file, found.problem);
  } else {
    say(Description(arguments.file, run, found).write());
  }
  return status_of(found.verdict);
}

ExitStatus verify(const ProofArguments& arguments) {
  const Interrupt interrupt;  // First: other threads inherit what it blocks.
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
  command->add_option("--scene", arguments->scene,
                      "The file has to be one of this scene file as it is now");
  command->add_flag("--json", arguments->json, "Prints JSON in place of text for people");
  command->add_flag("--lenient", arguments->lenient,
                    "Names in files that nobody knows are warnings, as in a run with this option");
  command
      ->add_option("--threads", arguments->threads,
                   "At most so many; 0, the default, for one on each core. The answer is the same")
      ->check(CLI::Range(0, 1024));
  command->footer(kFooter);
  command->callback([arguments, &status] { status = verify(*arguments); });
}

}  // namespace firstcontact::app
