#include <firstcontact/mechanism/mechanism.h>

#include <algorithm>
#include <cmath>
#include <utility>
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

/// The most by which a coordinate moves in a sub-step of free motion.
constexpr double kSubStep = 0.0125;  // [rad or m]
constexpr int kMostSubSteps = 4096;
/// The most by which it moves where accelerations change within the sub-step.
constexpr double kMostWay = 8.0 * kSubStep;  // [rad or m]
/// [-]  The most by which dampers slow a velocity in a sub-step: damping / mass times the sub-step.
constexpr double kMostDecay = 0.03;
/// [-]  The most by which both accelerations halfway, times the sub-step, differ, as a fraction of
/// the velocity, in the norm of the energy.
constexpr double kMostApart = 1e-3;
/// [rad/s or m/s]  A difference that is mere rounding.
constexpr double kRoundedApart = 1e-12;
/// The most sub-steps that are halved in a motion. In a jam, where nothing yields, no number of
/// them follows the motion.
constexpr int kMostHalved = 256;

/// Accelerations and the forces on driven coordinates.
struct Response {
  VectorXd accelerations;
  VectorXd forces;
  MatrixXd M = {};

  /// [J]  Twice the kinetic energy at these velocities.
  [[nodiscard]] double energy_of(const VectorXd& velocities) const {
    return velocities.dot(M * velocities);
  }
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

/// Computes the rates of a displacement. The turn of a pose is that of the displacement's rotation
/// vector d and a small one after it. So d' = w - d x w / 2 + d x (d x w) / 12, to fourth order.
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

/// Runge and Kutta's classical rule of fourth order for a mechanism under given forces.
class Mechanism::Flight {
 public:
  Flight(const Mechanism& mechanism, const Vector3d& gravity, const MechanismDrive& drive,
         MechanismMotion& motion)
      : mechanism_(mechanism), gravity_(gravity), drive_(drive), motion_(motion) {}

  /// Goes on by a time, in parts where the rule does not follow the motion. Light links that carry
  /// a heavy one turn by radians in a hundredth of the time that their speed suggests.
  void advance(double time) {
    const Step step = make_step(time);
    if (step.is_followed || halved_ == kMostHalved) {
      motion_.end = step.end;
      motion_.impulses += step.impulses;
      return;
    }
    ++halved_;
    advance(0.5 * time);
    advance(0.5 * time);
  }

 private:
  struct Step {
    MechanismState end;
    VectorXd impulses;
    bool is_followed;
  };

  [[nodiscard]] Response response(const MechanismState& state) const {
    const MechanismInstant instant = mechanism_.at(state);
    VectorXd forces = -mechanism_.bias_forces(instant, gravity_);
    if (drive_.forces.size() > 0) {
      forces += drive_.forces;
    }
    if (drive_.damping.size() > 0) {
      forces -= drive_.damping.cwiseProduct(state.velocities);
    }
    MatrixXd M = mechanism_.mass_matrix(instant);
    Response found = respond(M, forces, drive_.driven, drive_.accelerations);
    found.M = std::move(M);
    return found;
  }

  [[nodiscard]] Step make_step(double h) const {
    // Displacements d, their rates r, velocities v and accelerations a.
    const MechanismState& now = motion_.end;
    const VectorXd& v1 = now.velocities;
    const Response a1 = response(now);
    const VectorXd d2 = 0.5 * h * v1;
    const VectorXd v2 = v1 + 0.5 * h * a1.accelerations;
    const VectorXd r2 = mechanism_.rates(d2, v2);
    const Response a2 = response({mechanism_.moved(now.positions, d2), v2});
    const VectorXd d3 = 0.5 * h * r2;
    const VectorXd v3 = v1 + 0.5 * h * a2.accelerations;
    const VectorXd r3 = mechanism_.rates(d3, v3);
    const Response a3 = response({mechanism_.moved(now.positions, d3), v3});
    const VectorXd d4 = h * r3;
    const VectorXd v4 = v1 + h * a3.accelerations;
    const VectorXd r4 = mechanism_.rates(d4, v4);
    const Response a4 = response({mechanism_.moved(now.positions, d4), v4});
    Step step;
    step.end = {mechanism_.moved(now.positions, h / 6.0 * (v1 + 2.0 * r2 + 2.0 * r3 + r4)),
                v1 + h / 6.0 *
                         (a1.accelerations + 2.0 * a2.accelerations + 2.0 * a3.accelerations +
                          a4.accelerations)};
    if (!drive_.driven.empty()) {
      step.impulses = h / 6.0 * (a1.forces + 2.0 * a2.forces + 2.0 * a3.forces + a4.forces);
    }
    // Both accelerations halfway belong to one time: they agree where the rule follows the motion.
    const VectorXd apart = h * (a3.accelerations - a2.accelerations);
    const double whole = std::max(a1.energy_of(v1), a4.energy_of(v4));
    step.is_followed = d4.size() == 0 || (d4.lpNorm<Eigen::Infinity>() <= kMostWay &&
                                          (a3.energy_of(apart) <= kMostApart * kMostApart * whole ||
                                           apart.lpNorm<Eigen::Infinity>() <= kRoundedApart));
    return step;
  }

  const Mechanism& mechanism_;
  const Vector3d& gravity_;
  const MechanismDrive& drive_;
  MechanismMotion& motion_;
  int halved_ = 0;
};

/// [1/s]  A bound of the rates of decay by dampers: the sum of damping / mass.
double Mechanism::decay(const MechanismState& state, const VectorXd& damping) const {
  if (damping.size() == 0) {
    return 0.0;
  }
  const MatrixXd dampers = damping.asDiagonal();
  return solve_mass(mass_matrix(at(state)), dampers).trace();
}

MechanismMotion Mechanism::after_driven_motion(const MechanismState& state, const Vector3d& gravity,
                                               const MechanismDrive& drive, double dt) const {
  VectorXd fastest = state.velocities.cwiseAbs();
  for (std::size_t k = 0; k < drive.driven.size(); ++k) {
    const double end =
        state.velocities[drive.driven[k]] + dt * drive.accelerations[static_cast<Index>(k)];
    fastest[drive.driven[k]] = std::max(fastest[drive.driven[k]], std::abs(end));
  }
  const double way = dt * (fastest.size() > 0 ? fastest.maxCoeff() : 0.0);
  const double parts = std::max(way / kSubStep, dt * decay(state, drive.damping) / kMostDecay);
  const int count =
      static_cast<int>(std::clamp(std::ceil(parts), 1.0, static_cast<double>(kMostSubSteps)));
  MechanismMotion motion{state, VectorXd::Zero(static_cast<Index>(drive.driven.size()))};
  Flight flight(*this, gravity, drive, motion);
  for (int k = 0; k < count; ++k) {
    flight.advance(dt / count);
  }
  return motion;
}

VectorXd Mechanism::carried(const MechanismState& state, const VectorXd& positions) const {
  const MechanismInstant from = at(state);
  const MechanismInstant to = at({positions, VectorXd::Zero(size_)});
  VectorXd momenta = VectorXd::Zero(size_);
  double energy = 0.0;  // Twice the energy.
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
