/// @file
/// The front of the tree of box pairs of two bodies: the pairs at which a search at one instant
/// stopped.

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

/// Pairs of boxes that cover all pairs of triangles of two rigid bodies. Each pair has a lower
/// bound of its distance at the begin of the front.
///
/// Bodies that moved little since then have only few pairs that can be near. So questions about
/// many instants and short motions begin at the front in place of the roots. A question about an
/// instant refines the front: it opens near pairs, and raises bounds.
///
/// Source: S. A. Ehmann, M. C. Lin, "Accurate and fast proximity queries between polyhedra using
/// convex surface decomposition", Computer Graphics Forum 20 (2001), have the front. Here its pairs
/// have bounds, so that proofs can begin there as well.
class FIRSTCONTACT_API BoxFront {
 public:
  /// The pose of B in the frame of A.
  struct Place {
    Eigen::Matrix3d R_AB = Eigen::Matrix3d::Identity();
    Eigen::Vector3d p_AB = Eigen::Vector3d::Zero();  ///< [m]  From A's centre to B's.
    /// [m]  Bound of the difference between distances at the exact pose and distances at this one,
    /// or computed from the state.
    double error = 0.0;
  };

  /// 16 pairs of boxes, in the lanes of BoxGroup.
  struct Group {
    std::uint32_t node_a = 0;
    std::uint32_t node_b = 0;
    std::uint16_t live = 0;  ///< The lanes that are in the front.
    /// [m]  Lower bounds of the distances at the begin of the front.
    alignas(64) std::array<float, 16> apart;
  };

  /// A ball around the boxes of B in a group.
  struct Ball {
    Eigen::Vector3f centre;  ///< [m]  From B's centre, B's axes.
    float radius;            ///< [m]
  };

  /// Whether the front has no groups, and so covers nothing.
  [[nodiscard]] bool is_empty() const { return groups_.empty(); }
  void clear();

  /// Starts a new front with the roots of both hierarchies.
  void begin(const MovingPair& pair, const RelativeState& state);
  /// Lets the front begin at this instant instead: bounds fall by as much as distances may have.
  ///
  /// Bounds that are raised from then on are as near as at a new begin. Others are used up by the
  /// length of all motions since they were raised.
  void rebase(const MovingPair& pair, const RelativeState& state);
  [[nodiscard]] const Place& place() const { return place_; }
  [[nodiscard]] std::size_t size() const { return groups_.size(); }
  [[nodiscard]] const Group& group(std::size_t k) const { return groups_[k]; }
  [[nodiscard]] const Ball& ball(std::size_t k) const { return balls_[k]; }
  /// [m]  The least bound of the lanes of a group; infinite where no lane is left.
  [[nodiscard]] double least(std::size_t k) const { return static_cast<double>(least_[k]); }

  /// Finds the lanes of a group whose boxes may have been nearer than `distance` at the begin.
  [[nodiscard]] unsigned lanes_within(std::size_t k, double distance) const;

  /// Raises the bounds of a group by those of an instant, which have the unit [m]. Returns the
  /// lanes that may be nearer than the reach [m] at that instant.
  ///
  /// @param moved  [m]  the most by which distances of the group fell since the front began
  unsigned raise(std::size_t k, const BoxBounds& bounds, double unit, double moved, double reach);
  /// Raises the bound of a lane.
  void raise_lane(std::size_t k, int lane, double apart);
  /// Opens a lane: its contents take its place.
  void open(const MovingPair& pair, std::size_t k, int lane, const BoxPair& inside);
  /// Updates the least bound of a group. Call it after bounds and lanes of the group changed.
  void settle(std::size_t k);

  /// Notes that a new front has been refined for the first time.
  void end_begin() { size_at_begin_ = size(); }
  /// Whether the front has grown so far that a new one is due: opened groups are never closed.
  [[nodiscard]] bool is_spent() const;

  /// Drops the front for a while, where searches from the roots take less work.
  void give_up();
  /// Whether to try a front again.
  [[nodiscard]] bool is_due_again();

 private:
  void add(const MovingPair& pair, const NodeBoxes& a, const NodeBoxes& b);

  Place place_;
  std::vector<Group> groups_;
  std::vector<Ball> balls_;
  std::vector<float> least_;
  std::size_t size_at_begin_ = 0;
  int idle_ = 0;  // Number of questions for which the front stays dropped.
};

/// A bound of the fall of distances since a front began, for the points in a ball of B.
///
/// Derivation, in the frame of A: a point y of B was at p_0 + R_0 y and is at p + R y. So distances
/// of points in a ball (c, r) fell by no more than
///   |p - p_0 + (R - R_0) c| + |R - R_0| r.
/// Here |R - R_0| is the Frobenius norm by the root of 2. In the time tau from now on distances
/// fall by no more than MovingPair::speed_bound() tau.
///
/// Where A does not turn, the path of these points in the frame of A is bounded, too:
///   (|v + w x c'| + |w| r) tau + w^2 d tau^2 / 2.
/// The rates of B's pivot and turn are v and w. The ball's centre is at c' from the pivot. No point
/// of B is farther than d from the pivot.
class FrontMotion {
 public:
  /// @param tau  [-]  >= 0
  FrontMotion(const BoxFront::Place& begin, const MovingPair& pair, const RelativeState& state,
              double tau);

  [[nodiscard]] double most() const { return most_; }  ///< [m]  The bound for all points.
  /// [m]  The bound for the points in the ball.
  [[nodiscard]] double of(const BoxFront::Ball& ball) const;

 private:
  Eigen::Matrix3d turned_;  // R - R_0
  Eigen::Vector3d moved_;   // p - p_0
  // The displacement of c in the time tau is rate_ c + way_, to first order.
  Eigen::Matrix3d rate_;
  Eigen::Vector3d way_;
  double by_radius_;
  double slack_;
  double most_;
};

}  // namespace firstcontact::detail
