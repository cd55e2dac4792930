/// @file
/// A path from a start to a goal that is proven edge by edge: the question, its options, its
/// answer.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/math/export.h>
#include <firstcontact/scene/plan_question.h>

namespace firstcontact {

/// How far a planner is.
struct PlanProgress {
  double seconds = 0.0;
  std::size_t nodes = 0;
  std::optional<double> cost = {};  ///< Of the best path so far.
};

struct PlanOptions {
  Planner planner = Planner::rrt_connect;
  ContactUse contacts = ContactUse::none;  ///< Of RRT-Connect; others take `none` only.
  std::uint64_t seed = 1;
  double time = 10.0;              ///< [s]  Wall clock; > 0.
  double tolerance = 1e-6;         ///< [m]  See EdgeCheckOptions.
  double extra_clearance = 1e-9;   ///< [m]  So, too: of the proof at the end.
  std::uint64_t effort = 100'000;  ///< As EdgeCheckOptions::effort.
  /// The longest edge of a tree, in the length of the space; 0 for a share of what is sampled.
  double range = 0.0;
  std::size_t shortcuts = 100;  ///< Tries to shorten the path; 0 leaves it as it is.
  bool approximate = false;     ///< Without a path, one that ends as near to a goal as was reached.
  int threads = 0;              ///< Of the proof at the end; at most, 0 for one on each core.
  std::stop_token stop = {};    ///< Ends with the best path so far.
  /// Called now and then from the calling thread; may be empty.
  std::function<void(const PlanProgress&)> progress = {};
};

/// A pair of members, and how many edges and places it ended.
struct BlockingPair {
  BodyPair members = {};
  std::size_t count = 0;
};

/// The work of a planner in contact; all 0 where it was not to.
struct ContactStatistics {
  std::size_t slides = 0;      ///< Ways along contacts towards a target.
  std::size_t pushes = 0;      ///< Ways along contacts in a direction.
  std::size_t nodes = 0;       ///< Places of trees that they ended at.
  std::size_t in_contact = 0;  ///< Of these: no farther from contact than the gap that is kept.
  std::size_t active = 0;      ///< Contacts that held the last steps back, of all of these.
  std::size_t most_active = 0;
};

struct PlanStatistics {
  double seconds = 0.0;
  std::optional<double> first_path_seconds = {};
  std::size_t iterations = 0;
  std::size_t nodes = 0;
  std::size_t edges_checked = 0;
  std::size_t states_checked = 0;
  std::size_t undecided = 0;               ///< Edges that cost too much: taken as blocked.
  std::optional<double> first_cost = {};   ///< Before the shortcuts.
  std::vector<BlockingPair> blocked = {};  ///< The most frequent first.
  ContactStatistics contacts = {};
};

/// A pair that is in contact at an end of a path, and the distance that it is held to.
struct PlannedContact {
  ContactPair pair = {};
  double distance = 0.0;   ///< [m]  Proven: farther apart where its policy replaces its margin.
  double tolerance = 0.0;  ///< [m]  Of checks of it.
};

enum class PlanVerdict {
  none,         ///< No path was found in the time.
  approximate,  ///< The edges are proven, but the path does not end at a goal.
  proven,       ///< The edges are proven, from the start to a goal.
};

/// The words of a verdict in files and in Python, in this order.
inline constexpr std::array<const char*, 3> kPlanVerdictWords{"none", "approximate", "proven"};

struct PlanResult {
  PlanVerdict verdict = PlanVerdict::none;
  /// The places between which edges lead; start and goal are those of the question to the bit. Only
  /// one where the start is a goal.
  std::vector<Configuration> path = {};
  /// [s]  Of each place, from 0 to the duration, where the surroundings move; else empty. Between
  /// two times an edge runs at a constant rate.
  std::vector<double> times = {};
  /// [m]  Of each edge, or of the only place.
  ///
  /// It is a proven lower bound of the distance of every tested pair that is not held along the
  /// edge; none where there is no such pair.
  std::vector<std::optional<double>> clearances = {};
  std::vector<PlannedContact> contact_pairs = {};  ///< That are in contact at their end.
  std::optional<std::size_t> goal = {};            ///< At which the path ends.
  double distance_to_goal = 0.0;                   ///< By the length of the space.
  double cost = 0.0;                               ///< So, too: the length of the path.
  std::vector<std::string> warnings = {};          ///< Such as goals that are not free.
  PlanStatistics statistics = {};
};

/// Plans a path from a start to one of several goals, and proves it.
///
/// Every edge is proven by itself; those of the answer once more by a new EdgeChecker at the end.
/// The same for a seed and for every number of threads, as long as neither the time nor the stop
/// token ends the search before the shortcuts are done.
///
/// The search keeps twice the tolerance more than the margin, so that another check of the answer
/// with the same tolerance finds it free, too, wherever it looks.
///
/// Pairs of the scene's `contact_pairs` that are in contact at their end are held as their policy
/// says (ContactPolicy). A pair that must open does so on a straight edge that is looked for first:
/// without one the verdict is `none`, with a warning.
///
/// Where the surroundings move (`times` of the scene), the answer is a motion from the time 0 to
/// the duration: the mover gets to a goal within its speeds, and rests there until the end. It is
/// proven as a whole once more. There is no approximate answer; the planner is ST-RRT's, whatever
/// the options say, and of shortcuts there is one round.
///
/// @throws std::invalid_argument  names what is wrong: an option, a limit, a place that is none; or
///         the start, or all goals, are not free, with the pair, how deep it is, and the nearest
///         free place that was found; or a contact pair is not tested, or touches at its end
[[nodiscard]] FIRSTCONTACT_API PlanResult plan_path(const PlanScene& scene,
                                                    const Configuration& start,
                                                    const std::vector<Configuration>& goals,
                                                    const PlanOptions& options = {});

}  // namespace firstcontact
