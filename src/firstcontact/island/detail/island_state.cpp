#include <firstcontact/island/detail/island_state.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>

#include <firstcontact/island/detail/seams.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/moving_contact.h>
#include <firstcontact/simulation_model/detail/swept_hull.h>

namespace firstcontact::detail {
namespace {

/// A body for manifolds.
struct RestingBody {
  RestingBody(const SimBody& body, const Pose& X_WB)
      : hull(body, X_WB, Move()), surface(body.surface, X_WB) {}

  SweptHull hull;
  PlacedShape surface;
};

}  // namespace

IslandState::IslandState(const StepContext& step, std::vector<std::size_t> given_members,
                         const std::vector<std::size_t>& bare_robots)
    : model(step.model),
      start(step.start),
      around(step.around),
      members(std::move(given_members)),
      robots(step.model, step.start, members, bare_robots) {
  for (std::size_t k = 0; k < size(); ++k) {
    place[members[k]] = k;
    states.push_back(start.states[members[k]]);
    if (!model.ties.empty()) {
      std::ranges::copy(model.ties_of[members[k]], std::back_inserter(ties));
    }
  }
  std::ranges::sort(ties);
  ties.erase(std::unique(ties.begin(), ties.end()), ties.end());
}

const Pose& IslandState::pose_of(std::size_t body) {
  if (model.bodies[body].kind == BodyKind::free) {
    return states[place.at(body)].X_WB;
  }
  const auto [found, is_new] = poses_around.try_emplace(body);
  if (is_new) {
    found->second = scripted_pose(model, start, body, reached / start.h);
  }
  return found->second;
}

Pose IslandState::tied_pose(std::size_t body) {
  return model.bodies[body].link_body ? robots.state(place.at(body)).X_WB : pose_of(body);
}

ProblemBodies IslandState::problem_bodies() const {
  ProblemBodies bodies;
  for (std::size_t k = 0; k < size(); ++k) {
    const RigidState& state = states[k];
    bodies.add(members[k],
               member(k).link_body ? robots.body(k)
                                   : ContactBody{inverse_inertia(member(k).inertia, state.X_WB),
                                                 state.v_WC, state.w_WB},
               centre_of_mass(member(k).inertia, state.X_WB));
  }
  return bodies;
}

void IslandState::add_others(const BodyPair& pair, ProblemBodies& bodies) {
  for (const std::size_t b : pair) {
    if (!bodies.has(b)) {
      const Move& move = start.scripted[b];
      bodies.add(b, {{}, move.translation / start.h, move.rotation_vector / start.h},
                 centre_of_mass(model.bodies[b].inertia, pose_of(b)));
    }
  }
}

ContactPoint IslandState::contact(const ManifoldPoint& touch, const ProblemBodies& bodies,
                                  double least_normal_velocity) {
  ContactPoint made =
      contact_at(touch, bodies, model.laws.friction(touch.bodies), least_normal_velocity);
  made.sticking_velocity = belt_velocity(touch.bodies, made.frame);
  return made;
}

Eigen::Vector2d IslandState::belt_velocity(const BodyPair& pair, const Eigen::Matrix3d& frame) {
  Eigen::Vector2d sticking = Eigen::Vector2d::Zero();
  for (std::size_t s = 0; s < 2; ++s) {
    const Eigen::Vector3d& belt = model.laws.belt(pair[s]);
    if (belt.any()) {
      const Eigen::Vector3d running = pose_of(pair[s]).rotation.normalized() * belt;
      sticking += (s == 0 ? 1.0 : -1.0) * (frame * running).tail<2>();
    }
  }
  return sticking;
}

bool IslandState::bounces(const BodyPair& pair, double closing) const {
  return model.laws.restitution(pair) > 0.0 &&
         closing > kStepsWithoutBounce * model.gravity.norm() * start.h;
}

bool IslandState::is_nearer(double distance) const {
  return std::ranges::any_of(manifolds,
                             [&](const auto& entry) { return entry.second.gap < distance; });
}

std::size_t IslandState::touches() const {
  std::size_t count = 0;
  for (const auto& [pair, manifold] : manifolds) {
    count += manifold.touches.size();
  }
  return count;
}

std::array<ContactSide, 2> IslandState::turning_sides(const ManifoldPoint& touch) {
  std::array<ContactSide, 2> sides;
  for (std::size_t s = 0; s < 2; ++s) {
    const std::size_t body = touch.bodies[s];
    sides[s].round = touch.round[s];
    sides[s].R_WB = pose_of(body).rotation.normalized().toRotationMatrix();
    sides[s].w = model.bodies[body].kind == BodyKind::free
                     ? states[place.at(body)].w_WB
                     : Eigen::Vector3d(start.scripted[body].rotation_vector / start.h);
  }
  return sides;
}

bool IslandState::is_too_near() const { return is_nearer(model.distances.pushed); }

void IslandState::find_manifolds(const std::vector<ManifoldPoint>& before, Workspace& workspace) {
  manifolds.clear();
  std::vector<Eigen::AlignedBox3d> boxes;
  for (std::size_t k = 0; k < size(); ++k) {
    boxes.push_back(swept_box(member(k), states[k].X_WB, {}));
  }
  ManifoldFinder finder(model, workspace);
  std::unordered_map<std::size_t, RestingBody> resting;
  const auto at_rest = [&](std::size_t body) -> const RestingBody& {
    return resting.try_emplace(body, model.bodies[body], pose_of(body)).first->second;
  };
  for_each_pair(boxes, model.distances.near, 0.0, [&](const BodyPair& pair, double margin) {
    const RestingBody& A = at_rest(pair[0]);
    const RestingBody& B = at_rest(pair[1]);
    if (stays_apart(A.hull, B.hull, margin + near_of(model, pair),
                    (B.hull.p_WC - A.hull.p_WC).normalized())) {
      return;
    }
    Manifold manifold = finder.find(pair, A.surface, B.surface, margin);
    if (manifold.gap <= model.distances.band || !manifold.touches.empty()) {
      carry_impulses(before, smaller_reach(model, pair), manifold);
      manifolds.emplace_hint(manifolds.end(), pair, std::move(manifold));  // Most are last.
    }
  });
  SeamFinder seams(*this, workspace, [&](std::size_t body) { return pose_of(body); });
  for (auto& [pair, manifold] : manifolds) {
    for (ManifoldPoint& touch : manifold.touches) {
      seams.level(touch);
    }
  }
}

}  // namespace firstcontact::detail
