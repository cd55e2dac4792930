#include <firstcontact/island/detail/angular_momentum.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <Eigen/Cholesky>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/math/disjoint_sets.h>
#include <firstcontact/mechanism/detail/spatial.h>
#include <firstcontact/simulation_model/detail/manifold.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Whether all that acts on the island is within it.
bool is_loose(const IslandState& state, const std::vector<ManifoldPoint>& touches) {
  const auto is_member = [&](std::size_t body) { return state.place.contains(body); };
  const auto is_inner = [&](const ManifoldPoint& touch) {
    return touch.impulse.isZero(0.0) || std::ranges::all_of(touch.bodies, is_member);
  };
  const auto ties_members = [&](std::size_t t) {
    return std::ranges::all_of(state.model.ties[t].ends,
                               [&](const TieEnd& end) { return end.body && is_member(*end.body); });
  };
  return std::ranges::all_of(state.members,
                             [&](std::size_t b) { return moves_freely(state.model.bodies[b]); }) &&
         std::ranges::all_of(touches, is_inner) && std::ranges::all_of(state.ties, ties_members);
}

/// Bodies as one, or a body.
struct Group {
  void add(double of, const Vector3d& at, const Vector3d& v) {
    mass += of;
    centre += of / mass * (at - centre);
    velocity += of / mass * (v - velocity);
  }

  double mass = 0.0;                     // [kg]
  Vector3d centre = Vector3d::Zero();    // [m]
  Vector3d velocity = Vector3d::Zero();  // [m/s]  Of the centre.
};

Group group_of(const IslandState& state, std::size_t k) {
  const Inertia& inertia = state.member(k).inertia;
  return {inertia.mass, centre_of_mass(inertia, state.states[k].X_WB), state.states[k].v_WC};
}

Group whole(const IslandState& state) {
  Group sum;
  for (std::size_t k = 0; k < state.size(); ++k) {
    const Group body = group_of(state, k);
    sum.add(body.mass, body.centre, body.velocity);
  }
  return sum;
}

Vector3d angular_momentum(const IslandState& state) {
  const Group all = whole(state);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < state.size(); ++k) {
    const Group body = group_of(state, k);
    sum += body.mass * (body.centre - all.centre).cross(body.velocity - all.velocity) +
           rotational_inertia(state.member(k).inertia, state.states[k].X_WB) * state.states[k].w_WB;
  }
  return sum;
}

/// [m]  From the centre of what a member is tied to, to its own.
std::vector<Vector3d> arms_in_groups(const IslandState& state) {
  DisjointSets sets(state.size());
  for (const std::size_t t : state.ties) {
    const auto& ends = state.model.ties[t].ends;
    sets.join(static_cast<std::uint32_t>(state.place.at(*ends[0].body)),
              static_cast<std::uint32_t>(state.place.at(*ends[1].body)));
  }
  std::vector<Group> groups(state.size());
  for (std::uint32_t k = 0; k < state.size(); ++k) {
    const Group body = group_of(state, k);
    groups[sets.root(k)].add(body.mass, body.centre, body.velocity);
  }
  std::vector<Vector3d> arms;
  for (std::uint32_t k = 0; k < state.size(); ++k) {
    arms.emplace_back(group_of(state, k).centre - groups[sets.root(k)].centre);
  }
  return arms;
}

}  // namespace

std::optional<Vector3d> angular_momentum_ahead(const IslandState& state,
                                               const std::vector<ManifoldPoint>& touches,
                                               double span, double share) {
  if (state.size() < 2 || !is_loose(state, touches)) {
    return std::nullopt;
  }
  const Group all = whole(state);
  Vector3d momentum = angular_momentum(state);
  for (std::size_t k = 0; k < state.size(); ++k) {
    const MeanForce mean = mean_force(state.member(k), state.start.time + state.reached, span);
    const Group body = group_of(state, k);
    const Vector3d halfway =
        body.centre - all.centre + 0.5 * share * span * (body.velocity - all.velocity);
    momentum += share * span * (mean.torque + halfway.cross(mean.force));
  }
  return momentum;
}

void take_angular_momentum(const Vector3d& momentum, IslandState& state) {
  const std::vector<Vector3d> arms = arms_in_groups(state);
  Matrix3d inertia = Matrix3d::Zero();
  for (std::size_t k = 0; k < state.size(); ++k) {
    const Inertia& body = state.member(k).inertia;
    const Matrix3d arm = cross_matrix(arms[k]);
    inertia += rotational_inertia(body, state.states[k].X_WB) - body.mass * arm * arm;
  }
  const Vector3d faster = inertia.ldlt().solve(momentum - angular_momentum(state));
  for (std::size_t k = 0; k < state.size() && faster.allFinite(); ++k) {
    state.states[k].v_WC += faster.cross(arms[k]);
    state.states[k].w_WB += faster;
  }
}

}  // namespace firstcontact::detail
