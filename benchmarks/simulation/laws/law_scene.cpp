#include "benchmarks/simulation/laws/law_scene.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

Vector3d three(const json& v) {
  return {v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()};
}
json three(const Vector3d& v) { return json::array({v.x(), v.y(), v.z()}); }

/// Thrown where a scene has something that this comparison of engines leaves out.
class NotForPeer : public std::runtime_error {
 public:
  NotForPeer() : std::runtime_error("not for this engine") {}
};

LawShape shape_of(const json& shape) {
  if (shape.contains("box")) {
    return {LawShape::Kind::box, 0.5 * three(shape.at("box").at("size"))};
  }
  if (shape.contains("sphere")) {
    return {LawShape::Kind::sphere, Vector3d::Constant(shape.at("sphere").at("radius"))};
  }
  if (shape.contains("ellipsoid")) {
    return {LawShape::Kind::ellipsoid, three(shape.at("ellipsoid").at("radii"))};
  }
  const bool is_capsule = shape.contains("capsule");
  if (!is_capsule && !shape.contains("cylinder")) {
    throw NotForPeer();
  }
  const json& round = shape.at(is_capsule ? "capsule" : "cylinder");
  const double radius = round.at("radius");
  return {is_capsule ? LawShape::Kind::capsule : LawShape::Kind::cylinder,
          {radius, radius, 0.5 * round.at("length").get<double>()}};
}

/// Computes the mass and the moments of inertia for a density of 1000 kg/m^3.
void fill_mass(LawBody& body) {
  const Vector3d& h = body.shape.half;
  switch (body.shape.kind) {
    case LawShape::Kind::box:
      body.mass = 8e3 * h.prod();
      body.moments = body.mass / 3.0 *
                     Vector3d(h.y() * h.y() + h.z() * h.z(), h.x() * h.x() + h.z() * h.z(),
                              h.x() * h.x() + h.y() * h.y());
      return;
    case LawShape::Kind::sphere:
      body.mass = 4e3 / 3.0 * std::numbers::pi * std::pow(h.x(), 3);
      body.moments = Vector3d::Constant(0.4 * body.mass * h.x() * h.x());
      return;
    case LawShape::Kind::ellipsoid:  // Its mass and inertia are given, as are those of a capsule.
    case LawShape::Kind::capsule:
    case LawShape::Kind::cylinder:
      body.mass = 2e3 * std::numbers::pi * h.x() * h.x() * h.z();
      const double across = body.mass * (0.25 * h.x() * h.x() + h.z() * h.z() / 3.0);
      body.moments = {across, across, 0.5 * body.mass * h.x() * h.x()};
      return;
  }
}

void set_pose(const json& pose, LawBody& body) {
  body.p_WB = three(pose.at("position"));
  if (pose.contains("quaternion_wxyz")) {
    const json& q = pose.at("quaternion_wxyz");
    body.q_WB = Eigen::Quaterniond(q.at(0).get<double>(), q.at(1).get<double>(),
                                   q.at(2).get<double>(), q.at(3).get<double>());
  }
}

LawBody body_of(const json& described, double duration) {
  LawBody body{.shape = shape_of(described.at("shape"))};
  fill_mass(body);
  if (described.contains("pose")) {
    set_pose(described.at("pose"), body);
  }
  if (described.contains("motion")) {
    body.motion = LawMotion::spins;
    set_pose(described.at("motion").at("from"), body);
    body.w = three(described.at("motion").at("rotation_vector")) / duration;
  }
  if (described.contains("dynamics")) {
    const json& dynamics = described.at("dynamics");
    body.motion = LawMotion::free;
    const double density = body.mass;
    body.mass = dynamics.value("mass", body.mass);
    body.moments *= body.mass / density;
    if (dynamics.contains("inertia")) {
      const json& rows = dynamics.at("inertia");
      body.moments = three(json::array({rows.at(0).at(0), rows.at(1).at(1), rows.at(2).at(2)}));
    }
    if (dynamics.contains("centre_of_mass")) {
      body.p_CS = -three(dynamics.at("centre_of_mass"));
      body.p_WB -= body.q_WB * body.p_CS;
    }
    if (dynamics.contains("linear_velocity")) {
      body.v = three(dynamics.at("linear_velocity"));
    }
    if (dynamics.contains("angular_velocity")) {
      body.w = three(dynamics.at("angular_velocity"));
    }
    body.restitution = dynamics.value("restitution", 0.0);
  }
  return body;
}

LawRobot robot_of(const json& described, const std::filesystem::path& folder) {
  LawRobot robot{.urdf = folder / described.at("urdf").get<std::string>()};
  const json& dynamics = described.at("dynamics");
  const json motors = dynamics.value("motors", json::object());
  const json velocities = dynamics.value("velocities", json::object());
  robot.is_free = dynamics.at("base") == "free";
  if (robot.is_free) {
    robot.v = three(dynamics.at("linear_velocity"));
    robot.w = three(dynamics.at("angular_velocity"));
  }
  for (const auto& [joint, position] : described.at("state").items()) {
    robot.positions.push_back(position);
    robot.velocities.push_back(velocities.value(joint, 0.0));
    robot.stiffnesses.push_back(motors.contains(joint) ? motors.at(joint).value("stiffness", 0.0)
                                                       : 0.0);
  }
  return robot;
}

LawScene scene_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  const json described = json::parse(file);
  const json& simulation = described.at("simulation");
  if (simulation.contains("ties")) {
    throw NotForPeer();
  }
  LawScene scene{.step = simulation.at("step"),
                 .duration = simulation.at("duration"),
                 .gravity = -simulation.at("gravity").at(2).get<double>(),
                 .friction = simulation.at("friction")};
  for (const json& body : described.at("bodies")) {
    scene.bodies.push_back(body_of(body, scene.duration));
  }
  for (const json& robot : described.value("robots", json::array())) {
    scene.robots.push_back(robot_of(robot, path.parent_path()));
  }
  return scene;
}

void add_to(LawTotals& totals, const LawBody& body) {
  const Vector3d w_B = body.q_WB.conjugate() * body.w;
  const Vector3d spin = body.moments.cwiseProduct(w_B);
  totals.momentum += body.mass * body.v;
  totals.angular_momentum += body.mass * body.p_WB.cross(body.v) + body.q_WB * spin;
  totals.kinetic_energy += 0.5 * (body.mass * body.v.squaredNorm() + spin.dot(w_B));
}

json line_of(const LawScene& scene, LawEngine& engine, double time) {
  json bodies = json::array();
  LawTotals totals = engine.robots();
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    if (scene.bodies[k].motion == LawMotion::free) {
      const LawBody body = engine.body(k);
      add_to(totals, body);
      bodies.push_back(
          {{"body", k},
           {"position", three(body.p_WB)},
           {"quaternion_wxyz", {body.q_WB.w(), body.q_WB.x(), body.q_WB.y(), body.q_WB.z()}},
           {"linear_velocity", three(body.v)},
           {"angular_velocity", three(body.w)}});
    }
  }
  json robots = json::array();
  for (std::size_t r = 0; r < scene.robots.size(); ++r) {
    robots.push_back({{"positions", engine.positions(r)}});
  }
  return {{"time", time},
          {"bodies", bodies},
          {"robots", robots},
          {"kinetic_energy", totals.kinetic_energy},
          {"linear_momentum", three(totals.momentum)},
          {"angular_momentum", three(totals.angular_momentum)}};
}

}  // namespace

int simulate_law(int argc, char** argv, bool has_robots,
                 const std::function<std::unique_ptr<LawEngine>(const LawScene&)>& load) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s SCENE RUN\n", argv[0]);
    return 2;
  }
  try {
    const LawScene scene = scene_of(argv[1]);
    if (!scene.robots.empty() && !has_robots) {
      throw NotForPeer();
    }
    const std::unique_ptr<LawEngine> engine = load(scene);
    std::ofstream run(argv[2]);
    run << "{}\n";
    const auto steps = static_cast<int>(std::lround(scene.duration / scene.step));
    for (int k = 1; k <= steps; ++k) {
      engine->step();
      run << line_of(scene, *engine, k * scene.step).dump() << "\n";
    }
    return 0;
  } catch (const NotForPeer&) {
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}

}  // namespace firstcontact::benchmarks
