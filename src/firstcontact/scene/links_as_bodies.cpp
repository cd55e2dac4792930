#include <firstcontact/scene/links_as_bodies.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/geometry/mass_properties.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/detail/load_robots.h>
#include <firstcontact/scene/pair_counts.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::string geometry_name(const SceneRobot& robot, const Link& link, std::size_t geometry) {
  return robot.name + "/" + link.name + (geometry == 0 ? "" : "#" + std::to_string(geometry + 1));
}

void require_simulated(const SceneRobot& robot) {
  const std::string name = "robot " + detail::in_quotes(robot.name);
  if (!robot.attached.empty()) {
    throw std::invalid_argument(name +
                                ": attached bodies are not simulated; make the body a link of the "
                                "robot, or a body with \"dynamics\"");
  }
  if (!robot.tracking_error.empty()) {
    throw std::invalid_argument(name +
                                ": a simulation knows where the robot is; leave out "
                                "\"tracking_error\"");
  }
}

/// The moments about another point, for the same mass.
Matrix3d moved_moments(const Matrix3d& about_C, double mass, const Vector3d& by) {
  return about_C + mass * (by.squaredNorm() * Matrix3d::Identity() - by * by.transpose());
}

/// The inertia of all geometries of a link, as solids of a density.
LinkInertia inertia_of_solids(std::span<const MemberGeometry> geometries, double density) {
  LinkInertia sum;
  std::vector<std::pair<double, Vector3d>> centres;
  std::vector<Matrix3d> moments;
  for (const MemberGeometry& geometry : geometries) {
    const MassProperties solid = mass_properties(geometry.shape);
    const double mass = density * solid.volume;
    const Matrix3d R = geometry.X_MG.rotation.normalized().toRotationMatrix();
    centres.emplace_back(mass, geometry.X_MG.position + R * solid.p_BC);
    moments.emplace_back(R * (density * solid.about_C) * R.transpose());
    sum.mass += mass;
    sum.p_LC += mass * centres.back().second;
  }
  if (sum.mass > 0.0) {
    sum.p_LC /= sum.mass;
  }
  for (std::size_t k = 0; k < moments.size(); ++k) {
    sum.about_C_L += moved_moments(moments[k], centres[k].first, centres[k].second - sum.p_LC);
  }
  return sum;
}

class Links {
 public:
  explicit Links(const LoadedScene& loaded)
      : given_(loaded), robots_(*loaded.robots), bodies_of_(robots_.size()) {}

  LinksAsBodies run() {
    LinksAsBodies result;
    scene_ = given_.scene;
    scene_.robots.clear();
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      bodies_of_[b] = {b};
    }
    for (std::size_t r = 0; r < given_.scene.robots.size(); ++r) {
      require_simulated(given_.scene.robots[r]);
      result.models.push_back(model_with_masses(r));
      for (std::size_t l = 0; l < result.models.back().links().size(); ++l) {
        add_link(r, l, result.models.back().links()[l]);
      }
    }
    take_rules();
    result.loaded = load();
    result.geometries = std::move(geometries_);
    return result;
  }

 private:
  [[nodiscard]] RobotModel model_with_masses(std::size_t robot) const {
    const SceneRobot& described = given_.scene.robots[robot];
    const RobotModel& model = described.model;
    RobotDescription description{.name = model.name(),
                                 .links = {model.links().begin(), model.links().end()},
                                 .joints = {model.joints().begin(), model.joints().end()}};
    if (!described.dynamics || !described.dynamics->density) {
      return model;
    }
    for (std::size_t l = 0; l < description.links.size(); ++l) {
      Link& link = description.links[l];
      const auto geometries = robots_.geometries(robots_.first_member(robot) + l);
      if (!link.inertia && !geometries.empty()) {
        try {
          link.inertia = inertia_of_solids(geometries, *described.dynamics->density);
        } catch (const std::invalid_argument& error) {
          throw std::invalid_argument(
              "link " + detail::in_quotes(described.name + "/" + link.name) + ": " + error.what());
        }
      }
    }
    return RobotModel(std::move(description));
  }

  void add_link(std::size_t robot, std::size_t link, const Link& model) {
    const SceneRobot& described = given_.scene.robots[robot];
    const std::size_t member = robots_.first_member(robot) + link;
    const auto geometries = robots_.geometries(member);
    for (std::size_t g = 0; g < geometries.size(); ++g) {
      const MemberGeometry& geometry = geometries[g];
      Body body{
          .name = described.name + "/" + model.name + (g == 0 ? "" : "#" + std::to_string(g + 1)),
          .shape = {},
          .motion = motion(robot, member, geometry.X_MG)};
      body.shape.source = geometry.shape;
      body.shape.radius = geometry.shape.radius();
      if (described.dynamics) {
        body.surface = described.dynamics->surface;
        body.free = share_of(model, geometry.X_MG, geometries.size());
      }
      bodies_of_[member].push_back(scene_.bodies.size());
      scene_.bodies.push_back(std::move(body));
      geometries_.push_back({robot, link, geometry.X_MG});
    }
  }

  /// The body that a run has for a geometry. The simulation moves it with its robot.
  static FreeBody share_of(const Link& link, const Pose& X_LG, std::size_t geometries) {
    const LinkInertia inertia = link.inertia.value_or(LinkInertia{});
    const Matrix3d R_GL = X_LG.rotation.normalized().toRotationMatrix().transpose();
    FreeBody free{.density = {},
                  .mass = inertia.mass / static_cast<double>(geometries),
                  .centre_of_mass = R_GL * (inertia.p_LC - X_LG.position),
                  .inertia = {},
                  .forces = {}};
    free.inertia = R_GL * inertia.about_C_L * R_GL.transpose() / static_cast<double>(geometries);
    return free;
  }

  [[nodiscard]] Pose pose(std::size_t member, const Pose& X_MG, double t) const {
    const Pose X_WM = robots_.pose(member, t);
    const Eigen::Quaterniond R = X_WM.rotation.normalized();
    return {X_WM.position + R * X_MG.position, (R * X_MG.rotation.normalized()).normalized()};
  }

  [[nodiscard]] BodyMotion motion(std::size_t robot, std::size_t member, const Pose& X_MG) const {
    const SceneRobot& described = given_.scene.robots[robot];
    const bool moves = described.trajectory.points.size() > 1 ||
                       !std::holds_alternative<FixedMotion>(described.base);
    if (described.dynamics || !moves) {
      return FixedMotion{pose(member, X_MG, 0.0)};
    }
    const double step = given_.scene.simulation->step;
    const double duration = given_.scene.duration;
    WaypointMotion waypoints;
    for (std::size_t k = 0; waypoints.times.empty() || waypoints.times.back() < duration; ++k) {
      const double time = std::min(duration, static_cast<double>(k) * step);
      waypoints.times.push_back(time);
      waypoints.poses.push_back(pose(member, X_MG, time / duration));
    }
    return waypoints;
  }

  [[nodiscard]] std::vector<std::size_t> bodies_of(const std::vector<std::size_t>& members) const {
    std::vector<std::size_t> bodies;
    for (const std::size_t member : members) {
      bodies.insert(bodies.end(), bodies_of_[member].begin(), bodies_of_[member].end());
    }
    return bodies;
  }

  /// All pairs of the geometries of two members.
  template <class Use>
  void for_each_pair(const BodyPair& members, const Use& use) const {
    for (const std::size_t a : bodies_of_[members[0]]) {
      for (const std::size_t b : bodies_of_[members[1]]) {
        if (a != b) {
          use(BodyPair{std::min(a, b), std::max(a, b)});
        }
      }
    }
  }

  void take_rules() {
    const Scene& given = given_.scene;
    for (BodyGroup& group : scene_.groups) {
      group.bodies = bodies_of(group.bodies);
    }
    scene_.ignored_pairs.clear();
    scene_.pair_margins.clear();
    scene_.simulation->pairs.clear();
    const auto ignore = [this](const BodyPair& pair) { scene_.ignored_pairs.push_back(pair); };
    for (const BodyPair& pair : given.ignored_pairs) {
      for_each_pair(pair, ignore);
    }
    for (const PairMargin& pair : given.pair_margins) {
      for_each_pair(pair.bodies, [&](const BodyPair& bodies) {
        scene_.pair_margins.push_back({bodies, pair.margin});
      });
    }
    for (const PairSurface& pair : given.simulation->pairs) {
      for_each_pair(pair.bodies, [&](const BodyPair& bodies) {
        scene_.simulation->pairs.push_back({bodies, pair.surface});
      });
    }
    for (Tie& tie : scene_.simulation->ties) {
      for (std::size_t s = 0; s < 2; ++s) {
        take_end(s, tie);
      }
    }
    for (std::size_t r = 0; r < given.robots.size(); ++r) {
      ignore_within(r, ignore);
      take_padding(r);
    }
  }

  /// Replaces a link at an end of a tie by the link's first geometry.
  void take_end(std::size_t side, Tie& tie) const {
    if (!tie.bodies[side] || *tie.bodies[side] < given_.scene.bodies.size()) {
      return;
    }
    const std::size_t member = *tie.bodies[side];
    if (bodies_of_[member].empty()) {
      throw std::invalid_argument("simulation.ties: link " +
                                  detail::in_quotes(member_name(given_.scene, member)) +
                                  " has no geometry, and cannot be tied; give it a <collision>, of "
                                  "pairs that are ignored");
    }
    const std::size_t body = bodies_of_[member].front();
    const Pose& X_LG = geometries_[body - given_.scene.bodies.size()].X_LG;
    const Eigen::Quaterniond R_GL = X_LG.rotation.normalized().conjugate();
    tie.bodies[side] = body;
    if (tie.points[side]) {
      tie.points[side] = R_GL * (*tie.points[side] - X_LG.position);
    }
    if (side == 0) {
      tie.axis = R_GL * tie.axis;
    }
  }

  template <class Ignore>
  void ignore_within(std::size_t robot, const Ignore& ignore) {
    const std::size_t first = robots_.first_member(robot);
    const std::size_t count = given_.scene.robots[robot].model.links().size();
    for (std::size_t a = first; a < first + count; ++a) {
      for (std::size_t i = 0; i < bodies_of_[a].size(); ++i) {
        for (std::size_t k = i + 1; k < bodies_of_[a].size(); ++k) {
          ignore({bodies_of_[a][i], bodies_of_[a][k]});
        }
      }
      for (std::size_t b = a + 1; b < first + count; ++b) {
        if (!robots_.margin({a, b})) {
          for_each_pair({a, b}, ignore);
        }
      }
    }
  }

  void take_padding(std::size_t robot) {
    for (const auto& [link, padding] : given_.scene.robots[robot].padding) {
      const std::size_t a = robots_.first_member(robot) + link;
      for (std::size_t b = 0; b < robots_.size() && padding > 0.0; ++b) {
        const std::optional<double> margin =
            a == b ? std::nullopt : robots_.margin({std::min(a, b), std::max(a, b)});
        if (margin) {
          for_each_pair({a, b}, [&](const BodyPair& bodies) {
            scene_.pair_margins.push_back({bodies, *margin});
          });
        }
      }
    }
  }

  LoadedScene load() {
    LoadedScene loaded{.scene = {},
                       .bodies = BodySet(detail::rules_of(scene_)),
                       .input_digest = given_.input_digest,
                       .robots = {},
                       .limits = given_.limits,
                       .warnings = given_.warnings,
                       .files = given_.files,
                       .pair_counts = {}};
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const bool is_of_link = b >= given_.scene.bodies.size();
      loaded.bodies.add(is_of_link ? std::get<Shape>(scene_.bodies[b].shape.source)
                                   : robots_.geometries(b).front().shape,
                        normalised_motion(scene_.bodies[b].motion, scene_.duration));
    }
    loaded.scene = std::move(scene_);
    return loaded;
  }

  const LoadedScene& given_;
  const RobotScene& robots_;
  std::vector<std::vector<std::size_t>> bodies_of_;  // For each member of the given scene.
  Scene scene_;
  std::vector<LinkGeometryPose> geometries_;
};

}  // namespace

LinksAsBodies links_as_bodies(const LoadedScene& loaded) {
  LinksAsBodies result = loaded.robots
                             ? Links(loaded).run()
                             : LinksAsBodies{.loaded = loaded, .geometries = {}, .models = {}};
  result.loaded.pair_counts = count_simulated_pairs(loaded);
  return result;
}

std::vector<std::string> names_with_links(const Scene& scene) {
  std::vector<std::string> names;
  for (const Body& body : scene.bodies) {
    names.push_back(body.name);
  }
  for (const SceneRobot& robot : scene.robots) {
    for (const Link& link : robot.model.links()) {
      for (std::size_t g = 0; g < link.collision.size(); ++g) {
        names.push_back(geometry_name(robot, link, g));
      }
    }
  }
  return names;
}

}  // namespace firstcontact
