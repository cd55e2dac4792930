#include <firstcontact/mechanism/mechanism.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <firstcontact/mechanism/detail/spatial.h>

namespace firstcontact {
namespace {

using detail::solve_mass;
using detail::Spatial;
using detail::spatial;
using detail::spatial_inertia;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// No coordinate turns farther in a sub-step of free motion.
constexpr double kSubStep = 0.05;  // [rad or m]
constexpr int kMostSubSteps = 4096;

/// Accelerations and the forces on driven coordinates.
struct Response {
  VectorXd accelerations;
  VectorXd forces;
};

/// Solves M a = forces, but for the driven coordinates, whose accelerations are given.
Response respond(const MatrixXd& M, const VectorXd& forces, const std::vector<Index>& driven,
                 const VectorXd& given) {
  if (driven.empty()) {
    return {solve_mass(M, forces), VectorXd()};
  }
  std::vector<Index> others;
  for (Index k = 0; k < M.rows(); ++k) {
    if (std::ranges::find(driven, k) == driven.end()) {
      others.push_back(k);
    }
  }
  Response response{VectorXd::Zero(M.rows()), VectorXd()};
  response.accelerations(driven) = given;
  if (!others.empty()) {
    const VectorXd left = forces(others) - M(others, driven) * given;
    response.accelerations(others) = solve_mass(MatrixXd(M(others, others)), left);
  }
  response.forces = (M * response.accelerations - forces)(driven);
  return response;
}

}  // namespace

/// How fast a displacement grows. The turn of a pose is the one that the displacement's rotation
/// vector d makes and then some more: d' = w - d x w / 2 + d x (d x w) / 12, to fourth order.
VectorXd Mechanism::rates(const VectorXd& displacement, const VectorXd& velocities) const {
  VectorXd result = velocities;
  for (const MechanismJoint& block : blocks_) {
    if (block.quaternion()) {
      const Index turns = block.velocity + block.velocities - 3;
      const Vector3d d = displacement.segment<3>(turns);
      const Vector3d w = velocities.segment<3>(turns);
      const Vector3d across = d.cross(w);
      result.segment<3>(turns) += d.cross(across) / 12.0 - 0.5 * across;
    }
  }
  return result;
}

MechanismState Mechanism::after_free_motion(const MechanismState& state, const Vector3d& gravity,
                                            double dt) const {
  return after_driven_motion(state, gravity, {}, dt).end;
}

MechanismMotion Mechanism::after_driven_motion(const MechanismState& state, const Vector3d& gravity,
                                               const MechanismDrive& drive, double dt) const {
  const auto response = [&](const MechanismState& s) {
    const MechanismInstant instant = at(s);
    VectorXd forces = -bias_forces(instant, gravity);
    if (drive.forces.size() > 0) {
      forces += drive.forces;
    }
    return respond(mass_matrix(instant), forces, drive.driven, drive.accelerations);
  };
  VectorXd fastest = state.velocities.cwiseAbs();
  for (std::size_t k = 0; k < drive.driven.size(); ++k) {
    const double end =
        state.velocities[drive.driven[k]] + dt * drive.accelerations[static_cast<Index>(k)];
    fastest[drive.driven[k]] = std::max(fastest[drive.driven[k]], std::abs(end));
  }
  const double way = dt * (fastest.size() > 0 ? fastest.maxCoeff() : 0.0);
  const int count = static_cast<int>(
      std::clamp(std::ceil(way / kSubStep), 1.0, static_cast<double>(kMostSubSteps)));
  const double h = dt / count;
  MechanismMotion motion{state, VectorXd::Zero(static_cast<Index>(drive.driven.size()))};
  MechanismState& now = motion.end;
  for (int k = 0; k < count; ++k) {
    // Displacements d, their rates r, velocities v and accelerations a.
    const VectorXd& v1 = now.velocities;
    const Response a1 = response(now);
    const VectorXd d2 = 0.5 * h * v1;
    const VectorXd v2 = v1 + 0.5 * h * a1.accelerations;
    const VectorXd r2 = rates(d2, v2);
    const Response a2 = response({moved(now.positions, d2), v2});
    const VectorXd d3 = 0.5 * h * r2;
    const VectorXd v3 = v1 + 0.5 * h * a2.accelerations;
    const VectorXd r3 = rates(d3, v3);
    const Response a3 = response({moved(now.positions, d3), v3});
    const VectorXd d4 = h * r3;
    const VectorXd v4 = v1 + h * a3.accelerations;
    const VectorXd r4 = rates(d4, v4);
    const Response a4 = response({moved(now.positions, d4), v4});
    now = {moved(now.positions, h / 6.0 * (v1 + 2.0 * r2 + 2.0 * r3 + r4)),
           v1 + h / 6.0 *
                    (a1.accelerations + 2.0 * a2.accelerations + 2.0 * a3.accelerations +
                     a4.accelerations)};
    if (!drive.driven.empty()) {
      motion.impulses += h / 6.0 * (a1.forces + 2.0 * a2.forces + 2.0 * a3.forces + a4.forces);
    }
  }
  return motion;
}

VectorXd Mechanism::carried(const MechanismState& state, const VectorXd& positions) const {
  const MechanismInstant from = at(state);
  const MechanismInstant to = at({positions, VectorXd::Zero(size_)});
  VectorXd momenta = VectorXd::Zero(size_);
  double energy = 0.0;  // Twice.
  for (std::size_t l = 0; l < from.X_WL.size(); ++l) {
    const auto& inertia = model_.links()[l].inertia;
    if (!inertia) {
      continue;
    }
    const auto centre = [&](const MechanismInstant& instant) -> Vector3d {
      return instant.X_WL[l].position + instant.X_WL[l].rotation * inertia->p_LC;
    };
    const Spatial& V = from.velocity[l];
    const Vector3d w = V.tail<3>();
    const Vector3d v_WC = V.head<3>() + w.cross(centre(from) - from.reference);
    const Matrix3d R = from.X_WL[l].rotation.toRotationMatrix();
    const Vector3d linear = inertia->mass * v_WC;
    const Vector3d angular = R * (inertia->about_C_L * (R.transpose() * w));
    energy += linear.dot(v_WC) + angular.dot(w);
    momenta +=
        to.J[l].transpose() * spatial(linear, angular + (centre(to) - to.reference).cross(linear));
  }
  const VectorXd velocities = solve_mass(mass_matrix(to), momenta);
  const double found = velocities.dot(momenta);
  return found > 0.0 ? VectorXd(std::sqrt(energy / found) * velocities) : velocities;
}

VectorXd Mechanism::with_momenta(const MechanismState& state, const Vector3d& linear,
                                 const Vector3d& angular) const {
  const MechanismInstant instant = at(state);
  Eigen::Matrix<double, 6, 6> inertia = Eigen::Matrix<double, 6, 6>::Zero();
  Spatial momentum = Spatial::Zero();
  for (std::size_t l = 0; l < instant.X_WL.size(); ++l) {
    if (const auto& of_link = model_.links()[l].inertia) {
      const auto I = spatial_inertia(*of_link, instant.X_WL[l], instant.reference);
      inertia += I;
      momentum += I * instant.velocity[l];
    }
  }
  const Spatial wanted = spatial(linear, angular - instant.reference.cross(linear));
  VectorXd velocities = state.velocities;
  velocities.head<6>() += inertia.llt().solve(wanted - momentum);
  return velocities;
}

MechanismMechanics Mechanism::mechanics(const MechanismState& state,
                                        const Vector3d& gravity) const {
  const MechanismInstant instant = at(state);
  MechanismMechanics sum;
  for (std::size_t l = 0; l < instant.X_WL.size(); ++l) {
    const auto& inertia = model_.links()[l].inertia;
    if (!inertia) {
      continue;
    }
    const Spatial& V = instant.velocity[l];
    const Spatial momentum = spatial_inertia(*inertia, instant.X_WL[l], instant.reference) * V;
    const Vector3d p_WC = instant.X_WL[l].position + instant.X_WL[l].rotation * inertia->p_LC;
    sum.mass += inertia->mass;
    sum.p_WC += inertia->mass * p_WC;
    sum.kinetic_energy += 0.5 * V.dot(momentum);
    sum.potential_energy -= inertia->mass * gravity.dot(p_WC);
    sum.linear_momentum += momentum.head<3>();
    sum.angular_momentum +=
        momentum.tail<3>() + instant.reference.cross(Vector3d(momentum.head<3>()));
  }
  if (sum.mass > 0.0) {
    sum.p_WC /= sum.mass;
  }
  return sum;
}

}  // namespace firstcontact
