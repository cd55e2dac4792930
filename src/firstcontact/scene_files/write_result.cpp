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
#include <firstcontact/scene_files/detail/reports_json.h>
#include <firstcontact/scene_files/detail/result_json.h>
#include <firstcontact/scene_files/detail/robot_result.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_json.h>
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
  explicit ResultWriter(const LoadedScene& loaded) : scene_(loaded.scene), loaded_(loaded) {}

  [[nodiscard]] JsonObject result(const SceneResult& result, bool all_pairs) const {
    JsonObject object = head(result);
    if (result.closest) {
      object.push_back({"closest", closest(result.pairs[*result.closest])});
    }
    if (all_pairs) {
      object.push_back({"pairs", JsonValue{.value = pairs(result)}});
    }
    append_tolerance(result.tolerance_used, object);
    append_enclosure_error(greatest_enclosure_error(), object);
    return object;
  }

  [[nodiscard]] JsonObject head(const SceneResult& result) const {
    JsonObject object{{"id", to_json(scene_.id)},
                      {"verdict", to_json(word(result.verdict))},
                      {"reason", to_json(result.reason)},
                      {"t", to_json(result.t)},
                      {"t_upper", to_json(result.t_upper)},
                      {"time", to_json(result.t * scene_.duration)},
                      {"pair", result.first ? names(result.pairs[*result.first].bodies)
                                            : JsonValue{.value = JsonNull{}}}};
    append_contacts_at(result, object);
    object.push_back({"clearance", to_json(result.clearance)});
    return object;
  }

  [[nodiscard]] JsonValue closest(const PairAnswer& pair) const {
    const ClosestApproachResult& found = *pair.closest_approach;
    JsonObject object{{"pair", names(pair.bodies)},
                      {"distance", to_json(found.distance)},
                      {"lower_bound", to_json(found.lower_bound)},
                      {"t", to_json(found.t)},
                      {"time", to_json(found.t * scene_.duration)},
                      {"reason", to_json(found.reason)}};
    if (found.closest) {
      object.push_back({"points", two(to_json(found.closest->p_WA), to_json(found.closest->p_WB))});
    }
    return {.value = std::move(object)};
  }

  [[nodiscard]] JsonValue pair(const PairAnswer& pair) const {
    const FirstContactResult& found = pair.first_contact;
    ContactArray contacts(scene_.duration);
    append_contacts(pair, contacts);
    JsonObject object{{"pair", names(pair.bodies)},
                      {"margin", to_json(pair.margin)},
                      {"verdict", to_json(word(found.verdict))},
                      {"reason", to_json(found.reason)},
                      {"t", to_json(found.t)},
                      {"t_upper", to_json(found.t_upper)},
                      {"time", to_json(found.t * scene_.duration)},
                      {"contacts", contacts.take()}};
    detail::append_contact_count(found.contact_count, object);
    object.push_back({"clearance", to_json(found.clearance)});
    append_tolerance(found.tolerance_used, object);
    append_enclosure_error(loaded_.bodies.shape(pair.bodies[0]).enclosure_error() +
                               loaded_.bodies.shape(pair.bodies[1]).enclosure_error(),
                           object);
    if (pair.closest_approach) {
      object.push_back({"closest", closest(pair)});
    }
    return {.value = std::move(object)};
  }

  /// Only where it is not the one that was asked for.
  void append_tolerance(double tolerance_used, JsonObject& object) const {
    if (tolerance_used > scene_.options.tolerance) {
      object.push_back({"tolerance_used", to_json(tolerance_used)});
    }
  }

  /// Only where a curved body was enclosed by triangles.
  static void append_enclosure_error(double enclosure_error, JsonObject& object) {
    if (enclosure_error > 0.0) {
      object.push_back({"enclosure_error", to_json(enclosure_error)});
    }
  }

  [[nodiscard]] JsonValue sampling(const SamplingReport& report) const {
    return {.value = JsonObject{
                {"rate", to_json(report.rate)},
                {"samples", to_json(report.samples)},
                {"in_contact", to_json(report.in_contact)},
                {"least_distance", report.least ? to_json(report.least->distance) : JsonValue{}},
                {"time", report.least ? to_json(report.least->t * scene_.duration) : JsonValue{}}}};
  }

  [[nodiscard]] JsonArray pairs(const SceneResult& result) const {
    JsonArray array;
    for (const PairAnswer& answer : result.pairs) {
      array.push_back(pair(answer));
    }
    return array;
  }

 private:
  [[nodiscard]] JsonValue names(const BodyPair& bodies) const {
    return two(to_json(scene_.bodies[bodies[0]].name), to_json(scene_.bodies[bodies[1]].name));
  }

  void append_contacts(const PairAnswer& pair, ContactArray& array) const {
    array.set_names(names(pair.bodies));
    for (const Contact& found : pair.first_contact.contacts) {
      array.add(found);
    }
  }

  /// The contacts of every pair that touches at the scene's t.
  void append_contacts_at(const SceneResult& result, JsonObject& object) const {
    ContactArray array(scene_.duration);
    ContactCount count{0, true};
    for (const PairAnswer& pair : result.pairs) {
      if (result.first && pair.first_contact.t == result.t) {
        append_contacts(pair, array);
        count += pair.first_contact.contact_count;
      }
    }
    object.push_back({"contacts", array.take()});
    detail::append_contact_count(count, object);
  }

  /// [m]  Of any two bodies.
  [[nodiscard]] double greatest_enclosure_error() const {
    double greatest = 0.0;
    double second = 0.0;
    for (std::size_t k = 0; k < loaded_.bodies.size(); ++k) {
      const double error = loaded_.bodies.shape(k).enclosure_error();
      second = std::max(second, std::min(error, greatest));
      greatest = std::max(greatest, error);
    }
    return greatest + second;
  }

  const Scene& scene_;
  const LoadedScene& loaded_;
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
  JsonObject object = result.robots
                          ? detail::robot_result(loaded, *result.robots, options.all_pairs)
                          : writer.result(result, options.all_pairs);
  if (options.line) {
    object.insert(object.begin() + 1, {"line", to_json(*options.line)});  // After the id.
  }
  const std::vector<std::string> warnings = check_warnings(loaded);
  if (!result.robots && !warnings.empty()) {
    object.push_back({"warnings", to_json(warnings)});
  }
  if (options.sampling) {
    object.push_back({"sampling", writer.sampling(*options.sampling)});
  }
  object.push_back({"pair_counts", detail::pair_counts_json(loaded.pair_counts)});
  object.push_back({"files", detail::reports_json(loaded.files)});
  object.push_back({"scene", detail::parse_json(write_scene(loaded.scene), "scene", 1)});
  object.push_back({"version", to_json(version())});
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
