#include <firstcontact/scene_files/write_scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/geometry/height_map.h>
#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/verdict_words.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/robot/robot_description.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/scene/body_motion.h>
#include <firstcontact/scene/body_shape.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/scene_files/detail/write_simulation.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::JsonArray;
using detail::JsonMember;
using detail::JsonObject;
using detail::JsonValue;

JsonValue to_json(double number) { return {.value = number}; }

JsonValue to_json(const std::string& text) { return {.value = text}; }

JsonValue to_json(const char* word) { return {.value = std::string(word)}; }

JsonValue to_json(const Eigen::Vector3d& v) {
  return {.value = JsonArray{to_json(v.x()), to_json(v.y()), to_json(v.z())}};
}

JsonValue to_json(const std::array<std::uint32_t, 3>& triangle) {
  JsonArray array;
  for (const std::uint32_t corner : triangle) {
    array.push_back(to_json(static_cast<double>(corner)));
  }
  return {.value = std::move(array)};
}

JsonValue to_json(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  JsonArray wxyz{to_json(q.w()), to_json(q.x()), to_json(q.y()), to_json(q.z())};
  return {.value = JsonObject{{"position", to_json(pose.position)},
                              {"quaternion_wxyz", {.value = std::move(wxyz)}}}};
}

JsonValue to_json(const Body& body);

JsonValue to_json(const TrajectoryPoint& point);

JsonValue to_json(Between between) {
  return to_json(kBetweenWords[static_cast<std::size_t>(between)]);
}

template <class T>
JsonValue to_json(const std::vector<T>& elements) {
  JsonArray array;
  for (const T& element : elements) {
    array.push_back(to_json(element));
  }
  return {.value = std::move(array)};
}

JsonValue numbers(double radius, double length, const std::optional<double>& enclosure_error) {
  JsonObject object{{"radius", to_json(radius)}, {"length", to_json(length)}};
  if (enclosure_error) {
    object.push_back({"enclosure_error", to_json(*enclosure_error)});
  }
  return {.value = std::move(object)};
}

/// The keys and values of a body's shape; the overloads are picked by std::visit.
struct ShapeMembers {
  double radius;
  Filling filling;
  double enclosure_error;

  JsonObject operator()(const MeshFile& file) const {
    return with_thickness({{"mesh", to_json(file.path.string())}, {"scale", to_json(file.scale)}});
  }

  JsonObject operator()(const Mesh& mesh) const {
    JsonObject object = with_thickness(
        {{"vertices", to_json(mesh.vertices)}, {"triangles", to_json(mesh.triangles)}});
    if (enclosure_error > 0.0) {
      object.push_back({"enclosure_error", to_json(enclosure_error)});
    }
    return object;
  }

  JsonObject operator()(const Shape& ready) const {
    if (ready.is_curved() && ready.radius() == 0.0) {
      return curved(ready.convex_set()->core(), static_cast<double>(ready.mesh().triangles.size()));
    }
    const Filling filled = ready.is_solid() ? Filling::solid : Filling::surface;
    return ShapeMembers{ready.radius(), filled, ready.enclosure_error()}(ready.mesh());
  }

  JsonObject operator()(const SphereShape& sphere) const {
    return {{"sphere", {.value = JsonObject{{"radius", to_json(sphere.radius)}}}}};
  }

  JsonObject operator()(const CapsuleShape& capsule) const {
    return {{"capsule", numbers(capsule.radius, capsule.length, {})}};
  }

  JsonObject operator()(const BoxShape& box) const {
    JsonObject object{{"box", {.value = JsonObject{{"size", to_json(box.size)}}}}};
    if (radius > 0.0) {
      object.push_back({"radius", to_json(radius)});
    }
    return object;
  }

  JsonObject operator()(const CylinderShape& cylinder) const {
    return {{"cylinder", numbers(cylinder.radius, cylinder.length, cylinder.enclosure_error)}};
  }

  JsonObject operator()(const ConeShape& cone) const {
    return {{"cone", numbers(cone.radius, cone.length, cone.enclosure_error)}};
  }

  JsonObject operator()(const EllipsoidShape& ellipsoid) const {
    JsonObject object{{"radii", to_json(ellipsoid.radii)}};
    if (ellipsoid.enclosure_error) {
      object.push_back({"enclosure_error", to_json(*ellipsoid.enclosure_error)});
    }
    return {{"ellipsoid", {.value = std::move(object)}}};
  }

  /// Writes a ready shape that is a primitive, with the enclosure error that makes as many
  /// triangles.
  ///
  /// That is the error for half a corner less, of a polygon around a circle or of a globe's
  /// meridian.
  [[nodiscard]] JsonObject curved(const ConvexCore& core, double triangles) const {
    constexpr double kPi = std::numbers::pi;
    const double length = 2.0 * core.size.z();
    const auto ring_error = [&](double corners) {
      return core.size.x() *
             std::max((1.0 / std::cos(kPi / (corners - 0.5)) - 1.0) / 0.999, kLeastEnclosureError);
    };
    switch (core.kind) {
      case ConvexKind::cylinder:
        return (*this)(CylinderShape{core.size.x(), length, ring_error(0.25 * triangles)});
      case ConvexKind::cone:
        return (*this)(ConeShape{core.size.x(), length, ring_error(0.5 * triangles)});
      default:
        break;
    }
    const double rings = 0.5 + 0.5 * std::sqrt(1.0 + triangles);
    const double angle = 0.5 * kPi / (rings - 0.5);
    const double error = std::max(angle * angle / 0.9, kLeastEllipsoidError);
    return (*this)(EllipsoidShape{core.size, error * core.size.maxCoeff()});
  }

  JsonObject operator()(const ConvexHullShape& hull) const {
    const auto* file = std::get_if<MeshFile>(&hull.of);
    JsonObject of =
        file != nullptr
            ? JsonObject{{"mesh", to_json(file->path.string())}, {"scale", to_json(file->scale)}}
            : JsonObject{{"vertices", to_json(std::get<std::vector<Eigen::Vector3d>>(hull.of))}};
    return with_thickness({{"convex_hull", {.value = std::move(of)}}});
  }

  JsonObject operator()(const PointFile& file) const {
    return with_thickness(
        {{"points", to_json(file.path.string())}, {"scale", to_json(file.scale)}});
  }

  JsonObject operator()(const PointCloud& cloud) const {
    return with_thickness({{"points", to_json(cloud.points)}});
  }

  JsonObject operator()(const HeightFile& file) const {
    return height_map(file.cell, to_json(file.path.string()));
  }

  JsonObject operator()(const HeightMap& map) const {
    JsonArray rows;
    for (auto row = map.heights.begin(); row != map.heights.end();
         row += static_cast<std::ptrdiff_t>(map.columns)) {
      rows.push_back(
          to_json(std::vector<double>(row, row + static_cast<std::ptrdiff_t>(map.columns))));
    }
    return height_map(map.cell, {.value = std::move(rows)});
  }

  [[nodiscard]] JsonObject height_map(const Eigen::Vector2d& cell, JsonValue heights) const {
    return with_thickness(
        {{"heightmap",
          {.value = JsonObject{{"cell", {.value = JsonArray{to_json(cell.x()), to_json(cell.y())}}},
                               {"heights", std::move(heights)}}}}});
  }

  [[nodiscard]] JsonObject with_thickness(JsonObject object) const {
    object.push_back({"radius", to_json(radius)});
    if (filling == Filling::solid) {
      object.push_back({"solid", {.value = true}});
    }
    return object;
  }
};

JsonValue to_json(const BodyShape& shape) {
  return {.value = std::visit(ShapeMembers{shape.radius, shape.filling, shape.enclosure_error},
                              shape.source)};
}

/// The key and value of a body's motion; the overloads are picked by std::visit.
struct MotionMember {
  static JsonMember member(const char* type, JsonObject numbers) {
    numbers.insert(numbers.begin(), {"type", to_json(type)});
    return {"motion", {.value = std::move(numbers)}};
  }

  JsonMember operator()(const FixedMotion& motion) const { return {"pose", to_json(motion.pose)}; }

  JsonMember operator()(const ConstantVelocityMotion& motion) const {
    return member("constant_velocity", {{"from", to_json(motion.from)},
                                        {"translation", to_json(motion.translation)},
                                        {"rotation_vector", to_json(motion.rotation_vector)}});
  }

  JsonMember operator()(const ScrewMotion& motion) const {
    return member("screw", {{"from", to_json(motion.from)},
                            {"axis_point", to_json(motion.axis_point)},
                            {"axis_direction", to_json(motion.axis_direction)},
                            {"angle", to_json(motion.angle)},
                            {"translation", to_json(motion.translation)}});
  }

  JsonMember operator()(const TwoPoseMotion& motion) const {
    return member(kBetweenWords[static_cast<std::size_t>(motion.between)],
                  {{"from", to_json(motion.from)}, {"to", to_json(motion.to)}});
  }

  JsonMember operator()(const WaypointMotion& motion) const {
    return member("waypoints", {{"times", to_json(motion.times)},
                                {"poses", to_json(motion.poses)},
                                {"between", to_json(motion.between)}});
  }

  JsonMember operator()(const VertexMotion& motion) const {
    return member("vertices", {{"to", to_json(motion.to)}});
  }
};

JsonValue to_json(const Body& body) {
  JsonObject object{{"name", to_json(body.name)}, {"shape", to_json(body.shape)}};
  object.push_back(std::visit(MotionMember{}, body.motion));
  detail::add_dynamics(body, object);
  return {.value = std::move(object)};
}

JsonValue to_json(const TrajectoryPoint& point) {
  JsonObject object{{"time", to_json(point.time)}, {"positions", to_json(point.positions)}};
  if (!point.velocities.empty()) {
    object.push_back({"velocities", to_json(point.velocities)});
  }
  if (!point.accelerations.empty()) {
    object.push_back({"accelerations", to_json(point.accelerations)});
  }
  return {.value = std::move(object)};
}

JsonValue to_json(const SceneAttachment& attached, const Scene& scene, const RobotModel& model) {
  const auto link = [&](std::size_t index) { return to_json(model.links()[index].name); };
  JsonArray touch_links;
  for (const std::size_t index : attached.touch_links) {
    touch_links.push_back(link(index));
  }
  JsonObject object{{"body", to_json(scene.bodies.at(attached.body).name)},
                    {"link", link(attached.link)},
                    {"from_time", to_json(attached.from_time)}};
  if (attached.to_time) {
    object.push_back({"to_time", to_json(*attached.to_time)});
  }
  object.push_back({"touch_links", {.value = std::move(touch_links)}});
  if (attached.pose) {
    object.push_back({"pose", to_json(*attached.pose)});
  }
  return {.value = std::move(object)};
}

JsonObject tracking_errors(const SceneRobot& robot) {
  JsonObject object;
  for (const auto& [joint, error] : robot.tracking_error) {
    const Joint& what = robot.model.joints()[joint];
    object.push_back({what.name, to_json(std::max(error.angle, error.distance))});
  }
  return object;
}

JsonArray paths(const std::vector<std::filesystem::path>& folders) {
  JsonArray array;
  for (const std::filesystem::path& folder : folders) {
    array.push_back(to_json(folder.string()));
  }
  return array;
}

JsonValue robot_to_json(const SceneRobot& robot, const Scene& scene) {
  JsonObject object{{"name", to_json(robot.name)}, {"urdf", to_json(robot.file.urdf.string())}};
  if (!robot.srdf.empty()) {
    object.push_back({"srdf", to_json(robot.srdf.string())});
  }
  object.push_back({"package_roots", {.value = paths(robot.file.package_roots)}});
  if (robot.file.surface != RobotSurface::collision) {
    const auto surface = static_cast<std::size_t>(robot.file.surface);
    object.push_back({"surface", to_json(kRobotSurfaceWords[surface])});
  }
  JsonMember base = std::visit(MotionMember{}, robot.base);
  object.push_back({base.key == "pose" ? "base" : "base_motion", std::move(base.value)});
  if (!robot.trajectory.joint_names.empty()) {
    object.push_back({"trajectory",
                      {.value = JsonObject{{"joint_names", to_json(robot.trajectory.joint_names)},
                                           {"points", to_json(robot.trajectory.points)}}}});
    if (robot.trajectory.turning != Turning::as_given) {
      object.push_back({"turning", to_json(to_string(robot.trajectory.turning))});
    }
  }
  JsonObject state;
  for (const auto& [joint, position] : robot.state) {
    state.push_back({joint, to_json(position)});
  }
  object.push_back({"state", {.value = std::move(state)}});
  JsonArray attached;
  for (const SceneAttachment& attachment : robot.attached) {
    attached.push_back(to_json(attachment, scene, robot.model));
  }
  object.push_back({"attached", {.value = std::move(attached)}});
  JsonObject padding;
  for (const auto& [link, number] : robot.padding) {
    padding.push_back({robot.model.links()[link].name, to_json(number)});
  }
  object.push_back({"padding", {.value = std::move(padding)}});
  object.push_back({"tracking_error", {.value = tracking_errors(robot)}});
  if (robot.dynamics) {
    object.push_back({"dynamics", detail::robot_dynamics_to_json(robot)});
  }
  return {.value = std::move(object)};
}

JsonValue pairs_to_json(const Scene& scene) {
  const auto name = [&](std::size_t member) { return to_json(member_name(scene, member)); };
  const auto group_name = [&](std::size_t group) { return to_json(scene.groups.at(group).name); };
  JsonObject groups;
  for (const BodyGroup& group : scene.groups) {
    JsonArray members;
    for (const std::size_t body : group.bodies) {
      members.push_back(name(body));
    }
    groups.push_back({group.name, {.value = std::move(members)}});
  }
  JsonArray ignore;
  for (const auto& [first, second] : scene.ignored_groups) {
    ignore.push_back({.value = JsonArray{group_name(first), group_name(second)}});
  }
  for (const auto& [first, second] : scene.ignored_pairs) {
    ignore.push_back({.value = JsonArray{name(first), name(second)}});
  }
  JsonArray margin;
  for (const GroupMargin& pair : scene.group_margins) {
    margin.push_back({.value = JsonArray{group_name(pair.groups[0]), group_name(pair.groups[1]),
                                         to_json(pair.margin)}});
  }
  for (const PairMargin& pair : scene.pair_margins) {
    margin.push_back(
        {.value = JsonArray{name(pair.bodies[0]), name(pair.bodies[1]), to_json(pair.margin)}});
  }
  JsonObject pairs{{"ignore", {.value = std::move(ignore)}},
                   {"margin", {.value = std::move(margin)}}};
  if (!groups.empty()) {
    pairs.insert(pairs.begin(), {"groups", {.value = std::move(groups)}});
  }
  return {.value = std::move(pairs)};
}

JsonValue contacts_to_json(const ContactState& contacts) {
  if (contacts.kind == ContactState::Kind::nearest) {
    return to_json(static_cast<double>(contacts.most));
  }
  constexpr std::array kKinds{ContactState::Kind::none, ContactState::Kind::first,
                              ContactState::Kind::all};
  const auto found = std::ranges::find(kKinds, contacts.kind) - kKinds.begin();
  return to_json(kContactStateWords[static_cast<std::size_t>(found)]);
}

JsonValue options_to_json(const Scene& scene) {
  const SceneOptions& options = scene.options;
  const auto start_contacts = static_cast<std::size_t>(options.start_contacts);
  JsonObject object{{"tolerance", to_json(options.tolerance)},
                    {"margin", to_json(options.margin)},
                    {"contacts", contacts_to_json(options.contacts)},
                    {"start_contacts", to_json(kStartContactsWords[start_contacts])},
                    {"contact_band", to_json(options.contact_band)}};
  if (options.deadline) {
    object.push_back({"deadline", to_json(*options.deadline)});
  }
  if (options.lenient) {
    object.push_back({"lenient", {.value = true}});
  }
  object.push_back({"duration", to_json(scene.duration)});
  return {.value = std::move(object)};
}

}  // namespace

std::string write_scene(const Scene& scene) {
  JsonObject object{
      {"firstcontact", to_json(1.0)}, {"id", to_json(scene.id)}, {"bodies", to_json(scene.bodies)}};
  if (!scene.robots.empty()) {
    JsonArray robots;
    for (const SceneRobot& robot : scene.robots) {
      robots.push_back(robot_to_json(robot, scene));
    }
    object.push_back({"robots", {.value = std::move(robots)}});
  }
  object.push_back({"pairs", pairs_to_json(scene)});
  object.push_back({"options", options_to_json(scene)});
  if (scene.simulation) {
    object.push_back({"simulation", detail::simulation_to_json(scene)});
  }
  return detail::write_json({.value = std::move(object)});
}

}  // namespace firstcontact
