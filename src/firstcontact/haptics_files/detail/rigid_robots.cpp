#include <firstcontact/haptics_files/detail/rigid_robots.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptics_files/detail/moving_links.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

void require_rigid(const SceneRobot& robot) {
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds) {
      throw std::invalid_argument("haptics: robot " + in_quotes(robot.name) + ": expected " + what);
    }
  };
  require(!robot.dynamics, "no \"dynamics\"");
  require(robot.trajectory.points.size() <= 1 && std::holds_alternative<FixedMotion>(robot.base),
          "one posture: a \"base\" at rest, and \"state\" or a trajectory of one point");
  require(robot.attached.empty(), "no \"attached\" bodies; make them links of the robot");
  require(robot.padding.empty(), "no \"padding\"");
  require(robot.tracking_error.empty(), "no \"tracking_error\"");
}

Isometry3d isometry(const Pose& pose) {
  return Translation3d(pose.position) * pose.rotation.normalized();
}

void append(const Mesh& mesh, const Isometry3d& X_RG, Mesh& all) {
  const auto first = static_cast<std::uint32_t>(all.vertices.size());
  for (const Vector3d& v : mesh.vertices) {
    all.vertices.emplace_back(X_RG * v);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    all.triangles.push_back({first + a, first + b, first + c});
  }
}

/// Appends the triangles of a geometry; for a sphere or a capsule those that enclose it.
void append_geometry(const Shape& shape, const Isometry3d& X_RG, Mesh& all) {
  const Mesh& mesh = shape.mesh();
  const double r = shape.radius();
  if (r == 0.0) {
    append(mesh, X_RG, all);
    return;
  }
  const Shape ball = make_ellipsoid(Vector3d::Constant(r));
  for (const Vector3d& centre : mesh.vertices) {
    append(ball.mesh(), X_RG * Translation3d(centre), all);
  }
  const Vector3d axis =
      mesh.vertices.size() == 2 ? Vector3d(mesh.vertices[1] - mesh.vertices[0]) : Vector3d(0, 0, 0);
  if (axis.norm() > 0.0) {
    const Vector3d middle = 0.5 * (mesh.vertices[0] + mesh.vertices[1]);
    append(
        make_cylinder(r, axis.norm()).mesh(),
        X_RG * Translation3d(middle) * Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis),
        all);
  }
}

/// Whether a geometry is filled. A sphere and a capsule are thick points and segments without an
/// inside of their own.
bool is_filled(const Shape& shape) { return shape.is_solid() || shape.radius() > 0.0; }

class RobotsAsBodies {
 public:
  RobotsAsBodies(Scene& scene, ShapeCache& cache)
      : scene_(scene), loaded_(load_scene(scene, cache)), first_(scene.bodies.size()) {}

  void run() {
    require_apart_at_start();
    for (std::size_t r = 0; r < scene_.robots.size(); ++r) {
      if (HapticToolQuestion* tool = tool_with_grips(r)) {
        add_links(r, *tool);
      } else {
        add(r);
      }
    }
    take_ignored_pairs();
    for (BodyGroup& group : scene_.groups) {
      take_group(group);
    }
    for (HapticToolQuestion& tool : scene_.haptics->tools) {
      if (tool.robot) {
        tool.body = first_ + *std::exchange(tool.robot, {});
      }
    }
    std::move(bodies_.begin(), bodies_.end(), std::back_inserter(scene_.bodies));
    std::move(links_.begin(), links_.end(), std::back_inserter(scene_.bodies));
    take_warnings();
    scene_.robots.clear();
    scene_.text_digest = loaded_.input_digest;
    scene_.file_reports = loaded_.files;
  }

 private:
  /// Requires that robots do not overlap tools at the start. A mesh whose links are only partly
  /// solid is a surface: a start inside of a solid link would not be noticed later.
  void require_apart_at_start() const {
    const std::set<std::size_t> tools = members_of_tools();
    for (std::size_t a = 0; a < loaded_.robots->size(); ++a) {
      for (std::size_t b = a + 1; b < loaded_.robots->size(); ++b) {
        const bool is_of_tool = tools.contains(a) || tools.contains(b);
        const bool is_of_robot = std::max(a, b) >= first_;
        if (is_of_tool && is_of_robot && !are_of_one_robot(a, b) &&
            loaded_.robots->margin({a, b}) && meet_at_start(a, b)) {
          throw std::invalid_argument("haptics: " + in_quotes(loaded_.robots->name(a)) + " and " +
                                      in_quotes(loaded_.robots->name(b)) +
                                      " meet at the start; expected tools that are free there");
        }
      }
    }
  }

  [[nodiscard]] std::set<std::size_t> members_of_tools() const {
    std::set<std::size_t> members;
    for (const HapticToolQuestion& tool : scene_.haptics->tools) {
      if (!tool.robot) {
        members.insert(tool.body);
        continue;
      }
      const std::size_t links = scene_.robots[*tool.robot].model.links().size();
      for (std::size_t k = 0; k < links; ++k) {
        members.insert(loaded_.robots->first_member(*tool.robot) + k);
      }
    }
    return members;
  }

  [[nodiscard]] bool are_of_one_robot(std::size_t a, std::size_t b) const {
    const std::optional<RobotLink> link = loaded_.robots->robot_link(a);
    const std::optional<RobotLink> other = loaded_.robots->robot_link(b);
    return link && other && link->robot == other->robot;
  }

  [[nodiscard]] bool has_grips(std::size_t member) const {
    return tool_with_grips(loaded_.robots->robot_link(member)->robot) != nullptr;
  }

  [[nodiscard]] bool meet_at_start(std::size_t a, std::size_t b) const {
    const RobotScene& robots = *loaded_.robots;
    Workspace workspace;
    for (std::size_t i = 0; i < robots.geometries(a).size(); ++i) {
      const Motion X_WA = Motion::fixed(robots.geometry_pose(a, i, 0.0));
      for (std::size_t k = 0; k < robots.geometries(b).size(); ++k) {
        const Motion X_WB = Motion::fixed(robots.geometry_pose(b, k, 0.0));
        const MovingShape A{robots.geometries(a)[i].shape, X_WA};
        const MovingShape B{robots.geometries(b)[k].shape, X_WB};
        if (distance(A, B, 0.0, workspace).distance <= 0.0) {
          return true;
        }
      }
    }
    return false;
  }

  /// Takes over warnings. Loading the bodies again repeats its own warnings; only the others are
  /// kept.
  void take_warnings() {
    for (const std::string& warning : loaded_.warnings) {
      const auto is_of = [&](const SceneRobot& robot) {
        return warning.starts_with(robot.name + ":");
      };
      if (std::any_of(scene_.robots.begin(), scene_.robots.end(), is_of)) {
        scene_.warnings.push_back(warning);
      }
    }
  }

  [[nodiscard]] HapticToolQuestion* tool_with_grips(std::size_t robot) const {
    for (HapticToolQuestion& tool : scene_.haptics->tools) {
      if (tool.robot == robot && !tool.grips.empty()) {
        return &tool;
      }
    }
    return nullptr;
  }

  /// Makes a body at a pose from the geometries of some members.
  Body body_of_members(const std::string& name, const Pose& X_WB, std::size_t from, std::size_t to,
                       std::size_t number) {
    const RobotScene& robots = *loaded_.robots;
    const Isometry3d X_BW = isometry(X_WB).inverse();
    Mesh mesh;
    bool is_solid = true;
    for (std::size_t m = from; m < to; ++m) {
      const auto geometries = robots.geometries(m);
      for (std::size_t g = 0; g < geometries.size(); ++g) {
        append_geometry(geometries[g].shape, X_BW * isometry(robots.geometry_pose(m, g, 0.0)),
                        mesh);
        is_solid = is_solid && is_filled(geometries[g].shape);
      }
      if (!geometries.empty()) {
        body_of_[m] = number;
        ++counts_[number];
      }
    }
    Body body{.name = name, .shape = {}, .motion = FixedMotion{X_WB}};
    body.shape.source = Shape(std::move(mesh), 0.0, is_solid ? Filling::solid : Filling::surface);
    return body;
  }

  void add(std::size_t robot) {
    const SceneRobot& described = scene_.robots[robot];
    const std::size_t first = loaded_.robots->first_member(robot);
    bodies_.push_back(body_of_members(described.name, std::get<FixedMotion>(described.base).pose,
                                      first, first + described.model.links().size(),
                                      first_ + robot));
  }

  /// Adds a body for each link of a tool, and the pairs of its links that are ignored.
  void add_links(std::size_t robot, HapticToolQuestion& tool) {
    const SceneRobot& described = scene_.robots[robot];
    const RobotScene& robots = *loaded_.robots;
    const std::size_t first = robots.first_member(robot);
    const MovingLinks found = find_moving_links(robots, robot, described, tool);
    const std::size_t of_tool = first + found.body;
    bodies_.push_back(body_of_members(described.name, std::get<FixedMotion>(described.base).pose,
                                      of_tool, of_tool + 1, first_ + robot));
    for (std::size_t k = 0; k < tool.links.size(); ++k) {
      const std::size_t member = first + found.number[k];
      if (robots.geometries(member).empty()) {
        continue;
      }
      const std::size_t number = first_ + scene_.robots.size() + links_.size();
      tool.links[k].body = number;
      links_.push_back(body_of_members(robots.name(member), robots.pose(member, 0.0), member,
                                       member + 1, number));
      const auto ignore = [&](std::optional<std::size_t> other, std::size_t other_member,
                              std::size_t other_number) {
        if (are_connected(tool, k, other) ||
            !robots.margin({std::min(other_member, member), std::max(other_member, member)})) {
          of_links_.push_back({other_number, number});
        }
      };
      ignore({}, of_tool, first_ + robot);
      for (std::size_t other = 0; other < k; ++other) {
        if (tool.links[other].body) {
          ignore(other, first + found.number[other], *tool.links[other].body);
        }
      }
    }
  }

  /// Finds the body of a member; none for a link without geometry.
  [[nodiscard]] std::optional<std::size_t> body_of(std::size_t member) const {
    if (member < first_) {
      return member;
    }
    const auto found = body_of_.find(member);
    return found == body_of_.end() ? std::nullopt : std::optional(found->second);
  }

  /// Counts the members of a body: one, or its links with geometry.
  [[nodiscard]] std::size_t count(std::size_t body) const {
    return body < first_ ? 1 : counts_.at(body);
  }

  [[nodiscard]] const std::string& name(std::size_t body) const {
    if (body < first_) {
      return scene_.bodies[body].name;
    }
    const std::size_t number = body - first_;
    return number < bodies_.size() ? bodies_[number].name : links_[number - bodies_.size()].name;
  }

  void take_ignored_pairs() {
    std::map<BodyPair, std::set<BodyPair>> ignored;
    for (const auto& [first, second] : scene_.ignored_pairs) {
      const std::optional<std::size_t> a = body_of(first);
      const std::optional<std::size_t> b = body_of(second);
      const bool is_inside = are_of_one_robot(first, second) && has_grips(first);
      if (a && b && *a != *b && !is_inside) {
        ignored[{std::min(*a, *b), std::max(*a, *b)}].insert(
            {std::min(first, second), std::max(first, second)});
      }
    }
    scene_.ignored_pairs.clear();
    scene_.allowed_pairs.clear();
    for (const auto& [bodies, members] : ignored) {
      if (members.size() != count(bodies[0]) * count(bodies[1])) {
        throw std::invalid_argument("haptics: pairs: expected " + in_quotes(name(bodies[0])) +
                                    " and " + in_quotes(name(bodies[1])) +
                                    " ignored as a whole, got some links only");
      }
      scene_.ignored_pairs.push_back(bodies);
    }
    scene_.ignored_pairs.insert(scene_.ignored_pairs.end(), of_links_.begin(), of_links_.end());
  }

  void take_group(BodyGroup& group) const {
    std::map<std::size_t, std::size_t> found;
    for (const std::size_t member : group.bodies) {
      if (const std::optional<std::size_t> body = body_of(member)) {
        ++found[*body];
      }
    }
    group.bodies.clear();
    for (const auto& [body, members] : found) {
      if (members != count(body)) {
        throw std::invalid_argument("haptics: group " + in_quotes(group.name) + ": expected " +
                                    in_quotes(name(body)) + " as a whole, got some links only");
      }
      group.bodies.push_back(body);
    }
  }

  Scene& scene_;
  LoadedScene loaded_;
  std::size_t first_;
  std::vector<Body> bodies_;                         // Bodies of robots.
  std::vector<Body> links_;                          // Bodies of links of tools with grips.
  std::vector<BodyPair> of_links_;                   // Pairs of these that are ignored.
  std::map<std::size_t, std::size_t> body_of_ = {};  // Bodies of members that are links.
  std::map<std::size_t, std::size_t> counts_ = {};  // Number of links with geometry of such a body.
};

}  // namespace

void make_robots_bodies(Scene& scene, ShapeCache& cache) {
  if (!scene.robots.empty()) {
    std::for_each(scene.robots.begin(), scene.robots.end(), require_rigid);
    RobotsAsBodies(scene, cache).run();
  }
}

}  // namespace firstcontact::detail
