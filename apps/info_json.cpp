#include "info_json.h"

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/geometry/weld.h>
#include <firstcontact/scene_files/write_reports.h>

#include "print_robot.h"

namespace firstcontact::app {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json to_json(const std::optional<double>& number) { return number ? Json(*number) : Json(); }

/// Writes a box; null for an empty one.
Json to_json(const Eigen::AlignedBox3d& box) {
  return box.isEmpty() ? Json()
                       : Json{{"lower", to_json(box.min())}, {"upper", to_json(box.max())}};
}

/// Writes an object on one line, whatever bytes a file has for names.
std::string line_of(const Json& object) {
  return object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json files_json(std::span<const FileReport> reports) {
  return Json::parse(write_file_reports(reports));
}

Json link_json(const Link& link) {
  Json collision = Json::array();
  for (const LinkGeometry& geometry : link.collision) {
    Json element = {{"type", geometry_kind(geometry)}};
    if (const auto* mesh = std::get_if<MeshGeometry>(&geometry.source)) {
      element["file"] = mesh->path.string();
      element["triangles"] = geometry.shape.value().mesh().triangles.size();
    }
    collision.push_back(std::move(element));
  }
  Json result = {{"name", link.name}, {"mass", Json()}, {"centre_of_mass", Json()}};
  if (link.inertia) {
    result["mass"] = link.inertia->mass;
    result["centre_of_mass"] = to_json(link.inertia->p_LC);
  }
  result["collision"] = std::move(collision);
  return result;
}

Json joint_json(const Joint& joint) {
  Json result = {{"name", joint.name},
                 {"type", to_string(joint.type)},
                 {"parent", joint.parent},
                 {"child", joint.child},
                 {"lower", to_json(joint.limits.lower)},
                 {"upper", to_json(joint.limits.upper)},
                 {"velocity", to_json(joint.limits.velocity)},
                 {"effort", to_json(joint.limits.effort)}};
  if (joint.mimic) {
    result["mimic"] = {{"joint", joint.mimic->joint},
                       {"multiplier", joint.mimic->multiplier},
                       {"offset", joint.mimic->offset}};
  }
  return result;
}

}  // namespace

std::string mesh_json(const std::string& file, const MeshReading& reading,
                      const MeshDefects& found) {
  const Mesh& mesh = reading.mesh;
  return line_of({{"file", file},
                  {"type", "mesh"},
                  {"triangles", mesh.triangles.size()},
                  {"vertices", mesh.vertices.size()},
                  {"edges", found.edges},
                  {"components", found.components},
                  {"closed", found.closed},
                  {"consistently_oriented", found.consistently_oriented},
                  {"bounds", to_json(found.bounds)},
                  {"volume", to_json(found.signed_volume)},
                  {"open_edges", found.open_edges},
                  {"nonmanifold_edges", found.nonmanifold_edges},
                  {"degenerate_triangles", found.degenerate_triangles},
                  {"doubled_triangles", found.doubled_triangles},
                  {"unused_vertices", found.unused_vertices},
                  {"files", files_json({&reading.report, 1})}});
}

std::string points_json(const std::string& file, const PointReading& cloud) {
  const std::vector<Eigen::Vector3d>& points = cloud.points;
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& p : points) {
    bounds.extend(p);
  }
  Mesh mesh{.vertices = points, .triangles = {}};
  return line_of({{"file", file},
                  {"type", "points"},
                  {"points", points.size()},
                  {"points_at_one_place", weld(mesh)},
                  {"bounds", to_json(bounds)},
                  {"files", files_json({&cloud.report, 1})}});
}

std::string robot_json(const std::string& file, const RobotReading& reading) {
  const RobotModel& robot = reading.model;
  Json links = Json::array();
  for (const Link& link : robot.links()) {
    links.push_back(link_json(link));
  }
  Json joints = Json::array();
  for (const Joint& joint : robot.joints()) {
    joints.push_back(joint_json(joint));
  }
  const RobotMass mass = mass_of(robot);
  return line_of({{"file", file},
                  {"type", "robot"},
                  {"name", robot.name()},
                  {"mass", mass.total},
                  {"links_without_mass", mass.missing},
                  {"links", std::move(links)},
                  {"joints", std::move(joints)},
                  {"remarks", robot_remarks(robot)},
                  {"files", files_json(reading.files)}});
}

}  // namespace firstcontact::app
