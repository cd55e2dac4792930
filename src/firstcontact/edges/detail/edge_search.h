/// @file
/// The search for contacts along one edge after the other, with memory that they share.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/query/outcome.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/detail/candidates.h>
#include <firstcontact/robot_check/detail/link_query.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::detail {

/// What a search found.
struct EdgeFound {
  Verdict verdict = Verdict::free;
  double t = 1.0;  ///< [-]  Before it all pairs are proven free; 0 where only a verdict was asked.
  std::optional<BodyPair> pair = {};
  UndecidedReason reason = UndecidedReason::none;
};

/// As RobotChecker, for robots of which all paths have one piece: no answers of pairs, no contacts.
///
/// Bodies are asked as bodies: where two slide in each other on a screw, few steps prove that.
///
/// For one thread.
class EdgeSearch {
 public:
  /// @param options  tolerance and budget; all else is of no meaning
  /// @param early    [-]  by so much time a first contact may be told too early
  EdgeSearch(RobotScene scene, const RobotCheckOptions& options, double early = 0.0);
  EdgeSearch(const EdgeSearch&) = delete;
  EdgeSearch& operator=(const EdgeSearch&) = delete;

  /// Questions that follow are of this motion, and of those set before of other robots.
  void set_motion(std::size_t robot, RobotMotion motion);

  /// The first contact. One of bodies alone is not told too early.
  [[nodiscard]] EdgeFound first_contact();

  /// Whether there is a contact; of several not the first one. Where geometries are in each other
  /// half way, that is seen at once.
  ///
  /// @param within  a time in which contacts count; of no length where it is of one instant
  [[nodiscard]] EdgeFound any_contact(const TimeWindow& within = {0.0, 1.0});

  /// [m]  Of all pairs; infinite where there are none.
  [[nodiscard]] double least_margin() const { return timeline_.least_margin(); }

 private:
  void follow_motions();
  [[nodiscard]] FirstContactResult ask(const GeometryCandidate& candidate,
                                       const TimeWindow& window);
  /// The motion of a geometry as that of a rigid body, where it is no link among joints; null else.
  [[nodiscard]] const Motion* body_motion(std::size_t geometry) const;
  /// Whether two geometries are in contact at the instant that is the candidate's window.
  [[nodiscard]] bool is_contact_at(const GeometryCandidate& instant);
  [[nodiscard]] EdgeFound contact_at(const GeometryCandidate& instant) const;
  /// What is known of a contact of which the time was not asked.
  [[nodiscard]] EdgeFound contact_of(const GeometryCandidate& candidate) const;
  /// What a candidate adds to the first contact of others.
  [[nodiscard]] EdgeFound earlier_by(const GeometryCandidate& candidate, const EdgeFound& first);
  [[nodiscard]] EdgeFound any_contact(std::vector<GeometryCandidate> candidates,
                                      const TimeWindow& piece, const TimeWindow& within);
  [[nodiscard]] EdgeFound found_by(const GeometryCandidate& candidate,
                                   const FirstContactResult& result) const;

  RobotScene scene_;
  RobotCheckOptions options_;
  double early_;
  RobotTimeline timeline_;
  bool is_followed_ = true;  // Whether the timeline has the motions of the scene.
  CandidateSearch candidates_;
  LinkWorkspace workspace_;
  std::size_t robot_ = 0;             // The last that was moved.
  std::optional<Motion> moved_body_;  // Of that, where it is a body.
};

}  // namespace firstcontact::detail
