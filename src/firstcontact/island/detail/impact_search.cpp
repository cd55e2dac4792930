#include <firstcontact/island/detail/impact_search.h>

#include <algorithm>
#include <limits>

#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/sim_body.h>

#include <firstcontact/island/detail/island_state.h>

#include <firstcontact/simulation_model/detail/contact_distances.h>

namespace firstcontact::detail {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

std::vector<Impact> ImpactSearch::find(const Plan& plan) {
  follow(plan);
  const double reach = state_.model.distances.least + state_.model.distances.tolerance;
  clearance_ = state_.model.distances.least;
  std::vector<Impact> hits;
  for (Candidate& pair : candidates_) {
    if (mover(pair, 0).is_changed || mover(pair, 1).is_changed) {
      pair.is_near =
          widened(mover(pair, 0).box, reach).exteriorDistance(mover(pair, 1).box) <= pair.margin;
      pair.hit = pair.is_near ? ask(pair) : std::nullopt;
    }
    if (pair.is_near) {
      const double gap =
          pair.manifold == nullptr ? std::numeric_limits<double>::infinity() : pair.manifold->gap;
      clearance_ =
          std::min(clearance_, held_distance(state_.model.distances, pair.margin, gap).margin);
    }
    if (pair.hit) {
      hits.push_back(*pair.hit);
    }
  }
  return hits;
}

/// Takes over the plan's motions, and finds the pairs that they may bring near each other.
void ImpactSearch::follow(const Plan& plan) {
  const bool is_first = movers_.empty();
  bool have_room = !is_first;
  for (std::size_t k = 0; k < state_.size(); ++k) {
    if (is_first) {
      movers_.push_back({.body = state_.members[k]});
    }
    Mover& mover = movers_[k];
    const Move& move = plan.moves[k];
    mover.is_changed = is_first || move.translation != mover.move.translation ||
                       move.rotation_vector != mover.move.rotation_vector;
    if (mover.is_changed) {
      mover.move = move;
      mover.box = swept_box(state_.member(k), state_.states[k].X_WB, move);
      mover.hull.reset();
      have_room = have_room && mover.room.contains(mover.box);
    }
  }
  if (!have_room) {
    look_around();
  } else {
    std::for_each(movers_.begin() + static_cast<std::ptrdiff_t>(state_.size()), movers_.end(),
                  [](Mover& mover) { mover.is_changed = false; });
  }
}

/// Finds all pairs that are near while their boxes stay in their rooms. All of them are to be
/// searched.
void ImpactSearch::look_around() {
  std::vector<AlignedBox3d> rooms;
  for (std::size_t k = 0; k < state_.size(); ++k) {
    Mover& mover = movers_[k];
    mover.is_changed = true;
    mover.room = widened(mover.box, kRoomOfReach * state_.member(k).reach +
                                        kRoomOfWay * mover.move.translation.norm());
    rooms.push_back(mover.room);
  }
  candidates_.clear();
  const double reach = state_.model.distances.least + state_.model.distances.tolerance;
  state_.for_each_pair(
      rooms, reach, span_ / state_.start.h, [&](const BodyPair& pair, double margin) {
        const auto found = state_.manifolds.find(pair);
        candidates_.push_back(
            {.movers = {mover_of(pair[0]), mover_of(pair[1])},
             .margin = margin,
             .manifold = found == state_.manifolds.end() ? nullptr : &found->second});
      });
}

/// Finds the mover of a body. Those of members come first.
std::size_t ImpactSearch::mover_of(std::size_t body) {
  if (state_.model.bodies[body].kind == BodyKind::free) {
    return state_.place.at(body);
  }
  const auto [found, is_new] = around_.try_emplace(body, movers_.size());
  if (is_new) {
    const Move move = state_.start.scripted[body].part(span_ / state_.start.h);
    movers_.push_back({.body = body,
                       .move = move,
                       .box = swept_box(state_.model.bodies[body], state_.pose_of(body), move)});
  }
  movers_[found->second].is_changed = true;
  return found->second;
}

/// Searches a pair. Returns its impact, if the two come into contact.
std::optional<Impact> ImpactSearch::ask(Candidate& pair) {
  const double gap =
      pair.manifold == nullptr ? std::numeric_limits<double>::infinity() : pair.manifold->gap;
  const HeldDistance held = held_distance(state_.model.distances, pair.margin, gap);
  if (cannot_reach(pair, std::min(gap, state_.model.distances.band) + pair.margin - held.margin)) {
    return std::nullopt;
  }
  const BodyPair bodies = bodies_of(pair);
  if (!(held.tolerance > 0.0)) {
    return Impact{.bodies = bodies};  // Rounding left no gap that could be halved: no time passes.
  }
  if (hulls_stay_apart(pair, held.margin)) {
    return std::nullopt;
  }
  FirstContactOptions options;
  options.margin = held.margin;
  options.tolerance = held.tolerance;
  const auto motion = [&](int side) {
    return motion_of(state_.model.bodies[bodies[side]], state_.pose_of(bodies[side]),
                     mover(pair, side).move);
  };
  const Motion A = motion(0);
  const Motion B = motion(1);
  first_contact({state_.model.bodies[bodies[0]].shape, A},
                {state_.model.bodies[bodies[1]].shape, B}, workspace_, options, answer_);
  if (answer_.verdict == Verdict::free) {
    return std::nullopt;
  }
  return hit_of(pair, {A.pose(answer_.t), B.pose(answer_.t)});
}

SweptHull ImpactSearch::hull_of(std::size_t k, double from, double to) {
  const Mover& mover = movers_[k];
  return {state_.model.bodies[mover.body], state_.pose_of(mover.body), mover.move, from, to};
}

const SweptHull& ImpactSearch::whole_hull_of(std::size_t k) {
  std::optional<SweptHull>& hull = movers_[k].hull;
  if (!hull) {
    hull = hull_of(k, 0.0, 1.0);
  }
  return *hull;
}

/// Chooses a plane: that of the plan before, or of the touch. The plane of a touching face goes
/// with the face's body; for edges, a plane of either body often serves.
ImpactSearch::Plane ImpactSearch::likely_plane(const Candidate& pair) const {
  if (pair.plane) {
    return *pair.plane;
  }
  if (pair.manifold != nullptr && !pair.manifold->touches.empty()) {
    const ManifoldPoint& touch = pair.manifold->touches[0];
    return {touch.normal, touch.feature_B.type == FeatureType::face};
  }
  const auto centre = [&](int side) {
    const Eigen::AlignedBox3d& box = mover(pair, side).box;
    return Vector3d(0.5 * (box.min() + box.max()));
  };
  return {(centre(1) - centre(0)).normalized(), false};
}

/// Finds a plane that proves the hulls apart; it goes with either body.
std::optional<ImpactSearch::Plane> ImpactSearch::plane_of(const SweptHull& A, const SweptHull& B,
                                                          double distance, const Plane& likely) {
  for (const bool is_of_second : {likely.is_of_second, !likely.is_of_second}) {
    const std::optional<Vector3d> n = is_of_second ? plane_between(B, A, distance, -likely.n)
                                                   : plane_between(A, B, distance, likely.n);
    if (n) {
      return Plane{is_of_second ? Vector3d(-*n) : *n, is_of_second};
    }
  }
  return std::nullopt;
}

bool ImpactSearch::hulls_stay_apart(Candidate& pair, double distance) {
  const Plane likely = likely_plane(pair);
  pair.plane =
      plane_of(whole_hull_of(pair.movers[0]), whole_hull_of(pair.movers[1]), distance, likely);
  return pair.plane || parts_stay_apart(pair, distance, {0.0, 0.5, 1.0}, kSplitsOfPlan, likely);
}

/// Whether hulls over parts of the time stay apart. Motion that bends away from a plane does so by
/// a quarter in halves of a time.
///
/// @param times   [-]  begin, middle and end of the part of the plan
/// @param splits  how often it is halved
bool ImpactSearch::parts_stay_apart(const Candidate& pair, double distance,
                                    const std::array<double, 3>& times, int splits,
                                    const Plane& likely) {
  for (std::size_t half = 0; half < 2; ++half) {
    const double from = times[half];
    const double to = times[half + 1];
    const bool stay_apart =
        plane_of(hull_of(pair.movers[0], from, to), hull_of(pair.movers[1], from, to), distance,
                 likely) ||
        (splits > 1 &&
         parts_stay_apart(pair, distance, {from, 0.5 * (from + to), to}, splits - 1, likely));
    if (!stay_apart) {
      return false;
    }
  }
  return true;
}

/// Whether the two bodies move too little to close a distance. So resting bodies are not searched.
bool ImpactSearch::cannot_reach(const Candidate& pair, double distance) {
  double way = 0.0;
  double size = 0.0;
  for (int side = 0; side < 2; ++side) {
    const auto& [body, move, box, room, is_changed, hull] = mover(pair, side);
    const double reach = state_.model.bodies[body].reach;
    way += move.translation.norm() + reach * move.rotation_vector.norm();
    size += state_.pose_of(body).position.norm() + reach;
  }
  constexpr double kRounding = 0x1p-44;  // Relative to distances and displacements.
  return way + kRounding * size < distance;
}

/// The manifold points of the contact that was just found.
///
/// A first contact of convex sets has one point, where the line of a cylinder has two.
std::vector<ManifoldPoint> ImpactSearch::touches_at(const Candidate& pair,
                                                    const std::array<Pose, 2>& poses) {
  const BodyPair bodies = bodies_of(pair);
  if (!are_curved(state_.model, bodies)) {
    return touches_among(state_.model, bodies, poses, pair.margin, answer_.contacts);
  }
  const auto surface = [&](std::size_t side) {
    return PlacedShape(state_.model.bodies[bodies[side]].surface, poses[side]);
  };
  Manifold manifold =
      ManifoldFinder(state_.model, workspace_).find(bodies, surface(0), surface(1), pair.margin);
  const double most = least_gap(manifold) + state_.model.distances.tolerance;
  std::erase_if(manifold.touches, [&](const ManifoldPoint& touch) { return touch.gap > most; });
  return manifold.touches;
}

/// Makes the impact of the contact that was just found, as a constraint on the span.
Impact ImpactSearch::hit_of(const Candidate& pair, const std::array<Pose, 2>& poses) {
  Impact hit{.bodies = bodies_of(pair), .t = answer_.t};
  ProblemBodies bodies;
  for (int side = 0; side < 2; ++side) {
    const auto& [body, move, box, room, is_changed, hull] = mover(pair, side);
    bodies.add(body, {{}, move.translation / span_, move.rotation_vector / span_},
               centre_of_mass(state_.model.bodies[body].inertia, poses[side]));
  }
  double closing = 0.0;
  bool passes = true;  // Over a seam, at any distance from it.
  seam_time_ = hit.t;
  if (!seams_) {
    seams_.emplace(state_, workspace_,
                   [this](std::size_t body) { return pose_at(body, seam_time_); });
  }
  for (ManifoldPoint& touch : touches_at(pair, poses)) {
    const bool is_seam = seams_->level(touch);
    PredictedContact ahead{.touch = touch, .contact = contact_at(touch, bodies, 0.0, 0.0)};
    const double u_n = normal_velocity(ahead.contact, bodies.bodies());
    // The gap at the start of a straight motion to there.
    const double gap = touch.gap - hit.t * span_ * u_n;
    ahead.least = std::min(0.0, -state_.model.distances.way_to_rest(gap, gap) / span_);
    closing = std::max(closing, -u_n);
    passes = passes && is_seam && u_n >= ahead.least;
    hit.ahead.push_back(std::move(ahead));
  }
  hit.is_slight = !hit.ahead.empty() && !passes && !state_.bounces(hit.bodies, closing) &&
                  closing * span_ <= kSlightApproach * smaller_free_reach(hit.bodies);
  return hit;
}

/// Computes the pose of a body in the plan.
Pose ImpactSearch::pose_at(std::size_t body, double t) {
  const Move move = state_.model.bodies[body].kind == BodyKind::free
                        ? movers_[state_.place.at(body)].move
                        : state_.start.scripted[body].part(span_ / state_.start.h);
  return motion_of(state_.model.bodies[body], state_.pose_of(body), move).pose(t);
}

double ImpactSearch::smaller_free_reach(const BodyPair& pair) const {
  double smaller = std::numeric_limits<double>::infinity();
  for (const std::size_t b : pair) {
    if (state_.model.bodies[b].kind == BodyKind::free) {
      smaller = std::min(smaller, state_.model.bodies[b].reach);
    }
  }
  return smaller;
}

}  // namespace firstcontact::detail
