#include <firstcontact/robot_check/link_contact.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/query/shape_pair.h>
#include <firstcontact/robot_check/detail/convex_meeting.h>
#include <firstcontact/robot_check/detail/link_query.h>
#include <firstcontact/robot_check/link_pair_motion.h>

namespace firstcontact {
namespace {

LinkBall ball_of(const MovingLink& link) {
  const Hierarchy& hierarchy = link.shape.hierarchy();
  return {link.X_FS, hierarchy.centre, hierarchy.radius * (1.0 + 0x1p-44)};
}

auto place_key(const LinkPose& pose) {
  const auto& p = pose.p_OL;
  const auto& R = pose.R_FL;
  return std::tuple(p.x(), p.y(), p.z(), R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1));
}

/// Whether A comes before B by content, so that a question and its swap do the same arithmetic.
bool in_order(const MovingLink& A, const MovingLink& B, const TimeWindow& window) {
  const int shapes = A.shape.compare(B.shape);
  if (shapes != 0) {
    return shapes < 0;
  }
  for (const double share : {0.0, 0.375, 1.0}) {
    const double t = std::min(window.begin + share * (window.end - window.begin), window.end);
    const auto a = place_key(A.X_FS.at(t).pose(t));
    const auto b = place_key(B.X_FS.at(t).pose(t));
    if (a != b) {
      return a < b;
    }
  }
  return true;
}

void require_body_where_it_deforms(const MovingLink& link) {
  const auto pieces = link.X_FS.pieces();
  const auto has_constant_rates = [](const LinkPath& piece) {
    return piece.constant_rates() != nullptr;
  };
  if (link.shape.hierarchy().deforms() &&
      !std::all_of(pieces.begin(), pieces.end(), has_constant_rates)) {
    throw std::invalid_argument("queries of links: a shape deforms; links are rigid");
  }
}

/// Calls ask(ShapePair) with the two in order; returns whether they were swapped.
template <class Ask>
bool ask_in_order(const MovingLink& A, const MovingLink& B, const TimeWindow& window,
                  LinkScratch& scratch, const Ask& ask) {
  require_body_where_it_deforms(A);
  require_body_where_it_deforms(B);
  const FloatEnvironmentGuard guard;
  const bool swapped = !in_order(A, B, window);
  const MovingLink& first = swapped ? B : A;
  const MovingLink& second = swapped ? A : B;
  LinkPairMotion motion(ball_of(first), ball_of(second), scratch, window.end);
  ask(ShapePair{first.shape, second.shape, motion});
  return swapped;
}

void ask_first_contact(const MovingLink& A, const MovingLink& B, const TimeWindow& window,
                       Workspace& workspace, LinkScratch& scratch,
                       const FirstContactOptions& options, FirstContactResult& result) {
  const bool swapped = ask_in_order(A, B, window, scratch, [&](const ShapePair& pair) {
    first_contact(pair, window, workspace, options, result);
  });
  if (swapped) {
    std::for_each(result.contacts.begin(), result.contacts.end(), swap_bodies);
  }
}

DistanceResult ask_distance(const MovingLink& A, const MovingLink& B, double t,
                            Workspace& workspace, LinkScratch& scratch) {
  DistanceResult result;
  const bool swapped = ask_in_order(
      A, B, {t, t}, scratch, [&](const ShapePair& pair) { result = distance(pair, t, workspace); });
  if (swapped && result.closest) {
    swap_bodies(*result.closest);
  }
  return result;
}

}  // namespace

void detail::first_contact(const MovingLink& A, const MovingLink& B, const TimeWindow& window,
                           LinkWorkspace& workspace, const FirstContactOptions& options,
                           FirstContactResult& result) {
  ask_first_contact(A, B, window, workspace.queries, workspace.places, options, result);
}

void detail::first_contact_early(const MovingLink& A, const MovingLink& B, const ShapeHull& hull_A,
                                 const ShapeHull& hull_B, const TimeWindow& window, double early,
                                 LinkWorkspace& workspace, const FirstContactOptions& options,
                                 FirstContactResult& result) {
  ask_in_order(A, B, window, workspace.places, [&](const ShapePair& pair) {
    const bool swapped = &pair.A != &A.shape;
    const HullApproach hulls = follow_hulls(
        swapped ? hull_B : hull_A, swapped ? hull_A : hull_B, pair.motion, window,
        options.margin + A.shape.radius() + B.shape.radius(), options.tolerance, early);
    result.reason = UndecidedReason::none;
    result.t = hulls.t;
    if (window.begin < window.end && hulls.t >= window.end) {
      result.verdict = Verdict::free;
      result.t = window.end;
      return;
    }
    if (hulls.t_contact) {
      result.verdict = Verdict::contact;
      result.t_upper = hulls.t_contact;
      return;
    }
    first_contact_early(pair, {hulls.t, window.end}, early, workspace.queries, options, result);
  });
}

bool detail::has_vertex_inside(const MovingLink& A, const MovingLink& B, const ShapeHull& hull_A,
                               const ShapeHull& hull_B, double t, LinkWorkspace& workspace) {
  const FloatEnvironmentGuard guard;
  LinkPairMotion motion(ball_of(A), ball_of(B), workspace.places, t);
  motion.enter(t);
  return has_vertex_inside(hull_A, hull_B, motion.state(t));
}

void detail::first_contact_held(const MovingLink& A, const MovingLink& B, const TimeWindow& window,
                                const Hold& hold, LinkWorkspace& workspace,
                                const FirstContactOptions& options, FirstContactResult& result) {
  const bool swapped = ask_in_order(A, B, window, workspace.places, [&](const ShapePair& pair) {
    detail::first_contact_held(pair, window, hold, workspace.queries, options, result);
  });
  if (swapped) {
    std::for_each(result.contacts.begin(), result.contacts.end(), swap_bodies);
  }
}

detail::StartGap detail::start_gap(const MovingLink& A, const MovingLink& B, double t,
                                   LinkWorkspace& workspace, const FirstContactOptions& options,
                                   WorkCount& work) {
  StartGap gap;
  ask_in_order(A, B, {t, t}, workspace.places, [&](const ShapePair& pair) {
    gap = detail::start_gap(pair, t, workspace.queries, options, work);
  });
  return gap;
}

DistanceResult detail::distance(const MovingLink& A, const MovingLink& B, double t,
                                LinkWorkspace& workspace) {
  return ask_distance(A, B, t, workspace.queries, workspace.places);
}

void first_contact(const MovingLink& A, const MovingLink& B, const TimeWindow& window,
                   Workspace& workspace, const FirstContactOptions& options,
                   FirstContactResult& result) {
  LinkScratch scratch;
  ask_first_contact(A, B, window, workspace, scratch, options, result);
}

void first_contact(const MovingLink& A, const MovingLink& B, Workspace& workspace,
                   const FirstContactOptions& options, FirstContactResult& result) {
  first_contact(A, B, {}, workspace, options, result);
}

FirstContactResult first_contact(const MovingLink& A, const MovingLink& B, Workspace& workspace,
                                 const FirstContactOptions& options) {
  FirstContactResult result;
  first_contact(A, B, workspace, options, result);
  return result;
}

DistanceResult distance(const MovingLink& A, const MovingLink& B, double t, Workspace& workspace) {
  LinkScratch scratch;
  return ask_distance(A, B, t, workspace, scratch);
}

ClosestApproachResult closest_approach(const MovingLink& A, const MovingLink& B,
                                       Workspace& workspace,
                                       const ClosestApproachOptions& options) {
  ClosestApproachResult result;
  LinkScratch scratch;
  const bool swapped = ask_in_order(A, B, {}, scratch, [&](const ShapePair& pair) {
    result = closest_approach(pair, workspace, options);
  });
  if (swapped && result.closest) {
    swap_bodies(*result.closest);
  }
  return result;
}

}  // namespace firstcontact
