#include <firstcontact/scene_files/write_result.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/version.h>
#include <firstcontact/scene_files/detail/contact_json.h>
#include <firstcontact/scene_files/detail/joint_reports.h>
#include <firstcontact/scene_files/detail/reports_json.h>
#include <firstcontact/scene_files/detail/result_json.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/sha256.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::ContactArray;
using detail::JsonArray;
using detail::JsonNull;
using detail::JsonObject;
using detail::JsonValue;
using detail::to_json;
using detail::two;

/// Writes the parts of one scene's result.
class ResultWriter {
 public:
  explicit ResultWriter(const LoadedScene& loaded) : scene_(loaded.scene) {}

  [[nodiscard]] JsonObject result(const SceneResult& result, bool all_pairs) const {
    JsonObject object = head(result);
    if (result.closest) {
      object.push_back({"closest", closest(result.pairs[*result.closest])});
    }
    if (all_pairs) {
      object.push_back({"pairs", JsonValue{.value = pairs(result)}});
    }
    append_tolerances(result, object);
    return object;
  }

  [[nodiscard]] JsonValue sampling(const SamplingReport& report) const {
    return {.value = JsonObject{
                {"rate", to_json(report.rate)},
                {"samples", to_json(report.samples)},
                {"in_contact", to_json(report.in_contact)},
                {"least_distance", report.least ? to_json(report.least->distance) : JsonValue{}},
                {"time", report.least ? seconds(report.least->t) : JsonValue{}}}};
  }

 private:
  [[nodiscard]] JsonValue seconds(double t) const { return to_json(t * scene_.duration); }

  [[nodiscard]] JsonValue names(const BodyPair& members) const {
    return two(to_json(member_name(scene_, members[0])), to_json(member_name(scene_, members[1])));
  }

  [[nodiscard]] ContactArray no_contacts() const {
    return {scene_.duration, !scene_.robots.empty()};
  }

  [[nodiscard]] JsonObject head(const SceneResult& result) const {
    JsonObject object{{"id", to_json(scene_.id)}};
    append_outcome(result, object);
    object.push_back({"pair", result.first ? names(result.pairs[*result.first].members)
                                           : JsonValue{.value = JsonNull{}}});
    append_contacts_at(result, object);
    object.push_back({"clearance", to_json(result.clearance)});
    return object;
  }

  void append_outcome(const Outcome& outcome, JsonObject& object) const {
    object.push_back({"verdict", to_json(word(outcome.verdict))});
    object.push_back({"reason", to_json(outcome.reason)});
    object.push_back({"t", to_json(outcome.t)});
    object.push_back({"t_upper", to_json(outcome.t_upper)});
    object.push_back({"time", seconds(outcome.t)});
  }

  /// Appends tolerances that differ from those asked for, and the errors of triangles around curved
  /// shapes.
  void append_tolerances(const Outcome& outcome, JsonObject& object) const {
    if (outcome.tolerance_used > scene_.options.tolerance) {
      object.push_back({"tolerance_used", to_json(outcome.tolerance_used)});
    }
    if (outcome.enclosure_error > 0.0) {
      object.push_back({"enclosure_error", to_json(outcome.enclosure_error)});
    }
  }

  [[nodiscard]] JsonValue closest(const PairAnswer& pair) const {
    const ClosestApproach& found = *pair.closest;
    JsonObject object{{"pair", names(pair.members)},
                      {"distance", to_json(found.distance)},
                      {"lower_bound", to_json(found.lower_bound)},
                      {"t", to_json(found.t)},
                      {"time", seconds(found.t)},
                      {"reason", to_json(found.reason)}};
    if (found.closest) {
      object.push_back({"points", two(to_json(found.closest->p_WA), to_json(found.closest->p_WB))});
    }
    return {.value = std::move(object)};
  }

  [[nodiscard]] JsonArray pairs(const SceneResult& result) const {
    JsonArray array;
    for (const PairAnswer& answer : result.pairs) {
      array.push_back(pair(answer));
    }
    return array;
  }

  [[nodiscard]] JsonValue pair(const PairAnswer& pair) const {
    ContactArray contacts = no_contacts();
    append_contacts(pair, contacts);
    JsonObject object{{"pair", names(pair.members)}, {"margin", to_json(pair.margin)}};
    append_outcome(pair, object);
    object.push_back({"contacts", contacts.take()});
    detail::append_contact_count(pair.contact_count, object);
    object.push_back({"clearance", to_json(pair.clearance)});
    append_tolerances(pair, object);
    if (pair.closest) {
      object.push_back({"closest", closest(pair)});
    }
    if (!pair.intervals.empty()) {
      object.push_back({"intervals", JsonValue{.value = intervals(pair)}});
    }
    return {.value = std::move(object)};
  }

  [[nodiscard]] JsonArray intervals(const PairAnswer& pair) const {
    JsonArray array;
    for (const ContactInterval& interval : pair.intervals) {
      array.push_back({.value = JsonObject{{"enter", to_json(interval.enter)},
                                           {"leave", to_json(interval.leave)},
                                           {"enter_time", seconds(interval.enter)},
                                           {"leave_time", seconds(interval.leave)},
                                           {"reason", to_json(interval.reason)}}});
    }
    return array;
  }

  void append_contacts(const PairAnswer& pair, ContactArray& array) const {
    array.set_names(names(pair.members));
    for (const Contact& found : pair.contacts) {
      array.add(found);
    }
  }

  /// Appends the contacts of every pair that touches at the scene's t.
  void append_contacts_at(const SceneResult& result, JsonObject& object) const {
    ContactArray array = no_contacts();
    ContactCount count{0, true};
    for (const PairAnswer& pair : result.pairs) {
      if (result.first && pair.t == result.t) {
        append_contacts(pair, array);
        count += pair.contact_count;
      }
    }
    object.push_back({"contacts", array.take()});
    detail::append_contact_count(count, object);
  }

  const Scene& scene_;
};

JsonValue to_json(const WorkCount& work) {
  return {.value = JsonObject{{"node_groups", to_json(std::size_t{work.node_groups})},
                              {"triangle_pairs", to_json(std::size_t{work.triangle_pairs})},
                              {"steps", to_json(std::size_t{work.steps})}}};
}

}  // namespace

SamplingReport report_sampling(double rate, std::span<const GapSample> samples) {
  SamplingReport report{.rate = rate, .samples = samples.size(), .in_contact = 0, .least = {}};
  for (const GapSample& sample : samples) {
    report.in_contact += sample.contact ? 1 : 0;
    if (!report.least || sample.distance < report.least->distance) {
      report.least = sample;
    }
  }
  return report;
}

std::string write_result(const LoadedScene& loaded, const SceneResult& result,
                         const WriteResultOptions& options) {
  const ResultWriter writer(loaded);
  JsonObject object = writer.result(result, options.all_pairs);
  if (options.line) {
    object.insert(object.begin() + 1, {"line", to_json(*options.line)});  // After the id.
  }
  detail::append_joint_reports(loaded, object);
  const std::vector<std::string> warnings = check_warnings(loaded);
  if (!loaded.scene.robots.empty() || !warnings.empty()) {
    object.push_back({"warnings", to_json(warnings)});
  }
  if (options.sampling) {
    object.push_back({"sampling", writer.sampling(*options.sampling)});
  }
  object.push_back({"pair_counts", detail::pair_counts_json(loaded.pair_counts)});
  object.push_back({"files", detail::reports_json(loaded.files)});
  JsonValue scene = detail::parse_json(write_scene(loaded.scene), "scene", 1);
  const std::string resolved_digest = detail::sha256(detail::write_json(scene));
  object.push_back({"scene", std::move(scene)});
  object.push_back({"version", to_json(version())});
  object.push_back({"scene_digest", to_json(loaded.scene.text_digest)});
  object.push_back({"resolved_digest", to_json(resolved_digest)});
  object.push_back({"input_digest", to_json(loaded.input_digest)});
  object.push_back({"work", to_json(result.work)});
  return detail::write_json({.value = std::move(object)});
}

std::string write_error(std::string_view id, std::string_view file, std::optional<std::size_t> line,
                        std::string_view message, UndecidedReason reason) {
  JsonObject object{{"id", to_json(id)}, {"file", to_json(file)}};
  if (line) {
    object.push_back({"line", to_json(*line)});
  }
  object.push_back({"error", to_json(message)});
  if (reason != UndecidedReason::none) {
    object.push_back({"reason", to_json(reason)});
  }
  return detail::write_json({.value = std::move(object)});
}

}  // namespace firstcontact
