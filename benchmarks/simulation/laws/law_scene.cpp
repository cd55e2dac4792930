#include "benchmarks/simulation/laws/law_scene.h"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "benchmarks/simulation/laws/law_robot.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

Vector3d three(const json& v) {
  return {v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()};
}
json three(const Vector3d& v) { return json::array({v.x(), v.y(), v.z()}); }

LawShape shape_of(const json& shape) {
  if (shape.contains("box")) {
    return {.half = 0.5 * three(shape.at("box").at("size"))};
  }
  if (shape.contains("sphere")) {
    return {.kind = LawShape::Kind::sphere,
            .half = Vector3d::Constant(shape.at("sphere").at("radius"))};
  }
  if (shape.contains("ellipsoid")) {
    return {.kind = LawShape::Kind::ellipsoid, .half = three(shape.at("ellipsoid").at("radii"))};
  }
  const bool is_capsule = shape.contains("capsule");
  if (!is_capsule && !shape.contains("cylinder")) {
    throw NotForPeer();
  }
  const json& round = shape.at(is_capsule ? "capsule" : "cylinder");
  const double radius = round.at("radius");
  return {.kind = is_capsule ? LawShape::Kind::capsule : LawShape::Kind::cylinder,
          .half = {radius, radius, 0.5 * round.at("length").get<double>()}};
}

/// Computes the mass and the moments of inertia for a density of 1000 kg/m^3.
void fill_mass(const LawShape& shape, LawState& state) {
  const Vector3d& h = shape.half;
  switch (shape.kind) {
    case LawShape::Kind::box:
      state.mass = 8e3 * h.prod();
      state.moments = state.mass / 3.0 *
                      Vector3d(h.y() * h.y() + h.z() * h.z(), h.x() * h.x() + h.z() * h.z(),
                               h.x() * h.x() + h.y() * h.y());
      return;
    case LawShape::Kind::sphere:
      state.mass = 4e3 / 3.0 * std::numbers::pi * std::pow(h.x(), 3);
      state.moments = Vector3d::Constant(0.4 * state.mass * h.x() * h.x());
      return;
    case LawShape::Kind::ellipsoid:  // Their mass and inertia are given, as are those of a capsule.
    case LawShape::Kind::hull:
    case LawShape::Kind::capsule:
    case LawShape::Kind::cylinder:
      state.mass = 2e3 * std::numbers::pi * h.x() * h.x() * h.z();
      const double across = state.mass * (0.25 * h.x() * h.x() + h.z() * h.z() / 3.0);
      state.moments = {across, across, 0.5 * state.mass * h.x() * h.x()};
      return;
  }
}

void set_pose(const json& pose, Vector3d& position, Eigen::Quaterniond& rotation) {
  position = three(pose.at("position"));
  if (pose.contains("quaternion_wxyz")) {
    const json& q = pose.at("quaternion_wxyz");
    rotation = Eigen::Quaterniond(q.at(0).get<double>(), q.at(1).get<double>(),
                                  q.at(2).get<double>(), q.at(3).get<double>());
  }
}

bool is_in_plane(const json& dynamics) {
  if (!dynamics.contains("locked_translation") && !dynamics.contains("locked_rotation")) {
    return false;
  }
  if (dynamics.at("locked_translation") != json({false, true, false}) ||
      dynamics.at("locked_rotation") != json({true, false, true})) {
    throw NotForPeer();
  }
  return true;
}

void set_dynamics(const json& dynamics, LawBody& body) {
  LawState& start = body.start;
  body.motion = is_in_plane(dynamics) ? LawMotion::plane : LawMotion::free;
  const double mass = start.mass;
  start.mass = dynamics.value("mass", mass);
  if (dynamics.contains("inertia")) {
    const json& rows = dynamics.at("inertia");
    start.moments = three(json::array({rows.at(0).at(0), rows.at(1).at(1), rows.at(2).at(2)}));
  } else {
    start.moments *= start.mass / mass;
  }
  if (dynamics.contains("centre_of_mass")) {
    const Vector3d p_BC = three(dynamics.at("centre_of_mass"));
    for (LawShape& shape : body.shapes) {
      shape.p_BS -= p_BC;
    }
    start.p_WC += start.q_WB * p_BC;
  }
  if (dynamics.contains("linear_velocity")) {
    start.v = three(dynamics.at("linear_velocity"));
  }
  if (dynamics.contains("angular_velocity")) {
    start.w = three(dynamics.at("angular_velocity"));
  }
  body.restitution = dynamics.value("restitution", 0.0);
}

LawBody body_of(const json& described, double duration) {
  LawBody body{.name = described.at("name")};
  if (described.contains("hulls")) {  // In place of the mesh in `shape`.
    for (const json& corners : described.at("hulls")) {
      body.shapes.push_back({.kind = LawShape::Kind::hull});
      for (const json& corner : corners) {
        body.shapes.back().corners.push_back(three(corner));
      }
    }
  } else {
    body.shapes.push_back(shape_of(described.at("shape")));
  }
  LawState& start = body.start;
  fill_mass(body.shapes.front(), start);
  if (described.contains("pose")) {
    set_pose(described.at("pose"), start.p_WC, start.q_WB);
  }
  if (described.contains("motion")) {
    body.motion = LawMotion::spins;
    set_pose(described.at("motion").at("from"), start.p_WC, start.q_WB);
    start.w = three(described.at("motion").at("rotation_vector")) / duration;
  }
  if (described.contains("dynamics")) {
    set_dynamics(described.at("dynamics"), body);
  }
  return body;
}

LawRows rows_of(const json& target) {
  if (target.is_number()) {
    return {{0.0, target.get<double>()}};
  }
  LawRows rows;
  for (const json& row : target) {
    rows.emplace_back(row.at(0), row.at(1));
  }
  return rows;
}

LawMotor motor_of(const json& described) {
  LawMotor motor;
  motor.stiffness = described.value("stiffness", 0.0);
  motor.damping = described.value("damping", 0.0);
  if (described.contains("torque")) {
    if (described.at("torque") != 0) {
      throw NotForPeer();
    }
    return motor;
  }
  const bool has_position = described.contains("position");
  motor.target = rows_of(described.at(has_position ? "position" : "velocity"));
  motor.kind = !has_position           ? LawMotor::Kind::velocity
               : motor.stiffness > 0.0 ? LawMotor::Kind::spring
                                       : LawMotor::Kind::position;
  return motor;
}

LawRobot robot_of(const json& described, const std::filesystem::path& folder) {
  LawRobot robot{.name = described.at("name"),
                 .links = read_links(folder / described.at("urdf").get<std::string>())};
  const json& dynamics = described.at("dynamics");
  robot.is_free = dynamics.at("base") == "free";
  if (described.contains("base")) {
    set_pose(described.at("base"), robot.p_WL, robot.q_WL);
  }
  const json zero = json::array({0.0, 0.0, 0.0});
  robot.v = three(dynamics.value("linear_velocity", zero));
  robot.w = three(dynamics.value("angular_velocity", zero));
  const json none = json::object();
  const json positions = described.value("state", none);
  const json velocities = dynamics.value("velocities", none);
  const json motors = dynamics.value("motors", none);
  for (LawLink& link : robot.links) {
    link.position = positions.value(link.joint, 0.0);
    link.velocity = velocities.value(link.joint, 0.0);
    if (motors.contains(link.joint)) {
      link.motor = motor_of(motors.at(link.joint));
    }
  }
  return robot;
}

/// Finds the end of a tie at "body", "robot/link" or null.
LawTie::End end_of(const json& name, const json& point, const LawScene& scene) {
  LawTie::End end{.point = three(point)};
  if (name.is_null()) {
    return end;
  }
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    if (scene.bodies[k].name == name) {
      end.member = static_cast<int>(k);
      return end;
    }
  }
  for (std::size_t r = 0; r < scene.robots.size(); ++r) {
    for (std::size_t k = 0; k < scene.robots[r].links.size(); ++k) {
      if (scene.robots[r].name + "/" + scene.robots[r].links[k].name == name) {
        end.robot = static_cast<int>(r);
        end.member = static_cast<int>(k);
        return end;
      }
    }
  }
  throw NotForPeer();
}

LawTie tie_of(const json& described, const LawScene& scene) {
  const std::string type = described.at("type");
  if (type != "spring" && type != "pin") {
    throw NotForPeer();
  }
  LawTie tie{.kind = type == "pin" ? LawTie::Kind::pin : LawTie::Kind::spring,
             .stiffness = described.value("stiffness", 0.0),
             .length = described.value("length", 0.0)};
  for (std::size_t e = 0; e < 2; ++e) {
    tie.ends[e] = end_of(described.at("bodies").at(e), described.at("points").at(e), scene);
  }
  return tie;
}

LawScene scene_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  const json described = json::parse(file);
  const json& simulation = described.at("simulation");
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
  for (const json& tie : simulation.value("ties", json::array())) {
    scene.ties.push_back(tie_of(tie, scene));
  }
  return scene;
}

/// The states of what moves, in the order of the run, and their sums.
class RunLine {
 public:
  explicit RunLine(double gravity) : gravity_(gravity) {}

  void add(std::size_t number, const LawState& state) {
    const Vector3d w_B = state.q_WB.conjugate() * state.w;
    const Vector3d spin = state.moments.cwiseProduct(w_B);
    momentum_ += state.mass * state.v;
    angular_momentum_ += state.mass * state.p_WC.cross(state.v) + state.q_WB * spin;
    kinetic_energy_ += 0.5 * (state.mass * state.v.squaredNorm() + spin.dot(w_B));
    potential_energy_ += state.mass * gravity_ * state.p_WC.z();
    const Eigen::Quaterniond& q = state.q_WB;
    bodies_.push_back({{"body", number},
                       {"position", three(state.p_WC)},
                       {"quaternion_wxyz", {q.w(), q.x(), q.y(), q.z()}},
                       {"linear_velocity", three(state.v)},
                       {"angular_velocity", three(state.w)}});
  }

  [[nodiscard]] json with(double time, const json& robots) const {
    return {{"time", time},
            {"bodies", bodies_},
            {"robots", robots},
            {"kinetic_energy", kinetic_energy_},
            {"potential_energy", potential_energy_},
            {"linear_momentum", three(momentum_)},
            {"angular_momentum", three(angular_momentum_)}};
  }

 private:
  double gravity_ = 0.0;
  json bodies_ = json::array();
  Vector3d momentum_ = Vector3d::Zero();
  Vector3d angular_momentum_ = Vector3d::Zero();
  double kinetic_energy_ = 0.0;
  double potential_energy_ = 0.0;
};

json line_of(const LawScene& scene, LawEngine& engine, double time) {
  RunLine line(scene.gravity);
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    if (scene.bodies[k].motion == LawMotion::free || scene.bodies[k].motion == LawMotion::plane) {
      line.add(k, engine.body(k));
    }
  }
  json robots = json::array();
  std::size_t number = scene.bodies.size();
  for (std::size_t r = 0; r < scene.robots.size(); ++r) {
    const LawRobot& robot = scene.robots[r];
    std::vector<double> positions;
    for (std::size_t k = 0; k < robot.links.size(); ++k) {
      if (k > 0) {
        positions.push_back(engine.position(r, k));
      }
      if (k > 0 || robot.is_free) {
        line.add(number, engine.link(r, k));
      }
      number += robot.links[k].shapes.size();  // Links count by their geometries.
    }
    robots.push_back({{"positions", positions}});
  }
  return line.with(time, robots);
}

}  // namespace

double value_at(const LawRows& rows, double time) {
  std::size_t k = 0;
  while (k + 1 < rows.size() && rows[k + 1].first < time) {
    ++k;
  }
  if (k + 1 == rows.size() || time <= rows[k].first) {
    return rows[k].second;
  }
  const auto& [t0, v0] = rows[k];
  const auto& [t1, v1] = rows[k + 1];
  return v0 + (v1 - v0) * (time - t0) / (t1 - t0);
}

double integral_to(const LawRows& rows, double time) {
  double sum = 0.0;
  double from = 0.0;
  for (const auto& row : rows) {
    if (row.first > from && row.first < time) {
      sum += 0.5 * (value_at(rows, from) + row.second) * (row.first - from);
      from = row.first;
    }
  }
  return sum + 0.5 * (value_at(rows, from) + value_at(rows, time)) * (time - from);
}

int simulate_law(int argc, char** argv,
                 const std::function<std::unique_ptr<LawEngine>(const LawScene&)>& load) {
  if (argc != 3 && argc != 4) {
    std::fprintf(stderr, "usage: %s SCENE RUN [INTEGRATOR]\n", argv[0]);
    return 2;
  }
  try {
    LawScene scene = scene_of(argv[1]);
    scene.integrator = argc == 4 ? argv[3] : "";
    const std::unique_ptr<LawEngine> engine = load(scene);
    std::ofstream run(argv[2]);
    run << "{}\n";
    run << line_of(scene, *engine, 0.0).dump() << "\n";
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
