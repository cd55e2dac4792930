#include <firstcontact/scene_files/read_planned_path.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/scene/detail/robot_name.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/file_report.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/read_path.h>
#include <firstcontact/text/sha256.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::find;
using detail::JsonArray;
using detail::JsonNull;
using detail::JsonObject;
using detail::JsonReader;
using detail::JsonValue;

constexpr std::size_t kMostCounted = std::size_t{1} << 53;

class PathReader {
 public:
  /// @param folders  in which the files of the path are looked for
  PathReader(const JsonReader& read, detail::SceneFolders folders)
      : read_(read), folders_(std::move(folders)) {}

  void take(const JsonValue& root, PlannedPath& path) const {
    (void)read_.object(root, {{"firstcontact_path",
                               "verdict",
                               "moves",
                               "waypoints",
                               "times",
                               "edges",
                               "margin",
                               "tolerance",
                               "extra_clearance",
                               "clearance",
                               "contact_pairs",
                               "goals",
                               "goal",
                               "distance_to_goal",
                               "cost",
                               "planner",
                               "statistics",
                               "scene",
                               "version",
                               "scene_digest",
                               "resolved_digest",
                               "input_digest",
                               "sources"}});
    require_own_scene(root);
    path.is_proven = read_.word(read_.member(root, "verdict"), {{"proven", "approximate"}}) == 0;
    take_mover(read_.member(root, "moves"), path);
    path.waypoints = rows(read_.member(root, "waypoints"), path);
    take_times(root, path);
    path.goals = rows(read_.member(root, "goals"), path);
    take_edges(read_.member(root, "edges"), path);
    path.margin = read_.not_negative(read_.member(root, "margin"));
    path.tolerance = read_.positive(read_.member(root, "tolerance"));
    path.extra_clearance = read_.not_negative(read_.member(root, "extra_clearance"));
    path.clearance = not_negative_or_null(read_.member(root, "clearance"));
    take_contact_pairs(root, path);
    take_goal(read_.member(root, "goal"), path);
    path.distance_to_goal = read_.not_negative(read_.member(root, "distance_to_goal"));
    path.cost = read_.not_negative(read_.member(root, "cost"));
    take_planner(read_.member(root, "planner"), path);
    take_statistics(read_.member(root, "statistics"), path.statistics);
    path.version = string_of(read_.member(root, "version"));
    path.scene.text_digest = string_of(read_.member(root, "scene_digest"));
    path.input_digest = string_of(read_.member(root, "input_digest"));
    if (path.input_digest.size() != 64) {
      read_.fail_expected("a SHA-256 in hexadecimal", read_.member(root, "input_digest"));
    }
    take_sources(root, path);
  }

 private:
  void require_own_scene(const JsonValue& root) const {
    const JsonValue& digest = read_.member(root, "resolved_digest");
    if (string_of(digest) != detail::sha256(detail::write_json(read_.member(root, "scene")))) {
      read_.fail(digest,
                 "the scene in the path is not the one that it was planned in; plan it again");
    }
  }

  void take_sources(const JsonValue& root, PlannedPath& path) const {
    const JsonValue* sources = find(std::get<JsonObject>(root.value), "sources");
    for (const JsonValue& source :
         sources == nullptr ? JsonArray() : read_.array(*sources, "files")) {
      (void)read_.object(source, {{"file", "sha256"}});
      path.sources.push_back({detail::found_file(string_of(read_.member(source, "file")), folders_),
                              string_of(read_.member(source, "sha256"))});
    }
  }

  std::string string_of(const JsonValue& value) const {
    const auto* text = std::get_if<std::string>(&value.value);
    return text != nullptr ? *text : read_.string(value, "a string");
  }

  std::optional<double> not_negative_or_null(const JsonValue& value) const {
    return std::holds_alternative<JsonNull>(value.value) ? std::nullopt
                                                         : std::optional(read_.not_negative(value));
  }

  std::size_t count(const JsonValue& value) const {
    return read_.index(value, kMostCounted, "a whole number");
  }

  void take_mover(const JsonValue& value, PlannedPath& path) const {
    const JsonObject& object =
        read_.object(value, {{"robot", "robots", "joints", "turning", "body"}});
    if (const JsonValue* body = find(object, "body")) {
      path.body = read_.string(*body, "the name of a body");
      require_name(path.scene.bodies, path.body, *body);
      if (object.size() == 1) {
        return;
      }
    }
    const std::vector<std::size_t> robots = take_robots(value, path);
    for (const JsonValue& joint : read_.array(read_.member(value, "joints"), "names of joints")) {
      path.joints.push_back(read_.string(joint, "the name of a joint"));
      require_joint(joint, robots, path);
      if (std::count(path.joints.begin(), path.joints.end(), path.joints.back()) > 1) {
        read_.fail(joint, "expected each joint once, got one twice");
      }
    }
    for (const JsonValue& turning : read_.array(read_.member(value, "turning"), "turnings")) {
      path.turnings.push_back(read_.enumerator<Turning>(turning, kTurningWords));
    }
    if (path.joints.empty() || path.turnings.size() != path.joints.size()) {
      read_.fail(value, "expected at least one joint, and a turning for each");
    }
  }

  /// The robots that move, by their numbers in the scene.
  std::vector<std::size_t> take_robots(const JsonValue& value, PlannedPath& path) const {
    std::vector<std::size_t> numbers;
    const auto take = [&](const JsonValue& name) {
      path.robots.push_back(read_.string(name, "the name of a robot"));
      const SceneRobot& robot = require_name(path.scene.robots, path.robots.back(), name);
      numbers.push_back(static_cast<std::size_t>(&robot - path.scene.robots.data()));
      if (std::count(numbers.begin(), numbers.end(), numbers.back()) > 1) {
        read_.fail(name, "expected each robot once, got one twice");
      }
    };
    const JsonValue* robots = find(std::get<JsonObject>(value.value), "robots");
    if (robots == nullptr) {
      take(read_.member(value, "robot"));
      return numbers;
    }
    if (find(std::get<JsonObject>(value.value), "robot") != nullptr) {
      read_.fail(value, "expected either \"robot\" or \"robots\", got both");
    }
    for (const JsonValue& name : read_.array(*robots, "names of robots")) {
      take(name);
    }
    if (numbers.size() < 2) {
      read_.fail_expected("at least two robots; a single one is \"robot\"", *robots);
    }
    return numbers;
  }

  /// The number of the body that moves; none where robots move alone.
  static std::optional<std::size_t> body_of(const PlannedPath& path) {
    const auto found = std::ranges::find(path.scene.bodies, path.body, &Body::name);
    return path.body.empty()
               ? std::nullopt
               : std::optional(static_cast<std::size_t>(found - path.scene.bodies.begin()));
  }

  /// Refuses the last joint of a path where none of its robots has it.
  void require_joint(const JsonValue& where, std::span<const std::size_t> robots,
                     const PlannedPath& path) const {
    try {
      const detail::RobotName split =
          detail::split_mover_name(path.scene, {robots, body_of(path)}, path.joints.back());
      if (split.which == robots.size()) {
        if (!pose_index(split.name)) {
          read_.fail_expected("a number of the pose of the body", where);
        }
        return;
      }
      if (known_coordinate(path.scene.robots[robots[split.which]].model, split.name)) {
        return;
      }
    } catch (const std::invalid_argument& error) {
      read_.fail(where, error.what());
    }
    read_.fail_expected("the name of a joint of the robot", where);
  }

  template <class Named>
  const Named& require_name(const std::vector<Named>& all, const std::string& name,
                            const JsonValue& where) const {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
    if (found == all.end()) {
      read_.fail_expected("a name that the scene has", where);
    }
    return *found;
  }

  std::vector<std::vector<double>> rows(const JsonValue& value, const PlannedPath& path) const {
    const std::size_t size = path.robots.empty() ? 7 : path.joints.size();
    std::vector<std::vector<double>> all;
    for (const JsonValue& row : read_.array(value, "an array of waypoints")) {
      std::vector<double> numbers;
      for (const JsonValue& number : read_.array(row, "a waypoint")) {
        numbers.push_back(read_.number(number));
      }
      if (numbers.size() != size) {
        read_.fail(row, "expected " + std::to_string(size) + " numbers, got " +
                            std::to_string(numbers.size()));
      }
      all.push_back(std::move(numbers));
    }
    if (all.empty()) {
      read_.fail_expected("at least one waypoint", value);
    }
    return all;
  }

  void take_times(const JsonValue& root, PlannedPath& path) const {
    const JsonValue* times = find(std::get<JsonObject>(root.value), "times");
    if (times == nullptr) {
      return;
    }
    for (const JsonValue& time : read_.array(*times, "an array of times")) {
      path.times.push_back(read_.not_negative(time));
      const std::size_t count = path.times.size();
      if (count > 1 && !(path.times[count - 2] < path.times[count - 1])) {
        read_.fail(time, "expected times that increase strictly");
      }
    }
    if (path.times.size() != path.waypoints.size() || path.times.size() < 2) {
      read_.fail(*times, "expected a time for each of the " +
                             std::to_string(path.waypoints.size()) + " waypoints, at least two");
    }
    if (path.times.front() != 0.0 || path.times.back() != path.scene.duration) {
      read_.fail(*times, "expected times from 0 to the duration of the scene");
    }
  }

  void take_edges(const JsonValue& value, PlannedPath& path) const {
    for (const JsonValue& edge : read_.array(value, "an array of edges")) {
      (void)read_.object(edge, {{"verdict", "clearance"}});
      (void)read_.word(read_.member(edge, "verdict"), {{"proven"}});
      path.clearances.push_back(not_negative_or_null(read_.member(edge, "clearance")));
    }
    if (path.clearances.size() + 1 != path.waypoints.size()) {
      read_.fail(value, "expected an edge for each two neighbouring waypoints, " +
                            std::to_string(path.waypoints.size() - 1) + ", got " +
                            std::to_string(path.clearances.size()));
    }
  }

  void take_contact_pairs(const JsonValue& root, PlannedPath& path) const {
    const JsonValue* pairs = find(std::get<JsonObject>(root.value), "contact_pairs");
    if (pairs == nullptr) {
      return;
    }
    for (const JsonValue& one : read_.array(*pairs, "an array of pairs in contact")) {
      (void)read_.object(one, {{"pair", "policy", "at", "distance"}});
      NamedContactPair contact;
      contact.pair = pair_of_names(read_.member(one, "pair"));
      contact.policy =
          read_.enumerator<ContactPolicy>(read_.member(one, "policy"), kContactPolicyWords);
      contact.at = read_.enumerator<PathEnd>(read_.member(one, "at"), kPathEndWords);
      contact.distance = read_.positive(read_.member(one, "distance"));
      path.contact_pairs.push_back(std::move(contact));
    }
  }

  std::array<std::string, 2> pair_of_names(const JsonValue& value) const {
    const JsonArray& names = read_.array(value, "a pair of names");
    if (names.size() != 2) {
      read_.fail_expected("a pair of names", value);
    }
    return {read_.string(names[0], "a name"), read_.string(names[1], "a name")};
  }

  void take_goal(const JsonValue& value, PlannedPath& path) const {
    if (!std::holds_alternative<JsonNull>(value.value)) {
      path.goal = read_.index(value, path.goals.size(), "the number of a goal");
    }
    if (path.goal.has_value() != path.is_proven) {
      read_.fail(value, "expected a goal in a proven path, and null in an approximate one");
    }
    if (path.goal && path.goals[*path.goal] != path.waypoints.back()) {
      read_.fail(value, "expected the goal that the last waypoint is, got another one");
    }
  }

  void take_planner(const JsonValue& value, PlannedPath& path) const {
    const JsonObject& object = read_.object(value, {{"name", "contacts", "seed", "time"}});
    path.planner = read_.enumerator<Planner>(read_.member(value, "name"), kPlannerWords);
    if (const JsonValue* contacts = find(object, "contacts")) {
      path.contacts = read_.enumerator<ContactUse>(*contacts, kContactUseWords);
    }
    path.seed = count(read_.member(value, "seed"));
    path.time = read_.positive(read_.member(value, "time"));
  }

  void take_statistics(const JsonValue& value, PlannedPathStatistics& statistics) const {
    (void)read_.object(value,
                       {{"seconds", "first_path_seconds", "iterations", "nodes", "edges_checked",
                         "states_checked", "undecided", "first_cost", "blocked"}});
    statistics.seconds = read_.not_negative(read_.member(value, "seconds"));
    statistics.first_path_seconds = not_negative_or_null(read_.member(value, "first_path_seconds"));
    statistics.iterations = count(read_.member(value, "iterations"));
    statistics.nodes = count(read_.member(value, "nodes"));
    statistics.edges_checked = count(read_.member(value, "edges_checked"));
    statistics.states_checked = count(read_.member(value, "states_checked"));
    statistics.undecided = count(read_.member(value, "undecided"));
    statistics.first_cost = not_negative_or_null(read_.member(value, "first_cost"));
    for (const JsonValue& one : read_.array(read_.member(value, "blocked"), "an array")) {
      (void)read_.object(one, {{"pair", "count"}});
      statistics.blocked.push_back(
          {pair_of_names(read_.member(one, "pair")), count(read_.member(one, "count"))});
    }
  }

  const JsonReader& read_;
  detail::SceneFolders folders_;
};

void require_format(const JsonValue& root, const JsonReader& read) {
  const auto* object = std::get_if<JsonObject>(&root.value);
  const JsonValue* version = object == nullptr ? nullptr : find(*object, "firstcontact_path");
  const auto* number = version == nullptr ? nullptr : std::get_if<double>(&version->value);
  if (number == nullptr || *number != 1.0) {
    read.fail(root, "expected a path, an object with \"firstcontact_path\": 1");
  }
}

bool is_there(const std::filesystem::path& file) {
  std::error_code error;
  return file.native().find('\0') == std::string::npos &&
         std::filesystem::is_regular_file(file, error);
}

std::string digest_of(const std::filesystem::path& file) {
  return detail::sha256(detail::read_file(file, "a file of the path"));
}

/// Requires that the files that are found are those from which the path was planned.
void require_same(std::span<const PathSource> sources) {
  for (const PathSource& source : sources) {
    if (is_there(source.file) && digest_of(source.file) != source.digest) {
      throw std::invalid_argument(source.file.string() +
                                  " is not what it was when the path was planned; restore the "
                                  "file, or plan again");
    }
  }
}

/// The digests of the files that a scene has loaded.
std::set<std::string> digests_of(const LoadedScene& loaded) {
  std::set<std::string> digests;
  const auto add = [&](const std::filesystem::path& file) {
    if (is_there(file)) {
      digests.insert(digest_of(file));
    }
  };
  for (const FileReport& report : loaded.files) {
    add(report.path);
    std::ranges::for_each(report.also_read, add);
  }
  return digests;
}

/// Warns of files that are not found. The scene stands in the path, so nothing needs them.
void warn_of_missing(std::span<const PathSource> sources, LoadedScene& loaded) {
  std::optional<std::set<std::string>> known;  // Files that the input digest has compared.
  for (const PathSource& source : sources) {
    if (is_there(source.file)) {
      continue;
    }
    if (!known) {
      known = digests_of(loaded);
    }
    if (!known->contains(source.digest)) {
      loaded.warnings.push_back(source.file.string() +
                                " is not found, so it is not known whether it has changed");
    }
  }
}

}  // namespace

PlannedPath parse_planned_path(std::string_view text, const std::filesystem::path& source,
                               const ReadingOptions& options) {
  const FloatEnvironmentGuard guard;
  const std::string name = source.string();
  const JsonValue root = detail::parse_json(text, name);
  const JsonReader read(root, name);
  require_format(root, read);
  PlannedPath path;
  path.scene = parse_embedded_scene(text, name, 1, options);
  PathReader(read, detail::folders_around(source)).take(root, path);
  return path;
}

PlannedPath read_planned_path(const std::filesystem::path& file, const ReadingOptions& options) {
  return parse_planned_path(detail::read_file(file, "a path file"), file, options);
}

LoadedScene load_scene_of(const PlannedPath& path, ShapeCache& cache) {
  return load_planned_scene(path.scene, {path.sources, path.input_digest}, cache);
}

LoadedScene load_planned_scene(const Scene& scene, const PathFiles& files, ShapeCache& cache) {
  require_same(files.sources);
  LoadedScene loaded = load_scene(scene, cache);
  if (loaded.input_digest != files.input_digest) {
    throw std::invalid_argument(
        "a mesh or robot file of its scene is not what it was when the path was planned; restore "
        "the file, or plan again");
  }
  warn_of_missing(files.sources, loaded);
  return loaded;
}

}  // namespace firstcontact
