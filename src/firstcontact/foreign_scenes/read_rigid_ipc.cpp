#include <firstcontact/foreign_scenes/read_rigid_ipc.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/foreign_scenes/detail/read_rigid_ipc_body.h>
#include <firstcontact/foreign_scenes/detail/rigid_ipc_body.h>
#include <firstcontact/foreign_scenes/detail/rigid_ipc_groups.h>
#include <firstcontact/foreign_scenes/detail/rigid_ipc_keys.h>
#include <firstcontact/foreign_scenes/detail/rigid_ipc_meshes.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/sha256.h>

namespace firstcontact {
namespace {

using detail::find;
using detail::JsonObject;
using detail::JsonReader;
using detail::JsonValue;
using detail::RigidIpcBody;
using detail::RigidIpcKeys;
using detail::RigidIpcMeshes;
using detail::RigidIpcOrigin;
using detail::RigidIpcType;
using detail::weigh;
using detail::WeighedShape;
using Eigen::Vector3d;

class FixtureReader {
 public:
  FixtureReader(const JsonValue& root, const std::filesystem::path& source, const JsonReader& read)
      : root_(root), read_(read), keys_(read), meshes_(source) {}

  Scene scene(const std::filesystem::path& source) {
    const JsonObject& fixture = keys_.object(
        root_,
        {"scene_type", "solver", "timestep", "max_time", "max_iterations", detail::kRigidIpcProblem,
         "distance_barrier_constraint", "friction_constraints", "ipc_solver", "newton_solver",
         "homotopy_solver", "ncp_solver", "volume_constraint", "viewport_bbox"});
    scene_.id = source.stem().string();
    scene_.simulation.emplace();
    simulation().step = keys_.positive_or(fixture, "timestep", 0.01);
    scene_.duration = simulation().duration = duration(fixture);
    simulation().contact_distance = contact_distance(fixture);
    const JsonObject& problem =
        keys_.object(read_.member(root_, detail::kRigidIpcProblem),
                     {"rigid_bodies", "coefficient_restitution", "coefficient_friction", "gravity",
                      "collision_eps", "time_stepper", "do_intersection_check"});
    simulation().gravity = keys_.vector_or_zero(problem, "gravity");
    simulation().friction = friction(fixture, problem);
    simulation().restitution = restitution(problem);
    const JsonValue& bodies =
        read_.member(read_.member(root_, detail::kRigidIpcProblem), "rigid_bodies");
    for (const JsonValue& body : read_.array(bodies, "an array of bodies")) {
      add_entry(body);
    }
    if (scene_.bodies.empty()) {
      read_.fail(bodies, "expected at least one body that is enabled, got none");
    }
    detail::name_and_group(origins_, scene_);
    scene_.warnings = keys_.warnings();
    scene_.files_read = meshes_.files();
    return std::move(scene_);
  }

  [[nodiscard]] std::string digests() const { return meshes_.digests(); }

 private:
  Simulation& simulation() { return *scene_.simulation; }

  /// [s]  Reads the duration. A negative time, or number of steps, counts as missing.
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
    // Fraction of the distance at which repulsion begins in Rigid IPC.
    constexpr double kShare = 0.1;
    double activation = 1e-3;
    double separation = 0.0;
    if (const JsonValue* value = find(fixture, "distance_barrier_constraint")) {
      const JsonObject& barrier = keys_.object(
          *value, {"initial_barrier_activation_distance", "minimum_separation_distance",
                   "detection_method", "trajectory_type", "barrier_type"});
      activation = keys_.positive_or(barrier, "initial_barrier_activation_distance", activation);
      if (const JsonValue* least = find(barrier, "minimum_separation_distance")) {
        separation = read_.not_negative(*least);
      }
    }
    return separation + kShare * activation;
  }

  double friction(const JsonObject& fixture, const JsonObject& problem) {
    if (const JsonValue* value = find(fixture, "friction_constraints")) {
      const JsonObject& solver =
          keys_.object(*value, {"static_friction_speed_bound", "iterations"});
      const JsonValue* iterations = find(solver, "iterations");
      if (iterations != nullptr && read_.number(*iterations) == 0.0) {
        return 0.0;
      }
    }
    const JsonValue* friction = find(problem, "coefficient_friction");
    return friction == nullptr ? 0.0 : read_.not_negative(*friction);
  }

  /// Reads the restitution. A negative one is left to the solver, which has none.
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
    const JsonObject& entry = keys_.object(
        value, {"mesh", "enabled", "type", "density", "is_dof_fixed", "oriented", "group_id",
                "position", "rotation", "scale", "dimensions", "linear_velocity",
                "angular_velocity", "force", "torque", "kinematic_max_time", "kinematic_poses",
                "split_components", "ipc_comparison_enabled"});
    const JsonValue* enabled = find(entry, "enabled");
    if (enabled != nullptr && !read_.boolean(*enabled)) {
      return;
    }
    const JsonValue* mesh = find(entry, "mesh");
    if (mesh == nullptr) {
      read_.fail(value, "expected a key \"mesh\": bodies whose vertices stand here are not read");
    }
    const RigidIpcBody body = detail::read_rigid_ipc_body(entry, keys_);
    const std::filesystem::path file = meshes_.find(*mesh, read_);
    const Vector3d scale = read_scale(entry, meshes_.load(file));
    const RigidIpcOrigin origin{file.stem().string(), number, body.type == RigidIpcType::dynamic,
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

  [[nodiscard]] double read_group(const JsonObject& entry) const {
    const JsonValue* group = find(entry, "group_id");
    return group == nullptr ? -1.0 : read_.number(*group);
  }

  /// Reads the scale. Dimensions override factors; along an axis without extent they are factors.
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

  void add_parts(const RigidIpcBody& body, const RigidIpcOrigin& origin, const Mesh& mesh) {
    const std::vector<Mesh> parts = detail::split_components(mesh);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      RigidIpcOrigin part = origin;
      part.name += "-part" + std::to_string(k);
      add_body(body, part, weigh(parts[k]));
    }
  }

  /// Adds a whole mesh. Equal ones share their shape. The scene names the file where that gives the
  /// same shape.
  void add_whole(const RigidIpcBody& body, const RigidIpcOrigin& origin,
                 const std::filesystem::path& file, const Vector3d& scale) {
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

  void add_body(const RigidIpcBody& body, const RigidIpcOrigin& origin,
                const WeighedShape& weighed) {
    Body& added = scene_.bodies.emplace_back();
    origins_.push_back(origin);
    added.shape.source = weighed.shape;
    added.motion = FixedMotion{body.X_WB};
    if (body.type == RigidIpcType::dynamic) {
      added.free = detail::free_body(body, weighed);
    } else if (body.type == RigidIpcType::kinematic) {
      // A free body turns about the centre of mass, a scripted body about the origin of its frame.
      added.shape.source = Shape(detail::moved(weighed.shape.mesh(), -weighed.p_BC));
      added.motion =
          detail::scripted_motion(body, weighed, simulation().step, simulation().duration);
      (void)normalised_motion(added.motion, scene_.duration);
    }
  }

  const JsonValue& root_;
  const JsonReader& read_;
  RigidIpcKeys keys_;
  RigidIpcMeshes meshes_;
  Scene scene_;
  std::size_t entries_ = 0;
  std::vector<RigidIpcOrigin> origins_;
  std::map<std::tuple<std::filesystem::path, double, double, double>, WeighedShape> weighed_;
};

}  // namespace

Scene parse_rigid_ipc(std::string_view text, const std::filesystem::path& source) {
  const FloatEnvironmentGuard guard;
  const std::string name = source.string();
  const JsonValue root = detail::parse_json(text, name);
  const JsonReader read(root, name);
  if (!detail::is_rigid_ipc(root)) {
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

}  // namespace firstcontact
