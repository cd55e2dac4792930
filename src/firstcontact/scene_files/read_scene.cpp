#include <firstcontact/scene_files/read_scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/query/verdict_words.h>
#include <firstcontact/scene_files/detail/read_dynamics.h>
#include <firstcontact/scene_files/detail/read_haptics.h>
#include <firstcontact/scene_files/detail/read_motion.h>
#include <firstcontact/scene_files/detail/read_pairs.h>
#include <firstcontact/scene_files/detail/read_plan.h>
#include <firstcontact/scene_files/detail/read_pose.h>
#include <firstcontact/scene_files/detail/read_robots.h>
#include <firstcontact/scene_files/detail/read_shape.h>
#include <firstcontact/scene_files/detail/read_simulation.h>
#include <firstcontact/scene_files/detail/scene_text.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/read_path.h>
#include <firstcontact/text/sha256.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::find;
using detail::JsonArray;
using detail::JsonObject;
using detail::JsonReader;
using detail::JsonValue;
using detail::SceneFolders;

void require_version(const JsonValue& root, const JsonReader& read) {
  const auto* object = std::get_if<JsonObject>(&root.value);
  if (object == nullptr) {
    read.fail_expected("a scene, an object with \"firstcontact\": 1 and \"bodies\"", root);
  }
  const JsonValue* version = find(*object, "firstcontact");
  if (version == nullptr && find(*object, "rigid_body_problem") != nullptr) {
    read.fail(root, "this is a scene of Rigid IPC: such are for \"firstcontact simulate\" alone");
  }
  if (version == nullptr) {
    read.fail(root, "expected \"firstcontact\": 1, the version of the scene format");
  }
  const auto* number = std::get_if<double>(&version->value);
  if (number == nullptr || *number != 1.0) {
    read.fail_expected("1, the only version of the scene format that is known here", *version);
  }
}

SceneFolders with_package_roots(SceneFolders folders, const JsonObject& scene,
                                const JsonReader& read) {
  if (const JsonValue* roots = find(scene, "package_roots")) {
    folders.package_roots = detail::read_package_roots(*roots, folders, read);
  }
  return folders;
}

BodyMotion read_pose_or_motion(const JsonObject& body, const JsonReader& read) {
  const JsonValue* pose = find(body, "pose");
  const JsonValue* motion = find(body, "motion");
  if (pose != nullptr && motion != nullptr) {
    read.fail(*pose,
              "expected either \"pose\" (at rest) or \"motion\", got both; "
              "a motion begins at its own \"from\"");
  }
  if (motion != nullptr) {
    return detail::read_motion(*motion, read);
  }
  return FixedMotion{pose == nullptr ? Pose{} : detail::read_pose(*pose, read)};
}

/// Requires as many vertices as move; load_scene() compares the counts of a mesh in a file.
void require_vertices(const Body& body, const JsonValue& motion, const JsonReader& read) {
  const auto* mesh = std::get_if<Mesh>(&body.shape.source);
  if (mesh == nullptr && !std::holds_alternative<MeshFile>(body.shape.source)) {
    read.fail(motion,
              "expected another \"type\" than \"vertices\": only a \"mesh\", or \"vertices\" with "
              "\"triangles\", can deform");
  }
  const std::size_t count = std::get<VertexMotion>(body.motion).to.size();
  if (mesh != nullptr && count != mesh->vertices.size()) {
    read.fail(read.member(motion, "to"),
              "expected a place for each of the " + std::to_string(mesh->vertices.size()) +
                  " vertices of the shape, got " + std::to_string(count));
  }
}

/// Reads dynamics or a surface: a free body has its surface among its dynamics.
void read_dynamics_or_surface(const JsonObject& object, Body& body, const JsonReader& read) {
  const JsonValue* dynamics = find(object, "dynamics");
  const JsonValue* surface = find(object, "surface");
  if (dynamics != nullptr && find(object, "motion") != nullptr) {
    read.fail(*dynamics,
              "expected either \"dynamics\" (moved by forces, from its \"pose\") or \"motion\" "
              "(moved as it says), got both");
  }
  if (dynamics != nullptr && surface != nullptr) {
    read.fail(*surface,
              "expected \"friction\" and \"restitution\" in \"dynamics\", where a body has them");
  }
  if (dynamics != nullptr) {
    detail::read_dynamics(*dynamics, body, read);
  }
  if (surface != nullptr) {
    const JsonObject& given = read.object(*surface, {{"friction", "restitution", "velocity"}});
    body.surface = detail::read_surface(given, read);
    if (const JsonValue* velocity = find(given, "velocity")) {
      body.surface.velocity = read.vector3(*velocity);
    }
  }
}

Body read_body(const JsonValue& value, const SceneFolders& folders, const JsonReader& read) {
  const JsonObject& object =
      read.object(value, {{"name", "shape", "pose", "motion", "dynamics", "surface"}});
  Body body;
  body.name = read.string(read.member(value, "name"), "a name");
  body.shape = detail::read_shape(read.member(value, "shape"), folders, read);
  body.motion = read_pose_or_motion(object, read);
  if (std::holds_alternative<VertexMotion>(body.motion)) {
    require_vertices(body, read.member(value, "motion"), read);
  }
  read_dynamics_or_surface(object, body, read);
  return body;
}

std::vector<Body> read_bodies(const JsonValue& value, const SceneFolders& folders,
                              const JsonReader& read) {
  std::vector<Body> bodies;
  std::set<std::string> names;
  for (const JsonValue& element : read.array(value, "an array of bodies")) {
    bodies.push_back(read_body(element, folders, read));
    if (!names.insert(bodies.back().name).second) {
      read.fail_expected("a name that no other body has", read.member(element, "name"));
    }
  }
  return bodies;
}

/// Reads the choice of listed feature pairs: a word, or their greatest number.
ContactState read_contacts(const JsonValue& value, const JsonReader& read) {
  constexpr double kMost = 0x1p53;  // Doubles do not distinguish greater whole numbers.
  if (const auto* number = std::get_if<double>(&value.value)) {
    if (!(*number >= 1.0 && *number <= kMost && *number == std::trunc(*number))) {
      read.fail_expected(R"("none", "first", "all" or a whole number >= 1)", value);
    }
    return ContactState::nearest(static_cast<std::size_t>(*number));
  }
  constexpr std::array kStates{ContactState::none, ContactState::first, ContactState::all};
  return kStates.at(read.word(value, {{kContactStateWords.begin(), kContactStateWords.end()}}));
}

SceneOptions read_options(const JsonObject& object, const JsonReader& read) {
  SceneOptions options;
  if (const JsonValue* tolerance = find(object, "tolerance")) {
    options.tolerance = read.positive(*tolerance);
  }
  if (const JsonValue* margin = find(object, "margin")) {
    options.margin = read.not_negative(*margin);
  }
  if (const JsonValue* contacts = find(object, "contacts")) {
    options.contacts = read_contacts(*contacts, read);
  }
  if (const JsonValue* start_contacts = find(object, "start_contacts")) {
    options.start_contacts = read.enumerator<StartContacts>(*start_contacts, kStartContactsWords);
  }
  if (const JsonValue* contact_band = find(object, "contact_band")) {
    options.contact_band = read.not_negative(*contact_band);
  }
  if (const JsonValue* deadline = find(object, "deadline")) {
    options.deadline = read.positive(*deadline);
  }
  if (const JsonValue* lenient = find(object, "lenient")) {
    options.lenient = read.boolean(*lenient);
  }
  return options;
}

/// The duration of a scene.
///
/// @param asked      the duration that is given; may be null
/// @param simulated  the duration of the simulation; may be null
double scene_duration(const Scene& scene, const JsonValue* asked, const JsonValue* simulated,
                      const JsonReader& read) {
  const double last =
      std::max(last_time(scene), simulated == nullptr ? 0.0 : scene.simulation->duration);
  if (asked == nullptr) {
    return last > 0.0 ? last : 1.0;
  }
  const double duration = read.positive(*asked);
  // A simulation may end before the motions that span the scene.
  const bool fits = simulated == nullptr ? duration == last : duration >= last;
  if (last > 0.0 && !fits) {
    read.fail_expected(detail::write_json(last) + (simulated == nullptr ? "" : " or more") +
                           ", the last time of the " +
                           (simulated == nullptr ? "" : "simulation, the ") + "waypoints" +
                           (scene.robots.empty() ? "" : " and trajectories") +
                           " (or no \"duration\" at all)",
                       *asked);
  }
  return duration;
}

/// Makes the motions, which refuse some values themselves, such as too many turns.
void require_motions(const Scene& scene, const JsonArray& bodies, const JsonReader& read) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    try {
      (void)normalised_motion(scene.bodies[i].motion, scene.duration);
    } catch (const std::invalid_argument& error) {
      const JsonValue* motion = find(std::get<JsonObject>(bodies[i].value), "motion");
      read.fail(motion == nullptr ? bodies[i] : *motion, error.what());
    }
  }
}

/// Checks that all times fit together.
void require_times(const Scene& scene, const JsonObject& object, const JsonReader& read) {
  for (std::size_t i = 0; i < scene.robots.size(); ++i) {
    const SceneRobot& robot = scene.robots[i];
    const JsonValue& value = std::get<JsonArray>(find(object, "robots")->value)[i];
    for (const SceneAttachment& attachment : robot.attached) {
      if (!(attachment.from_time < scene.duration &&
            attachment.to_time.value_or(scene.duration) <= scene.duration)) {
        read.fail(read.member(value, "attached"), "expected times within the scene's duration, " +
                                                      detail::write_json(scene.duration) + " s");
      }
    }
    try {
      (void)normalised_motion(robot.base, scene.duration);
    } catch (const std::invalid_argument& error) {
      read.fail(value, error.what());
    }
  }
}

/// Reads the bodies and robots; at least one of them.
void read_members(const JsonValue& root, const JsonObject& object, const SceneFolders& folders,
                  Scene& scene, const JsonReader& read) {
  const JsonValue* robots = find(object, "robots");
  const JsonValue* bodies =
      robots == nullptr ? &read.member(root, "bodies") : find(object, "bodies");
  if (bodies != nullptr) {
    scene.bodies = read_bodies(*bodies, folders, read);
  }
  if (robots != nullptr) {
    detail::read_robots(*robots, folders, scene, read);
  }
  if (scene.bodies.empty() && scene.robots.empty()) {
    read.fail(bodies != nullptr ? *bodies : *robots,
              robots == nullptr ? "expected at least one body, got none"
                                : "expected at least one body or robot, got none");
  }
}

bool has_dynamics(const Scene& scene) {
  return std::ranges::any_of(scene.bodies,
                             [](const Body& body) { return body.free.has_value(); }) ||
         std::ranges::any_of(scene.robots,
                             [](const SceneRobot& robot) { return robot.dynamics.has_value(); });
}

/// Reads the simulation of a scene, or takes the defaults where bodies need one.
///
/// It returns the duration where that is given, else null.
const JsonValue* take_simulation(const JsonObject& object, Scene& scene, const JsonReader& read) {
  if (const JsonValue* simulation = find(object, "simulation")) {
    scene.simulation = detail::read_simulation(*simulation, scene, read);
    return find(std::get<JsonObject>(simulation->value), "duration");
  }
  if (has_dynamics(scene)) {
    scene.simulation.emplace();
  }
  return nullptr;
}

/// Reads the options of a scene, and those of reading its files.
///
/// @returns "options"; null where there are none
const JsonObject* take_options(const JsonObject& object, bool lenient, Scene& scene,
                               const JsonReader& read) {
  const JsonValue* options = find(object, "options");
  const JsonObject* given = nullptr;
  if (options != nullptr) {
    given = &read.object(*options, {{"tolerance", "margin", "contacts", "start_contacts",
                                     "contact_band", "deadline", "duration", "lenient"}});
    scene.options = read_options(*given, read);
  }
  scene.options.lenient = scene.options.lenient || lenient;
  return given;
}

Scene to_scene(const JsonValue& root, const SceneFolders& folders, const JsonReader& read,
               const ReadingOptions& options) {
  require_version(root, read);
  const JsonObject& object =
      read.object(root, {{"firstcontact", "id", "package_roots", "bodies", "robots", "pairs",
                          "options", "simulation", "plan", "haptics"}});
  Scene scene;
  if (const JsonValue* id = find(object, "id")) {
    const auto* text = std::get_if<std::string>(&id->value);
    scene.id = text != nullptr ? *text : read.string(*id, "a string");
  }
  const JsonObject* given = take_options(object, options.lenient, scene, read);
  read_members(root, object, with_package_roots(folders, object, read), scene, read);
  if (const JsonValue* pairs = find(object, "pairs")) {
    detail::read_pairs(*pairs, scene, read);
  }
  if (const JsonValue* plan = find(object, "plan")) {
    scene.plan = detail::read_plan(*plan, scene, read);
  }
  if (const JsonValue* haptics = find(object, "haptics")) {
    scene.haptics = detail::read_haptics(*haptics, scene, read);
  }
  const JsonValue* duration = given == nullptr ? nullptr : find(*given, "duration");
  const JsonValue* simulated = take_simulation(object, scene, read);
  scene.duration = scene_duration(scene, duration, simulated, read);
  if (scene.simulation && simulated == nullptr) {
    scene.simulation->duration = scene.duration;
  }
  if (const JsonValue* bodies = find(object, "bodies")) {
    require_motions(scene, std::get<JsonArray>(bodies->value), read);
  }
  require_times(scene, object, read);
  return scene;
}

Scene parse_in(const SceneFolders& folders, std::string_view text, const std::string& name,
               std::size_t first_line, const ReadingOptions& options) {
  const FloatEnvironmentGuard guard;
  const JsonValue root = detail::parse_json(text, name, first_line);
  Scene scene = to_scene(root, folders, JsonReader(root, name), options);
  const std::string own_digest = detail::sha256(text);
  scene.text_digest = scene.text_digest.empty()
                          ? own_digest
                          : detail::sha256(own_digest + '\n' + scene.text_digest);
  return scene;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& source,
                  std::size_t first_line, const ReadingOptions& options) {
  return parse_in({.scene = source.parent_path()}, text, source.string(), first_line, options);
}

Scene parse_embedded_scene(std::string_view text, const std::string& name, std::size_t first_line,
                           const ReadingOptions& options) {
  const JsonValue root = detail::parse_json(text, name, first_line);
  const auto* object = std::get_if<JsonObject>(&root.value);
  const JsonValue* scene = object == nullptr ? nullptr : find(*object, "scene");
  if (scene == nullptr) {
    throw ParseError(name, first_line, "expected an object with a \"scene\"");
  }
  const std::string own = "scene";
  try {
    return parse_in(detail::folders_around(name), detail::write_json(*scene), own, 1, options);
  } catch (const ParseError& error) {
    if (error.path() != own) {
      throw;  // A file that the scene names is wrong.
    }
    throw ParseError(name, scene->line, "scene: " + error.message());
  }
}

Scene read_scene(const std::filesystem::path& path, const ReadingOptions& options) {
  return parse_scene(detail::scene_text(path), path, 1, options);
}

}  // namespace firstcontact
