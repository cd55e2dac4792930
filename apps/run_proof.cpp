#include "run_proof.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/record/read_run.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_simulation_scene.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/verification/verify_run.h>
#include <firstcontact/verification/write_verification.h>

#include "pair_text.h"
#include "progress.h"
#include "quantity_text.h"
#include "terminal_text.h"

namespace firstcontact::app {
namespace {

/// Writes the lines of one answer, except for a broken record.
class RunDescription {
 public:
  RunDescription(const std::string& file, const RunReader& run, const RunVerification& found)
      : scene_(run.header().scene), run_(run), found_(found) {
    text_ = fmt::format("{}: {}\n", visible(file), verdict());
  }

  std::string write() {
    problem();
    line("verified", fmt::format("{}, {}{}", counted(found_.steps, "step"), time_text(found_.time),
                                 of_the_whole()));
    if (found_.verdict == ProofVerdict::proven && found_.closest) {
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
    for (const auto& [label, value] : last_proof_lines(found_.pair_counts, found_.warnings)) {
      line(label, value);
    }
    return text_;
  }

 private:
  [[nodiscard]] std::string verdict() const {
    if (found_.verdict == ProofVerdict::proven) {
      return "proven: " + no_penetration_text(found_.pair_counts);
    }
    return found_.verdict == ProofVerdict::refuted ? "refuted" : "not proven";
  }

  void line(const char* label, const std::string& value) { text_ += answer_line(label, value); }

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
      if (found_.verdict == ProofVerdict::refuted) {
        line("distance", at.distance > 0.0 ? length_text(at.distance) + " or less" : "0");
      }
    }
  }

  /// A note about the whole: a simulation may have ended early.
  [[nodiscard]] std::string of_the_whole() const {
    const double whole = scene_.simulation ? scene_.simulation->duration : 0.0;
    return found_.time < (1.0 - 1e-9) * whole ? " of " + time_text(whole) : "";
  }

  const Scene& scene_;
  const RunReader& run_;
  const RunVerification& found_;
  std::string text_;
};

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

/// Requires the scene of the run.
///
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

}  // namespace

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
  } else if (found.verdict == ProofVerdict::broken) {
    throw ParseError(arguments.file, found.problem);
  } else {
    say(RunDescription(arguments.file, run, found).write());
  }
  return status_of(found.verdict);
}

}  // namespace firstcontact::app
