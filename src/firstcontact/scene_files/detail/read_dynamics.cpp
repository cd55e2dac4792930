#include <firstcontact/scene_files/detail/read_dynamics.h>

#include <array>
#include <cstddef>
#include <limits>
#include <string>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <firstcontact/scene/scene.h>

namespace firstcontact::detail {
namespace {

/// [-]  Printed numbers that are nearer than this to symmetric, or to a flat body, count as such.
constexpr double kPrinted = 1e-9;  // [-]

Eigen::Matrix3d read_matrix3(const JsonValue& value, const JsonReader& read) {
  const JsonArray& rows = read.array(value, "a matrix of three rows of three numbers");
  if (rows.size() != 3) {
    read.fail_expected("a matrix of three rows of three numbers", value);
  }
  Eigen::Matrix3d matrix;
  for (std::size_t i = 0; i < 3; ++i) {
    matrix.row(static_cast<Eigen::Index>(i)) = read.vector3(rows[i]).transpose();
  }
  return matrix;
}

/// Reads an inertia that some distribution of mass has.
Eigen::Matrix3d read_inertia(const JsonValue& value, const JsonReader& read) {
  const Eigen::Matrix3d given = read_matrix3(value, read);
  const double size = given.cwiseAbs().maxCoeff();
  if (!((given - given.transpose()).cwiseAbs().maxCoeff() <= kPrinted * size)) {
    read.fail(value, "expected a symmetric matrix: row i, column j as row j, column i");
  }
  Eigen::Matrix3d inertia = 0.5 * (given + given.transpose());
  // Scaled to size 1, so that no product under- or overflows.
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia / size, Eigen::EigenvaluesOnly)
          .eigenvalues();
  if (!(moments[0] > 0.0)) {
    read.fail(value, "expected principal moments > 0");
  }
  if (!(moments[2] <= (moments[0] + moments[1]) * (1.0 + kPrinted))) {
    read.fail(value,
              "expected principal moments of which none is greater than the sum of the other two: "
              "no body has such");
  }
  return inertia;
}

std::array<bool, 3> read_locks(const JsonValue& value, const JsonReader& read) {
  const std::string expected = "three of true and false, for the axes x, y, z of the world";
  const JsonArray& elements = read.array(value, expected);
  if (elements.size() != 3) {
    read.fail_expected(expected, value);
  }
  return {read.boolean(elements[0]), read.boolean(elements[1]), read.boolean(elements[2])};
}

TimedForce read_force(const JsonValue& value, const JsonReader& read) {
  const JsonObject& object = read.object(value, {{"from", "to", "force", "torque"}});
  TimedForce force{.to = std::numeric_limits<double>::infinity()};
  if (const JsonValue* from = find(object, "from")) {
    force.from = read.not_negative(*from);
  }
  if (const JsonValue* to = find(object, "to")) {
    force.to = read.positive(*to);
    if (!(force.to > force.from)) {
      read.fail_expected("a time later than \"from\"", *to);
    }
  }
  const JsonValue* linear = find(object, "force");
  const JsonValue* torque = find(object, "torque");
  if (linear == nullptr && torque == nullptr) {
    read.fail(value, "expected \"force\" or \"torque\", got neither");
  }
  if (linear != nullptr) {
    force.force = read.vector3(*linear);
  }
  if (torque != nullptr) {
    force.torque = read.vector3(*torque);
  }
  return force;
}

void read_mass(const JsonObject& object, FreeBody& body, const JsonReader& read) {
  const JsonValue* density = find(object, "density");
  const JsonValue* mass = find(object, "mass");
  if (density != nullptr && mass != nullptr) {
    read.fail(*mass, "expected either \"density\" or \"mass\", got both");
  }
  if (density != nullptr) {
    body.density = read.positive(*density);
  }
  if (mass != nullptr) {
    body.mass = read.positive(*mass);
  }
  if (const JsonValue* centre = find(object, "centre_of_mass")) {
    body.centre_of_mass = read.vector3(*centre);
  }
  if (const JsonValue* inertia = find(object, "inertia")) {
    body.inertia = read_inertia(*inertia, read);
  }
}

/// Reads an angular velocity. Motions turn by 1e8 rad at most, and steps are about a second at
/// most.
Eigen::Vector3d read_angular_velocity(const JsonValue& value, const JsonReader& read) {
  constexpr double kLargest = 1e8;
  Eigen::Vector3d velocity = read.vector3(value);
  if (!(velocity.norm() <= kLargest)) {
    read.fail_expected("an angular velocity of at most 1e8 rad/s", value);
  }
  return velocity;
}

}  // namespace

void read_dynamics(const JsonValue& value, Body& body, const JsonReader& read) {
  const JsonObject& object = read.object(
      value,
      {{"density", "mass", "centre_of_mass", "inertia", "linear_velocity", "angular_velocity",
        "friction", "restitution", "locked_translation", "locked_rotation", "forces"}});
  FreeBody& free = body.free.emplace();
  read_mass(object, free, read);
  if (const JsonValue* velocity = find(object, "linear_velocity")) {
    free.linear_velocity = read.vector3(*velocity);
  }
  if (const JsonValue* velocity = find(object, "angular_velocity")) {
    free.angular_velocity = read_angular_velocity(*velocity, read);
  }
  body.surface = read_surface(object, read);
  if (const JsonValue* locks = find(object, "locked_translation")) {
    free.locked_translation = read_locks(*locks, read);
  }
  if (const JsonValue* locks = find(object, "locked_rotation")) {
    free.locked_rotation = read_locks(*locks, read);
  }
  if (const JsonValue* forces = find(object, "forces")) {
    for (const JsonValue& element : read.array(*forces, "an array of forces")) {
      free.forces.push_back(read_force(element, read));
    }
  }
}

Surface read_surface(const JsonObject& object, const JsonReader& read) {
  Surface surface;
  if (const JsonValue* friction = find(object, "friction")) {
    surface.friction = read.not_negative(*friction);
  }
  if (const JsonValue* restitution = find(object, "restitution")) {
    surface.restitution = read_restitution(*restitution, read);
  }
  return surface;
}

double read_restitution(const JsonValue& value, const JsonReader& read) {
  const double restitution = read.number(value);
  if (!(restitution >= 0.0 && restitution <= 1.0)) {
    read.fail_expected("a number from 0 to 1", value);
  }
  return restitution;
}

}  // namespace firstcontact::detail
