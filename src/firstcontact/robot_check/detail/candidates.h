/// @file
/// The geometries of a scene that may touch in a piece of time.

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
#include <firstcontact/robot_check/detail/robot_tree.h>
#include <firstcontact/robot_check/detail/swept_geometry.h>

namespace firstcontact::detail {

/// Two geometries that may touch in a window of time.
struct GeometryCandidate {
  TimeWindow window;
  std::size_t piece = 0;
  std::size_t pair = 0;                        ///< Index of the pair among the tested pairs.
  std::array<std::size_t, 2> geometries = {};  ///< Index of each geometry in its member, in the
                                               ///< order of the members.
  double threshold = 0.0;                      ///< [m]  Margin and paddings.
  bool has_tracking_errors = false;            ///< Whether these count besides the threshold, see
                                               ///< first_contact_within_errors().
  double gap = 0.0;               ///< [m]  A bound of their distance at some time of the window.
  std::optional<Hold> hold = {};  ///< Hold in place of the threshold, for keep_half.

  /// Orders by pieces, and in each the nearest first: its contact may make other searches needless.
  friend bool operator<(const GeometryCandidate& x, const GeometryCandidate& y) {
    const auto key = [](const GeometryCandidate& c) {
      return std::tuple(c.piece, c.gap, c.window.begin, c.pair, c.geometries);
    };
    return key(x) < key(y);
  }
};

/// Whether two geometries are in contact at an instant, which is the candidate's window. Their
/// hulls then overlap, or nearly so.
using InstantProbe = std::function<bool(const GeometryCandidate&)>;

/// Searches the window of a candidate whose hulls overlap at some time, or nearly so. It returns
/// the time after which nothing matters any more.
using WindowProbe = std::function<double(const GeometryCandidate&)>;

/// The geometries that may touch, or a contact.
struct ProbedCandidates {
  std::vector<GeometryCandidate> candidates;  ///< Empty where a contact is known.
  std::optional<GeometryCandidate> contact;   ///< The contact; its window is the instant.
};

/// Finds the geometries that may touch, piece by piece. Thread-safe.
class CandidateSearch {
 public:
  explicit CandidateSearch(const RobotTimeline& timeline);

  /// Finds the candidates of a piece, in order.
  ///
  /// Outside of their windows all pairs that are tested in the piece are farther apart than their
  /// thresholds. The windows of one pair of geometries do not overlap.
  ///
  /// @param wanted  whether a tested pair is of interest, by index; empty where all are
  /// @param held    [m]  a distance for each tested pair; lesser thresholds do not count. Empty
  ///                where all thresholds count
  [[nodiscard]] std::vector<GeometryCandidate> find(std::size_t piece,
                                                    const std::function<bool(std::size_t)>& wanted,
                                                    std::span<const double> held = {}) const;

  /// Finds candidates, unless a probe finds a contact.
  ///
  /// The probe is called where the hulls of two geometries are no farther apart than their
  /// threshold: at the end of the piece, or at the middle of a window. Tracking errors count only
  /// at middles of windows, by their bound over the window.
  [[nodiscard]] ProbedCandidates find_unless_contact(std::size_t piece,
                                                     const InstantProbe& probe) const;

  /// Finds candidates from the begin of the piece on, as far as they matter.
  ///
  /// The probe searches windows at whose middle the hulls of two geometries are no farther apart
  /// than their threshold, with the bound of tracking errors over the window. These windows are not
  /// among the candidates. Windows are left out, or end earlier, where the probe has found that
  /// nothing matters later.
  [[nodiscard]] std::vector<GeometryCandidate> find_until_contact(std::size_t piece,
                                                                  const WindowProbe& probe) const;

  /// Finds candidates of all tested pairs, with one distance [m] in place of their thresholds.
  [[nodiscard]] std::vector<GeometryCandidate> find_within(std::size_t piece,
                                                           double distance) const;

 private:
  const RobotTimeline& timeline_;
  std::vector<RobotTree> trees_;                       // One for each robot.
  std::vector<std::optional<SweptGeometry>> resting_;  // One for each geometry that rests over the
                                                       // step.
};

}  // namespace firstcontact::detail
