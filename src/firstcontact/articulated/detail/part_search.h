/// @file
/// The questions of a check about two parts, in a piece of time.

#pragma once

#include <vector>

#include <firstcontact/articulated/check_robots.h>
#include <firstcontact/articulated/detail/candidates.h>
#include <firstcontact/articulated/detail/link_query.h>
#include <firstcontact/articulated/detail/robot_timeline.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// Why a check has to end now; none if it need not. Of the steps each search takes care itself.
[[nodiscard]] UndecidedReason spent(const WorkBudget& budget);

[[nodiscard]] inline bool is_contact(Verdict verdict) {
  return verdict == Verdict::contact || verdict == Verdict::contact_at_start;
}

/// Two parts in one window of time. Refers to all that it is made of.
class PartSearch {
 public:
  PartSearch(const RobotTimeline& timeline, const PartCandidate& candidate,
             const RobotCheckOptions& options, LinkWorkspace& workspace);

  /// First contact in [t_begin, t_end], before which the two are proven free and not inside of each
  /// other; when free, `t` is its end.
  [[nodiscard]] FirstContactResult first_contact(double t_begin, double t_end, double margin,
                                                 double tolerance);

  /// The same with the candidate's threshold and the tolerance of the options.
  [[nodiscard]] FirstContactResult first_contact(double t_begin, double t_end);

  /// [m]  At a time of the piece, rounded; 0 for one inside of a solid.
  [[nodiscard]] double distance(double t);

  /// Whether one is inside of the other, a solid.
  [[nodiscard]] bool is_inside(double t);

  /// Whether they are within threshold + tolerance.
  [[nodiscard]] bool touch(double t, double tolerance_used);

  /// The closest features at t, as a contact there.
  [[nodiscard]] Contact closest(double t);

  /// Contacts of the candidate's frame at t as the world sees them.
  [[nodiscard]] std::vector<RobotContact> in_world(const std::vector<Contact>& contacts,
                                                   double t) const;

 private:
  const RobotTimeline& timeline_;
  const PartCandidate& candidate_;
  const RobotCheckOptions& options_;
  LinkWorkspace& workspace_;
  PairPaths paths_;
  LinkMotion X_FA_;
  LinkMotion X_FB_;
  const Shape& A_;
  const Shape& B_;
};

}  // namespace firstcontact::detail
