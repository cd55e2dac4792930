#include <firstcontact/robot_check/detail/geometry_search.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/narrowphase/convex_closest.h>
#include <firstcontact/narrowphase/convex_pair.h>
#include <firstcontact/narrowphase/triangle_distance.h>
#include <firstcontact/robot_check/detail/tracked_contact.h>
#include <firstcontact/robot_check/link_pair_motion.h>

namespace firstcontact::detail {
namespace {

const Shape& shape_of(const RobotTimeline& timeline, std::size_t geometry) {
  return *timeline.geometries()[geometry].shape;
}

/// [m]  The place of a vertex in the shape's frame.
Eigen::Vector3d vertex_at(const Shape& shape, std::uint32_t vertex, double t) {
  const Eigen::Vector3d& from = shape.mesh().vertices[vertex];
  const std::span<const Eigen::Vector3d> to = shape.vertices_to();
  return to.empty() ? from
                    : Eigen::Vector3d((1.0 - t) * from + t * (to[vertex] - shape.translation_to()));
}

/// [m]  The distance of a triangle from the core of a convex set at a pose, rounded.
double distance_of_set(const Shape& set, const LinkPose& X_FS, const Triangle& triangle) {
  const std::array<Eigen::Vector3d, 3> corners = {
      Eigen::Vector3d::Zero(), triangle[1] - triangle[0], triangle[2] - triangle[0]};
  const ConvexCore core{.kind = ConvexKind::hull,
                        .points = corners,
                        .reach = std::max(corners[1].norm(), corners[2].norm())};
  const ConvexCore of_set = set.convex_core();
  const PlacedConvex A{
      .core = of_set, .R = X_FS.R_FL, .centre = X_FS.p_OL + X_FS.R_FL * set.hierarchy().centre};
  const PlacedConvex B{.core = core, .centre = triangle[0]};
  ConvexGuess guess;
  guess.n = (B.centre - A.centre).stableNormalized();
  return closest_points(A, B, {}, guess).distance;
}

/// [m]  The threshold with a bound of tracking errors, rounded up.
double threshold_beyond(double threshold, double error) {
  return error > 0.0 ? std::nextafter(threshold + error, std::numeric_limits<double>::infinity())
                     : threshold;
}

LinkBall ball_of_link(const MovingLink& link) {
  const Hierarchy& hierarchy = link.shape.hierarchy();
  return {link.X_FS, hierarchy.centre, hierarchy.radius * (1.0 + 0x1p-44)};
}

/// Whether the hulls of two shapes are proven farther apart than a distance at t.
bool hulls_are_farther(const MovingLink& A, const MovingLink& B, const ShapeHull& hull_A,
                       const ShapeHull& hull_B, double t, double distance, LinkScratch& scratch) {
  const FloatEnvironmentGuard guard;
  LinkPairMotion motion(ball_of_link(A), ball_of_link(B), scratch, t);
  motion.enter(t);
  const double threshold =
      distance + A.shape.radius() + B.shape.radius() + hull_A.error + hull_B.error;
  ConvexGuess guess;
  return convex_first_contact({hull_A.core, hull_B.core, motion},
                              {.threshold = threshold, .t_begin = t, .t_end = t, .most_steps = 1},
                              guess)
             .verdict == ConvexVerdict::free;
}

}  // namespace

UndecidedReason spent(const WorkBudget& budget) {
  if (budget.stop.stop_requested()) {
    return UndecidedReason::cancelled;
  }
  const bool late = budget.deadline && std::chrono::steady_clock::now() >= *budget.deadline;
  return late ? UndecidedReason::deadline : UndecidedReason::none;
}

GeometrySearch::GeometrySearch(const RobotTimeline& timeline, const GeometryCandidate& candidate,
                               const RobotCheckOptions& options, LinkWorkspace& workspace)
    : timeline_(timeline),
      candidate_(candidate),
      options_(options),
      workspace_(workspace),
      paths_(timeline.paths(candidate.geometries[0], candidate.geometries[1],
                            0.5 * (candidate.window.begin + candidate.window.end))),
      X_FA_(std::vector<LinkPath>{paths_.A.X_FS}),
      X_FB_(std::vector<LinkPath>{paths_.B.X_FS}),
      A_(shape_of(timeline, candidate.geometries[0])),
      B_(shape_of(timeline, candidate.geometries[1])) {}

FirstContactResult GeometrySearch::ask(const TimeWindow& window, FirstContactOptions query) {
  query.budget = options_.budget;
  FirstContactResult result;
  detail::first_contact({A_, X_FA_}, {B_, X_FB_}, window, workspace_, query, result);
  return result;
}

FirstContactOptions GeometrySearch::options_of_candidate() const {
  return {.margin = candidate_.threshold,
          .tolerance = options_.tolerance,
          .contacts = options_.contacts,
          .contact_band = options_.contact_band,
          .budget = options_.budget};
}

double GeometrySearch::tracking_bound(const TimeWindow& window) {
  const auto& [a, b] = candidate_.geometries;
  return paths_.tracking_bound(timeline_.geometries()[a], timeline_.geometries()[b], window,
                               workspace_.places);
}

double GeometrySearch::threshold_at(double t) {
  return candidate_.has_tracking_errors
             ? threshold_beyond(candidate_.threshold, tracking_bound({t, t}))
             : candidate_.threshold;
}

template <class Ask>
FirstContactResult GeometrySearch::within_errors(const TimeWindow& window, const Ask& ask) {
  const auto ask_part = [&](const TimeWindow& part, double error, double tolerance,
                            std::uint64_t steps) {
    FirstContactOptions query = options_of_candidate();
    query.margin = threshold_beyond(candidate_.threshold, error);
    query.tolerance = tolerance;
    query.budget.steps = steps;
    FirstContactResult result;
    ask(part, query, result);
    return result;
  };
  return first_contact_within_errors(
      window, options_.tolerance, options_.budget.steps,
      {.error = [this](const TimeWindow& part) { return tracking_bound(part); },
       .first_contact = ask_part});
}

FirstContactResult GeometrySearch::first_contact(const TimeWindow& window) {
  if (candidate_.has_tracking_errors) {
    return within_errors(window, [this](const TimeWindow& part, const FirstContactOptions& query,
                                        FirstContactResult& result) {
      detail::first_contact({A_, X_FA_}, {B_, X_FB_}, part, workspace_, query, result);
    });
  }
  FirstContactResult result;
  if (candidate_.hold) {
    detail::first_contact_held({A_, X_FA_}, {B_, X_FB_}, window, *candidate_.hold, workspace_,
                               options_of_candidate(), result);
  } else {
    detail::first_contact({A_, X_FA_}, {B_, X_FB_}, window, workspace_, options_of_candidate(),
                          result);
  }
  return result;
}

void GeometrySearch::first_contact_of_hulls(const TimeWindow& window, double early,
                                            const FirstContactOptions& query,
                                            FirstContactResult& result) {
  const auto& [a, b] = candidate_.geometries;
  detail::first_contact_early(
      {A_, X_FA_}, {B_, X_FB_}, hull_of(A_, B_, timeline_.geometries()[a].corners),
      hull_of(B_, A_, timeline_.geometries()[b].corners), window, early, workspace_, query, result);
}

FirstContactResult GeometrySearch::first_contact_early(const TimeWindow& window, double early) {
  const auto& [a, b] = candidate_.geometries;
  if (timeline_.geometries()[a].corners.points.empty() ||
      timeline_.geometries()[b].corners.points.empty()) {
    return first_contact(window);
  }
  if (candidate_.has_tracking_errors) {
    return within_errors(window, [this](const TimeWindow& part, const FirstContactOptions& query,
                                        FirstContactResult& result) {
      if (part.begin < part.end) {
        first_contact_of_hulls(part, 0.0, query, result);
      } else {
        detail::first_contact({A_, X_FA_}, {B_, X_FB_}, part, workspace_, query, result);
      }
    });
  }
  FirstContactResult result;
  first_contact_of_hulls(window, early, options_of_candidate(), result);
  return result;
}

StartGap GeometrySearch::start_gap(WorkCount& work) {
  return detail::start_gap({A_, X_FA_}, {B_, X_FB_}, candidate_.window.begin, workspace_,
                           options_of_candidate(), work);
}

FirstContactResult GeometrySearch::features_within(double t, double distance) {
  const double tolerance = std::min(options_.tolerance, 0.5 * distance);
  return ask(
      {t, t},
      {.margin = distance - tolerance, .tolerance = tolerance, .contacts = options_.contacts});
}

FirstContactResult GeometrySearch::first_contact(const TimeWindow& window, double margin,
                                                 double tolerance) {
  const auto& [a, b] = candidate_.geometries;
  if (window.begin < window.end && !timeline_.geometries()[a].corners.points.empty() &&
      !timeline_.geometries()[b].corners.points.empty()) {
    FirstContactResult result;
    first_contact_of_hulls(window, 0.0,
                           {.margin = margin,
                            .tolerance = tolerance,
                            .contacts = ContactState::none,
                            .budget = options_.budget},
                           result);
    return result;
  }
  return ask(window, {.margin = margin, .tolerance = tolerance, .contacts = ContactState::none});
}

DistanceResult GeometrySearch::nearest(double t) {
  return detail::distance({A_, X_FA_}, {B_, X_FB_}, t, workspace_);
}

double GeometrySearch::distance_of_triangles(const Contact& contact, double t) {
  const bool A_is_set = is_asked_as_convex(A_, B_);
  const bool B_is_set = is_asked_as_convex(B_, A_);
  if (A_is_set && B_is_set) {
    return nearest(t).distance;
  }
  const auto placed = [t](const Shape& shape, const LinkMotion& X_FS, std::uint32_t triangle) {
    const LinkPose pose = X_FS.at(t).pose(t);
    Triangle corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = pose.p_OL + pose.R_FL * vertex_at(shape, shape.mesh().triangles[triangle][k], t);
    }
    return corners;
  };
  double distance = 0.0;
  if (A_is_set) {
    distance =
        distance_of_set(A_, X_FA_.at(t).pose(t), placed(B_, X_FB_, contact.feature_B.triangle));
  } else if (B_is_set) {
    distance =
        distance_of_set(B_, X_FB_.at(t).pose(t), placed(A_, X_FA_, contact.feature_A.triangle));
  } else {
    distance = triangle_distance(placed(A_, X_FA_, contact.feature_A.triangle),
                                 placed(B_, X_FB_, contact.feature_B.triangle))
                   .distance;
  }
  return std::max(0.0, distance - A_.radius() - B_.radius());
}

bool GeometrySearch::is_farther(double t, double distance) {
  if (!std::isfinite(distance)) {
    return false;
  }
  const auto& [a, b] = candidate_.geometries;
  const HullCorners& corners_A = timeline_.geometries()[a].corners;
  const HullCorners& corners_B = timeline_.geometries()[b].corners;
  if (!corners_A.points.empty() && !corners_B.points.empty() &&
      hulls_are_farther({A_, X_FA_}, {B_, X_FB_}, hull_of(A_, B_, corners_A),
                        hull_of(B_, A_, corners_B), t, distance, workspace_.places)) {
    return true;
  }
  return first_contact({t, t}, distance, 1e-9 + 1e-3 * distance).verdict == Verdict::free;
}

bool GeometrySearch::has_vertex_inside(double t) {
  const auto& [a, b] = candidate_.geometries;
  const HullCorners& corners_A = timeline_.geometries()[a].corners;
  const HullCorners& corners_B = timeline_.geometries()[b].corners;
  return !corners_A.points.empty() && !corners_B.points.empty() &&
         detail::has_vertex_inside({A_, X_FA_}, {B_, X_FB_}, hull_of(A_, B_, corners_A),
                                   hull_of(B_, A_, corners_B), t, workspace_);
}

bool GeometrySearch::is_inside(double t) {
  return (A_.is_solid() || B_.is_solid()) && distance(t) == 0.0;
}

Contact GeometrySearch::in_world(const Contact& contact, double t) const {
  return placed(contact, frame_at(t));
}

std::vector<Contact> GeometrySearch::in_world(const std::vector<Contact>& contacts,
                                              double t) const {
  const LinkPose X_WF = frame_at(t);
  std::vector<Contact> all;
  all.reserve(contacts.size());
  for (const Contact& contact : contacts) {
    all.push_back(placed(contact, X_WF));
  }
  return all;
}

LinkPose GeometrySearch::frame_at(double t) const {
  if (!paths_.frame) {
    return {};
  }
  const RobotMotion& motion = timeline_.scene().robot_motion(paths_.frame->robot);
  return motion.path(paths_.frame->link, t).pose(t);
}

Contact GeometrySearch::placed(const Contact& contact, const LinkPose& X_WF) const {
  const auto geometries = timeline_.geometries();
  const auto& [a, b] = candidate_.geometries;
  Contact placed = contact;
  placed.geometries = {geometries[a].index, geometries[b].index};
  placed.p_WA = X_WF.p_OL + X_WF.R_FL * contact.p_WA;
  placed.p_WB = X_WF.p_OL + X_WF.R_FL * contact.p_WB;
  if (contact.n_AB_W) {
    placed.n_AB_W = X_WF.R_FL * *contact.n_AB_W;
  }
  return placed;
}

}  // namespace firstcontact::detail
