#include <firstcontact/scene/read_rigid_ipc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/geometry/parse_error.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/motion/rotation_forms.h>
#include <firstcontact/scene/detail/json_reader.h>
#include <firstcontact/scene/detail/parse_json.h>
#include <firstcontact/scene/detail/read_file.h>
#include <firstcontact/scene/detail/rigid_ipc_body.h>
#include <firstcontact/scene/detail/rigid_ipc_meshes.h>
#include <firstcontact/scene/detail/sha256.h>
#include <firstcontact/scene/detail/write_json.h>
#include <firstcontact/scene/read_scene.h>

namespace firstcontact {
namespace {

using detail::find;
using detail::in_quotes;
using detail::JsonArray;
using detail::JsonObject;
using detail::JsonReader;
using detail::JsonValue;
using detail::RigidIpcBody;
using detail::RigidIpcMeshes;
using detail::RigidIpcType;
using detail::weigh;
using detail::WeighedShape;
using Eigen::Vector3d;

constexpr const char* kProblem = "rigid_body_problem";

class FixtureReader {
 public:
  FixtureReader(const JsonValue& root, const std::filesystem::path& source, const JsonReader& read)
      : root_(root), read_(read), meshes_(source) {}

  Scene scene(const std::filesystem::path& source) {
    const JsonObject& fixture =
        object(root_, {"scene_type", "solver", "timestep", "max_time", "max_iterations", kProblem,
                       "distance_barrier_constraint", "friction_constraints", "ipc_solver",
                       "newton_solver", "homotopy_solver", "ncp_solver", "volume_constraint",
                       "viewport_bbox"});
    scene_.id = source.stem().string();
    scene_.simulation.emplace();
    simulation().step = positive_or(fixture, "timestep", 0.01);
    scene_.duration = simulation().duration = duration(fixture);
    simulation().contact_distance = contact_distance(fixture);
    const JsonObject& problem =
        object(read_.member(root_, kProblem),
               {"rigid_bodies", "coefficient_restitution", "coefficient_friction", "gravity",
                "collision_eps", "time_stepper", "do_intersection_check"});
    simulation().gravity = vector_or_zero(problem, "gravity");
    simulation().friction = friction(fixture, problem);
    simulation().restitution = restitution(problem);
    const JsonValue& bodies = read_.member(read_.member(root_, kProblem), "rigid_bodies");
    for (const JsonValue& body : read_.array(bodies, "an array of bodies")) {
      add_entry(body);
    }
    if (scene_.bodies.empty()) {
      read_.fail(bodies, "expected at least one body that is enabled, got none");
    }
    name_bodies();
    group_bodies();
    return std::move(scene_);
  }

  [[nodiscard]] std::string digests() const { return meshes_.digests(); }

 private:
  /// What names and groups are made of, for each body of the scene.
  struct Origin {
    std::string name;
    std::size_t number = 0;  ///< In the file.
    bool is_free = false;
    double group = -1.0;
  };

  Simulation& simulation() { return *scene_.simulation; }

  /// Warns of unknown keys.
  const JsonObject& object(const JsonValue& value, const std::vector<std::string_view>& known) {
    const auto* members = std::get_if<JsonObject>(&value.value);
    if (members == nullptr) {
      read_.fail_expected("an object", value);
    }
    for (const auto& [key, member] : *members) {
      if (!key.starts_with('#') && std::ranges::find(known, key) == known.end()) {
        scene_.warnings.push_back("line " + std::to_string(member.line) + ": unknown key " +
                                  in_quotes(key) + " passed over");
      }
    }
    return *members;
  }

  [[nodiscard]] double positive_or(const JsonObject& object, std::string_view key,
                                   double otherwise) const {
    const JsonValue* value = find(object, key);
    return value == nullptr ? otherwise : read_.positive(*value);
  }

  [[nodiscard]] Vector3d vector_or_zero(const JsonObject& object, std::string_view key) const {
    const JsonValue* value = find(object, key);
    return value == nullptr ? Vector3d(Vector3d::Zero()) : read_.vector3(*value);
  }

  /// [rad, or what else there is in degrees]
  [[nodiscard]] Vector3d degrees_or_zero(const JsonObject& object, std::string_view key) const {
    return vector_or_zero(object, key) * (std::numbers::pi / 180.0);
  }

  /// Negative: not given.
  double duration(const JsonObject& fixture) {
    constexpr double kStepsByDefault = 1000.0;
    const JsonValue* time = find(fixture, "max_time");
    if (time != nullptr && read_.number(*time) > 0.0) {
      return read_.number(*time);
    }
    const JsonValue* steps = find(fixture, "max_iterations");
    const bool given = steps != nullptr && read_.number(*steps) > 0.0;
    const double result = simulation().step * (given ? read_.number(*steps) : kStepsByDefault);
    if (!std::isfinite(result) || !(result > 0.0)) {
      read_.fail(root_, "expected a duration that fits a double");
    }
    return result;
  }

  double contact_distance(const JsonObject& fixture) {
    double activation = 1e-3;
    double separation = 0.0;
    if (const JsonValue* value = find(fixture, "distance_barrier_constraint")) {
      const JsonObject& barrier =
          object(*value, {"initial_barrier_activation_distance", "minimum_separation_distance",
                          "detection_method", "trajectory_type", "barrier_type"});
      activation = positive_or(barrier, "initial_barrier_activation_distance", activation);
      if (const JsonValue* least = find(barrier, "minimum_separation_distance")) {
        separation = read_.not_negative(*least);
      }
    }
    return separation + 0.1 * activation;
  }

  double friction(const JsonObject& fixture, const JsonObject& problem) {
    if (const JsonValue* value = find(fixture, "friction_constraints")) {
      const JsonObject& solver = object(*value, {"static_friction_speed_bound", "iterations"});
      const JsonValue* iterations = find(solver, "iterations");
      if (iterations != nullptr && read_.number(*iterations) == 0.0) {
        return 0.0;
      }
    }
    const JsonValue* friction = find(problem, "coefficient_friction");
    return friction == nullptr ? 0.0 : read_.not_negative(*friction);
  }

  /// Negative: left to the solver, which has none.
  [[nodiscard]] double restitution(const JsonObject& problem) const {
    const JsonValue* value = find(problem, "coefficient_restitution");
    const double restitution = value == nullptr ? 0.0 : read_.number(*value);
    if (!(restitution <= 1.0)) {
      read_.fail_expected("a number of at most 1", *value);
    }
    return std::max(0.0, restitution);
  }

  void add_entry(const JsonValue& value) {
    const std::size_t number = entries_++;
    const JsonObject& entry =
        object(value, {"mesh", "enabled", "type", "density", "is_dof_fixed", "oriented", "group_id",
                       "position", "rotation", "scale", "dimensions", "linear_velocity",
                       "angular_velocity", "force", "torque", "kinematic_max_time",
                       "kinematic_poses", "split_components", "ipc_comparison_enabled"});
    const JsonValue* enabled = find(entry, "enabled");
    if (enabled != nullptr && !read_.boolean(*enabled)) {
      return;
    }
    const JsonValue* mesh = find(entry, "mesh");
    if (mesh == nullptr) {
      read_.fail(value, "expected a key \"mesh\": bodies whose vertices stand here are not read");
    }
    const RigidIpcBody body = read_body(entry);
    const std::filesystem::path file = meshes_.find(*mesh, read_);
    const Vector3d scale = read_scale(entry, meshes_.load(file));
    const Origin origin{file.stem().string(), number, body.type == RigidIpcType::dynamic,
                        read_group(entry)};
    const JsonValue* split = find(entry, "split_components");
    try {
      if (split != nullptr && read_.boolean(*split)) {
        add_parts(body, origin, detail::scaled(meshes_.load(file), scale));
      } else {
        add_whole(body, origin, file, scale);
      }
    } catch (const std::invalid_argument& error) {
      read_.fail(value, error.what());
    }
  }

  RigidIpcBody read_body(const JsonObject& entry) {
    RigidIpcBody body;
    body.X_WB = {.position = vector_or_zero(entry, "position"),
                 .rotation = rotation_from_rpy(degrees_or_zero(entry, "rotation"))};
    body.density = positive_or(entry, "density", body.density);
    body.linear_velocity = vector_or_zero(entry, "linear_velocity");
    body.angular_velocity = degrees_or_zero(entry, "angular_velocity");
    body.force = vector_or_zero(entry, "force");
    body.torque = degrees_or_zero(entry, "torque");
    if (const JsonValue* type = find(entry, "type")) {
      constexpr std::array kTypes{RigidIpcType::fixed, RigidIpcType::kinematic,
                                  RigidIpcType::dynamic};
      body.type = kTypes.at(read_.word(*type, {{"static", "kinematic", "dynamic"}}));
    }
    read_locks(entry, body);
    const JsonValue* until = find(entry, "kinematic_max_time");
    if (until != nullptr && read_.number(*until) >= 0.0) {
      body.moves_until = read_.number(*until);
    }
    if (const JsonValue* poses = find(entry, "kinematic_poses")) {
      for (const JsonValue& element : read_.array(*poses, "an array of poses")) {
        const JsonObject& pose = object(element, {"position", "rotation"});
        body.poses.push_back({.position = vector_or_zero(pose, "position"),
                              .rotation = rotation_from_vector(vector_or_zero(pose, "rotation"))});
      }
    }
    return body;
  }

  void read_locks(const JsonObject& entry, RigidIpcBody& body) const {
    const JsonValue* value = find(entry, "is_dof_fixed");
    if (value == nullptr) {
      return;
    }
    std::array<bool, 6> locks{};
    if (std::holds_alternative<bool>(value->value)) {
      locks.fill(read_.boolean(*value));
    } else {
      const std::string expected =
          "true, false, or six of them: three for translation, three for "
          "rotation";
      const JsonArray& elements = read_.array(*value, expected);
      if (elements.size() != locks.size()) {
        read_.fail_expected(expected, *value);
      }
      std::ranges::transform(elements, locks.begin(),
                             [this](const JsonValue& lock) { return read_.boolean(lock); });
    }
    std::copy_n(locks.begin(), 3, body.locked_translation.begin());
    std::copy_n(locks.begin() + 3, 3, body.locked_rotation.begin());
    if (std::ranges::find(locks, false) == locks.end()) {
      body.type = RigidIpcType::fixed;
    }
    for (int k = 0; k < 3; ++k) {
      body.linear_velocity[k] *= body.locked_translation[k] ? 0.0 : 1.0;
      body.angular_velocity[k] *= body.locked_rotation[k] ? 0.0 : 1.0;
    }
  }

  [[nodiscard]] double read_group(const JsonObject& entry) const {
    const JsonValue* group = find(entry, "group_id");
    return group == nullptr ? -1.0 : read_.number(*group);
  }

  /// Dimensions prevail; along an axis without extent they are factors.
  [[nodiscard]] Vector3d read_scale(const JsonObject& entry, const Mesh& mesh) const {
    if (const JsonValue* dimensions = find(entry, "dimensions")) {
      const Vector3d extent = detail::extent(mesh);
      return read_.vector3(*dimensions)
          .cwiseQuotient((extent.array() == 0.0).select(Vector3d::Ones(), extent));
    }
    const JsonValue* scale = find(entry, "scale");
    if (scale == nullptr) {
      return Vector3d::Ones();
    }
    return std::holds_alternative<double>(scale->value)
               ? Vector3d(Vector3d::Constant(read_.number(*scale)))
               : read_.vector3(*scale);
  }

  void add_parts(const RigidIpcBody& body, const Origin& origin, const Mesh& mesh) {
    const std::vector<Mesh> parts = detail::split_components(mesh);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      Origin part = origin;
      part.name += "-part" + std::to_string(k);
      add_body(body, part, weigh(parts[k]));
    }
  }

  /// Equal ones share their shape. The file stands for it where it says the same.
  void add_whole(const RigidIpcBody& body, const Origin& origin, const std::filesystem::path& file,
                 const Vector3d& scale) {
    const Mesh& mesh = meshes_.load(file);
    const std::tuple key(file, scale.x(), scale.y(), scale.z());
    auto known = weighed_.find(key);
    if (known == weighed_.end()) {
      known = weighed_.emplace(key, weigh(detail::scaled(mesh, scale))).first;
    }
    add_body(body, origin, known->second);
    const bool is_uniform = scale.x() > 0.0 && scale == Vector3d::Constant(scale.x());
    const bool is_cloud =
        std::ranges::all_of(mesh.triangles, [](const auto& t) { return t[0] == t[1]; });
    if (body.type != RigidIpcType::kinematic && is_uniform && !is_cloud) {
      scene_.bodies.back().shape.source = MeshFile{file, scale.x()};
    }
  }

  void add_body(const RigidIpcBody& body, const Origin& origin, const WeighedShape& weighed) {
    Body& added = scene_.bodies.emplace_back();
    origins_.push_back(origin);
    added.shape.source = weighed.shape;
    added.motion = FixedMotion{body.X_WB};
    if (body.type == RigidIpcType::dynamic) {
      added.free = detail::free_body(body, weighed);
    } else if (body.type == RigidIpcType::kinematic) {
      // It turns about the centre of mass, a scripted body about the origin of its frame.
      added.shape.source = Shape(detail::moved(weighed.shape.mesh(), -weighed.p_BC));
      added.motion =
          detail::scripted_motion(body, weighed, simulation().step, simulation().duration);
      (void)normalised_motion(added.motion, scene_.duration);
    }
  }

  void name_bodies() {
    std::map<std::string, int> count;
    for (const Origin& origin : origins_) {
      ++count[origin.name];
    }
    std::set<std::string> taken;
    for (std::size_t k = 0; k < origins_.size(); ++k) {
      std::string name = origins_[k].name;
      if (count[name] > 1) {
        name += "-" + std::to_string(origins_[k].number);
      }
      scene_.bodies[k].name = free_name(std::move(name), taken);
    }
    names_ = std::move(taken);
  }

  /// The name, or one like it that is not taken; takes it.
  static std::string free_name(std::string name, std::set<std::string>& taken) {
    while (!taken.insert(name).second) {
      name += "'";
    }
    return name;
  }

  /// Bodies that do not move freely are of one group, with all of the groups that they are in.
  void group_bodies() {
    constexpr double kNone = -1.0;
    std::set<double> not_free;
    for (const Origin& origin : origins_) {
      if (!origin.is_free && origin.group >= 0.0) {
        not_free.insert(origin.group);
      }
    }
    std::map<double, std::vector<std::size_t>> groups;
    for (std::size_t k = 0; k < origins_.size(); ++k) {
      const Origin& origin = origins_[k];
      if (!origin.is_free || not_free.contains(origin.group)) {
        groups[kNone].push_back(k);
      } else if (origin.group >= 0.0) {
        groups[origin.group].push_back(k);
      }
    }
    for (auto& [id, members] : groups) {
      if (members.size() < 2) {
        continue;
      }
      const std::string name = id == kNone ? "not free" : "group " + detail::write_json(id);
      scene_.ignored_groups.push_back({scene_.groups.size(), scene_.groups.size()});
      scene_.groups.push_back({free_name(name, names_), std::move(members)});
    }
  }

  const JsonValue& root_;
  const JsonReader& read_;
  RigidIpcMeshes meshes_;
  Scene scene_;
  std::size_t entries_ = 0;
  std::vector<Origin> origins_;
  std::set<std::string> names_;
  std::map<std::tuple<std::filesystem::path, double, double, double>, WeighedShape> weighed_;
};

bool is_fixture(const JsonValue& root) {
  const auto* object = std::get_if<JsonObject>(&root.value);
  return object != nullptr && find(*object, kProblem) != nullptr;
}

}  // namespace

Scene parse_rigid_ipc(std::string_view text, const std::filesystem::path& source) {
  const FloatEnvironmentGuard guard;
  const std::string name = source.string();
  const JsonValue root = detail::parse_json(text, name);
  const JsonReader read(root, name);
  if (!is_fixture(root)) {
    read.fail(root, "expected a scene of Rigid IPC, an object with \"rigid_body_problem\"");
  }
  FixtureReader reader(root, source, read);
  Scene scene = reader.scene(source);
  scene.text_digest = detail::sha256(detail::sha256(text) + '\n' + reader.digests());
  return scene;
}

Scene read_rigid_ipc(const std::filesystem::path& path) {
  return parse_rigid_ipc(detail::read_file(path, "a scene of Rigid IPC"), path);
}

Scene read_simulation_scene(const std::filesystem::path& path) {
  const std::string text = detail::read_file(path, "a scene file");
  return is_fixture(detail::parse_json(text, path.string())) ? parse_rigid_ipc(text, path)
                                                             : parse_scene(text, path);
}

}  // namespace firstcontact
