/// @file
/// The questions of a check about two geometries, in a piece of time.

#pragma once

#include <vector>

#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/detail/candidates.h>
#include <firstcontact/robot_check/detail/link_query.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>

namespace firstcontact::detail {

/// The limit that ends a check now; none if it may go on. Each search watches its steps itself.
[[nodiscard]] UndecidedReason spent(const WorkBudget& budget);

/// Two geometries in one window of time. Refers to all of its arguments.
class GeometrySearch {
 public:
  GeometrySearch(const RobotTimeline& timeline, const GeometryCandidate& candidate,
                 const RobotCheckOptions& options, LinkWorkspace& workspace);

  /// Finds the first contact in a window, with the candidate's threshold or hold.
  ///
  /// Before the window the two are proven free and not inside of each other. When free, `t` is its
  /// end. The tolerance is that of the options. With tracking errors the threshold is that of each
  /// instant, see first_contact_within_errors().
  [[nodiscard]] FirstContactResult first_contact(const TimeWindow& window);

  /// Finds the first contact without hold or contacts.
  ///
  /// `t` may be earlier than the contact by `early` [-]; `t_upper` is the time of the contact. With
  /// tracking errors `t` is that time, too. Only
  /// verdict, reason and times of the result have a meaning.
  [[nodiscard]] FirstContactResult first_contact_early(const TimeWindow& window, double early);

  /// [m]  The threshold at a time of the piece: the margin, paddings and tracking errors.
  [[nodiscard]] double threshold_at(double t);

  /// [m]  Bound of the effect of tracking errors in a window of the piece.
  [[nodiscard]] double tracking_bound(const TimeWindow& window);

  /// Finds the first contact with another margin and tolerance, without contacts.
  [[nodiscard]] FirstContactResult first_contact(const TimeWindow& window, double margin,
                                                 double tolerance);

  /// The distance of the two at the begin of the window, as far as keep_half needs it.
  [[nodiscard]] StartGap start_gap(WorkCount& work);

  /// The features that are no farther apart than a distance at a time of the piece.
  ///
  /// The result is a contact with them; free where there are none.
  [[nodiscard]] FirstContactResult features_within(double t, double distance);

  /// The distance at a time of the piece, with the closest features in the candidate's frame.
  [[nodiscard]] DistanceResult nearest(double t);

  /// [m]  The distance of nearest(): rounded; 0 for one inside of a solid.
  [[nodiscard]] double distance(double t) { return nearest(t).distance; }

  /// [m]  The distance, at a time of the piece, of the triangles that a contact of the two names.
  ///
  /// It is no less than that of the geometries. A curved shape counts as the set that it is.
  [[nodiscard]] double distance_of_triangles(const Contact& contact, double t);

  /// Whether the two are proven farther apart at t, which costs less than the distance.
  [[nodiscard]] bool is_farther(double t, double distance);

  /// Whether a vertex of one is provably inside of the other, a solid. False says nothing.
  [[nodiscard]] bool has_vertex_inside(double t);

  /// Whether one is inside of the other, a solid.
  [[nodiscard]] bool is_inside(double t);

  /// Transforms a contact of the candidate's frame to the world at t.
  [[nodiscard]] Contact in_world(const Contact& contact, double t) const;
  /// Transforms contacts of one t likewise.
  [[nodiscard]] std::vector<Contact> in_world(const std::vector<Contact>& contacts, double t) const;

 private:
  [[nodiscard]] FirstContactResult ask(const TimeWindow& window, FirstContactOptions query);
  [[nodiscard]] FirstContactOptions options_of_candidate() const;
  /// Finds the first contact with the threshold of each instant.
  template <class Ask>
  [[nodiscard]] FirstContactResult within_errors(const TimeWindow& window, const Ask& ask);
  void first_contact_of_hulls(const TimeWindow& window, double early,
                              const FirstContactOptions& query, FirstContactResult& result);
  /// The pose of the candidate's frame at t.
  [[nodiscard]] LinkPose frame_at(double t) const;
  [[nodiscard]] Contact placed(const Contact& contact, const LinkPose& X_WF) const;

  const RobotTimeline& timeline_;
  const GeometryCandidate& candidate_;
  const RobotCheckOptions& options_;
  LinkWorkspace& workspace_;
  PairPaths paths_;
  LinkMotion X_FA_;
  LinkMotion X_FB_;
  const Shape& A_;
  const Shape& B_;
};

}  // namespace firstcontact::detail
