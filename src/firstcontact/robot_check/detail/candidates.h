/// @file
/// Which geometries of a scene may touch in a piece of time.

#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/query/detail/pair_query.h>
#include <firstcontact/query/shape_pair.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>
#include <firstcontact/robot_check/detail/swept_geometry.h>

namespace firstcontact::detail {

/// Two geometries that may touch in a window of time.
struct GeometryCandidate {
  TimeWindow window;
  std::size_t piece = 0;
  std::size_t pair = 0;                        ///< Index among the tested pairs.
  std::array<std::size_t, 2> geometries = {};  ///< Of its members, in their order.
  double threshold = 0.0;  ///< [m]  Margin, paddings, and tracking errors over the window.
  double gap = 0.0;        ///< [m]  A bound of how far apart they are at some time of the window.
  std::optional<Hold> hold = {};  ///< In place of the threshold, where keep_half is asked.

  /// By pieces; in each the nearest first, whose contact may spare the search for others.
  friend bool operator<(const GeometryCandidate& x, const GeometryCandidate& y) {
    const auto key = [](const GeometryCandidate& c) {
      return std::tuple(c.piece, c.gap, c.window.begin, c.pair, c.geometries);
    };
    return key(x) < key(y);
  }
};

/// Looks at instants while candidates are searched for, so that a contact spares the rest.
struct InstantProbe {
  /// Whether two geometries are in contact at an instant: a candidate whose window is that. Their
  /// hulls overlap then, or nearly so.
  std::function<bool(const GeometryCandidate&)> is_contact;
  bool any_will_do = false;  ///< A contact ends the search; else only what is later is left out.
};

/// What may touch until the earliest contact that a probe has seen.
struct ProbedCandidates {
  std::vector<GeometryCandidate> candidates;  ///< Empty where any contact will do and one is known.
  std::optional<GeometryCandidate> contact;   ///< Its window is the instant.
};

/// The links of a robot that joints move, each after the one that carries it.
struct RobotTree {
  struct Node {
    std::size_t parent = 0;  ///< Of no meaning for the first.
    std::size_t joint = 0;   ///< That moves it; so, too.
  };
  std::vector<Node> nodes;
  std::vector<std::size_t> node_of_link;  ///< Of a link that is its own rigid_root().

  explicit RobotTree(const RobotModel& model);
};

/// Finds the geometries that may touch, piece by piece. Thread-safe.
class CandidateSearch {
 public:
  explicit CandidateSearch(const RobotTimeline& timeline);

  /// In order; outside of their windows all pairs that are tested in the piece are farther apart
  /// than their thresholds. The windows of one pair of geometries do not overlap.
  ///
  /// @param wanted  whether a tested pair is of interest, by index; empty where all are
  /// @param held    [m]  a distance for each tested pair, for which a lesser threshold does not
  ///                count; empty where all thresholds do
  [[nodiscard]] std::vector<GeometryCandidate> find(std::size_t piece,
                                                    const std::function<bool(std::size_t)>& wanted,
                                                    std::span<const double> held = {}) const;

  /// The same, in windows that begin no later than the earliest contact that a probe sees. Between
  /// that and the end of the piece nothing is known.
  ///
  /// Without tracking errors it is asked where the hulls of two geometries are no farther apart
  /// than their threshold at the middle of a window; where any contact will do, also at the end of
  /// the piece.
  [[nodiscard]] ProbedCandidates find_until_contact(std::size_t piece,
                                                    const InstantProbe& probe) const;

  /// The same of all pairs that are tested, with one distance [m] in place of their thresholds.
  [[nodiscard]] std::vector<GeometryCandidate> find_within(std::size_t piece,
                                                           double distance) const;

 private:
  const RobotTimeline& timeline_;
  std::vector<RobotTree> trees_;                       // Of each robot.
  std::vector<std::optional<SweptGeometry>> resting_;  // Of each geometry that rests over the step.
};

}  // namespace firstcontact::detail
