#include <firstcontact/verification/write_verification.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include <firstcontact/record/run.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene_files/write_reports.h>
#include <firstcontact/verification/verify_run.h>

namespace firstcontact {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(double number) { return std::isfinite(number) ? Json(number) : Json(); }

Json to_json(const RunHeader& header, const std::optional<RunMoment>& moment) {
  if (!moment) {
    return {};
  }
  const std::vector<std::string> names = names_with_links(header.scene);
  const auto name = [&](std::size_t body) { return names.at(body); };
  return {{"step", moment->step},
          {"time", to_json(moment->time)},
          {"bodies", Json::array({name(moment->bodies[0]), name(moment->bodies[1])})},
          {"distance", to_json(moment->distance)}};
}

}  // namespace

std::string write_verification(const RunHeader& header, const RunVerification& verification) {
  const Json result = {{"verdict", word(verification.verdict)},
                       {"problem", verification.problem},
                       {"problem_at", to_json(header, verification.problem_at)},
                       {"steps", verification.steps},
                       {"time", to_json(verification.time)},
                       {"time_lost", to_json(verification.time_lost)},
                       {"least_distance", to_json(verification.least_distance)},
                       {"closest", to_json(header, verification.closest)},
                       {"greatest_jump", to_json(verification.greatest_jump)},
                       {"scripted_deviation", to_json(verification.scripted_deviation)},
                       {"pair_counts", Json::parse(write_pair_counts(verification.pair_counts))},
                       {"warnings", verification.warnings}};
  return result.dump(-1, ' ', false, Json::error_handler_t::replace);
}

const char* word(RunVerdict verdict) { return kRunVerdictWords[static_cast<std::size_t>(verdict)]; }

}  // namespace firstcontact
