/// @file
/// The front of the tree of box pairs of two bodies: where a search at one instant stopped opening.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/moving_pairs/detail/box_pairs.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/narrowphase/detail/box_bounds.h>

namespace firstcontact::detail {

/// Pairs that cover all pairs of triangles of two rigid bodies, each with a lower bound of its
/// distance where the front began.
///
/// Bodies that moved little since then have only few pairs that can be near. So questions about
/// many instants and short motions begin at the front in place of the roots. A question about an
/// instant refines the front: it opens what is near, and raises bounds.
///
/// Source: S. A. Ehmann, M. C. Lin, "Accurate and fast proximity queries between polyhedra using
/// convex surface decomposition", Computer Graphics Forum 20 (2001), have the front. Here its pairs
/// have bounds, so that proofs can begin there as well.
class FIRSTCONTACT_API BoxFront {
 public:
  /// Where a pair of bodies is, seen from A.
  struct Place {
    Eigen::Matrix3d R_AB = Eigen::Matrix3d::Identity();
    Eigen::Vector3d p_AB = Eigen::Vector3d::Zero();  ///< [m]  From A's centre to B's.
    /// [m]  Distances at the exact place are those computed from the state, and seen from here, but
    /// for this.
    double error = 0.0;
  };

  /// 16 pairs of boxes, in the lanes of BoxGroup.
  struct Group {
    std::uint32_t node_a = 0;
    std::uint32_t node_b = 0;
    std::uint16_t live = 0;                   ///< Lanes that are in the front.
    alignas(64) std::array<float, 16> apart;  ///< [m]  Lower bounds where the front began.
  };

  /// A ball around the boxes of B in a group.
  struct Ball {
    Eigen::Vector3f centre;  ///< [m]  From B's centre, B's axes.
    float radius;            ///< [m]
  };

  [[nodiscard]] bool is_empty() const { return groups_.empty(); }
  void clear();

  /// Begins anew with the roots of both hierarchies.
  void begin(const MovingPair& pair, const RelativeState& state);
  [[nodiscard]] const Place& place() const { return place_; }
  [[nodiscard]] std::size_t size() const { return groups_.size(); }
  [[nodiscard]] const Group& group(std::size_t k) const { return groups_[k]; }
  [[nodiscard]] const Ball& ball(std::size_t k) const { return balls_[k]; }
  /// [m]  The least bound of the lanes of a group; infinite where it has none left.
  [[nodiscard]] double least(std::size_t k) const { return static_cast<double>(least_[k]); }

  /// The lanes of a group that may be nearer than that where the front began.
  [[nodiscard]] unsigned lanes_within(std::size_t k, double distance) const;

  /// Raises the bounds of a group by those of an instant, which have the unit [m]. Distances of the
  /// group fell by `moved` [m] at most since the front began. Returns the lanes that may be nearer
  /// than the reach [m] at that instant.
  unsigned raise(std::size_t k, const BoxBounds& bounds, double unit, double moved, double reach);
  /// Raises the bound of a lane.
  void raise_lane(std::size_t k, int lane, double apart);
  /// Opens a lane: what is inside takes its place.
  void open(const MovingPair& pair, std::size_t k, int lane, const BoxPair& inside);
  /// Has to be called after bounds and lanes of a group changed.
  void settle(std::size_t k);

  /// Counts work: where a front has taken as much as it took to begin it, a new one is due.
  void count_work(std::uint64_t work) { work_ += work; }
  void count_begin(std::uint64_t work);
  [[nodiscard]] bool is_spent() const { return work_ > work_of_begin_; }

  /// Drops it for a while, as other ways are shorter.
  void give_up();
  /// Whether it is to be tried again.
  [[nodiscard]] bool is_due_again();

 private:
  void add(const MovingPair& pair, const NodeBoxes& a, const NodeBoxes& b);

  Place place_;
  std::vector<Group> groups_;
  std::vector<Ball> balls_;
  std::vector<float> least_;
  std::uint64_t work_ = 0;
  int idle_ = 0;  // Questions for which it stays dropped.
  std::uint64_t work_of_begin_ = 0;
};

/// By how much distances may have fallen since a front began, for what is in a ball of B.
///
/// Derivation: seen from A, a point y of B was at p_0 + R_0 y and is at p + R y. So distances of
/// points in a ball (c, r) fell by no more than
///   |p - p_0 + (R - R_0) c| + |R - R_0| r.
/// Here |R - R_0| is the Frobenius norm by the root of 2. In the time tau from now on distances
/// fall by no more than MovingPair::speed_bound() tau.
///
/// Where A does not turn, the way of these points seen from A is a bound, too:
///   (|v + w x c'| + |w| r) tau + w^2 d tau^2 / 2.
/// The rates of B's pivot and turn are v and w. The ball's centre is at c' from the pivot. No point
/// of B is farther than d from it.
class FrontMotion {
 public:
  /// @param tau  [-]  >= 0
  FrontMotion(const BoxFront::Place& begin, const MovingPair& pair, const RelativeState& state,
              double tau);

  [[nodiscard]] double most() const { return most_; }  ///< [m]  For all points.
  /// [m]  For those in the ball.
  [[nodiscard]] double of(const BoxFront::Ball& ball) const;

 private:
  Eigen::Matrix3d turned_;  // R - R_0
  Eigen::Vector3d moved_;   // p - p_0
  Eigen::Matrix3d rate_;    // The way of c in the time tau is rate_ c + way_, to first order.
  Eigen::Vector3d way_;
  double by_radius_;
  double slack_;
  double most_;
};

}  // namespace firstcontact::detail
