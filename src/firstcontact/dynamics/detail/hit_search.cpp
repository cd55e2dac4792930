#include <firstcontact/dynamics/detail/hit_search.h>

#include <algorithm>
#include <limits>

namespace firstcontact::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// A contact ahead is slight if the bodies approach by less than this part of the smaller one's
/// radius over the span of the plan, and would not bounce.
constexpr double kSlightApproach = 0.4;

}  // namespace

/// Of a member, or of a body around the island, over the span.
Move HitSearch::move_of(std::size_t body, const Plan& plan) const {
  return state_.world.bodies[body].kind == BodyKind::free
             ? plan.moves[state_.place.at(body)]
             : state_.start.scripted[body].part(span_ / state_.start.h);
}

std::vector<Hit> HitSearch::find(const Plan& plan) {
  hulls_.clear();
  std::vector<AlignedBox3d> boxes;
  for (std::size_t k = 0; k < state_.size(); ++k) {
    boxes.push_back(swept_box(state_.member(k), state_.states[k].X_WB, plan.moves[k]));
  }
  std::vector<Hit> hits;
  const double reach = state_.world.distances.least + state_.world.distances.tolerance;
  clearance_ = state_.world.distances.least;
  const auto find_hit = [&](const BodyPair& pair, double margin) {
    if (!moves_as_before(pair[0], plan) || !moves_as_before(pair[1], plan)) {
      ask(pair, margin, {move_of(pair[0], plan), move_of(pair[1], plan)}, hits);
      return;
    }
    const HeldDistance held = held_distance(state_.world.distances, margin, gap_of(pair));
    clearance_ = std::min(clearance_, held.margin);
    if (const auto found = hits_.find(pair); found != hits_.end()) {
      hits.push_back(found->second);
    }
  };
  state_.for_each_pair(boxes, reach, span_ / state_.start.h, find_hit);
  moves_ = plan.moves;
  hits_.clear();
  for (const Hit& hit : hits) {
    hits_.emplace(hit.bodies, hit);
  }
  return hits;
}

/// What was found of two such bodies still holds.
bool HitSearch::moves_as_before(std::size_t body, const Plan& plan) const {
  if (moves_.empty() || state_.world.bodies[body].kind != BodyKind::free) {
    return !moves_.empty();
  }
  const std::size_t k = state_.place.at(body);
  return moves_[k].translation == plan.moves[k].translation &&
         moves_[k].rotation_vector == plan.moves[k].rotation_vector;
}

/// [m]  Beyond its margin, now; infinite beyond the band.
double HitSearch::gap_of(const BodyPair& pair) const {
  const auto found = state_.manifolds.find(pair);
  return found == state_.manifolds.end() ? std::numeric_limits<double>::infinity()
                                         : found->second.gap;
}

void HitSearch::ask(const BodyPair& pair, double margin, const std::array<Move, 2>& moves,
                    std::vector<Hit>& hits) {
  const double gap = gap_of(pair);
  const HeldDistance held = held_distance(state_.world.distances, margin, gap);
  clearance_ = std::min(clearance_, held.margin);
  if (cannot_reach(pair, std::min(gap, state_.world.distances.band) + margin - held.margin,
                   moves)) {
    return;
  }
  if (!(held.tolerance > 0.0)) {
    hits.push_back({.bodies = pair});  // Rounding left no gap that could be halved: no time passes.
    return;
  }
  if (hulls_stay_apart(pair, moves, held.margin)) {
    return;
  }
  FirstContactOptions options;
  options.margin = held.margin;
  options.tolerance = held.tolerance;
  const Motion A = motion_of(state_.world.bodies[pair[0]], state_.pose_of(pair[0]), moves[0]);
  const Motion B = motion_of(state_.world.bodies[pair[1]], state_.pose_of(pair[1]), moves[1]);
  first_contact({state_.world.bodies[pair[0]].shape, A}, {state_.world.bodies[pair[1]].shape, B},
                workspace_, options, answer_);
  if (answer_.verdict == Verdict::free) {
    return;
  }
  hits.push_back(hit_of(pair, margin, {A.pose(answer_.t), B.pose(answer_.t)}, moves));
}

const SweptHull& HitSearch::hull_of(std::size_t body, const Move& move) {
  return hulls_.try_emplace(body, state_.world.bodies[body], state_.pose_of(body), move)
      .first->second;
}

/// A face that touches goes with its body; of edges, often one of both will do.
bool HitSearch::hulls_stay_apart(const BodyPair& pair, const std::array<Move, 2>& moves,
                                 double distance) {
  const SweptHull& A = hull_of(pair[0], moves[0]);
  const SweptHull& B = hull_of(pair[1], moves[1]);
  Vector3d n = (B.p_WC - A.p_WC).normalized();
  bool sees_B = false;
  const auto found = state_.manifolds.find(pair);
  if (found != state_.manifolds.end() && !found->second.touches.empty()) {
    const Touch& touch = found->second.touches[0];
    n = touch.normal;
    sees_B = touch.feature_B.type == FeatureType::face;
  }
  const auto seen_from_A = [&] { return stays_apart(A, B, distance, n); };
  const auto seen_from_B = [&] { return stays_apart(B, A, distance, -n); };
  return sees_B ? seen_from_B() || seen_from_A() : seen_from_A() || seen_from_B();
}

/// Whether no point of two bodies gets far enough to close a distance: what rests is not
/// searched.
bool HitSearch::cannot_reach(const BodyPair& pair, double distance,
                             const std::array<Move, 2>& moves) {
  double way = 0.0;
  double size = 0.0;
  for (int side = 0; side < 2; ++side) {
    const double reach = state_.world.bodies[pair[side]].reach;
    way += moves[side].translation.norm() + reach * moves[side].rotation_vector.norm();
    size += state_.pose_of(pair[side]).position.norm() + reach;
  }
  constexpr double kRounding = 0x1p-44;  // Of the distance and of the way, with room.
  return way + kRounding * size < distance;
}

/// The contact that was just found, as a constraint on the span.
Hit HitSearch::hit_of(const BodyPair& pair, double margin, const std::array<Pose, 2>& poses,
                      const std::array<Move, 2>& moves) {
  Hit hit{.bodies = pair, .t = answer_.t};
  ProblemBodies bodies;
  for (int side = 0; side < 2; ++side) {
    const Move& move = moves[side];
    bodies.add(pair[side], {{}, move.translation / span_, move.rotation_vector / span_},
               centre_of_mass(state_.world.bodies[pair[side]].inertia, poses[side]));
  }
  double closing = 0.0;
  for (Touch& touch : touches_among(state_.world, pair, poses, margin, answer_.contacts)) {
    TouchAhead ahead{.touch = touch, .contact = contact_at(touch, bodies, 0.0, 0.0)};
    const double u_n = normal_velocity(ahead.contact, bodies.bodies());
    // From the gap of the start, were it straight to there.
    const double gap = touch.gap - hit.t * span_ * u_n;
    ahead.least = std::min(0.0, -state_.world.distances.way_to_rest(gap) / span_);
    closing = std::max(closing, -u_n);
    hit.ahead.push_back(std::move(ahead));
  }
  hit.is_slight = !hit.ahead.empty() && !state_.bounces(pair, closing) &&
                  closing * span_ <= kSlightApproach * smaller_free_reach(pair);
  return hit;
}

double HitSearch::smaller_free_reach(const BodyPair& pair) const {
  double smaller = std::numeric_limits<double>::infinity();
  for (const std::size_t b : pair) {
    if (state_.world.bodies[b].kind == BodyKind::free) {
      smaller = std::min(smaller, state_.world.bodies[b].reach);
    }
  }
  return smaller;
}

}  // namespace firstcontact::detail
