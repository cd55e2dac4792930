#include <firstcontact/island/detail/loose_momenta.h>

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

/// Whether all forces on the island come from within it.
bool is_loose(const IslandState& state, const std::vector<ManifoldPoint>& touches) {
  const auto is_member = [&](std::size_t body) { return state.place.contains(body); };
  const auto is_free = [&](std::size_t body) {
    return state.model.bodies[body].link_body || moves_freely(state.model.bodies[body]);
  };
  const auto is_inner = [&](const ManifoldPoint& touch) {
    return touch.impulse.isZero(0.0) || std::ranges::all_of(touch.bodies, is_member);
  };
  const auto ties_members = [&](std::size_t t) {
    return std::ranges::all_of(state.model.ties[t].ends,
                               [&](const TieEnd& end) { return end.body && is_member(*end.body); });
  };
  for (std::size_t r = 0; r < state.robots.size(); ++r) {
    if (!state.robots.free_base(r)) {
      return false;
    }
  }
  return std::ranges::all_of(state.members, is_free) && std::ranges::all_of(touches, is_inner) &&
         std::ranges::all_of(state.ties, ties_members);
}

/// A free body, a robot, or several of them as one.
struct Part {
  void add(const Part& part) {
    mass += part.mass;
    centre += part.mass / mass * (part.centre - centre);
    velocity += part.mass / mass * (part.velocity - velocity);
  }

  double mass = 0.0;                     // [kg]
  Vector3d centre = Vector3d::Zero();    // [m]
  Vector3d velocity = Vector3d::Zero();  // [m/s]  Velocity of the centre.
  Vector3d spin = Vector3d::Zero();      // [kg m^2/s]  Angular momentum about the centre,
  Matrix3d inertia = Matrix3d::Zero();   // [kg m^2]    and the inertia.
};

/// The parts of an island: its robots first, then its free bodies.
class Parts {
 public:
  explicit Parts(const IslandState& state) {
    for (std::size_t r = 0; r < state.robots.size(); ++r) {
      const MechanismMechanics robot = state.robots.mechanics(r);
      const Vector3d velocity = robot.linear_momentum / robot.mass;
      add({robot.mass, robot.p_WC, velocity,
           robot.angular_momentum - robot.p_WC.cross(robot.linear_momentum),
           state.robots.inertia(r)});
    }
    for (std::size_t k = 0; k < state.size(); ++k) {
      const bool is_link = state.member(k).link_body.has_value();
      of_member.push_back(is_link ? state.robots.robot_of(k) : all.size());
      if (is_link) {
        continue;
      }
      const Inertia& inertia = state.member(k).inertia;
      const RigidState& moving = state.states[k];
      const Matrix3d I = rotational_inertia(inertia, moving.X_WB);
      add({inertia.mass, centre_of_mass(inertia, moving.X_WB), moving.v_WC, I * moving.w_WB, I});
    }
  }

  [[nodiscard]] Momenta momenta(const Vector3d& about) const {
    Momenta sum{.about = about, .linear = whole.mass * whole.velocity};
    for (const Part& part : all) {
      sum.angular += part.spin + part.mass * (part.centre - about).cross(part.velocity);
    }
    return sum;
  }

  /// [m]  The centre of the tied group of each part.
  [[nodiscard]] std::vector<Vector3d> centres_of_groups(const IslandState& state) const {
    DisjointSets sets(all.size());
    for (const std::size_t t : state.ties) {
      const auto& ends = state.model.ties[t].ends;
      sets.join(static_cast<std::uint32_t>(of_member[state.place.at(*ends[0].body)]),
                static_cast<std::uint32_t>(of_member[state.place.at(*ends[1].body)]));
    }
    std::vector<Part> groups(all.size());
    for (std::uint32_t k = 0; k < all.size(); ++k) {
      groups[sets.root(k)].add(all[k]);
    }
    std::vector<Vector3d> centres;
    for (std::uint32_t k = 0; k < all.size(); ++k) {
      centres.push_back(groups[sets.root(k)].centre);
    }
    return centres;
  }

  std::vector<Part> all = {};
  std::vector<std::size_t> of_member = {};  // The part of each member.
  Part whole = {};

 private:
  void add(const Part& part) {
    all.push_back(part);
    whole.add(part);
  }
};

}  // namespace

std::optional<Momenta> momenta_ahead(const IslandState& state,
                                     const std::vector<ManifoldPoint>& touches, double span,
                                     double share) {
  if (state.size() < 2 || !is_loose(state, touches)) {
    return std::nullopt;
  }
  const Parts parts(state);
  if (parts.all.size() < 2) {
    return std::nullopt;
  }
  const double time = share * span;
  const Part& whole = parts.whole;
  const Vector3d weight = whole.mass * state.model.gravity;
  Momenta momenta = parts.momenta(whole.centre);
  momenta.linear += time * weight;
  momenta.angular += time * (0.5 * time * whole.velocity).cross(weight);
  for (std::size_t k = 0; k < state.size(); ++k) {
    const MeanForce mean = mean_force(state.member(k), state.start.time + state.reached, span);
    const RigidState moving = state.member(k).link_body ? state.robots.state(k) : state.states[k];
    const Vector3d halfway = centre_of_mass(state.member(k).inertia, moving.X_WB) +
                             0.5 * time * moving.v_WC - whole.centre;
    momenta.linear += time * mean.force;
    momenta.angular += time * (mean.torque + halfway.cross(mean.force));
  }
  return momenta;
}

void take_momenta(const Momenta& momenta, IslandState& state) {
  const Parts parts(state);
  const std::vector<Vector3d> centres = parts.centres_of_groups(state);
  Matrix3d inertia = Matrix3d::Zero();
  for (std::size_t k = 0; k < parts.all.size(); ++k) {
    const Matrix3d arm = cross_matrix(parts.all[k].centre - centres[k]);
    inertia += parts.all[k].inertia - parts.all[k].mass * arm * arm;
  }
  const Momenta now = parts.momenta(momenta.about);
  const Vector3d linear = momenta.linear - now.linear;
  const Vector3d v = linear / parts.whole.mass;
  const Vector3d w = inertia.ldlt().solve(momenta.angular - now.angular -
                                          (parts.whole.centre - momenta.about).cross(linear));
  if (!v.allFinite() || !w.allFinite()) {
    return;
  }
  for (std::size_t r = 0; r < state.robots.size(); ++r) {
    state.robots.move_faster(r, v, w, centres[r]);
  }
  for (std::size_t k = 0; k < state.size(); ++k) {
    RigidState& moving = state.states[k];
    if (state.member(k).link_body) {
      moving = {moving.X_WB, state.robots.body(k).v, state.robots.body(k).w};
    } else {
      const std::size_t part = parts.of_member[k];
      moving.v_WC += v + w.cross(parts.all[part].centre - centres[part]);
      moving.w_WB += w;
    }
  }
}

}  // namespace firstcontact::detail
