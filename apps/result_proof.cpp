#include "result_proof.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/scene_files/read_claims.h>
#include <firstcontact/scene_files/read_result.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/verification/provable_file.h>
#include <firstcontact/verification/verify_result.h>
#include <firstcontact/verification/write_verification.h>

#include "pair_text.h"
#include "progress.h"
#include "quantity_text.h"
#include "standard_streams.h"
#include "terminal_text.h"

namespace firstcontact::app {
namespace {

std::string at_most(double metres) {
  const std::string text = length_text(metres);
  return metres == 0.0 ? "0" : (text.starts_with("below") ? text : text + " or less");
}

/// Writes the lines of one answer.
class ResultDescription {
 public:
  ResultDescription(const ResultClaims& claims, const ResultVerification& found)
      : claims_(claims), found_(found) {}

  std::string write(const std::string& name) {
    text_ = fmt::format("{}: {}\n", visible(name), headline());
    if (found_.verdict != ProofVerdict::proven) {
      line("claim", claim());
    }
    problem();
    if (found_.contact_distance) {
      line("contact", contact());
    }
    if (found_.left_open > 0.0) {
      line("left open", fmt::format("the last {:.2g} before t, where a pair is about to touch",
                                    found_.left_open));
    }
    if (!found_.has_digests) {
      line("warning",
           "the result states no digest of its scene: whether the scene or a file has changed is "
           "not known");
    }
    for (const auto& [label, value] : last_proof_lines(found_.pair_counts, found_.warnings)) {
      line(label, value);
    }
    return text_;
  }

 private:
  [[nodiscard]] std::string headline() const {
    switch (found_.verdict) {
      case ProofVerdict::proven:
        return "proven: " + claim();
      case ProofVerdict::refuted:
        return "refuted";
      case ProofVerdict::broken:
        return "broken";
      case ProofVerdict::not_proven:
        break;
    }
    return "not proven";
  }

  [[nodiscard]] std::string claim() const {
    const std::string at = fmt::format("t = {:.9g} ({})", found_.t, time_text(found_.time));
    switch (claims_.verdict) {
      case Verdict::free:
        return "free";
      case Verdict::contact:
        return "contact at " + at + ", free before";
      case Verdict::contact_at_start:
        return "contact at the start";
      case Verdict::undecided:
        break;
    }
    return "free until " + at + ", nothing is said of later";
  }

  [[nodiscard]] std::string contact() const {
    const std::string pairs = claims_.pairs && found_.contacts > 1
                                  // The first counts twice.
                                  ? fmt::format("{} pairs, among them ", found_.contacts - 1)
                                  : "";
    return fmt::format("{}{} and {} at t: {}, {} allowed beyond the margin", pairs,
                       claims_.pair.value()[0], claims_.pair.value()[1],
                       at_most(*found_.contact_distance), length_text(found_.tolerance));
  }

  void line(const char* label, const std::string& value) { text_ += answer_line(label, value); }

  void problem() {
    if (!found_.problem.empty()) {
      line("problem", found_.problem);
    }
    if (found_.problem_at) {
      const ProofMoment& at = *found_.problem_at;
      line("when", at.from == at.to ? fmt::format("t = {:.17g}", at.from)
                                    : fmt::format("t = {:.17g} to {:.17g}", at.from, at.to));
      if (at.distance) {
        line("distance", at_most(*at.distance));
      }
    }
  }

  const ResultClaims& claims_;
  const ResultVerification& found_;
  std::string text_;
};

struct ResultLine {
  std::string_view text;
  std::size_t line = 1;
};

/// The lines of a text: one object over several lines, or one on each.
std::vector<ResultLine> lines_of(std::string_view text) {
  const std::size_t end = text.find('\n');
  if (provable_file(text.substr(0, end)) != ProvableFile::result) {
    return {{text, 1}};
  }
  std::vector<ResultLine> lines;
  std::size_t number = 1;
  for (std::size_t from = 0; from < text.size(); ++number) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    const std::string_view line = text.substr(from, to - from);
    if (line.find_first_not_of(" \t\r") != std::string_view::npos) {
      lines.push_back({line, number});
    }
    from = to + 1;
  }
  return lines;
}

class ResultsProof {
 public:
  ResultsProof(const ProofArguments& arguments, Progress& progress, const std::stop_token& stop)
      : arguments_(arguments), progress_(progress), stop_(stop) {
    if (!arguments.scene.empty()) {
      digest_ = read_scene(arguments.scene, reading()).text_digest;
    }
  }

  ExitStatus prove(const ResultLine& result, bool is_alone) {
    const ResultSummary summary = read_summary(result.text, arguments_.file, result.line);
    if (!summary.verdict) {
      throw ParseError(arguments_.file, result.line,
                       "expected a result, this line has an error in place of one");
    }
    const ResultClaims claims = read_claims(result.text, arguments_.file, result.line, reading());
    if (!digest_.empty() && claims.scene.text_digest != digest_) {
      throw ParseError(
          arguments_.file, result.line,
          "the result is not one of " + arguments_.scene + " as it is now; check it again");
    }
    const ResultVerification found = verify(claims, result.line);
    const std::string name =
        is_alone ? arguments_.file : fmt::format("{}:{}", arguments_.file, result.line);
    if (arguments_.json) {
      fmt::print("{}\n", write_verification(claims, found));
    } else if (found.verdict == ProofVerdict::broken) {
      throw ParseError(arguments_.file, result.line, found.problem);
    } else {
      say(ResultDescription(claims, found).write(name));
    }
    return status_of(found.verdict);
  }

 private:
  [[nodiscard]] ReadingOptions reading() const { return {.lenient = arguments_.lenient}; }

  [[nodiscard]] ResultVerification verify(const ResultClaims& claims, std::size_t line) const {
    VerifyResultOptions options{.threads = arguments_.threads, .stop = stop_};
    options.progress = [&](double t) {
      progress_.doing(fmt::format("verified {:.3g} % of the time", 100.0 * t));
    };
    try {
      return verify_result(claims, options);
    } catch (const std::invalid_argument& error) {
      throw ParseError(arguments_.file, line, error.what());
    }
  }

  const ProofArguments& arguments_;
  Progress& progress_;
  std::stop_token stop_;
  std::string digest_;
};

}  // namespace

ExitStatus prove_results(const ProofArguments& arguments, const std::string& text,
                         Progress& progress, const std::stop_token& stop) {
  ResultsProof proof(arguments, progress, stop);
  const std::vector<ResultLine> lines = lines_of(text);
  ExitStatus status = kSuccess;
  for (const ResultLine& line : lines) {
    status = worse(status, proof.prove(line, lines.size() == 1));
  }
  return status;
}

}  // namespace firstcontact::app
