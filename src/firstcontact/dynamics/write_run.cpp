#include <firstcontact/dynamics/write_run.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/scene/write_result.h>
#include <firstcontact/scene/write_scene.h>

namespace firstcontact {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(double number) {
  if (!std::isfinite(number)) {
    throw std::invalid_argument("a run holds finite numbers only, got " + std::to_string(number));
  }
  return number;
}

Json to_json(const Eigen::Vector3d& v) {
  return Json::array({to_json(v.x()), to_json(v.y()), to_json(v.z())});
}

Json to_json(const Eigen::Quaterniond& q) {
  return Json::array({to_json(q.w()), to_json(q.x()), to_json(q.y()), to_json(q.z())});
}

template <class T>
Json to_json(const std::vector<T>& elements);

void append(Json& row, const Json& numbers) {
  row.insert(row.end(), numbers.begin(), numbers.end());
}

Json to_json(const RunPiece& piece) {
  Json row = Json::array({to_json(piece.to)});
  append(row, to_json(piece.X_WB.position));
  append(row, to_json(piece.X_WB.rotation));
  append(row, to_json(piece.translation));
  append(row, to_json(piece.rotation_vector));
  return row;
}

Json to_json(const RunBody& body) {
  return {{"body", body.body},
          {"pieces", to_json(body.pieces)},
          {"position", to_json(body.X_WB.position)},
          {"quaternion_wxyz", to_json(body.X_WB.rotation)},
          {"linear_velocity", to_json(body.linear_velocity)},
          {"angular_velocity", to_json(body.angular_velocity)}};
}

Json to_json(const RunRobot& robot) {
  return {{"robot", robot.robot},
          {"positions", to_json(robot.positions)},
          {"velocities", to_json(robot.velocities)}};
}

Json to_json(const Feature& feature) {
  return {{"type", word(feature.type)}, {"index", feature.index}};
}

Json to_json(const RunContact& contact) {
  return {{"bodies", contact.bodies},
          {"features", Json::array({to_json(contact.feature_A), to_json(contact.feature_B)})},
          {"triangles", Json::array({contact.feature_A.triangle, contact.feature_B.triangle})},
          {"point", to_json(contact.point)},
          {"normal", to_json(contact.normal)},
          {"distance", to_json(contact.distance)},
          {"impulse", to_json(contact.impulse)}};
}

template <class T>
Json to_json(const std::vector<T>& elements) {
  Json array = Json::array();
  for (const T& element : elements) {
    array.push_back(to_json(element));
  }
  return array;
}

Json clearance_json(double clearance) {
  const bool no_pair = clearance == std::numeric_limits<double>::infinity();
  return no_pair ? Json() : to_json(clearance);
}

}  // namespace

std::string write_run_header(const RunHeader& header) {
  const Json rest = {{"version", header.version},
                     {"input_digest", header.input_digest},
                     {"masses", to_json(header.masses)},
                     {"centres_of_mass", to_json(header.centres_of_mass)}};
  // The scene has a writer of its own.
  return "{\"firstcontact_run\":1,\"scene\":" + write_scene(header.scene) + "," +
         rest.dump().substr(1) + "\n";
}

std::string write_run_step(const RunStep& step) {
  Json line = {{"step", step.index},
               {"time", to_json(step.time)},
               {"lasted", to_json(step.lasted)},
               {"time_lost", to_json(step.time_lost)},
               {"bodies", to_json(step.bodies)},
               {"contacts", to_json(step.contacts)},
               {"clearance", clearance_json(step.clearance)},
               {"kinetic_energy", to_json(step.kinetic_energy)},
               {"potential_energy", to_json(step.potential_energy)},
               {"linear_momentum", to_json(step.linear_momentum)},
               {"angular_momentum", to_json(step.angular_momentum)},
               {"residual", to_json(step.residual)},
               {"events", step.events}};
  if (!step.robots.empty()) {
    line["robots"] = to_json(step.robots);
  }
  return line.dump() + "\n";
}

}  // namespace firstcontact
