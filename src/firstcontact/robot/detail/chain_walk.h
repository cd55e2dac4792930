/// @file
/// Places and derivatives along a chain of joints at one time, and a memory of them.

#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/math/double_double.h>
#include <firstcontact/robot/joint_path.h>
#include <firstcontact/robot/link_path.h>

namespace firstcontact::detail {

/// [-]  Rounding of a few operations on vectors of three.
inline constexpr double kChainRounding = 0x1p-49;

/// [-]  Error of one joint's rotation, its product with those before it, and the vectors fixed in
/// it.
///
/// It is 24 2^-53 for each of three columns, 9 2^-53 for the product.
inline constexpr double kRotationStep = 0x1p-47;

/// An upper bound of the length without a square root; errors need not be tight.
inline double rough_size(const Eigen::Vector3d& v) { return v.lpNorm<1>(); }

/// The recursion of Newton and Euler from F outwards: place and derivatives of the last link
/// reached.
///
/// The walk also sums up the sizes of all terms, from which the errors follow.
///
/// Derivation of the errors: e is the error of the last rotation, the greatest one. d is the error
/// of the rates of joints, summed up over the joints. Vectors r of the chain are within e |r|, and
/// axes likewise. Each term of v is a product of one rate and one vector, within (2 e + d / rate)
/// of its size. A term of al has two rates and an axis. A term of a has two rates or their
/// derivative, two axes and a vector. Roundings are some dozen of each term, and two for each sum
/// that a joint adds to.
struct ChainWalk {
  /// [-]  Factor that covers products of two errors.
  static constexpr double kSecondOrder = 1.0 + 0x1p-30;

  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  Eigen::Vector3d al = Eigen::Vector3d::Zero();

  std::size_t joints = 0;  ///< Number of joints passed so far.
  double rotation_error = 0.0;
  double position_error = 0.0;  ///< [m]  Error by rotations and pivots.
  double length = 0.0;          ///< [m]  Length of the chain.
  double speed = 0.0;  ///< At least |v|, and the terms that cancelled in it; likewise the other
                       ///< sums.
  double acceleration = 0.0;
  double spin = 0.0;
  double spin_rate = 0.0;
  double sliding = 0.0;
  double spin_error = 0.0;  ///< Error by the rates of joints; likewise the others.
  double spin_rate_error = 0.0;
  double sliding_error = 0.0;
  double sliding_rate_error = 0.0;

  /// Moves from the origin of the last link to a point r that is fixed in it.
  void move(const Eigen::Vector3d& r) {
    const Eigen::Vector3d velocity = w.cross(r);
    a += al.cross(r) + w.cross(velocity);
    v += velocity;
    p += r;
    const double far = rough_size(r);
    length += far;
    speed += spin * far;
    acceleration += (spin_rate + spin * spin) * far;
    position_error += rotation_error * far;
  }

  /// Adds the slide of the point in the link.
  void slide(const JointState& joint) {
    const Eigen::Vector3d velocity = R * joint.pivot_velocity;
    const Eigen::Vector3d rate = R * joint.pivot_acceleration;
    a += 2.0 * w.cross(velocity) + rate;
    v += velocity;
    const double fast = rough_size(velocity);
    speed += fast;
    sliding += fast;
    acceleration += 2.0 * spin * fast + rough_size(rate);
    sliding_error += joint.pivot_velocity_error;
    sliding_rate_error +=
        joint.pivot_acceleration_error + 2.0 * (spin + spin_error) * joint.pivot_velocity_error;
  }

  void turn(const JointState& joint, const Eigen::Vector3d& axis) {
    const Eigen::Vector3d rate = joint.rate * axis;
    al += w.cross(rate) + joint.acceleration * axis;
    w += rate;
    const double fast = std::abs(joint.rate);
    spin_rate_error += joint.acceleration_error + spin * joint.rate_error + spin_error * fast +
                       spin_error * joint.rate_error;
    spin_rate += spin * fast + std::abs(joint.acceleration);
    spin += fast;
    spin_error += joint.rate_error;
    R = (R * joint.R_PL).eval();
    rotation_error += kRotationStep + joint.angle_error;
  }

  [[nodiscard]] LinkPose pose() const {
    const double rounding = static_cast<double>(joints + 2) * kChainRounding;
    return {R, p, rotation_error, (position_error + rounding * length) * kSecondOrder};
  }

  [[nodiscard]] LinkState state() const {
    const double rounding = static_cast<double>(joints + 2) * kChainRounding;
    const double e = rotation_error + 0x1p-51;
    LinkState state;
    state.pose = pose();
    state.velocity = v;
    state.acceleration = a;
    state.spin = w;
    state.spin_rate = al;
    state.velocity_error =
        ((2.0 * e + rounding) * speed + spin_error * length + sliding_error) * kSecondOrder;
    state.acceleration_error =
        ((4.0 * e + rounding) * acceleration +
         (spin_rate_error + (2.0 * spin + spin_error) * spin_error) * length +
         2.0 * spin_error * sliding + sliding_rate_error) *
        kSecondOrder;
    state.spin_error = ((e + rounding) * spin + spin_error) * kSecondOrder;
    state.spin_rate_error = ((2.0 * e + rounding) * spin_rate + spin_rate_error) * kSecondOrder;
    return state;
  }
};

/// A joint that a walk has passed, in F.
struct PassedJoint {
  Eigen::Vector3d p_OQ;  ///< [m]  Pivot.
  Eigen::Vector3d axis;  ///< [-]
  double step = 0.0;     ///< [m]  |p_PQ|.
  double lever = 0.0;    ///< [m]  |p_QL|.
  Eigen::Vector3d p_OL;  ///< [m]  The child's origin.
};

using Joints = std::span<const std::shared_ptr<const JointPath>>;

/// Walks along some joints at t, without memory.
[[nodiscard]] ChainWalk walk_along(Joints joints, double t, const DoubleDoubleVector3& p_FO);

/// A memory of the last walks.
///
/// The links of a robot share the joints before them. Pairs of links share the times of queries.
class ChainMemory {
 public:
  struct Node {
    std::uint64_t joint = 0;  ///< Id of the joint's path.
    std::size_t parent = 0;
    std::size_t first_child = 0;  ///< 0 for none: the root is no child.
    std::size_t next_sibling = 0;
    ChainWalk walk;
    PassedJoint passed;
    // The window of the last bounds.
    mutable double t_from = std::numeric_limits<double>::quiet_NaN();
    mutable double t_to = std::numeric_limits<double>::quiet_NaN();
    mutable JointBounds bounds = {};
  };

  /// A walk that ends at a node; the nodes before it are its parents, with the root 0.
  struct Walked {
    const std::vector<Node>& nodes;
    std::size_t last = 0;

    [[nodiscard]] const ChainWalk& end() const { return nodes[last].walk; }
  };

  /// Walks along joints. The result is valid until the next call.
  [[nodiscard]] Walked walk(Joints joints, double t, const DoubleDoubleVector3& p_FO);

  /// Drops the knowledge of all joints, where none of them is needed any more.
  void forget() {
    for (Instant& instant : instants_) {
      instant.t = std::numeric_limits<double>::quiet_NaN();
    }
  }

  /// The bounds of the joint that leads to a node of the walk.
  [[nodiscard]] static const JointBounds& bounds(const Node& node, const JointPath& joint,
                                                 double t_from, double t_to);

 private:
  static constexpr std::size_t kInstants = 32;

  struct Instant {
    double t = std::numeric_limits<double>::quiet_NaN();
    DoubleDoubleVector3 p_FO;
    std::vector<Node> nodes;  // Those in use come first; the memory of the others is kept.
    std::size_t used = 0;

    /// Adds a node without state; nodes before it may move in memory.
    std::size_t add_child(std::size_t parent);
  };
  Instant& instant(double t, const DoubleDoubleVector3& p_FO);

  std::array<Instant, kInstants> instants_;
  std::size_t next_instant_ = 0;
};

}  // namespace firstcontact::detail
