#include "path_proof.h"

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/verification/verify_path.h>
#include <firstcontact/verification/write_verification.h>

#include "path_scene.h"
#include "progress.h"
#include "quantity_text.h"
#include "terminal_text.h"

namespace firstcontact::app {
namespace {

std::string path_headline(const PlannedPath& path, const PathVerification& found) {
  if (found.verdict == ProofVerdict::refuted) {
    return "refuted";
  }
  if (found.verdict != ProofVerdict::proven) {
    return "not proven";
  }
  const std::string what =
      path.waypoints.size() == 1 ? "one waypoint, no edge" : counted(found.edges, "edge");
  return "proven: " + what +
         (found.reaches_goal ? ", to a goal" : ", approximate: it ends before a goal");
}

std::string describe_path(const std::string& file, const PlannedPath& path,
                          const PathVerification& found) {
  std::string text = fmt::format("{}: {}\n", visible(file), path_headline(path, found));
  const auto line = [&](const char* label, const std::string& value) {
    text += answer_line(label, value);
  };
  if (!found.problem.empty()) {
    line("problem", found.problem);
  }
  if (found.problem_edge) {
    const std::size_t edge = *found.problem_edge;
    const std::string where = fmt::format("edge {} of {}, from waypoint {} on", edge + 1,
                                          path.waypoints.size() - 1, edge + 1);
    line("where", found.problem_at ? fmt::format("{}: t = {:.9g} to {:.9g}", where,
                                                 found.problem_at->from, found.problem_at->to)
                                   : where);
  }
  line("margin",
       fmt::format("{} and {} more", length_text(path.margin), length_text(path.extra_clearance)));
  if (found.verdict == ProofVerdict::proven && path.clearance) {
    line("clearance", lower_bound_text(*path.clearance) +
                          (path.contact_pairs.empty() ? "" : ", but for contact pairs"));
  }
  for (const NamedContactPair& one : path.contact_pairs) {
    line("contact", fmt::format("{} and {} at the {} ({}): {}", one.pair[0], one.pair[1],
                                kPathEndWords.at(static_cast<std::size_t>(one.at)),
                                kContactPolicyWords.at(static_cast<std::size_t>(one.policy)),
                                lower_bound_text(one.distance)));
  }
  line("tested", counted(found.tested, "pair"));
  for (const std::string& warning : found.warnings) {
    line("warning", warning);
  }
  return text;
}

}  // namespace

ExitStatus prove_path(const ProofArguments& arguments, const std::string& text, Progress& progress,
                      const std::stop_token& stop) {
  const PlannedPath path = parse_planned_path(text, arguments.file, {.lenient = arguments.lenient});
  std::vector<std::string> warnings;
  if (!arguments.scene.empty()) {
    warnings = require_scene_of_path(arguments, text, path);
  }
  VerifyResultOptions options{.threads = arguments.threads, .stop = stop};
  options.progress = [&](double t) {
    progress.doing(fmt::format("verified {:.3g} % of the path", 100.0 * t));
  };
  PathVerification found = [&] {
    try {
      return verify_path(path, options);
    } catch (const std::invalid_argument& error) {
      throw ParseError(arguments.file, error.what());
    }
  }();
  found.warnings.insert(found.warnings.end(), warnings.begin(), warnings.end());
  if (arguments.json) {
    fmt::print("{}\n", write_verification(path, found));
  } else if (found.verdict == ProofVerdict::broken) {
    throw ParseError(arguments.file, found.problem);
  } else {
    say(describe_path(arguments.file, path, found));
  }
  return status_of(found.verdict);
}

}  // namespace firstcontact::app
