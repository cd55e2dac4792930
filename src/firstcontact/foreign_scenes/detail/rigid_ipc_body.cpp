#include <firstcontact/foreign_scenes/detail/rigid_ipc_body.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <firstcontact/geometry/mass_properties.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/rotation_forms.h>
#include <firstcontact/scene/detail/thin_mass.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// [kg]  Limits by which no product of masses and squared lengths over- or underflows.
constexpr double kLeastMass = 1e-100;
constexpr double kGreatestMass = 1e100;

/// Computes the mass of the enclosed solid; none where the mesh encloses no space.
std::optional<MassProperties> solid_mass(const Shape& shape) {
  try {
    return mass_properties(shape);
  } catch (const std::invalid_argument&) {
    return {};
  }
}

/// Finds the principal axes, as columns in those of the given inertia; the identity where every
/// axis is a principal one.
Quaterniond principal_axes(const Matrix3d& inertia) {
  constexpr double kRounding = 1e-9;  // [-]
  const double mean = inertia.trace() / 3.0;
  if ((inertia - mean * Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kRounding * mean) {
    return Quaterniond::Identity();
  }
  Matrix3d axes = Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia).eigenvectors();
  if (axes.determinant() < 0.0) {
    axes.col(0) *= -1.0;
  }
  return Quaterniond(axes).normalized();
}

/// Converts a pose of the centre of mass and principal axes to one of the centre of mass and mesh
/// axes.
Pose with_mesh_axes(const Pose& pose, const RigidIpcBody& body, const WeighedShape& shape) {
  const Matrix3d R = body.X_WB.rotation.toRotationMatrix();
  const bool one_axis = std::ranges::count(body.locked_rotation, true) == 2;
  const Quaterniond principal =
      one_axis ? Quaterniond::Identity() : principal_axes(R * shape.about_C * R.transpose());
  return {.position = pose.position,
          .rotation = pose.rotation * principal.conjugate() * body.X_WB.rotation};
}

Pose advanced(const Pose& pose, const RigidIpcBody& body, double dt) {
  return {.position = pose.position + dt * body.linear_velocity,
          .rotation = rotation_from_vector(dt * body.angular_velocity) * pose.rotation};
}

/// Goes on from the last waypoint at constant rates, by shortest turns.
void go_on(const RigidIpcBody& body, double until, WaypointMotion& motion) {
  constexpr double kQuarterTurn = std::numbers::pi / 2.0;
  constexpr double kMostPieces = 1e4;
  const double from = motion.times.back();
  const Pose start = motion.poses.back();
  const double pieces =
      std::max(1.0, std::ceil(body.angular_velocity.norm() * (until - from) / kQuarterTurn));
  if (!(pieces <= kMostPieces)) {
    throw std::invalid_argument(
        "expected at most 2500 turns of a kinematic body that has poses, or an end");
  }
  const int count = static_cast<int>(pieces);
  for (int k = 1; k <= count; ++k) {
    const double time = k < count ? from + (until - from) * (k / pieces) : until;
    if (time > motion.times.back()) {
      motion.times.push_back(time);
      motion.poses.push_back(advanced(start, body, time - from));
    }
  }
}

}  // namespace

WeighedShape weigh(const Mesh& mesh) {
  const Shape shape(mesh);
  if (const auto solid = solid_mass(shape)) {
    return {shape, true, solid->volume, solid->p_BC, solid->about_C};
  }
  const ThinMass thin = thin_mass(mesh);
  return {shape, false, thin.mass, thin.p_BC, thin.about_C};
}

FreeBody free_body(const RigidIpcBody& body, const WeighedShape& shape) {
  FreeBody free;
  free.locked_translation = body.locked_translation;
  free.locked_rotation = body.locked_rotation;
  const double mass = body.density * shape.mass;
  if (!(mass >= kLeastMass && mass <= kGreatestMass)) {
    throw std::invalid_argument("expected a mass in 1e-100 ... 1e100 kg");
  }
  if (shape.is_solid) {
    free.density = body.density;
  } else {
    const Vector3d moments =
        Eigen::SelfAdjointEigenSolver<Matrix3d>(shape.about_C, Eigen::EigenvaluesOnly)
            .eigenvalues();
    constexpr double kRounding = 1e-12;  // [-]
    if (!(moments[0] > kRounding * moments[2])) {
      throw std::invalid_argument("expected a mesh that does not lie on a line");
    }
    free.mass = mass;
    free.centre_of_mass = shape.p_BC;
    free.inertia = body.density * shape.about_C;
  }
  for (int k = 0; k < 3; ++k) {
    free.linear_velocity[k] = body.locked_translation[k] ? 0.0 : body.linear_velocity[k];
    free.angular_velocity[k] = body.locked_rotation[k] ? 0.0 : body.angular_velocity[k];
  }
  if (!body.force.isZero(0.0) || !body.torque.isZero(0.0)) {
    free.forces.push_back({.from = 0.0,
                           .to = std::numeric_limits<double>::infinity(),
                           .force = body.force,
                           .torque = body.torque});
  }
  return free;
}

BodyMotion scripted_motion(const RigidIpcBody& body, const WeighedShape& shape, double step,
                           double duration) {
  const Pose start{.position = body.X_WB.position + body.X_WB.rotation * shape.p_BC,
                   .rotation = body.X_WB.rotation};
  const double until = std::min(body.moves_until, duration);
  if (body.poses.empty() && until >= duration) {
    return ConstantVelocityMotion{start, duration * body.linear_velocity,
                                  duration * body.angular_velocity};
  }
  WaypointMotion motion{.times = {0.0}, .poses = {start}};
  for (const Pose& pose : body.poses) {
    const double time = step * static_cast<double>(motion.times.size());
    if (time > until) {
      break;
    }
    motion.times.push_back(time);
    motion.poses.push_back(with_mesh_axes(pose, body, shape));
  }
  if (motion.times.size() > body.poses.size() && until > motion.times.back()) {
    go_on(body, until, motion);
  }
  return motion;
}

}  // namespace firstcontact::detail
