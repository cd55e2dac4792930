/// @file
/// The broad phase: the pairs of many moving bodies that may touch, interval by interval of the
/// step.

#pragma once

#include <functional>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/many_bodies/body_set.h>
#include <firstcontact/many_bodies/detail/box_join.h>
#include <firstcontact/parallel/detail/workers.h>
#include <firstcontact/query/detail/ball_path.h>
#include <firstcontact/query/detail/pair_query.h>

namespace firstcontact::detail {

/// A pair that may touch in an interval.
struct Candidate {
  double free_until = 0.0;  ///< [-]  Time until which this pair is proven free.
  BodyPair bodies = {};
  double margin = 0.0;  ///< [m]

  friend bool operator<(const Candidate& x, const Candidate& y) {
    return x.free_until != y.free_until ? x.free_until < y.free_until : x.bodies < y.bodies;
  }
};

/// The memory of a broad phase, for use again.
struct BroadPhaseData {
  std::vector<Eigen::AlignedBox3d> boxes;
  BoxJoin join;
  std::vector<BodyPair> overlaps;
  std::vector<Candidate> candidates;
};

/// Walks the step in intervals, halved where the bodies sweep over many more others than they
/// overlap at one time.
class BroadPhase {
 public:
  BroadPhase(const BodySet& bodies, Workers& workers, BroadPhaseData& data);

  /// Calls use(window, candidates) in the order of time until it returns false. The candidates of a
  /// window are sorted by the time until which they are proven free. All other pairs are free in
  /// the window.
  void for_each_interval(
      const std::function<bool(const TimeWindow&, const std::vector<Candidate>&)>& use);

 private:
  [[nodiscard]] BallPath ball(std::size_t body, double more) const;
  void place_boxes(const TimeWindow& window);
  bool join(const TimeWindow& window, std::size_t most);
  bool find_overlaps(const TimeWindow& window);
  void find_candidates(const TimeWindow& window);

  const BodySet& bodies_;
  Workers& workers_;
  BroadPhaseData& data_;
  std::vector<double> margins_;
};

}  // namespace firstcontact::detail
