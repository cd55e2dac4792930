#include <firstcontact/haptics/detail/pair_proof.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/haptics/detail/constants.h>
#include <firstcontact/haptics/detail/hull_proof.h>
#include <firstcontact/motion/time_window.h>
#include <firstcontact/query/detail/front_query.h>
#include <firstcontact/query/detail/pair_query.h>
#include <firstcontact/query/distance.h>

namespace firstcontact::detail {
namespace {

/// The margin and the tolerance of a pair's proof.
struct HeldApart {
  double margin = 0.0;     // [m]
  double tolerance = 0.0;  // [m]
};

/// Chooses the margin of a pair. A near pair is held to a fraction of its gap, so that it can slide
/// and part.
HeldApart held_apart(double gap, double contact_distance) {
  if (gap > kFreeGap * contact_distance) {
    return {contact_distance, kFoundWithin * contact_distance};
  }
  const double margin = std::max(
      kShareOfGap * gap, std::min(kLeastHeldGap * contact_distance, kShareOfJammedGap * gap));
  return {margin, 0.5 * (gap - margin)};
}

/// [-]  Greater than the rounding errors of balls, by their sizes.
constexpr double kRoundingOfBalls = 1e-12;

/// A ball that contains a member throughout its motion.
struct MemberBall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // [m]  World.
  double radius = 0.0;                               // [m]
};

MemberBall ball_of(const HapticMember& member, const Pose& X_WM) {
  const Eigen::Vector3d& centre = member.shape.bounds().centre;
  const double size = X_WM.position.norm() + centre.norm() + member.reach;
  return {X_WM.position + X_WM.rotation.normalized() * centre,
          member.reach + kRoundingOfBalls * size};
}

/// Finds the ball over a motion: the centre goes with the pivot, and turns about it at a constant
/// rate.
MemberBall ball_over(const HapticMember& member, const Motion& motion) {
  MemberBall ball = ball_of(member, motion.pose(0.0));
  if (motion.breaks().size() != 2) {
    return {ball.centre, std::numeric_limits<double>::infinity()};
  }
  const ConstantRatePath path = motion.path(0, member.shape.bounds().centre);
  const double way = path.pivot_velocity().value().norm() + path.rate() * path.lever_length();
  ball.radius += (1.0 + kRoundingOfBalls) * way;
  return ball;
}

bool are_far(const MemberBall& A, const MemberBall& B, double distance) {
  return (A.centre - B.centre).norm() - A.radius - B.radius > distance;
}

/// Finds the balls of members that are in pairs that may be far.
std::vector<MemberBall> balls_over(std::span<const HapticMember> members,
                                   std::span<const Motion> motions,
                                   std::span<const HapticPair> pairs) {
  std::vector<MemberBall> balls;
  if (std::ranges::any_of(pairs, &HapticPair::may_be_far)) {
    for (std::size_t m = 0; m < members.size(); ++m) {
      balls.push_back(ball_over(members[m], motions[m]));
    }
  }
  return balls;
}

/// Searches the first contact of the hulls of two convex members. Returns whether that settles it.
bool is_settled_by_hulls(const MovingShape& A, const MovingShape& B, FirstContactOptions options,
                         FirstContactResult& found) {
  options.budget.steps = kHullSteps;
  first_contact_of_hulls(A, B, options, found);
  return found.verdict == Verdict::free || found.verdict == Verdict::contact ||
         found.reason == UndecidedReason::deadline;
}

/// Searches the first contact by triangles in a part of the plan.
void search_part(const MovingShape& A, const MovingShape& B, HapticPair& pair,
                 const FirstContactOptions& options, Workspace& workspace,
                 FirstContactResult& found) {
  const TimeWindow window{0.0, pair.part};
  if (pair.front.is_empty()) {
    first_contact_within(A, B, window, workspace, options, found);
  } else {
    first_contact_by_front(pair.front, A, B, window, workspace, options, found);
  }
}

/// Searches the first contact by triangles. Where a search ends before it has proven anything, it
/// is made again for a shorter part of the plan, in which fewer triangles can come near, and with
/// more work. The next plan begins with both.
void search_triangles(const MovingShape& A, const MovingShape& B, HapticPair& pair,
                      FirstContactOptions options, Workspace& workspace,
                      FirstContactResult& found) {
  while (true) {
    options.budget.steps = pair.steps;
    search_part(A, B, pair, options, workspace, found);
    if (found.verdict != Verdict::undecided) {
      const std::uint64_t work = found.work.node_groups + found.work.steps;
      pair.part = std::min(1.0, pair.part / kShorterPart);
      pair.steps = 4 * work < pair.steps ? std::max(kProofSteps, pair.steps / 2) : pair.steps;
      return;
    }
    if (found.t > kShorterPart * pair.part || found.reason == UndecidedReason::precision) {
      return;
    }
    const bool is_last = found.reason != UndecidedReason::work || pair.steps == kMostProofSteps;
    pair.part = std::max(kShortestPart, kShorterPart * pair.part);
    pair.steps = std::min(kMostProofSteps, 2 * pair.steps);
    if (is_last) {
      return;
    }
  }
}

}  // namespace

bool are_far(const HapticMember& A, const Pose& X_WA, const HapticMember& B, const Pose& X_WB,
             double distance) {
  return are_far(ball_of(A, X_WA), ball_of(B, X_WB), distance);
}

ProvenPart prove_plan(std::span<const HapticMember> members, std::span<const Motion> motions,
                      std::span<HapticPair> pairs, double contact_distance,
                      const std::optional<std::chrono::steady_clock::time_point>& deadline,
                      Workspace& workspace, FirstContactResult& scratch) {
  ProvenPart proven{.clearance = std::numeric_limits<double>::infinity()};
  const std::vector<MemberBall> balls = balls_over(members, motions, pairs);
  for (HapticPair& pair : pairs) {
    const auto [other, tool] = pair.members;
    const HeldApart held = held_apart(pair.gap, contact_distance);
    proven.clearance = std::min(proven.clearance, held.margin);
    if (pair.may_be_far && are_far(balls[other], balls[tool], held.margin)) {
      continue;
    }
    FirstContactOptions options{
        .margin = held.margin, .tolerance = held.tolerance, .contacts = ContactState::none};
    options.budget.deadline = deadline;
    const MovingShape A{members[other].shape, motions[other]};
    const MovingShape B{members[tool].shape, motions[tool]};
    const bool fill_hulls =
        members[other].fills_hull && members[tool].fills_hull && may_have_front(A.shape, B.shape);
    if (!fill_hulls || !is_settled_by_hulls(A, B, options, scratch)) {
      search_triangles(A, B, pair, options, workspace, scratch);
    }
    if (scratch.t < proven.t) {
      proven.t = scratch.t;
      proven.is_unproven = scratch.t == 0.0 && scratch.verdict == Verdict::undecided;
    }
    proven.is_late = proven.is_late || (scratch.verdict == Verdict::undecided &&
                                        scratch.reason == UndecidedReason::deadline);
  }
  const auto comes_nearer = [&](const HapticPair& pair) {
    if (!(pair.gap < kFloorOfGap * contact_distance)) {
      return false;
    }
    const std::size_t other = pair.members[0];
    const std::size_t tool = pair.members[1];
    const auto distance_at = [&](double t) {
      return distance({members[other].shape, motions[other]}, {members[tool].shape, motions[tool]},
                      t, workspace)
          .distance;
    };
    // Rounding alone must not hold a tool that slides or rests.
    const double slack =
        kSlackOfFloor * pair.gap + kRoundingOfPieces * (members[other].reach + members[tool].reach);
    return distance_at(proven.t) < distance_at(0.0) - slack;
  };
  if (proven.t > 0.0 && std::ranges::any_of(pairs, comes_nearer)) {
    proven.t = 0.0;
    proven.is_unproven = true;
  }
  return proven;
}

}  // namespace firstcontact::detail
