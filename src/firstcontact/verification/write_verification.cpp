#include <firstcontact/verification/write_verification.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include <firstcontact/record/run.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene_files/read_claims.h>
#include <firstcontact/scene_files/write_reports.h>
#include <firstcontact/verification/verify_path.h>
#include <firstcontact/verification/verify_result.h>
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

Json to_json(const std::optional<ProofMoment>& moment, double duration) {
  if (!moment) {
    return {};
  }
  return {{"pair", moment->pair},
          {"t", Json::array({to_json(moment->from), to_json(moment->to)})},
          {"time", Json::array({to_json(moment->from * duration), to_json(moment->to * duration)})},
          {"distance", moment->distance ? to_json(*moment->distance) : Json()}};
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
                       {"greatest_behind", to_json(verification.greatest_behind)},
                       {"pair_counts", Json::parse(write_pair_counts(verification.pair_counts))},
                       {"warnings", verification.warnings}};
  return result.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string write_verification(const ResultClaims& claims, const ResultVerification& found) {
  const Json result = {
      {"id", claims.scene.id},
      {"verdict", word(found.verdict)},
      {"problem", found.problem},
      {"problem_at", to_json(found.problem_at, claims.scene.duration)},
      {"claim",
       {{"verdict", to_string(claims.verdict)},
        {"t", to_json(found.t)},
        {"time", to_json(found.time)},
        {"tolerance", to_json(found.tolerance)}}},
      {"left_open", to_json(found.left_open)},
      {"contacts", found.contacts},
      {"contact_distance", found.contact_distance ? to_json(*found.contact_distance) : Json()},
      {"has_digests", found.has_digests},
      {"pair_counts", Json::parse(write_pair_counts(found.pair_counts))},
      {"warnings", found.warnings}};
  return result.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string write_verification(const PlannedPath& path, const PathVerification& found) {
  const auto optional = [](const auto& value) { return value ? Json(*value) : Json(); };
  const Json result = {{"id", path.scene.id},
                       {"verdict", word(found.verdict)},
                       {"problem", found.problem},
                       {"problem_at", to_json(found.problem_at, 1.0)},
                       {"problem_edge", optional(found.problem_edge)},
                       {"edges", found.edges},
                       {"waypoints", path.waypoints.size()},
                       {"reaches_goal", found.reaches_goal},
                       {"margin", to_json(path.margin)},
                       {"extra_clearance", to_json(path.extra_clearance)},
                       {"tested", found.tested},
                       {"warnings", found.warnings}};
  return result.dump(-1, ' ', false, Json::error_handler_t::replace);
}

const char* word(ProofVerdict verdict) {
  return kProofVerdictWords[static_cast<std::size_t>(verdict)];
}

}  // namespace firstcontact
