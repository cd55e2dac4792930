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
#include <firstcontact/planning/search_tree.h>
#include <firstcontact/scene/plan_question.h>

namespace firstcontact {

/// The progress of a planner.
struct PlanProgress {
  double seconds = 0.0;
  std::size_t nodes = 0;
  std::optional<double> cost = {};  ///< Cost of the best path so far.
};

/// The options of a planner.
struct PlanOptions {
  Planner planner = Planner::rrt_connect;
  ContactUse contacts = ContactUse::none;  ///< For RRT-Connect; other planners take `none` only.
  std::uint64_t seed = 1;
  double time = 10.0;              ///< [s]  Wall clock; > 0.
  double spent = 0.0;              ///< [s]  Part of `time` that is over before; >= 0.
  double tolerance = 1e-6;         ///< [m]  See EdgeCheckOptions.
  double extra_clearance = 1e-9;   ///< [m]  Extra clearance of the proof at the end; see
                                   ///< EdgeCheckOptions.
  std::uint64_t effort = 100'000;  ///< As EdgeCheckOptions::effort.
  /// The longest edge of a tree, in the length of the space; 0 for a share of what is sampled.
  double range = 0.0;
  /// Tries to shorten the path; 0 leaves it as it is. Rounds of half as many follow, as long as
  /// each saves 2 % of the cost.
  std::size_t shortcuts = 100;
  bool approximate = false;   ///< Without a path, returns one that ends as near to a goal as the
                              ///< search came.
  bool keep_trees = false;    ///< Returns the trees of the search: PlanResult::trees.
  int threads = 0;            ///< Threads of the proof at the end; at most, 0 for one on each core.
  std::stop_token stop = {};  ///< Ends with the best path so far.
  /// Called now and then from the calling thread; may be empty.
  std::function<void(const PlanProgress&)> progress = {};
};

/// A pair of members, and the number of edges and places that it blocked.
struct BlockingPair {
  BodyPair members = {};
  std::size_t count = 0;
};

/// The work of a planner in contact; all 0 where contacts were not used.
struct ContactStatistics {
  std::size_t slides = 0;      ///< Ways along contacts towards a target.
  std::size_t pushes = 0;      ///< Ways along contacts in a direction.
  std::size_t nodes = 0;       ///< Places of trees at which these ways ended.
  std::size_t in_contact = 0;  ///< Number of these no farther from contact than the kept gap.
  std::size_t active = 0;  ///< Contacts that held the last steps back, summed up over all of these
                           ///< places.
  std::size_t most_active = 0;
};

/// The work of a planner.
struct PlanStatistics {
  double seconds = 0.0;
  std::optional<double> first_path_seconds = {};
  std::size_t iterations = 0;
  std::size_t nodes = 0;
  std::size_t edges_checked = 0;
  std::size_t states_checked = 0;
  std::size_t undecided = 0;  ///< Edges that cost too much to decide; they are taken as blocked.
  std::optional<double> first_cost = {};   ///< Before the shortcuts.
  std::vector<BlockingPair> blocked = {};  ///< The most frequent first.
  ContactStatistics contacts = {};
};

/// A pair that is in contact at an end of a path, and the distance that holds it apart.
struct PlannedContact {
  ContactPair pair = {};
  double distance = 0.0;   ///< [m]  Proven: the pair is farther apart where its policy replaces its
                           ///< margin.
  double tolerance = 0.0;  ///< [m]  Tolerance of checks of the pair.
};

enum class PlanVerdict {
  none,         ///< No path was found in the time.
  approximate,  ///< The edges are proven, but the path does not end at a goal.
  proven,       ///< The edges are proven, from the start to a goal.
};

/// The words of a verdict in files and in Python, in this order.
inline constexpr std::array<const char*, 3> kPlanVerdictWords{"none", "approximate", "proven"};

/// The answer of a planner.
struct PlanResult {
  PlanVerdict verdict = PlanVerdict::none;
  /// The places between which edges lead; start and goal are those of the question to the bit.
  ///
  /// It has only one place where the start is a goal.
  std::vector<Configuration> path = {};
  /// [s]  Time of each place, from 0 to the duration, where the environment moves; else empty.
  ///
  /// Between two times an edge runs at a constant rate.
  std::vector<double> times = {};
  /// [m]  Clearance of each edge, or of the only place.
  ///
  /// It is a proven lower bound of the distance of every tested pair that is not held along the
  /// edge. It is none where there is no such pair.
  std::vector<std::optional<double>> clearances = {};
  std::vector<PlannedContact> contact_pairs = {};  ///< Pairs that are in contact at their end.
  std::optional<std::size_t> goal = {};            ///< Index of the goal at which the path ends.
  double distance_to_goal = 0.0;                   ///< Distance by the length of the space.
  double cost = 0.0;                               ///< Length of the path, by that of the space.
  std::vector<std::string> warnings = {};          ///< Such as goals that are not free.
  PlanStatistics statistics = {};
  /// The trees of the search, or its roadmap; empty without PlanOptions::keep_trees.
  ///
  /// Edges on which contact pairs open at an end of the path are not among theirs. Empty also where
  /// the start is a goal.
  std::vector<SearchTree> trees = {};
};

/// Plans a path from a start to one of several goals, and proves it.
///
/// Every edge is proven by itself. A new EdgeChecker proves those of the answer once more at the
/// end. The answer is the same for a seed and for every number of threads. That ceases where the
/// time or the stop token ends the search before the shortcuts are done.
///
/// The search keeps twice the tolerance more than the margin. So another check of the answer with
/// the same tolerance finds it free, too, wherever it tests.
///
/// Pairs of the scene's `contact_pairs` that are in contact at their end are held by their policy
/// (ContactPolicy). A pair that must open does so on a straight edge, which the planner looks for
/// first. Without such an edge the verdict is `none`, with a warning.
///
/// Where the environment moves (`times` of the scene), the answer is a motion from the time 0 to
/// the duration. The mover gets to a goal within its speeds, and rests there until the end. The
/// whole motion is proven once more. There is no approximate answer. The planner is ST-RRT's.
/// Shortcuts make the way shorter and the arrival earlier.
///
/// @param goals  empty only where the search was stopped before it had any
/// @throws std::invalid_argument  names the defect: an option, a limit, a place that is none; the
///         start, or all goals, are not free, with the pair, its depth, and the nearest free
///         configuration that was found; a contact pair is not tested, or touches at its end
[[nodiscard]] FIRSTCONTACT_API PlanResult plan_path(const PlanScene& scene,
                                                    const Configuration& start,
                                                    const std::vector<Configuration>& goals,
                                                    const PlanOptions& options = {});

}  // namespace firstcontact
