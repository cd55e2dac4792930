/// @file
/// First contact of robots and bodies: the question, its options and its answer.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/math/export.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact {

struct RobotCheckOptions {
  double tolerance = 1e-6;  ///< [m]  A reported contact is no farther than threshold + tolerance.
  ContactState contacts = ContactState::nearest();  ///< Which are listed of a pair of members.
  WorkBudget budget = {};  ///< Steps and memory are those of one pair in one piece of time.
  int threads = 0;         ///< At most; 0 for one on each core. Answers do not depend on it.

  bool all_pairs = false;              ///< The answer of every tested pair over the whole step.
  bool all_contact_intervals = false;  ///< So too, with every interval of contact of each.
  /// The least distance of all pairs, with the answer of the pair that comes closest. With one of
  /// the two above: that of each pair, which costs much more.
  bool least_clearance = false;
  double time_resolution = 1e-3;  ///< [-]  Of contact intervals: see there; in (0, 1].

  /// Called now and then from the calling thread with the part that is done, in [0, 1]; without
  /// all_pairs the time proven free so far. May be empty.
  std::function<void(double)> progress = {};
};

/// Two features of members in contact, in the world.
struct RobotContact {
  BodyPair members = {};
  std::array<std::size_t, 2> geometries = {};  ///< Of each member, by index.
  Contact contact = {};                        ///< Features by their indices in the shapes.
};

/// A stretch of time that may be in contact: outside of its intervals a pair is proven free.
///
/// At `enter` the pair is within threshold + tolerance. It is proven free before, back to the
/// `leave` of the interval before. The claim of `leave` is that the pair was within threshold +
/// tolerance at some time in [leave - resolution, leave]. Gaps in which the pair comes apart for
/// less than twice the resolution may be counted to the interval around them.
struct ContactInterval {
  double enter = 0.0;  ///< [-]
  double leave = 1.0;  ///< [-]
  /// Not none: the interval was not searched to its end, nothing is known in it after `enter`.
  UndecidedReason reason = UndecidedReason::none;
};

/// The least distance of a pair over all times at which it is tested.
///
/// Padding, margin and tracking errors do not count. Where a pair touches, it is at the time of a
/// contact that need not be its first.
struct LeastClearance {
  double lower_bound = 0.0;  ///< [m]  Proven for all times; distance - lower_bound <= tolerance.
  double distance = std::numeric_limits<double>::infinity();  ///< [m]  Attained at t.
  double t = 0.0;                                             ///< [-]
  UndecidedReason reason = UndecidedReason::none;  ///< Not none: the budget ended the search.
  std::optional<Contact> closest = {};             ///< The closest feature pair at t, in the world.
};

/// The answer of one pair of members.
struct RobotPairAnswer {
  BodyPair members = {};
  /// [m]  Margin, both paddings, and the effect of the tracking errors about t: closer than this
  /// counts as contact.
  double threshold = 0.0;
  Verdict verdict = Verdict::undecided;
  UndecidedReason reason = UndecidedReason::none;
  double t = 0.0;                               ///< [-]  [0, t) is proven free; 1 when free.
  std::optional<double> t_upper = {};           ///< [-]  A time proven in contact, if one is known.
  double tolerance_used = 0.0;                  ///< [m]  Larger than asked only if f64 needs it.
  double enclosure_error = 0.0;                 ///< [m]  Of both shapes: adds to the tolerance.
  std::vector<RobotContact> contacts = {};      ///< At t; at least one at a contact.
  ContactCount contact_count = {};              ///< Of them, those included that are not listed.
  std::vector<ContactInterval> intervals = {};  ///< In order, where asked.
  std::optional<LeastClearance> least_clearance = {};  ///< Where asked.
  std::uint64_t steps = 0;                             ///< Node pairs and steps of triangle pairs.
};

struct RobotCheckResult {
  Verdict verdict = Verdict::undecided;
  UndecidedReason reason = UndecidedReason::none;
  double t = 0.0;                 ///< [-]  No pair is in contact in [0, t): proven. 1 when free.
  std::optional<double> t_upper;  ///< [-]  A time that is proven to be in contact, if one is known.
  double clearance = 0.0;         ///< [m]  Proven lower bound of every pair's distance up to t;
                                  ///<      infinite where no pair is tested.
  double tolerance_used = 0.0;    ///< [m]  The greatest of the pairs that were searched.
  double enclosure_error = 0.0;   ///< [m]  The greatest of these.

  /// The index into `pairs` of the pair that decides `t`: the earliest, ties by their order. None
  /// when free.
  std::optional<std::size_t> first;
  /// The index into `pairs` of the pair that comes closest, where that was asked.
  std::optional<std::size_t> closest;
  /// Every tested pair where that was asked, else those that decide `t` and the closest one where
  /// that was asked; by the order of members.
  std::vector<RobotPairAnswer> pairs;
  std::uint64_t steps = 0;  ///< Of all pairs that were searched.
};

/// Finds the first contact of all members that are tested against each other.
///
/// Before t every pair is farther apart than its threshold: proven for the exact motions that the
/// input defines, and for all that stay within the tracking errors. At a contact the nominal
/// motion's distance is no more than threshold + tolerance. The same on every run and for every
/// number of threads, as long as neither the deadline nor the stop token ends it.
///
/// Method: the step is walked piece by piece of the trajectories, several at once, and left at the
/// first contact.
///
/// @throws std::invalid_argument if an option is outside its documented range
[[nodiscard]] FIRSTCONTACT_API RobotCheckResult check_robots(const RobotScene& scene,
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
  [[nodiscard]] RobotCheckResult check(const RobotCheckOptions& options = {});

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace firstcontact
