/// @file
/// The holds of pairs of members that begin in contact: StartContacts::keep_half.

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <firstcontact/query/detail/pair_query.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/detail/candidates.h>
#include <firstcontact/robot_check/detail/least_of_all.h>
#include <firstcontact/robot_check/detail/robot_timeline.h>

namespace firstcontact::detail {

/// A stretch of time in which a pair is tested, and its hold there.
struct HeldStretch {
  std::size_t first_piece = 0;
  Hold hold;  ///< Hold by the least distance of all geometries at the begin of the stretch.
  WorkCount work;
};

/// The holds of all tested pairs, found at once.
class PairHolds {
 public:
  PairHolds(const RobotTimeline& timeline, const RobotCheckOptions& options,
            LinkWorkspaces& workspaces);

  /// [m]  For each tested pair the greatest distance of its holds; at least 0.
  [[nodiscard]] std::span<const double> greatest() const { return greatest_; }

  /// [m]  The distance beyond which a tested pair stays before its first contact.
  [[nodiscard]] double least(std::size_t pair) const;

  /// The stretches of a pair, in order of time.
  [[nodiscard]] std::span<const HeldStretch> stretches(std::size_t pair) const {
    return stretches_[pair];
  }

  /// Holds a candidate as its pair is held in its piece, with the margin instead of the greatest
  /// hold.
  void apply(GeometryCandidate& candidate) const;

 private:
  const RobotTimeline& timeline_;
  std::vector<std::vector<HeldStretch>> stretches_;
  std::vector<double> greatest_;
};

}  // namespace firstcontact::detail
