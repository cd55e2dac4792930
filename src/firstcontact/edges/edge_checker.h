/// @file
/// Edges and places of a planner, proven to be free.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/math/export.h>
#include <firstcontact/query/outcome.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/contact_pair.h>

namespace firstcontact {

/// The times of a plan in an environment that moves.
struct PlanTimes {
  double duration = 1.0;            ///< [s]  Duration of the scene: t = time / duration.
  std::vector<double> speeds = {};  ///< As ConfigurationSpace::travel_time().
};

/// A scene of which some robots are planned; all else is at rest, or moves as is known.
struct PlanScene {
  RobotScene scene;
  std::vector<std::size_t> robots = {0};  ///< The robot of each mover of the space.
  ConfigurationSpace space;
  std::vector<std::string> names = {};  ///< Names of members in messages; empty: the scene's.
  std::optional<PlanTimes> times = {};  ///< Set where the environment moves; see plan_path().
  /// Pairs that may be in contact, each once, for plan_path(). An EdgeChecker holds only those of
  /// its options.
  std::vector<ContactPair> contact_pairs = {};

  [[nodiscard]] const std::string& name(std::size_t member) const {
    return names.empty() ? scene.name(member) : names[member];
  }

  /// The mover of the space that is a robot of the scene; none where the robot is not planned.
  [[nodiscard]] std::optional<std::size_t> mover(std::size_t robot) const;

  /// Gives all movers their motions along an edge: to a scene, a RobotChecker or a search.
  template <class Moved>
  void set_motions(Moved& moved, const Configuration& from, const Configuration& to) const {
    for (std::size_t k = 0; k < robots.size(); ++k) {
      moved.set_motion(robots[k], space.motion(from, to, k));
    }
  }

  /// Gives all movers their motions through several places at their times.
  template <class Moved>
  void set_motions(Moved& moved, std::span<const Configuration> places,
                   std::span<const double> at) const {
    for (std::size_t k = 0; k < robots.size(); ++k) {
      moved.set_motion(robots[k], space.motion(places, at, k));
    }
  }
};

/// A pair that is held to a distance of its own in place of its margin and paddings.
struct HeldPair {
  BodyPair members = {};
  double distance = 0.0;  ///< [m]  Free edges keep strictly more; > 0.
  /// [m]  A pair farther apart than its distance by twice this blocks no edge; > 0.
  double tolerance = 0.0;
};

/// The options of an EdgeChecker.
struct EdgeCheckOptions {
  /// [m]  A pair that is farther apart than its margin, the extra and this blocks no edge; > 0.
  double tolerance = 1e-6;
  /// [m]  Extra distance added to the margins of all pairs; >= 0. Pieces of a free edge between
  /// rounded places then keep the margins themselves.
  double extra_clearance = 1e-9;
  /// [-]  The most by which the fraction of a blocked edge may fall short of its first contact; in
  /// [0, 1]. A thousandth takes less time than 0.
  double fraction_tolerance = 0.0;
  /// The most steps of the search for each two geometries; at least 1. Beyond it the answer is
  /// undecided.
  std::uint64_t effort = 100'000;
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  std::stop_token stop = {};
  std::vector<HeldPair> held = {};  ///< The pairs that are held to a distance, each once.
};

/// The verdict about an edge or a place.
enum class EdgeVerdict {
  /// Proven: every tested pair is farther apart than its margin and the extra; a held pair is
  /// farther apart than its distance.
  free,
  blocked,    ///< A pair is no farther apart than its margin, the extra and the tolerance.
  undecided,  ///< The effort was spent, or the check was ended.
};

/// The answer about an edge.
struct EdgeAnswer {
  EdgeVerdict verdict = EdgeVerdict::undecided;
  /// [-]  Proven: from its start to the rounded interpolation at this share, the edge keeps the
  /// margins. 1 when free; 0 also where no part of it is known to be free.
  double fraction = 0.0;
  /// [m]  Proven lower bound of the distance of every tested pair that is not held, up to
  /// `fraction`. 0 where the start is not free. None where there is no such pair.
  std::optional<double> clearance = 0.0;
  std::optional<BodyPair> pair = {};  ///< The members that block the edge, or are undecided.
  /// Why it is undecided; for a free edge, why check_closely() has no nearer clearance.
  UndecidedReason reason = UndecidedReason::none;
};

/// The answer about a place.
struct StateAnswer {
  EdgeVerdict verdict = EdgeVerdict::undecided;
  /// [m]  Proven lower bound of the distance of every tested pair that is not held; 0 unless the
  /// place is free. None where there is no such pair. Never infinite.
  std::optional<double> clearance = 0.0;
  std::optional<BodyPair> pair = {};  ///< The members that block the place, else the nearest ones.
};

/// Checks the edges of a planner against a scene at rest. Members are those of the scene. Pairs
/// that no edge moves are not tested.
///
/// Thread-safe without locks: every thread has memory of its own. An answer depends neither on
/// other questions nor on the number of threads, unless the deadline or the stop token ends it.
class FIRSTCONTACT_API EdgeChecker {
 public:
  /// Prepares the checks of a scene.
  ///
  /// @throws std::invalid_argument  names the culprit: an option is out of its range; a body or
  /// another robot moves, or is held for some of the time only; a held pair is not tested, or has
  /// tracking errors
  explicit EdgeChecker(PlanScene scene, const EdgeCheckOptions& options = {});
  ~EdgeChecker();
  EdgeChecker(EdgeChecker&&) noexcept;
  EdgeChecker& operator=(EdgeChecker&&) noexcept;

  [[nodiscard]] const PlanScene& scene() const;
  [[nodiscard]] const ConfigurationSpace& space() const { return scene().space; }
  [[nodiscard]] const EdgeCheckOptions& options() const;

  /// Checks an edge. The clearance of a free one is at least the least margin.
  [[nodiscard]] EdgeAnswer check(const Configuration& from, const Configuration& to) const;

  /// Checks an edge, with a clearance that is near the least distance. It takes longer than
  /// check().
  [[nodiscard]] EdgeAnswer check_closely(const Configuration& from, const Configuration& to) const;

  /// Checks an edge for its verdict alone: quicker where it is blocked. The fraction of an edge
  /// that is not free is 0, and the pair need not be the first that blocks it.
  [[nodiscard]] EdgeAnswer check_quickly(const Configuration& from, const Configuration& to) const;

  /// Checks many edges, from[k] to to[k], on several threads.
  ///
  /// @param threads  at most; 0 for one on each core
  /// @throws std::invalid_argument if the two have not as many places
  [[nodiscard]] std::vector<EdgeAnswer> check(std::span<const Configuration> from,
                                              std::span<const Configuration> to,
                                              int threads = 0) const;

  /// Whether a place is free. Quicker than state().
  [[nodiscard]] bool is_free(const Configuration& q) const;

  /// Checks a place, with a clearance that is near the least distance.
  [[nodiscard]] StateAnswer state(const Configuration& q) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace firstcontact
