#include <firstcontact/island/detail/isolated_island.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include <firstcontact/island/detail/energy_limit.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/simulation_model/detail/sim_body.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// The sum of masses, moments and momenta, about the origin.
class Sum {
 public:
  /// @param inertia   (6, 6)  of (v, w) at a point, @param momentum  about the point
  void add(const Matrix6d& inertia, const Vector6d& momentum, const Vector3d& point) {
    Matrix6d to_point = Matrix6d::Identity();  // Velocities at the origin give those at the point.
    to_point.topRightCorner<3, 3>() << 0.0, point.z(), -point.y(), -point.z(), 0.0, point.x(),
        point.y(), -point.x(), 0.0;
    inertia_ += to_point.transpose() * inertia * to_point;
    momentum_ += to_point.transpose() * momentum;
  }

  /// The velocity of all of it as one rigid body with these momenta.
  [[nodiscard]] Vector6d velocity() const { return inertia_.ldlt().solve(momentum_); }

 private:
  Matrix6d inertia_ = Matrix6d::Zero();
  Vector6d momentum_ = Vector6d::Zero();
};

/// Makes the motion of an island as one rigid body with the momenta of a solution.
ContactSolution as_one_body(const IslandState& state, const ContactProblem& problem,
                            const ContactSolution& solution) {
  Sum sum;
  const auto centre = [&](std::size_t k) {
    return centre_of_mass(state.member(k).inertia, state.states[k].X_WB);
  };
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (!state.member(k).link_body) {
      const Inertia& of_body = state.member(k).inertia;
      Matrix6d inertia = of_body.mass * Matrix6d::Identity();
      inertia.bottomRightCorner<3, 3>() = rotational_inertia(of_body, state.states[k].X_WB);
      Vector6d velocity;
      velocity << solution.bodies[k].v, solution.bodies[k].w;
      sum.add(inertia, inertia * velocity, centre(k));
    }
  }
  for (std::size_t r = 0; r < problem.mechanisms.size(); ++r) {
    const Eigen::MatrixXd& inverse = problem.mechanisms[r].inverse_mass;
    const Eigen::MatrixXd M =
        inverse.llt().solve(Eigen::MatrixXd::Identity(inverse.rows(), inverse.cols()));
    sum.add(M.topLeftCorner<6, 6>(), M.topRows<6>() * solution.mechanisms[r],
            *state.robots.free_base(r));
  }
  const Vector6d V = sum.velocity();
  const Vector3d w = V.tail<3>();
  ContactSolution one = solution;
  for (std::size_t k = 0; k < state.size(); ++k) {
    one.bodies[k].v = V.head<3>() + w.cross(centre(k));
    one.bodies[k].w = w;
  }
  for (std::size_t r = 0; r < problem.mechanisms.size(); ++r) {
    one.mechanisms[r].setZero();
    one.mechanisms[r].head<6>() << V.head<3>() + w.cross(*state.robots.free_base(r)), w;
  }
  return one;
}

/// Takes a share of the velocities of a solution, on top of those of another one.
void shorten(const ContactSolution& to, double share, std::size_t members,
             ContactSolution& solution) {
  for (std::size_t k = 0; k < members; ++k) {
    solution.bodies[k].v = to.bodies[k].v + share * (solution.bodies[k].v - to.bodies[k].v);
    solution.bodies[k].w = to.bodies[k].w + share * (solution.bodies[k].w - to.bodies[k].w);
  }
  for (std::size_t r = 0; r < solution.mechanisms.size(); ++r) {
    solution.mechanisms[r] = to.mechanisms[r] + share * (solution.mechanisms[r] - to.mechanisms[r]);
  }
}

}  // namespace

bool is_isolated(const IslandState& state, const ContactProblem& problem) {
  const auto is_set = [](bool lock) { return lock; };
  for (std::size_t k = 0; k < state.size(); ++k) {
    const Inertia& inertia = state.member(k).inertia;
    if (std::ranges::any_of(inertia.locked_translation, is_set) ||
        std::ranges::any_of(inertia.locked_rotation, is_set)) {
      return false;
    }
  }
  for (std::size_t r = 0; r < state.robots.size(); ++r) {
    if (!state.robots.free_base(r)) {
      return false;
    }
  }
  const bool is_tied = std::ranges::any_of(problem.ties, [&](const TieRow& tie) {
    return tie.sides.size() < 2 || std::ranges::any_of(tie.sides, [&](const TieSide& side) {
             return side.body >= state.size();
           });
  });
  return !is_tied && std::ranges::all_of(problem.contacts, [&](const ContactPoint& contact) {
    return contact.bodies[0] < state.size() && contact.bodies[1] < state.size();
  });
}

void shorten_within(const IslandState& state, const ContactProblem& problem, double allowed,
                    ContactSolution& solution) {
  const ContactSolution one = as_one_body(state, problem, solution);
  const auto energy_at = [&](double share) {
    ContactSolution at = solution;
    shorten(one, share, state.size(), at);
    return energy_of(state, problem, at.bodies, at.mechanisms);
  };
  // a + b s + c s^2
  const double a = energy_at(0.0);
  const double whole = energy_at(1.0) - a;
  const double half = energy_at(0.5) - a;
  const double c = 2.0 * whole - 4.0 * half;
  const double b = whole - c;
  const double under = b * b + 4.0 * c * std::max(0.0, allowed - a);
  const double share = c > 0.0 ? (std::sqrt(std::max(0.0, under)) - b) / (2.0 * c) : 0.0;
  shorten(one, std::clamp(share, 0.0, 1.0), state.size(), solution);
}

}  // namespace firstcontact::detail
