/// @file
/// First contact of robots and bodies: the question, its options and its answer.

#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include <firstcontact/many_bodies/scene_result.h>
#include <firstcontact/math/export.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact {

/// The options of a check of robots.
struct RobotCheckOptions {
  double tolerance = 1e-6;  ///< [m]  A reported contact is no farther than margin + tolerance.
  /// The meaning of a start within margin + tolerance.
  ///
  /// With keep_half a pair of members starts where its test begins: at 0, or where a body is put
  /// down. The start distance d0 is the least of all their geometries there. keep_half is not for
  /// robots with tracking errors: within these they may start in contact.
  StartContacts start_contacts = StartContacts::report;
  ContactState contacts = ContactState::nearest();  ///< The contacts that a pair of members lists.
  double contact_band = 0.0;  ///< [m]  Lists features within margin + tolerance + band; >= 0.
  WorkBudget budget = {};     ///< Steps and memory are those of one pair in one piece of time.
  int threads = 0;            ///< At most; 0 for one on each core. Answers do not depend on it.

  bool all_pairs = false;             ///< Answers every tested pair over the whole step.
  bool all_contacts_in_time = false;  ///< Answers every pair likewise, with all of its intervals of
                                      ///< contact.
  /// Computes the closest approach of all pairs, with the answer of the pair that comes closest.
  ///
  /// With one of the two options above it computes that of each pair, which costs much more. A
  /// closest approach covers all times at which a pair is tested, without padding, margin and
  /// tracking errors. Where a pair touches, its time is that of a contact, which need not be the
  /// first.
  bool closest = false;
  double time_resolution = 1e-3;  ///< [-]  Resolution of contact intervals; in (0, 1].

  /// Called now and then from the calling thread with the share that is done, in [0, 1]; may be
  /// empty.
  ///
  /// Without all_pairs the number is the time proven free so far.
  std::function<void(double)> progress = {};
};

/// Finds the first contact of all members that are tested against each other.
///
/// Before t every pair is proven farther apart than its margin, paddings included. That holds for
/// the exact motions that the input defines, and for all that stay within the tracking errors. At a
/// contact the nominal motion's distance is no more than margin + tolerance. The bound of the
/// tracking errors at that time is added to the margin. The answer is the same
/// on every run and for every number of threads, unless the deadline or the stop token ends it.
///
/// Method: the search goes through the pieces of the trajectories, several at once, and ends at the
/// first contact.
///
/// @throws std::invalid_argument if an option is outside its documented range, or not for this
///         scene
[[nodiscard]] FIRSTCONTACT_API SceneResult check_robots(const RobotScene& scene,
                                                        const RobotCheckOptions& options = {});

/// A scene prepared for many checks, one after the other, as a planner makes them.
///
/// The work that all of them share is done once.
class FIRSTCONTACT_API RobotChecker {
 public:
  explicit RobotChecker(RobotScene scene);
  ~RobotChecker();
  RobotChecker(RobotChecker&&) noexcept;
  RobotChecker& operator=(RobotChecker&&) noexcept;

  [[nodiscard]] const RobotScene& scene() const;

  /// Sets another motion of a robot, as RobotScene::set_motion() does.
  void set_motion(std::size_t robot, RobotMotion motion);

  /// Checks the scene as check_robots() does. Not for two threads at a time: it reuses its memory.
  [[nodiscard]] SceneResult check(const RobotCheckOptions& options = {});

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace firstcontact
