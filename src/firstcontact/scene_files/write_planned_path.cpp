#include <firstcontact/scene_files/write_planned_path.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/sha256.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::JsonArray;
using detail::JsonNull;
using detail::JsonObject;
using detail::JsonValue;

JsonValue number_of(double number) {
  if (!std::isfinite(number)) {
    throw std::invalid_argument("a path file holds finite numbers only, got " +
                                std::to_string(number));
  }
  return {.value = number};
}

JsonValue count_of(std::size_t count) { return {.value = static_cast<double>(count)}; }
JsonValue text_of(std::string_view text) { return {.value = std::string(text)}; }

JsonValue number_or_null(const std::optional<double>& number) {
  return number ? number_of(*number) : JsonValue{.value = JsonNull{}};
}

JsonValue numbers_of(const std::vector<double>& row) {
  JsonArray numbers;
  for (const double number : row) {
    numbers.push_back(number_of(number));
  }
  return {.value = std::move(numbers)};
}

JsonValue rows_of(const std::vector<std::vector<double>>& rows) {
  JsonArray array;
  for (const std::vector<double>& row : rows) {
    array.push_back(numbers_of(row));
  }
  return {.value = std::move(array)};
}

JsonValue mover_of(const PlannedPath& path) {
  if (path.robots.empty()) {
    return {.value = JsonObject{{"body", text_of(path.body)}}};
  }
  JsonArray joints;
  JsonArray turnings;
  for (const std::string& joint : path.joints) {
    joints.push_back(text_of(joint));
  }
  for (const Turning turning : path.turnings) {
    turnings.push_back(text_of(to_string(turning)));
  }
  JsonArray robots;
  for (const std::string& robot : path.robots) {
    robots.push_back(text_of(robot));
  }
  const bool is_one = robots.size() == 1;
  JsonObject mover{{is_one ? "robot" : "robots",
                    is_one ? robots.front() : JsonValue{.value = std::move(robots)}}};
  if (!path.body.empty()) {
    mover.push_back({"body", text_of(path.body)});
  }
  mover.push_back({"joints", {.value = std::move(joints)}});
  mover.push_back({"turning", {.value = std::move(turnings)}});
  return {.value = std::move(mover)};
}

JsonValue edges_of(const PlannedPath& path) {
  JsonArray edges;
  for (const std::optional<double>& clearance : path.clearances) {
    edges.push_back({.value = JsonObject{{"verdict", text_of("proven")},
                                         {"clearance", number_or_null(clearance)}}});
  }
  return {.value = std::move(edges)};
}

JsonValue pair_of(const std::array<std::string, 2>& names) {
  return {.value = JsonArray{text_of(names[0]), text_of(names[1])}};
}

JsonValue contact_pairs_of(const PlannedPath& path) {
  JsonArray pairs;
  for (const NamedContactPair& one : path.contact_pairs) {
    pairs.push_back(
        {.value = JsonObject{
             {"pair", pair_of(one.pair)},
             {"policy", text_of(kContactPolicyWords.at(static_cast<std::size_t>(one.policy)))},
             {"at", text_of(kPathEndWords.at(static_cast<std::size_t>(one.at)))},
             {"distance", number_of(one.distance)}}});
  }
  return {.value = std::move(pairs)};
}

JsonValue statistics_of(const PlannedPathStatistics& statistics) {
  JsonArray blocked;
  for (const NamedBlockingPair& blocking : statistics.blocked) {
    blocked.push_back({.value = JsonObject{{"pair", pair_of(blocking.pair)},
                                           {"count", count_of(blocking.count)}}});
  }
  return {.value = JsonObject{{"seconds", number_of(statistics.seconds)},
                              {"first_path_seconds", number_or_null(statistics.first_path_seconds)},
                              {"iterations", count_of(statistics.iterations)},
                              {"nodes", count_of(statistics.nodes)},
                              {"edges_checked", count_of(statistics.edges_checked)},
                              {"states_checked", count_of(statistics.states_checked)},
                              {"undecided", count_of(statistics.undecided)},
                              {"first_cost", number_or_null(statistics.first_cost)},
                              {"blocked", {.value = std::move(blocked)}}}};
}

JsonValue sources_of(const PlannedPath& path) {
  JsonArray sources;
  for (const PathSource& source : path.sources) {
    sources.push_back({.value = JsonObject{{"file", text_of(source.file.string())},
                                           {"sha256", text_of(source.digest)}}});
  }
  return {.value = std::move(sources)};
}

}  // namespace

std::string write_planned_path(const PlannedPath& path) {
  const JsonValue planner = {
      .value = JsonObject{
          {"name", text_of(kPlannerWords.at(static_cast<std::size_t>(path.planner)))},
          {"contacts", text_of(kContactUseWords.at(static_cast<std::size_t>(path.contacts)))},
          {"seed", count_of(path.seed)},
          {"time", number_of(path.time)}}};
  JsonValue scene = detail::parse_json(write_scene(path.scene), "scene", 1);
  const std::string resolved_digest = detail::sha256(detail::write_json(scene));
  JsonObject object{{"firstcontact_path", count_of(1)},
                    {"verdict", text_of(path.is_proven ? "proven" : "approximate")},
                    {"moves", mover_of(path)},
                    {"waypoints", rows_of(path.waypoints)},
                    {"edges", edges_of(path)},
                    {"margin", number_of(path.margin)},
                    {"tolerance", number_of(path.tolerance)},
                    {"extra_clearance", number_of(path.extra_clearance)},
                    {"clearance", number_or_null(path.clearance)},
                    {"goals", rows_of(path.goals)},
                    {"goal", path.goal ? count_of(*path.goal) : JsonValue{.value = JsonNull{}}},
                    {"distance_to_goal", number_of(path.distance_to_goal)},
                    {"cost", number_of(path.cost)},
                    {"planner", planner},
                    {"statistics", statistics_of(path.statistics)},
                    {"scene", std::move(scene)},
                    {"version", text_of(path.version)},
                    {"scene_digest", text_of(path.scene.text_digest)},
                    {"resolved_digest", text_of(resolved_digest)},
                    {"input_digest", text_of(path.input_digest)}};
  if (!path.sources.empty()) {
    object.push_back({"sources", sources_of(path)});
  }
  const auto before = [&](const char* key) {
    return std::find_if(object.begin(), object.end(),
                        [&](const auto& member) { return member.key == key; });
  };
  if (!path.times.empty()) {
    object.insert(before("edges"), {"times", numbers_of(path.times)});
  }
  if (!path.contact_pairs.empty()) {
    object.insert(before("goals"), {"contact_pairs", contact_pairs_of(path)});
  }
  return detail::write_json({.value = std::move(object)});
}

std::vector<PathSource> path_sources(const std::vector<std::filesystem::path>& files) {
  std::vector<PathSource> sources;
  for (const std::filesystem::path& file : files) {
    if (std::ranges::find(sources, file, &PathSource::file) == sources.end()) {
      sources.push_back({file, detail::sha256(detail::read_file(file, "a file of the scene"))});
    }
  }
  return sources;
}

}  // namespace firstcontact
