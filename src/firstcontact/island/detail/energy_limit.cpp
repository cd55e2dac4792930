#include <firstcontact/island/detail/energy_limit.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include <firstcontact/island/detail/island_response.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/isolated_island.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/response.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [J]  The energy of a member, by the inertia in the problem: that of now or, where it spins, that
/// of the end of the plan.
double energy_of(const IslandState& state, std::size_t k, const InverseInertia& inverse,
                 const ContactBody& moving) {
  const Inertia& inertia = state.member(k).inertia;
  if (is_locked(inertia)) {
    return kinetic_energy(inertia, {state.states[k].X_WB, moving.v, moving.w});
  }
  return 0.5 * inertia.mass * moving.v.squaredNorm() +
         0.5 * moving.w.dot(inverse.rotation.inverse() * moving.w);
}

/// [m/s]  Bounds the speed that links of a robot have where its motors without bound reach their
/// targets, and its other joints take part as little as possible.
double speed_at_targets(const IslandState& state, const ContactProblem& problem, std::size_t r) {
  std::vector<Eigen::Index> driven;
  std::vector<double> targets;
  for (const JointDrive& drive : problem.drives) {
    if (drive.mechanism == r && is_unbounded(drive)) {
      driven.push_back(static_cast<Eigen::Index>(drive.coordinate));
      targets.push_back(drive.target);
    }
  }
  const Eigen::MatrixXd columns = problem.mechanisms[r].inverse_mass(Eigen::all, driven);
  const Eigen::Map<const Eigen::VectorXd> wanted(targets.data(),
                                                 static_cast<Eigen::Index>(targets.size()));
  const Eigen::VectorXd V =
      columns * Eigen::MatrixXd(columns(driven, Eigen::all)).ldlt().solve(wanted);
  double speed = 0.0;
  for (std::size_t k = 0; k < state.size() && !driven.empty(); ++k) {
    const std::optional<MechanismLink>& link = problem.bodies[k].link;
    if (link && link->mechanism == r) {
      const Eigen::Matrix<double, 6, 1> of_link = link->J * V;
      speed = std::max(speed,
                       of_link.head<3>().norm() + state.member(k).reach * of_link.tail<3>().norm());
    }
  }
  return std::isfinite(speed) ? speed : 0.0;
}

/// [J]  The energy that bounded motors and springs give to a solution at most.
double work_of_bounded(const ContactProblem& problem, const ContactSolution& solution) {
  double work = 0.0;
  for (std::size_t k = 0; k < problem.drives.size(); ++k) {
    const JointDrive& drive = problem.drives[k];
    if (!is_unbounded(drive)) {
      const auto c = static_cast<Eigen::Index>(drive.coordinate);
      work += std::max(0.0, solution.drives[k] * solution.mechanisms[drive.mechanism][c]);
    }
  }
  return work;
}

/// [m/s]  The greatest speed of motors without bound that reach their targets.
double speed_of_motors(const IslandState& state, const ContactProblem& problem) {
  double speed = 0.0;
  for (std::size_t r = 0; r < problem.mechanisms.size(); ++r) {
    speed = std::max(speed, speed_at_targets(state, problem, r));
  }
  return speed;
}

/// [m/s]  The greatest speed of belts and of bodies around an island at its contacts.
double speed_of_scripts(const IslandState& state, const ContactProblem& problem) {
  double speed = 0.0;
  for (const ContactPoint& contact : problem.contacts) {
    speed = std::max(speed, contact.sticking_velocity.norm());
    for (int side = 0; side < 2; ++side) {
      const ContactBody& body = problem.bodies[contact.bodies[side]];
      if (contact.bodies[side] >= state.size()) {
        const Vector3d& arm = side == 0 ? contact.arm_A : contact.arm_B;
        speed = std::max(speed, (body.v + body.w.cross(arm)).norm());
      }
    }
  }
  return speed;
}

/// [sqrt(J)]  The root of the energy of all members at a speed [m/s].
double root_of_energy_at(const IslandState& state, double speed) {
  double mass = 0.0;
  for (std::size_t k = 0; k < state.size(); ++k) {
    mass += state.member(k).inertia.mass;
  }
  return speed * std::sqrt(0.5 * mass);
}

}  // namespace

bool is_unbounded(const JointDrive& drive) {
  return drive.compliance == 0.0 && std::isinf(drive.least) && std::isinf(drive.greatest);
}

double energy_of(const IslandState& state, const ContactProblem& problem,
                 const std::vector<ContactBody>& bodies,
                 const std::vector<Eigen::VectorXd>& mechanisms) {
  double sum = kinetic_energy(problem.mechanisms, mechanisms);
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (!state.member(k).link_body) {
      sum += energy_of(state, k, problem.bodies[k].inverse_inertia, bodies[k]);
    }
  }
  return sum;
}

bool squeezes_out(const IslandState& state, const ContactProblem& problem,
                  const ContactSolution& solution, std::optional<double> free) {
  if (problem.contacts.empty() || std::ranges::none_of(problem.drives, is_unbounded)) {
    return false;
  }
  const double before = free ? *free : free_energy(state, problem);
  const double speed = std::max(speed_of_motors(state, problem), speed_of_scripts(state, problem));
  const double after = energy_of(state, problem, solution.bodies, solution.mechanisms) -
                       work_of_bounded(problem, solution);
  const double most = kMostSqueeze * (std::sqrt(before) + root_of_energy_at(state, speed));
  return !(after <= most * most);
}

bool limit_energy(const IslandState& state, const ContactProblem& problem,
                  ContactSolution& solution, bool yields, std::optional<double> free) {
  const bool has_solution = is_solved(state, solution) && !yields;
  if (has_solution && (state.robots.has_motors() || !problem.ties.empty())) {
    return false;
  }
  const double before = free ? *free : free_energy(state, problem);
  const double after = energy_of(state, problem, solution.bodies, solution.mechanisms);
  double speed = speed_of_scripts(state, problem);
  if (yields) {
    speed = std::max(speed, speed_of_motors(state, problem));
  }
  const double along = root_of_energy_at(state, speed);
  const double work = yields ? work_of_bounded(problem, solution) : 0.0;
  const double allowed = has_solution ? std::sqrt(before) + 2.0 * along
                                      : std::sqrt(std::max(before, along * along) + work);
  if (std::sqrt(after) <= allowed * (1.0 + 1e-9)) {
    return false;
  }
  if (is_isolated(state, problem)) {
    shorten_within(state, problem, allowed * allowed, solution);
    return true;
  }
  const double share = allowed / std::sqrt(after);
  for (std::size_t k = 0; k < state.size(); ++k) {
    solution.bodies[k].v *= share;
    solution.bodies[k].w *= share;
  }
  for (Eigen::VectorXd& velocities : solution.mechanisms) {
    velocities *= share;
  }
  return true;
}

}  // namespace firstcontact::detail
