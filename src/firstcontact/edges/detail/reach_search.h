/// @file
/// A search for places of joints at which a link is at a pose, one try at a time.

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <firstcontact/edges/inverse_kinematics.h>

namespace firstcontact::detail {

/// The search of reach_pose(), for callers with several goals that share their time.
class ReachSearch {
 public:
  /// @param space    outlives this
  /// @param options  of these `tries`, `deadline` and `stop` are the caller's
  /// @throws as reach_pose()
  ReachSearch(const ConfigurationSpace& space, const LinkPoseGoal& goal, const Configuration& start,
              ReachOptions options);
  ~ReachSearch();
  ReachSearch(ReachSearch&&) noexcept;
  ReachSearch& operator=(ReachSearch&&) noexcept;

  /// Begins at the start, then at random places; returns whether it found another place.
  bool try_once();

  /// The number of places found so far.
  [[nodiscard]] std::size_t size() const;

  /// The places found so far, as reach_pose() returns them.
  [[nodiscard]] std::vector<ReachedPose> places();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace firstcontact::detail
