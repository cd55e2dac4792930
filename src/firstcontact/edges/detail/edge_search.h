/// @file
/// The search for contacts along one edge after another, with memory that they share.

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

/// The finding of a search.
struct EdgeFound {
  Verdict verdict = Verdict::free;
  double t = 1.0;  ///< [-]  Before it all pairs are proven free; 0 where only a verdict was wanted.
  std::optional<BodyPair> pair = {};
  UndecidedReason reason = UndecidedReason::none;
};

/// A search like RobotChecker, for robots whose paths all have one piece. It gives no answers of
/// pairs and no contacts.
///
/// Bodies are searched as rigid bodies, not as links: where two slide in each other on a screw, few
/// steps prove that. For one thread.
class EdgeSearch {
 public:
  /// Prepares a search.
  ///
  /// @param options  only tolerance and budget are used
  /// @param early    [-]  the most by which the time of a first contact may be too early
  EdgeSearch(RobotScene scene, const RobotCheckOptions& options, double early = 0.0);
  EdgeSearch(const EdgeSearch&) = delete;
  EdgeSearch& operator=(const EdgeSearch&) = delete;

  /// Sets the motion of a robot for the searches that follow. Other robots keep theirs.
  void set_motion(std::size_t robot, RobotMotion motion);

  /// Finds the first contact. A first contact of bodies alone is not too early.
  [[nodiscard]] EdgeFound first_contact();

  /// Finds a contact, not always the first one. Geometries that overlap in the middle of their
  /// window are found at once.
  ///
  /// @param within  the window in which contacts count; of no length for one instant
  [[nodiscard]] EdgeFound any_contact(const TimeWindow& within = {0.0, 1.0});

  /// [m]  The least margin of all pairs; infinite where there are none.
  [[nodiscard]] double least_margin() const { return timeline_.least_margin(); }

 private:
  void follow_motions();
  [[nodiscard]] FirstContactResult ask(const GeometryCandidate& candidate,
                                       const TimeWindow& window);
  /// The motion of a geometry as that of a rigid body; null for a link among joints.
  [[nodiscard]] const Motion* body_motion(std::size_t geometry) const;
  /// Whether two geometries are in contact at the instant that is the candidate's window.
  [[nodiscard]] bool is_contact_at(const GeometryCandidate& instant);
  /// Whether one of the two lies in the other, a solid, at an instant. False for longer windows: a
  /// motion that begins free meets the surface first.
  [[nodiscard]] bool is_inside_at(const GeometryCandidate& candidate, const TimeWindow& within);
  /// The finding of a contact whose time was not searched for.
  [[nodiscard]] EdgeFound contact_of(const GeometryCandidate& candidate) const;
  /// The earlier one of a first contact and the contact of a candidate.
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
  std::size_t robot_ = 0;             // The robot that was moved last.
  std::optional<Motion> moved_body_;  // Its motion, where it is a body.
};

}  // namespace firstcontact::detail
